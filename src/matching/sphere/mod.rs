//! Spheres with fewer than three landmarks: both surfaces go to the unit sphere, where harmonic maps are Möbius transformations.
//!
//! Without landmarks the source is rotated until its conformal factor fits the target's best. One landmark is brought to its partner by a
//! rotation, and two by a Möbius transformation; of those that remain the one is taken by which the conformal factors fit best.

mod rotations;

use super::balance::{BalanceReport, mean_value_weights, unfold};
use super::canonical::{for_both, not_found};
use super::cover::{PlacedMesh, UniversalCover, WalkSeed, locate};
use super::domain_pair::DomainPair;
use super::fit::{ConformalFactors, PolarSample, best_turn, centre, factors};
use super::landmarks::MarkedSurface;
use super::least_energy::LeastEnergy;
use super::options::MatchOptions;
use crate::canonical::{SphereOptions, uniformize_sphere};
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::Space;
use crate::geometry::complex::{Complex, conj, mul, norm2, scale};
use crate::geometry::vector::{Vector, cross, dot, norm, normalised, sub, triangle_normal};
use crate::mesh::{HalfedgeId, PerVertex, Place, VertexId};
use crate::metric::Surface;
use rotations::{IDENTITY, SphereSamples, turnings};

/// Both triangulations on one unit sphere.
///
/// # Errors
/// [`Error::Matching`] if a flow does not reach its target or a fold cannot be opened; those of [`uniformize_sphere`];
/// [`Error::Cancelled`].
pub(super) fn on_sphere(
    sides: [MarkedSurface; 2],
    options: &MatchOptions,
    control: &Control,
) -> Result<DomainPair> {
    let [(source, first), (target, second)] =
        for_both(|s| on_unit_sphere(sides[s].surface, options, control))?;
    let source = if sides[0].marks.landmarks.is_empty() {
        best_rotated(sides.map(|side| side.surface), [&source, &target], control)?
    } else {
        about_landmarks(sides, [&source, &target], control)?
    };
    let seeds = [seed(&source, &positions(&target), &target), seed(&target, &positions(&source), &source)];
    let reports = [BalanceReport::default(); 2];
    Ok(DomainPair { source, target, seeds, reports, flow_iterations: [first, second], markings: 1 })
}

/// The source after the rotation by which its conformal factor fits the target's best. Both are centred, so that a rotation is all that is
/// left to find.
fn best_rotated(
    surfaces: [&Surface; 2],
    [source, target]: [&PlacedMesh; 2],
    control: &Control,
) -> Result<PlacedMesh> {
    let points = [source, target].map(positions);
    let densities = [0, 1].map(|s| samples(surfaces[s], &points[s]));
    control.check()?;
    let mut least = LeastEnergy::new(f64::NEG_INFINITY);
    for turn in turnings([&densities[0], &densities[1]], control)? {
        control.check()?;
        let mut turned = source.clone();
        let rotate = |p: Vector| turn.map(|row| dot(row, p));
        if turn != IDENTITY {
            turned.at = PerVertex::from_fn(points[0].len(), |v: VertexId| {
                PlacedMesh::frame(Space::S2, rotate(points[0][v.index()]))
            });
        }
        let seed = seed(&turned, &points[1], target);
        let difference = |(places, _): (Vec<Place>, f64)| {
            let carried = places.iter().map(|place| {
                let corners = target.cover.mesh.face_vertices(place.face);
                (0..3).map(|k| place.weights[k] * densities[1].values[corners[k].index()]).sum::<f64>()
            });
            let off = carried.zip(&densities[0].values).zip(&densities[0].weights);
            off.map(|((a, b), w)| w * (a - b) * (a - b)).sum()
        };
        let off = locate(&turned, target, seed, control).map(difference);
        least.offer(off.map(|off| (off, turned)))?;
    }
    least.into_best("no rotation of the sphere was found")
}

/// The stereographic projection of the sphere that has a landmark at the origin of the plane and the second landmark, if there is one, at
/// infinity.
struct LandmarkProjection {
    /// By rows: two axes of the plane, and the landmark.
    axes: [Vector; 3],
    /// The second landmark in the plane of the projection from the antipode of the first; `None` if it is this antipode.
    far: Option<Complex>,
}

fn div(z: Complex, w: Complex) -> Complex {
    scale(1.0 / norm2(w), mul(z, conj(w)))
}

/// Height above the antipode of the first landmark below which a point counts as the antipode: rounding.
const AT_POLE: f64 = 1e-14;

impl LandmarkProjection {
    fn new(points: &[Vector], landmarks: &[VertexId]) -> Option<LandmarkProjection> {
        let pole = points[landmarks.first()?.index()];
        let side = if pole[2].abs() < 0.9 { [0.0, 0.0, 1.0] } else { [1.0, 0.0, 0.0] };
        let first = normalised(cross(side, pole));
        let mut view = LandmarkProjection { axes: [first, cross(pole, first), pole], far: None };
        view.far = landmarks.get(1).and_then(|v| view.projected(points[v.index()]));
        Some(view)
    }

    /// The point in the plane of the projection from the antipode of the first landmark; `None` for this antipode.
    fn projected(&self, p: Vector) -> Option<Complex> {
        let [x, y, w] = self.axes.map(|axis| dot(axis, p));
        (1.0 + w > AT_POLE).then(|| [x / (1.0 + w), y / (1.0 + w)])
    }

