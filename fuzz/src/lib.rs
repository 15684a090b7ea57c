//! What must hold of whatever a reader accepts.

use ricci::Error;
use ricci::mesh::check::diagnose;
use ricci::mesh::io::{self, Format, Soup};
use ricci::mesh::repair::{Repair, repair};
use ricci::mesh::{Mesh, Point};
use std::path::PathBuf;
use std::sync::OnceLock;

/// A position for a vertex: no two alike, no three in line.
pub fn position(v: u32) -> Point {
    let t = f64::from(v);
    [t, t * t, t * t * t]
}

/// Bytes are refused with a place, or read into a list that holds together, builds or is diagnosed, and survives being
/// written and read again.
pub fn read(parse: impl Fn(&[u8], &str) -> ricci::Result<Soup>, bytes: &[u8]) {
    match parse(bytes, "input") {
        Ok(soup) => {
            let Soup { positions, faces, attributes } = &soup;
            let counts = [
                (attributes.normals.as_ref().map(Vec::len), positions.len()),
                (attributes.colors.as_ref().map(Vec::len), positions.len()),
                (attributes.uv.as_ref().map(Vec::len), faces.len()),
            ];
            assert!(
                counts.iter().all(|&(got, expected)| got.is_none_or(|got| got == expected)),
                "{counts:?}"
            );
            build(&soup);
            for format in [Format::Obj, Format::Off, Format::Ply, Format::Glb] {
                round_trip(&soup, format);
            }
        }
        Err(Error::Parse { path, message, .. }) => {
            assert!(path == "input" && !message.is_empty());
        }
        Err(Error::TooLarge { .. }) => {}
        Err(other) => panic!("a reader says {other}"),
    }
}

/// The builder and the diagnosis agree; what is repaired has its way back and needs no second repair.
pub fn build(soup: &Soup) {
    let diagnosis = diagnose(&soup.positions, &soup.faces);
    match Mesh::from_soup(soup) {
        Ok(mesh) => {
            assert!(diagnosis.defects.is_empty(), "{:?}", diagnosis.defects);
            mesh.validate().unwrap();
            assert_eq!((mesh.n_vertices(), mesh.n_faces()), (soup.positions.len(), soup.faces.len()));
            for (f, corners) in mesh.faces().zip(&soup.faces) {
                assert_eq!(mesh.face_vertices(f).map(|v| v.0), *corners);
            }
            counts(&mesh);
        }
        Err(Error::Defects(found)) => assert_eq!(found.defects, diagnosis.defects),
        Err(other) => panic!("{other}"),
    }
    let mended = match repair(soup, &Repair::default()) {
        Ok(mended) => mended,
        Err(Error::Argument { .. } | Error::Defects(_)) => return,
        Err(other) => panic!("{other}"),
    };
    assert_eq!(mended.vertex_origin.len(), mended.soup.positions.len());
    assert_eq!(mended.face_origin.len(), mended.soup.faces.len());
    for (p, &v) in mended.soup.positions.iter().zip(&mended.vertex_origin) {
        let origin = soup.positions[v as usize];
        assert!((0..3).all(|k| p[k].to_bits() == origin[k].to_bits()));
    }
    let again = repair(&mended.soup, &Repair::default()).unwrap();
    assert!(again.soup.faces == mended.soup.faces, "repaired twice");
}

/// Euler's formula with what the mesh says of itself.
pub fn counts(mesh: &Mesh) {
    let [v, e, f] = [mesh.n_vertices(), mesh.n_edges(), mesh.n_faces()].map(|n| n as i64);
    assert_eq!(mesh.euler(), v - e + f);
    assert_eq!(mesh.euler(), 2 - 2 * mesh.genus() as i64 - mesh.boundary_loops().len() as i64);
}

/// A list that can be written reads back with the same faces and, to what the format stores, positions.
fn round_trip(soup: &Soup, format: Format) {
    static FOLDER: OnceLock<tempfile::TempDir> = OnceLock::new();
    let folder =
        FOLDER.get_or_init(|| tempfile::tempdir_in("/dev/shm").or_else(|_| tempfile::tempdir()).unwrap());
    let extension = match format {
        Format::Obj => "obj",
        Format::Off => "off",
        Format::Ply => "ply",
        Format::Glb => "glb",
    };
    let path: PathBuf = folder.path().join("m").with_extension(extension);
    match io::write_as(&path, format, soup) {
        Ok(_) => {}
        Err(Error::Argument { .. }) => return,
        Err(other) => panic!("written as {extension}: {other}"),
    }
    let back = io::read(&path).unwrap();
    if format == Format::Glb {
        // Vertices are split where their corners have different texture coordinates.
        assert_eq!(back.faces.len(), soup.faces.len());
        return;
    }
    assert!(back.faces == soup.faces, "{extension}: other faces");
    // +0 and −0 are one number to a text.
    assert!(back.positions == soup.positions, "{extension}: other positions");
}
