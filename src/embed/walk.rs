//! Walks along edge paths of what a layout shows, in the universal cover: face after face, whatever the copies of the layout.

use super::faces::{Faces, corner_of};
use super::layout::Layout;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::flow::Solution;
use crate::geometry::{DoubleDouble, Motion, Space};
use crate::mesh::{FaceId, HalfedgeId};
use crate::topology::{corner_walk, crossed_halfedges};

/// Walks on a layout of a metric.
///
/// Products of the layout's side pairings lead from the middle of one copy to that of the next, in H² far from the path, which costs
/// e^{3 radius} of the digits; from face to face nothing leads farther than the path. In E², where the layout has a scale of its own, the
/// products cost none.
pub(super) struct Walks<'a> {
    faces: Faces<'a, Motion<DoubleDouble>>,
    layout: &'a Layout,
}

/// Where a walk is: a piece, its final face, and the frame of that face's first half-edge.
#[derive(Clone, Copy)]
struct Place {
    piece: FaceId,
    face: FaceId,
    frame: Motion<DoubleDouble>,
}

impl<'a> Walks<'a> {
    pub fn new(metric: &'a Solution, layout: &'a Layout) -> Result<Self> {
        Ok(Walks { faces: Faces::precise(metric.mesh(), metric.metric())?, layout })
    }

    pub fn layout(&self) -> &'a Layout {
        self.layout
    }

    /// The deck transformation of a closed path that starts at a corner (a half-edge of a face) of the layout, where the layout has it.
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

    /// The vertices of the lift of a path that starts at a corner, in the metric's own lengths: the final face of the corner lies with its
    /// first half-edge at the origin, along the x axis.
    pub fn points(&self, corner: HalfedgeId, path: &[HalfedgeId]) -> Result<Vec<[DoubleDouble; 3]>> {
        let mut place = self.start(corner)?;
        let mut points = vec![self.point(&place, corner)?];
        for (crossed, at) in corner_walk(self.layout.mesh(), corner, path)? {
            place = self.through(place, &crossed)?;
            points.push(self.point(&place, at)?);
        }
        Ok(points)
    }

    fn start(&self, corner: HalfedgeId) -> Result<Place> {
        let (piece, _) = corner_of(self.layout.mesh(), corner)?;
        let face = self.layout.pieces.final_face(piece);
        Ok(Place { piece, face, frame: Motion::identity(self.faces.space) })
    }

    /// The end of a walk through half-edges, each of the piece that the walk is in.
    fn through(&self, mut at: Place, crossed: &[HalfedgeId]) -> Result<Place> {
        let (mesh, faces) = (self.layout.mesh(), &self.faces);
        for &h in crossed {
            let (piece, _) = corner_of(mesh, h)?;
            if piece != at.piece {
                let where_it_is = at.piece;
                return Err(Error::Layout(format!(
                    "half-edge {h} is no side of face {where_it_is}, where a walk is"
                )));
            }
            (at.piece, _) = corner_of(mesh, h.twin())?;
            if let Some(along) = self.layout.pieces.final_halfedge(h) {
                let (_, side) = corner_of(faces.mesh, along)?;
                let (next, k) = corner_of(faces.mesh, along.twin())?;
                let across = faces.across(faces.around(at.face, 0, at.frame)[side], along);
                (at.face, at.frame) = (next, faces.around(next, k, across)[0]);
            }
        }
        Ok(at)
    }

    /// The origin of a half-edge of the piece that a walk is in.
    fn point(&self, at: &Place, h: HalfedgeId) -> Result<[DoubleDouble; 3]> {
        let corner = corner_of(self.layout.mesh(), h)?;
        Ok(self.faces.point((at.face, at.frame), self.layout.pieces.final_place(corner, h)))
    }
}
