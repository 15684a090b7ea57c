//! Building a mesh from a gluing: three vertices and three signed edges per face, a byte each.
#![no_main]

use ricci::Error;
use ricci::mesh::Mesh;

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let Some((&n, rest)) = data.split_first() else { return };
    let rows = || rest.chunks_exact(6);
    let faces: Vec<[u32; 3]> = rows().map(|r| [0, 1, 2].map(|k| u32::from(r[k]))).collect();
    let edges: Vec<[i32; 3]> = rows().map(|r| [3, 4, 5].map(|k| i32::from(r[k] as i8))).collect();
    match Mesh::from_gluing(n.into(), &faces, &edges) {
        Ok(mesh) => {
            mesh.validate().unwrap();
            assert_eq!((mesh.n_vertices(), mesh.n_faces()), (n.into(), faces.len()));
            for (f, (corners, edges)) in mesh.faces().zip(faces.iter().zip(&edges)) {
                assert_eq!(mesh.face_vertices(f).map(|v| v.0), *corners);
                assert_eq!(mesh.opposite_edges(f).map(|e| e.0 as i32 + 1), edges.map(i32::abs));
            }
            ricci_fuzz::counts(&mesh);
        }
        Err(Error::Defects(found)) => assert!(!found.defects.is_empty()),
        Err(Error::Gluing { face, .. }) => assert!(face < faces.len()),
        Err(other) => panic!("{other}"),
    }
});
