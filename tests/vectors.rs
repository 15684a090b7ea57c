//! Golden vectors (`tests/vectors/make.py`, 60 digits and plain cosine laws): what double precision leaves of them.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::print_stderr)]

mod common;

use common::flow::{converged, rigid, solve};
use common::hex;
use ricci::flow::curvature_derivative;
use ricci::geometry::conformal::{Vertex, differences, edge, length};
use ricci::geometry::triangle::angles_from;
use ricci::geometry::weights::weights;
use ricci::geometry::{Space, triangle};
use ricci::mesh::{Mesh, PerEdge, PerVertex};
use ricci::metric::{Class, Metric, Scheme, curvature, initial_metric};
use std::collections::HashMap;

fn space(name: &str) -> Space {
    [Space::E2, Space::H2, Space::S2].into_iter().find(|s| s.name() == name).unwrap()
}

#[test]
fn angles_and_areas_are_right_to_a_few_ulp_however_thin_the_triangle() {
    let (mut worst_angle, mut worst_area, mut lines) = (0.0f64, 0.0f64, 0);
    for line in include_str!("vectors/triangles.txt").lines() {
        let (name, numbers) = line.split_once(' ').unwrap();
        let x: Vec<f64> = numbers.split(' ').map(hex).collect();
        let (space, lengths) = (space(name), [x[0], x[1], x[2]]);
        let ours = triangle::angles(space, lengths);
        assert!(!ours.broken(), "{line}");
        let relative = |ours: f64, exact: f64| (ours - exact).abs() / exact;
        for k in 0..3 {
            let error = relative(ours.at[k], x[3 + k]);
            assert!(error <= ANGLE, "{space} {lengths:?}: angle {k} is off by {error:e}");
            worst_angle = worst_angle.max(error);
        }
        let error = relative(triangle::area(space, lengths), x[6]);
        assert!(error <= AREA, "{space} {lengths:?}: area is off by {error:e}");
        worst_area = worst_area.max(error);
        lines += 1;
    }
    assert!(lines > 60);
    println!("{lines} triangles: angles within {worst_angle:.1e}, areas within {worst_area:.1e} (relative)");
}

/// Relative; the lengths are exact.
const ANGLE: f64 = 16.0 * f64::EPSILON;
const AREA: f64 = 8.0 * f64::EPSILON;

#[test]
fn circles_of_very_different_sizes_keep_the_accuracy_of_their_angles_and_weights() {
    let (mut worst_angle, mut worst_weight, mut lines) = (0.0f64, 0.0f64, 0);
    for line in include_str!("vectors/circles.txt").lines() {
        let (name, numbers) = line.split_once(' ').unwrap();
        let x: Vec<f64> = numbers.split(' ').map(hex).collect();
        let (space, eta) = (space(name), [x[0], x[1], x[2]]);
        let corners = [x[3], x[4], x[5]].map(|u| Vertex::new(space, 1, u));
        let edges =
            [0, 1, 2].map(|k| edge(space, corners[(k + 1) % 3], corners[(k + 2) % 3], eta[k]).unwrap());
        let r = differences(corners, edges);
        let (angles, weights) =
            (angles_from(space, r).at, weights(space, r, edges.map(|e| e.q2), corners, eta));
        let largest = weights.iter().fold(0.0f64, |m, w| m.max(w.abs()));
        for k in 0..3 {
            let angle = (angles[k] - x[6 + k]).abs() / x[6 + k];
            // Between circles that do not meet at right angles or less a weight can vanish by cancellation.
            let scale = if eta[k] <= 1.0 { x[9 + k].abs() } else { largest };
            let weight = (weights[k] - x[9 + k]).abs() / scale;
            assert!(
                angle < CIRCLES && weight < CIRCLES,
                "{line}: corner {k}: {angle:e} {weight:e} {weights:?}"
            );
            (worst_angle, worst_weight) = (worst_angle.max(angle), worst_weight.max(weight));
        }
        // The same differences from lengths of twice the digits, which is how files hold them.
        let l = edges.map(|e| length(space, e.q2));
        let lo = [0, 1, 2].map(|k| edges[k].remainder(corners[(k + 1) % 3], corners[(k + 2) % 3], l[k]));
        let longest = l.into_iter().fold(0.0, f64::max);
        for k in 0..3 {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            // Exact in the order that Kahan's differences have.
            let (a, b) = if l[i] > l[j] { (l[i], l[j]) } else { (l[j], l[i]) };
            let high = if l[k] < b { a + (b - l[k]) } else { b + (a - l[k]) };
            let ours = 0.5 * (high + (lo[i] + lo[j] - lo[k]));
            assert!(
                (ours - r[k]).abs() <= 1e-15 * r[k] + 1e-30 * longest,
                "{line}: r {k}: {ours:e} {:e}",
                r[k]
            );
        }
        lines += 1;
    }
    assert_eq!(lines, 45);
    println!(
        "{lines} circle triples: angles within {worst_angle:.1e}, weights within {worst_weight:.1e} (relative)"
    );
}

