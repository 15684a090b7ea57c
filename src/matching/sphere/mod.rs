//! Spheres with fewer than three landmarks: both go to the unit sphere. Without landmarks one is turned until its conformal factor fits the
//! other's best; with one it is turned about that, and with two it goes by a Möbius transformation that brings both to their partners.

use super::axis::{Around, best_turn, centre};
use super::balance::BalanceReport;
use super::canonical::not_found;
use super::cover::{Cover, Placed};
use super::density::{Factors, factors};
use super::options::MatchOptions;
use super::orbifold::Pair;
use super::repair::unfold;
use super::route::Marks;
use super::turn::{Density, IDENTITY, turnings};
use super::walk::{Seed, locate};
use super::weights::mean_value_weights;
use crate::canonical::{SphereOptions, uniformize_sphere};
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::Space;
use crate::geometry::complex::{Complex, conj, mul, norm2, scale};
use crate::geometry::vector::{Vector, cross, dot, norm, normalised, sub, triangle_normal};
use crate::mesh::{HalfedgeId, PerVertex, VertexId};
use crate::metric::Surface;
use crate::parallel::join;

/// Both triangulations on one unit sphere: harmonic maps of spheres are Möbius transformations, and both are centred, so that a rotation is
/// left to find.
///
/// # Errors
/// [`Error::Matching`] where a flow does not come to its target or a fold cannot be opened; those of [`uniformize_sphere`];
/// [`Error::Cancelled`].
pub(super) fn on_sphere(
    surfaces: [&Surface; 2],
    marks: [&Marks; 2],
    options: &MatchOptions,
    control: &Control,
) -> Result<Pair> {
    let own = |s: usize| in_own_sphere(surfaces[s], options, control);
    let (source, target) = join(|| own(0), || own(1));
    let ((mut source, first), (target, second)) = (source?, target?);
    if !marks[0].landmarks.is_empty() {
        let source = about_landmarks(surfaces, marks, [&source, &target], control)?;
        return Ok(pair([source, target], [first, second]));
    }
    let points = [&source, &target].map(positions);
    let densities = [0, 1].map(|s| density(surfaces[s], &points[s]));
    let mut best: Option<(f64, Placed)> = None;
    for turn in turnings([&densities[0], &densities[1]])? {
        control.check()?;
        let mut turned = source.clone();
        let rotate = |p: Vector| turn.map(|row| dot(row, p));
        if turn != IDENTITY {
            turned.at = PerVertex::from_fn(points[0].len(), |v: VertexId| {
                Placed::frame(Space::S2, rotate(points[0][v.index()]))
            });
        }
        let seed = seed(&turned, &points[1], &target);
        let places = match locate(&turned, &target, seed, control) {
            Ok((places, _)) => places,
            Err(Error::Cancelled) => return Err(Error::Cancelled),
            // Another rotation may do.
            Err(_) => continue,
        };
        let carried = places.iter().map(|place| {
            let corners = target.cover.mesh.face_vertices(place.face);
            (0..3).map(|k| place.weights[k] * densities[1].values[corners[k].index()]).sum::<f64>()
        });
        let off = carried.zip(&densities[0].values).zip(&densities[0].weights);
        let off: f64 = off.map(|((a, b), w)| w * (a - b) * (a - b)).sum();
        if best.as_ref().is_none_or(|(least, ..)| off < *least) {
            best = Some((off, turned));
        }
    }
    let Some((_, turned)) = best else {
        return Err(Error::Matching("no rotation of the sphere was found".into()));
    };
    source = turned;
    Ok(pair([source, target], [first, second]))
}

fn pair([source, target]: [Placed; 2], flow_iterations: [usize; 2]) -> Pair {
    let seeds = [seed(&source, &positions(&target), &target), seed(&target, &positions(&source), &source)];
    let reports = [BalanceReport::default(); 2];
    Pair { source, target, seeds, reports, flow_iterations, markings: 1 }
}

/// The sphere seen from a landmark: this at the pole, the second one, if there is one, at infinity of the plane into which the sphere is
/// projected from the other pole.
struct View {
    /// By rows: two axes of the plane, and the landmark.
    axes: [Vector; 3],
    /// The second landmark in the plane, if it is not the other pole.
    far: Option<Complex>,
}

fn div(z: Complex, w: Complex) -> Complex {
    scale(1.0 / norm2(w), mul(z, conj(w)))
}

/// Height above the other pole below which a point counts as it.
const AT_POLE: f64 = 1e-14;

impl View {
    fn new(points: &[Vector], landmarks: &[VertexId]) -> Option<View> {
        let pole = points[landmarks.first()?.index()];
        let side = if pole[2].abs() < 0.9 { [0.0, 0.0, 1.0] } else { [1.0, 0.0, 0.0] };
        let first = normalised(cross(side, pole));
        let mut view = View { axes: [first, cross(pole, first), pole], far: None };
        view.far = landmarks.get(1).and_then(|v| view.projected(points[v.index()]));
        Some(view)
    }

    /// In the plane, the second landmark still where it is.
    fn projected(&self, p: Vector) -> Option<Complex> {
        let [x, y, w] = self.axes.map(|axis| dot(axis, p));
        (1.0 + w > AT_POLE).then(|| [x / (1.0 + w), y / (1.0 + w)])
    }

    /// In the plane, the second landmark at infinity: `z/(1 − z/far)`; `None` at infinity.
    fn seen(&self, p: Vector) -> Option<Complex> {
        let at = match (self.projected(p), self.far) {
            (Some(z), None) => z,
            (Some(z), Some(far)) => {
                let [x, y] = div(z, far);
                div(z, [1.0 - x, -y])
            }
            (None, far) => far.map(|far| far.map(|x| -x))?,
        };
        at.iter().all(|x| x.is_finite()).then_some(at)
    }

