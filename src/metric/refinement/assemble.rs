//! From pieces to a refinement: the vertices and edges that were kept are numbered without gaps.

use super::parts::{Crossing, OnFace, Refinement, torn};
use super::pieces::{Corner, Pieces};
use crate::error::Result;
use crate::mesh::{FaceId, HalfedgeId, Mesh, PerFace};
use crate::parallel;

/// Marks a vertex or edge that is in no piece that is kept.
const UNUSED: u32 = u32::MAX;

/// New numbers of the elements that are not [`UNUSED`], in order, and how many these are.
fn numbered(mut all: Vec<u32>) -> (Vec<u32>, usize) {
    let mut n = 0;
    for x in all.iter_mut().filter(|x| **x != UNUSED) {
        *x = n;
        n += 1;
    }
    (all, n as usize)
}

/// The refinement of these pieces. `crossings` and `weight` are those of all faces, also of those that are not kept.
///
/// # Errors
/// [`crate::Error::Connectivity`] where a corner of a piece lies outside the input or the final triangulation.
pub(super) fn assemble(pieces: Pieces, crossings: Vec<Crossing>, weight: Vec<f64>) -> Result<Refinement> {
    let [input, result] = [pieces.overlay.input, pieces.overlay.result.mesh];
    let mut vertex = vec![UNUSED; weight.len()];
    let mut edge = vec![UNUSED; pieces.origins.len()];
    for (sides, corners) in pieces.sides.iter().zip(&pieces.corners) {
        sides.iter().for_each(|h| edge[(h >> 1) as usize] = 0);
        corners.iter().for_each(|c| vertex[c.vertex as usize] = 0);
    }
    let (vertex, n_vertices) = numbered(vertex);
    let (edge, n_edges) = numbered(edge);
    let mut sides = pieces.sides;
    let connected = || {
        let mut origin = vec![0; 2 * n_edges];
        for (sides, corners) in sides.iter_mut().zip(&pieces.corners) {
            for k in 0..3 {
                sides[k] = 2 * edge[(sides[k] >> 1) as usize] + (sides[k] & 1);
                origin[sides[k] as usize] = vertex[corners[k].vertex as usize];
                origin[sides[k] as usize ^ 1] = vertex[corners[(k + 1) % 3].vertex as usize];
            }
        }
        Mesh::assemble(n_vertices, origin, &sides)
    };
    let (mesh, faces) = parallel::join(connected, || faces_of(&pieces.corners, [input, result]));
    let (mesh, (places, [input_face, final_face])) = (mesh?, faces?);
    let n = input.n_vertices();
    let is_kept = |v: &usize| vertex[*v] != UNUSED;
    let kept_edges = (0..edge.len()).filter(|&e| edge[e] != UNUSED);
    Ok(Refinement {
        n_input_vertices: (0..n).filter(is_kept).count(),
        crossings: (0..crossings.len()).filter(|c| is_kept(&(n + c))).map(|c| crossings[c]).collect(),
        weight: (0..weight.len()).filter(is_kept).map(|v| weight[v]).collect::<Vec<_>>().into(),
        input_face,
        final_face,
        places,
        piece: pieces.piece.into(),
        origin: kept_edges.map(|e| pieces.origins[e]).collect::<Vec<_>>().into(),
        mesh,
    })
}

/// Per triangle where its corners lie, and its faces, in the input and in the final triangulation.
fn faces_of(
    all: &[[Corner; 3]],
    meshes: [&Mesh; 2],
) -> Result<(Vec<[[OnFace; 2]; 3]>, [PerFace<FaceId>; 2])> {
    let lies_on = |mesh: &Mesh, h: HalfedgeId| {
        let (face, corner) = mesh.corner(h)?;
        Some((face, OnFace { corner: corner as u8, backward: h.0 & 1 == 1 }))
    };
    let of = |c: Corner| lies_on(meshes[0], c.input).zip(lies_on(meshes[1], c.result));
    let mut places = Vec::with_capacity(all.len());
    let mut faces = [Vec::with_capacity(all.len()), Vec::with_capacity(all.len())];
    for corners in all {
        let [Some(first), Some(second), Some(third)] = corners.map(of) else { return Err(torn()) };
        faces[0].push(first.0.0);
        faces[1].push(first.1.0);
        places.push([first, second, third].map(|(a, b)| [a.1, b.1]));
    }
    Ok((places, faces.map(PerFace::from)))
}
