//! The file formats that can be written, and the choice of a format by a file's extension.

use crate::error::{Error, Result};
use std::path::Path;

/// The format to write for each extension.
const WRITERS: &[(&str, Format)] = &[
    ("obj", Format::Obj),
    ("off", Format::Off),
    ("ply", Format::Ply),
    #[cfg(feature = "gltf")]
    ("glb", Format::Glb),
];

/// Extensions whose writers need a cargo feature, with its name.
const WRITER_FEATURES: &[(&str, &str)] = &[("glb", "gltf")];

/// The entry of `table` for the extension of a path (case does not matter). The error lists the extensions of the table or names the
/// cargo feature that this build lacks.
pub(super) fn by_extension<T: Copy>(
    path: &Path,
    table: &[(&str, T)],
    features: &[(&str, &str)],
) -> Result<T> {
    let extension = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
    let is_this = |known: &str| extension.as_deref() == Some(known);
    if let Some((_, entry)) = table.iter().find(|(known, _)| is_this(known)) {
        return Ok(*entry);
    }
    let message = match features.iter().find(|(known, _)| is_this(known)) {
        Some((extension, feature)) => {
            format!(
                ".{extension} files need the cargo feature `{feature}`, without which this library was built"
            )
        }
        None => {
            let known: Vec<_> = table.iter().map(|(extension, _)| format!(".{extension}")).collect();
            format!("unknown format; known are {}", known.join(", "))
        }
    };
    Err(Error::UnknownFormat { path: path.display().to_string(), message })
}

/// A file format that can be written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Wavefront OBJ.
    Obj,
    /// OFF, text.
    Off,
    /// PLY, binary.
    Ply,
    /// Binary glTF 2.0.
    #[cfg(feature = "gltf")]
    Glb,
}

impl Format {
    /// The format for a file's extension (case does not matter): .obj, .off, .ply, .glb.
    ///
    /// # Errors
    ///
    /// [`Error::UnknownFormat`] for another extension, and for .glb in a build without the cargo feature `gltf`.
    pub fn of(path: &Path) -> Result<Format> {
        by_extension(path, WRITERS, WRITER_FEATURES)
    }
}
