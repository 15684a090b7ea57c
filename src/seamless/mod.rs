//! Seamless metrics: flat but at cones whose angles are multiples of 90°, with turning along loops that is a multiple of 90° too, so that a
//! grid of squares goes on across every seam \[CZ24\].
//!
//! ```
//! use ricci::seamless::{SeamlessOptions, seamless};
//! use ricci::{Control, Surface, mesh::shapes};
//! let torus = Surface::from_soup(&shapes::torus(2.0, 1.0, 24, 12)?)?;
//! let flat = seamless(&torus, &SeamlessOptions::default(), &Control::new())?;
//! assert!(flat.converged());
//! # Ok::<(), ricci::Error>(())
//! ```

mod aligned_field;
mod continuation;
mod corner_choice;
mod cross_field;
mod dual_loops;
mod face_axes;
mod field_guides;
mod holonomy_state;
mod least_norm;
mod left_out;
mod newton;
mod opening;
mod options;
mod sectors;
mod signature;
mod spin;
mod start;
mod turning_choice;

pub use aligned_field::{CrossField, FieldGuide};
pub use cross_field::field_cones;
pub use dual_loops::DualLoops;
pub use field_guides::{curvature_guides, sharp_edges, stroke_guides};
pub use options::{SeamlessCones, SeamlessOptions};
pub use signature::ConeValence;

use crate::archive::{ArchiveWriter, Stored, stored};
use crate::control::Control;
use crate::embed::{Layout, LayoutOptions};
use crate::error::{Error, Result, check_size};
use crate::flow::Solution;
use crate::mesh::{EdgeId, HalfedgeId, Mesh, PerVertex, VertexId};
use crate::metric::Surface;
use crate::parallel::Pool;
use continuation::reach_by_stages;
use holonomy_state::{HolonomyState, HolonomyTarget};
use left_out::without_worst;
use newton::{NewtonEnd, come_near};
use signature::{check_existence, cones_of_sectors};
pub use start::placed_cones;
use start::{chosen_right_angles, start_state};
use std::f64::consts::FRAC_PI_2;
use turning_choice::nearest_quarter_turns;

/// Rounds in which features are given up where a metric is not reached; after them all that are inside the surface.
const ROUNDS: usize = 6;

/// A metric whose angles around cones and along loops are multiples of 90°.
#[derive(Debug, Clone)]
pub struct Seamless {
    /// The metric on its triangulation, which is Delaunay but for features, with the way back to the surface. Its report is that of the
    /// conformal flow before it; none if that flow did not end and Newton's method began at the surface itself.
    pub solution: Solution,
    /// The cones and the corners of the boundary, by vertex: all angles add up around a vertex, on all sides of features.
    pub cones: Vec<ConeValence>,
    /// Paths whose turning decides that of all others, on the triangulation of the metric.
    pub loops: DualLoops,
    /// Turning of each path that was asked for, quarter turns.
    pub quarter_turns: Vec<i32>,
    /// The features that were kept and the edges of the boundary, on both triangulations.
    pub features: Vec<EdgeId>,
    /// The features that were asked for inside the surface and are not straight, ascending: those around pieces without room for right angles,
    /// and those near angles that were furthest off where the metric was not reached with all of them.
    pub left_out: Vec<EdgeId>,
    /// Steps of the conformal flow, and Newton steps after it.
    pub iterations: [usize; 2],
    /// Root mean square over the edges of the change of 2 ln ℓ, less its mean, from the surface to the metric before the isometric steps and
    /// after them; both the same without such steps.
    pub length_changes: [f64; 2],
    /// Largest deviation, radians, of the angle in a sector between features or around a vertex from its target, and of the turning of paths that
    /// were found anew, from another vertex, from multiples of 90°.
    pub error: f64,
    /// The tolerance that was asked for.
    pub tolerance: f64,
}
stored!(sections Seamless { solution, cones, loops, quarter_turns, features, left_out, iterations,
    length_changes, error, tolerance });

impl Seamless {
    /// A number by which this metric is told from others: the checksum of its triangulation and its u.
    pub fn fingerprint(&self) -> u64 {
        let mut writer = ArchiveWriter::default();
        Mesh::write(self.solution.mesh(), &mut writer);
        self.solution.metric().u.write(&mut writer);
        writer.fingerprint()
    }

    /// True if every angle is within the tolerance of its target.
    pub fn converged(&self) -> bool {
        self.error <= self.tolerance
    }

