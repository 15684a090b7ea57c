//! Tests of the rules of the half-edge structure on small surfaces; `validate` finds each broken one.
use super::{Mesh, OUTSIDE};
use crate::mesh::VertexId;

/// A disk of four faces around vertex 0, an annulus, a tetrahedron, the one-vertex torus, and a cone whose face is glued to itself along
/// one edge and whose boundary is a loop edge.
fn surfaces() -> Vec<Mesh> {
    let fan = Mesh::from_faces(5, &[[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]]);
    let annulus = Mesh::from_faces(6, &[[0, 1, 3], [1, 4, 3], [1, 2, 4], [2, 5, 4], [2, 0, 5], [0, 3, 5]]);
    let tetrahedron = Mesh::from_faces(4, &[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]);
    let torus = Mesh::from_gluing(1, &[[0; 3]; 2], &[[2, -3, 1], [-1, -2, 3]]);
    let cone = Mesh::from_gluing(2, &[[0, 1, 1]], &[[2, -1, 1]]);
    let surfaces: Vec<Mesh> = [fan, annulus, tetrahedron, torus, cone].into_iter().flatten().collect();
    assert_eq!(surfaces.len(), 5);
    surfaces
}

#[test]
fn euler_genus_and_boundary_of_known_surfaces() {
    let counts = |m: &Mesh| (m.euler(), m.genus(), m.boundary_loops().len(), m.is_closed());
    let expected = [(1, 0, 1, false), (0, 0, 2, false), (2, 0, 0, true), (0, 1, 0, true), (1, 0, 1, false)];
    assert_eq!(surfaces().iter().map(counts).collect::<Vec<_>>(), expected);
}

#[test]
fn next_prev_twin_and_corners_agree() {
    for mesh in surfaces() {
        for f in mesh.faces() {
            let [ab, bc, ca] = mesh.face_halfedges(f);
            assert_eq!([mesh.next(ab), mesh.next(bc), mesh.next(ca)], [bc, ca, ab]);
            assert_eq!([mesh.prev(ab), mesh.prev(bc), mesh.prev(ca)], [ca, ab, bc]);
            assert_eq!(mesh.face_vertices(f), [ab, bc, ca].map(|h| mesh.origin(h)));
            assert_eq!(mesh.opposite_edges(f), [bc, ca, ab].map(|h| h.edge()));
            assert!([ab, bc, ca].iter().all(|&h| mesh.face(h) == Some(f)));
        }
        for h in mesh.halfedges() {
            assert_eq!((mesh.tip(h), h.twin().twin(), h.twin().edge()), (mesh.origin(h.twin()), h, h.edge()));
            assert!(mesh.ends(h.edge()).contains(&mesh.origin(h)));
        }
    }
}

#[test]
fn every_half_edge_leaves_exactly_one_vertex() {
    for mesh in surfaces() {
        let mut left: Vec<_> = mesh.vertices().flat_map(|v| mesh.outgoing(v).map(move |h| (h, v))).collect();
        assert!(left.iter().all(|&(h, v)| mesh.origin(h) == v));
        left.sort_unstable();
        assert!(left.iter().map(|&(h, _)| h).eq(mesh.halfedges()));
    }
}

#[test]
fn outgoing_turns_clockwise_from_the_outside() {
    let fan = &surfaces()[0];
    let tips = |v: u32| fan.outgoing(VertexId(v)).map(|h| fan.tip(h).0).collect::<Vec<_>>();
    let mut around = tips(0);
    let first = around.iter().position(|&v| v == 4);
    around.rotate_left(first.unwrap_or(0));
    assert_eq!(around, [4, 3, 2, 1]);
    // At the rim: first the half-edge outside, with the surface on its right, last the one inside.
    assert_eq!(tips(1), [4, 0, 2]);
    assert!(fan.is_outside(fan.out(VertexId(1))) && fan.is_boundary_vertex(VertexId(1)));
    assert!(!fan.is_boundary_vertex(VertexId(0)));
}

#[test]
fn boundary_loops_run_with_the_surface_on_their_right() {
    for mesh in surfaces() {
        let loops = mesh.boundary_loops();
        for walk in &loops {
            for (i, &h) in walk.iter().enumerate() {
                let following = walk[(i + 1) % walk.len()];
                assert!(
                    mesh.is_outside(h) && mesh.face(h.twin()).is_some() && mesh.is_boundary_edge(h.edge())
                );
                assert_eq!((mesh.next(h), mesh.tip(h)), (following, mesh.origin(following)));
            }
        }
        let outside = mesh.halfedges().filter(|&h| mesh.is_outside(h)).count();
        assert_eq!(loops.iter().map(Vec::len).sum::<usize>(), outside);
    }
}

#[test]
fn assemble_refuses_what_is_no_surface() {
    // A half-edge in two faces.
    assert!(Mesh::assemble(4, vec![0, 1, 1, 2, 2, 0, 1, 3], &[[0, 2, 4], [0, 6, 4]]).is_err());
    // Two faces that only touch at vertex 0.
    let origin = vec![0, 1, 1, 2, 2, 0, 0, 3, 3, 4, 4, 0];
    assert!(Mesh::assemble(5, origin, &[[0, 2, 4], [6, 8, 10]]).is_err());
    // A vertex without edges, and an edge without faces.
    assert!(Mesh::assemble(4, vec![0, 1, 1, 2, 2, 0], &[[0, 2, 4]]).is_err());
    assert!(Mesh::assemble(3, vec![0, 1, 1, 2, 2, 0, 0, 1], &[[0, 2, 4]]).is_err());
    // A side that does not start where the one before it ends.
    assert!(Mesh::assemble(4, vec![0, 1, 3, 2, 2, 0], &[[0, 2, 4]]).is_err());
}

#[test]
fn validate_notices_every_single_wrong_entry() {
    let wrong = |mesh: &Mesh, array: &str, at: usize, value: u32| {
        let mut broken = mesh.clone();
        let entries = match array {
            "next" => &mut broken.next,
            "origin" => &mut broken.origin,
            _ => &mut broken.face,
        };
        if std::mem::replace(&mut entries[at], value) != value {
            assert!(broken.validate().is_err(), "{array}[{at}] = {value} of {mesh:?}");
        }
    };
    for mesh in surfaces() {
        for h in 0..mesh.n_halfedges() {
            for value in (0..mesh.n_halfedges() as u32 + 1).chain([OUTSIDE]) {
                for array in ["next", "origin", "face"] {
                    wrong(&mesh, array, h, value);
                }
            }
        }
        for v in 0..mesh.n_vertices() {
            let mut broken = mesh.clone();
            broken.out[v] = OUTSIDE;
            assert!(broken.validate().is_err());
            if mesh.is_boundary_vertex(VertexId(v as u32)) {
                broken.out[v] = mesh.out[v] ^ 1;
                assert!(broken.validate().is_err());
            }
        }
        if mesh.n_faces() > 1 {
            let mut broken = mesh.clone();
            broken.first.swap(0, 1);
            assert!(broken.validate().is_err());
        }
    }
}
