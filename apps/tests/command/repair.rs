//! `ricci repair`: what is mended, what is left, and the way back.

use crate::run::Place;
use crate::surfaces::{moebius, octahedron, torus};

#[test]
fn a_mended_scan_flows() {
    let place = Place::new();
    // A torus with a repeated and a turned face, beside a small piece, and a point that nobody uses.
    let mut scan = torus(12, 8).beside(octahedron());
    let first = scan.faces[0];
    scan.faces.push(first);
    scan.faces[5].swap(0, 1);
    scan.positions.push([9.0, 9.0, 9.0]);
    place.put("scan.obj", &scan.obj());
    place.expect(3, "flow scan.obj");
    let ended = place.expect(1, "repair scan.obj -o both.off");
    assert!(ended.out.contains("left: the surface has 2 components"), "{}", ended.out);
    let ended = place.expect(
        0,
        "repair scan.obj -o clean.ply --component 0 --map map.json --report r.json --picture p.png",
    );
    assert!(ended.out.contains("1 face turned") && ended.out.contains("clean.ply"), "{}", ended.out);
    let (report, map) = (place.json("r.json"), place.json("map.json"));
    let result = &report["result"];
    for (key, value) in [
        ("duplicate_faces", 1),
        ("turned_faces", 1),
        ("isolated_vertices", 7),
        ("faces_of_other_components", 8),
        ("vertices", 96),
        ("faces", 192),
        ("genus", 1),
    ] {
        assert_eq!(result[key], value, "{key}");
    }
    assert_eq!((&report["command"], &report["checks"]["defects"]["holds"]), (&"repair".into(), &true.into()));
    let list =
        |key: &str| map[key].as_array().unwrap().iter().map(|v| v.as_u64().unwrap()).collect::<Vec<_>>();
    assert_eq!(list("vertex_origin"), (0..96).collect::<Vec<_>>());
    assert_eq!(list("face_origin"), (0..192).collect::<Vec<_>>());
    place.expect(0, "flow clean.ply");
}

