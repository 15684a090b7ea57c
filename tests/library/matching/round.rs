//! Boundary loops that become circles: they are round, both surfaces lie along them, and no face folds.

use super::samples::{apart, check_map, potato, surface};
use ricci::geometry::Space;
use ricci::matching::{BoundaryMatching, LoopShape, MatchOptions, Matching, match_surfaces};
use ricci::mesh::{VertexId, shapes};
use ricci::{Control, Error, Surface};
use std::collections::HashMap;
use std::f64::consts::TAU;

fn in_circles(source: &Surface, target: &Surface, boundary: BoundaryMatching) -> Result<Matching, Error> {
    let options = MatchOptions { loop_shape: LoopShape::Circles, boundary, ..MatchOptions::default() };
    match_surfaces(source, target, &options, &Control::new())
}

/// The boundary loops of a triangulation in the plane as the vectors along their edges, which the deck transformations, translations, do
/// not change.
fn steps(matching: &Matching, side: usize) -> Vec<Vec<[f64; 2]>> {
    let mut along: HashMap<(VertexId, VertexId), [f64; 2]> = HashMap::new();
    for triangle in matching.domain.triangles(side) {
        for k in 0..3 {
            let [a, b] = [k, (k + 1) % 3].map(|k| (triangle.vertices[k], triangle.corners[k]));
            along.insert((a.0, b.0), [b.1[0] - a.1[0], b.1[1] - a.1[1]]);
        }
    }
    let rim: HashMap<VertexId, (VertexId, [f64; 2])> = along
        .iter()
        .filter(|((a, b), _)| !along.contains_key(&(*b, *a)))
        .map(|(&(a, b), &step)| (a, (b, step)))
        .collect();
    let mut starts: Vec<VertexId> = rim.keys().copied().collect();
    starts.sort_unstable();
    let (mut seen, mut loops) = (Vec::new(), Vec::new());
    for start in starts {
        let (mut v, mut steps) = (start, Vec::new());
        while !seen.contains(&v) {
            seen.push(v);
            steps.push(rim[&v].1);
            v = rim[&v].0;
        }
        if !steps.is_empty() {
            loops.push(steps);
        }
    }
    loops
}

/// The radius of the circle through points a third of a closed polygon apart, and the largest distance of a corner from it as a share of
/// that.
fn circle(steps: &[[f64; 2]]) -> [f64; 2] {
    let mut points = vec![[0.0; 2]];
    for step in steps {
        let [x, y] = points[points.len() - 1];
        points.push([x + step[0], y + step[1]]);
    }
    let [x, y] = points.pop().unwrap();
    assert!(x.hypot(y) < 1e-10, "the loop does not close by {:e}", x.hypot(y));
    let [p, q] = [1, 2].map(|k| points[k * points.len() / 3]);
    // The centre is at equal distances from 0, p and q.
    let [pp, qq] = [p, q].map(|[x, y]| 0.5 * (x * x + y * y));
    let det = p[0] * q[1] - p[1] * q[0];
    let centre = [(pp * q[1] - qq * p[1]) / det, (p[0] * qq - q[0] * pp) / det];
    let far = |p: &[f64; 2]| (p[0] - centre[0]).hypot(p[1] - centre[1]);
    let radius = far(&points[0]);
    [radius, points.iter().map(|p| (far(p) / radius - 1.0).abs()).fold(0.0, f64::max)]
}

#[test]
fn loops_of_tori_become_circles_and_no_face_folds() {
    let torus = |small: f64, holes: usize| {
        surface(&shapes::punch(&shapes::torus(1.0, small, 36, 14).unwrap(), holes).unwrap())
    };
    let mut matched = 0;
    for holes in [1, 3] {
        let both = [torus(0.3, holes), torus(0.5, holes)];
        for (source, target) in [(&both[0], &both[1]), (&both[1], &both[0])] {
            let matching = in_circles(source, target, BoundaryMatching::Slides).unwrap();
            check_map(&matching, source, target);
            assert_eq!((matching.space, matching.holes.len()), (Space::E2, holes));
            assert!(matching.outside < 1e-9, "{:e}", matching.outside);
            let mut radii: Vec<f64> = matching.holes.iter().map(|hole| hole.radius).collect();
            radii.sort_by(f64::total_cmp);
            for side in 0..2 {
                let loops = steps(&matching, side);
                let mut circles: Vec<[f64; 2]> = loops.iter().map(|steps| circle(steps)).collect();
                circles.sort_by(|a, b| a[0].total_cmp(&b[0]));
                assert_eq!(circles.len(), holes);
                for ([radius, off], named) in circles.iter().zip(&radii) {
                    assert!(*off < 1e-9 && (radius / named - 1.0).abs() < 1e-9, "{radius} {off:e} {named}");
                }
                // Chords bend by a full turn around each hole, clockwise with the surface on the left.
                for steps in &loops {
                    let turn = |k: usize| {
                        let [a, b] = [steps[k], steps[(k + 1) % steps.len()]];
                        (a[0] * b[1] - a[1] * b[0]).atan2(a[0] * b[0] + a[1] * b[1])
                    };
                    let total: f64 = (0..steps.len()).map(turn).sum();
                    assert!((total + TAU).abs() < 1e-9, "{total}");
                }
            }
            matched += 1;
        }
    }
    assert_eq!(matched, 4);
}

#[test]
fn surfaces_with_round_holes_go_to_themselves_by_the_identity() {
    let torus = shapes::punch(&shapes::torus(2.0, 0.8, 36, 18).unwrap(), 3).unwrap();
    let genus = shapes::punch(&shapes::genus(2, 6).unwrap(), 2).unwrap();
    for (name, surface, space) in
        [("torus", surface(&torus), Space::E2), ("genus 2", surface(&genus), Space::H2)]
    {
        for boundary in [BoundaryMatching::Slides, BoundaryMatching::ArcLength] {
            let matching = in_circles(&surface, &surface, boundary).unwrap();
            check_map(&matching, &surface, &surface);
            assert_eq!(matching.space, space);
            assert!(matching.holes.iter().all(|hole| hole.deviation < 1e-9), "{name}");
            assert!(apart(&matching, &surface) < 1e-8, "{name}: {:e}", apart(&matching, &surface));
        }
    }
}

#[test]
fn landmarks_inside_are_refused_beside_round_holes() {
    let torus = surface(&shapes::punch(&shapes::torus(2.0, 0.8, 36, 18).unwrap(), 2).unwrap());
    let inside = torus.mesh().vertices().find(|&v| !torus.mesh().is_boundary_vertex(v)).unwrap();
    let options = MatchOptions {
        landmarks: vec![[inside; 2]],
        loop_shape: LoopShape::Circles,
        ..MatchOptions::default()
    };
    let error = match_surfaces(&torus, &torus, &options, &Control::new()).unwrap_err();
    assert!(
        error.code() == 650 && error.to_string().contains("1 landmarks inside the surfaces and round holes"),
        "{error}"
    );
}

#[test]
fn surfaces_without_handles_or_boundary_have_no_round_holes() {
    let torus = surface(&shapes::torus(2.0, 0.8, 12, 8).unwrap());
    let ball = surface(&shapes::punch(&potato(6), 3).unwrap());
    for (surface, words) in [(torus, "genus 1 and 0 boundary loops"), (ball, "genus 0 and 3 boundary loops")]
    {
        let error = in_circles(&surface, &surface, BoundaryMatching::Slides).unwrap_err();
        assert!(error.code() == 650 && error.to_string().contains(words), "{error}");
    }
}
