//! Conditions that every flow with flips must satisfy, recomputed with plain formulas that the library does not use.
#![allow(dead_code)]

use super::Random;
use super::flow::{attempt, euclidean};
use ricci::flow::{Options, Report, StopReason};
use ricci::geometry::{DoubleDouble, Space};
use ricci::mesh::{EdgeId, FaceId, Mesh, PerEdge, PerVertex, VertexId, shapes};
use ricci::metric::delaunay::failing;
use ricci::metric::{Metric, Scheme};
use ricci::{Class, Control, Flow};
use std::f64::consts::PI;

/// Schemes that represent every metric with real circles or none.
pub const SCHEMES: [Scheme; 2] = [Scheme::Yamabe, Scheme::Inversive];

/// A surface in the class of `scheme`, from Euclidean lengths.
pub fn started(
    (mesh, lengths): &(Mesh, PerEdge<f64>),
    (space, scheme): (Space, Scheme),
    options: &Options,
) -> Flow {
    let class = Class::new(scheme, space);
    Flow::new(euclidean(mesh, lengths), class, options, &Control::new()).unwrap()
}

/// The rounded sum `a + b`, and its rounding error.
pub fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let part = sum - a;
    (sum, (a - (sum - part)) + (b - part))
}

/// Curvature from lengths and their remainders alone, the number of broken faces, and per vertex a bound of the change of its curvature
/// by the rounding of the given lengths.
pub struct Measured {
    pub curvature: Vec<f64>,
    pub broken: usize,
    pub rounding: Vec<f64>,
}

/// `e^x` in double-double precision: the power series at x/1024, squared ten times.
pub fn exp(x: DoubleDouble) -> DoubleDouble {
    let x = x * (0.5f64.powi(10)).into();
    let (mut sum, mut term) = (DoubleDouble::from(1.0), DoubleDouble::from(1.0));
    for k in 1..16 {
        term = term * x / f64::from(k).into();
        sum = sum + term;
    }
    (0..10).fold(sum, |e, _| e * e)
}

/// The sides of a face in E² from u alone, over e^u of its largest corner, and that u: `l² = ε e^{2u} + ε' e^{2u'} + 2 η e^{u + u'}`.
pub fn scaled_sides(mesh: &Mesh, metric: &Metric, face: FaceId) -> ([(f64, f64); 3], f64) {
    let corners = mesh.face_vertices(face);
    let top = corners.map(|v| metric.u[v]).into_iter().fold(f64::NEG_INFINITY, f64::max);
    let e = corners.map(|v| exp(DoubleDouble::from(metric.u[v]) - top.into() + metric.u_low[v].into()));
    let edges = mesh.opposite_edges(face);
    let sides = [0, 1, 2].map(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        let own = |k: usize| e[k] * e[k] * f64::from(metric.epsilon[corners[k]]).into();
        let square = own(i) + own(j) + e[i] * e[j] * metric.eta[edges[k]] * 2.0.into();
        let side = square.sqrt();
        (side.high, side.low)
    });
    (sides, top)
}

