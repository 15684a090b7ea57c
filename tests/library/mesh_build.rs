//! Building and diagnosis on handmade lists: one case for each defect, and Δ-complexes by gluing.

use proptest::prelude::*;
use ricci::Error;
use ricci::mesh::check::{Defect, diagnose};
use ricci::mesh::io::Soup;
use ricci::mesh::{FaceId, Mesh};

const TETRAHEDRON: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];

/// Positions in general position (a moment curve), so that no face is flat.
fn positions(n: usize) -> Vec<[f64; 3]> {
    (0..n).map(|i| i as f64).map(|t| [t, t * t, t * t * t]).collect()
}

fn defects(n: usize, faces: &[[u32; 3]]) -> Vec<Defect> {
    let defects = diagnose(&positions(n), faces).defects;
    if defects.is_empty() {
        Mesh::from_faces(n, faces).unwrap();
    } else {
        let Err(Error::Defects(found)) = Mesh::from_faces(n, faces) else { panic!("{faces:?} was built") };
        assert_eq!(found.defects, defects);
    }
    defects
}

#[test]
fn tetrahedron_is_a_sphere() {
    assert_eq!(defects(4, &TETRAHEDRON), []);
    let mesh = Mesh::from_faces(4, &TETRAHEDRON).unwrap();
    assert_eq!((mesh.n_edges(), mesh.euler(), mesh.genus(), mesh.is_closed()), (6, 2, 0, true));
    let diagnosis = diagnose(&positions(4), &TETRAHEDRON);
    assert_eq!((diagnosis.edges, diagnosis.euler, diagnosis.genus), (6, 2, Some(0)));
}

#[test]
fn edges_are_numbered_by_first_appearance_and_corners_keep_their_order() {
    let mesh = Mesh::from_faces(4, &[[2, 0, 1], [1, 0, 3]]).unwrap();
    let ends: Vec<_> = mesh.edges().map(|e| mesh.ends(e).map(|v| v.0)).collect();
    assert_eq!(ends, [[2, 0], [0, 1], [1, 2], [0, 3], [3, 1]]);
    assert_eq!(mesh.face_vertices(FaceId(0)).map(|v| v.0), [2, 0, 1]);
    assert_eq!(mesh.face_vertices(FaceId(1)).map(|v| v.0), [1, 0, 3]);
    assert_eq!(mesh.face_edges(FaceId(0)), [2, 3, 1]);
    assert_eq!(mesh.face_edges(FaceId(1)), [4, 5, -2]);
}

#[test]
fn empty_lists() {
    assert_eq!(defects(0, &[]), [Defect::Empty { collapsed: 0 }]);
    let isolated = Defect::IsolatedVertex { vertex: 0 };
    assert_eq!(defects(1, &[]), [Defect::Empty { collapsed: 0 }, isolated]);
}

#[test]
fn index_out_of_range_names_face_and_index() {
    let faces = [[0, 1, 2], [1, 0, 7]];
    assert_eq!(defects(3, &faces), [Defect::IndexOutOfRange { face: 1, index: 7 }]);
    let faces = [[0, 1, 2], [1, u32::MAX, 3]];
    let found = defects(3, &faces);
    assert_eq!(found.len(), 2);
    assert_eq!(found[0], Defect::IndexOutOfRange { face: 1, index: u32::MAX });
}

#[test]
fn degenerate_faces_name_a_vertex_twice() {
    assert_eq!(defects(3, &[[0, 1, 2], [1, 1, 0]]), [Defect::DegenerateFace { face: 1 }]);
}

#[test]
fn duplicate_faces_are_paired_with_the_first() {
    let faces = [[0, 1, 2], [1, 2, 0], [2, 1, 0]];
    let found = defects(3, &faces);
    let pairs: Vec<_> = found.iter().filter(|d| d.code() == "duplicate_face").collect();
    assert_eq!(
        pairs,
        [&Defect::DuplicateFace { face: 1, first: 0 }, &Defect::DuplicateFace { face: 2, first: 0 }]
    );
}

#[test]
fn pillow_is_a_duplicate_face_as_a_list_and_a_sphere_as_a_gluing() {
    let faces = [[0, 1, 2], [0, 2, 1]];
    assert_eq!(defects(3, &faces), [Defect::DuplicateFace { face: 1, first: 0 }]);
    let mesh = Mesh::from_gluing(3, &faces, &[[2, 3, 1], [-2, -1, -3]]).unwrap();
    assert_eq!((mesh.n_edges(), mesh.genus(), mesh.is_closed()), (3, 0, true));
    assert!(mesh.is_simplicial());
}

