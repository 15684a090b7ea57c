//! The report of a flow.
//!
//! ```
//! # use ricci::{Class, Control, Flow, Surface, Target, geometry::Space, mesh::shapes};
//! # use ricci::flow::{Options, StopReason};
//! let options = Options { max_iterations: 1, ..Options::default() };
//! let torus = Surface::from_soup(&shapes::torus(2.0, 1.0, 24, 12)?)?;
//! let mut flow = Flow::new(torus, Class::yamabe(Space::E2), &options, &Control::new())?;
//! let stopped = flow.solve(&Target::Uniform, &Control::new())?;
//! let report = stopped.report().unwrap();
//! assert!(report.stop_reason == StopReason::IterationLimit && !report.converged());
//! # Ok::<(), ricci::Error>(())
//! ```

use super::seconds::FlowSeconds;
use crate::archive::{ArchiveReader, ArchiveWriter, Stored, stored};
use crate::error::Result;
use crate::mesh::{Double, VertexId};
use std::collections::BTreeSet;

/// Why a flow stopped.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StopReason {
    /// The tolerance asked for is reached and every triangle is whole.
    Converged,
    /// No step reduces the error further, and rounding explains the remaining error; every triangle is whole. The metric is as good as
    /// floating-point numbers can make it on this surface, but not to the tolerance asked for.
    RoundingFloor {
        /// Largest curvature error that rounding explains, radians; above the tolerance.
        size: f64,
    },
    /// The extended energy is at its minimum there, but some triangles break: no metric of this class on this
    /// triangulation has the target curvature.
    BrokenTriangles,
    /// No metric of the class on this triangulation has the target curvature: `Report::obstruction` names a set of
    /// vertices that proves it.
    Infeasible,
    /// The variables run away: some |u| exceeds 5e5, where metrics in E² end, and no obstruction was found.
    Diverged,
    /// The metric is out of reach: the step to it moves some u by `step`, and all steps up to the iteration limit could not
    /// ([`super::Options::max_step`] each). So much curvature at so few vertices, or behind so short a loop, asks for lengths that differ
    /// by a factor of about e^step.
    OutOfReach {
        /// Largest change of u in the step.
        step: f64,
    },
    /// No step reduces the error, which is above the rounding floor: `Report::worst` says where,
    /// `Report::broken_triangles` whether triangles break there. No obstruction was found.
    Stalled,
    /// The iteration limit came first.
    IterationLimit,
}

impl Stored for StopReason {
    const LEAST: usize = 1;

    fn write(&self, to: &mut ArchiveWriter) {
        let (number, amount): (u8, Option<f64>) = match *self {
            StopReason::Converged => (0, None),
            StopReason::RoundingFloor { size } => (1, Some(size)),
            StopReason::BrokenTriangles => (2, None),
            StopReason::Infeasible => (3, None),
            StopReason::Diverged => (4, None),
            StopReason::OutOfReach { step } => (5, Some(step)),
            StopReason::Stalled => (6, None),
            StopReason::IterationLimit => (7, None),
        };
        number.write(to);
        amount.iter().for_each(|amount| amount.write(to));
    }

    fn read(from: &mut ArchiveReader<'_>) -> Result<Self> {
        Ok(match u8::read(from)? {
            0 => StopReason::Converged,
            1 => StopReason::RoundingFloor { size: Stored::read(from)? },
            2 => StopReason::BrokenTriangles,
            3 => StopReason::Infeasible,
            4 => StopReason::Diverged,
            5 => StopReason::OutOfReach { step: Stored::read(from)? },
            6 => StopReason::Stalled,
            7 => StopReason::IterationLimit,
            other => return Err(from.wrong(format!("{other} is no reason to stop"))),
        })
    }
}

impl StopReason {
    /// The name used in reports.
    pub fn name(self) -> &'static str {
        match self {
            StopReason::Converged => "converged",
            StopReason::RoundingFloor { .. } => "rounding_floor",
            StopReason::BrokenTriangles => "broken_triangles",
            StopReason::Infeasible => "infeasible",
            StopReason::Diverged => "diverged",
            StopReason::OutOfReach { .. } => "out_of_reach",
            StopReason::Stalled => "stalled",
            StopReason::IterationLimit => "iteration_limit",
        }
    }
}

impl std::fmt::Display for StopReason {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

/// One step of the gradient flow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TraceRow {
    /// Step number; 0 is the start.
    pub step: usize,
    /// `∫ Σ (K − K̄) du` along the steps so far (trapezoidal rule with its first correction), 0 at the start. It falls at every step, except
    /// with plain Barzilai–Borwein steps.
    pub energy: f64,
    /// max |K − K̄|, radians.
    pub max_curvature_error: f64,
    /// Total area.
    pub area: f64,
    /// Step size that led here.
    pub step_size: f64,
}
stored!(row TraceRow { step: usize, energy: f64, max_curvature_error: f64, area: f64, step_size: f64 });

/// Vertices named in [`Report::worst`].
pub const WORST: usize = 8;

/// A set I of vertices that proves a target out of reach: every metric of the class on this triangulation has `Σ_I K > least`, and the
/// target asks for `Σ_I K̄ = curvature ≤ least`.
///
/// A triangle with two or three corners in I has angles of at most π there; one with a single corner has less than
/// `π − arccos η` of the opposite edge in a circle packing (all η in [0, 1]: Thurston's inequality, \[Thu80, chapter
/// 13\], \[CL03\]), less than π in the other schemes. `least` is 2π per vertex of I (π on the boundary) minus these.
#[derive(Debug, Clone, PartialEq)]
pub struct Obstruction {
    /// The vertices of I, ascending.
    pub vertices: Vec<VertexId>,
    /// Σ K̄ over I, radians.
    pub curvature: f64,
    /// The bound, not attained, radians. (Both sums are formed in f64.)
    pub least: f64,
}
stored!(sections Obstruction { vertices, curvature, least });

