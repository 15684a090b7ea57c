//! Developing an opened surface into the space of its metric: face after face, outwards from the origin.

use super::faces::{Faces, Placed, place_in_face};
use super::frame::Frame;
use super::pieces::Pieces;
use crate::control::{Control, Stage};
use crate::error::{Error, Result};
use crate::geometry::model::distance;
use crate::geometry::{Motion, Space, Twofold};
use crate::mesh::{FaceId, HalfedgeId, PerEdge, PerFace, PerHalfedge};
use crate::metric::Refinement;
use crate::topology::spanning::Key;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// "In no patch yet".
const NONE: u32 = u32::MAX;
/// Patches between two looks at the control.
const PATCHES_PER_STEP: usize = 4096;

/// What lies at the origin.
#[derive(Debug, Clone, Copy)]
pub(super) struct Start {
    /// A piece to begin with.
    pub piece: FaceId,
    /// The half-edge of its final face, by its number there, that lies along the x axis from the origin.
    pub side: usize,
}

/// Where everything lies. A *patch* is what hangs together of a final face between cuts: its pieces lie in one copy of the face.
pub(super) struct Development<F> {
    /// Per patch, in the order in which they were added, the frame of the first half-edge of its final face.
    pub frames: Vec<F>,
    /// Per piece its patch; `u32::MAX` for one that was not reached.
    pub patch: PerFace<u32>,
    /// The pieces, patch by patch.
    order: Vec<FaceId>,
    /// `order[starts[k]..starts[k + 1]]` are those of patch k.
    starts: Vec<u32>,
    /// Edges of the pieces through which a patch grew or was entered; empty where a cut was given.
    pub crossed: PerEdge<bool>,
}

/// Add face after face, next the one whose far corner is nearest to the origin, over no edge that `is_cut`.
///
/// This order keeps the largest coordinate on the way to every face as small as it can be. Accuracy asks for that: in H² what a
/// frame loses is magnified by e^distance, in E² a position is rounded to the spacing of doubles there. Frames are passed on from whole final
/// faces to whole final faces: pieces lie in them, however small they are, and nothing is laid out from a piece.
///
/// Without a cut every face is added once, and the edges that are not [`Development::crossed`] are where the growing disk meets itself.
///
/// Errors: [`Error::Layout`] for lengths beyond what doubles can place; [`Error::Cancelled`].
pub(super) fn develop<F: Frame>(
    pieces: &Pieces,
    faces: &Faces<F>,
    start: Start,
    is_cut: Option<&PerEdge<bool>>,
    control: &Control,
) -> Result<Development<F>> {
    let mesh = pieces.mesh();
    let mut grown = Development {
        frames: Vec::with_capacity(faces.mesh.n_faces()),
        patch: PerFace::filled(mesh.n_faces(), NONE),
        order: Vec::with_capacity(mesh.n_faces()),
        starts: Vec::with_capacity(faces.mesh.n_faces() + 1),
        crossed: PerEdge::filled(if is_cut.is_none() { mesh.n_edges() } else { 0 }, false),
    };
    let mut queue = BinaryHeap::new();
    let mut stack = Vec::new();
    let mut next = Some((start.piece, start.side, F::identity(faces.space)));
    while let Some((piece, side, frame)) = next {
        if grown.frames.len().is_multiple_of(PATCHES_PER_STEP) {
            control.step(Stage::Layout, grown.order.len() as f64 / mesh.n_faces() as f64)?;
        }
        let (number, face) = (grown.frames.len() as u32, pieces.final_face(piece));
        let sides = faces.around(face, side, frame);
        grown.frames.push(sides[0]);
        grown.starts.push(grown.order.len() as u32);
        grown.patch[piece] = number;
        stack.push(piece);
        let mut distance = [None; 3];
        while let Some(piece) = stack.pop() {
            grown.order.push(piece);
            for h in mesh.face_halfedges(piece) {
                let Some(beside) = mesh.face(h.twin()) else { continue };
                if is_cut.is_some_and(|is_cut| is_cut[h.edge()]) {
                    continue;
                }
                match pieces.final_halfedge(h) {
                    None => {
                        if grown.patch[beside] == NONE {
                            grown.patch[beside] = number;
                            stack.push(beside);
                        }
                        if is_cut.is_none() {
                            grown.crossed[h.edge()] |= grown.patch[beside] == number;
                        }
                    }
                    Some(_) if grown.patch[beside] != NONE => {}
                    Some(along) => {
                        let (_, k) = faces.place_of(along)?;
                        let far = match distance[k] {
                            Some(far) => far,
                            None => *distance[k].insert(distance_beyond(faces, sides[k], along)?),
                        };
                        queue.push(Reverse((Key(far), h.twin())));
                    }
                }
            }
        }
        next = None;
        while next.is_none() {
            let Some(Reverse((_, entry))) = queue.pop() else { break };
            next = enter(pieces, faces, &mut grown, entry)?;
        }
    }
    grown.starts.push(grown.order.len() as u32);
    Ok(grown)
}