#[test]
fn three_faces_at_an_edge_are_non_manifold_and_two_of_them_run_the_same_way() {
    let faces = [[0, 1, 2], [1, 0, 3], [0, 1, 4]];
    let edge = Defect::NonManifoldEdge { vertices: [0, 1], faces: vec![0, 1, 2] };
    let end = |vertex| Defect::NonManifoldVertex { vertex, sheets: 1 };
    let clash = Defect::InconsistentOrientation { vertices: [0, 1], faces: vec![0, 2], meeting: 3 };
    assert_eq!(defects(5, &faces), [edge, end(0), end(1), clash.clone()]);
    // Turning faces over mends two faces at an edge, but never three.
    assert!(
        clash.remedy().contains("first: ricci repair --cut-edges")
            && clash.remedy().contains("non-manifold edge")
    );
    let two = Defect::InconsistentOrientation { vertices: [0, 1], faces: vec![0, 2], meeting: 2 };
    assert_eq!(
        defects(4, &[[0, 1, 2], [3, 0, 1]]),
        [Defect::InconsistentOrientation { vertices: [0, 1], faces: vec![0, 1], meeting: 2 }]
    );
    assert!(two.remedy().contains("ricci repair"));
    // Both remedies are given where both kinds occur.
    let text = diagnose(&positions(7), &[[0, 1, 2], [1, 0, 3], [0, 1, 4], [4, 5, 6], [4, 5, 2]]).to_string();
    assert!(text.contains(clash.remedy()) && text.contains(two.remedy()), "{text}");
    // Two faces in each direction: no order of the edge's faces is consistent, and both pairs are named.
    let four = [[0, 1, 2], [1, 0, 3], [0, 1, 4], [1, 0, 5]];
    let pairs: Vec<_> =
        defects(6, &four).into_iter().filter(|d| d.code() == "inconsistent_orientation").collect();
    assert_eq!(pairs.iter().map(Defect::faces).collect::<Vec<_>>(), [vec![0, 2], vec![1, 3]]);
    assert_eq!(pairs.iter().map(Defect::vertices).collect::<Vec<_>>(), [vec![0, 1], vec![1, 0]]);
}

#[test]
fn bow_tie_is_a_non_manifold_vertex() {
    let found = defects(5, &[[0, 1, 2], [0, 3, 4]]);
    assert_eq!(found, [Defect::NonManifoldVertex { vertex: 0, sheets: 2 }]);
}

#[test]
fn a_face_turned_over_is_inconsistent_along_its_edges() {
    let mut faces = TETRAHEDRON;
    faces[2].swap(0, 1);
    let found = defects(4, &faces);
    assert!(found.iter().all(|d| d.code() == "inconsistent_orientation" && d.faces().contains(&2)));
    let ends: Vec<_> = found.iter().map(Defect::vertices).collect();
    assert_eq!(ends, [[2, 1], [1, 3], [3, 2]]);
    assert_eq!(diagnose(&positions(4), &faces).genus, Some(0));
}

/// A strip of n triangles on vertices 0…n−1 is an annulus for even n and a Möbius band for odd n.
fn closed_strip(n: u32) -> Vec<[u32; 3]> {
    let turn = |i: u32| if i.is_multiple_of(2) { [i, i + 1, i + 2] } else { [i + 1, i, i + 2] };
    (0..n).map(|i| turn(i).map(|v| v % n)).collect()
}

#[test]
fn odd_strip_is_non_orientable_with_the_band_as_witness() {
    assert_eq!(defects(6, &closed_strip(6)), []);
    for n in [5, 7, 31] {
        let faces = closed_strip(n);
        let [Defect::NonOrientable { strip }] = &defects(n as usize, &faces)[..] else {
            panic!("one defect expected")
        };
        // The strip is a proof of one-sidedness: count the sides passed in the same direction around the band.
        let side = |f: u32, v: u32, w: u32| {
            let face = faces[f as usize];
            (0..3).any(|k| face[k] == v && face[(k + 1) % 3] == w)
        };
        let turns = (0..strip.len()).filter(|&i| {
            let (f, g) = (strip[i], strip[(i + 1) % strip.len()]);
            let [a, b] = common(faces[f as usize], faces[g as usize]);
            side(f, a, b) == side(g, a, b)
        });
        assert_eq!(turns.count() % 2, 1);
    }
}

