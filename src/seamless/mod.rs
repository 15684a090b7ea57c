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

mod cross_field;
mod dual_loops;
mod holonomy_state;
mod least_norm;
mod newton;
mod signature;
mod turning_choice;

pub use cross_field::field_cones;
pub use dual_loops::DualLoops;
pub use signature::ConeValence;

use crate::control::Control;
use crate::embed::{Layout, LayoutOptions};
use crate::error::{Error, Result, check_size};
use crate::flow::{Flow, Options, Solution, auto_cones};
use crate::geometry::Space;
use crate::mesh::{Mesh, PerVertex, VertexId};
use crate::metric::{Class, Surface, Target};
use crate::parallel::Pool;
use holonomy_state::{HolonomyState, HolonomyTarget};
use newton::{NewtonEnd, reach_holonomy};
use signature::{MOST_CURVED, check_existence, cones_of_curvature, curvature_of_cones};
use std::f64::consts::FRAC_PI_2;
use turning_choice::nearest_quarter_turns;

/// The way in which the cones of a seamless metric are chosen.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum SeamlessCones {
    /// Those of the smoothest field of four directions.
    #[default]
    Field,
    /// This many, placed so that areas change little ([`auto_cones`]), with their curvature rounded to quarter turns. The total is kept by
    /// those that rounding changes most.
    Auto(usize),
    /// These; any other vertex is regular. The sum of 4 − valence is 4χ.
    Valences(Vec<ConeValence>),
}

/// Options of [`seamless`].
#[derive(Debug, Clone, PartialEq)]
pub struct SeamlessOptions {
    /// The cones.
    pub cones: SeamlessCones,
    /// The turning of each loop in quarter turns, of the loops that [`DualLoops::new`] finds from vertex 0 on the triangulation of the
    /// conformal metric with these cones. Default: the nearest to that metric's, in the energy of the field that turns by the difference.
    pub quarter_turns: Option<Vec<i32>>,
    /// Largest deviation of an angle, around a vertex or along a loop, from the target, radians. Default 1e-10.
    pub tolerance: f64,
    /// Most Newton steps after the conformal flow. Default 100.
    pub max_iterations: usize,
    /// Number of threads; 0 (default) is one for each core. The result does not depend on it.
    pub threads: usize,
}

impl Default for SeamlessOptions {
    fn default() -> Self {
        let cones = SeamlessCones::Field;
        SeamlessOptions { cones, quarter_turns: None, tolerance: 1e-10, max_iterations: 100, threads: 0 }
    }
}

/// A metric whose angles around cones and along loops are multiples of 90°.
#[derive(Debug, Clone)]
pub struct Seamless {
    /// The metric on its Delaunay triangulation, with the way back to the surface. Its report is that of the conformal flow before it.
    pub solution: Solution,
    /// The cones, by vertex.
    pub cones: Vec<ConeValence>,
    /// Loops that generate the homology, on the triangulation of the metric.
    pub loops: DualLoops,
    /// Turning of each loop that was asked for, quarter turns.
    pub quarter_turns: Vec<i32>,
    /// Steps of the conformal flow, and Newton steps after it.
    pub iterations: [usize; 2],
    /// Largest deviation, radians, of the angle around a vertex from its target, and of the turning of loops that were found anew, from another
    /// vertex, from multiples of 90°.
    pub error: f64,
    /// The tolerance that was asked for.
    pub tolerance: f64,
}

impl Seamless {
    /// True if every angle is within the tolerance of its target.
    pub fn converged(&self) -> bool {
        self.error <= self.tolerance
    }

    /// The map into the plane, cut through all cones, on the common subdivision with the surface as it came where edges were flipped. Its
    /// seams are exact ([`Layout::make_seams_exact`]).
    ///
    /// # Errors
    /// Those of [`Layout::of_solution`] and [`Layout::make_seams_exact`].
    pub fn map(&self, control: &Control) -> Result<SeamlessMap> {
        let cones = Some(self.cones.iter().map(|cone| cone.vertex).collect());
        let options = LayoutOptions { cones, ..LayoutOptions::default() };
        let mut layout = Layout::of_solution(&self.solution, &options, control)?;
        let moved = layout.make_seams_exact()?;
        Ok(SeamlessMap { layout, moved })
    }
}

/// The map of a seamless metric, whose seams are rotations by multiples of 90° and translations exactly.
#[derive(Debug, Clone)]
pub struct SeamlessMap {
    /// The map.
    pub layout: Layout,
    /// The largest distance by which a corner was moved to make the seams exact.
    pub moved: f64,
}

