//! Mesh files: readers and writers of triangles and positions, with the file's numbering.
//!
//! ```
//! use ricci::mesh::io::parse_obj;
//! let soup = parse_obj(b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n", "square.obj")?;
//! assert_eq!(soup.faces, [[0, 1, 2], [0, 2, 3]]);
//! # Ok::<(), ricci::Error>(())
//! ```

#[cfg(any(feature = "gltf", feature = "gifti"))]
mod base64;
mod budget;
mod content;
mod file_format;
pub mod freesurfer;
#[cfg(feature = "gifti")]
mod gifti;
#[cfg(feature = "gifti")]
mod gifti_data;
#[cfg(feature = "gifti")]
mod gifti_notes;
#[cfg(feature = "gifti")]
mod gifti_values;
#[cfg(feature = "gifti")]
mod gifti_write;
#[cfg(feature = "gltf")]
mod gltf;
mod guess;
mod kind;
mod labels;
mod mz3;
mod number_column;
mod obj;
mod obj_write;
mod off;
mod off_binary;
mod off_extras;
mod ply;
mod polygon;
mod scan;
mod sheet;
mod shortest;
mod soup;
mod stl;
mod surface_file;
pub mod text;
mod textured;
mod unpack;
mod vtk;

pub use crate::archive::{destination, write_atomically};
pub use file_format::Format;
pub use freesurfer::{parse_freesurfer, write_freesurfer, write_freesurfer_text};
#[cfg(feature = "gifti")]
pub use gifti::parse_gifti;
#[cfg(feature = "gifti")]
pub use gifti_notes::{GiftiNotes, GiftiTransform, parse_gifti_notes};
#[cfg(feature = "gifti")]
pub use gifti_values::{GiftiColumn, GiftiColumns, parse_gifti_columns};
#[cfg(feature = "gifti")]
pub use gifti_write::{GiftiLabel, gifti_labels, gifti_surface, gifti_values, write_gifti};
#[cfg(feature = "gltf")]
pub use gltf::{SceneFile, SceneOptions, SceneReport, Texture, Wrap, parse_glb, write_glb};
pub use guess::SurfaceFormat;
pub use kind::NumberType;
pub use labels::{FaceLabel, FaceLabels, PlainMaterial};
pub use mz3::{parse_mz3, write_mz3};
pub use number_column::NumberColumn;
pub use obj::{parse_obj, parse_obj_polygons};
pub use obj_write::{write_obj, write_obj_to};
pub use off::{parse_off, write_off};
pub use ply::{parse_ply, write_ply};
pub use polygon::{PolygonTriangles, triangles_of_polygons};
pub use sheet::{
    CuttingSheet, SheetLayer, SheetLine, SheetUnit, write_dxf, write_dxf_to, write_svg, write_svg_to,
};
pub use soup::{Attributes, Soup};
pub use stl::{parse_stl, parse_stl_welded};
pub use surface_file::SurfaceFile;
pub use textured::TexturedMesh;
#[cfg(feature = "gzip")]
pub use unpack::packed;
pub use unpack::{file_bytes, is_packed, packed_for};
pub use vtk::{parse_vtk, write_vtk};
#[cfg(feature = "gifti")]
pub use vtk::{parse_vtp, write_vtp};

use crate::error::Result;
#[cfg(feature = "gltf")]
use crate::mesh::tangents::vertex_normals;
#[cfg(feature = "gltf")]
use soup::in_range;
use std::path::Path;

/// Reads a mesh file: .obj, .off, .ply, .stl, .vtk, .mz3, surfaces of FreeSurfer; with the cargo feature `gltf` .glb and .gltf, with `gifti` .gii
/// and .vtp; with `gzip` each also
/// packed, with `.gz` at the end. What is in the file counts, also under the name of another format.
///
/// # Errors
///
/// Those of [`SurfaceFile::open`] and [`SurfaceFile::soup`].
pub fn read(path: &Path) -> Result<Soup> {
    SurfaceFile::open(path)?.soup()
}

/// Writes a mesh file in the format for its extension; with `.gz` at its end, packed.
///
/// # Errors
///
/// Those of [`Format::of`] and [`write_as`].
pub fn write(path: &Path, soup: &Soup) -> Result<Vec<String>> {
    let format = Format::of(path)?;
    #[cfg(feature = "gzip")]
    if is_packed(path) {
        return write_packed(path, format, soup);
    }
    write_as(path, format, soup)
}

