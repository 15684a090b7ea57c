//! Points, curves, soft landmarks and loops, from files.

use crate::csv::read_rows;
use crate::failure::Failure;
use ricci::matching::{Place, SoftLandmark};
use ricci::mesh::{FaceId, HalfedgeId, Mesh, VertexId};
use std::path::Path;

/// Rows `source_face,s0,s1,s2,target_face,t0,t1,t2`.
pub fn read_points(path: &Path, meshes: [&Mesh; 2]) -> Result<Vec<[Place; 2]>, Failure> {
    let names = ["source_face", "s0", "s1", "s2", "target_face", "t0", "t1", "t2"];
    let mut all = Vec::new();
    for (line, row) in read_rows(path, names)? {
        let place = |s: usize| -> Result<Place, Failure> {
            let face = number(path, line, &row[4 * s], meshes[s].n_faces())?;
            let mut weights = [0.0; 3];
            for (weight, text) in weights.iter_mut().zip(&row[4 * s + 1..]) {
                *weight =
                    text.trim().parse().map_err(|_| refuse(path, line, format!("{text} is no weight")))?;
            }
            Ok(Place { face: FaceId(face), weights })
        };
        all.push([place(0)?, place(1)?]);
    }
    Ok(all)
}

/// Rows `source_vertex,target_vertex,weight`.
pub fn read_soft(path: &Path, meshes: [&Mesh; 2]) -> Result<Vec<SoftLandmark>, Failure> {
    let mut all = Vec::new();
    for (line, [from, to, weight]) in read_rows(path, ["source_vertex", "target_vertex", "weight"])? {
        let from = number(path, line, &from, meshes[0].n_vertices())?;
        let to = number(path, line, &to, meshes[1].n_vertices())?;
        let weight =
            weight.trim().parse().map_err(|_| refuse(path, line, format!("{weight} is no weight")))?;
        all.push(SoftLandmark { pair: [VertexId(from), VertexId(to)], weight });
    }
    Ok(all)
}

/// Rows `curve,surface,vertex`.
pub fn read_curves(path: &Path, meshes: [&Mesh; 2]) -> Result<Vec<[Vec<VertexId>; 2]>, Failure> {
    read_paths(path, meshes, "curve")
}

/// Rows `loop,surface,vertex`: closed paths along edges.
pub fn read_basis(path: &Path, meshes: [&Mesh; 2]) -> Result<Vec<[Vec<HalfedgeId>; 2]>, Failure> {
    let mut all = Vec::new();
    for (number, pair) in read_paths(path, meshes, "loop")?.into_iter().enumerate() {
        let along = |s: usize| -> Result<Vec<HalfedgeId>, Failure> {
            let (mesh, name) = (meshes[s], ["source", "target"][s]);
            let step = |ends: &[VertexId]| {
                let edge = mesh.outgoing(ends[0]).find(|&h| mesh.tip(h) == ends[1]);
                edge.ok_or_else(|| {
                    let why = format!("no edge joins vertices {} and {}", ends[0], ends[1]);
                    Failure::Input(format!("{}: loop {number} on the {name}: {why}", path.display()))
                })
            };
            pair[s].windows(2).map(step).collect()
        };
        all.push([along(0)?, along(1)?]);
    }
    Ok(all)
}

/// Rows `<name>,surface,vertex`: paths on both surfaces, numbered from 0.
fn read_paths(
    path: &Path,
    meshes: [&Mesh; 2],
    name: &'static str,
) -> Result<Vec<[Vec<VertexId>; 2]>, Failure> {
    let mut all: Vec<[Vec<VertexId>; 2]> = Vec::new();
    for (line, [curve, surface, vertex]) in read_rows(path, [name, "surface", "vertex"])? {
        // A curve has one of the numbers up to the number of rows: those before it may come later.
        let curve = number(path, line, &curve, line)? as usize;
        let side = match surface.trim() {
            "source" => 0,
            "target" => 1,
            other => return Err(refuse(path, line, format!("{other} is neither source nor target"))),
        };
        let vertex = number(path, line, &vertex, meshes[side].n_vertices())?;
        if all.len() <= curve {
            all.resize(curve + 1, [Vec::new(), Vec::new()]);
        }
        all[curve][side].push(VertexId(vertex));
    }
    Ok(all)
}

fn number(path: &Path, line: usize, text: &str, n: usize) -> Result<u32, Failure> {
    let found = text.trim().parse::<u32>().ok().filter(|&k| (k as usize) < n);
    found.ok_or_else(|| refuse(path, line, format!("{text} is no number below {n}")))
}

fn refuse(path: &Path, line: usize, why: String) -> Failure {
    Failure::Input(format!("{}:{line}: {why}", path.display()))
}
