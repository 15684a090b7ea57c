//! Doubles of plane polygons: spheres where there are vertices inside, a flat polyhedron where all of them lie on the mirror's circle.

use crate::common::Random;
use crate::common::flips::shuffle;
use crate::sphere::check::{check, run};
use ricci::Error;
use ricci::canonical::SphereOptions;
use ricci::mesh::{Double, Mesh, PerEdge, Point, VertexId, shapes};
use ricci::metric::lengths_from_positions;
use std::collections::BTreeMap;
use std::f64::consts::PI;

/// Both sides of a triangulated polygon.
fn double(points: &[Point], faces: &[[u32; 3]]) -> (Mesh, PerEdge<f64>) {
    let half = Mesh::from_faces(points.len(), faces).unwrap();
    let double = Double::new(&half).unwrap();
    let lengths = lengths_from_positions(&half, points).unwrap();
    let lengths = double.spread_edges(&lengths).unwrap().into();
    (double.mesh, lengths)
}

/// A polygon about its vertex 0.
fn fan(n: usize) -> Vec<[u32; 3]> {
    (1..n as u32 - 1).map(|k| [0, k, k + 1]).collect()
}

/// Each triangle cut into four.
fn cut(points: &[Point], faces: &[[u32; 3]]) -> (Vec<Point>, Vec<[u32; 3]>) {
    let (mut points, mut middles) = (points.to_vec(), BTreeMap::new());
    let mut middle = |a: u32, b: u32| {
        *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
            let [p, q] = [a, b].map(|v| points[v as usize]);
            points.push([0, 1, 2].map(|k| 0.5 * (p[k] + q[k])));
            points.len() as u32 - 1
        })
    };
    let pieces = faces.iter().flat_map(|&[a, b, c]| {
        let [x, y, z] = [middle(b, c), middle(c, a), middle(a, b)];
        [[a, z, y], [z, b, x], [y, x, c], [x, y, z]]
    });
    let pieces = pieces.collect();
    (points, pieces)
}

/// Points at sorted random angles, all at less than π from the next: star-shaped about the centre, and a fan where convex.
fn angles(n: usize, random: &mut Random) -> Vec<f64> {
    (0..n).map(|k| 2.0 * PI * (k as f64 + 0.45 * random.symmetric()) / n as f64).collect()
}

fn is_refused(mesh: &Mesh, lengths: &PerEdge<f64>, options: &SphereOptions, what: &str) {
    let end = run(mesh, lengths, options).map(|sphere| sphere.report);
    let words = format!("all {} vertices come to lie on one circle", mesh.n_vertices());
    assert!(
        matches!(&end, Err(Error::Layout(message)) if message.contains(&words) && message.contains("cut each")),
        "{what}: {end:?}"
    );
}

#[test]
fn doubles_of_polygons_without_inner_vertices_end_in_one_error() {
    for seed in [3, 8] {
        let mut random = Random::new(seed);
        for n in [4, 5, 6, 7, 8, 12, 20, 50, 100, 400] {
            doubles_of_polygons_end_in_one_error(n, &mut random);
        }
    }
}

fn doubles_of_polygons_end_in_one_error(n: usize, random: &mut Random) {
    let a = angles(n, random);
    let regular: Vec<f64> = (0..n).map(|k| 2.0 * PI * k as f64 / n as f64).collect();
    let at = |a: &[f64], [x, y]: [f64; 2]| -> Vec<Point> {
        a.iter().map(|a| [x * a.cos(), y * a.sin(), 0.0]).collect()
    };
    let polygons = [
        ("regular", at(&regular, [1.0; 2])),
        ("on a circle", at(&a, [1.0; 2])),
        ("on an ellipse", at(&a, [2.0, 0.3])),
        // Nearly on a line.
        ("narrow", at(&a, [1.0, 5e-2])),
        ("small", at(&a, [3e-9; 2])),
    ];
    for (name, points) in &polygons {
        let (mut mesh, mut lengths) = double(points, &fan(n));
        let default = SphereOptions::default();
        is_refused(&mesh, &lengths, &default, &format!("{name}, {n} sides"));
        let puncture = SphereOptions { puncture: Some(VertexId::from(n / 2)), ..default.clone() };
        is_refused(&mesh, &lengths, &puncture, &format!("{name}, {n} sides, seen from one"));
        shuffle(&mut mesh, &mut lengths, 4 * n, random);
        is_refused(&mesh, &lengths, &default, &format!("{name}, {n} sides, after flips"));
    }
}

