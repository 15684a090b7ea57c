//! `ricci surface`: solids of few faces from meshes.

use crate::run::Place;

/// A sphere-like surface and a torus become solids, with every check held and a face for each patch.
#[test]
fn closed_surfaces_become_solids_of_few_faces() {
    let place = Place::new();
    for (shape, tolerance, most) in [("ellipsoid", 1e-3, 6), ("torus", 1e-3, 16)] {
        place.expect(0, &format!("make {shape} -o in.obj"));
        place.expect(0, &format!("surface in.obj -o out.step --tolerance {tolerance} --report r.json"));
        let (report, text) = (place.json("r.json"), place.text("out.step"));
        let result = &report["result"];
        let faces = result["faces"].as_u64().unwrap() as usize;
        assert!(faces <= most, "{shape}: {result}");
        assert_eq!(text.matches("ADVANCED_FACE(").count(), faces, "{shape}");
        assert_eq!(text.matches("CLOSED_SHELL(").count(), 1, "{shape}");
        assert_eq!(result["bytes"].as_u64(), Some(text.len() as u64), "{shape}");
        assert!(result["max"].as_f64().unwrap() <= tolerance, "{shape}: {result}");
        assert!(result["normal_jump"].as_f64().unwrap() < 1e-6, "{shape}: {result}");
    }
}

/// Where no fit reaches the tolerance the file is written, and the check says by how much it is missed.
#[test]
fn a_tolerance_that_is_missed_is_told() {
    let place = Place::new();
    place.expect(0, "make torus -n 16 -o in.obj");
    let ended = place.expect(1, "surface in.obj -o out.step --tolerance 1e-9 --spans 1 --report r.json");
    assert!(ended.out.contains("max = ") || ended.err.contains("max = "), "{} {}", ended.out, ended.err);
    let report = place.json("r.json");
    assert_eq!(report["checks"]["max"]["holds"], false);
    assert!(place.exists("out.step"));
}