/// Measure a metric with plain formulas: `tan²(θ_a/2) = f(s − b) f(s − c) / (f(s) f(s − a))` (f = identity, sinh) with the
/// half-perimeter differences in double-double precision; in E² each triangle in a scale of its own, so that lengths may be of any size.
pub fn measure(mesh: &Mesh, metric: &Metric) -> Measured {
    let plane = metric.space == Space::E2;
    let read = |of: fn(&Metric, &Mesh) -> ricci::Result<PerEdge<f64>>| {
        if plane { PerEdge::filled(0, 0.0) } else { of(metric, mesh).unwrap() }
    };
    let (lengths, low) = (read(Metric::lengths), read(Metric::length_remainders));
    let f = |x: f64| if metric.space == Space::H2 { x.sinh() } else { x };
    let at = |v| if mesh.is_boundary_vertex(v) { PI } else { 2.0 * PI };
    let mut found = Measured {
        curvature: mesh.vertices().map(at).collect(),
        broken: 0,
        rounding: vec![1e-14; mesh.n_vertices()],
    };
    for face in mesh.faces() {
        let sides = if plane {
            scaled_sides(mesh, metric, face).0
        } else {
            mesh.opposite_edges(face).map(|e| (lengths[e], low[e]))
        };
        assert!(sides.iter().all(|(l, rest)| *l > 0.0 && l.is_finite() && rest.is_finite()));
        // s − l_k, and an ulp of the longest side where no remainder is known.
        let r = [0, 1, 2].map(|k| {
            let [own, a, b] = [sides[k], sides[(k + 1) % 3], sides[(k + 2) % 3]];
            let (sum, lost) = two_sum(a.0, b.0);
            let (rest, lost_too) = two_sum(sum, -own.0);
            0.5 * (rest + (lost + lost_too + a.1 + b.1 - own.1))
        });
        if r.iter().any(|&r| r <= 0.0) {
            found.broken += 1;
            continue;
        }
        let s = r[0] + r[1] + r[2];
        let longest = sides.iter().fold(0.0f64, |m, side| m.max(side.0));
        let known = plane || sides.iter().all(|side| side.1 != 0.0);
        let ulp = if known { f64::EPSILON * f64::EPSILON } else { f64::EPSILON } * longest;
        for (k, v) in mesh.face_vertices(face).into_iter().enumerate() {
            let [own, a, b] = [r[k], r[(k + 1) % 3], r[(k + 2) % 3]].map(f);
            let angle = 2.0 * (a.sqrt() * b.sqrt()).atan2(f(s).sqrt() * own.sqrt());
            found.curvature[v.index()] -= angle;
            // d log tan(θ/2) is half the sum of the relative changes, dθ = sin θ times it.
            let relative: f64 = r.iter().chain([&s]).map(|r| ulp / r).sum();
            found.rounding[v.index()] += angle.sin() * relative.min(1.0) + f64::EPSILON * angle;
        }
    }
    assert!(found.curvature.iter().all(|k| !k.is_nan()));
    found
}

/// The default tolerance of a flow.
const ASKED: f64 = 1e-10;

/// Asserts that what a flow with flips and the default tolerance reports is true: Euler's and Delaunay's conditions, whole triangles and,
/// where it says that it reached its target, the curvature of the target: to the tolerance asked for, or, at the rounding floor, to the
/// error that it states. Nothing is NaN. Returns whether it reached it.
pub fn honest(flow: &Flow, report: &Report, target: &PerVertex<f64>, what: &str) -> bool {
    let (mesh, metric) = (flow.mesh(), flow.metric());
    mesh.validate().unwrap();
    assert!(
        metric.u.iter().copied().chain(metric.eta.iter().map(|eta| eta.high)).all(f64::is_finite),
        "{what}"
    );
    assert!(!report.max_curvature_error.is_nan() && !report.gauss_bonnet.is_nan(), "{what}");
    // The tolerance stays as it was asked for, and only an error within it is called converged.
    assert!(report.tolerance <= 1e-10, "{what}: {report:?}");
    assert_eq!(report.converged(), report.stop_reason == StopReason::Converged, "{what}");
    assert_eq!(flow.solution().report(), Some(report), "{what}");
    match report.stop_reason {
        StopReason::Converged => {
            assert!(report.max_curvature_error <= report.tolerance, "{what}: {report:?}")
        }
        StopReason::RoundingFloor { size } => {
            assert!(report.max_curvature_error > report.tolerance, "{what}: {report:?}");
            assert!(report.max_curvature_error <= size && size <= 1e-7, "{what}: {report:?}");
            assert!(report.rounding_floor.is_some(), "{what}: {report:?}");
        }
        _ => {
            assert!(!report.is_reached(), "{what}: {report:?}");
            return false;
        }
    }
    assert!(report.is_reached() && report.broken_triangles == 0, "{what}: {report:?}");
    let found = measure(mesh, metric);
    assert_eq!(found.broken, 0, "{what}");
    let target = flow.spread_target(target).unwrap();
    for v in mesh.vertices() {
        let error = (found.curvature[v.index()] - target[v]).abs();
        let most = report.allowed_error() + found.rounding[v.index()];
        assert!(error <= most, "{what}: {error:e} at {v}, allowed {most:e}");
    }
    assert!(failing(mesh, metric).is_empty(), "{what}: not Delaunay");
    true
}

