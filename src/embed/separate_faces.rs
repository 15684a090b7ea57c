//! The faces of the input, in the metric of a flow, each in a frame of its own, and the motions between neighbouring frames.
//!
//! Each face lies near the origin of its frame, so errors do not grow with the extent of the surface, whereas in H² a layout in a single
//! frame magnifies errors by e^distance.

use super::faces::Faces;
use super::pieces::LayoutPieces;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::flow::Solution;
use crate::geometry::{DoubleDouble, Motion};
use crate::mesh::{FaceId, HalfedgeId, PerFace, PerHalfedge};
use std::sync::Arc;

/// The faces of the input, in the metric of a flow, each in a frame of its own. If edges were flipped, a face consists of
/// pieces of the flow's triangles.
pub(crate) struct SeparateFaces {
    /// Per half-edge of a face, its origin in the frame of the face.
    pub corner: PerHalfedge<[DoubleDouble; 3]>,
    /// Per half-edge between two faces, the motion from the frame of the face across it to the frame of its own face; the identity
    /// elsewhere.
    pub across: PerHalfedge<Motion<DoubleDouble>>,
}

impl SeparateFaces {
    /// The faces of a flow's result.
    ///
    /// # Errors
    /// [`Error::Layout`] for a face whose pieces are not connected; those of [`Solution::common_subdivision`] and
    /// [`crate::metric::Metric::lengths`]; [`Error::Cancelled`].
    pub(crate) fn of_solution(solution: &Solution, control: &Control) -> Result<SeparateFaces> {
        control.check()?;
        let given = solution.given();
        let pieces = if solution.is_unflipped() {
            LayoutPieces::Mesh(given.clone())
        } else {
            LayoutPieces::Subdivision(Arc::new(solution.common_subdivision(control)?))
        };
        let faces = Faces::precise(solution.mesh(), solution.metric())?;
        let frames = frames(&pieces, &faces)?;
        let identity = Motion::identity(faces.space);
        let n = given.n_halfedges();
        let mut corner = PerHalfedge::filled(n, identity.origin());
        let mut across = PerHalfedge::filled(n, identity);
        for piece in pieces.mesh().faces() {
            let sides = pieces.mesh().face_halfedges(piece);
            for k in 0..3 {
                if let Some(input_corner) = pieces.input_place((piece, k), sides[k]).rounded_corner() {
                    let h = given.face_halfedges(pieces.input_face(piece))[input_corner];
                    let place = pieces.final_place((piece, k), sides[k]);
                    corner[h] = faces.point(pieces.final_face(piece), frames[piece], place);
                }
                let beside = pieces.mesh().face(sides[k].twin());
                if let (Some(h), Some(beside)) = (pieces.input_halfedge(sides[k]), beside) {
                    let frame = frame_beyond(&pieces, &faces, frames[piece], sides[k])?;
                    // All parts of an edge give the same motion, up to rounding.
                    across[h] = frame.compose(&frames[beside].inverse()).normalised();
                }
            }
        }
        Ok(SeparateFaces { corner, across })
    }
}

/// Per piece, the motion from the standard position of its final face (first corner at the origin, first side along the x axis) to the frame
/// of its input face. An input face's frame is the one in which this is the identity for its first piece.
fn frames(
    pieces: &LayoutPieces,
    faces: &Faces<Motion<DoubleDouble>>,
) -> Result<PerFace<Motion<DoubleDouble>>> {
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
                frames[beside.index()] = Some(frame_beyond(pieces, faces, frame, h)?);
                waiting.push(beside);
            }
        }
    }
    let all: Option<Vec<_>> = frames.into_iter().collect();
    Ok(all.ok_or_else(|| Error::Layout("the pieces of a face are not connected".into()))?.into())
}

/// As in [`frames`], the motion for the piece across `h`, continued from that of the piece at `h`.
fn frame_beyond(
    pieces: &LayoutPieces,
    faces: &Faces<Motion<DoubleDouble>>,
    frame: Motion<DoubleDouble>,
    h: HalfedgeId,
) -> Result<Motion<DoubleDouble>> {
    match pieces.final_halfedge(h) {
        Some(along) => Ok(faces.across_side(frame, along)?.1),
        None => Ok(frame),
    }
}
