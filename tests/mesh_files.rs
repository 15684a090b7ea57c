//! Reading, diagnosis and building, against the topology that the corpus index states.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::print_stderr)]

mod common;

use proptest::prelude::*;
use ricci::Error;
use ricci::mesh::check::{Defect, diagnose};
use ricci::mesh::io::{self, ObjData, Soup};
use ricci::mesh::{FaceId, Mesh};
use std::collections::HashMap;

fn count(row: &HashMap<String, String>, column: &str) -> Option<usize> {
    row[column].parse().ok()
}

#[test]
fn every_good_mesh_has_the_topology_of_the_index() {
    let Some((folder, rows)) = common::index("good") else { return };
    assert_eq!(rows.len(), 112);
    for row in &rows {
        let soup = io::read(&folder.join(&row["file"])).unwrap();
        let diagnosis = diagnose(&soup.positions, &soup.faces);
        assert_eq!(diagnosis.defects, [], "{}", row["name"]);
        let mesh = Mesh::from_soup(&soup).unwrap();
        mesh.validate().unwrap();
        let ours =
            [mesh.n_vertices(), mesh.n_edges(), mesh.n_faces(), mesh.genus(), mesh.boundary_loops().len()];
        let theirs = ["V", "E", "F", "genus", "boundary_loops"].map(|c| count(row, c).unwrap());
        assert_eq!(ours, theirs, "{}", row["name"]);
        assert_eq!(diagnosis.genus, Some(mesh.genus()));
        assert_eq!(diagnosis.boundary_loops, Some(mesh.boundary_loops().len()));
        assert!(mesh.faces().all(|f| mesh.face_vertices(f).map(|v| v.0) == soup.faces[f.index()]));
    }
}

/// The number before `words` in the index's note, 0 where they are missing.
fn noted(note: &str, words: &str) -> usize {
    let part = note.split(';').map(str::trim).find(|p| p.ends_with(words));
    part.and_then(|p| p.split(' ').next()).and_then(|n| n.parse().ok()).unwrap_or(0)
}

#[test]
fn every_bad_obj_and_ascii_off_gets_the_diagnosis_of_the_index() {
    let Some((folder, rows)) = common::index("bad") else { return };
    let mut compared = 0;
    for row in rows.iter().filter(|r| r["file"].ends_with("obj") || r["file"].ends_with("off")) {
        let Some(faces) = count(row, "F") else { continue };
        let soup = io::read(&folder.join(&row["file"])).unwrap();
        let diagnosis = diagnose(&soup.positions, &soup.faces);
        let found: HashMap<_, _> = diagnosis.counts().into_iter().collect();
        let ours = |code: &str| found.get(code).copied().unwrap_or(0);
        let note = &row["note"];
        let name = &row["name"];
        assert_eq!(soup.faces.len() - ours("degenerate_face"), faces, "{name}: faces");
        assert_eq!(ours("isolated_vertex"), noted(note, "isolated vertices"), "{name}: isolated");
        assert_eq!(ours("duplicate_face"), noted(note, "duplicate faces"), "{name}: duplicates");
        assert_eq!(ours("non_manifold_edge"), noted(note, "non-manifold edges"), "{name}: edges");
        assert_eq!(ours("non_manifold_vertex"), noted(note, "non-manifold vertices"), "{name}: vertices");
        assert_eq!(diagnosis.edges, count(row, "E").unwrap(), "{name}: edges");
        assert_eq!(ours("non_orientable") > 0, row["orientable"] == "False", "{name}: orientable");
        compared += 1;
    }
    assert!(compared > 30, "only {compared} files compared");
}

fn tetrahedron() -> Soup {
    let positions = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    Soup { positions, faces: vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]] }
}

fn codes(soup: &Soup) -> Vec<&'static str> {
    diagnose(&soup.positions, &soup.faces).counts().into_iter().map(|(code, _)| code).collect()
}