/// Writes a mesh file that gzip packs, atomically: what is packed is first written to a file of its own.
#[cfg(feature = "gzip")]
fn write_packed(path: &Path, format: Format, soup: &Soup) -> Result<Vec<String>> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let plain = path.with_file_name(format!(".{name}.{}.plain", std::process::id()));
    let left_out = write_as(&plain, format, soup);
    let bytes = left_out.as_ref().ok().map(|_| std::fs::read(&plain));
    let _ = std::fs::remove_file(&plain);
    let left_out = left_out?;
    let failed =
        |e: std::io::Error| crate::Error::Io { path: path.display().to_string(), message: e.to_string() };
    let bytes = bytes.unwrap_or_else(|| Ok(Vec::new())).and_then(|bytes| packed(&bytes)).map_err(failed)?;
    write_atomically(path, |out| std::io::Write::write_all(out, &bytes))?;
    Ok(left_out)
}

/// Writes binary glTF with a texture over the texture coordinates of a mesh.
///
/// # Errors
///
/// Those of [`write_glb`].
#[cfg(feature = "gltf")]
pub fn write_glb_textured(path: &Path, soup: &Soup, texture: Texture<'_>) -> Result<()> {
    textured::with_textured(soup, |data| write_glb(path, data, Some(texture))).map(drop)
}

/// Writes binary glTF with tangents of the texture coordinates, [`crate::mesh::tangents`]. Vertices without normals get those of
/// [`crate::mesh::tangents::vertex_normals`], which tangents need. Returns what was left out, as [`write_as`].
///
/// # Errors
///
/// Those of [`write_as`]; [`crate::Error::Argument`] for a mesh without texture coordinates.
#[cfg(feature = "gltf")]
pub fn write_glb_with_tangents(path: &Path, soup: &Soup) -> Result<Vec<String>> {
    let attributes = &soup.attributes;
    let Some(uv) = &attributes.uv else {
        return Err(crate::Error::argument(
            "texture coordinates",
            "none",
            "tangents are those of coordinates",
        ));
    };
    let has_normals = attributes.normals.is_some() || attributes.corner_normals.is_some();
    let mut with_normals = soup.clone();
    if !has_normals {
        in_range("vertex", &soup.faces, soup.positions.len())?;
        with_normals.attributes.normals = Some(vertex_normals(&soup.positions, &soup.faces));
    }
    let left_out = write_as(path, Format::Glb, &with_normals)?;
    // One node, one mesh, and the faces in their order.
    let scene = SceneFile::of_bytes(content::content(path)?, &path.display().to_string())?;
    scene.write(path, uv, &SceneOptions { texcoord: Some(0), tangents: true })?;
    Ok(left_out)
}

/// Writes a mesh file, atomically, with the attributes that the format has: text with the fewest digits that read back, PLY binary, so
/// that positions read back unchanged; GLB has 24 bits, see [`write_glb`]. Returns what was left out: the attributes that the format cannot
/// hold (normals and texture coordinates with more than one value at a vertex, in PLY and OFF; [`Attributes::unheld`]), and
/// [`Attributes::unread`].
///
/// # Errors
///
/// With the file untouched: [`crate::Error::Argument`] for numbers that are not finite and corners out of range;
/// [`crate::Error::Size`] for attributes of another size; [`crate::Error::Io`].
pub fn write_as(path: &Path, format: Format, soup: &Soup) -> Result<Vec<String>> {
    match format {
        Format::Ply => return write_ply(path, soup),
        Format::Off => return write_off(path, soup),
        Format::Vtk => return write_vtk(path, soup),
        #[cfg(feature = "gifti")]
        Format::Vtp => return write_vtp(path, soup),
        Format::Mz3 => return write_mz3(path, soup),
        #[cfg(feature = "gifti")]
        Format::Gifti => return write_gifti(path, soup),
        Format::FreeSurfer => return write_freesurfer(path, soup),
        Format::FreeSurferText => return write_freesurfer_text(path, soup),
        Format::Obj => textured::with_textured(soup, |data| write_obj(path, data))?,
        #[cfg(feature = "gltf")]
        Format::Glb => textured::with_textured(soup, |data| write_glb(path, data, None).map(drop))?,
    }
    Ok(soup.attributes.unheld(format))
}

#[cfg(test)]
mod tests {
    use super::file_format::by_extension;
    use super::surface_file::{READER_FEATURES, READERS};
    use super::*;
    use crate::error::Error;

    /// The first four readers are those of a build without features.
    #[test]
    fn a_build_without_a_feature_names_it() {
        let message = |path: &str| match by_extension(Path::new(path), &READERS[..4], READER_FEATURES) {
            Err(error @ Error::UnknownFormat { .. }) => error.to_string(),
            other => panic!("{other:?}"),
        };
        assert!(by_extension(Path::new("a.PLY"), &READERS[..4], READER_FEATURES).is_ok());
        assert!(message("a/b.GLB").starts_with("a/b.GLB: .glb files need the cargo feature `gltf`"));
        assert!(message("b.gii").contains("`gifti`"));
        assert_eq!(message("b.x"), "b.x: unknown format; known are .obj, .off, .ply, .stl");
        assert!(message("obj").contains("unknown format"));
    }
}
