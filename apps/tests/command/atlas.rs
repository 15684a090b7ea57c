//! `ricci atlas`: files with the faces of the model, the way back, and what is refused.

use crate::run::Place;
use std::collections::HashMap;

#[test]
fn a_model_keeps_its_faces_and_gets_an_atlas() {
    let place = Place::new();
    place.expect(0, "make torus -n 16 -m 10 -o t.obj");
    let words = "--page 256 --xref back.csv --report r.json";
    let done = place.expect(0, &format!("atlas t.obj -o a.obj {words} --picture p.png --size 200"));
    assert!(done.out.contains("charts") && place.exists("p.png"), "{}", done.out);
    let report = place.json("r.json");
    let (result, checks) = (&report["result"], &report["checks"]);
    assert!(
        checks["folded_faces"]["value"] == 0.0 && checks["overlapping_faces"]["value"] == 0.0,
        "{checks}"
    );
    assert!(
        result["fill"].as_f64().unwrap() > 0.4 && result["stretch_99"].as_f64().unwrap() < 1.33,
        "{result}"
    );
    let (given, made) = (place.text("t.obj"), place.text("a.obj"));
    let lines = |text: &str, mark: &str| -> Vec<Vec<String>> {
        let all = text.lines().filter(|line| line.split(' ').next() == Some(mark));
        all.map(|line| line.split_whitespace().skip(1).map(String::from).collect()).collect()
    };
    assert_eq!(lines(&given, "v"), lines(&made, "v"));
    let vertex = |face: &Vec<String>| -> Vec<String> {
        face.iter().map(|corner| corner.split('/').next().unwrap().into()).collect()
    };
    let (before, after) = (lines(&given, "f"), lines(&made, "f"));
    assert_eq!(before.iter().map(vertex).collect::<Vec<_>>(), after.iter().map(vertex).collect::<Vec<_>>());
    // The way back has the vertex of every corner.
    let back: HashMap<(usize, usize), i64> = place
        .text("back.csv")
        .lines()
        .skip(1)
        .map(|row| {
            let row: Vec<i64> = row.split(',').map(|x| x.parse().unwrap()).collect();
            ((row[0] as usize, row[1] as usize), row[2])
        })
        .collect();
    let charts = result["charts"].as_i64().unwrap();
    for corner in after.iter().flatten() {
        let numbers: Vec<usize> =
            corner.split('/').take(2).map(|x| x.parse::<usize>().unwrap() - 1).collect();
        assert!((0..charts).contains(&back[&(numbers[1], numbers[0])]), "{corner}");
    }
    // The same bytes for any number of threads.
    place.expect(0, "atlas t.obj -o again.obj --page 256 --threads 1");
    assert_eq!(made, place.text("again.obj"));
}

#[test]
fn models_that_are_no_surface_go_in() {
    let place = Place::new();
    let wings = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 5 0 0\nv 6 0 0\nv 6 1 0\nv 5 1 0\nf 1 2 3\nf 2 1 4\nf 1 2 5\nf 6 7 8 9\nf 1 1 2\n";
    place.put("wings.obj", wings);
    let done = place.expect(0, "atlas wings.obj -o a.glb --page 128 --report r.json");
    assert!(done.out.contains("no place"), "{}", done.out);
    let result = &place.json("r.json")["result"];
    assert_eq!((result["sheets"].as_u64(), result["opened_edges"].as_u64()), (Some(3), Some(1)));
    assert_eq!(result["placeless_faces"].as_array().unwrap().len(), 1);
    place.expect(0, "info a.glb --report i.json");
    assert_eq!(place.json("i.json")["input"]["faces"].as_u64(), Some(6));
}

/// The document of a binary glTF file.
fn document(place: &Place, name: &str) -> serde_json::Value {
    let bytes = std::fs::read(place.path(name)).unwrap();
    let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
    serde_json::from_slice(&bytes[20..20 + length]).unwrap()
}

#[test]
fn a_scene_stays_one() {
    let place = Place::new();
    place.put(
        "scene.gltf",
        r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
        "nodes":[{"name":"root","children":[1,2]},{"name":"left","mesh":0,"scale":[3,3,3]},{"name":"right","mesh":0}],
        "meshes":[{"name":"plate","primitives":[{"attributes":{"POSITION":0},"mode":5,"material":0}]}],
        "materials":[{"name":"tin","extras":{"price":0.1}}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
        "bufferViews":[{"buffer":0,"byteLength":48}],
        "buffers":[{"byteLength":48,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAACAPwAAgD8AAAAA"}]}"#,
    );
    let done = place.expect(0, "atlas scene.gltf -o a.glb --page 64 --texcoord 1 --tangents --report r.json");
    for words in ["1 mesh shown by several nodes", "of strips or fans", "1 primitive without: no normals"] {
        assert!(done.out.contains(words), "{words}: {}", done.out);
    }
    let result = &place.json("r.json")["result"];
    assert_eq!((result["nodes"].as_u64(), result["texcoord"].as_u64()), (Some(3), Some(1)));
    let given: serde_json::Value = serde_json::from_str(&place.text("scene.gltf")).unwrap();
    let made = document(&place, "a.glb");
    for member in ["nodes", "materials", "scenes"] {
        assert_eq!(given[member], made[member]);
    }
    assert_eq!(made["meshes"][0]["name"], "plate");
    assert_eq!(made["meshes"][0]["primitives"][0].get("mode"), None);
    // Two plates of two triangles each.
    place.expect(0, "info a.glb --report i.json");
    assert_eq!(place.json("i.json")["input"]["faces"].as_u64(), Some(4));
}

#[test]
fn several_pages_and_tangents_are_asked_for() {
    let place = Place::new();
    place.expect(0, "make sphere -n 8 -o s.obj");
    let words = "--page 32 --density 12 --tangents --xref back.csv --picture p.svg --report r.json";
    let done = place.expect(0, &format!("atlas s.obj -o a.glb {words}"));
    let pages = place.json("r.json")["result"]["pages"].as_u64().unwrap();
    assert!(pages > 1 && done.out.contains(&format!("of {pages} pages filled")), "{}", done.out);
    let named: std::collections::BTreeSet<u64> = place
        .text("back.csv")
        .lines()
        .skip(1)
        .map(|row| row.split(',').nth(3).unwrap().parse().unwrap())
        .collect();
    assert_eq!(named, (0..pages).collect());
    let attributes = &document(&place, "a.glb")["meshes"][0]["primitives"][0]["attributes"];
    assert!(!attributes["TANGENT"].is_null() && !attributes["NORMAL"].is_null(), "{attributes}");
}

#[test]
fn what_no_atlas_can_be_made_of_is_refused() {
    let place = Place::new();
    place.expect(0, "make disk -o d.obj");
    for words in [
        "-o a.ply",
        "-o a.obj --stretch 1",
        "-o a.obj --page 100",
        "-o a.obj --fill 2",
        "-o d.obj",
        "-o a.obj --tangents",
        "-o a.glb --texcoord 1",
        "-o a.obj --density 0",
    ] {
        place.expect(2, &format!("atlas d.obj {words}"));
    }
    place.put("points.obj", "v 0 0 0\nv 1 0 0\nf 1 1 2\n");
    let refused = place.expect(3, "atlas points.obj -o a.obj");
    assert!(refused.err.contains("no face"), "{}", refused.err);
}