#[test]
fn each_defect_is_named_with_its_elements() {
    let sound = tetrahedron();
    assert!(codes(&sound).is_empty());

    let mut soup = sound.clone();
    soup.faces[2][1] = 9;
    let defects = diagnose(&soup.positions, &soup.faces).defects;
    assert!(defects.contains(&Defect::IndexOutOfRange { face: 2, index: 9 }));

    let mut soup = sound.clone();
    soup.faces.push([1, 1, 2]);
    assert_eq!(codes(&soup), ["degenerate_face"]);

    let mut soup = sound.clone();
    soup.faces.push([1, 0, 2]);
    let defects = diagnose(&soup.positions, &soup.faces).defects;
    assert!(defects.contains(&Defect::DuplicateFace { face: 4, first: 0 }));
    assert!(defects.contains(&Defect::NonManifoldEdge { vertices: [0, 2], faces: vec![0, 3, 4] }));

    let mut soup = sound.clone();
    soup.faces[0] = [0, 1, 2];
    assert_eq!(codes(&soup), ["inconsistent_orientation"]);
    assert_eq!(diagnose(&soup.positions, &soup.faces).defects.len(), 3);

    let mut soup = sound.clone();
    soup.positions[3] = [f64::NAN, 0.0, 0.0];
    assert_eq!(diagnose(&soup.positions, &soup.faces).defects, [Defect::NonFiniteCoordinate { vertex: 3 }]);

    let mut soup = sound.clone();
    soup.positions[2] = [0.25, 0.0, 0.0];
    assert_eq!(codes(&soup), ["zero_area_face"]);

    let mut soup = sound.clone();
    soup.positions.push([5.0, 5.0, 5.0]);
    assert_eq!(diagnose(&soup.positions, &soup.faces).defects, [Defect::IsolatedVertex { vertex: 4 }]);

    // Two tetrahedra: apart, and joined in one vertex.
    let far: Vec<_> = sound.positions.iter().map(|p| [p[0] + 3.0, p[1], p[2]]).collect();
    let mut soup = sound.clone();
    soup.positions.extend(&far);
    soup.faces.extend(sound.faces.iter().map(|f| f.map(|v| v + 4)));
    let defects = diagnose(&soup.positions, &soup.faces).defects;
    assert_eq!(defects, [Defect::SeveralComponents { faces: vec![4, 4] }]);
    soup.faces.iter_mut().flatten().filter(|v| **v == 4).for_each(|v| *v = 0);
    soup.faces.iter_mut().flatten().filter(|v| **v > 4).for_each(|v| *v -= 1);
    soup.positions.remove(4);
    let defects = diagnose(&soup.positions, &soup.faces).defects;
    assert_eq!(defects, [Defect::NonManifoldVertex { vertex: 0, sheets: 2 }]);

    assert_eq!(codes(&Soup::default()), ["empty"]);

    // Möbius strip of five triangles.
    let faces: Vec<[u32; 3]> = (0..5).map(|i| [i, (i + 1) % 5, (i + 2) % 5]).collect();
    let positions: Vec<_> =
        (0..5).map(|i| [f64::from(i).cos(), f64::from(i).sin(), f64::from(i * i)]).collect();
    let defects = diagnose(&positions, &faces).defects;
    assert!(matches!(defects[..], [Defect::NonOrientable { faces: 5, .. }]), "{defects:?}");
    assert!(matches!(Mesh::from_faces(5, &faces), Err(Error::Defects(_))));
}

#[test]
fn a_written_obj_reads_back_bit_for_bit() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("t.obj");
    let mut soup = tetrahedron();
    soup.positions[1] = [1.0 / 3.0, -0.0, 1e-310];
    soup.positions[2] = [f64::MAX, std::f64::consts::PI, -1.0 - f64::EPSILON];
    let data = ObjData { positions: &soup.positions, faces: &soup.faces, ..ObjData::default() };
    io::write_obj(&path, &data).unwrap();
    let back = io::read(&path).unwrap();
    let bits = |s: &Soup| s.positions.iter().flatten().map(|x| x.to_bits()).collect::<Vec<_>>();
    assert_eq!((bits(&soup), &soup.faces), (bits(&back), &back.faces));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "a temporary was left behind");

    // A failed write leaves the old file and no temporary.
    soup.positions[0][0] = f64::NAN;
    let data = ObjData { positions: &soup.positions, faces: &soup.faces, ..ObjData::default() };
    assert!(matches!(io::write_obj(&path, &data), Err(Error::Io { .. })));
    assert_eq!(io::read(&path).unwrap(), back);
    let missing = folder.path().join("no/such/folder/t.obj");
    assert!(matches!(io::write_obj(&missing, &data), Err(Error::Io { .. })));
}

#[test]
fn obj_and_off_dialects_are_read() {
    let obj =
        "v 0 0 0 1 0 0\r\nv 1 0 0\n# c\nv 1 1 0\nv 0 1 0 # last\nvt 0 0\ng a\nf 1/1 2/1/1 3//1 \\\n -1\n";
    let soup = io::parse_obj(obj, "t.obj").unwrap();
    assert_eq!(soup.faces, [[0, 1, 2], [0, 2, 3]]);
    let odd = "\u{feff}v 0 0 0\rv 1 0 0\r# back\\\rv 1 1 0\rv 0 1 0\rf 1 2 3 4\r";
    assert_eq!(io::parse_obj(odd, "t.obj").unwrap(), soup);
    for off in [
        "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n",
        "COFF 4 1 0\n0 0 0 9 9 9 9\n1 0 0 9\n# c\n\n1 1 0\n0 1 0\n4 0 1 2 3 255 0 0\n",
        "\u{feff}OFF4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n",
        "  OFF # head\n 4 1\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3",
    ] {
        let read = io::parse_off(off, "t.off").unwrap();
        assert_eq!((read.faces, read.positions), (soup.faces.clone(), soup.positions.clone()));
    }
}

