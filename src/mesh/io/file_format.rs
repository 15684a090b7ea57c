//! The file formats that can be written, and the choice of a format by a file's extension.

use super::unpack::is_packed;
use crate::error::{Error, Result};
use std::path::Path;

/// The format to write for each extension.
const WRITERS: &[(&str, Format)] = &[
    ("obj", Format::Obj),
    ("off", Format::Off),
    ("ply", Format::Ply),
    #[cfg(feature = "gltf")]
    ("glb", Format::Glb),
    ("vtk", Format::Vtk),
    #[cfg(feature = "gifti")]
    ("vtp", Format::Vtp),
    ("mz3", Format::Mz3),
    #[cfg(feature = "gifti")]
    ("gii", Format::Gifti),
    ("asc", Format::FreeSurferText),
    ("white", Format::FreeSurfer),
    ("pial", Format::FreeSurfer),
    ("inflated", Format::FreeSurfer),
    ("sphere", Format::FreeSurfer),
    ("orig", Format::FreeSurfer),
    ("smoothwm", Format::FreeSurfer),
    ("midthickness", Format::FreeSurfer),
    ("reg", Format::FreeSurfer),
];

/// Extensions whose writers need a cargo feature, with its name.
const WRITER_FEATURES: &[(&str, &str)] = &[("glb", "gltf"), ("vtp", "gifti"), ("gii", "gifti")];

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
    /// VTK, legacy, binary.
    Vtk,
    /// VTK in XML, with numbers as base64.
    #[cfg(feature = "gifti")]
    Vtp,
    /// MZ3, not packed.
    Mz3,
    /// GIFTI, with numbers compressed in base64.
    #[cfg(feature = "gifti")]
    Gifti,
    /// A surface of FreeSurfer, binary.
    FreeSurfer,
    /// A surface of FreeSurfer as text.
    FreeSurferText,
}

impl Format {
    /// True if files have room for numbers of vertices and faces with their names.
    pub(super) fn has_numbers(self) -> bool {
        match self {
            Format::Ply | Format::Vtk => true,
            #[cfg(feature = "gifti")]
            Format::Vtp => true,
            _ => false,
        }
    }

    /// True if files have room for texture coordinates.
    pub fn has_texture_coordinates(self) -> bool {
        match self {
            Format::Mz3 | Format::FreeSurfer | Format::FreeSurferText => false,
            #[cfg(feature = "gifti")]
            Format::Gifti => false,
            _ => true,
        }
    }

    /// True if files have room for one pair of texture coordinates at each vertex alone, and none for seams.
    pub fn has_no_seams(self) -> bool {
        match self {
            Format::Off | Format::Vtk => true,
            #[cfg(feature = "gifti")]
            Format::Vtp => true,
            _ => false,
        }
    }

    /// The format for a file's extension (case does not matter): .obj, .off, .ply, .glb, .vtk, .vtp, .mz3, .gii; with `.gz` at the end that before it, packed; of FreeSurfer .asc for text, and for binary
    /// surfaces the names that it gives them, such as `lh.pial`: .white, .pial, .inflated, .sphere, .reg, .orig, .smoothwm, .midthickness.
    ///
    /// # Errors
    ///
    /// [`Error::UnknownFormat`] for another extension, and for .glb, .vtp and .gii in a build without the cargo features `gltf` and
    /// `gifti`, for .gz in one without `gzip`.
    pub fn of(path: &Path) -> Result<Format> {
        if !is_packed(path) {
            return by_extension(path, WRITERS, WRITER_FEATURES);
        }
        if cfg!(not(feature = "gzip")) {
            let message =
                ".gz files need the cargo feature `gzip`, without which this library was built".to_string();
            return Err(Error::UnknownFormat { path: path.display().to_string(), message });
        }
        by_extension(&path.with_extension(""), WRITERS, WRITER_FEATURES)
    }
}
