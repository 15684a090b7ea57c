//! The bytes of a surface's file, from a name or from stdin, and what is made of them: one way for both.

use super::file_format::by_extension;
use super::guess::{SurfaceFormat, format};
use super::obj::parse_obj_polygons;
use super::scan::Location;
use super::{Soup, content, parse_obj, parse_off, parse_ply, parse_stl, parse_stl_welded, unpack};
use crate::error::{Error, Result};
use crate::mesh::Point;
use std::path::{Path, PathBuf};

/// The format that each extension names.
pub(super) const READERS: &[(&str, SurfaceFormat)] = &[
    ("obj", SurfaceFormat::Obj),
    ("off", SurfaceFormat::Off),
    ("ply", SurfaceFormat::Ply),
    ("stl", SurfaceFormat::Stl),
    #[cfg(feature = "gltf")]
    ("glb", SurfaceFormat::Gltf),
    #[cfg(feature = "gltf")]
    ("gltf", SurfaceFormat::Gltf),
    #[cfg(feature = "gifti")]
    ("gii", SurfaceFormat::Gifti),
    ("vtk", SurfaceFormat::Vtk),
    #[cfg(feature = "gifti")]
    ("vtp", SurfaceFormat::Vtp),
    ("mz3", SurfaceFormat::Mz3),
    ("asc", SurfaceFormat::FreeSurfer),
    ("white", SurfaceFormat::FreeSurfer),
    ("pial", SurfaceFormat::FreeSurfer),
    ("inflated", SurfaceFormat::FreeSurfer),
    ("sphere", SurfaceFormat::FreeSurfer),
    ("orig", SurfaceFormat::FreeSurfer),
    ("smoothwm", SurfaceFormat::FreeSurfer),
    ("midthickness", SurfaceFormat::FreeSurfer),
    ("reg", SurfaceFormat::FreeSurfer),
];

/// Extensions whose readers need a cargo feature, with its name.
pub(super) const READER_FEATURES: &[(&str, &str)] =
    &[("glb", "gltf"), ("gltf", "gltf"), ("gii", "gifti"), ("vtp", "gifti")];

/// The contents of a file that holds a surface, unpacked where gzip has packed it, and its format.
///
/// The format is that of a mark at the beginning of the file; a file without one (OBJ, and OFF without its header word) has the format
/// that its name says. Without a name it is told by its looks.
#[derive(Debug)]
pub struct SurfaceFile {
    /// The name in errors.
    name: String,
    /// The folder of the files that this one names, as only glTF does.
    #[cfg_attr(not(feature = "gltf"), allow(dead_code))]
    folder: Option<PathBuf>,
    bytes: Vec<u8>,
    format: SurfaceFormat,
}

impl SurfaceFile {
    /// Reads a file: .obj, .off, .ply, .stl, .vtk, .mz3, surfaces of FreeSurfer, .json; with the cargo feature `gltf` .glb and .gltf, with `gifti` .gii and .vtp; with `gzip` each
    /// also with `.gz` at the end (case does not matter).
    ///
    /// # Errors
    /// [`Error::UnknownFormat`] for another extension, or one whose feature this build lacks; [`Error::Io`]; [`Error::Parse`] for a file
    /// that holds no surface, such as a web page, and for damaged gzip data.
    pub fn open(path: &Path) -> Result<SurfaceFile> {
        let named = named(path)?;
        let name = path.display().to_string();
        let bytes = unpack::unpacked(content::content(path)?, &name)?;
        let format = format(&bytes, named, &name)?;
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
        Ok(SurfaceFile { name, folder: Some(folder.unwrap_or(Path::new(".")).into()), bytes, format })
    }

    /// The contents of a file without a name. `name` is used in errors.
    ///
    /// # Errors
    /// [`Error::Parse`] as in [`SurfaceFile::open`].
    pub fn of_bytes(bytes: Vec<u8>, name: &str) -> Result<SurfaceFile> {
        let bytes = unpack::unpacked(bytes, name)?;
        let format = format(&bytes, None, name)?;
        Ok(SurfaceFile { name: name.into(), folder: None, bytes, format })
    }

    /// The format of the file.
    pub fn format(&self) -> SurfaceFormat {
        self.format
    }