/// Flow to a target, which must be reached.
pub fn reach(flow: &mut Flow, target: &PerVertex<f64>, what: &str) -> Report {
    let report = attempt(flow, target);
    assert!(
        honest(flow, &report, target, what),
        "{what}: {} after {} steps, {:.1e}",
        report.stop_reason,
        report.iterations,
        report.max_curvature_error
    );
    report
}

/// Flip an edge whose two triangles form a strictly convex quadrilateral in the plane, which does not change the surface.
pub fn isometric_flip(mesh: &mut Mesh, lengths: &mut PerEdge<f64>, e: EdgeId) -> bool {
    let h = e.halfedge();
    if mesh.is_outside(h) || mesh.is_outside(h.twin()) || mesh.face(h) == mesh.face(h.twin()) {
        return false;
    }
    let place = |h| {
        let [base, left, right] = [h, mesh.next(h), mesh.prev(h)].map(|h| lengths[h.edge()]);
        let x = (base * base + right * right - left * left) / (2.0 * base);
        [x, (right * right - x * x).max(0.0).sqrt()]
    };
    let (k, l) = (place(h), place(h.twin()));
    let l = [lengths[e] - l[0], -l[1]];
    // Where the new edge crosses the line of the old one, well inside.
    let crossing = k[0] + (l[0] - k[0]) * k[1] / (k[1] - l[1]);
    if !(0.05 * lengths[e]..0.95 * lengths[e]).contains(&crossing) {
        return false;
    }
    let length = (k[0] - l[0]).hypot(k[1] - l[1]);
    mesh.flip(e) && {
        lengths[e] = length;
        true
    }
}

/// Another geodesic triangulation of the same surface, by `tries` random flips that keep it. Returns how many there were.
pub fn shuffle(mesh: &mut Mesh, lengths: &mut PerEdge<f64>, tries: usize, random: &mut Random) -> usize {
    let mut edge = || EdgeId::from(random.below(mesh.n_edges()));
    let edges: Vec<EdgeId> = (0..tries).map(|_| edge()).collect();
    edges.into_iter().filter(|&e| isometric_flip(mesh, lengths, e)).count()
}

/// A target with the given curvatures at some vertices; the others share the rest of 2πχ equally.
pub fn balanced(mesh: &Mesh, cones: &[(VertexId, f64)]) -> PerVertex<f64> {
    let left = 2.0 * PI * mesh.euler() as f64 - cones.iter().map(|(_, k)| k).sum::<f64>();
    let mut target = PerVertex::filled(mesh.n_vertices(), left / (mesh.n_vertices() - cones.len()) as f64);
    cones.iter().for_each(|&(v, k)| target[v] = k);
    target
}

/// A sphere drawn out along an axis, and its vertices by height.
pub fn stretched(frequency: usize, times: f64) -> ((Mesh, PerEdge<f64>), Vec<VertexId>) {
    let mut soup = shapes::icosphere(frequency).unwrap();
    soup.positions.iter_mut().for_each(|p| p[2] *= times);
    let mut by_height: Vec<usize> = (0..soup.positions.len()).collect();
    by_height.sort_by(|&a, &b| soup.positions[a][2].total_cmp(&soup.positions[b][2]));
    (super::flow::surface(&soup), by_height.into_iter().map(VertexId::from).collect())
}

/// Four cones about the middle. The ends become discs that are smaller by the exponential of the length over the width.
pub fn in_the_middle(mesh: &Mesh, by_height: &[VertexId]) -> PerVertex<f64> {
    let cones: Vec<_> = by_height[by_height.len() / 2 - 2..][..4].iter().map(|&v| (v, PI)).collect();
    balanced(mesh, &cones)
}

/// Moves a target towards its mean until its largest entry is `most`.
pub fn drawn_below(target: &mut PerVertex<f64>, total: f64, most: f64) {
    let mean = total / target.len() as f64;
    let shift = target.iter().sum::<f64>() / target.len() as f64;
    target.iter_mut().for_each(|k| *k += mean - shift);
    let largest = target.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let pull = if largest > most { (most - mean) / (largest - mean) } else { 1.0 };
    target.iter_mut().for_each(|k| *k = mean + pull * (*k - mean));
}
