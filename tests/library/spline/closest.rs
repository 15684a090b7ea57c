//! Nearest points of splines over the plane, against dense samples and against points on normals.

use crate::spline::{Random, difference, random_surface, space};
use ricci::spline::{ClosestPoint, Parameter, Spline, SplineSpace};
use ricci::{Control, Error};
use std::sync::Arc;

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|x| (a[x] - b[x]).powi(2)).sum::<f64>().sqrt()
}

/// Hills over the unit square: control points over their abscissas, at heights of a wave.
fn hills(degree: usize) -> Spline {
    let space = space(4, degree);
    let height = |[x, y]: [f64; 2]| [x, y, 0.15 * (7.0 * x).sin() * (5.0 * y).cos()];
    let points = space.abscissas().into_iter().map(height).collect();
    Spline::new(space, points).unwrap()
}

fn find(surface: &Spline, points: &[[f64; 3]], threads: usize) -> Vec<ClosestPoint> {
    surface.closest_points(2, &Control::new()).unwrap().find(points, threads, &Control::new()).unwrap()
}

fn around(n: usize, size: f64) -> Vec<[f64; 3]> {
    let mut random = Random(11);
    (0..n).map(|_| [0; 3].map(|_| 0.5 + size * (random.next() - 0.5))).collect()
}

#[test]
fn no_other_point_is_nearer() {
    let mut random = Random(13);
    for degree in 1..=5 {
        for surface in [hills(degree), random_surface(&space(3, degree))] {
            let places: Vec<Parameter> = (0..20_000).map(|_| random.place(surface.space())).collect();
            let samples = surface.evaluate(&places, 0, 0, &Control::new()).unwrap();
            let points = around(80, 2.0);
            let (mut cells, mut steps) = (0, 0);
            for (point, found) in points.iter().zip(find(&surface, &points, 2)) {
                let nearest =
                    samples.iter().map(|at| distance(at.point, *point)).fold(f64::INFINITY, f64::min);
                assert!(found.distance <= nearest, "{degree} {point:?} {found:?} {nearest}");
                assert_eq!(found.point, surface.point(found.place).unwrap());
                assert!((found.distance - distance(found.point, *point)).abs() < 1e-15);
                (cells, steps) = (cells + found.cells, steps + found.steps);
            }
            assert!(cells < 100 * 80 && steps < 1000 * 80, "{degree}: {cells} {steps}");
        }
    }
}

#[test]
fn points_on_normals_come_back_to_where_the_normals_start() {
    let mut random = Random(17);
    for degree in 2..=5 {
        let surface = hills(degree);
        let places: Vec<Parameter> = (0..300).map(|_| random.place(surface.space())).collect();
        let on = surface.evaluate(&places, 2, 1, &Control::new()).unwrap();
        for far in [0.0f64, 1e-9, -0.003, 0.01] {
            let lifted: Vec<[f64; 3]> = on
                .iter()
                .map(|at| {
                    let normal = at.normal().unwrap();
                    [0, 1, 2].map(|x| at.point[x] + far * normal[x])
                })
                .collect();
            let one = find(&surface, &lifted, 1);
            let mut back = 0;
            for (i, found) in one.iter().enumerate() {
                assert!(found.distance <= far.abs() + 1e-13, "{degree} {far} {i} {found:?}");
                // Beyond the radius of curvature, and near the boundary, another part of the hills can be nearer.
                let bends = on[i].principal_curvatures().unwrap();
                if found.distance < far.abs() - 1e-13 || bends.iter().any(|k| k.abs() * far.abs() > 0.8) {
                    continue;
                }
                back += 1;
                assert!(difference(found.point, on[i].point) < 1e-12, "{degree} {far} {i} {found:?}");
                let moved = (found.place.x - places[i].x).hypot(found.place.y - places[i].y);
                assert!(found.place.patch != places[i].patch || moved < 1e-11, "{moved:e}");
            }
            assert!(back >= 270, "{back}");
            assert_eq!(one, find(&surface, &lifted, 3));
        }
    }
}

#[test]
fn the_nearest_point_may_be_on_the_boundary() {
    let surface = hills(3);
    let points = [[-1.0, -1.0, 0.0], [0.3, -2.0, 0.1], [3.0, 0.5, 0.2]];
    for (point, found) in points.iter().zip(find(&surface, &points, 1)) {
        let Parameter { x, y, .. } = found.place;
        assert!(x.min(y) < 1e-12 || x.max(y) > 1.0 - 1e-12, "{point:?} {found:?}");
    }
    assert!(find(&surface, &[[1e100, 1e100, 0.0]], 1)[0].distance.is_finite());
    let Parameter { x, y, .. } = find(&surface, &points[..1], 1)[0].place;
    assert_eq!([x, y], [0.0; 2]);
}

#[test]
fn what_has_no_nearest_point_is_refused_by_name() {
    let surface = hills(2);
    let finder = surface.closest_points(2, &Control::new()).unwrap();
    for bad in [f64::NAN, f64::INFINITY, -1e200] {
        let found = finder.find(&[[0.0; 3], [0.0, bad, 0.0]], 1, &Control::new());
        assert!(matches!(found, Err(Error::Argument { what: "point", ref value, .. }) if value == "1"));
    }
    assert!(finder.find(&[], 1, &Control::new()).unwrap().is_empty());
    let control = Control::new();
    control.cancel();
    assert_eq!(finder.find(&[[0.0; 3]], 1, &control), Err(Error::Cancelled));
    let none = Spline::new(Arc::new(SplineSpace::new(2, vec![], vec![]).unwrap()), vec![]).unwrap();
    assert!(matches!(
        none.closest_points(1, &Control::new()).map(|_| ()),
        Err(Error::Argument { what: "patches", .. })
    ));
    // The surface is a single point.
    let point =
        Spline::new(surface.space().clone(), vec![[1.0; 3]; surface.space().n_control_points()]).unwrap();
    assert!((find(&point, &[[1.0, 1.0, 3.0]], 1)[0].distance - 2.0).abs() < 1e-14);
}