fn common(f: [u32; 3], g: [u32; 3]) -> [u32; 2] {
    let both: Vec<u32> = f.into_iter().filter(|v| g.contains(v)).collect();
    both.try_into().unwrap()
}

#[test]
fn projective_plane_is_non_orientable() {
    let faces = [
        [0, 1, 2],
        [0, 2, 3],
        [0, 3, 4],
        [0, 4, 5],
        [0, 5, 1],
        [1, 2, 4],
        [2, 3, 5],
        [3, 4, 1],
        [4, 5, 2],
        [5, 1, 3],
    ];
    let found = defects(6, &faces);
    assert_eq!((found.len(), found[0].code()), (1, "non_orientable"));
    assert_eq!(diagnose(&positions(6), &faces).euler, 1);
}

#[test]
fn isolated_vertices_and_several_components() {
    let found = defects(8, &[[0, 1, 2], [4, 5, 6], [2, 1, 7]]);
    let components = Defect::SeveralComponents { first_faces: vec![0, 1], sizes: vec![2, 1], torn: false };
    assert_eq!(components.faces(), [0, 1]);
    assert_eq!(found, [Defect::IsolatedVertex { vertex: 3 }, components.clone()]);
    assert!(components.remedy().contains("repair --component K"));
}

#[test]
fn non_finite_coordinates_are_named_and_never_flat() {
    let mut positions = positions(4);
    positions[1][2] = f64::NAN;
    positions[3][0] = f64::INFINITY;
    let found = diagnose(&positions, &TETRAHEDRON).defects;
    assert_eq!(found, [Defect::NonFiniteCoordinate { vertex: 1 }, Defect::NonFiniteCoordinate { vertex: 3 }]);
    let soup = Soup::new(positions, TETRAHEDRON.to_vec());
    assert!(matches!(Mesh::from_soup(&soup), Err(Error::Defects(_))));
}

#[test]
fn faces_without_area() {
    let flat = |p: [[f64; 3]; 3]| diagnose(&p, &[[0, 1, 2]]).counts() == [("zero_area_face", 1)];
    assert!(flat([[0.0; 3]; 3]));
    assert!(flat([[0.0; 3], [1.0, 1.0, 1.0], [3.0, 3.0, 3.0]]));
    assert!(flat([[0.0; 3], [0.0; 3], [1.0, 0.0, 0.0]]));
    assert!(flat([[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1e-9, 0.0]]));
    assert!(!flat([[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1e-7, 0.0]]));
    // A needle keeps its angles at any scale within the range of f64.
    for s in [1e-300, 1e-160, 1.0, 1e160, 1e308] {
        assert!(!flat([[0.0, -s * 1e-6, 0.0], [0.0, s * 1e-6, 0.0], [s, 0.0, 0.0]]), "scale {s:e}");
    }
    assert!(!flat([[-1.7e308, 0.0, 0.0], [1.7e308, 0.0, 0.0], [0.0, 1.7e308, 0.0]]));
}

#[test]
fn one_vertex_torus_and_its_edges() {
    // The square with opposite sides glued: one vertex, edges 1 (right), 2 (up), 3 (diagonal).
    let faces = [[0, 0, 0], [0, 0, 0]];
    let face_edges = [[2, -3, 1], [-1, -2, 3]];
    let mesh = Mesh::from_gluing(1, &faces, &face_edges).unwrap();
    assert_eq!((mesh.n_vertices(), mesh.n_edges(), mesh.euler(), mesh.genus()), (1, 3, 0, 1));
    assert!(!mesh.is_simplicial() && !mesh.is_given_by_faces());
    assert_eq!(mesh.outgoing(ricci::mesh::VertexId(0)).count(), 6);
    for f in mesh.faces() {
        assert_eq!(mesh.face_edges(f), face_edges[f.index()]);
    }
}

#[test]
fn faces_with_the_same_vertices_do_not_give_the_surface() {
    let (pillow, _) = ricci::mesh::shapes::two_triangle_sphere().build().unwrap();
    assert!(pillow.is_simplicial() && !pillow.is_given_by_faces());
    assert!(Mesh::from_faces(3, &pillow.triangles()).is_err());
    let tetrahedron = Mesh::from_faces(4, &TETRAHEDRON).unwrap();
    assert!(tetrahedron.is_simplicial() && tetrahedron.is_given_by_faces());
}