    /// The curvature that was asked for at each vertex, radians.
    pub fn target(&self) -> PerVertex<f64> {
        let mesh = self.solution.given();
        let regular = |v| if mesh.is_boundary_vertex(v) { 2.0 } else { 4.0 };
        let mut target = PerVertex::filled(mesh.n_vertices(), 0.0);
        for &ConeValence { vertex, valence } in &self.cones {
            target[vertex] = (regular(vertex) - f64::from(valence)) * FRAC_PI_2;
        }
        target
    }

    /// The map into the plane, cut through all cones, on the common subdivision with the surface as it came where edges were flipped. Its
    /// seams are exact, and edges of the boundary and features are parallel to an axis exactly ([`Layout::make_seams_exact`]).
    ///
    /// # Errors
    /// Those of [`Layout::of_solution`] and [`Layout::make_seams_exact`].
    pub fn map(&self, control: &Control) -> Result<SeamlessMap> {
        let given = self.solution.given();
        let cones = self.cones.iter().map(|cone| cone.vertex).filter(|&v| !given.is_boundary_vertex(v));
        let cones = Some(cones.collect());
        let options = LayoutOptions { cones, ..LayoutOptions::default() };
        let mut layout = Layout::of_solution(&self.solution, &options, control)?;
        let features = self.on_features(layout.mesh());
        if let Some(h) = features.first() {
            layout.align(*h)?;
        }
        let is_inner = |h: &&HalfedgeId| !layout.mesh().is_boundary_edge(h.edge());
        let inner: Vec<HalfedgeId> = features.iter().filter(is_inner).copied().collect();
        let moved = layout.make_seams_exact(&inner)?;
        let bend = self.bend(&layout);
        Ok(SeamlessMap { layout, moved, bend })
    }
}

impl Seamless {
    /// Half-edges of a triangulation with the surface's vertices first that lie on features and the boundary and have a face.
    fn on_features(&self, mesh: &Mesh) -> Vec<HalfedgeId> {
        let given = self.solution.given();
        let of_edge = |e: &EdgeId| {
            let [a, b] = given.ends(*e);
            let mut both = mesh.outgoing(a).filter(|&h| mesh.tip(h) == b);
            // Of several edges between the same vertices any may be the feature.
            let h = both.next().filter(|_| both.next().is_none())?;
            Some(if mesh.is_outside(h) { h.twin() } else { h })
        };
        self.features.iter().filter_map(of_edge).collect()
    }

    /// [`SeamlessMap::bend`].
    fn bend(&self, layout: &Layout) -> f64 {
        let mesh = layout.mesh();
        let off = |h: HalfedgeId| {
            let [a, b] = [layout.uv(h), layout.uv(mesh.next(h))];
            let turn = (b[1] - a[1]).atan2(b[0] - a[0]) / FRAC_PI_2;
            (turn - turn.round()).abs() * FRAC_PI_2
        };
        self.on_features(mesh).into_iter().map(off).fold(0.0, f64::max)
    }
}

/// The map of a seamless metric, whose seams are rotations by multiples of 90° and translations exactly.
#[derive(Debug, Clone)]
pub struct SeamlessMap {
    /// The map.
    pub layout: Layout,
    /// The largest distance by which a corner was moved to make the seams exact.
    pub moved: f64,
    /// The largest angle, radians, between an axis and an edge of the boundary or a feature; 0 without any.
    pub bend: f64,
}

/// A seamless metric of a surface near its conformal class: first the conformal metric with the cones, then least changes of the
/// logarithms of lengths, on the Delaunay triangulation, until the turning of 2g loops is what is asked for \[CZ24\]. Without loops, on a
/// sphere, the conformal metric is seamless itself.
///
/// Edges of the boundary and features become straight lines parallel to an axis between corners of multiples of 90°. They are not flipped:
/// angles between them are asked for one by one, and the turning of arcs between those that no feature joins. The flow then is only the
/// start, and where it breaks triangles at features Newton's method begins at the surface itself. Where that is not reached with the cones
/// of the field, features near the angles that are furthest off are given up, a few lines at a time ([`Seamless::left_out`]).
///
/// Not reaching the target is no error: [`Seamless::converged`] is false then, and nothing is claimed of whether such a metric exists.
///
/// # Errors
/// [`Error::TargetKind`] for cones that no metric has, and signatures that are known to be impossible (genus 1 and 2); [`Error::Argument`]
/// for a tolerance that is not positive, features or guides that do not exist, sizes that are not positive, and a choice of cones that does
/// not fit a boundary or features; [`Error::Size`] for quarter turns of another number than paths, and sizes of another than vertices;
/// those of [`crate::Flow::solve`]; [`Error::Cancelled`].
pub fn seamless(surface: &Surface, options: &SeamlessOptions, control: &Control) -> Result<Seamless> {
    if options.tolerance.is_nan() || options.tolerance <= 0.0 {
        return Err(Error::argument("tolerance", options.tolerance, "positive"));
    }
    Pool::new(options.threads)?.run(|| {
        let mut features = options.features.clone();
        let may_leave_out = options.cones == SeamlessCones::Field && options.quarter_turns.is_none();
        let mut round = 0;
        loop {
            let (mut found, next) = attempt(surface, &features, options, control)?;
            match next {
                Some(fewer) if may_leave_out => {
                    features = if round < ROUNDS { fewer } else { Vec::new() };
                    round += 1;
                }
                _ => {
                    found.left_out = left_out(surface.mesh(), &options.features, &found.features);
                    return Ok(found);
                }
            }
        }
    })
}

