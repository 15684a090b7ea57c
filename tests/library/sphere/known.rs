//! Spheres that are known: round ones, spheroids, few vertices, and vertices on common circles.

use crate::common::Random;
use crate::sphere::check::{check, on_sphere, run, same_up_to_moebius};
use ricci::canonical::SphereOptions;
use ricci::geometry::vector::{add, cross, dot, norm, scale, sub};
use ricci::mesh::{Mesh, Point, shapes};
use ricci::metric::lengths_from_positions;

#[test]
fn the_round_sphere_comes_back_up_to_a_rotation() {
    for n in [1, 2, 5, 12] {
        let soup = shapes::icosphere(n).unwrap();
        let sphere = on_sphere(&soup);
        let (x, y) = (&soup.positions, &sphere.positions);
        let far = [0, 1, x.len() - 1];
        for (i, p) in x.iter().enumerate() {
            for &j in &far {
                let off = (dot(*p, x[j]) - dot(y[i.into()], y[j.into()])).abs();
                assert!(off < 1e-13, "{n}: {off:e}");
            }
        }
        // Not its mirror image either.
        let volume = |[a, b, c]: [Point; 3]| dot(a, cross(b, c));
        let three = [0, 1, 2];
        let (before, after) = (volume(three.map(|i| x[i])), volume(three.map(|i| y[i.into()])));
        assert!((before - after).abs() < 1e-13);
    }
}

/// Latitude θ on the sphere of reduced latitude β on the spheroid with half axes 1, 1, c: the isometric latitudes
/// `artanh sin θ = artanh sin β + ∫₀^β (√(sin² + c² cos²) − 1)/cos dβ` agree.
fn spheroid_latitude(c: f64, beta: f64) -> f64 {
    let f = |t: f64| {
        let (sin, cos) = t.sin_cos();
        (c * c - 1.0) * cos / ((sin * sin + c * c * cos * cos).sqrt() + 1.0)
    };
    let (n, mut sum) = (2000, 0.0);
    let h = beta / f64::from(n);
    for k in 0..n {
        let t = f64::from(k) * h;
        sum += h / 6.0 * (f(t) + 4.0 * f(t + 0.5 * h) + f(t + h));
    }
    (beta.sin().atanh() + sum).tanh().asin()
}

/// Largest distance of the result from the analytic map, after the rotation that fits best.
fn spheroid_error(c: f64, n: usize) -> f64 {
    let round = shapes::icosphere(n).unwrap();
    let sphere = on_sphere(&shapes::ellipsoid([1.0, 1.0, c], n).unwrap());
    let exact: Vec<Point> = round
        .positions
        .iter()
        .map(|x| {
            let theta = spheroid_latitude(c, x[2].clamp(-1.0, 1.0).asin());
            let r = x[0].hypot(x[1]);
            let [cos, sin] = if r > 0.0 { [x[0] / r, x[1] / r] } else { [1.0, 0.0] };
            [theta.cos() * cos, theta.cos() * sin, theta.sin()]
        })
        .collect();
    // Σ exactᵀ x is the rotation times a symmetric matrix: its polar factor, by Newton's iteration R ← (R + R⁻ᵀ)/2.
    let mut m = [[0.0; 3]; 3];
    for (p, x) in exact.iter().zip(sphere.positions.iter()) {
        (0..3).for_each(|i| (0..3).for_each(|j| m[i][j] += x[i] * p[j]));
    }
    for _ in 0..60 {
        let cofactors = [cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1])];
        let det = dot(m[0], cofactors[0]);
        (0..3).for_each(|i| m[i] = scale(0.5, add(m[i], scale(1.0 / det, cofactors[i]))));
    }
    let distance = |(p, x): (&Point, &Point)| norm(sub(m.map(|row| dot(row, *p)), *x));
    exact.iter().zip(sphere.positions.iter()).map(distance).fold(0.0, f64::max)
}

#[test]
fn spheroids_converge_to_the_analytic_map_with_the_square_of_the_edge_length() {
    for c in [0.5, 2.0, 3.0] {
        let errors = [6, 12, 24].map(|n| spheroid_error(c, n));
        println!("half axis {c}: {errors:?}");
        assert!(errors[0] < 0.1 && errors[2] < 4e-3, "{c}: {errors:?}");
        assert!(errors[0] / errors[1] > 3.0 && errors[1] / errors[2] > 3.3, "{c}: {errors:?}");
    }
}

