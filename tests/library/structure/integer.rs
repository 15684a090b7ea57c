//! Integer structures: whole coordinates, transitions that turn by multiples of 90° and move by whole numbers, cones where they belong.

use crate::structure::{check, glued, made, of, options};
use ricci::mesh::{FaceId, VertexId, shapes};
use ricci::structure::{Atlas, AtlasOptions, ChartKind, GroupElement, Structure, atlas};
use ricci::{Control, Error, Surface};
use std::collections::BTreeSet;

fn is_whole(x: f64) -> bool {
    x == x.round() && x.abs() < 1e6
}

fn check_integers(name: &str, found: &Atlas) {
    for chart in &found.charts {
        assert!(chart.coordinates.iter().flatten().all(|&x| is_whole(x)), "{name}: {:?}", chart.coordinates);
    }
    let elements = found.transitions.iter().map(|t| t.element);
    let holonomy = (0..found.holonomy.group.n_generators())
        .filter_map(|k| found.holonomy.element(Structure::Integer, k));
    for element in elements.chain(holonomy) {
        let GroupElement::Projective(m) = element else { panic!("{element:?}") };
        assert!(m.iter().all(|&x| is_whole(x)), "{name}: {m}");
        let [cos, sin] = [m[(0, 0)], m[(1, 0)]];
        assert!(cos.abs() + sin.abs() == 1.0 && m[(1, 1)] == cos && m[(0, 1)] == -sin, "{name}: {m}");
    }
    assert_eq!(found.transition_residual(), 0.0, "{name}");
}

/// The cones of the quads are the singular vertices, and their curvature adds up.
fn check_cones(name: &str, surface: &Surface, found: &Atlas) {
    let mesh = &found.mesh;
    assert_eq!(found.on_given.as_ref().map(Vec::len), Some(mesh.n_vertices()), "{name}");
    assert_eq!(mesh.euler(), surface.mesh().euler(), "{name}");
    let mut valences = vec![0i64; mesh.n_vertices()];
    for q in 0..mesh.n_faces() / 2 {
        let halves = [2 * q, 2 * q + 1].map(|f| mesh.face_vertices(FaceId::from(f)));
        let corners: BTreeSet<VertexId> = halves.into_iter().flatten().collect();
        assert_eq!(corners.len(), 4, "{name}");
        corners.into_iter().for_each(|v| valences[v.index()] += 1);
    }
    let is_singular = |v: &VertexId| valences[v.index()] != 4 && !mesh.is_boundary_vertex(*v);
    assert_eq!(found.singular_vertices, mesh.vertices().filter(is_singular).collect::<Vec<_>>(), "{name}");
    if surface.mesh().is_closed() {
        let turns: i64 = valences.iter().map(|k| 4 - k).sum();
        assert_eq!(turns, 4 * surface.mesh().euler(), "{name}");
    }
}

#[test]
fn coordinates_and_transitions_of_quads_are_whole() {
    for (name, surface) in [
        ("torus", of(shapes::torus(2.0, 1.0, 24, 14))),
        ("genus 2", of(shapes::genus(2, 6))),
        ("ellipsoid", of(shapes::ellipsoid([1.6, 1.0, 0.7], 8))),
        ("disk", of(shapes::disk(8))),
        ("annulus", of(shapes::annulus(0.4, 1.0, 6, 30))),
    ] {
        for (charts, quads) in [(ChartKind::Stars, Some(400)), (ChartKind::Patches, None)] {
            let found = made(&surface, &AtlasOptions { quads, ..options(Structure::Integer, charts) });
            check(name, &found, 1e-11);
            check_integers(name, &found);
            check_cones(name, &surface, &found);
        }
    }
}

#[test]
fn a_torus_without_cones_is_a_torus_of_squares() {
    let found =
        made(&glued(shapes::flat_torus([0.3, 1.2], 5, 7)), &options(Structure::Integer, ChartKind::Stars));
    assert!(found.singular_vertices.is_empty());
    // Both holonomies are translations that span a lattice of as many squares as there are.
    let moves = [0, 1].map(|k| {
        let element = found.holonomy.element(Structure::Integer, k).unwrap();
        let GroupElement::Projective(m) = element else { panic!("{element:?}") };
        assert_eq!((m[(0, 0)], m[(1, 0)]), (1.0, 0.0));
        [m[(0, 2)], m[(1, 2)]]
    });
    let area = (moves[0][0] * moves[1][1] - moves[0][1] * moves[1][0]).abs();
    assert_eq!(area, found.mesh.n_faces() as f64 / 2.0);
}

#[test]
fn the_number_of_quads_belongs_to_integer_structures() {
    let surface = of(shapes::torus(2.0, 1.0, 12, 8));
    let asked = AtlasOptions { quads: Some(100), ..options(Structure::Affine, ChartKind::Stars) };
    assert!(matches!(atlas(&surface, &asked, &Control::new()), Err(Error::Argument { what: "quads", .. })));
}