/// A seamless metric of a closed surface near its conformal class: first the conformal metric with the cones, then least changes of the
/// logarithms of lengths, on the Delaunay triangulation, until the turning of 2g loops is what is asked for \[CZ24\]. Without loops, on a
/// sphere, the conformal metric is seamless itself.
///
/// Not reaching the target is no error: [`Seamless::converged`] is false then, and nothing is claimed of whether such a metric exists.
///
/// # Errors
/// [`Error::TargetKind`] for cones that no metric has, and signatures that are known to be impossible (genus 1 and 2); [`Error::Argument`]
/// for a surface with boundary or a tolerance that is not positive; [`Error::Size`] for quarter turns of another number than 2g; those of
/// [`Flow::solve`]; [`Error::Cancelled`].
pub fn seamless(surface: &Surface, options: &SeamlessOptions, control: &Control) -> Result<Seamless> {
    let mesh = surface.mesh();
    if !mesh.is_closed() {
        return Err(Error::argument("surface", "one with boundary", "closed, for a seamless metric"));
    }
    if options.tolerance.is_nan() || options.tolerance <= 0.0 {
        return Err(Error::argument("tolerance", options.tolerance, "positive"));
    }
    Pool::new(options.threads)?.run(|| {
        let curvature = chosen_cones(surface, &options.cones, control)?;
        let conformal = conformal_metric(surface, &curvature, options, control)?;
        let (mesh, metric, followed) = conformal.parts();
        let loops = DualLoops::new(&mesh, VertexId(0))?;
        let state = HolonomyState::new(mesh, metric, followed, loops)?;
        let quarter_turns = match &options.quarter_turns {
            Some(turns) => {
                check_size("quarter turns", turns.len(), state.loops.len())?;
                turns.clone()
            }
            None => nearest_quarter_turns(&state)?,
        };
        check_existence(surface.mesh().genus(), &curvature, &quarter_turns)?;
        let radians = |k: &i32| f64::from(*k) * FRAC_PI_2;
        let target = HolonomyTarget {
            curvature: curvature.iter().map(radians).collect::<Vec<_>>().into(),
            turning: quarter_turns.iter().map(radians).collect(),
        };
        let steps = conformal.report().map_or(0, |report| report.iterations);
        let end = if quarter_turns.is_empty() {
            NewtonEnd { state, iterations: 0 }
        } else {
            reach_holonomy(state, &target, options.max_iterations, control)?
        };
        let error = deviation(&end.state, &target)?;
        let HolonomyState { mesh, metric, followed, loops, flips, .. } = end.state;
        Ok(Seamless {
            solution: conformal.at(mesh, metric, followed, flips),
            cones: cones_of_curvature(&curvature),
            loops,
            quarter_turns,
            iterations: [steps, end.iterations],
            error,
            tolerance: options.tolerance,
        })
    })
}

/// The curvature per vertex in quarter turns.
fn chosen_cones(surface: &Surface, cones: &SeamlessCones, control: &Control) -> Result<PerVertex<i32>> {
    let mesh = surface.mesh();
    match cones {
        SeamlessCones::Field => {
            let curvature = field_cones(surface, control)?;
            curvature_of_cones(mesh, &cones_of_curvature(&curvature))
        }
        SeamlessCones::Auto(n) => {
            let placed = auto_cones(mesh, surface.lengths(), *n, control)?;
            let curvature = rounded_to_quarters(mesh, &placed.cones);
            curvature_of_cones(mesh, &cones_of_curvature(&curvature))
        }
        SeamlessCones::Valences(cones) => curvature_of_cones(mesh, cones),
    }
}

/// Curvature of cones rounded to quarter turns such that the total is 4χ and no angle is below 90°.
fn rounded_to_quarters(mesh: &Mesh, cones: &[(VertexId, f64)]) -> PerVertex<i32> {
    let exact = |k: usize| cones[k].1 / FRAC_PI_2;
    let mut quarters: Vec<i32> =
        (0..cones.len()).map(|k| (exact(k).round() as i32).min(MOST_CURVED)).collect();
    loop {
        let missing = 4 * mesh.euler() - quarters.iter().map(|&k| i64::from(k)).sum::<i64>();
        let step = missing.signum() as i32;
        let off = |k: &usize| f64::from(step) * (exact(*k) - f64::from(quarters[*k]));
        let most = (0..cones.len())
            .filter(|&k| quarters[k] + step <= MOST_CURVED)
            .max_by(|a, b| off(a).total_cmp(&off(b)));
        match most {
            Some(k) if step != 0 => quarters[k] += step,
            _ => break,
        }
    }
    let mut curvature = PerVertex::filled(mesh.n_vertices(), 0);
    cones.iter().zip(&quarters).for_each(|(cone, &k)| curvature[cone.0] = k);
    curvature
}

/// The conformal metric with these cones.
fn conformal_metric(
    surface: &Surface,
    curvature: &PerVertex<i32>,
    options: &SeamlessOptions,
    control: &Control,
) -> Result<Solution> {
    let cones = cones_of_curvature(curvature);
    let radians = |cone: &ConeValence| (cone.vertex, (4.0 - f64::from(cone.valence)) * FRAC_PI_2);
    let target = Target::Cones(cones.iter().map(radians).collect());
    let flow_options =
        Options { tolerance: options.tolerance, threads: options.threads, ..Options::default() };
    Flow::new(surface.clone(), Class::yamabe(Space::E2), &flow_options, control)?.solve(&target, control)
}

/// [`Seamless::error`].
fn deviation(state: &HolonomyState, target: &HolonomyTarget) -> Result<f64> {
    let curvature = state.curvature();
    let around = curvature.iter().zip(target.curvature.iter()).map(|(is, wanted)| (is - wanted).abs());
    let asked = state.turning().into_iter().zip(&target.turning).map(|(is, wanted)| (is - wanted).abs());
    let last = VertexId::from(state.mesh.n_vertices() - 1);
    let others = DualLoops::new(&state.mesh, last)?.turning(&state.mesh, &state.halfedge_angles());
    let off = others.iter().map(|turning| turning - FRAC_PI_2 * (turning / FRAC_PI_2).round()).map(f64::abs);
    Ok(around.chain(asked).chain(off).fold(0.0, f64::max))
}
