//! Types in place of those of parts of the library that a build leaves out.
#![allow(dead_code)]

use ricci::mesh::io::Soup;
use std::path::Path;

/// In place of handles that nobody can have.
pub enum SeamlessLeftOut {}
pub enum QuadsLeftOut {}
pub enum QuadLayoutLeftOut {}
pub enum QuadSplineLeftOut {}
pub enum SplineLeftOut {}

/// In place of the library's `Wrap`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WrapLeftOut {
    Repeat,
    Mirror,
    Clamp,
}

/// In place of the library's `LengthUnit`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum UnitLeftOut {
    Millimetre,
    Metre,
}

/// In place of the library's `StepOptions`.
#[derive(Debug, Clone)]
pub struct StepLeftOut {
    pub name: String,
    pub unit: UnitLeftOut,
    pub colours: bool,
}

/// In place of the library's `SceneFile`, of which there are none.
pub enum SceneLeftOut {}

/// In place of the library's `SceneOptions`.
#[derive(Debug, Clone, Copy)]
pub struct SceneOptionsLeftOut {
    pub texcoord: Option<u32>,
    pub tangents: bool,
}

/// In place of the library's `SceneReport`.
#[derive(Debug, Clone)]
pub struct SceneReportLeftOut {
    pub texcoord: u32,
    pub n_primitives: usize,
    pub n_vertices: usize,
    pub n_split_vertices: usize,
    pub n_replaced: usize,
    pub n_kept_textures: usize,
    pub n_misplaced_textures: usize,
    pub n_tangents: usize,
    pub n_without_tangents: usize,
    pub n_dropped_tangents: usize,
    pub n_unrolled: usize,
    pub n_shared_meshes: usize,
    pub notes: Vec<String>,
}

impl SceneLeftOut {
    pub fn open(path: &Path) -> ricci::Result<SceneLeftOut> {
        Err(ricci::Error::UnknownFormat {
            path: path.display().to_string(),
            message: "glTF was left out when this library was built (cargo feature `gltf`)".into(),
        })
    }

    pub fn soup(&self) -> &Soup {
        match *self {}
    }

    pub fn meshes(&self) -> &[u32] {
        match *self {}
    }

    pub fn counts(&self) -> [usize; 4] {
        match *self {}
    }

    pub fn write(
        &self,
        _: &Path,
        _: &[[[f64; 2]; 3]],
        _: &SceneOptionsLeftOut,
    ) -> ricci::Result<SceneReportLeftOut> {
        match *self {}
    }
}