    /// The file as text; bytes that are not UTF-8 are replaced.
    pub fn text(&self) -> String {
        String::from_utf8_lossy(&self.bytes).into_owned()
    }

    /// The triangle list of the file.
    ///
    /// # Errors
    /// [`Error::Parse`] with the line or byte where the file violates its format; [`Error::UnknownFormat`] for an intrinsic metric, which
    /// has no triangles in space, and for a format whose feature this build lacks.
    pub fn soup(&self) -> Result<Soup> {
        let soup = self.parsed()?;
        for what in &soup.attributes.unread {
            log::info!("{}: left out: {what}", self.name);
        }
        Ok(soup)
    }

    /// The vertices and the polygons of an OBJ file, as they are.
    ///
    /// # Errors
    /// [`Error::Parse`] with the line where the file violates its format, and for a file of another format.
    pub fn polygons(&self) -> Result<(Vec<Point>, Vec<Vec<u32>>)> {
        match self.format {
            SurfaceFormat::Obj => parse_obj_polygons(&self.bytes, &self.name),
            _ => Location::whole(&self.name).error("polygons are read from OBJ files alone".into()),
        }
    }

    /// The name, the folder and the bytes of a glTF file; an error for one of another format.
    #[cfg(feature = "gltf")]
    pub(super) fn into_gltf(self) -> Result<(String, Option<PathBuf>, Vec<u8>)> {
        if self.format != SurfaceFormat::Gltf {
            return Err(Error::UnknownFormat {
                path: self.name,
                message: "scenes are read from .glb and .gltf files alone".into(),
            });
        }
        Ok((self.name, self.folder, self.bytes))
    }

    fn parsed(&self) -> Result<Soup> {
        let (bytes, name) = (&self.bytes[..], &self.name[..]);
        match self.format {
            SurfaceFormat::Obj => parse_obj(bytes, name),
            SurfaceFormat::Off => parse_off(bytes, name),
            SurfaceFormat::Ply => parse_ply(bytes, name),
            SurfaceFormat::Stl => parse_stl(bytes, name),
            #[cfg(feature = "gltf")]
            SurfaceFormat::Gltf => super::gltf::parse_beside(bytes, name, self.folder.as_deref()),
            #[cfg(feature = "gifti")]
            SurfaceFormat::Gifti => super::parse_gifti(bytes, name),
            SurfaceFormat::Vtk => super::parse_vtk(bytes, name),
            #[cfg(feature = "gifti")]
            SurfaceFormat::Vtp => super::parse_vtp(bytes, name),
            SurfaceFormat::Mz3 => super::parse_mz3(bytes, name),
            SurfaceFormat::FreeSurfer => super::parse_freesurfer(bytes, name),
            SurfaceFormat::Metric => self.unknown("this is JSON, such as an intrinsic metric, not a mesh"),
            #[cfg(not(feature = "gltf"))]
            SurfaceFormat::Gltf => self.unknown("glTF needs the cargo feature `gltf`"),
            #[cfg(not(feature = "gifti"))]
            SurfaceFormat::Gifti => self.unknown("GIFTI needs the cargo feature `gifti`"),
            #[cfg(not(feature = "gifti"))]
            SurfaceFormat::Vtp => self.unknown("VTK in XML needs the cargo feature `gifti`"),
        }
    }

    fn unknown(&self, message: &str) -> Result<Soup> {
        Err(Error::UnknownFormat { path: self.name.clone(), message: message.into() })
    }

    /// The triangle list of an STL file, with vertices within a distance of each other welded.
    ///
    /// # Errors
    /// Those of [`parse_stl_welded`].
    pub fn welded(&self, weld: f64) -> Result<Soup> {
        parse_stl_welded(&self.bytes, &self.name, weld)
    }
}

/// The format that a name says: that before `.gz`, if that is its end; none for `.gz` alone.
fn named(path: &Path) -> Result<Option<SurfaceFormat>> {
    let is = |path: &Path, wanted: &str| path.extension().is_some_and(|e| e.eq_ignore_ascii_case(wanted));
    let inner = if is(path, "gz") { path.with_extension("") } else { path.into() };
    if is(&inner, "json") {
        return Ok(Some(SurfaceFormat::Metric));
    }
    if inner != path && inner.extension().is_none() {
        return Ok(None);
    }
    by_extension(&inner, READERS, READER_FEATURES).map(Some)
}
