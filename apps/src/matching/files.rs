//! The files of `ricci match`.

use super::outcome::MatchOutcome;
use crate::failure::Failure;
use crate::output::{Outputs, write_textured};
use ricci::matching::SurfaceMap;
use ricci::mesh::io::TexturedMesh;
use ricci::metric::CommonSubdivision;
use std::fmt::Write;
use std::path::Path;

/// A map as rows `source_vertex,target_face,b0,b1,b2`.
pub fn write_map(outputs: &mut Outputs, path: &Path, map: &SurfaceMap) -> Result<(), Failure> {
    let mut text = String::from("source_vertex,target_face,b0,b1,b2\n");
    for (v, place) in map.places.iter().enumerate() {
        let [a, b, c] = place.weights;
        // Writing to a string does not fail.
        let _ = writeln!(text, "{v},{},{a:?},{b:?},{c:?}", place.face);
    }
    outputs.add_bytes(path, text.as_bytes())
}

/// The source with its vertices at their images.
pub fn write_moved(outputs: &mut Outputs, path: &Path, outcome: &MatchOutcome) -> Result<(), Failure> {
    let Some(positions) = outcome.target.positions() else { return Err(Failure::no_positions()) };
    let images = outcome.matching.forward.carry(outcome.target.mesh(), positions)?;
    let faces = outcome.source.mesh().triangles();
    let data = TexturedMesh { positions: &images, faces: &faces, ..TexturedMesh::default() };
    write_textured(outputs, path, &data)
}

/// The source with the target's texture coordinates. Where these have seams, each vertex takes those of the face of the target that it lies
/// in.
pub fn write_carried(outputs: &mut Outputs, path: &Path, outcome: &MatchOutcome) -> Result<(), Failure> {
    let Some(uv) = &outcome.target.attributes.uv else {
        return Err(Failure::Failed("the target has no texture coordinates".into()));
    };
    let Some(positions) = outcome.source.positions() else { return Err(Failure::no_positions()) };
    let texcoords = outcome.matching.forward.carry_corners(outcome.target.mesh(), uv)?;
    let faces = outcome.source.mesh().triangles();
    let data = TexturedMesh {
        positions,
        faces: &faces,
        texcoords: &texcoords,
        face_texcoords: &faces,
        ..TexturedMesh::default()
    };
    write_textured(outputs, path, &data)
}

/// The overlay on the source, with the target's texture coordinates, seams and all, where it has them.
pub fn write_overlay(
    outputs: &mut Outputs,
    path: &Path,
    outcome: &MatchOutcome,
    overlay: &CommonSubdivision,
) -> Result<(), Failure> {
    let Some(positions) = outcome.source.positions() else { return Err(Failure::no_positions()) };
    let positions = overlay.from_vertices(0, positions)?;
    let faces = overlay.mesh.triangles();
    let carried = match &outcome.target.attributes.uv {
        Some(uv) => overlay.from_corners(1, uv)?,
        None => Vec::new(),
    };
    let apart: Vec<[u32; 3]> = (0..carried.len() as u32).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]).collect();
    let data = TexturedMesh {
        positions: &positions,
        faces: &faces,
        texcoords: carried.as_flattened(),
        face_texcoords: &apart,
        ..TexturedMesh::default()
    };
    write_textured(outputs, path, &data)
}

/// A row for every corner of the overlay, with its places in the source and in the target and its weight.
pub fn write_places(outputs: &mut Outputs, path: &Path, overlay: &CommonSubdivision) -> Result<(), Failure> {
    let mut text = String::from("face,vertex,source_face,a0,a1,a2,target_face,b0,b1,b2,weight\n");
    for f in overlay.mesh.faces() {
        let [first, second] = overlay.faces.each_ref().map(|faces| faces[f]);
        for (k, v) in overlay.mesh.face_vertices(f).into_iter().enumerate() {
            let [[a, b, c], [p, q, r]] = [0, 1].map(|side| overlay.barycentric(side, f)[k]);
            let weight = overlay.weight[v];
            // Writing to a string does not fail.
            let _ = writeln!(text, "{f},{v},{first},{a:?},{b:?},{c:?},{second},{p:?},{q:?},{r:?},{weight:?}");
        }
    }
    outputs.add_bytes(path, text.as_bytes())
}