/// The distance from the origin of the far corner of the face beyond a final half-edge with this frame.
fn distance_beyond<F: Frame>(faces: &Faces<F>, frame: F, along: HalfedgeId) -> Result<f64> {
    let (face, k) = faces.place_of(along.twin())?;
    let far = faces.distance_of_apex(faces.across(frame, along), face, k);
    if !far.is_finite() {
        return Err(Error::Layout(format!("edge {} lies beyond the range of doubles", along.edge())));
    }
    Ok(far)
}

/// The piece that a half-edge leads into, unless it has its place, with the number of its final half-edge and the frame of that.
fn enter<F: Frame>(
    pieces: &Pieces,
    faces: &Faces<F>,
    grown: &mut Development<F>,
    entry: HalfedgeId,
) -> Result<Option<(FaceId, usize, F)>> {
    let mesh = pieces.mesh();
    let (piece, _) = place_in_face(mesh, entry)?;
    if grown.patch[piece] != NONE {
        return Ok(None);
    }
    let (from, _) = place_in_face(mesh, entry.twin())?;
    let along = final_side(pieces, entry.twin())?;
    if !grown.crossed.is_empty() {
        grown.crossed[entry.edge()] = true;
    }
    let (_, k) = faces.place_of(along.twin())?;
    Ok(Some((piece, k, faces.across(grown.side(faces, from, along)?, along))))
}

fn final_side(pieces: &Pieces, h: HalfedgeId) -> Result<HalfedgeId> {
    let inside =
        || Error::Layout(format!("edge {} lies inside a face of the metric's triangulation", h.edge()));
    pieces.final_halfedge(h).ok_or_else(inside)
}

impl<F: Frame> Development<F> {
    /// The frame of the final half-edge `along`, of the final face of a piece, where that lies.
    fn side(&self, faces: &Faces<F>, piece: FaceId, along: HalfedgeId) -> Result<F> {
        let (face, k) = faces.place_of(along)?;
        Ok(faces.around(face, 0, self.frames[self.patch[piece] as usize])[k])
    }

    /// That of a refinement whose final faces all have these frames.
    pub fn of_frames(r: &Refinement, frames: PerFace<F>) -> Self {
        let mut order: Vec<FaceId> = r.mesh.faces().collect();
        order.sort_by_key(|&f| r.final_face[f]);
        let first = |k: usize| order.partition_point(|&f| r.final_face[f].index() < k) as u32;
        Development {
            starts: (0..=frames.len()).map(first).collect(),
            patch: r.final_face.iter().map(|f| f.0).collect::<Vec<_>>().into(),
            frames: frames.into_vec(),
            order,
            crossed: Vec::new().into(),
        }
    }

    /// Number of pieces that were reached.
    pub fn n_reached(&self) -> usize {
        self.order.len()
    }

    /// The pieces of a patch.
    pub fn pieces_of(&self, patch: usize) -> &[FaceId] {
        &self.order[self.starts[patch] as usize..self.starts[patch + 1] as usize]
    }