    /// The point in the plane with the second landmark at infinity, `z/(1 − z/far)`; `None` for the second landmark.
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

    /// The point of the sphere that is projected to z: the inverse of [`LandmarkProjection::seen`].
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

/// The source on the sphere with its one or two landmarks at their partners. A rotation about the landmarks remains free; the one is taken
/// by which the areas fit best. With two landmarks a scaling about them remains free too; the one is taken that balances the area between
/// them.
///
/// # Errors
/// [`Error::Matching`] if a fold cannot be opened.
fn about_landmarks(
    sides: [MarkedSurface; 2],
    [source, target]: [&PlacedMesh; 2],
    control: &Control,
) -> Result<PlacedMesh> {
    let points = [source, target].map(positions);
    let weights = [0, 1].map(|s| samples(sides[s].surface, &points[s]).weights);
    let landmarks = sides.map(|side| &side.marks.landmarks);
    let projections = [0, 1].map(|s| LandmarkProjection::new(&points[s], landmarks[s]));
    let [Some(own), Some(other)] = projections else {
        return Err(Error::Matching("no landmark on the sphere".into()));
    };
    let is_two = landmarks[0].len() > 1;
    let about = |projection: &LandmarkProjection, s: usize| -> (f64, Vec<PolarSample>) {
        // A landmark has no direction from itself.
        let others = sides[s].surface.mesh().vertices().filter(|v| !landmarks[s].contains(v));
        let seen =
            others.filter_map(|v| Some((projection.seen(points[s][v.index()])?, weights[s][v.index()])));
        // With the logarithm of the distance from the origin of the plane.
        let seen: Vec<PolarSample> = seen
            .map(|([x, y], share)| PolarSample { distance: x.hypot(y).ln(), angle: y.atan2(x), share })
            .filter(|sample| sample.distance.is_finite())
            .collect();
        let sizes: Vec<(f64, f64)> = seen.iter().map(|sample| (sample.distance, sample.share)).collect();
        let size = if is_two { centre(&sizes) } else { 0.0 };
        let on_sphere = |sample: PolarSample| {
            let distance = 0.5 + 0.5 * (sample.distance - size).tanh();
            PolarSample { distance, ..sample }
        };
        (size, seen.into_iter().map(on_sphere).collect())
    };
    let ((size, from), (other_size, to)) = (about(&own, 0), about(&other, 1));
    let (sin, cos) = best_turn(&from, &to).sin_cos();
    let factor = [cos, sin].map(|x| x * (other_size - size).exp());
    let mesh_weights = mean_value_weights(source, sides[0].surface, control)?;
    let mut image = source.clone();
    image.at = PerVertex::from_fn(points[0].len(), |v: VertexId| {
        let seen = own.seen(points[0][v.index()]).map(|z| other.point(mul(factor, z)));
        PlacedMesh::frame(Space::S2, seen.unwrap_or_else(|| other.point([f64::INFINITY; 2])))
    });
    for (&from, &to) in landmarks[0].iter().zip(landmarks[1]) {
        image.at[from] = target.at[to];
    }
    unfold(&mut image, &mesh_weights, landmarks[0], control)?;
    Ok(image)
}

/// The triangulation of a surface on its unit sphere, folds opened, and the steps of the flow.
fn on_unit_sphere(
    surface: &Surface,
    options: &MatchOptions,
    control: &Control,
) -> Result<(PlacedMesh, usize)> {
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
    let cover = UniversalCover::new(surface.mesh(), Space::S2, |_| None, &[])?;
    let at = PerVertex::from_fn(sphere.positions.len(), |v: VertexId| {
        PlacedMesh::frame(Space::S2, sphere.positions[v])
    });
    let mut placed = PlacedMesh { cover, at };
    let weights = mean_value_weights(&placed, surface, control)?;
    control.check()?;
    unfold(&mut placed, &weights, &[], control)?;
    Ok((placed, sphere.report.iterations))
}

fn positions(placed: &PlacedMesh) -> Vec<Vector> {
    placed.at.iter().map(|frame| normalised(frame.origin().map(f64::from))).collect()
}

/// The conformal factor at the vertices of a surface on the sphere, and their shares of its area.
fn samples(surface: &Surface, points: &[Vector]) -> SphereSamples {
    let round = |f| 0.5 * norm(triangle_normal(surface.mesh().face_vertices(f).map(|v| points[v.index()])));
    let ConformalFactors { values, weights } = factors(surface, round);
    SphereSamples { values, points: points.to_vec(), weights }
}

/// The start of the search for the vertices of `points`: their first one, and the vertex of the target, at the positions `at`, nearest to
/// it.
fn seed(points: &PlacedMesh, at: &[Vector], target: &PlacedMesh) -> WalkSeed {
    let start = points.at[VertexId(0)].origin().map(f64::from);
    let off = |p: &Vector| dot(sub(*p, start), sub(*p, start));
    let nearest = (0..at.len()).min_by(|&i, &j| off(&at[i]).total_cmp(&off(&at[j]))).unwrap_or(0);
    let near: HalfedgeId = target.cover.own(VertexId::from(nearest));
    WalkSeed { vertex: VertexId(0), near }
}
