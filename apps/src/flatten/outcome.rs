//! A map of a surface to the plane or the sphere, and what was seen when its file was read again.

use super::round::RoundOutcome;
use super::seamed::SeamedMap;
use crate::input::Input;
use crate::report::{Checks, Done, Figures, InputSummary};
use crate::runner::{CommandRun, JobOutcome};
use ricci::flatten::{Dart, FaceStrain, Flattening, StrainLimits};
use ricci::mesh::VertexId;
use std::sync::OnceLock;

/// What `ricci flatten` finds.
pub enum FlattenOutcome {
    Plane(Box<PlaneOutcome>),
    Sphere(Box<RoundOutcome>),
}

/// A map to the plane.
pub struct PlaneOutcome {
    pub input: Input,
    /// Per vertex its number in the whole surface; none where that is what is flattened.
    pub origins: Option<Vec<u32>>,
    /// The number of vertices of the whole surface.
    pub n_whole: usize,
    pub flat: Flattening,
    /// The strains of the sheet, and the darts; none where no limit is given.
    pub sheet: Option<StrainedSheet>,
    /// The map with seams, whose points are those of `flat`; none of a map without.
    pub seamed: Option<SeamedMap>,
    /// The Newton decrement that was asked for.
    pub tolerance: f64,
    /// True if no part of the map is to lie on another one.
    pub injective: bool,
    /// True if vertices are pinned or pieces are straight.
    pub has_conditions: bool,
    /// The number of triangles that the numbers in the file of `--uv` turn over; unset where no file was read again.
    pub written_turned: OnceLock<usize>,
}

/// The strains of a sheet that is cut by the map.
pub struct StrainedSheet {
    pub limits: StrainLimits,
    pub strains: Vec<FaceStrain>,
    /// Vertices are those of the input.
    pub darts: Vec<Dart>,
    /// The largest part of its limit that a triangle takes, without darts and with them.
    pub taken: [f64; 2],
}

impl PlaneOutcome {
    /// The number of a vertex in the whole surface.
    pub fn origin(&self, v: VertexId) -> u32 {
        self.origins.as_ref().map_or(v.0, |origins| origins[v.index()])
    }
}

impl FlattenOutcome {
    /// The surface that is mapped.
    pub fn source(&self) -> &Input {
        match self {
            FlattenOutcome::Plane(found) => &found.input,
            FlattenOutcome::Sphere(found) => &found.input,
        }
    }
}

impl JobOutcome for FlattenOutcome {
    type Figures = Figures;

    fn checks(&self) -> Checks {
        match self {
            FlattenOutcome::Plane(found) => found.checks(),
            FlattenOutcome::Sphere(found) => found.checks(),
        }
    }

    fn input(&self) -> Option<InputSummary> {
        Some(InputSummary::of(self.source()))
    }

    fn figures(&self, run: &CommandRun<'_>) -> Figures {
        match self {
            FlattenOutcome::Plane(found) => found.figures(run),
            FlattenOutcome::Sphere(found) => found.figures(run),
        }
    }

    fn summary(&self, done: &Done) -> String {
        match self {
            FlattenOutcome::Plane(found) => found.summary(done),
            FlattenOutcome::Sphere(found) => found.summary(done),
        }
    }
}
