//! The maps of a hemisphere.

use super::side::HemisphereSide;
use ricci::flatten::{FlattenReport, Flattening, SphereFlattening};
use ricci::mesh::Point;
use ricci::metric::Surface;
use std::path::PathBuf;

/// The maps of one hemisphere, with what its files need of them.
pub struct Hemisphere {
    pub side: HemisphereSide,
    pub path: PathBuf,
    pub surface: Surface,
    pub sphere: SphereFlattening,
    pub inflated: Vec<Point>,
    /// Per vertex how far it moved outwards while the surface was inflated, less the mean.
    pub sulc: Vec<f64>,
    /// True for vertices of the cortex.
    pub is_cortex: Vec<bool>,
    pub cortex: Cortex,
    /// Areal and shape distortion of the sphere and of the flat map at the vertices.
    pub distortion: [[Vec<f64>; 2]; 2],
}

/// The cortex laid flat.
pub struct Cortex {
    pub surface: Surface,
    /// Per vertex its number in the hemisphere.
    pub origins: Vec<u32>,
    pub flat: Flattening,
}

/// What became of a hemisphere.
pub enum Made {
    New(Box<Hemisphere>),
    /// Its files were there.
    Kept {
        side: HemisphereSide,
        path: PathBuf,
    },
}

/// The hemispheres of a run.
pub struct BrainOutcome {
    pub made: Vec<Made>,
    pub radius: f64,
    /// Per new hemisphere the triangles that the numbers in the files of sphere and patch turn over.
    pub written_turned: std::sync::Mutex<Vec<[usize; 2]>>,
}

impl Hemisphere {
    /// The reports of the sphere and of the flat map.
    pub fn reports(&self) -> [(&'static str, &FlattenReport); 2] {
        [("sphere", &self.sphere.report), ("flat", &self.cortex.flat.report)]
    }
}
