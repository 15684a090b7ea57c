//! The positions of knots, and splines whose knots coincide.

use crate::spline::{Random, difference, random_surface, square};
use ricci::spline::{KnotOptions, MAX_DEGREE, SplineSpace, multi_indices};
use std::sync::Arc;

fn cross(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

#[test]
fn knots_are_in_general_position_inside_on_straight_sides_and_at_corners() {
    let (n, domain) = (4, square(4));
    for degree in 1..=MAX_DEGREE {
        let knots = domain.knots(degree, &KnotOptions::default()).unwrap();
        for (v, own) in knots.iter().enumerate() {
            let [i, j] = [v % (n + 1), v / (n + 1)];
            let sides = [i == 0 || i == n, j == 0 || j == n];
            assert!(own.len() == degree + 1 && own[0] == domain.vertices[v]);
            match sides {
                [true, true] => assert!(own.iter().all(|knot| *knot == own[0]), "{own:?}"),
                [false, false] => {}
                [x, _] => {
                    let across = if x { 0 } else { 1 };
                    assert!(own.iter().all(|knot| knot[across] == own[0][across]), "{own:?}");
                    assert!((1..=degree).all(|k| own[..k].iter().all(|other| *other != own[k])), "{own:?}");
                }
            }
        }
        // No three knots of a triangle are on a line if its corners are all inside.
        let inner =
            |v: &u32| (1..n).contains(&(*v as usize % (n + 1))) && (1..n).contains(&(*v as usize / (n + 1)));
        let mut seen = 0;
        for triangle in domain.triangles.iter().filter(|t| t.iter().all(inner)) {
            let all: Vec<[f64; 2]> = triangle.iter().flat_map(|&v| knots[v as usize].clone()).collect();
            for (i, &a) in all.iter().enumerate() {
                for (j, &b) in all.iter().enumerate().skip(i + 1) {
                    assert!(
                        all[j + 1..].iter().all(|&c| cross(a, b, c).abs() > 1e-9),
                        "{degree} {triangle:?}"
                    );
                }
            }
            seen += 1;
        }
        assert!(seen >= 8);
    }
}

#[test]
fn many_places_at_a_time_are_the_same_as_one_by_one_for_any_number_of_threads() {
    let domain = square(3);
    let knots = domain.knots(3, &KnotOptions::default()).unwrap();
    let space = Arc::new(SplineSpace::planar(&domain, &knots).unwrap());
    let surface = random_surface(&space);
    let mut random = Random(43);
    // The places are more than one batch.
    let places: Vec<_> = (0..70_000).map(|_| random.place(&space)).collect();
    let control = ricci::Control::new();
    let one = surface.evaluate(&places, 2, 1, &control).unwrap();
    assert_eq!(one, surface.evaluate(&places, 2, 3, &control).unwrap());
    for (found, &at) in one.iter().zip(&places).step_by(997) {
        assert_eq!(*found, surface.surface_point(at).unwrap());
    }
    let values = surface.evaluate(&places, 0, 2, &control).unwrap();
    assert!(one.iter().zip(&values).all(|(a, b)| a.point == b.point && b.first == [[0.0; 3]; 2]));
    assert!(matches!(
        surface.evaluate(&places, 3, 1, &control),
        Err(ricci::Error::Argument { what: "order of derivatives", .. })
    ));
    control.cancel();
    assert_eq!(surface.evaluate(&places, 0, 1, &control).unwrap_err(), ricci::Error::Cancelled);
}

#[test]
fn coincident_knots_make_bezier_triangles() {
    let domain = square(2);
    let all =
        KnotOptions { coincident: (0..domain.vertices.len() as u32).collect(), ..KnotOptions::default() };
    let factorial = |k: usize| (1..=k).map(|i| i as f64).product::<f64>();
    for degree in 1..=MAX_DEGREE {
        let space = Arc::new(SplineSpace::planar(&domain, &domain.knots(degree, &all).unwrap()).unwrap());
        let surface = random_surface(&space);
        let mut random = Random(41);
        for _ in 0..100 {
            let at = random.place(&space);
            let patch = &space.patches()[at.patch as usize];
            let [a, b, c] = [0, 1, 2].map(|k| patch.knots[k][0]);
            let u = [at.x, at.y];
            let weights = [cross(u, b, c), cross(a, u, c), cross(a, b, u)].map(|w| w / cross(a, b, c));
            let mut bernstein = [0.0; 3];
            for (beta, &control) in multi_indices(degree).zip(&patch.control) {
                let powers: f64 =
                    (0..3).map(|k| weights[k].powi(beta[k] as i32) / factorial(beta[k])).product();
                let point = surface.control_points()[control as usize];
                (0..3).for_each(|x| bernstein[x] += factorial(degree) * powers * point[x]);
            }
            assert!(difference(surface.point(at).unwrap(), bernstein) < 1e-13, "{degree} {at:?}");
        }
    }
}

#[test]
fn an_end_with_coincident_knots_goes_through_its_control_point() {
    let domain = square(4);
    let options = KnotOptions { coincident: vec![12], ..KnotOptions::default() };
    let end = |options: &KnotOptions| {
        let space = Arc::new(SplineSpace::planar(&domain, &domain.knots(3, options).unwrap()).unwrap());
        let surface = random_surface(&space);
        let (patch, corner) = domain
            .triangles
            .iter()
            .enumerate()
            .find_map(|(t, corners)| Some((t, corners.iter().position(|&v| v == 12)?)))
            .unwrap();
        let beta = [0, 1, 2].map(|k| if k == corner { 3 } else { 0 });
        let at = multi_indices(3).position(|other| other == beta).unwrap();
        let control = space.patches()[patch].control[at];
        let [x, y] = domain.vertices[12];
        let place = ricci::spline::Parameter { patch: patch as u32, x, y };
        difference(surface.point(place).unwrap(), surface.control_points()[control as usize])
    };
    assert!(end(&options) < 1e-9 && end(&KnotOptions::default()) > 1e-3);
}
