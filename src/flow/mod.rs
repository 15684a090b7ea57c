//! The flow `du/dt = K̄ − K` [JKLLG08, Eqn 16] to a prescribed curvature, by Newton's method on its convex energy
//! or by following it.
//!
//! ```
//! use ricci::{Class, Control, Flow, Surface, Target, flow::Options, geometry::Space, mesh::shapes};
//!
//! let torus = Surface::from_soup(&shapes::torus(2.0, 1.0, 24, 12)?)?;
//! let mut flow = Flow::new(torus, Class::yamabe(Space::E2), &Options::default(), &Control::new())?;
//! let flat = flow.solve(&Target::Uniform, &Control::new())?;
//! assert!(flat.converged() && flat.cones().is_empty());
//! # Ok::<(), ricci::Error>(())
//! ```

mod active_set;
mod cone_angles;
pub mod cones;
mod cones_within;
mod direction;
mod evaluate;
mod flatten;
mod gradient;
pub(crate) mod hubs;
mod jacobian;
mod line_search;
mod measure;
mod memory;
mod newton;
mod obstruction;
mod off_caps;
pub mod options;
mod origin;
mod outer;
mod polish;
pub mod report;
mod seconds;
mod solution;
mod solve;
mod spherical;
mod start;
mod system;

pub(crate) use active_set::{ActiveSet, BorrowedMetric};
pub use cones::{AutoCones, auto_cones, with_cones_placed};
#[cfg(feature = "splines")]
pub(crate) use cones_within::outside_neighbourhoods;
pub use cones_within::{ConeLimits, cones_at, cones_within};
pub use jacobian::curvature_derivative;
pub use options::{Flips, Gradient, Method, Options, StepRule};
pub use outer::prescribed_curvature;
pub use report::{Obstruction, Report, StopReason, TraceRow};
pub use seconds::FlowSeconds;
pub use solution::Solution;

use crate::control::Control;
use crate::error::Result;
use crate::geometry::DoubleDouble;
use crate::mesh::{FixedEdges, FlipLog, PerVertex};
use crate::metric::{Class, Surface, Target};
use crate::parallel::Pool;
use memory::SolveMemory;
use std::ops::Deref;
use std::sync::Arc;
use system::NewtonSystem;

/// A surface in a conformal class, which flows to one target after the other. It keeps its factorisation and its threads; each solve
/// starts from the last metric that reached its target (at first from the given one).
///
/// With [`Flips::Auto`] the class is that of the surface's (weighted) Delaunay triangulation and edges are flipped inside it, so that
/// every admissible target is reached; a surface with boundary is solved on its double, whose metric is kept symmetric, since only
/// closed surfaces have that guarantee. Before that it is solved on one copy, for as long as no edge is to be flipped across the boundary;
/// surfaces that need no flips are solved there altogether. [`Solution::common_subdivision`] carries the result back to the given triangulation.
///
/// Edges stay as they are with [`Flips::Never`], and where flips play no part: in S², in the gradient flow, for Thurston's and
/// tangential packings (Delaunay on any triangulation). Between imaginary circles (virtual radii) an edge need not have another
/// diagonal: flips help there, without a guarantee. A surface with boundary and pinned vertices is not doubled: only its interior edges
/// are flipped.
///
/// A flow dereferences to its present metric, a [`Solution`]: the start, or the end of the last solve, converged or not.
pub struct Flow {
    now: Solution,
    /// u that solves start from, in double-double precision (high parts, low parts): that of the last solve that reached its target, or the
    /// one that was set.
    start: PerVertex<f64>,
    start_low: PerVertex<f64>,
    options: Options,
    /// True if edges may be flipped, by the options and the class.
    flips_allowed: bool,
    /// Edges of the present triangulation that are not flipped: those of the options, and their mirror images on a double.
    fixed: FixedEdges,
    pinned: Vec<bool>,
    /// True after a solve for [`Target::Outer`], which holds the boundary whatever the options say.
    holds_outer: bool,
    /// True if `pinned` is an active set, which changes between steps: then it stays in the matrix ([`active_set`]).
    is_bounded: bool,
    /// Per vertex its mirror image on a double, where the metric is kept symmetric.
    mirror: Option<Vec<u32>>,
    /// The flips of the present solve, for undoing it.
    log: FlipLog<DoubleDouble>,
    /// True while the flow is on one copy of a surface with boundary, because nothing has to be flipped across the boundary yet.
    one_copy: bool,
    /// The present solve's target per vertex of the present triangulation.
    target: PerVertex<f64>,
    system: Option<NewtonSystem>,
    /// True if a factor in f32 has been precise enough in this solve.
    single_serves: bool,
    /// Flips since `system` was made.
    unseen_flips: usize,
    memory: SolveMemory,
    pool: Arc<Pool>,
}

impl Deref for Flow {
    type Target = Solution;

    fn deref(&self) -> &Solution {
        &self.now
    }
}

/// The metric of a surface with prescribed curvature in a class: [`Flow::new`] and [`Flow::solve`].
///
/// Not reaching the target is no error: the report says so and why, and the metric is the last one. For several targets on one surface
/// keep a [`Flow`].
///
/// # Errors
/// Those of [`Flow::new`] and [`Flow::solve`].
pub fn flow(
    surface: Surface,
    class: Class,
    target: &Target,
    options: &Options,
    control: &Control,
) -> Result<Solution> {
    Flow::toward(target, surface, class, options, control)?.solve(target, control)
}