    /// Ambient coordinates per number of a corner: each from the first patch that has it; NaN for what was not reached.
    pub fn points(
        &self,
        pieces: &Pieces,
        faces: &Faces<F>,
        corner: &PerHalfedge<u32>,
        n_corners: usize,
    ) -> Vec<[f64; 3]> {
        let mut points = vec![[f64::NAN; 3]; n_corners];
        for (k, &frame) in self.frames.iter().enumerate() {
            let of_patch = self.pieces_of(k);
            let Some(&first) = of_patch.first() else { continue };
            let placed = faces.placed(pieces.final_face(first), frame);
            for &f in of_patch {
                for (h, weights) in
                    pieces.mesh().face_halfedges(f).into_iter().zip(pieces.final_barycentric(f))
                {
                    let point = &mut points[corner[h] as usize];
                    if point[0].is_nan() {
                        *point = placed.point(faces, weights);
                    }
                }
            }
        }
        points
    }

    /// The two places of one frame, of a half-edge `h` on the cut: as the face on its left and as the face on its right has it. What carries
    /// the second onto the first pairs the sides of the cut.
    pub fn on_both_sides(
        &self,
        pieces: &Pieces,
        faces: &Faces<F>,
        h: HalfedgeId,
    ) -> Result<[Motion<Twofold>; 2]> {
        let ((left, _), (right, _)) =
            (place_in_face(pieces.mesh(), h)?, place_in_face(pieces.mesh(), h.twin())?);
        let both = match pieces.final_halfedge(h) {
            Some(along) => {
                let twin = along.twin();
                [self.side(faces, left, along)?, faces.across(self.side(faces, right, twin)?, twin)]
            }
            // Two copies of one final face.
            None => [left, right].map(|f| self.frames[self.patch[f] as usize]),
        };
        Ok(both.map(|frame| frame.motion()))
    }
}

impl<F: Frame> Placed<F> {
    /// The point with these weights of the face's corners, as the face's first half-edge has it at the origin.
    fn local(&self, faces: &Faces<F>, weights: [f64; 3]) -> [f64; 3] {
        combination(faces.space, *self.local.get_or_init(|| faces.local(self.face)), weights)
    }

    /// The point of the face with these weights of its corners, where it lies.
    pub fn point(&self, faces: &Faces<F>, weights: [f64; 3]) -> [f64; 3] {
        match weights.iter().position(|&w| w == 1.0) {
            Some(corner) => self.sides[corner].apply([0.0, 0.0, 1.0]),
            None => self.sides[0].apply(self.local(faces, weights)),
        }
    }

    /// By how much a point misses that one: a vector in the frame of the face's first half-edge, for a corner that of its own.
    pub fn miss(&self, faces: &Faces<F>, point: [f64; 3], weights: [f64; 3]) -> [f64; 2] {
        match weights.iter().position(|&w| w == 1.0) {
            // About the corner itself: seen from elsewhere in a large face of H² it would be magnified.
            Some(corner) if faces.space != Space::E2 => self.sides[corner].miss(point, [0.0, 0.0, 1.0]),
            _ => self.sides[0].miss(point, self.local(faces, weights)),
        }
    }
}

/// The point of the plane, hyperboloid or sphere in the direction of a combination of points; at a corner, the corner itself.
pub(super) fn combination(space: Space, corners: [[f64; 3]; 3], weights: [f64; 3]) -> [f64; 3] {
    if let Some(corner) = weights.iter().position(|&w| w == 1.0) {
        return corners[corner];
    }
    let [x, y, w] = [0, 1, 2].map(|i| (0..3).map(|k| weights[k] * corners[k][i]).sum::<f64>());
    // −⟨P, P⟩ = Σ w_i² + Σ 2 w_i w_j cosh d_ij, and cosh d − 1 is half the square of the difference.
    let norm = match space {
        Space::E2 => w,
        Space::S2 => (x * x + y * y + w * w).sqrt(),
        Space::H2 => {
            let pairs = [[0, 1], [1, 2], [2, 0]].map(|[i, j]| {
                let half = (0.5 * distance(corners[i], corners[j])).sinh();
                4.0 * weights[i] * weights[j] * half * half
            });
            let sum: f64 = weights.iter().sum();
            (sum * sum + pairs.iter().sum::<f64>()).sqrt()
        }
    };
    let (x, y) = (x / norm, y / norm);
    // On the hyperboloid to the last digit.
    let w = if space == Space::H2 { 1.0f64.hypot(x.hypot(y)) } else { w / norm };
    [x, y, w]
}
