//! Scenes of glTF with an atlas: five meshes with two materials go in, and come out with their nodes, materials, names and triangles.

use crate::scene_build::{DecodedScene, SceneBuilder};
use ricci::geometry::triangle_overlap::overlapping;
use ricci::mesh::io::{self, SceneFile, SceneOptions, SceneReport};
use ricci::texture::{TextureAtlas, TextureOptions, texture_atlas_of_parts};
use ricci::{Control, Error};
use serde_json::{Value, json};

/// The members of a document that an atlas leaves as they are.
const KEPT: [&str; 11] = [
    "asset",
    "scene",
    "scenes",
    "nodes",
    "materials",
    "textures",
    "images",
    "samplers",
    "cameras",
    "skins",
    "animations",
];

struct AtlasOfScene {
    atlas: TextureAtlas,
    report: SceneReport,
    before: DecodedScene,
    after: DecodedScene,
    bytes: Vec<u8>,
}

fn atlas_of(scene: &SceneFile) -> TextureAtlas {
    let options = TextureOptions { page: 256, fill: 0.0, threads: 1, ..TextureOptions::default() };
    texture_atlas_of_parts(scene.soup(), scene.meshes(), &options, &Control::new()).unwrap()
}

fn made(given: &SceneBuilder, options: &SceneOptions) -> AtlasOfScene {
    let bytes = given.glb();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("out.glb");
    let scene = SceneFile::of_bytes(bytes.clone(), "in.glb").unwrap();
    let atlas = atlas_of(&scene);
    let report = scene.write(&path, &atlas.corner_uv, options).unwrap();
    let written = std::fs::read(&path).unwrap();
    let (before, after) = (DecodedScene::new(&bytes), DecodedScene::new(&written));
    AtlasOfScene { atlas, report, before, after, bytes: written }
}

/// Positions and names are those of the input, bit for bit, and the coordinates those of the atlas, which do not overlap.
fn check_kept(made: &AtlasOfScene, set: u32) {
    let AtlasOfScene { atlas, before, after, bytes, .. } = made;
    for member in KEPT {
        assert_eq!(before.document[member], after.document[member], "{member}");
    }
    let mut uv = Vec::new();
    let name = format!("TEXCOORD_{set}");
    let pairs = before.primitives().into_iter().zip(after.primitives());
    for ((mesh, index, was), (_, _, is)) in pairs {
        assert_eq!(was["material"], is["material"]);
        assert_eq!(was["extras"], is["extras"]);
        if was["mode"] == 1 {
            assert_eq!(was, is);
            continue;
        }
        let (was_corners, is_corners) = (before.corners(was), after.corners(is));
        for (attribute, accessor) in is["attributes"].as_object().unwrap() {
            let is_new = *attribute == name || (attribute == "TANGENT" && made.report.n_tangents > 0);
            if is_new || was["attributes"][attribute].is_null() {
                continue;
            }
            let given = before.elements(&was["attributes"][attribute], &was_corners);
            let kept = after.elements(accessor, &is_corners);
            assert_eq!(given, kept, "{attribute} of primitive {index} of mesh {mesh}");
        }
        for (was, is) in before.targets(was).iter().zip(after.targets(is)) {
            assert_eq!(before.elements(was, &was_corners), after.elements(&is, &is_corners));
        }
        let pairs = after.floats(&is["attributes"][&name], &is_corners);
        uv.extend(
            pairs.chunks(6).map(|c| [0, 1, 2].map(|k| [f64::from(c[2 * k]), f64::from(1.0 - c[2 * k + 1])])),
        );
    }
    assert_eq!(uv, atlas.corner_uv);
    assert!(uv.as_flattened().as_flattened().iter().all(|x| (0.0..1.0).contains(x)));
    assert!(overlapping(&uv, &Control::new()).unwrap().is_empty());
    assert!(atlas.folded.is_empty() && atlas.overlapping.is_empty() && atlas.placeless.is_empty());
    // The reader of meshes finds as many faces in space: one mesh is shown twice.
    let read = io::parse_glb(bytes, "out.glb").unwrap();
    assert_eq!(read.faces.len(), atlas.chart.len() + 12);
}

