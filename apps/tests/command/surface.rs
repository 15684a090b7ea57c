//! `ricci surface`: solids of few faces from meshes.

use crate::run::Place;

/// A sphere-like, a torus and a surface of genus 2 become solids, with every check held and a face for each patch.
#[test]
fn closed_surfaces_become_solids_of_few_faces() {
    let place = Place::new();
    for (shape, most) in [("ellipsoid --edge-cuts 12", 24), ("torus", 8), ("genus", 60)] {
        place.run_ok(&format!("make {shape} -o in.obj"));
        let ended = place.run("surface in.obj -o out.step --report r.json");
        assert_eq!(ended.code, Some(0), "{shape}: {}", ended.stderr);
        let (report, text) = (place.json("r.json"), place.text("out.step"));
        let result = &report["result"];
        let faces = result["faces"].as_u64().unwrap() as usize;
        assert!(faces <= most, "{shape}: {result}");
        assert_eq!(text.matches("ADVANCED_FACE(").count(), faces, "{shape}");
        assert_eq!(text.matches("CLOSED_SHELL(").count(), 1, "{shape}");
        assert_eq!(result["bytes"].as_u64(), Some(text.len() as u64), "{shape}");
        assert!(result["max"].as_f64().unwrap() <= 1e-3, "{shape}: {result}");
        assert!(result["normal_jump"].as_f64().unwrap() < 1e-6, "{shape}: {result}");
    }
}