/// Result of a flow, with everything needed to judge it.
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    /// Why it stopped.
    pub stop_reason: StopReason,
    /// Newton steps, or time steps.
    pub iterations: usize,
    /// Edge flips.
    pub flips: usize,
    /// max |K − K̄| over the vertices that are not pinned, radians.
    pub max_curvature_error: f64,
    /// The tolerance that was asked for, radians.
    pub tolerance: f64,
    /// Largest remaining |K| after the correction in double-double precision, with which flows to K̄ = 0 in H² end.
    pub angle_defect: Option<f64>,
    /// Largest curvature error that rounding can cause at the final metric; determined where a flow stalls.
    pub rounding_floor: Option<f64>,
    /// True if u and the lengths were carried in double-double precision (Newton's method in E², and in H² if every ε is 0; the steps are
    /// f64). The angles formed from them are f64, and so is the curvature, up to the rounding errors of its sums.
    pub double_double: bool,
    /// Faces that break the triangle inequality.
    pub broken_triangles: usize,
    /// The vertices of largest |K − K̄| with their K − K̄ (radians), largest first: at most [`WORST`], none where the
    /// error is 0.
    pub worst: Vec<(VertexId, f64)>,
    /// Vertices that prove the target out of reach (see [`StopReason::Infeasible`]).
    pub obstruction: Option<Obstruction>,
    /// |Σ K + λ·area − 2πχ| of the final metric (broken triangles count with their extended angles, which add up to π).
    pub gauss_bonnet: f64,
    /// max |K − K̄| at the start and after each Newton step.
    pub residuals: Vec<f64>,
    /// The gradient flow's steps.
    pub trace: Vec<TraceRow>,
    /// Newton matrices that had to be shifted to be positive definite.
    pub shifted: usize,
    /// Numeric factorisations, also those that failed: Newton steps after the first use the factor of an earlier one if that is quicker.
    pub factorisations: usize,
    /// Unknowns of the linear system and entries of its Cholesky factor (0 for the gradient flow).
    pub unknowns: usize,
    /// Entries of the Cholesky factor.
    pub factor_entries: usize,
    /// Seconds by phase.
    pub seconds: FlowSeconds,
}
stored!(sections Report { stop_reason, iterations, flips, max_curvature_error, tolerance, angle_defect,
    rounding_floor, double_double, broken_triangles, worst, obstruction, gauss_bonnet, residuals, trace,
    shifted, factorisations, unknowns, factor_entries } without { seconds });

impl Report {
    pub(super) fn new(tolerance: f64) -> Report {
        Report {
            stop_reason: StopReason::IterationLimit,
            iterations: 0,
            flips: 0,
            max_curvature_error: f64::INFINITY,
            tolerance,
            angle_defect: None,
            rounding_floor: None,
            double_double: false,
            broken_triangles: 0,
            worst: Vec::new(),
            obstruction: None,
            gauss_bonnet: 0.0,
            residuals: Vec::new(),
            trace: Vec::new(),
            shifted: 0,
            factorisations: 0,
            unknowns: 0,
            factor_entries: 0,
            seconds: FlowSeconds::default(),
        }
    }

    /// True if the curvature error is at most the tolerance asked for, and no triangle is broken.
    pub fn converged(&self) -> bool {
        self.stop_reason == StopReason::Converged
    }

    /// True if the flow came as far as rounding lets it: it converged, or it ended at the rounding floor.
    pub fn is_reached(&self) -> bool {
        matches!(self.stop_reason, StopReason::Converged | StopReason::RoundingFloor { .. })
    }

    /// The bound that the curvature error is compared with: the tolerance asked for, or the size of the rounding floor if the flow ended
    /// there.
    pub fn allowed_error(&self) -> f64 {
        match self.stop_reason {
            StopReason::RoundingFloor { size } => size.max(self.tolerance),
            _ => self.tolerance,
        }
    }

    /// Replace mirror images in the report of a flow on a double by the vertices of the surface. Errors at boundary vertices stay those of
    /// both copies: twice those of the surface.
    pub(super) fn on_surface(&mut self, double: &Double) {
        let on_surface = |v: VertexId| v.min(double.mirror(v));
        let mut seen = BTreeSet::new();
        self.worst.iter_mut().for_each(|(v, _)| *v = on_surface(*v));
        self.worst.retain(|(v, _)| seen.insert(*v));
        if let Some(obstruction) = &mut self.obstruction {
            obstruction.vertices.iter_mut().for_each(|v| *v = on_surface(*v));
            obstruction.vertices.sort_unstable();
            obstruction.vertices.dedup();
        }
    }

    /// The report of this flow and of the one that went on where this one ended.
    pub(super) fn then(mut self, rest: Report) -> Report {
        self.residuals.extend(rest.residuals.into_iter().skip(1));
        self.seconds += rest.seconds;
        Report {
            iterations: self.iterations + rest.iterations,
            flips: self.flips + rest.flips,
            shifted: self.shifted + rest.shifted,
            factorisations: self.factorisations + rest.factorisations,
            residuals: self.residuals,
            seconds: self.seconds,
            ..rest
        }
    }
}
