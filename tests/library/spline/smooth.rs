//! The smoothness of splines across the edges of their domain.

use crate::spline::{along, random_surface, square};
use ricci::spline::{KnotOptions, MAX_DEGREE, Parameter, Spline, SplineSpace};
use std::sync::Arc;

/// Shortest piece of a segment between two lines of knots that is used, in a unit square with 4 × 4 cells: derivatives from values on a
/// shorter one lose digits.
const SHORTEST: f64 = 4e-4;

/// The derivatives at s = 0, by s, of the polynomial with these values, by Newton's divided differences.
fn derivatives(nodes: &[f64], values: &[f64]) -> Vec<f64> {
    let n = nodes.len();
    let mut divided = values.to_vec();
    for level in 1..n {
        for i in (level..n).rev() {
            divided[i] = (divided[i] - divided[i - 1]) / (nodes[i] - nodes[i - level]);
        }
    }
    // Coefficients of the powers of s, by Horner's scheme.
    let mut powers = vec![0.0; n];
    for i in (0..n).rev() {
        for k in (0..n).rev() {
            powers[k] = if k > 0 { powers[k - 1] } else { 0.0 } - nodes[i] * powers[k];
        }
        powers[0] += divided[i];
    }
    let mut factorial = 1.0;
    for (k, power) in powers.iter_mut().enumerate() {
        factorial *= k.max(1) as f64;
        *power *= factorial;
    }
    powers
}

/// The derivatives, by length, at the start of a segment from a place on an edge into a patch: from the order min(n − 1, 2) up to n. None
/// if another line of knots is too near.
fn at_edge(surface: &Spline, patch: usize, from: [f64; 2], direction: [f64; 2]) -> Option<Vec<[f64; 3]>> {
    let space = surface.space();
    let cross = |a: [f64; 2], b: [f64; 2]| a[0] * b[1] - a[1] * b[0];
    let mut end = 0.2f64;
    for support in &space.supports()[patch] {
        let knots = space.patches()[support.patch as usize].knots.concat();
        for (i, a) in knots.iter().enumerate() {
            for b in &knots[i + 1..] {
                let side = [b[0] - a[0], b[1] - a[1]];
                let s = cross([a[0] - from[0], a[1] - from[1]], side) / cross(direction, side);
                end = if s > 1e-9 { end.min(s) } else { end };
            }
        }
    }
    let (degree, base) = (space.degree(), (space.degree() - 1).min(2));
    let nodes: Vec<f64> =
        (0..=degree - base).map(|k| end * (0.1 + 0.8 * k as f64 / (degree - base) as f64)).collect();
    let place = |s: &f64| Parameter {
        patch: patch as u32,
        x: from[0] + s * direction[0],
        y: from[1] + s * direction[1],
    };
    let found: Vec<[f64; 3]> = nodes.iter().map(|s| along(surface, place(s), direction, base)).collect();
    let of = |x: usize| derivatives(&nodes, &found.iter().map(|p| p[x]).collect::<Vec<_>>());
    let [x, y, z] = [0, 1, 2].map(of);
    (end > SHORTEST).then(|| (0..x.len()).map(|k| [x[k], y[k], z[k]]).collect())
}

#[test]
fn derivatives_below_the_degree_are_continuous_across_edges_and_the_next_one_jumps() {
    for degree in 1..=MAX_DEGREE {
        let domain = square(4);
        let knots = domain.knots(degree, &KnotOptions { spread: 0.9, ..KnotOptions::default() }).unwrap();
        let space = Arc::new(SplineSpace::planar(&domain, &knots).unwrap());
        let surface = random_surface(&space);
        let base = (degree - 1).min(2);
        let (mut edges, mut jumps, mut sizes) =
            (0, vec![0.0f64; degree - base + 1], vec![0.0f64; degree - base + 1]);
        for (a, patch) in space.patches().iter().enumerate() {
            let corners = [0, 1, 2].map(|k| patch.knots[k][0]);
            for k in 0..3 {
                let [p, q] = [corners[k], corners[(k + 1) % 3]];
                let is_beside = |other: &ricci::spline::Patch| {
                    (0..3).any(|i| other.knots[i][0] == q && other.knots[(i + 1) % 3][0] == p)
                };
                // Only edges between inner vertices count: at corners and on the boundary knots lie on lines of edges.
                let is_inside = |v: [f64; 2]| v.iter().all(|x| *x > 0.1 && *x < 0.9);
                let beyond = space.patches().iter().position(is_beside).filter(|b| a < *b);
                let Some(b) = beyond.filter(|_| is_inside(p) && is_inside(q)) else { continue };
                let length = (q[0] - p[0]).hypot(q[1] - p[1]);
                let across = [(p[1] - q[1]) / length, (q[0] - p[0]) / length];
                for share in (1..20).map(|k| 0.05 * f64::from(k)) {
                    let from = [0, 1].map(|x| (1.0 - share) * p[x] + share * q[x]);
                    let back = across.map(|x| -x);
                    let (Some(here), Some(there)) =
                        (at_edge(&surface, a, from, across), at_edge(&surface, b, from, back))
                    else {
                        continue;
                    };
                    edges += 1;
                    for (order, (here, there)) in here.iter().zip(&there).enumerate() {
                        let sign = if (base + order) % 2 == 0 { 1.0 } else { -1.0 };
                        for x in 0..3 {
                            jumps[order] = jumps[order].max((here[x] - sign * there[x]).abs());
                            sizes[order] = sizes[order].max(here[x].abs());
                        }
                    }
                }
            }
        }
        let relative: Vec<f64> = jumps.iter().zip(&sizes).map(|(jump, size)| jump / size).collect();
        let (last, below) = relative.split_last().unwrap();
        println!("degree {degree}, {edges} places: {relative:?}");
        assert!(
            edges >= 4 && below.iter().all(|jump| *jump < 1e-8) && *last > 1e-2,
            "{degree}: {edges} {relative:?}"
        );
    }
}