#[test]
fn polygons_with_reflex_and_straight_corners_are_as_flat() {
    // A staircase, a strip with reflex corners, a square with two diagonals, and a triangle with the middles of its sides.
    let stairs = [
        [0.0, 0.0, 0.0],
        [2.0, 0.0, 0.0],
        [2.0, 1.0, 0.0],
        [1.0, 1.0, 0.0],
        [1.0, 2.0, 0.0],
        [0.0, 2.0, 0.0],
    ];
    let (mesh, lengths) = double(&stairs, &[[0, 1, 2], [0, 2, 3], [0, 3, 5], [3, 4, 5]]);
    is_refused(&mesh, &lengths, &SphereOptions::default(), "staircase");
    let n = 30;
    let low = (0..n).map(|k| [f64::from(k), 0.3 * f64::from(k % 2), 0.0]);
    let high = (0..n).map(|k| [f64::from(k), 1.0 + 0.6 * f64::from(k / 2 % 2), 0.0]);
    let comb: Vec<Point> = low.chain(high).collect();
    let n = n as u32;
    let faces: Vec<[u32; 3]> =
        (0..n - 1).flat_map(|k| [[k, k + 1, n + k], [k + 1, n + k + 1, n + k]]).collect();
    let (mesh, lengths) = double(&comb, &faces);
    is_refused(&mesh, &lengths, &SphereOptions::default(), "comb");
    let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let mesh = Mesh::from_faces(4, &[[0, 1, 2], [0, 2, 3], [1, 0, 3], [1, 3, 2]]).unwrap();
    let lengths = lengths_from_positions(&mesh, &square).unwrap();
    is_refused(&mesh, &lengths, &SphereOptions::default(), "square");
    let (points, faces) = cut(&[[0.0; 3], [4.0, 0.0, 0.0], [1.0, 3.0, 0.0]], &[[0, 1, 2]]);
    let (mesh, lengths) = double(&points, &faces);
    is_refused(&mesh, &lengths, &SphereOptions::default(), "middles");
}

#[test]
fn what_the_error_advises_helps() {
    let mut random = Random::new(5);
    for n in [4, 7, 20] {
        let points: Vec<Point> =
            angles(n, &mut random).iter().map(|a| [a.cos(), 0.6 * a.sin(), 0.0]).collect();
        let (points, faces) = cut(&points, &fan(n));
        let (mesh, lengths) = double(&points, &faces);
        let sphere = run(&mesh, &lengths, &SphereOptions::default()).unwrap();
        check(&sphere, &mesh, &lengths, &format!("{n} sides, cut"));
    }
    for n in [1, 2, 5] {
        let soup = shapes::disk(n).unwrap();
        let (mesh, lengths) = double(&soup.positions, &soup.faces);
        let sphere = run(&mesh, &lengths, &SphereOptions::default()).unwrap();
        check(&sphere, &mesh, &lengths, &format!("disk {n}"));
    }
}

#[test]
fn a_little_off_the_circle_is_a_polyhedron() {
    // Lengths that differ a little between the sides.
    let mut random = Random::new(3);
    for n in [5, 20] {
        let regular = (0..n).map(|k| 2.0 * PI * k as f64 / n as f64);
        let points: Vec<Point> = regular.map(|a| [a.cos(), a.sin(), 0.0]).collect();
        for noise in [1e-14, 1e-11, 1e-8, 1e-6, 1e-4, 1e-2] {
            let (mesh, mut lengths) = double(&points, &fan(n));
            lengths.iter_mut().for_each(|l| *l *= 1.0 + noise * random.symmetric());
            if noise < 1e-10 {
                is_refused(&mesh, &lengths, &SphereOptions::default(), &format!("noise {noise:e}"));
            } else {
                let sphere = run(&mesh, &lengths, &SphereOptions::default()).unwrap();
                check(&sphere, &mesh, &lengths, &format!("{n} sides, noise {noise:e}"));
            }
        }
    }
}
