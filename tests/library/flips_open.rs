//! Tests that surfaces with boundary flow on one copy as long as the result is that of the double.

use crate::common::Random;
use crate::common::flips::{SCHEMES, drawn_below, honest, reach, started};
use crate::common::flow::{attempt, euclidean, surface};
use ricci::flow::Options;
use ricci::geometry::Space;
use ricci::mesh::{Double, Mesh, PerEdge, PerVertex, VertexId, shapes};
use ricci::metric::Scheme;
use ricci::{Control, Flow, Target};

/// log of the change of size at the given vertices, its mean subtracted.
fn factor(flow: &Flow, n: usize) -> Vec<f64> {
    let factor = flow.solution().conformal_factor().unwrap();
    let half: Vec<f64> = factor.iter().take(n).copied().collect();
    let mean = half.iter().sum::<f64>() / n as f64;
    half.iter().map(|u| u - mean).collect()
}

/// Flow on the double given as a closed surface of its own.
fn on_the_double(given: &(Mesh, PerEdge<f64>), target: &PerVertex<f64>, scheme: Scheme) -> Flow {
    let double = Double::new(&given.0).unwrap();
    let lengths = double.spread_edges(&given.1).unwrap().into();
    let target = double.target(target).unwrap().into();
    let mut flow = started(&(double.mesh, lengths), (Space::E2, scheme), &Options::default());
    reach(&mut flow, &target, "double");
    flow
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn one_copy_does_where_the_boundary_stays_delaunay() {
    let flat = surface(&shapes::disk(12).unwrap());
    let n = flat.0.n_vertices();
    // Hills inside: the boundary hardly notices.
    let mut target = Target::Boundary.values(&euclidean(&flat.0, &flat.1), Space::E2).unwrap();
    (target[VertexId(0)], target[VertexId(9)]) = (0.3, -0.3);
    for scheme in SCHEMES {
        let mut flow = started(&flat, (Space::E2, scheme), &Options::default());
        let report = reach(&mut flow, &target, "one copy");
        assert!(flow.double().is_none(), "{scheme}");
        assert_eq!(flow.mesh().n_vertices(), n);
        let double = on_the_double(&flat, &target, scheme);
        let worst = distance(&factor(&flow, n), &factor(&double, n));
        println!(
            "one copy, {scheme}: {} steps, {} flips, off by {worst:.1e}",
            report.iterations, report.flips
        );
        assert!(worst < 1e-9, "{scheme}: {worst:e}");
    }
}

#[test]
fn the_flow_goes_on_in_the_double_where_the_boundary_gives_way() {
    let flat = surface(&shapes::disk(8).unwrap());
    let n = flat.0.n_vertices();
    let first = Target::Boundary.values(&euclidean(&flat.0, &flat.1), Space::E2).unwrap();
    let total: f64 = first.iter().sum();
    let mut random = Random::new(4);
    for scheme in SCHEMES {
        let mut left = 0;
        for round in 0..8 {
            let mut flow = started(&flat, (Space::E2, scheme), &Options::default());
            reach(&mut flow, &first, "round");
            assert!(flow.double().is_none(), "{scheme}: one copy to begin with");
            let before = flow.solution();
            // Curvature at random, the boundary included.
            let mut target = PerVertex::from_fn(n, |_: VertexId| f64::from(round) * 0.6 * random.symmetric());
            drawn_below(&mut target, total, 2.8);
            let report = reach(&mut flow, &target, "random");
            left += usize::from(flow.double().is_some());
            if flow.double().is_some() {
                assert_eq!(report.residuals.len(), report.iterations + 1);
            }
            let worst = distance(&factor(&flow, n), &factor(&on_the_double(&flat, &target, scheme), n));
            println!(
                "{}, {scheme}: {} steps, {} flips, off by {worst:.1e}",
                if flow.double().is_some() { "left" } else { "one copy" },
                report.iterations,
                report.flips
            );
            assert!(worst < 1e-8, "{scheme}: {worst:e}");
            // Both go on to the next target, and a flow from either metric ends where they do.
            reach(&mut flow, &first, "round again");
            let mut resumed = Flow::resume(&before, &Options::default(), &Control::new()).unwrap();
            reach(&mut resumed, &first, "resumed");
            assert!(distance(&factor(&flow, n), &factor(&resumed, n)) < 1e-8, "{scheme}");
        }
        assert!((1..8).contains(&left), "{scheme}: {left} of 8");
    }
}

#[test]
fn obtuse_boundaries_begin_on_the_double() {
    let mut rough = shapes::disk(8).unwrap();
    shapes::noise(&mut rough, 0.3, 9).unwrap();
    let rough = surface(&rough);
    for scheme in [Scheme::Yamabe, Scheme::Inversive, Scheme::Virtual] {
        let mut flow = started(&rough, (Space::E2, scheme), &Options::default());
        assert!(flow.double().is_some(), "{scheme}");
        let target = Target::Boundary.values(&euclidean(&rough.0, &rough.1), Space::E2).unwrap();
        let report = attempt(&mut flow, &target);
        let reached = honest(&flow, &report, &target, "rough");
        assert!(reached, "{scheme}: {}", report.stop_reason);
    }
}