#[test]
fn a_scene_of_five_meshes_keeps_everything_but_its_vertices() {
    let given = SceneBuilder::five_meshes(false);
    let made = made(&given, &SceneOptions::default());
    check_kept(&made, 0);
    let report = &made.report;
    assert_eq!((report.texcoord, report.n_primitives, report.n_shared_meshes), (0, 6, 1));
    // The box alone had coordinates, and the tangents that went with them.
    assert_eq!((report.n_replaced, report.n_dropped_tangents, report.n_misplaced_textures), (1, 1, 0));
    assert_eq!(report.n_unrolled, 1);
    assert!(report.n_split_vertices > report.n_vertices && report.notes.is_empty());
    // Nothing is left in the file that nothing names but the accessor of the tangents.
    let count = |scene: &DecodedScene, list: &str| scene.document[list].as_array().unwrap().len();
    assert!(count(&made.after, "accessors") <= count(&made.before, "accessors") + 5);
    assert!(count(&made.after, "bufferViews") <= count(&made.before, "bufferViews") + 5);
    assert_eq!(made.after.document["meshes"][1]["primitives"][0].get("mode"), None);
    assert_eq!(made.after.document["meshes"][0]["name"], "box");
}

#[test]
fn texels_have_one_size_in_the_scene() {
    let given = SceneBuilder::five_meshes(false);
    let scene = SceneFile::of_bytes(given.glb(), "in.glb").unwrap();
    assert_eq!(scene.counts(), [7, 5, 6, 2]);
    let atlas = atlas_of(&scene);
    let density = |mesh: u32| {
        let soup = scene.soup();
        let (mut flat, mut area) = (0.0, 0.0);
        for (f, uv) in
            soup.faces.iter().zip(&atlas.corner_uv).filter(|(f, _)| scene.meshes()[f[0] as usize] == mesh)
        {
            let [a, b, c] = f.map(|v| soup.positions[v as usize]);
            area += ricci::geometry::vector::norm(ricci::geometry::vector::triangle_normal([a, b, c]));
            flat += ricci::geometry::complex::doubled_area(*uv).abs();
        }
        (flat / area).sqrt()
    };
    // The box of side 1 is shown four times as large, and once more in its own size; the strip has half of its size.
    for mesh in 1..5 {
        assert!((density(mesh) / density(0) - 1.0).abs() < 0.02, "{mesh}: {} {}", density(mesh), density(0));
    }
    let size = |v: usize| scene.soup().positions[v].iter().fold(0.0f64, |most, x| most.max(x.abs()));
    assert!(size(0) > 3.9);
}

#[test]
fn textures_keep_their_coordinates() {
    let given = SceneBuilder::five_meshes(true);
    let free = made(&given, &SceneOptions::default());
    check_kept(&free, 1);
    assert_eq!(
        (free.report.texcoord, free.report.n_kept_textures, free.report.n_dropped_tangents),
        (1, 2, 0)
    );
    for (_, _, primitive) in free.after.primitives().into_iter().filter(|(_, _, p)| p["mode"] != 1) {
        assert!(!primitive["attributes"]["TEXCOORD_0"].is_null(), "sets have no gaps");
    }
    // Set 0 on request, and the textures whose pictures no longer fit are counted.
    let asked = made(&given, &SceneOptions { texcoord: Some(0), tangents: true });
    check_kept(&asked, 0);
    let report = &asked.report;
    assert_eq!((report.n_misplaced_textures, report.n_replaced, report.n_dropped_tangents), (2, 1, 0));
    assert_eq!((report.n_tangents, report.n_without_tangents), (3, 3));
}