#[test]
fn four_vertices_are_enough() {
    // A tetrahedron's three opposite products of lengths are, up to a factor, those of its image: the class is all there is.
    let points = [[0.0, 0.0, 0.0], [1.0, 0.1, 0.0], [0.2, 0.9, 0.0], [0.3, 0.3, 1.7]];
    let mesh = Mesh::from_faces(4, &[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]).unwrap();
    let lengths = lengths_from_positions(&mesh, &points).unwrap();
    let sphere = run(&mesh, &lengths, &SphereOptions::default()).unwrap();
    check(&sphere, &mesh, &lengths, "tetrahedron");
    assert!(sphere.metric.is_unflipped());
    same_up_to_moebius(&points, &sphere.positions, 1e-12, "tetrahedron");

    let corners: Vec<Point> = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
        .into_iter()
        .flat_map(|x| [x, scale(-1.0, x)])
        .collect();
    let faces = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
    let mesh = Mesh::from_faces(6, &faces).unwrap();
    let lengths = lengths_from_positions(&mesh, &corners).unwrap();
    let sphere = run(&mesh, &lengths, &SphereOptions::default()).unwrap();
    check(&sphere, &mesh, &lengths, "octahedron");
    for i in 0..6 {
        for j in 0..6 {
            let off =
                dot(corners[i], corners[j]) - dot(sphere.positions[i.into()], sphere.positions[j.into()]);
            assert!(off.abs() < 1e-14);
        }
    }
}

#[test]
fn a_cube_with_and_without_noise() {
    // Squares of four points on a circle: ties of the Delaunay condition, and outlines that turn by nothing.
    let corner = |k: usize| [0, 1, 2].map(|i| if k >> i & 1 == 1 { 1.0 } else { -1.0 });
    let squares = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let faces: Vec<[u32; 3]> = squares.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    let mesh = Mesh::from_faces(8, &faces).unwrap();
    let mut random = Random::new(2);
    for noise in [0.0, 1e-15, 1e-12, 1e-9, 1e-7, 1e-5, 1e-3] {
        let points: Vec<Point> =
            (0..8).map(|k| corner(k).map(|x: f64| x + noise * random.symmetric())).collect();
        let lengths = lengths_from_positions(&mesh, &points).unwrap();
        let sphere = run(&mesh, &lengths, &SphereOptions::default()).unwrap();
        check(&sphere, &mesh, &lengths, &format!("cube, noise {noise:e}"));
        let tolerance = 1e-13 + 20.0 * noise;
        same_up_to_moebius(&points, &sphere.positions, tolerance, "cube");
    }
}

/// Cylinders without inner vertices on their caps: every vertex lies on polygons of vertices on a circle, up to noise.
#[test]
fn prisms_with_and_without_noise() {
    let mut random = Random::new(4);
    for n in [3, 5, 8, 20] {
        for noise in [0.0, 1e-14, 1e-7, 1e-6, 1e-4, 1e-2] {
            let ring = |z: f64| {
                (0..n)
                    .map(move |i| 2.0 * std::f64::consts::PI * i as f64 / n as f64)
                    .map(move |a| [a.cos(), a.sin(), z])
            };
            let mut points: Vec<Point> = ring(0.0).chain(ring(0.7)).chain(ring(1.4)).collect();
            points.as_flattened_mut().iter_mut().for_each(|x| *x += noise * random.symmetric());
            let at = |k: usize, i: usize| (k * n + i % n) as u32;
            let mut faces = Vec::new();
            for i in 0..n {
                for k in 0..2 {
                    faces.push([at(k, i), at(k, i + 1), at(k + 1, i + 1)]);
                    faces.push([at(k, i), at(k + 1, i + 1), at(k + 1, i)]);
                }
            }
            for i in 1..n - 1 {
                faces.push([at(0, 0), at(0, i + 1), at(0, i)]);
                faces.push([at(2, 0), at(2, i), at(2, i + 1)]);
            }
            let mesh = Mesh::from_faces(3 * n, &faces).unwrap();
            let lengths = lengths_from_positions(&mesh, &points).unwrap();
            let sphere = run(&mesh, &lengths, &SphereOptions::default()).unwrap();
            check(&sphere, &mesh, &lengths, &format!("{n} sides, noise {noise:e}"));
        }
    }
}
