//! Tests of fundamental domains: side pairings, and paths across them.

use crate::homotopy::samples::*;
use crate::surfaces::Random;
use ricci::mesh::{HalfedgeId, Mesh, PerEdge, VertexId};
use ricci::topology::*;
use ricci::{Control, Error};
use std::collections::BTreeSet;

fn check(name: &str, mesh: &Mesh, basis: &HomotopyBasis, is_cut: &PerEdge<bool>, random: &mut Random) {
    let domain = FundamentalDomain::new(mesh, is_cut, basis).unwrap();
    let (group, n) = (basis.group, domain.sides.len());
    assert_eq!(domain.corners.len(), n);
    let mut covered = BTreeSet::new();
    for (k, side) in domain.sides.iter().enumerate() {
        // The sides follow each other around D, and so do their lifts.
        assert_eq!(domain.corners[k].vertex, mesh.origin(side.halfedges[0]), "{name}");
        let along: Vec<_> = basis.lift(mesh, &domain.corners[k], &side.halfedges).unwrap().collect();
        let (end, next) = (&along[along.len() - 1], &domain.corners[(k + 1) % n]);
        assert_eq!(end.vertex, next.vertex, "{name}");
        assert!(group.equal(&end.element, &next.element), "{name}: the lifts of the sides do not close");
        for &h in &side.halfedges {
            assert!(!mesh.is_outside(h) && covered.insert(h.0), "{name}");
            assert!(is_cut[h.edge()] || mesh.is_boundary_edge(h.edge()), "{name}");
        }
        let Some(j) = side.partner else {
            assert!(side.halfedges.iter().all(|h| mesh.is_boundary_edge(h.edge())), "{name}");
            assert!(side.element.is_empty());
            continue;
        };
        let partner = &domain.sides[j];
        assert_eq!((partner.partner, &partner.halfedges), (Some(k), &reversed(&side.halfedges)), "{name}");
        assert!(group.is_trivial(&side.element.times(&partner.element)), "{name}");
        // The element maps the partner's lift, vertex by vertex, to this side's.
        let across: Vec<_> = basis.lift(mesh, &domain.corners[j], &partner.halfedges).unwrap().collect();
        for (here, there) in along.iter().zip(across.iter().rev()) {
            assert_eq!(here.vertex, there.vertex, "{name}");
            assert!(group.equal(&here.element, &side.element.times(&there.element)), "{name}: side {k}");
        }
    }
    let walls: usize =
        mesh.edges().map(|e| if mesh.is_boundary_edge(e) { 1 } else { 2 * usize::from(is_cut[e]) }).sum();
    assert_eq!(covered.len(), walls, "{name}: every wall is on the polygon once");

    // A loop through the base corner: the product of the crossed sides' elements is its element, a generator for the loops of the basis.
    let product = |path: &[HalfedgeId]| {
        let crossed = domain.crossings(mesh, domain.base_corner, path).unwrap();
        crossed.iter().fold(Word::identity(), |w, &k| w.times(&domain.sides[k].element))
    };
    for steps in [0, 3, 30, 100] {
        let path = random_loop(mesh, basis, steps, random);
        assert!(group.equal(&product(&path), &basis.path_word(mesh, &path).unwrap()), "{name}");
    }
    for (k, path) in basis.loops.iter().enumerate() {
        assert!(group.equal(&product(path), &Word::from_iter([Letter::generator(k)])), "{name}");
    }
    let start = domain.corners[0].vertex;
    let corner = domain.sides[0].halfedges[0];
    let elsewhere =
        mesh.face_halfedges(mesh.face(corner).unwrap()).into_iter().find(|&h| mesh.origin(h) != start);
    if let Some(h) = elsewhere {
        assert!(matches!(domain.crossings(mesh, h, &[corner]), Err(Error::Argument { .. })));
    }
}

fn check_all(surfaces: Vec<Surface>) {
    let mut random = Random(6);
    for (name, mesh, lengths) in surfaces {
        let basis = basis_of(&mesh, &lengths);
        let sphere = mesh.euler() == 2;
        if !sphere {
            check(&name, &mesh, &basis, &basis.cut(&mesh), &mut random);
            // The polygon of the basis itself: its elements are the transitions, its corners those of the basis.
            let polygon = FundamentalDomain::new(&mesh, &basis.cut(&mesh), &basis).unwrap();
            for (side, corner) in polygon.sides.iter().zip(&polygon.corners) {
                let h = side.halfedges[0];
                assert!(basis.group.equal(&side.element, &basis.transition(&mesh, h)), "{name}");
                assert!(basis.group.equal(&corner.element, &basis.corner_word(h)), "{name}");
            }
            let cut = cut_graph(&mesh, &lengths, &[], &Control::new()).unwrap();
            check(&name, &mesh, &basis, &cut.is_cut, &mut random);
        }
        let mut cones = random.vertices(&mesh, 5);
        cones.extend([VertexId(0), VertexId(1)].into_iter().filter(|v| v.index() < mesh.n_vertices()));
        let cut = cut_graph(&mesh, &lengths, &cones, &Control::new()).unwrap();
        check(&name, &mesh, &basis, &cut.is_cut, &mut random);
    }
}

#[test]
fn sides_of_domains_are_paired_by_their_elements() {
    check_all(generated());
}

#[test]
fn sides_of_domains_of_the_corpus_are_paired_by_their_elements() {
    check_all(corpus());
}

#[test]
fn a_cut_that_leaves_no_disk_is_refused() {
    for (name, mesh, lengths) in generated().into_iter().filter(|(_, mesh, _)| mesh.is_closed()) {
        let basis = basis_of(&mesh, &lengths);
        for cut in [PerEdge::filled(mesh.n_edges(), false), PerEdge::filled(mesh.n_edges(), true)] {
            assert!(matches!(FundamentalDomain::new(&mesh, &cut, &basis), Err(Error::Layout(_))), "{name}");
        }
        let short = PerEdge::filled(1, true);
        assert!(matches!(FundamentalDomain::new(&mesh, &short, &basis), Err(Error::Size { .. })), "{name}");
    }
}