/// Of each vertex the tangent is a unit vector at a right angle to the normal, along growing u of the faces around.
#[test]
fn tangents_follow_the_atlas() {
    let given = SceneBuilder::five_meshes(false);
    let made = made(&given, &SceneOptions { tangents: true, ..SceneOptions::default() });
    let mut n = 0;
    for (mesh, _, primitive) in made.after.primitives() {
        let attributes = &primitive["attributes"];
        if attributes["TANGENT"].is_null() {
            assert!(attributes["NORMAL"].is_null() || primitive["mode"] == 1);
            continue;
        }
        let corners = made.after.corners(primitive);
        let list = |name: &str| made.after.floats(&attributes[name], &corners);
        let (tangents, normals) = (list("TANGENT"), list("NORMAL"));
        let (positions, uv) = (list("POSITION"), list("TEXCOORD_0"));
        for (k, t) in tangents.chunks(4).enumerate() {
            let dot = |a: &[f32], b: &[f32]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f32>();
            assert!((dot(&t[..3], &t[..3]) - 1.0).abs() < 1e-5 && t[3] == 1.0, "{t:?}");
            assert!(dot(&t[..3], &normals[3 * k..3 * k + 3]).abs() < 1e-5);
            // A flat mesh: from the other corners, u grows along the tangent.
            let (first, mut along) = (k / 3 * 3, [[0.0; 2]; 2]);
            for j in 1..3 {
                let other = first + (k + j) % 3;
                let edge: Vec<f32> =
                    (0..3).map(|i| positions[3 * other + i] - positions[3 * k + i]).collect();
                along[j - 1] = [dot(&edge, &t[..3]), uv[2 * other] - uv[2 * k]];
            }
            let scale = along.iter().map(|[x, _]| x.abs()).fold(0.0, f32::max) * 0.05;
            if mesh == 0 {
                let ratio = along.iter().map(|[_, u]| u).fold(0.0f32, |m, u| m.max(u.abs()))
                    / along.iter().map(|[x, _]| x.abs()).fold(0.0, f32::max);
                along.iter().for_each(|[x, u]| assert!((u / ratio - x).abs() < scale, "{along:?}"));
            }
            n += 1;
        }
    }
    assert!(n > 36 && made.report.n_tangents == 3);
}

#[test]
fn a_file_with_its_buffer_and_picture_beside_it_becomes_one() {
    let folder = tempfile::tempdir().unwrap();
    let given = SceneBuilder::five_meshes(true);
    given.write_apart(folder.path());
    let scene = SceneFile::open(&folder.path().join("scene.gltf")).unwrap();
    let atlas = atlas_of(&scene);
    let path = folder.path().join("out.glb");
    let report = scene.write(&path, &atlas.corner_uv, &SceneOptions::default()).unwrap();
    let after = DecodedScene::new(&std::fs::read(&path).unwrap());
    assert_eq!(after.document["buffers"].as_array().unwrap().len(), 1);
    assert_eq!(after.document["buffers"][0].get("uri"), None);
    let image = &after.document["images"][0];
    assert_eq!((image["mimeType"].as_str(), image.get("uri")), (Some("image/png"), None));
    assert!(after.view(&image["bufferView"]).starts_with(b"\x89PNG\r\n\x1a\n"));
    assert!(report.notes.len() == 1 && report.notes[0].contains("missing.png"), "{:?}", report.notes);
}

#[test]
fn what_is_no_scene_is_refused() {
    let given = SceneBuilder::five_meshes(false);
    let scene = SceneFile::of_bytes(given.glb(), "in.glb").unwrap();
    let path = std::path::Path::new("unwritten.glb");
    let few = scene.write(path, &[], &SceneOptions::default());
    assert!(matches!(few, Err(Error::Size { .. })), "{few:?}");
    let uv = vec![[[0.0; 2]; 3]; scene.soup().faces.len()];
    let high = scene.write(path, &uv, &SceneOptions { texcoord: Some(8), tangents: false });
    assert!(matches!(high, Err(Error::Argument { .. })), "{high:?}");
    assert!(!path.exists());
    let other = SceneFile::of_bytes(b"ply\nformat ascii 1.0\nend_header\n".to_vec(), "x").err();
    assert!(matches!(other, Some(Error::UnknownFormat { .. })), "{other:?}");
    let words = |change: &dyn Fn(&mut Value)| {
        let mut given = SceneBuilder::five_meshes(false);
        change(&mut given.document);
        SceneFile::of_bytes(given.glb(), "in.glb").err().unwrap().to_string()
    };
    let draco = words(&|d| d["extensionsRequired"] = json!(["KHR_draco_mesh_compression"]));
    assert!(draco.contains("KHR_draco_mesh_compression"), "{draco}");
    assert!(words(&|d| d["nodes"][0]["children"] = json!([1, 1])).contains("two parents"));
    let circle = |d: &mut Value| {
        d["nodes"][0]["children"] = json!([1, 3, 4, 5]);
        d["nodes"][2]["children"] = json!([2]);
    };
    assert!(words(&circle).contains("below themselves"));
    assert!(words(&|d| d["nodes"][1]["mesh"] = json!(9)).contains("mesh 9"));
}
