//! The report of a flat map: how its descent began and ended, and how much lengths and areas change.

use super::distortion::Distortion;

/// The map that a descent started from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FlattenStart {
    /// The conformal layout that keeps the lengths of the outer loop.
    Conformal,
    /// Every vertex at the mean of its neighbours, the outer loop on a circle \[Flo03\]: the conformal layout turns a triangle of the surface
    /// over, or was not found.
    Tutte,
    /// On the sphere: the conformal map, which turned triangles of the surface over that were turned back.
    Untangled,
    /// A seamless map ([`crate::seamless`]), whose seams stay rotations.
    Seamless,
    /// On the sphere: a map of the triangulation alone, vertex by vertex from coarse to fine \[PH03\]. The conformal map turns triangles over, and
    /// they stay so.
    CoarseToFine,
}

impl FlattenStart {
    /// The name in reports.
    pub fn name(self) -> &'static str {
        match self {
            FlattenStart::Conformal => "conformal",
            FlattenStart::Tutte => "tutte",
            FlattenStart::Untangled => "untangled",
            FlattenStart::Seamless => "seamless",
            FlattenStart::CoarseToFine => "coarse-to-fine",
        }
    }
}

/// Why a descent ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FlattenStop {
    /// A full Newton step was made whose decrement is at most the tolerance.
    Converged,
    /// A full step is expected to lower the energy by less than its last digits, and decrements do not get smaller: doubles hold no better map.
    Rounding,
    /// The steps ran out.
    MaxIterations,
    /// The energy falls on toward a triangle without area, as it can do where it stays finite there ([`super::DistortionEnergy::Arap`]).
    Barrier,
    /// No step along the Newton direction lowers the energy.
    NoStep,
    /// Pinned vertices or straight pieces are not where they are to be: no map that turns no triangle over was found that has them there.
    Unmet,
}

impl FlattenStop {
    /// The name in reports.
    pub fn name(self) -> &'static str {
        match self {
            FlattenStop::Converged => "converged",
            FlattenStop::Rounding => "rounding",
            FlattenStop::MaxIterations => "max-iterations",
            FlattenStop::Barrier => "barrier",
            FlattenStop::NoStep => "no-step",
            FlattenStop::Unmet => "unmet",
        }
    }
}

/// How a flat map was found.
#[derive(Debug, Clone, PartialEq)]
pub struct FlattenReport {
    /// The start.
    pub start: FlattenStart,
    /// Why the descent ended.
    pub stop: FlattenStop,
    /// The energy that is least: at the start, then after each step. It can rise on the way to pinned vertices and straight pieces.
    pub energies: Vec<f64>,
    /// The steps by the Hessian itself; the others are by the one whose negative eigenvalues in triangles are replaced by 0.
    pub unclamped: usize,
    /// The Newton decrement of the last step ([`super::FlattenOptions::tolerance`]); infinite if no step was made.
    pub decrement: f64,
    /// The largest slope of the energy at the end, in x or y of a vertex, times the diameter of the map.
    pub gradient: f64,
    /// The change of lengths and areas at the start, the map scaled to the least symmetric Dirichlet energy.
    pub before: Distortion,
    /// The change of lengths and areas at the end.
    pub after: Distortion,
    /// The share of the map's area that is covered more than once ([`crate::geometry::cover_share::covered_again`]).
    pub overlap: f64,
    /// True if the map is one to one: no triangle is turned over and no two sides of the border meet but at their ends, by exact arithmetic on
    /// the points.
    pub one_to_one: bool,
    /// The largest distance of a pinned vertex from its place, and of a vertex of a straight piece from the line through the piece's ends,
    /// over the diameter of the map.
    pub misfit: f64,
    /// Seconds for the start and for the descent.
    pub seconds: [f64; 2],
}

impl FlattenReport {
    /// True if the map is as good as the tolerance asks, or as doubles hold.
    pub fn converged(&self) -> bool {
        matches!(self.stop, FlattenStop::Converged | FlattenStop::Rounding)
    }

    /// The number of Newton steps.
    pub fn iterations(&self) -> usize {
        self.energies.len() - 1
    }
}
