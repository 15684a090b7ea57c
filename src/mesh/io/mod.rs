//! Mesh files: triangles and positions, as the file numbers them.

mod atomic;
mod base64;
mod budget;
mod gifti;
mod gifti_data;
mod gltf;
mod kind;
mod obj;
mod off;
mod off_binary;
mod off_extras;
mod ply;
mod polygon;
mod scan;
mod soup;
mod stl;
mod textured;

pub use atomic::{destination, write_atomically};
pub use gifti::parse_gifti;
pub use gltf::{Texture, Wrap, parse_glb, write_glb};
pub use obj::{parse_obj, write_obj};
pub use off::{parse_off, write_off};
pub use ply::{parse_ply, write_ply};
pub use soup::{Attributes, Soup};
pub use stl::{parse_stl, parse_stl_welded};
pub use textured::Textured;

use crate::error::{Error, Result};
use std::path::Path;

/// Extensions that [`read`] knows.
pub const READABLE: &str = ".obj, .off, .ply, .stl, .glb, .gltf, .gii";

/// Read a mesh file by its extension (case does not matter).
pub fn read(path: &Path) -> Result<Soup> {
    let name = path.display().to_string();
    let extension = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
    let parse = match extension.as_deref() {
        Some("obj") => parse_obj,
        Some("off") => parse_off,
        Some("ply") => parse_ply,
        Some("stl") => parse_stl,
        Some("glb" | "gltf") => parse_glb,
        Some("gii") => parse_gifti,
        _ => return Err(Error::UnknownFormat { path: name, known: READABLE }),
    };
    parse(&content(path)?, &name)
}

/// Read an STL file, whatever its name, and weld it within a distance: [`parse_stl_welded`].
pub fn read_stl(path: &Path, weld: f64) -> Result<Soup> {
    parse_stl_welded(&content(path)?, &path.display().to_string(), weld)
}

fn content(path: &Path) -> Result<Vec<u8>> {
    std::fs::read(path).map_err(|e| Error::Io { path: path.display().to_string(), message: e.to_string() })
}

/// Extensions that [`write()`] knows.
pub const WRITABLE: &str = ".obj, .off, .ply, .glb";

/// A format that can be written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Wavefront OBJ.
    Obj,
    /// OFF, text.
    Off,
    /// PLY, binary.
    Ply,
    /// Binary glTF 2.0.
    Glb,
}

impl Format {
    /// The format that a file's extension names (case does not matter). Errors: [`Error::UnknownFormat`].
    pub fn of(path: &Path) -> Result<Format> {
        let extension = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
        match extension.as_deref() {
            Some("obj") => Ok(Format::Obj),
            Some("off") => Ok(Format::Off),
            Some("ply") => Ok(Format::Ply),
            Some("glb") => Ok(Format::Glb),
            _ => Err(Error::UnknownFormat { path: path.display().to_string(), known: WRITABLE }),
        }
    }
}

/// Write a mesh file by its extension: [`write_as`] the format of that.
pub fn write(path: &Path, soup: &Soup) -> Result<Vec<&'static str>> {
    write_as(path, Format::of(path)?, soup)
}

/// Write binary glTF with a texture over the texture coordinates of a mesh: [`write_glb`].
pub fn write_glb_textured(path: &Path, soup: &Soup, texture: Texture<'_>) -> Result<()> {
    textured::with_textured(soup, |data| write_glb(path, data, Some(texture))).map(drop)
}

/// Write a mesh file, atomically, with the attributes that the format has: text with 17 significant digits, PLY binary, so that
/// positions read back as they are; GLB has 24 bits, see [`write_glb`]. Returned is what was left out because the format has no
/// place for it, by name: normals and texture coordinates with more than one value at a vertex, in PLY and OFF.
///
/// Errors, with the file untouched: [`Error::Argument`] for numbers that are not finite and corners out of range;
/// [`Error::Size`] for attributes of another size; [`Error::Io`].
pub fn write_as(path: &Path, format: Format, soup: &Soup) -> Result<Vec<&'static str>> {
    match format {
        Format::Ply => write_ply(path, soup),
        Format::Off => write_off(path, soup),
        Format::Obj => textured::with_textured(soup, |data| write_obj(path, data)).map(|()| Vec::new()),
        Format::Glb => textured::with_textured(soup, |data| write_glb(path, data, None)).map(|_| Vec::new()),
    }
}
