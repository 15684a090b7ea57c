//! Tests straight boundaries in the plane.

use crate::bordered::surfaces::{check_geodesic, from_soup, uniformized};
use ricci::canonical::{Boundary, BoundaryCorner, Corners, Quotient, QuotientOptions, uniformize_quotient};
use ricci::embed::dirichlet_domain;
use ricci::geometry::Space;
use ricci::mesh::VertexId;
use ricci::mesh::io::Soup;
use ricci::mesh::shapes;
use ricci::{Control, Error, Surface};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

fn straight(corners: Corners) -> QuotientOptions {
    QuotientOptions { boundary: Boundary::Straight(corners), ..QuotientOptions::default() }
}

fn at(corners: &[(u32, Option<f64>)]) -> Corners {
    let corner = |&(v, angle): &(u32, Option<f64>)| BoundaryCorner { vertex: VertexId(v), angle };
    Corners::At(corners.iter().map(corner).collect())
}

/// A part of the square lattice of this step, cut into triangles along alternating diagonals, and the number of the vertex at a point of
/// it.
fn lattice(
    size: [usize; 2],
    step: f64,
    keep: impl Fn([usize; 2]) -> bool,
) -> (Soup, impl Fn([usize; 2]) -> u32) {
    let [nx, ny] = size;
    let mut number = vec![u32::MAX; (nx + 1) * (ny + 1)];
    let mut soup = Soup::default();
    let index = move |[i, j]: [usize; 2]| j * (nx + 1) + i;
    for j in 0..ny {
        for i in (0..nx).filter(|&i| keep([i, j])) {
            let corners = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]].map(|[i, j]| {
                let slot = &mut number[index([i, j])];
                if *slot == u32::MAX {
                    *slot = soup.positions.len() as u32;
                    soup.positions.push([i as f64 * step, j as f64 * step, 0.0]);
                }
                *slot
            });
            let [a, b, c, d] = corners;
            soup.faces.extend(match (i + j) % 2 {
                0 => [[a, b, c], [a, c, d]],
                _ => [[a, b, d], [b, c, d]],
            });
        }
    }
    (soup, move |p| number[index(p)])
}

fn check_straight(name: &str, q: &Quotient) {
    assert!(q.report.converged() && q.deck.space == Space::E2, "{name}: {}", q.report.stop_reason);
    assert!(q.layout.flipped.is_empty() && q.layout.broken.is_empty(), "{name}");
    for side in q.boundary.iter().flat_map(|around| &around.sides) {
        assert!(side.straightness < 1e-9, "{name}: {:e}", side.straightness);
    }
}

#[test]
fn a_rectangle_is_its_own_image() {
    let (soup, vertex) = lattice([6, 4], 0.25, |_| true);
    let corners = [[0, 0], [6, 0], [6, 4], [0, 4]].map(&vertex);
    let named = straight(at(&corners.map(|v| (v, None))));
    for options in [named, straight(Corners::Default), straight(Corners::Count(4))] {
        let q = uniformized(&from_soup(&soup), &options);
        check_straight("rectangle", &q);
        assert_eq!(q.corners.iter().map(|c| c.0.0).collect::<Vec<_>>(), corners);
        assert!(q.corners.iter().all(|c| (c.1 - FRAC_PI_2).abs() < 1e-15));
        assert!((q.extremal_distance().unwrap() - 2.0 / 3.0).abs() < 1e-12);
        // The first corner lies at the origin, the first side on the x axis.
        for h in q.layout.mesh().halfedges().filter(|&h| !q.layout.mesh().is_outside(h)) {
            let [x, y, _] = soup.positions[q.layout.mesh().origin(h).index()];
            let [u, v] = q.layout.uv(h);
            assert!((x - u).abs() < 1e-12 && (y - v).abs() < 1e-12, "{x} {y} at {u} {v}");
        }
    }
    // Another first corner: the reciprocal.
    let turned = straight(at(&[corners[1], corners[2], corners[3], corners[0]].map(|v| (v, None))));
    let q = uniformized(&from_soup(&soup), &turned);
    assert!((q.extremal_distance().unwrap() - 1.5).abs() < 1e-12);
}