#[test]
fn a_face_may_be_glued_to_itself() {
    // A cone: sides ab and ca glued at the apex a; the third side is a boundary loop.
    let mesh = Mesh::from_gluing(2, &[[0, 1, 1]], &[[2, -1, 1]]).unwrap();
    assert_eq!((mesh.n_edges(), mesh.euler(), mesh.boundary_loops().len(), mesh.genus()), (2, 1, 1, 0));
}

#[test]
fn bad_gluings_name_the_face() {
    let faces = [[0, 1, 2], [0, 2, 1]];
    let gluing = |face_edges: [[i32; 3]; 2]| match Mesh::from_gluing(3, &faces, &face_edges) {
        Err(Error::Gluing { face, message }) => (face, message),
        other => panic!("{other:?}"),
    };
    let expect = |face_edges, face, words: &str| {
        let (found, message) = gluing(face_edges);
        assert!(found == face && message.contains(words), "face {found}: {message}");
    };
    expect([[2, 3, 1], [-2, 0, -3]], 1, "numbered from 1");
    expect([[2, 3, 1], [-2, i32::MIN, -3]], 1, "exceeds");
    expect([[2, 3, 1], [-2, -7, -3]], 1, "exceeds");
    expect([[2, 3, 1], [2, -1, -3]], 1, "opposite directions");
    expect([[2, 3, 1], [-1, -1, -2]], 1, "same ends");
    expect([[-1, 1, 1], [2, 3, 4]], 0, "same ends");
    expect([[2, 3, 1], [-2, -1, -5]], 1, "no face names edge 4");
    expect([[2, 3, 1], [-1, -2, -3]], 1, "same ends");
    let beyond = Mesh::from_gluing(2, &faces, &[[2, 3, 1], [-2, -1, -3]]);
    assert!(matches!(beyond, Err(Error::Gluing { face: 0, .. })), "{beyond:?}");
    assert!(matches!(Mesh::from_gluing(3, &faces, &[[2, 3, 1]]), Err(Error::Size { .. })));
}

#[test]
fn gluings_that_are_no_surface_name_the_vertex_or_components() {
    let code = |n, faces: &[[u32; 3]], face_edges: &[[i32; 3]]| match Mesh::from_gluing(n, faces, face_edges)
    {
        Err(Error::Defects(d)) => d.defects.iter().map(Defect::code).collect::<Vec<_>>(),
        other => panic!("{other:?}"),
    };
    assert_eq!(code(5, &[[0, 1, 2], [0, 3, 4]], &[[2, 3, 1], [5, 6, 4]]), ["non_manifold_vertex"]);
    assert_eq!(code(6, &[[0, 1, 2], [3, 4, 5]], &[[2, 3, 1], [5, 6, 4]]), ["several_components"]);
    assert_eq!(code(4, &[[0, 1, 2]], &[[2, 3, 1]]), ["isolated_vertex"]);
    assert_eq!(code(0, &[], &[]), ["empty"]);
}

#[test]
fn an_untrusted_number_of_vertices_allocates_nothing() {
    assert!(matches!(Mesh::from_faces(2_000_000_000, &[[0, 1, 2]]), Err(Error::Argument { .. })));
    assert!(matches!(Mesh::from_faces(usize::MAX, &[[0, 1, 2]]), Err(Error::TooLarge { .. })));
    assert!(matches!(
        Mesh::from_gluing(2_000_000_000, &[[0, 1, 2]], &[[1, 2, 3]]),
        Err(Error::Argument { .. })
    ));
}

/// An n × m grid torus.
fn torus(n: u32, m: u32) -> Vec<[u32; 3]> {
    let at = |i: u32, j: u32| (i % n) * m + j % m;
    let quad =
        |i, j| [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]];
    (0..n).flat_map(|i| (0..m).flat_map(move |j| quad(i, j))).collect()
}