/// The edges inside a surface that are in a list and not in another, which is sorted; ascending.
fn left_out(mesh: &Mesh, asked: &[EdgeId], kept: &[EdgeId]) -> Vec<EdgeId> {
    let is_left = |e: &EdgeId| !mesh.is_boundary_edge(*e) && kept.binary_search(e).is_err();
    let mut left: Vec<EdgeId> = asked.iter().copied().filter(is_left).collect();
    left.sort_unstable();
    left.dedup();
    left
}

/// One way to a seamless metric, with these features. Where it is not reached, and some are inside the surface, also those to go on with.
fn attempt(
    surface: &Surface,
    features: &[EdgeId],
    options: &SeamlessOptions,
    control: &Control,
) -> Result<(Seamless, Option<Vec<EdgeId>>)> {
    let (sectors, right_angles) = chosen_right_angles(surface, features, options, &control.part(0.0, 0.3))?;
    let (start, state) = start_state(surface, sectors, &right_angles, options, &control.part(0.3, 0.5))?;
    let radians = |k: &i32| f64::from(*k) * FRAC_PI_2;
    let mut target =
        HolonomyTarget { angles: right_angles.iter().map(radians).collect(), turning: Vec::new() };
    let quarter_turns = match &options.quarter_turns {
        Some(turns) => {
            check_size("quarter turns", turns.len(), state.loops.len())?;
            turns.clone()
        }
        None => nearest_quarter_turns(&state, &target)?,
    };
    if state.sectors.are_vertices() {
        check_existence(&state.mesh, &state.loops, &right_angles, &quarter_turns)?;
    }
    target.turning = quarter_turns.iter().map(radians).collect();
    let steps = start.report().map_or(0, |report| report.iterations);
    let is_flow_enough = state.sectors.are_vertices() && quarter_turns.is_empty();
    let mut end = if is_flow_enough {
        NewtonEnd { state, iterations: 0 }
    } else {
        reach_by_stages(state, &target, options, &control.part(0.5, 0.9))?
    };
    let before = end.state.length_change()?;
    let mut next = None;
    if deviation(&end.state, &target) <= options.tolerance {
        end = come_near(end, &target, options.isometric_steps, &control.part(0.9, 1.0))?;
    } else if !end.state.sectors.inner_features(&end.state.mesh).is_empty() {
        next = Some(without_worst(&end.state, &target));
    }
    let (error, length_changes) = (deviation(&end.state, &target), [before, end.state.length_change()?]);
    let HolonomyState { mesh, metric, followed, loops, flips, sectors, .. } = end.state;
    let found = Seamless {
        solution: start.at(mesh, metric, followed, flips),
        cones: cones_of_sectors(surface.mesh(), &sectors, &right_angles),
        loops,
        quarter_turns,
        features: sectors.features(),
        left_out: Vec::new(),
        iterations: [steps, end.iterations],
        length_changes,
        error,
        tolerance: options.tolerance,
    };
    Ok((found, next))
}

/// [`Seamless::error`].
fn deviation(state: &HolonomyState, target: &HolonomyTarget) -> f64 {
    let around =
        state.sector_angles().into_iter().zip(&target.angles).map(|(is, wanted)| (is - wanted).abs());
    let asked = state.turning().into_iter().zip(&target.turning).map(|(is, wanted)| (is - wanted).abs());
    let last = VertexId::from(state.mesh.n_vertices() - 1);
    let others = DualLoops::between(&state.mesh, &state.sectors, last);
    let others = others.turning(&state.mesh, &state.halfedge_angles());
    let off = others.iter().map(|turning| turning - FRAC_PI_2 * (turning / FRAC_PI_2).round()).map(f64::abs);
    let broken = if state.is_broken { f64::INFINITY } else { 0.0 };
    around.chain(asked).chain(off).fold(broken, f64::max)
}