#[test]
fn what_cannot_be_mended_is_named_and_written_all_the_same() {
    let place = Place::new();
    place.put("band.obj", &moebius(12).obj());
    let ended = place.expect(1, "repair band.obj -o same.obj --report r.json");
    assert!(ended.out.contains("nothing to mend") && ended.out.contains("non-orientable"), "{}", ended.out);
    assert_eq!(place.json("r.json")["result"]["defect_counts"][0]["code"], "non_orientable");
    assert!(place.exists("same.obj"));
    place.put("gone.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
    let ended = place.expect(3, "repair gone.obj -o out.obj");
    assert!(ended.err.contains("vertex 8, which does not exist"), "{}", ended.err);
    assert!(!place.exists("out.obj"));
    place.put("ball.obj", &octahedron().obj());
    for line in [
        "repair ball.obj",
        "repair ball.obj -o out.stl",
        "repair ball.obj -o out.obj --weld -1",
        "repair ball.obj -o out.obj --weld 1 --no-weld",
        "repair ball.obj -o out.obj --component 1",
        "repair ball.obj -o missing/out.obj",
    ] {
        place.expect(2, line);
    }
    assert!(!place.exists("out.obj"));
}

#[test]
fn welding_is_asked_for_by_distance() {
    let place = Place::new();
    place.put("slit.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 0.001 0\nv 1 1.001 0\nv 0 1 0\nf 1 2 3\nf 4 5 6\n");
    place.expect(1, "repair slit.obj -o out.obj");
    place.expect(0, "repair slit.obj -o out.obj --weld 0.002");
    place.expect(0, "info out.obj --report r.json");
    assert_eq!(place.json("r.json")["input"]["vertices"], 4);
}

#[test]
fn a_weld_that_is_refused_is_told() {
    let place = Place::new();
    // Three loose pages of a book, and the corners of a fourth triangle all within the tolerance.
    let pages = "v 0 0 0\nv 0 0 1\nv 1 0 0\nv 0 0 0\nv 0 0 1\nv -1 1 0\nv 0 0 0\nv 0 0 1\nv -1 -1 0\n";
    place.put("book.obj", &format!("{pages}f 1 2 3\nf 4 5 6\nf 7 8 9\n"));
    let ended = place.expect(1, "repair book.obj -o out.obj --report r.json");
    assert!(ended.out.contains("not welded throughout: 1 edge"), "{}", ended.out);
    let refused = place.json("r.json")["result"]["weld_refused"][0].clone();
    assert_eq!(refused["faces"], serde_json::json!([0, 1, 2]));
    let ended = place.expect(1, "repair book.obj -o out.obj --weld 1e-9");
    assert!(ended.out.contains("ricci repair --cut-edges"), "{}", ended.out);
    // Everything collapses: the remedy is a smaller distance, not another file.
    let ended = place.expect(1, "repair book.obj -o out.obj --weld 9");
    assert!(
        ended.out.contains("all 3 use a vertex twice") && ended.out.contains("smaller distance"),
        "{}",
        ended.out
    );
}

#[test]
fn corners_of_stl_are_welded_for_every_command() {
    let place = Place::new();
    // A square whose triangles miss each other.
    let facet = |corners: [&str; 3]| {
        let loops: String = corners.iter().map(|c| format!("vertex {c}\n")).collect();
        format!("facet normal 0 0 1\nouter loop\n{loops}endloop\nendfacet\n")
    };
    let (one, two) = (facet(["0 0 0", "1 0 0", "1 1 0"]), facet(["0 0.001 0", "1 1.001 0", "0 1 0"]));
    place.put("slit.stl", &format!("solid s\n{one}{two}endsolid s\n"));
    place.expect(3, "flow slit.stl");
    place.expect(0, "flow slit.stl --weld 0.002 --report f.json");
    assert_eq!(place.json("f.json")["options"]["weld"], 0.002);
    for (weld, vertices) in [("", 6), (" --weld 0", 6), (" --weld 0.002", 4)] {
        place.expect(0, &format!("info slit.stl{weld} --report r.json"));
        assert_eq!(place.json("r.json")["input"]["vertices"], vertices);
    }
    place.expect(0, "make torus -o t.obj");
    place.expect(2, "info t.obj --weld 1");
    place.expect(0, "make torus -o t.json");
    place.expect(2, "flow t.json --weld 1");
}

#[test]
fn what_the_format_has_no_place_for_is_said() {
    let place = Place::new();
    // A square whose halves have different normals and places in the texture.
    place.put(
        "hard.obj",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 1\nvn 0 0 1\nvn 0 1 1\nf 1/1/1 2/1/1 3/1/1\nf 1/2/2 3/2/2 4/2/2\n",
    );
    let left_out = |out: &str| {
        let said = place.expect(0, &format!("repair hard.obj -o {out} --report r.json")).out;
        let list = place.json("r.json")["result"]["left_out"].as_array().unwrap().clone();
        assert!(list.iter().all(|what| said.contains(&format!("left out: {}", what.as_str().unwrap()))));
        assert_eq!(said.contains("left out"), !list.is_empty());
        list.len()
    };
    assert_eq!(["o.obj", "o.glb", "o.ply", "o.off"].map(left_out), [0, 0, 1, 2]);
}

#[test]
fn holes_are_filled_where_that_is_asked_for() {
    let place = Place::new();
    // A torus without the faces at two vertices.
    let mut open = torus(12, 8);
    open.faces.retain(|f| !f.contains(&20) && !f.contains(&70));
    place.put("open.obj", &open.obj());
    place.expect(0, "repair open.obj -o all.obj --fill-holes all --map map.json --report r.json");
    let result = place.json("r.json")["result"].clone();
    assert_eq!((&result["boundary_loops"], &result["genus"]), (&0.into(), &1.into()));
    let holes = result["filled_holes"].as_array().unwrap();
    assert_eq!(holes.iter().map(|hole| hole["edges"].as_u64().unwrap()).collect::<Vec<_>>(), [6, 6]);
    let map = place.json("map.json");
    let first = holes[0]["faces"][0].as_u64().unwrap() as usize;
    assert!(map["face_origin"][first].is_null() && map["face_origin"][first - 1].is_u64());
    place.expect(0, "repair open.obj -o none.obj --fill-holes 5 --report r.json");
    assert_eq!(place.json("r.json")["result"]["boundary_loops"], 2);
    place.expect(0, "info open.obj --report r.json");
    let vertex = place.json("r.json")["result"]["loops"][1]["vertex"].as_u64().unwrap();
    place.expect(0, &format!("repair open.obj -o one.obj --fill-hole {vertex} --report r.json"));
    assert_eq!(place.json("r.json")["result"]["boundary_loops"], 1);
    for wrong in ["--fill-holes 2", "--fill-holes x", "--fill-hole 0", "--fill-holes all --fill-hole 3"] {
        place.expect(2, &format!("repair open.obj -o x.obj {wrong}"));
    }
}
