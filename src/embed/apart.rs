//! The faces of a surface in the metric of a flow, each laid out by itself, and the motions from face to face.
//!
//! Nothing here lies farther from its origin than a face reaches. So no error grows, however far the surface's fundamental domain would
//! reach: in H² a layout in one frame loses e^distance of its digits.

use super::faces::{Faces, corner_of};
use super::pieces::Pieces;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::flow::Solution;
use crate::geometry::{DoubleDouble, Motion};
use crate::mesh::{FaceId, HalfedgeId, PerFace, PerHalfedge};
use std::sync::Arc;

/// Faces with a frame each.
pub(crate) struct Apart {
    /// Per half-edge of a face: its origin in the frame of the face.
    pub corner: PerHalfedge<[DoubleDouble; 3]>,
    /// Per half-edge between two faces: the motion that carries the frame of the face on its right to where that lies beside the face on
    /// its left. The identity elsewhere.
    pub across: PerHalfedge<Motion<DoubleDouble>>,
}

/// Lays the faces of the surface as it came out, each in a frame of its own, in the metric of a flow; where edges were flipped, by the
/// parts of the flow's triangles that a face consists of.
///
/// # Errors
/// [`Error::Layout`] for a face that does not hang together; those of [`Solution::refinement`] and [`crate::metric::Metric::lengths`];
/// [`Error::Cancelled`].
pub(crate) fn apart(result: &Solution, control: &Control) -> Result<Apart> {
    control.check()?;
    let given = result.given();
    let pieces = match result.is_unflipped() {
        true => Pieces::Mesh(given.clone()),
        false => Pieces::Refinement(Arc::new(result.refinement(control)?)),
    };
    let faces = Faces::precise(result.mesh(), result.metric())?;
    let frames = frames(&pieces, &faces)?;
    let identity = Motion::identity(faces.space);
    let n = given.n_halfedges();
    let mut apart =
        Apart { corner: PerHalfedge::filled(n, identity.origin()), across: PerHalfedge::filled(n, identity) };
    for piece in pieces.mesh().faces() {
        let sides = pieces.mesh().face_halfedges(piece);
        for k in 0..3 {
            if let Some(corner) = pieces.input_place((piece, k), sides[k]).rounded() {
                let h = given.face_halfedges(pieces.input_face(piece))[corner];
                let place = pieces.final_place((piece, k), sides[k]);
                apart.corner[h] = faces.point((pieces.final_face(piece), frames[piece]), place);
            }
            let beside = pieces.mesh().face(sides[k].twin());
            if let (Some(h), Some(beside)) = (pieces.input_halfedge(given, sides[k]), beside) {
                let there = through(&pieces, &faces, frames[piece], sides[k])?;
                apart.across[h] = there.compose(&frames[beside].inverse()).normalised();
            }
        }
    }
    Ok(apart)
}

/// Per piece the frame of the first half-edge of its final face, in the frame of its face of the input: that of the face's first piece.
fn frames(pieces: &Pieces, faces: &Faces<Motion<DoubleDouble>>) -> Result<PerFace<Motion<DoubleDouble>>> {
    let mesh = pieces.mesh();
    let mut first = vec![None; mesh.n_faces()];
    mesh.faces()
        .for_each(|p| first[pieces.input_face(p).index()] = first[pieces.input_face(p).index()].or(Some(p)));
    let mut frames: Vec<Option<Motion<DoubleDouble>>> = vec![None; mesh.n_faces()];
    let mut waiting: Vec<FaceId> = first.into_iter().flatten().collect();
    waiting.iter().for_each(|p| frames[p.index()] = Some(Motion::identity(faces.space)));
    while let Some(piece) = waiting.pop() {
        let Some(frame) = frames[piece.index()] else { continue };
        for h in mesh.face_halfedges(piece) {
            let Some(beside) = mesh.face(h.twin()).filter(|_| pieces.input_edge(h.edge()).is_none()) else {
                continue;
            };
            if frames[beside.index()].is_none() {
                frames[beside.index()] = Some(through(pieces, faces, frame, h)?);
                waiting.push(beside);
            }
        }
    }
    let all: Option<Vec<_>> = frames.into_iter().collect();
    Ok(all.ok_or_else(|| Error::Layout("the parts of a face do not hang together".into()))?.into())
}

/// The frame of the final face of the piece across a half-edge, from that of the piece on its left.
fn through(
    pieces: &Pieces,
    faces: &Faces<Motion<DoubleDouble>>,
    frame: Motion<DoubleDouble>,
    h: HalfedgeId,
) -> Result<Motion<DoubleDouble>> {
    let Some(along) = pieces.final_halfedge(h) else { return Ok(frame) };
    let (face, side) = corner_of(faces.mesh, along)?;
    let (next, k) = corner_of(faces.mesh, along.twin())?;
    let across = faces.across(faces.around(face, 0, frame)[side], along);
    Ok(faces.around(next, k, across)[0])
}
