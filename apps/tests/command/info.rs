//! `ricci info`: every readable file is described, defects and all.

use crate::run::Place;
use crate::surfaces::{hill, moebius, octahedron, torus};

#[test]
fn counts_and_topology_are_reported() {
    let place = Place::new();
    place.put("torus.obj", &torus(12, 8).obj()).put("disk.obj", &hill(4).obj());
    place.expect(0, "info torus.obj --report r.json");
    let report = place.json("r.json");
    for (key, value) in [("vertices", 96), ("edges", 288), ("faces", 192), ("components", 1), ("genus", 1)] {
        assert_eq!(report["input"][key], value);
    }
    assert_eq!(report["result"]["admissible"], true);
    assert_eq!(report["result"]["defects"].as_array().unwrap().len(), 0);
    let quality = &report["result"]["quality"];
    for key in ["area", "min_angle_degrees", "obtuse_fraction", "edge_ratio", "non_delaunay_fraction"] {
        assert!(quality[key].is_f64(), "{key}");
    }
    place.expect(0, "info disk.obj --report r.json --quiet");
    assert_eq!(place.json("r.json")["input"]["boundary_loops"], 1);
}

#[test]
fn each_remedy_of_a_kind_is_said() {
    let place = Place::new();
    // Faces 1 and 2 at an edge of their own, faces 1, 3 and 4 at another: turning helps the first edge only.
    place.put(
        "m.obj",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 0 0 -1\nf 1 2 3\nf 2 3 4\nf 1 2 5\nf 1 2 6\n",
    );
    let ended = place.expect(0, "info m.obj");
    assert!(ended.out.contains("faces 0, 2, 3 run the same way along edge 0–1"), "{}", ended.out);
    assert!(ended.out.contains("turn faces until neighbours agree"), "{}", ended.out);
    assert!(ended.out.contains("turning faces cannot help"), "{}", ended.out);
}

#[test]
fn defects_are_a_result_with_their_elements_and_remedy() {
    let place = Place::new();
    let two = octahedron().beside(octahedron());
    let repeated = octahedron().obj() + "f 1 2 5\nf 1 1 2\nv 0 0 7\nf 1 2 99\n";
    for (text, codes) in [
        (two.obj(), vec!["several_components"]),
        (moebius(12).obj(), vec!["non_orientable"]),
        (octahedron().obj() + "v 0 0 9\nf 1 5 7\n", vec!["non_manifold_edge", "inconsistent_orientation"]),
        (repeated, vec!["duplicate_face", "degenerate_face", "isolated_vertex", "index_out_of_range"]),
        ("# nothing\n".into(), vec!["empty"]),
        (octahedron().obj().replacen("v 1 ", "v nan ", 1), vec!["non_finite_coordinate"]),
    ] {
        place.put("m.obj", &text);
        let ended = place.expect(0, "info m.obj --report r.json --picture p.png");
        assert!(std::fs::read(place.path("p.png")).unwrap().starts_with(b"\x89PNG"));
        let report = place.json("r.json");
        assert!(report["input"]["boundary_loops"].is_u64());
        let result = &report["result"];
        assert_eq!(result["admissible"], false);
        let defects = result["defects"].as_array().unwrap();
        for code in codes {
            let defect = defects.iter().find(|d| d["code"] == code);
            let defect = defect.unwrap_or_else(|| panic!("{code} not among {defects:?}"));
            assert!(!defect["remedy"].as_str().unwrap().is_empty());
            assert!(defect["vertices"].is_array() && defect["faces"].is_array());
            assert!(ended.out.contains(code));
        }
    }
    for (text, code) in [
        (r#"{"faces": [[0,1,2]], "lengths": [[1,1,5]]}"#, "triangle_inequality"),
        (r#"{"faces": [[0,1,2],[0,1,2]], "lengths": [[1,1,1],[1,1,1]]}"#, "duplicate_face"),
    ] {
        place.put("m.json", text);
        place.expect(0, "info m.json --report r.json");
        let result = &place.json("r.json")["result"];
        assert_eq!((&result["admissible"], &result["defects"][0]["code"]), (&false.into(), &code.into()));
    }
    place.expect(3, "info missing.obj");
    place.put("m.obj", "v 0 0\n");
    place.expect(3, "info m.obj");
}
