//! The readers of tables: curvatures, places and landmarks of vertices, edges.
#![no_main]

#[path = "../../apps/src/csv.rs"]
#[allow(dead_code)]
mod csv;
#[path = "../../apps/src/failure.rs"]
#[allow(dead_code)]
mod failure;

use ricci::mesh::{Mesh, shapes};
use std::sync::OnceLock;
use tempfile::{NamedTempFile, TempPath};

const N: usize = 7;

/// A refusal names the file and a line of it, or what is missing.
fn refused<T>(read: Result<T, failure::Failure>) -> Option<T> {
    read.map_err(|why| assert!(why.to_string().len() > 8, "{why}")).ok()
}

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    static PLACE: OnceLock<(TempPath, Mesh)> = OnceLock::new();
    let (path, mesh) = PLACE.get_or_init(|| {
        let file = NamedTempFile::new_in("/dev/shm").or_else(|_| NamedTempFile::new()).unwrap();
        (file.into_temp_path(), Mesh::from_soup(&shapes::disk(1).unwrap()).unwrap())
    });
    std::fs::write(path, bytes).unwrap();
    if let Some(rows) = refused(csv::read_curvatures(path, N)) {
        assert!(rows.len() <= N && rows.iter().all(|(v, k)| v.index() < N && k.is_finite()));
    }
    if let Some(all) = refused(csv::read_all_curvatures(path, N)) {
        assert!(all.len() == N && all.iter().all(|k| k.is_finite()));
    }
    if let Some(rows) = refused(csv::read_places(path, N)) {
        assert!(rows.len() <= N && rows.iter().all(|(_, p)| p.iter().all(|x| x.is_finite())));
    }
    if let Some(rows) = refused(csv::read_landmarks(path, [N, 3])) {
        assert!(rows.iter().all(|[a, b]| a.index() < N && b.index() < 3));
    }
    if let Some(edges) = refused(csv::read_edges(path, mesh)) {
        assert!(edges.is_sorted_by(|a, b| a < b) && edges.iter().all(|e| e.index() < mesh.n_edges()));
    }
});