#[test]
fn a_syntax_error_names_its_line() {
    let line = |e: Error| if let Error::Parse { line, .. } = e { line } else { 0 };
    assert_eq!(line(io::parse_obj("v 0 0 0\nv 1 x 0\n", "t").unwrap_err()), 2);
    assert_eq!(line(io::parse_obj("v 0 0 0\n\nf 1 a 2\n", "t").unwrap_err()), 3);
    assert_eq!(line(io::parse_obj("v 0 0 0\nf 0 1 1\n", "t").unwrap_err()), 2);
    assert_eq!(line(io::parse_off("OFF\n3 1 0\n0 0 0\n0 0\n3 0 1 2\n", "t").unwrap_err()), 5);
    // A header that promises more than the file holds is an error, not an allocation.
    assert!(line(io::parse_off("OFF\n99999999999 1 0\n0 0 0\n", "t").unwrap_err()) > 0);
    assert!(
        line(io::parse_off("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n99999999999 0 1 2\n", "t").unwrap_err()) > 0
    );
    assert!(matches!(io::read("mesh.xyz".as_ref()), Err(Error::UnknownFormat { .. })));
}

#[test]
fn one_vertex_torus_is_a_surface() {
    // The square with opposite sides glued: edges 1 (right), 2 (up), 3 (diagonal).
    let edges = [[2, -3, 1], [-1, -2, 3]];
    let mesh = Mesh::from_gluing(1, &[[0, 0, 0], [0, 0, 0]], &edges).unwrap();
    assert_eq!((mesh.n_edges(), mesh.euler(), mesh.genus()), (3, 0, 1));
    assert!(mesh.is_closed() && !mesh.is_simplicial());
    assert_eq!(mesh.outgoing(0usize.into()).count(), 6);
    assert_eq!([0usize, 1].map(|f| mesh.face_edges(FaceId::from(f))), edges);
}

#[test]
fn an_inconsistent_gluing_names_the_face() {
    let faces = [[0, 0, 0], [0, 0, 0]];
    let face = |e: [[i32; 3]; 2]| match Mesh::from_gluing(1, &faces, &e) {
        Err(Error::Gluing { face, .. }) => face,
        other => panic!("{other:?}"),
    };
    assert_eq!(face([[2, -3, 1], [-1, 0, 3]]), 1);
    assert_eq!(face([[2, -3, 1], [-1, 2, 3]]), 1);
    assert_eq!(face([[2, -3, 1], [-1, -2, 1_000_000]]), 1);
    // Two triangles around one vertex 0, glued so that vertices 1 and 2 disagree.
    let ends = Mesh::from_gluing(4, &[[0, 1, 2], [0, 2, 3]], &[[1, 2, 3], [4, 5, -3]]);
    assert!(matches!(ends, Err(Error::Gluing { face: 1, .. })));
    // A vertex with two fans: two triangles that share only vertex 0.
    let fans = Mesh::from_gluing(5, &[[0, 1, 2], [0, 3, 4]], &[[1, 2, 3], [4, 5, 6]]);
    assert!(matches!(fans, Err(Error::Gluing { .. })));
}

proptest! {
    #[test]
    fn random_triples_build_a_valid_mesh_or_name_a_defect(
        faces in prop::collection::vec([0u32..9, 0u32..9, 0u32..9], 0..14)
    ) {
        match Mesh::from_faces(8, &faces) {
            Ok(mesh) => prop_assert!(mesh.validate().is_ok()),
            Err(Error::Defects(diagnosis)) => prop_assert!(!diagnosis.defects.is_empty()),
            Err(other) => prop_assert!(false, "{other}"),
        }
    }

    #[test]
    fn random_gluings_build_a_valid_mesh_or_name_a_face(
        edges in prop::collection::vec([-6i32..7, -6i32..7, -6i32..7], 1..5)
    ) {
        match Mesh::from_gluing(1, &vec![[0; 3]; edges.len()], &edges) {
            Ok(mesh) => prop_assert!(mesh.validate().is_ok()),
            Err(Error::Gluing { .. }) => {}
            Err(other) => prop_assert!(false, "{other}"),
        }
    }

    #[test]
    fn relabelled_and_turned_faces_are_the_same_surface(seed in any::<u64>()) {
        let faces = tetrahedron().faces;
        let mut state = seed;
        let mut random = |n: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            ((state >> 33) % n) as usize
        };
        let mut label = [0u32, 1, 2, 3];
        (1..4).for_each(|i| label.swap(i, random(i as u64 + 1)));
        let mut relabelled: Vec<[u32; 3]> = faces.iter().map(|f| f.map(|v| label[v as usize])).collect();
        relabelled.iter_mut().for_each(|f| f.rotate_left(random(3)));
        let mesh = Mesh::from_faces(4, &relabelled).unwrap();
        prop_assert_eq!((mesh.n_edges(), mesh.euler(), mesh.is_closed()), (6, 2, true));
    }
}
