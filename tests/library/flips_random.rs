//! A thousand random targets, and the same target from random triangulations.

use crate::common;
use crate::common::Random;
use crate::common::flips::{SCHEMES, drawn_below, reach, shuffle, started};
use crate::common::flow::{euclidean, prescribing_target, surface};
use ricci::Class;
use ricci::flow::Options;
use ricci::geometry::Space;
use ricci::mesh::{Mesh, PerEdge, PerVertex, shapes};
use std::collections::BTreeMap;
use std::f64::consts::PI;

/// Steps that a flow should not need more of.
const MOST: usize = 50;

/// Curvature of the vertices of a closed surface, three kinds in turn: uniform in (−2π, 2π) about its mean at every vertex; at one
/// in twenty, the others alike; at eight, the others flat. Drawn towards the mean as far as 2π asks for.
fn random_target(mesh: &Mesh, round: usize, random: &mut Random) -> PerVertex<f64> {
    let (n, total) = (mesh.n_vertices(), 2.0 * PI * mesh.euler() as f64);
    let below = 2.0 * PI - 0.05;
    if round.is_multiple_of(3) {
        let mut at = PerVertex::from_fn(8, |_: ricci::mesh::VertexId| 2.0 * PI * random.symmetric());
        drawn_below(&mut at, total, below);
        let mut target = PerVertex::filled(n, 0.0);
        let stride = 1 + random.below(n / 8 - 1);
        let first = random.below(n);
        at.iter().enumerate().for_each(|(k, x)| target[((first + k * stride) % n).into()] = *x);
        return target;
    }
    let every = if round % 3 == 1 { 1 } else { 20 };
    let mut target = PerVertex::from_fn(n, |_| {
        let k = 2.0 * PI * random.symmetric();
        if random.below(every) == 0 { k } else { 0.0 }
    });
    drawn_below(&mut target, total, below);
    target
}

/// Flow to random targets on one surface and print how many steps were taken how often. Returns those with more than [`MOST`].
fn slow_flows_to_random_targets(surface: &(Mesh, PerEdge<f64>), rounds: usize, seed: u64) -> usize {
    let mut random = Random::new(seed);
    let mut counts = BTreeMap::<usize, usize>::new();
    let mut most_flips = 0;
    let options = Options::default();
    for round in 0..rounds {
        let target = random_target(&surface.0, round, &mut random);
        let scheme = SCHEMES[round / 3 % 2];
        let mut flow = started(surface, (Space::E2, scheme), &options);
        let report = reach(&mut flow, &target, &format!("round {round} {scheme}"));
        *counts.entry(report.iterations).or_default() += 1;
        most_flips = most_flips.max(report.flips);
    }
    let often: Vec<_> = counts.iter().map(|(steps, count)| format!("{steps}: {count}")).collect();
    let (n, often) = (surface.0.n_vertices(), often.join(", "));
    println!("V = {n}, {rounds} targets; steps and how often: {often}; at most {most_flips} flips");
    counts.range(MOST + 1..).map(|(_, count)| count).sum()
}

#[test]
fn three_hundred_random_targets_on_a_sphere_are_reached() {
    assert_eq!(slow_flows_to_random_targets(&surface(&shapes::icosphere(10).unwrap()), 300, 11), 0);
}

#[test]
fn two_hundred_random_targets_on_genus_two_are_reached() {
    assert_eq!(slow_flows_to_random_targets(&surface(&shapes::genus(2, 2).unwrap()), 200, 12), 0);
    assert_eq!(slow_flows_to_random_targets(&surface(&shapes::genus(2, 3).unwrap()), 20, 12), 0);
    // Random curvature at every vertex asks for lengths of a range that grows with their number, and for more steps.
    assert!(slow_flows_to_random_targets(&surface(&shapes::genus(2, 4).unwrap()), 20, 12) <= 4);
}

#[test]
fn the_result_depends_on_the_metric_and_not_on_its_triangulation() {
    let mut tall = shapes::ellipsoid([1.0, 1.0, 3.0], 5).unwrap();
    shapes::noise(&mut tall, 0.1, 4).unwrap();
    let mut bumpy = shapes::torus(2.0, 0.7, 24, 12).unwrap();
    shapes::noise(&mut bumpy, 0.1, 5).unwrap();
    let mut genus = shapes::genus(2, 3).unwrap();
    shapes::noise(&mut genus, 0.05, 6).unwrap();
    let mut open = shapes::disk(8).unwrap();
    shapes::noise(&mut open, 0.1, 7).unwrap();
    let cases = [("sphere", tall), ("torus", bumpy), ("genus 2", genus), ("disk", open)];
    for (seed, (name, soup)) in cases.into_iter().enumerate() {
        let given = surface(&soup);
        let mut other = given.clone();
        let mut random = Random::new(seed as u64);
        let (tries, edges) = (3 * given.0.n_edges(), given.0.n_edges());
        let flips = shuffle(&mut other.0, &mut other.1, tries, &mut random);
        assert!(2 * flips > edges, "{name}: {flips} of {edges} edges");
        let curved = (given.0.euler() < 0).then_some(Space::H2);
        for space in [Space::E2].into_iter().chain(curved) {
            let whole = euclidean(&given.0, &given.1);
            let target = prescribing_target(&whole, space);
            let target = target.resolve(&whole, Class::yamabe(space)).unwrap();
            for scheme in SCHEMES {
                let what = format!("{name} {space} {scheme}, {flips} flips");
                let run = |surface: &(Mesh, PerEdge<f64>)| {
                    let mut flow = started(surface, (space, scheme), &Options::default());
                    reach(&mut flow, &target, &what);
                    flow.metric().u.clone()
                };
                let (one, two) = (run(&given), run(&other));
                let worst = common::flow::distance(&one, &two);
                println!("{what}: u differs by {worst:.1e}");
                assert!(worst < 1e-8, "{what}: {worst:e}");
            }
        }
    }
}