/// Three squares of side 1: the vertices of the L counterclockwise from its outer corner.
fn ell(n: usize) -> (Soup, [u32; 6]) {
    let (soup, vertex) = lattice([2 * n, 2 * n], 1.0 / n as f64, |[i, j]| i < n || j < n);
    (soup, [[0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]].map(|[i, j]| vertex([i * n, j * n])))
}

#[test]
fn an_l_shape_is_its_own_image_with_its_own_corners() {
    let (soup, corners) = ell(4);
    let mut named = corners.map(|v| (v, None));
    named[3].1 = Some(3.0 * FRAC_PI_2);
    let q = uniformized(&from_soup(&soup), &straight(at(&named)));
    check_straight("L", &q);
    let found: Vec<f64> = q.boundary[0].sides.iter().map(|side| side.length).collect();
    let off =
        found.iter().zip([2.0, 1.0, 1.0, 1.0, 1.0, 2.0]).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(off < 1e-8, "{found:?}");
    assert!(q.extremal_distance().is_none() && (q.layout.area - 3.0).abs() < 1e-12);
}

/// The complete elliptic integral of this modulus k, by the mean of its complement and 1.
fn elliptic(k: f64) -> f64 {
    let (mut a, mut b) = (1.0, (1.0 - k * k).sqrt());
    for _ in 0..30 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    0.5 * PI / a
}

#[test]
fn the_modulus_of_an_l_shape_converges_to_the_exact_one() {
    // ∫ z^{−1/2} (z² − k²)^{−1/2} (z² − 1)^{−1/2} dz maps the upper half-plane onto an L, symmetric about its diagonal, with the outer
    // corner at 0 and the inner one at ∞. For k = √3/2 its arms are as long and as wide as those of three squares: a quadrature gives 2 for
    // the quotient of the integrals from 0 to k and from k to 1. The quadrilateral with corners ±k, ±1 has modulus K(k')/2K(k).
    let k = 0.75f64.sqrt();
    let exact = elliptic(0.5) / (2.0 * elliptic(k));
    let off = [8, 16, 32].map(|n| {
        let (soup, [_, a, b, _, c, d]) = ell(n);
        let q = uniformized(&from_soup(&soup), &straight(at(&[d, a, b, c].map(|v| (v, None)))));
        check_straight("L as a rectangle", &q);
        (q.extremal_distance().unwrap() - exact).abs()
    });
    println!("exact {exact}, off by {off:?}");
    let rates = [(off[0] / off[1]).log2(), (off[1] / off[2]).log2()];
    assert!(off[2] < 1e-4 && rates.iter().all(|&r| r > 1.8), "{off:?}: {rates:?}");
}

#[test]
fn annuli_are_cylinders_of_their_modulus() {
    // A cylinder of plane strips is its own image.
    let (n, m, height) = (12, 5, 0.7);
    let mut soup = Soup::default();
    for j in 0..=m {
        for i in 0..n {
            let (t, z) = (TAU * i as f64 / n as f64, height * j as f64 / m as f64);
            soup.positions.push([t.cos(), t.sin(), z]);
        }
    }
    let at = |i: usize, j: usize| (j * n + i % n) as u32;
    for (i, j) in (0..m).flat_map(|j| (0..n).map(move |i| (i, j))) {
        let corners = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        soup.faces.extend([[corners[0], corners[1], corners[2]], [corners[0], corners[2], corners[3]]]);
    }
    let around = n as f64 * 2.0 * (PI / n as f64).sin();
    for options in [QuotientOptions::default(), straight(Corners::Default)] {
        let q = uniformized(&from_soup(&soup), &options);
        check_geodesic("cylinder", &q);
        assert!((q.extremal_distance().unwrap() - height / around).abs() < 1e-12);
        assert!(q.boundary.iter().all(|b| (b.length() - around).abs() < 1e-12));
        // The first loop runs along the x axis, the surface above it.
        let [[[re, im], [x, y]], _] = q.deck.generators[q.boundary[0].generator].mobius();
        assert!(
            (re - 1.0).abs() < 1e-12 && im.abs() < 1e-12 && y.abs() < 1e-12 && (x - around).abs() < 1e-12
        );
        let domain = dirichlet_domain(&q.deck, [0.0, 0.0, 1.0], q.layout.area, &Control::new()).unwrap();
        assert_eq!(domain.partner.iter().filter(|partner| partner.is_none()).count(), 2);
    }
    // The modulus of a round annulus of the plane is log(R/r)/2π.
    let off = [1, 2, 4].map(|k| {
        let annulus = from_soup(&shapes::annulus(0.4, 1.0, 5 * k, 24 * k).unwrap());
        let q = uniformized(&annulus, &QuotientOptions::default());
        check_geodesic("annulus", &q);
        (q.extremal_distance().unwrap() - (1.0f64 / 0.4).ln() / TAU).abs()
    });
    println!("annulus off by {off:?}");
    let rates = [(off[0] / off[1]).log2(), (off[1] / off[2]).log2()];
    assert!(rates.iter().all(|&r| r > 1.9), "{off:?}: {rates:?}");
}