/// Relative; u has twenty units before the point, so that e^u is off by 20 ε at the start.
const CIRCLES: f64 = 1e-13;

/// One block of `surfaces.txt`.
struct Golden {
    name: String,
    geometry: Space,
    space: Space,
    scheme: Scheme,
    mesh: Mesh,
    numbers: HashMap<String, Vec<f64>>,
}

impl Golden {
    fn parse(block: &str) -> Golden {
        let lines: HashMap<&str, Vec<&str>> = block
            .lines()
            .map(|line| {
                line.split_once(' ').map_or((line, vec![]), |(key, rest)| (key, rest.split(' ').collect()))
            })
            .collect();
        let count: Vec<usize> = lines["counts"].iter().map(|x| x.parse().unwrap()).collect();
        let integers = |key: &str| -> Vec<[i32; 3]> {
            let flat: Vec<i32> = lines[key].iter().map(|x| x.parse().unwrap()).collect();
            flat.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect()
        };
        let faces: Vec<[u32; 3]> = integers("faces").into_iter().map(|f| f.map(|v| v as u32)).collect();
        let mesh = Mesh::from_gluing(count[0], &faces, &integers("face_edges")).unwrap();
        assert_eq!([mesh.n_edges(), mesh.n_faces()], [count[1], count[2]]);
        let given = ["lengths", "eta", "curvature", "derivative", "target", "u", "solution"];
        let numbers = given
            .into_iter()
            .filter_map(|key| Some((key.to_string(), lines.get(key)?.iter().map(|x| hex(x)).collect())));
        let head = &lines["surface"];
        Golden {
            name: head.join(" "),
            geometry: space(head[1]),
            space: space(head[2]),
            scheme: head[3].parse().unwrap(),
            mesh,
            numbers: numbers.collect(),
        }
    }

    /// Compare with what was computed, relative to the largest entry, or to 1 where all are smaller (angles in a vertex add
    /// up to 2π, also where little curvature is left).
    fn compare(&self, key: &str, ours: &[f64], bound: f64, worst: &mut HashMap<String, f64>) {
        let exact = &self.numbers[key];
        assert_eq!(ours.len(), exact.len(), "{} {key}", self.name);
        let scale = exact.iter().fold(1.0f64, |m, x| m.max(x.abs()));
        let error = ours.iter().zip(exact).fold(0.0f64, |m, (a, b)| m.max((a - b).abs())) / scale;
        assert!(error <= bound, "{}: {key} is off by {error:e}, bound {bound:e}", self.name);
        let entry = worst.entry(key.to_string()).or_default();
        *entry = entry.max(error);
    }
}

#[test]
fn weights_curvature_derivative_and_solutions_agree_with_sixty_digits() {
    let mut worst = HashMap::new();
    let mut blocks = 0;
    for block in include_str!("vectors/surfaces.txt").split("end\n").filter(|b| !b.is_empty()) {
        let golden = Golden::parse(block);
        let Golden { mesh, geometry, space, scheme, .. } = &golden;
        let lengths = PerEdge::from(golden.numbers["lengths"].clone());
        let start = initial_metric(mesh, &lengths, *geometry, Class::new(*scheme, *geometry)).unwrap().metric;
        golden.compare("eta", &start.rounded_eta(), 1e-14, &mut worst);
        let k = curvature(mesh, *geometry, &start.lengths(mesh).unwrap()).unwrap();
        golden.compare("curvature", &k.at, 1e-14, &mut worst);
        let mut derivative = vec![0.0; mesh.n_vertices() * mesh.n_vertices()];
        for (i, j, x) in curvature_derivative(mesh, &start).unwrap() {
            derivative[i.index() * mesh.n_vertices() + j.index()] = x;
            derivative[j.index() * mesh.n_vertices() + i.index()] = x;
        }
        golden.compare("derivative", &derivative, 1e-14, &mut worst);
        if let Some(target) = golden.numbers.get("target") {
            let class =
                initial_metric(mesh, &lengths, *geometry, Class::new(*scheme, *space)).unwrap().metric;
            let (metric, report): (Metric, _) =
                solve(mesh, &class, &PerVertex::from(target.clone()), &rigid());
            converged(&report);
            golden.compare("u", &metric.u, 2e-13, &mut worst);
            golden.compare("solution", &metric.lengths(mesh).unwrap(), 2e-13, &mut worst);
        }
        blocks += 1;
    }
    assert_eq!(blocks, 40);
    let mut worst: Vec<_> = worst.into_iter().collect();
    worst.sort_by(|a, b| a.0.cmp(&b.0));
    println!("{blocks} surfaces, largest errors: {worst:?}");
}
