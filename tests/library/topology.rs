//! Tests of homology generators and cut graphs, by theorem.

use crate::surfaces::*;
use ricci::mesh::{EdgeId, HalfedgeId, Mesh, PerEdge, PerHalfedge, VertexId};
use ricci::topology::{CutGraph, cut_graph, homology_generators};
use ricci::{Control, Error};

/// The Poincaré dual cochain of a closed loop: the number of times that each half-edge crosses the loop, pushed to its left, from right
/// to left. A boundary loop counts as filled.
fn dual_cochain(mesh: &Mesh, walk: &[HalfedgeId]) -> PerHalfedge<i64> {
    let mut crossing = PerHalfedge::filled(mesh.n_halfedges(), 0);
    for (k, &enter) in walk.iter().enumerate() {
        let leave = walk[(k + 1) % walk.len()];
        let mut h = mesh.next(enter); // clockwise through the wedge on the left
        while h != leave {
            crossing[h] += 1;
            crossing[h.twin()] -= 1;
            h = mesh.next(h.twin());
        }
    }
    crossing
}

fn intersection_matrix(mesh: &Mesh, loops: &[Vec<HalfedgeId>]) -> Vec<Vec<i64>> {
    let row = |a: &Vec<HalfedgeId>| {
        let dual = dual_cochain(mesh, a);
        loops.iter().map(|b| b.iter().map(|&h| dual[h]).sum()).collect()
    };
    loops.iter().map(row).collect()
}

const P: i64 = 2_147_483_647;

/// Rank and determinant modulo the prime P.
fn rank_and_determinant(mut m: Vec<Vec<i64>>) -> (usize, i64) {
    let inverse = |a: i64| {
        (0..31).fold(1, |r, k| {
            let square = (0..k).fold(a, |x, _| x * x % P);
            if (P - 2) >> k & 1 == 1 { r * square % P } else { r }
        })
    };
    let columns = m.first().map_or(0, Vec::len);
    let (mut rank, mut determinant) = (0, 1);
    for c in 0..columns {
        let Some(pivot) = (rank..m.len()).find(|&r| m[r][c].rem_euclid(P) != 0) else {
            determinant = 0;
            continue;
        };
        if pivot != rank {
            m.swap(pivot, rank);
            determinant = -determinant;
        }
        determinant = determinant * m[rank][c].rem_euclid(P) % P;
        let scale = inverse(m[rank][c].rem_euclid(P));
        for r in rank + 1..m.len() {
            let factor = m[r][c].rem_euclid(P) * scale % P;
            for k in c..columns {
                m[r][k] = (m[r][k] - factor * m[rank][k].rem_euclid(P)).rem_euclid(P);
            }
        }
        rank += 1;
    }
    (rank, determinant.rem_euclid(P))
}

fn assert_closed_without_spurs(mesh: &Mesh, walk: &[HalfedgeId]) {
    for (k, &h) in walk.iter().enumerate() {
        let next = walk[(k + 1) % walk.len()];
        assert_eq!(mesh.tip(h), mesh.origin(next));
        assert_ne!(next, h.twin(), "the loop turns back on itself");
    }
}

fn check_generators(name: &str, mesh: &Mesh, lengths: &PerEdge<f64>) {
    let loops = homology_generators(mesh, lengths, &Control::new()).unwrap();
    let (genus, boundary) = (mesh.genus(), mesh.boundary_loops().len());
    assert_eq!(loops.len(), 2 * genus + boundary.saturating_sub(1), "{name}");
    loops.iter().for_each(|walk| assert_closed_without_spurs(mesh, walk));
    let matrix = intersection_matrix(mesh, &loops);
    for (i, row) in matrix.iter().enumerate() {
        for (j, &x) in row.iter().enumerate() {
            assert_eq!(x, -matrix[j][i], "{name}: the intersection form is antisymmetric");
        }
    }
    let (rank, determinant) = rank_and_determinant(matrix);
    assert_eq!(rank, 2 * genus, "{name}: the form of the filled surface has rank 2g");
    if boundary < 2 {
        assert!([1, P - 1].contains(&determinant), "{name}: determinant {determinant} mod p");
    }
}

