//! Walks from face to face in the universal cover, along edge paths of the triangulation that is laid out.

use super::faces::{Faces, corner_of};
use super::layout::Layout;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::flow::Solution;
use crate::geometry::{DoubleDouble, Motion, Space};
use crate::mesh::{FaceId, HalfedgeId};
use crate::topology::{corner_walk, crossed_halfedges};

/// Walks in the universal cover of a layout of a metric.
///
/// A product of the layout's side pairings leads from the middle of one copy of the layout to the middle of the next, in H² far from the
/// path, and magnifies errors by e^{3 radius}. A walk from face to face never leads farther than the path. In E², where the layout may have
/// another scale than the metric, products are exact enough and are used.
pub(super) struct CoverWalks<'a> {
    faces: Faces<'a, Motion<DoubleDouble>>,
    layout: &'a Layout,
}

/// The position of a walk: a piece, its final face, and the frame of that face's first half-edge.
#[derive(Clone, Copy)]
struct WalkPosition {
    piece: FaceId,
    face: FaceId,
    frame: Motion<DoubleDouble>,
}

impl<'a> CoverWalks<'a> {
    pub fn new(metric: &'a Solution, layout: &'a Layout) -> Result<Self> {
        Ok(CoverWalks { faces: Faces::precise(metric.mesh(), metric.metric())?, layout })
    }

    pub fn layout(&self) -> &'a Layout {
        self.layout
    }

    /// The deck transformation of a closed path that starts at the corner of the layout at the origin of `corner`, a half-edge of a face.
    pub fn element(
        &self,
        corner: HalfedgeId,
        path: &[HalfedgeId],
        control: &Control,
    ) -> Result<Motion<DoubleDouble>> {
        control.check()?;
        let crossed = crossed_halfedges(self.layout.mesh(), corner, path)?;
        if self.layout.space != Space::H2 {
            let steps = crossed.iter().filter(|h| self.layout.side(**h) != 0);
            let step =
                |m: Motion<DoubleDouble>, &h: &HalfedgeId| m.compose(&self.layout.neighbour(h).normalised());
            return Ok(steps.fold(Motion::identity(self.layout.space), step).normalised());
        }
        let end = self.through(self.start(corner)?, &crossed)?;
        let home = self.layout.frame(end.piece)?;
        Ok(end.frame.conjugated_by(&home).normalised())
    }

    /// The vertices of the lift of a path that starts at a corner, in the metric's own lengths. The first half-edge of the corner's final
    /// face starts at the origin, along the x axis.
    pub fn points(&self, corner: HalfedgeId, path: &[HalfedgeId]) -> Result<Vec<[DoubleDouble; 3]>> {
        let mut place = self.start(corner)?;
        let mut points = vec![self.point(&place, corner)?];
        for (crossed, at) in corner_walk(self.layout.mesh(), corner, path)? {
            place = self.through(place, &crossed)?;
            points.push(self.point(&place, at)?);
        }
        Ok(points)
    }

    /// The position at a corner, when the first half-edge of its final face starts at the origin.
    fn start(&self, corner: HalfedgeId) -> Result<WalkPosition> {
        let (piece, _) = corner_of(self.layout.mesh(), corner)?;
        let face = self.layout.pieces.final_face(piece);
        Ok(WalkPosition { piece, face, frame: Motion::identity(self.faces.space) })
    }

    /// The position after a walk through half-edges, each of which is a side of the piece where the walk is then.
    fn through(&self, mut at: WalkPosition, crossed: &[HalfedgeId]) -> Result<WalkPosition> {
        let mesh = self.layout.mesh();
        for &h in crossed {
            let (piece, _) = corner_of(mesh, h)?;
            if piece != at.piece {
                let face = at.piece;
                return Err(Error::Layout(format!(
                    "half-edge {h} is no side of face {face}, where a walk is"
                )));
            }
            (at.piece, _) = corner_of(mesh, h.twin())?;
            if let Some(along) = self.layout.pieces.final_halfedge(h) {
                (at.face, at.frame) = self.faces.across_side(at.frame, along)?;
            }
        }
        Ok(at)
    }

    /// The origin of a half-edge of the piece where a walk is.
    fn point(&self, at: &WalkPosition, h: HalfedgeId) -> Result<[DoubleDouble; 3]> {
        let corner = corner_of(self.layout.mesh(), h)?;
        Ok(self.faces.point(at.face, at.frame, self.layout.pieces.final_place(corner, h)))
    }
}
