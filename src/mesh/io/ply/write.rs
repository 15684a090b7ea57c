//! Writer of binary PLY.

use crate::error::Result;
use crate::mesh::io::{Attributes, Format, NumberColumn, Soup, write_atomically};
use std::io::Write;
use std::path::Path;

/// Writes binary PLY, atomically (little-endian, positions as 64-bit numbers, so that they read back unchanged), with normals, colours (8
/// bits) and texture coordinates if there are any: at the vertices (s, t) if each has a single pair, else at the corners of the faces
/// (texcoord), and further numbers under their names. Returns what was left out: normals that differ between the corners of a vertex,
/// numbers under a name that another property has, and [`Attributes::unheld`].
///
/// # Errors
///
/// With the file untouched: [`crate::Error::Argument`] for numbers that are not finite and corners out of range,
/// [`crate::Error::Size`] for attributes of another size, [`crate::Error::Io`].
pub fn write_ply(path: &Path, soup: &Soup) -> Result<Vec<String>> {
    soup.check_writable()?;
    let attributes = &soup.attributes;
    let vertex_uv = attributes.vertex_uv(soup.positions.len(), &soup.faces);
    let mut left_out = [attributes.left_out(true), attributes.unheld(Format::Ply)].concat();
    let mut names = vec!["x", "y", "z"];
    names.extend(["nx", "ny", "nz"].into_iter().filter(|_| attributes.normals.is_some()));
    names.extend(["red", "green", "blue", "alpha"].into_iter().filter(|_| attributes.colors.is_some()));
    names.extend(["s", "t"].into_iter().filter(|_| vertex_uv.is_some()));
    let vertex_numbers = free(&attributes.vertex_numbers, names, &mut left_out);
    let face_numbers = free(&attributes.face_numbers, vec!["vertex_indices", "texcoord"], &mut left_out);
    let table = PlyTable { soup, vertex_uv, vertex_numbers, face_numbers };
    write_atomically(path, |out| {
        table.header(out)?;
        table.vertices(out)?;
        table.faces(out)
    })?;
    Ok(left_out)
}

/// The properties that are written.
struct PlyTable<'a> {
    soup: &'a Soup,
    /// Texture coordinates of the vertices, if each has a single pair.
    vertex_uv: Option<Vec<[f64; 2]>>,
    vertex_numbers: Vec<&'a NumberColumn>,
    face_numbers: Vec<&'a NumberColumn>,
}

impl PlyTable<'_> {
    /// Texture coordinates of the corners, if vertices have several pairs.
    fn corner_uv(&self) -> Option<&Vec<[[f64; 2]; 3]>> {
        self.soup.attributes.uv.as_ref().filter(|_| self.vertex_uv.is_none())
    }

    fn header(&self, out: &mut impl Write) -> std::io::Result<()> {
        let Soup { positions, faces, attributes } = self.soup;
        write!(out, "ply\nformat binary_little_endian 1.0\ncomment ricci {}\n", env!("CARGO_PKG_VERSION"))?;
        write!(
            out,
            "element vertex {}\nproperty double x\nproperty double y\nproperty double z\n",
            positions.len()
        )?;
        if attributes.normals.is_some() {
            out.write_all(b"property double nx\nproperty double ny\nproperty double nz\n")?;
        }
        if attributes.colors.is_some() {
            for name in ["red", "green", "blue", "alpha"] {
                writeln!(out, "property uchar {name}")?;
            }
        }
        if self.vertex_uv.is_some() {
            out.write_all(b"property double s\nproperty double t\n")?;
        }
        declare(out, &self.vertex_numbers)?;
        write!(out, "element face {}\nproperty list uchar uint vertex_indices\n", faces.len())?;
        if self.corner_uv().is_some() {
            out.write_all(b"property list uchar double texcoord\n")?;
        }
        declare(out, &self.face_numbers)?;
        out.write_all(b"end_header\n")
    }

    fn vertices(&self, out: &mut impl Write) -> std::io::Result<()> {
        let Attributes { normals, colors, .. } = &self.soup.attributes;
        for (v, position) in self.soup.positions.iter().enumerate() {
            let normal = normals.as_ref().map(|n| n[v]);
            for x in position.iter().chain(normal.iter().flatten()) {
                out.write_all(&x.to_le_bytes())?;
            }
            if let Some(color) = colors.as_ref().map(|c| c[v]) {
                out.write_all(&color.map(|x| (255.0 * x.clamp(0.0, 1.0)).round() as u8))?;
            }
            for x in self.vertex_uv.iter().flat_map(|uv| uv[v]) {
                out.write_all(&x.to_le_bytes())?;
            }
            row(out, &self.vertex_numbers, v)?;
        }
        Ok(())
    }

    fn faces(&self, out: &mut impl Write) -> std::io::Result<()> {
        for (f, face) in self.soup.faces.iter().enumerate() {
            out.write_all(&[3])?;
            for v in face {
                out.write_all(&v.to_le_bytes())?;
            }
            if let Some(uv) = self.corner_uv().map(|uv| uv[f]) {
                out.write_all(&[6])?;
                for x in uv.as_flattened() {
                    out.write_all(&x.to_le_bytes())?;
                }
            }
            row(out, &self.face_numbers, f)?;
        }
        Ok(())
    }
}

/// The columns whose names no other property of their element has; the others are added to `left_out`.
fn free<'a>(
    columns: &'a [NumberColumn],
    mut names: Vec<&'a str>,
    left_out: &mut Vec<String>,
) -> Vec<&'a NumberColumn> {
    let mut kept = Vec::new();
    for column in columns {
        if names.contains(&&column.name[..]) {
            left_out.push(format!("numbers `{}`: another property has the name", column.name));
        } else {
            names.push(&column.name);
            kept.push(column);
        }
    }
    kept
}

fn declare(out: &mut impl Write, columns: &[&NumberColumn]) -> std::io::Result<()> {
    columns.iter().try_for_each(|column| writeln!(out, "property {} {}", column.kind.name(), column.name))
}

fn row(out: &mut impl Write, columns: &[&NumberColumn], k: usize) -> std::io::Result<()> {
    columns
        .iter()
        .try_for_each(|column| out.write_all(&column.kind.bytes(column.values[k])[..column.kind.size()]))
}