    /// The point of the sphere that is seen there.
    fn point(&self, z: Complex) -> Vector {
        let z = self.far.map_or(z, |far| {
            let [x, y] = div(z, far);
            div(z, [1.0 + x, y])
        });
        let square = z[0] * z[0] + z[1] * z[1];
        let [x, y, w] =
            [2.0 * z[0] / (1.0 + square), 2.0 * z[1] / (1.0 + square), (1.0 - square) / (1.0 + square)];
        let p = [0, 1, 2].map(|i| x * self.axes[0][i] + y * self.axes[1][i] + w * self.axes[2][i]);
        if p.iter().all(|c| c.is_finite()) { normalised(p) } else { self.axes[2].map(|c| -c) }
    }
}

/// The source on the sphere with its one or two landmarks at their partners. Two leave a change of size about them, which centres the area
/// between them; both leave a turn, by which the areas fit best.
///
/// # Errors
/// [`Error::Matching`] where a fold cannot be opened.
fn about_landmarks(
    surfaces: [&Surface; 2],
    marks: [&Marks; 2],
    [source, target]: [&Placed; 2],
    control: &Control,
) -> Result<Placed> {
    let points = [source, target].map(positions);
    let weights = [0, 1].map(|s| density(surfaces[s], &points[s]).weights);
    let views = [0, 1].map(|s| View::new(&points[s], &marks[s].landmarks));
    let [Some(own), Some(other)] = views else {
        return Err(Error::Matching("no landmark on the sphere".into()));
    };
    let is_two = marks[0].landmarks.len() > 1;
    let about = |view: &View, s: usize| -> (f64, Vec<Around>) {
        // A landmark has no direction from itself.
        let others = surfaces[s].mesh().vertices().filter(|v| !marks[s].landmarks.contains(v));
        let seen = others.filter_map(|v| Some((view.seen(points[s][v.index()])?, weights[s][v.index()])));
        let seen: Vec<(f64, f64, f64)> = seen
            .map(|([x, y], w)| (x.hypot(y).ln(), y.atan2(x), w))
            .filter(|(size, ..)| size.is_finite())
            .collect();
        let sizes: Vec<(f64, f64)> = seen.iter().map(|&(size, _, w)| (size, w)).collect();
        let size = if is_two { centre(&sizes) } else { 0.0 };
        (size, seen.into_iter().map(|(x, angle, w)| (0.5 + 0.5 * (x - size).tanh(), angle, w)).collect())
    };
    let ((size, from), (other_size, to)) = (about(&own, 0), about(&other, 1));
    let (sin, cos) = best_turn(&from, &to).sin_cos();
    let factor = [cos, sin].map(|x| x * (other_size - size).exp());
    let mesh_weights = mean_value_weights(source, surfaces[0]);
    let mut image = source.clone();
    image.at = PerVertex::from_fn(points[0].len(), |v: VertexId| {
        let seen = own.seen(points[0][v.index()]).map(|z| other.point(mul(factor, z)));
        Placed::frame(Space::S2, seen.unwrap_or_else(|| other.point([f64::INFINITY; 2])))
    });
    for (&from, &to) in marks[0].landmarks.iter().zip(&marks[1].landmarks) {
        image.at[from] = target.at[to];
    }
    unfold(&mut image, &mesh_weights, &marks[0].landmarks, control)?;
    Ok(image)
}

/// A surface as its own triangulation on its unit sphere, folds opened, and the steps of the flow.
fn in_own_sphere(surface: &Surface, options: &MatchOptions, control: &Control) -> Result<(Placed, usize)> {
    let flow = &options.flow;
    let wanted = SphereOptions {
        tolerance: flow.tolerance,
        max_iterations: flow.max_iterations,
        puncture: None,
        threads: flow.threads,
    };
    let sphere = uniformize_sphere(surface, &wanted, control)?;
    if !sphere.report.converged {
        return Err(not_found(sphere.report.iterations, sphere.report.stop_reason));
    }
    let cover = Cover::new(surface.mesh(), Space::S2, |_| None, &[])?;
    let at = PerVertex::from_fn(sphere.positions.len(), |v: VertexId| {
        Placed::frame(Space::S2, sphere.positions[v])
    });
    let mut placed = Placed { cover, at };
    let weights = mean_value_weights(&placed, surface);
    unfold(&mut placed, &weights, &[], control)?;
    Ok((placed, sphere.report.iterations))
}

fn positions(placed: &Placed) -> Vec<Vector> {
    placed.at.iter().map(|frame| normalised(frame.origin().map(f64::from))).collect()
}

/// The conformal factor at the vertices of a surface on the sphere.
fn density(surface: &Surface, points: &[Vector]) -> Density {
    let round = |f| 0.5 * norm(triangle_normal(surface.mesh().face_vertices(f).map(|v| points[v.index()])));
    let Factors { values, weights } = factors(surface, round);
    Density { values, points: points.to_vec(), weights }
}

/// The first vertex of the points, and the target's vertex nearest to it.
fn seed(points: &Placed, at: &[Vector], target: &Placed) -> Seed {
    let start = points.at[VertexId(0)].origin().map(f64::from);
    let off = |p: &Vector| dot(sub(*p, start), sub(*p, start));
    let nearest = (0..at.len()).min_by(|&i, &j| off(&at[i]).total_cmp(&off(&at[j]))).unwrap_or(0);
    let near: HalfedgeId = target.cover.own(VertexId::from(nearest));
    Seed { vertex: VertexId(0), near }
}