proptest! {
    #[test]
    fn relabelling_and_rotating_builds_the_same_surface(
        n in 3u32..7,
        m in 3u32..7,
        open in 0usize..3,
        labels in Just((0..36u32).collect::<Vec<_>>()).prop_shuffle(),
        order in Just((0..72usize).collect::<Vec<_>>()).prop_shuffle(),
        turns in prop::collection::vec(0usize..3, 72),
    ) {
        let faces = torus(n, m);
        let open = if open == 0 { &faces[..] } else { &faces[1..] };
        let v = (n * m) as usize;
        let rank: Vec<u32> = labels.into_iter().filter(|&l| (l as usize) < v).collect();
        let order: Vec<usize> = order.into_iter().filter(|&f| f < open.len()).collect();
        let moved: Vec<[u32; 3]> = order.iter().map(|&f| {
            let mut face = open[f].map(|v| rank[v as usize]);
            face.rotate_left(turns[f]);
            face
        }).collect();
        let (a, b) = (Mesh::from_faces(v, open).unwrap(), Mesh::from_faces(v, &moved).unwrap());
        let counts = |m: &Mesh| (m.n_vertices(), m.n_edges(), m.n_faces(), m.genus(), m.boundary_loops().len());
        prop_assert_eq!(counts(&a), counts(&b));
        for (f, face) in b.faces().zip(&moved) {
            prop_assert_eq!(b.face_vertices(f).map(|v| v.0), *face);
        }
        // The gluing of a mesh rebuilds it exactly.
        let face_edges: Vec<_> = b.faces().map(|f| b.face_edges(f)).collect();
        prop_assert_eq!(&Mesh::from_gluing(v, &moved, &face_edges).unwrap(), &b);
        prop_assert!(b.is_simplicial() && b.is_given_by_faces());
    }

    #[test]
    fn garbage_builds_a_valid_mesh_or_names_defects(
        n in 0usize..9,
        faces in prop::collection::vec([0u32..9, 0u32..9, 0u32..9], 0..14),
    ) {
        match Mesh::from_faces(n, &faces) {
            Ok(mesh) => prop_assert_eq!(mesh.validate(), Ok(())),
            Err(Error::Defects(d)) => {
                prop_assert!(!d.defects.is_empty() && !d.to_string().is_empty());
                prop_assert!(d.defects.iter().all(|d| !d.remedy().is_empty()));
            }
            Err(other) => prop_assert!(false, "{}", other),
        }
    }

    #[test]
    fn garbage_gluings_never_pass_as_surfaces(
        n in 0usize..4,
        faces in prop::collection::vec([0u32..4, 0u32..4, 0u32..4], 0..4),
        edges in prop::collection::vec([-7i32..8, -7i32..8, -7i32..8], 4),
    ) {
        match Mesh::from_gluing(n, &faces, &edges[..faces.len()]) {
            Ok(mesh) => prop_assert_eq!(mesh.validate(), Ok(())),
            Err(Error::Gluing { .. } | Error::Defects(_)) => (),
            Err(other) => prop_assert!(false, "{}", other),
        }
    }

    #[test]
    fn gluings_of_one_vertex_build_a_valid_mesh_or_name_a_face(
        edges in prop::collection::vec([-6i32..7, -6i32..7, -6i32..7], 1..5),
    ) {
        match Mesh::from_gluing(1, &vec![[0; 3]; edges.len()], &edges) {
            Ok(mesh) => prop_assert_eq!(mesh.validate(), Ok(())),
            Err(Error::Gluing { .. } | Error::Defects(_)) => (),
            Err(other) => prop_assert!(false, "{}", other),
        }
    }

    /// Derives the flatness tolerance: faces that pass have lengths that satisfy the strict inequality.
    #[test]
    fn faces_that_are_not_flat_have_strict_triangle_inequalities(
        p in [-1.0f64..1.0, -1.0f64..1.0, -1.0f64..1.0],
        d in [-1.0f64..1.0, -1.0f64..1.0, -1.0f64..1.0],
        t in 0.0f64..1.0,
        e in -30i32..-20,
        offset in [-1.0f64..1.0, -1.0f64..1.0, -1.0f64..1.0],
    ) {
        let h = 2f64.powi(e);
        let q: [f64; 3] = std::array::from_fn(|k| p[k] + d[k]);
        let r: [f64; 3] = std::array::from_fn(|k| p[k] + t * d[k] + h * offset[k]);
        let length = |x: [f64; 3], y: [f64; 3]| (0..3).map(|k| (y[k] - x[k]).powi(2)).sum::<f64>().sqrt();
        let (a, b, c) = (length(q, r), length(r, p), length(p, q));
        if diagnose(&[p, q, r], &[[0, 1, 2]]).defects.is_empty() {
            prop_assert!(a + b > c && b + c > a && c + a > b);
        }
    }
}
