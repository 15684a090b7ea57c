//! Mesh files: triangles and positions, as the file numbers them.

mod atomic;
mod obj;
mod off;
mod off_binary;
mod scan;

pub use atomic::write_atomically;
pub use obj::{ObjData, parse_obj, write_obj};
pub use off::parse_off;

use super::Point;
use crate::error::{Error, Result};
use std::path::Path;

/// An indexed triangle list as a file gives it. Polygons are triangulated as fans from their first corner;
/// vertices keep the file's numbering, isolated ones included.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Soup {
    /// Vertex positions; coordinates may be non-finite, [`super::check::diagnose`] finds that.
    pub positions: Vec<Point>,
    /// Corners of each triangle, 0-based. Indices may be out of range, the diagnosis finds that too.
    pub faces: Vec<[u32; 3]>,
}

/// Extensions that [`read`] knows.
pub const READABLE: &str = ".obj, .off";

/// Read a mesh file by its extension (case does not matter).
pub fn read(path: &Path) -> Result<Soup> {
    let name = path.display().to_string();
    let extension = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
    let parse = match extension.as_deref() {
        Some("obj") => parse_obj,
        Some("off") => parse_off,
        _ => return Err(Error::UnknownFormat { path: name, known: READABLE }),
    };
    let bytes = std::fs::read(path).map_err(|e| Error::Io { path: name.clone(), message: e.to_string() })?;
    parse(&bytes, &name)
}

/// The fan of a polygon from its first corner; nothing for fewer than three corners.
fn fan(corners: &[u32], faces: &mut Vec<[u32; 3]>) {
    faces.extend(corners.windows(2).skip(1).map(|w| [corners[0], w[0], w[1]]));
}
