//! Tests geodesic boundaries.

use crate::bordered::surfaces::{ORIGIN, check_geodesic, from_soup, uniformized};
use ricci::canonical::QuotientOptions;
use ricci::embed::cover::{elements_to_depth, elements_within};
use ricci::embed::{DeckElement, dirichlet_domain};
use ricci::flow::Options;
use ricci::geometry::Space;
use ricci::mesh::shapes::{self, SplitMix64};
use ricci::mesh::{Double, PerEdge, PerVertex, VertexId};
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

#[test]
fn half_of_a_symmetric_surface_has_the_geodesics_of_the_whole() {
    let (mesh, edges) = shapes::pants([1.5, 2.0, 2.5], 4).unwrap().build().unwrap();
    let half = deformed(&Surface::intrinsic(mesh, edges, Space::H2).unwrap(), 0.2, 11);
    let double = Double::new(half.mesh()).unwrap();
    let lengths = double.spread_edges(half.lengths()).unwrap();
    let whole = Surface::intrinsic(double.mesh.clone(), PerEdge::from(lengths), Space::H2).unwrap();
    let bordered = uniformized(&half, &QuotientOptions::default());
    check_geodesic("half", &bordered);
    let closed = uniformized(&whole, &QuotientOptions::default());
    assert!(closed.report.converged() && closed.boundary.is_empty());
    for (around, outside) in bordered.boundary.iter().zip(half.mesh().boundary_loops()) {
        // Half-edges of the double have the numbers of the half's; edges along the mirror are never flipped.
        let path = half.mesh().boundary_from(outside[0].twin());
        let word = closed.basis.path_word(closed.metric.mesh(), &path).unwrap();
        let length = closed.deck.motion(&word).unwrap().translation_length();
        println!("{length} in the whole, {} in the half", around.length());
        assert!((length - around.length()).abs() < 1e-9);
    }
}

#[test]
fn pieces_of_the_cover_are_named_by_a_free_group() {
    let (mesh, edges) = shapes::pants([2.0, 2.5, 3.0], 3).unwrap().build().unwrap();
    let q = uniformized(&Surface::intrinsic(mesh, edges, Space::H2).unwrap(), &QuotientOptions::default());
    let control = Control::new();
    // The generators c1, c2, c3 with c1 c2 c3 = 1: c3 is a word in the others, so that 1 + 4 + 2 elements have length 1, but each once.
    let near = elements_to_depth(&q.deck, 1, 100, &control).unwrap();
    assert_eq!(near.len(), 7);
    let domain = dirichlet_domain(&q.deck, ORIGIN, q.layout.area, &control).unwrap();
    let within = elements_within(&q.deck, &domain, 6.0, 10_000, &control).unwrap();
    let deep = elements_to_depth(&q.deck, 5, 100_000, &control).unwrap();
    let moved = |g: &DeckElement| g.motion.displacement();
    let expected = deep.iter().filter(|g| moved(g) <= 6.0).count();
    assert!(within.len() > 10 && within.len() == expected, "{} of {expected}", within.len());
    // Every element of a free group that is not the identity is hyperbolic here.
    assert!(within.iter().skip(1).all(|g| f64::from(g.motion.half_trace()).abs() > 1.0));
}

#[test]
fn small_meshes_of_the_corpus_get_geodesic_boundaries() {
    let names = ["pig_7b", "eight_open", "flatmesh_5b", "b9_mesh", "eight_hole", "derived_fertility_3disks"];
    for (name, soup) in crate::common::named("good", &names).into_iter().flatten() {
        let q = uniformized(&from_soup(&soup), &QuotientOptions::default());
        check_geodesic(name, &q);
    }
}