#[test]
fn intersection_form_of_homology_generators_is_unimodular() {
    for (n, m) in [(1, 1), (1, 2), (2, 1), (2, 2), (5, 7)] {
        let (mesh, lengths) = flat_torus(n, m, [0.3, 1.2]);
        check_generators("flat torus", &mesh, &lengths);
    }
    let (mesh, lengths) = octagon();
    assert_eq!(mesh.genus(), 2);
    check_generators("octagon", &mesh, &lengths);
    for path in corpus() {
        let (mesh, lengths) = load(&path);
        check_generators(&path.display().to_string(), &mesh, &lengths);
    }
}

#[test]
fn generators_of_a_holed_disk_are_a_basis_of_its_homology() {
    let (mesh, positions) = square(7, &[(1, 1), (4, 2), (5, 5)], &mut Random(1));
    let lengths = plane_lengths(&mesh, &positions);
    let loops = homology_generators(&mesh, &lengths, &Control::new()).unwrap();
    assert_eq!(loops.len(), 3);
    // The first homology is cycles modulo the boundaries of faces, which are independent on an open surface.
    let chain = |walk: &[HalfedgeId]| {
        let mut chain = vec![0; mesh.n_edges()];
        walk.iter().for_each(|h| chain[h.edge().index()] += if h.0 % 2 == 0 { 1 } else { -1 });
        chain
    };
    let faces = mesh.faces().map(|f| chain(&mesh.face_halfedges(f)));
    let rows: Vec<_> = faces.chain(loops.iter().map(|walk| chain(walk))).collect();
    assert_eq!(rank_and_determinant(rows).0, mesh.n_faces() + 3);
}

#[test]
fn sphere_and_disk_have_no_homology() {
    let (mesh, lengths) = tetrahedron();
    assert!(homology_generators(&mesh, &lengths, &Control::new()).unwrap().is_empty());
    let (mesh, positions) = square(4, &[], &mut Random(2));
    assert!(
        homology_generators(&mesh, &plane_lengths(&mesh, &positions), &Control::new()).unwrap().is_empty()
    );
}

/// Euler characteristic of the opened surface, its vertices counted as classes of corners; `None` if
/// disconnected.
fn opened_euler(mesh: &Mesh, cut: &CutGraph) -> Option<i64> {
    fn find(parent: &mut [usize], mut i: usize) -> usize {
        while parent[i] != i {
            parent[i] = parent[parent[i]];
            i = parent[i];
        }
        i
    }
    let mut corner: Vec<usize> = (0..mesh.n_halfedges()).collect();
    let mut face: Vec<usize> = (0..mesh.n_faces()).collect();
    let mut edges = 0;
    for e in mesh.edges() {
        let h = e.halfedge();
        let (Some(f), Some(g)) = (mesh.face(h), mesh.face(h.twin())) else {
            edges += 1;
            continue;
        };
        if cut.is_cut[e] {
            edges += 2;
            continue;
        }
        edges += 1;
        for (a, b) in [(h, mesh.next(h.twin())), (mesh.next(h), h.twin())] {
            let (a, b) = (find(&mut corner, a.index()), find(&mut corner, b.index()));
            corner[a] = b;
        }
        let (f, g) = (find(&mut face, f.index()), find(&mut face, g.index()));
        face[f] = g;
    }
    let vertices =
        mesh.halfedges().filter(|&h| !mesh.is_outside(h) && corner[h.index()] == h.index()).count();
    let components = (0..mesh.n_faces()).filter(|&f| face[f] == f).count();
    (components == 1).then_some(vertices as i64 - edges + mesh.n_faces() as i64)
}

