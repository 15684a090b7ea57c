//! Writer of binary PLY.

use crate::error::Result;
use crate::mesh::io::{Attributes, Soup, write_atomically};
use std::io::Write;
use std::path::Path;

/// Writes binary PLY, atomically (little-endian, positions as 64-bit numbers, so that they read back unchanged), with normals, colours (8
/// bits) and texture coordinates if there are any: at the vertices (s, t) if each has a single pair, else at the corners of the faces
/// (texcoord). Returns the names of the attributes that were left out: normals that differ between the corners of a vertex.
///
/// # Errors
///
/// With the file untouched: [`crate::Error::Argument`] for numbers that are not finite and corners out of range,
/// [`crate::Error::Size`] for attributes of another size, [`crate::Error::Io`].
pub fn write_ply(path: &Path, soup: &Soup) -> Result<Vec<String>> {
    soup.check_writable()?;
    let Soup { positions, faces, attributes } = soup;
    let Attributes { normals, colors, uv, .. } = attributes;
    let vertex_uv = attributes.vertex_uv(positions.len(), faces);
    let corner_uv = uv.as_ref().filter(|_| vertex_uv.is_none());
    write_atomically(path, |out| {
        write!(out, "ply\nformat binary_little_endian 1.0\ncomment ricci {}\n", env!("CARGO_PKG_VERSION"))?;
        write!(
            out,
            "element vertex {}\nproperty double x\nproperty double y\nproperty double z\n",
            positions.len()
        )?;
        if normals.is_some() {
            out.write_all(b"property double nx\nproperty double ny\nproperty double nz\n")?;
        }
        if colors.is_some() {
            for name in ["red", "green", "blue", "alpha"] {
                writeln!(out, "property uchar {name}")?;
            }
        }
        if vertex_uv.is_some() {
            out.write_all(b"property double s\nproperty double t\n")?;
        }
        write!(out, "element face {}\nproperty list uchar uint vertex_indices\n", faces.len())?;
        if corner_uv.is_some() {
            out.write_all(b"property list uchar double texcoord\n")?;
        }
        out.write_all(b"end_header\n")?;
        for (v, position) in positions.iter().enumerate() {
            let normal = normals.as_ref().map(|n| n[v]);
            for x in position.iter().chain(normal.iter().flatten()) {
                out.write_all(&x.to_le_bytes())?;
            }
            if let Some(color) = colors.as_ref().map(|c| c[v]) {
                out.write_all(&color.map(|x| (255.0 * x.clamp(0.0, 1.0)).round() as u8))?;
            }
            for x in vertex_uv.iter().flat_map(|uv| uv[v]) {
                out.write_all(&x.to_le_bytes())?;
            }
        }
        for (f, face) in faces.iter().enumerate() {
            out.write_all(&[3])?;
            for v in face {
                out.write_all(&v.to_le_bytes())?;
            }
            if let Some(uv) = corner_uv.map(|uv| uv[f]) {
                out.write_all(&[6])?;
                for x in uv.as_flattened() {
                    out.write_all(&x.to_le_bytes())?;
                }
            }
        }
        Ok(())
    })?;
    Ok(attributes.left_out(true))
}