#[test]
fn surfaces_with_handles_get_straight_sides_too() {
    let soup = shapes::punch(&shapes::torus(2.0, 1.0, 24, 12).unwrap(), 1).unwrap();
    let q = uniformized(&from_soup(&soup), &straight(Corners::Default));
    check_straight("torus with a hole", &q);
    assert_eq!(q.boundary[0].sides.len(), 4);
    assert!(q.corners.iter().all(|c| (c.1 - 1.5 * PI).abs() < 1e-12));
    // Loops turn by multiples of a right angle, and no copies tile the plane.
    let turns: Vec<f64> = q.deck.generators.iter().map(|g| g.rotation_angle() / FRAC_PI_2).collect();
    assert!(turns.iter().all(|t| t.is_finite()), "{turns:?}");
    let disk = from_soup(&shapes::disk(6).unwrap());
    let triangle = uniformized(&disk, &straight(Corners::Count(3)));
    check_straight("triangle", &triangle);
    assert!(triangle.corners.iter().all(|c| (c.1 - PI / 3.0).abs() < 1e-12));
    let [a, b, c] = triangle.boundary[0].sides[..] else { panic!("three sides") };
    assert!((a.length - b.length).abs() < 1e-9 && (b.length - c.length).abs() < 1e-9);
}

#[test]
fn what_cannot_be_is_refused_with_what_misses() {
    let disk = from_soup(&shapes::disk(4).unwrap());
    let refused = |surface: &Surface, options: &QuotientOptions| {
        uniformize_quotient(surface, options, &Control::new()).unwrap_err()
    };
    let rim: Vec<u32> = disk.mesh().boundary_loops()[0].iter().map(|&h| disk.mesh().origin(h).0).collect();
    let error = refused(&disk, &QuotientOptions::default());
    assert!(matches!(error, Error::Layout(_)) && error.to_string().contains("straight sides"), "{error}");
    let right = Some(FRAC_PI_2);
    let five: Vec<_> = rim.iter().step_by(3).take(5).map(|&v| (v, right)).collect();
    let error = refused(&disk, &straight(at(&five)));
    assert!(matches!(error, Error::TargetTotal { .. }) && error.to_string().contains("540°"), "{error}");
    let error = refused(&disk, &straight(at(&[(rim[0], None)])));
    assert!(matches!(error, Error::TargetTotal { .. }), "{error}");
    for wrong in [at(&[(0, right)]), at(&[(9999, right)]), at(&[(rim[0], right), (rim[0], right)])] {
        let error = refused(&disk, &straight(wrong));
        assert!(matches!(error, Error::Argument { what: "corner", .. }), "{error}");
    }
    let error = refused(&disk, &straight(at(&[(rim[0], Some(-1.0)), (rim[5], right)])));
    assert!(matches!(error, Error::Argument { .. }) && error.to_string().contains("positive"), "{error}");
    let error = refused(&disk, &straight(Corners::Count(1000)));
    assert!(error.to_string().contains("number of corners"), "{error}");
    let torus = from_soup(&shapes::torus(2.0, 1.0, 12, 8).unwrap());
    let error = refused(&torus, &straight(Corners::Default));
    assert!(error.to_string().contains("no boundary"), "{error}");
}
