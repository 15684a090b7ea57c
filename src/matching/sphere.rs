//! Spheres without landmarks: both go to the unit sphere, and one is turned until its conformal factor fits the other's best.

use super::balance::BalanceReport;
use super::canonical::not_found;
use super::cover::{Cover, Placed};
use super::options::MatchOptions;
use super::orbifold::Pair;
use super::repair::unfold;
use super::turn::{Density, IDENTITY, turnings};
use super::walk::{Seed, locate};
use super::weights::mean_value_weights;
use crate::canonical::{SphereOptions, uniformize_sphere};
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::Space;
use crate::geometry::vector::{Vector, cross, dot, norm, normalised, sub};
use crate::mesh::{HalfedgeId, PerVertex, VertexId};
use crate::metric::Surface;

/// Both triangulations on one unit sphere: harmonic maps of spheres are Möbius transformations, and both are centred, so that a rotation is left to
/// find.
///
/// # Errors
/// [`Error::Matching`] where a flow does not come to its target or a fold cannot be opened; those of [`uniformize_sphere`]; [`Error::Cancelled`].
pub(super) fn on_sphere(surfaces: [&Surface; 2], options: &MatchOptions, control: &Control) -> Result<Pair> {
    let own = |s: usize| in_own_sphere(surfaces[s], options, control);
    let (source, target) = rayon::join(|| own(0), || own(1));
    let ((mut source, first), (target, second)) = (source?, target?);
    let points = [&source, &target].map(positions);
    let densities = [0, 1].map(|s| density(surfaces[s], &points[s]));
    let mut best: Option<(f64, Placed, Seed)> = None;
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
            best = Some((off, turned, seed));
        }
    }
    let Some((_, turned, ahead)) = best else {
        return Err(Error::Matching("no rotation of the sphere was found".into()));
    };
    source = turned;
    let back = seed(&target, &positions(&source), &source);
    let seeds = [ahead, back];
    let reports = [BalanceReport::default(); 2];
    Ok(Pair { source, target, seeds, reports, flow_iterations: [first, second], markings: 1 })
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
    unfold(&mut placed, &weights, control)?;
    Ok((placed, sphere.report.iterations))
}

fn positions(placed: &Placed) -> Vec<Vector> {
    placed.at.iter().map(|frame| normalised(frame.origin().map(f64::from))).collect()
}

/// The conformal factor at the vertices, `½ log` of the area around them on the surface over that on the sphere, both as shares of the totals.
fn density(surface: &Surface, points: &[Vector]) -> Density {
    let mesh = surface.mesh();
    let mut areas = vec![[0.0f64; 2]; points.len()];
    for f in mesh.faces() {
        let vertices = mesh.face_vertices(f);
        let [a, b, c] = vertices.map(|v| points[v.index()]);
        let round = 0.5 * norm(cross(sub(b, a), sub(c, a)));
        let lengths = crate::metric::lengths::face_lengths(mesh, surface.lengths(), f);
        let own = crate::geometry::triangle::area(surface.geometry(), lengths);
        for v in vertices {
            areas[v.index()][0] += own / 3.0;
            areas[v.index()][1] += round / 3.0;
        }
    }
    let totals = [0, 1].map(|k| areas.iter().map(|a| a[k]).sum::<f64>().max(f64::MIN_POSITIVE));
    let weights: Vec<f64> = areas.iter().map(|a| a[0] / totals[0]).collect();
    let least = f64::MIN_POSITIVE;
    let factor =
        |a: &[f64; 2]| 0.5 * ((a[0] / totals[0]).max(least).ln() - (a[1] / totals[1]).max(least).ln());
    Density { values: areas.iter().map(factor).collect(), points: points.to_vec(), weights }
}

/// The first vertex of the points, and the target's vertex nearest to it.
fn seed(points: &Placed, at: &[Vector], target: &Placed) -> Seed {
    let start = points.at[VertexId(0)].origin().map(f64::from);
    let off = |p: &Vector| dot(sub(*p, start), sub(*p, start));
    let nearest = (0..at.len()).min_by(|&i, &j| off(&at[i]).total_cmp(&off(&at[j]))).unwrap_or(0);
    let near: HalfedgeId = target.cover.own(VertexId::from(nearest));
    Seed { vertex: VertexId(0), near }
}
