//! Geodesic boundaries.

use crate::surfaces::{check_geodesic, from_soup, uniformized};
use ricci::canonical::QuotientOptions;
use ricci::flow::Options;
use ricci::geometry::Space;
use ricci::mesh::shapes::{self, SplitMix64};
use ricci::mesh::{PerVertex, VertexId};
use ricci::{Class, Control, Flow, Surface, Target};

/// Another metric of the conformal class of a surface in H²: flown to random curvature, on its own triangulation.
fn deformed(surface: &Surface, size: f64, seed: u64) -> Surface {
    let (control, mut random) = (Control::new(), SplitMix64::new(seed));
    let class = Class::yamabe(Space::H2);
    let mut flow = Flow::new(surface.clone(), class, &Options::default(), &control).unwrap();
    let target = PerVertex::from_fn(surface.mesh().n_vertices(), |_: VertexId| size * (random.unit() - 0.5));
    let moved = flow.solve(&Target::All(target), &control).unwrap();
    assert!(moved.converged() && moved.double().is_none());
    let range = |f: fn(f64, f64) -> f64| moved.conformal_factor().unwrap().iter().copied().fold(0.0, f);
    println!("u from {:.2} to {:.2}", range(f64::min), range(f64::max));
    let lengths = moved.metric().lengths(moved.mesh()).unwrap();
    Surface::intrinsic(moved.mesh().clone(), lengths, Space::H2).unwrap()
}

#[test]
fn pants_return_the_boundary_lengths_that_they_were_made_with() {
    for (lengths, size) in [([2.0, 2.0, 2.0], 0.05), ([1.0, 2.0, 3.0], 0.05), ([0.5, 4.0, 1.5], 0.03)] {
        let (mesh, edges) = shapes::pants(lengths, 4).unwrap().build().unwrap();
        let pants = Surface::intrinsic(mesh, edges, Space::H2).unwrap();
        let moved = deformed(&pants, size, 7);
        assert_ne!(moved.lengths(), pants.lengths());
        let q = uniformized(&moved, &QuotientOptions::default());
        let name = format!("pants {lengths:?}");
        check_geodesic(&name, &q);
        let mut found: Vec<f64> = q.boundary.iter().map(|around| around.length()).collect();
        let mut wanted = lengths.to_vec();
        found.sort_by(f64::total_cmp);
        wanted.sort_by(f64::total_cmp);
        let worst = found.iter().zip(&wanted).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        println!("{name}: lengths off by {worst:.1e}, {} flips", q.metric.flips());
        assert!(worst < 1e-8, "{name}: {found:?}");
    }
}

#[test]
fn open_surfaces_of_every_topology_get_geodesic_boundaries() {
    let holes = |soup, n| shapes::punch(&soup, n).unwrap();
    for (name, soup) in [
        ("sphere, 3 holes", holes(shapes::icosphere(4).unwrap(), 3)),
        ("sphere, 7 holes", holes(shapes::icosphere(4).unwrap(), 7)),
        ("torus, 1 hole", holes(shapes::torus(2.0, 1.0, 24, 12).unwrap(), 1)),
        ("torus, 3 holes", holes(shapes::torus(2.0, 1.0, 24, 12).unwrap(), 3)),
        ("genus 2, 1 hole", holes(shapes::genus(2, 3).unwrap(), 1)),
        ("genus 3, 2 holes", holes(shapes::genus(3, 3).unwrap(), 2)),
    ] {
        let q = uniformized(&from_soup(&soup), &QuotientOptions::default());
        println!("{name}: on {}", if q.metric.double().is_some() { "its double" } else { "one copy" });
        check_geodesic(name, &q);
    }
}