fn check_cut(name: &str, mesh: &Mesh, lengths: &PerEdge<f64>, cones: &[VertexId]) -> CutGraph {
    let cut = cut_graph(mesh, lengths, cones, &Control::new()).unwrap();
    assert_eq!(opened_euler(mesh, &cut), Some(1), "{name}: not a disk");
    let mut degree = vec![0; mesh.n_vertices()];
    let mut covered = PerEdge::filled(mesh.n_edges(), 0);
    for segment in &cut.segments {
        for pair in segment.windows(2) {
            let v = mesh.tip(pair[0]);
            assert_eq!(v, mesh.origin(pair[1]), "{name}: the chain is broken");
            assert!(cut.nodes.binary_search(&v).is_err(), "{name}: a segment passes node {v}");
        }
        for v in [mesh.origin(segment[0]), mesh.tip(segment[segment.len() - 1])] {
            assert!(cut.nodes.binary_search(&v).is_ok(), "{name}: a segment ends at {v}, which is no node");
        }
        for h in segment {
            covered[h.edge()] += 1;
            mesh.ends(h.edge()).iter().for_each(|v| degree[v.index()] += 1);
        }
    }
    for e in mesh.edges() {
        assert_eq!(covered[e], i32::from(cut.is_cut[e]), "{name}: edge {e} in the segments");
        assert!(!(cut.is_cut[e] && mesh.is_boundary_edge(e)), "{name}: boundary edge {e} is cut");
    }
    for v in mesh.vertices().filter(|&v| !mesh.is_boundary_vertex(v)) {
        let is_cone = cones.contains(&v);
        assert!(degree[v.index()] > 0 || !is_cone, "{name}: the cut misses cone {v}");
        assert!(degree[v.index()] != 1 || is_cone, "{name}: the cut dangles at {v}");
    }
    cut
}

#[test]
fn cut_opens_every_surface_into_a_disk_through_all_cones() {
    let mut random = Random(7);
    for (mesh, lengths) in
        [flat_torus(1, 1, [0.3, 1.2]), flat_torus(1, 3, [0.0, 1.0]), flat_torus(6, 5, [0.5, 0.9]), octagon()]
    {
        check_cut("Δ-complex", &mesh, &lengths, &[]);
        check_cut("Δ-complex", &mesh, &lengths, &[VertexId(0)]);
        let cones = random.vertices(&mesh, 4);
        check_cut("Δ-complex", &mesh, &lengths, &cones);
    }
    for path in corpus() {
        let name = path.display().to_string();
        let (mesh, lengths) = load(&path);
        let mut cones = random.vertices(&mesh, 5);
        cones.push(cones[0]); // a cone named twice is one
        check_cut(&name, &mesh, &lengths, &cones);
        if mesh.is_closed() && mesh.genus() == 0 {
            assert!(
                matches!(cut_graph(&mesh, &lengths, &[], &Control::new()), Err(Error::Layout(_))),
                "{name}"
            );
        } else {
            check_cut(&name, &mesh, &lengths, &[]);
        }
    }
}

#[test]
fn cut_of_a_disk_is_empty_and_reaches_interior_cones_only() {
    let (mesh, positions) = square(6, &[], &mut Random(3));
    let lengths = plane_lengths(&mesh, &positions);
    assert!(check_cut("disk", &mesh, &lengths, &[]).segments.is_empty());
    assert!(check_cut("disk", &mesh, &lengths, &[VertexId(0), VertexId(3)]).segments.is_empty());
    let cut = check_cut("disk", &mesh, &lengths, &[VertexId(8)]);
    assert_eq!(cut.segments.len(), 1);
}

#[test]
fn cut_of_a_flat_torus_is_about_as_short_as_two_closed_geodesics() {
    // Any cut graph of a torus contains two independent loops. On this grid those along the edges have length
    // 1 each, and a cut along edges cannot be shorter than the systole 1 twice minus what two loops may
    // share.
    let (mesh, lengths) = flat_torus(24, 24, [0.0, 1.0]);
    let cut = check_cut("torus", &mesh, &lengths, &[]);
    assert!(cut.length(&lengths) < 2.0 + 1e-12, "{}", cut.length(&lengths));
}

#[test]
fn bad_input_is_named() {
    let (mesh, lengths) = cube();
    let cones = [VertexId(0), VertexId(8)];
    assert!(matches!(cut_graph(&mesh, &lengths, &cones, &Control::new()), Err(Error::Argument { .. })));
    let mut bad = lengths.clone();
    bad[EdgeId(5)] = f64::NAN;
    assert!(matches!(
        homology_generators(&mesh, &bad, &Control::new()),
        Err(Error::EdgeLength { edge: 5, .. })
    ));
    assert!(matches!(
        cut_graph(&mesh, &PerEdge::filled(3, 1.0), &[], &Control::new()),
        Err(Error::Size { .. })
    ));
}
