//! Values and derivatives against exact rational arithmetic (`tests/vectors/splines.py`).

use crate::common::hex;
use crate::difference;
use ricci::spline::{Domain, Parameter, Spline, SplineSpace, basis_size};
use std::collections::HashMap;
use std::sync::Arc;

/// Largest errors of values, first and second derivatives of splines with control points between −1 and 1 over triangles of size 4. What is
/// given is exact. A value is a sum of at most five steps of the recurrence, each of them a mean with weights that may be negative where a
/// point lies outside the triangle of the step; a derivative divides by the size of such a triangle.
const ERRORS: [f64; 3] = [1e-15, 5e-15, 3e-13];

/// One block of the file.
struct Golden<'a>(HashMap<&'a str, Vec<&'a str>>, Vec<Vec<&'a str>>);

impl<'a> Golden<'a> {
    fn parse(block: &'a str) -> Golden<'a> {
        let lines = block.lines().filter_map(|line| line.split_once(' '));
        let words = |text: &'a str| text.split(' ').collect();
        let (places, given): (Vec<_>, Vec<_>) = lines.partition(|(key, _)| *key == "place");
        Golden(
            given.into_iter().map(|(key, rest)| (key, words(rest))).collect(),
            places.into_iter().map(|(_, rest)| words(rest)).collect(),
        )
    }

    fn rows<const D: usize>(&self, key: &str) -> Vec<[f64; D]> {
        let numbers: Vec<f64> = self.0[key].iter().map(|x| hex(x)).collect();
        numbers.as_chunks().0.to_vec()
    }

    fn surface(&self) -> Spline {
        let degree: usize = self.0["spline"][0].parse().unwrap();
        let corners: Vec<u32> = self.0["triangles"].iter().map(|x| x.parse().unwrap()).collect();
        let domain = Domain { vertices: self.rows("vertices"), triangles: corners.as_chunks().0.to_vec() };
        let knots: Vec<Vec<[f64; 2]>> =
            self.rows::<2>("knots").chunks_exact(degree + 1).map(<[_]>::to_vec).collect();
        let space = SplineSpace::planar(&domain, &knots).unwrap();
        let mut points = vec![None; space.n_control_points()];
        let given = self.rows::<3>("control");
        for (patch, given) in space.patches().iter().zip(given.chunks_exact(basis_size(degree))) {
            for (&control, &point) in patch.control.iter().zip(given) {
                // Where the polar arguments are equal, so are the points of the file.
                assert!(points[control as usize].replace(point).is_none_or(|other| other == point));
            }
        }
        Spline::new(Arc::new(space), points.into_iter().map(Option::unwrap).collect()).unwrap()
    }
}

#[test]
fn values_and_derivatives_are_those_of_exact_arithmetic() {
    let (mut blocks, mut worst) = (0, [0.0f64; 3]);
    for block in include_str!("../vectors/splines.txt").split("end\n").filter(|block| !block.is_empty()) {
        let golden = Golden::parse(block);
        let surface = golden.surface();
        assert_eq!(golden.1.len(), 6);
        for row in &golden.1 {
            let x: Vec<f64> = row[1..].iter().map(|x| hex(x)).collect();
            let at = Parameter { patch: row[0].parse().unwrap(), x: x[0], y: x[1] };
            let found = surface.surface_point(at).unwrap();
            let exact = x[2..].as_chunks::<3>().0;
            let ours = [found.point].into_iter().chain(found.first).chain(found.second);
            for ((ours, exact), order) in ours.zip(exact).zip([0, 1, 1, 2, 2, 2]) {
                worst[order] = worst[order].max(difference(ours, *exact));
            }
        }
        assert!((0..3).all(|order| worst[order] < ERRORS[order]), "{:?}: {worst:?}", golden.0["spline"]);
        blocks += 1;
    }
    assert_eq!(blocks, 10);
    println!("values, first and second derivatives within {worst:?}");
}
