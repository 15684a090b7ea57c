//! The reader of binary glTF, and scenes that stay scenes: what is written has the same triangles.
#![no_main]

use ricci::mesh::io::{SceneFile, SceneOptions, parse_glb};
use ricci_fuzz::read;

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    read(parse_glb, data);
    let Ok(scene) = SceneFile::of_bytes(data.to_vec(), "x.glb") else { return };
    let soup = scene.soup();
    // Each face has coordinates of its own, so that every vertex is repeated.
    let place =
        |f: usize| [0.0, 0.25, 0.5].map(|x| [x + (f % 16) as f64 / 64.0, (f / 16 % 16) as f64 / 16.0]);
    let uv: Vec<[[f64; 2]; 3]> = (0..soup.faces.len()).map(place).collect();
    let folder = tempfile::tempdir_in("/dev/shm").or_else(|_| tempfile::tempdir()).expect("a folder");
    let path = folder.path().join("x.glb");
    let options = SceneOptions { tangents: data.len().is_multiple_of(2), ..SceneOptions::default() };
    if scene.write(&path, &uv, &options).is_ok() {
        let again = SceneFile::open(&path).expect("what is written is a scene");
        let corners = |scene: &SceneFile| -> Vec<[[u64; 3]; 3]> {
            let soup = scene.soup();
            soup.faces.iter().map(|f| f.map(|v| soup.positions[v as usize].map(f64::to_bits))).collect()
        };
        assert_eq!(corners(&scene), corners(&again));
    }
});
