//! The development of an opened surface into the space of its metric: faces are placed one after the other, outwards from the origin.

use super::faces::{Faces, PlacedFace, corner_of, face_of};
use super::frame::{HalfedgeFrame, MovingFrame};
use super::pieces::LayoutPieces;
use crate::control::{Control, Stage};
use crate::error::{Error, Result};
use crate::geometry::{DoubleDouble, Motion};
use crate::mesh::{FaceId, HalfedgeId, PerEdge, PerFace, PerHalfedge, VertexId};
use crate::metric::CommonSubdivision;
use crate::parallel;
use crate::topology::{NearestQueue, check_vertex};
use std::sync::Arc;

/// The patch number of a piece that is in no patch yet.
const NONE: u32 = u32::MAX;
/// Number of patches after which the control is asked again whether to stop.
const PATCHES_PER_STEP: usize = 4096;

/// The places of the pieces. A *patch* is a part of a final face that no cut divides: its pieces lie in one copy of the face.
pub(super) struct Development<'a, F: HalfedgeFrame> {
    pub pieces: LayoutPieces,
    pub faces: &'a Faces<'a, F>,
    /// Per patch, the frame of the first half-edge of its final face. The first patch in a final face has the number of that face, so that
    /// patches are stored in the order of the faces; the other patches of faces that a cut divides follow.
    pub frames: Vec<F>,
    /// Per piece, its patch; `u32::MAX` if the piece was not reached.
    pub patch: PerFace<u32>,
    /// The number of patches that were reached.
    pub n_patches: usize,
    /// The pieces in the order in which they were added, patch by patch.
    order: Vec<FaceId>,
    /// The pieces of patch k are `order[spans[k][0]..spans[k][1]]`; empty for a mesh, each of whose faces is a patch.
    spans: Vec<[u32; 2]>,
    /// Per edge of the pieces, true if a patch grew or was entered through it; empty if a cut was given.
    pub crossed: PerEdge<bool>,
}

/// A development while it grows, which finds the order in which patches are added.
struct DevelopmentGrowth<'a, F: HalfedgeFrame> {
    pieces: &'a LayoutPieces,
    faces: &'a Faces<'a, F>,
    is_cut: Option<&'a PerEdge<bool>>,
    /// Per patch, the frame of the first half-edge of its final face.
    frames: Vec<F::Rough>,
    /// Per patch but the first, in the order of their adding, the half-edge of a piece through which the patch was entered.
    entries: Vec<HalfedgeId>,
    patch: PerFace<u32>,
    n_patches: usize,
    order: Vec<FaceId>,
    spans: Vec<[u32; 2]>,
    crossed: PerEdge<bool>,
    /// Half-edges through which the development can go on, by [`DevelopmentGrowth::distance`].
    queue: NearestQueue<HalfedgeId>,
}

impl<'a, F: HalfedgeFrame> Development<'a, F> {
    /// The development of the pieces from the origin, where the vertex `root`, or a corner of the smallest final face, lies. Faces are
    /// added one after the other, next the one behind the edge that is nearest to the origin, over no edge that `is_cut`.
    ///
    /// This order keeps the largest coordinate on the way to every face small, which accuracy needs: in H² the error of a frame is
    /// magnified by e^distance, in E² a position is rounded to the spacing of f64s there. Frames are passed on between whole final faces,
    /// and pieces are placed in these, so the place of a face never depends on a small piece.
    ///
    /// Without a cut every face is added once, next the one whose far corner is nearest, and the growing disk meets itself along the edges
    /// that are not [`Development::crossed`].
    ///
    /// # Errors
    /// [`Error::Argument`] for a root that is no vertex; [`Error::Layout`] for a root without a face and for lengths beyond what f64s
    /// can place; [`Error::Cancelled`].
    pub fn grow(
        pieces: LayoutPieces,
        faces: &'a Faces<'a, F>,
        root: Option<VertexId>,
        is_cut: Option<&PerEdge<bool>>,
        control: &Control,
    ) -> Result<Self> {
        let (piece, side) = start(&pieces, faces, root)?;
        let (n_pieces, n_final, n_edges) =
            (pieces.mesh().n_faces(), faces.mesh.n_faces(), pieces.mesh().n_edges());
        let mut growth = DevelopmentGrowth {
            pieces: &pieces,
            faces,
            is_cut,
            frames: vec![MovingFrame::identity(faces.space); n_final],
            entries: Vec::with_capacity(if F::IS_PRECISE { n_final } else { 0 }),
            patch: PerFace::filled(n_pieces, NONE),
            n_patches: 0,
            order: Vec::with_capacity(n_pieces),
            spans: vec![[0; 2]; if pieces.common_subdivision().is_some() { n_final } else { 0 }],
            crossed: PerEdge::filled(if is_cut.is_none() { n_edges } else { 0 }, false),
            queue: NearestQueue::new((faces.area() / n_final as f64).sqrt()),
        };
        control.step(Stage::Layout, 0.0)?;
        growth.add(piece, side, MovingFrame::identity(faces.space))?;
        while let Some((_, h)) = growth.queue.pop() {
            if growth.enter(h)? && growth.n_patches.is_multiple_of(PATCHES_PER_STEP) {
                control.step(Stage::Layout, growth.order.len() as f64 / n_pieces as f64)?;
            }
        }
        let DevelopmentGrowth { frames, entries, patch, n_patches, order, spans, crossed, .. } = growth;
        let n_frames = frames.len();
        let known: Option<Vec<F>> = frames.into_iter().map(F::of_rough).collect();
        let is_known = known.is_some();
        let frames = known.unwrap_or_else(|| vec![F::identity(faces.space); n_frames]);
        let mut grown = Development { pieces, faces, frames, patch, n_patches, order, spans, crossed };
        if !is_known {
            grown.compute_frames(piece, side, &entries, control)?;
        }
        Ok(grown)
    }

    /// Computes the frames of the patches, each from that of the patch from which it was entered. `piece`, `side`: as in [`start`].
    fn compute_frames(
        &mut self,
        piece: FaceId,
        side: usize,
        entries: &[HalfedgeId],
        control: &Control,
    ) -> Result<()> {
        let mut looked_at = 0;
        let (faces, mesh) = (self.faces, self.pieces.mesh());
        self.frames[self.patch[piece] as usize] =
            faces.first(self.pieces.final_face(piece), side, F::identity(faces.space));
        for &h in entries {
            control.check_every(PATCHES_PER_STEP, &mut looked_at)?;
            let ([from, to], along) =
                ([face_of(mesh, h.twin())?, face_of(mesh, h)?], final_side(&self.pieces, h.twin())?);
            let ((face, k), (next, side)) =
                (corner_of(faces.mesh, along)?, corner_of(faces.mesh, along.twin())?);
            let beyond = faces.beyond(face, k, self.frames[self.patch[from] as usize]);
            self.frames[self.patch[to] as usize] = faces.first(next, side, beyond);
        }
        Ok(())
    }

    /// The frame, in the layout of a piece, of the half-edge `along` of the piece's final face.
    fn side(&self, piece: FaceId, along: HalfedgeId) -> Result<F> {
        let (face, k) = corner_of(self.faces.mesh, along)?;
        Ok(self.faces.side(face, k, self.frames[self.patch[piece] as usize]))
    }

    /// The development of a subdivision, given the frames of the first half-edges of its final faces.
    pub fn of_frames(r: &Arc<CommonSubdivision>, faces: &'a Faces<'a, F>, frames: Vec<F>) -> Self {
        let mut order: Vec<FaceId> = r.mesh.faces().collect();
        order.sort_by_key(|&f| r.faces[1][f]);
        let first = |k: usize| order.partition_point(|&f| r.faces[1][f].index() < k) as u32;
        Development {
            pieces: LayoutPieces::Subdivision(r.clone()),
            faces,
            spans: (0..frames.len()).map(|k| [first(k), first(k + 1)]).collect(),
            n_patches: frames.len(),
            patch: r.faces[1].iter().map(|f| f.0).collect::<Vec<_>>().into(),
            frames,
            order,
            crossed: Vec::new().into(),
        }
    }

    /// The number of pieces that were reached.
    pub fn n_reached(&self) -> usize {
        self.order.len()
    }

    /// The pieces of a patch; of a subdivision, none if the patch's final face was not reached.
    pub fn pieces_of(&self, patch: usize) -> impl Iterator<Item = FaceId> + '_ {
        let of_mesh = self.spans.is_empty().then(|| FaceId::from(patch));
        let [begin, end] = self.spans.get(patch).map_or([0; 2], |span| span.map(|k| k as usize));
        of_mesh.into_iter().chain(self.order[begin..end].iter().copied())
    }

    /// The final face of a piece at its place.
    pub fn placed(&self, piece: FaceId) -> PlacedFace<'_, F> {
        PlacedFace::new(self.faces, self.pieces.final_face(piece), self.frames[self.patch[piece] as usize])
    }

    /// The ambient coordinates of the corners: each from the first patch that contains it, NaN if none was reached that does. `corner`: per
    /// half-edge, the number of the corner at its origin.
    pub fn points(&self, corner: &PerHalfedge<u32>, n_corners: usize) -> Vec<[f64; 3]> {
        self.points_and_remainders(corner, n_corners).0
    }

    /// [`Development::points`], and the low parts of x and y in double-double precision at the corners of final faces.
    pub fn points_and_remainders(
        &self,
        corner: &PerHalfedge<u32>,
        n_corners: usize,
    ) -> (Vec<[f64; 3]>, Vec<[f64; 2]>) {
        let mesh = self.pieces.mesh();
        // Per number, the first corner of a piece that bears it: 3f + k.
        let mut first = vec![NONE; n_corners];
        for &f in &self.order {
            for (at, h) in (3 * f.0..).zip(mesh.face_halfedges(f)) {
                let first = &mut first[corner[h] as usize];
                *first = if *first == NONE { at } else { *first };
            }
        }
        let (mut points, mut remainders) = (vec![[f64::NAN; 3]; n_corners], vec![[0.0; 2]; n_corners]);
        parallel::fill_both(&mut points, &mut remainders, |k| {
            if first[k] == NONE {
                return ([f64::NAN; 3], [0.0; 2]);
            }
            let (f, k) = (FaceId(first[k] / 3), first[k] as usize % 3);
            self.placed(f).point(self.pieces.final_place((f, k), mesh.face_halfedges(f)[k]))
        });
        (points, remainders)
    }

    /// The frame of a half-edge `h` on the cut by the face on its left, and by the face on its right. The isometry that carries the second
    /// onto the first pairs the sides of the cut.
    pub fn on_both_sides(&self, h: HalfedgeId) -> Result<[Motion<DoubleDouble>; 2]> {
        let mesh = self.pieces.mesh();
        let ((left, _), (right, _)) = (corner_of(mesh, h)?, corner_of(mesh, h.twin())?);
        let both = match self.pieces.final_halfedge(h) {
            Some(along) => {
                let twin = along.twin();
                [self.side(left, along)?, self.faces.across(self.side(right, twin)?, twin)]
            }
            // Two copies of one final face.
            None => [left, right].map(|f| self.frames[self.patch[f] as usize]),
        };
        Ok(both.map(|frame| frame.motion()))
    }
}

impl<F: HalfedgeFrame> DevelopmentGrowth<'_, F> {
    /// Adds a patch: a piece, and all pieces that are connected with it inside its final face. `frame`: of half-edge number `k` of that
    /// face.
    fn add(&mut self, piece: FaceId, k: usize, frame: F::Rough) -> Result<()> {
        let (mesh, faces, pieces) = (self.pieces.mesh(), self.faces, self.pieces);
        let face = pieces.final_face(piece);
        let is_refined = pieces.common_subdivision().is_some();
        let (halfedges, sides) = (faces.mesh.face_halfedges(face), faces.around(face, k, frame));
        let number = self.new_patch(face, sides[0]);
        let (begin, mut distance) = (self.order.len(), [None; 3]);
        let mut done = begin;
        self.patch[piece] = number;
        self.order.push(piece);
        // Pieces are appended to `order` while it is walked through.
        while let Some(&piece) = self.order.get(done) {
            done += 1;
            for (number_in_piece, h) in mesh.face_halfedges(piece).into_iter().enumerate() {
                let Some(beside) = mesh.face(h.twin()) else { continue };
                let is_placed = self.patch[beside] != NONE;
                if self.is_cut.is_some_and(|is_cut| is_placed || is_cut[h.edge()]) {
                    continue;
                }
                match pieces.final_halfedge(h) {
                    None => {
                        if !is_placed {
                            self.patch[beside] = number;
                            self.order.push(beside);
                        }
                        if self.is_cut.is_none() {
                            self.crossed[h.edge()] |= self.patch[beside] == number;
                        }
                    }
                    Some(_) if is_placed => {}
                    Some(along) => {
                        let k = if is_refined { number_in(halfedges, along)? } else { number_in_piece };
                        let far = match distance[k] {
                            Some(far) => far,
                            None => *distance[k].insert(self.distance(&sides, k, along)?),
                        };
                        self.queue.push(far, h.twin());
                    }
                }
            }
        }
        if is_refined {
            self.spans[number as usize] = [begin as u32, self.order.len() as u32];
        }
        Ok(())
    }

    /// The distance that decides when the face beyond side `k` of a final face is added: with a cut, the mean distance of the ends of the
    /// side from the origin; without one, the distance of the face's far corner. `sides`: the frames of the final face's sides.
    fn distance(&self, sides: &[F::Rough; 3], k: usize, along: HalfedgeId) -> Result<f64> {
        let distance = match self.is_cut {
            Some(_) => Some(0.5 * (sides[k].distance() + sides[(k + 1) % 3].distance())),
            None => self.faces.distance_beyond(sides[k], along),
        };
        let beyond = || {
            Error::Layout(format!("edge {} lies beyond the range of floating-point numbers", along.edge()))
        };
        distance.filter(|far| far.is_finite()).ok_or_else(beyond)
    }

    /// The number of a new patch in a final face, which is stored with the frame of that face.
    fn new_patch(&mut self, face: FaceId, frame: F::Rough) -> u32 {
        self.n_patches += 1;
        let is_first = self.spans.get(face.index()).is_none_or(|[begin, end]| begin == end);
        if is_first {
            self.frames[face.index()] = frame;
            return face.0;
        }
        self.frames.push(frame);
        self.spans.push([0; 2]);
        self.frames.len() as u32 - 1
    }

    /// Adds the patch into which a half-edge leads, unless the piece of the half-edge is placed already; true if a patch was added.
    fn enter(&mut self, h: HalfedgeId) -> Result<bool> {
        let unplaced = self.pieces.mesh().face(h).filter(|&f| self.patch[f] == NONE);
        let Some(piece) = unplaced else { return Ok(false) };
        let from = face_of(self.pieces.mesh(), h.twin())?;
        let along = final_side(self.pieces, h.twin())?;
        if !self.crossed.is_empty() {
            self.crossed[h.edge()] = true;
        }
        if F::IS_PRECISE {
            self.entries.push(h);
        }
        let (face, mesh) = (self.pieces.final_face(from), self.faces.mesh);
        let k = number_in(mesh.face_halfedges(face), along)?;
        let side = number_in(mesh.face_halfedges(self.pieces.final_face(piece)), along.twin())?;
        let frame = self.faces.beyond(face, k, self.frames[self.patch[from] as usize]);
        self.add(piece, side, frame).map(|()| true)
    }
}

/// The number of a half-edge among those of the final face of a piece that has it as a side.
fn number_in(sides: [HalfedgeId; 3], along: HalfedgeId) -> Result<usize> {
    let torn = || Error::Layout("a piece of the subdivision does not lie in its face".into());
    sides.iter().position(|&side| side == along).ok_or_else(torn)
}

/// The half-edge of a final face along which a half-edge of a piece runs.
///
/// # Errors
/// [`Error::Layout`] if it runs through the inside of the face.
fn final_side(pieces: &LayoutPieces, h: HalfedgeId) -> Result<HalfedgeId> {
    let inside =
        || Error::Layout(format!("edge {} lies inside a face of the metric's triangulation", h.edge()));
    pieces.final_halfedge(h).ok_or_else(inside)
}

/// The first piece, and the number of the half-edge of its final face that is to lie along the x axis from the origin: a half-edge that
/// leaves the root, or one of the smallest final face.
fn start<F: HalfedgeFrame>(
    pieces: &LayoutPieces,
    faces: &Faces<F>,
    root: Option<VertexId>,
) -> Result<(FaceId, usize)> {
    let mesh = pieces.mesh();
    let Some(root) = root else {
        let sized = mesh.faces().map(|f| (f, faces.longest(pieces.final_face(f))));
        let smallest = sized.min_by(|(_, a), (_, b)| a.total_cmp(b)).map(|(f, _)| f);
        return Ok((smallest.ok_or_else(|| Error::Layout("the surface has no face".into()))?, 0));
    };
    check_vertex(faces.mesh, root)?;
    check_vertex(mesh, root)?;
    // A layout of the final triangulation and one of its subdivision agree if both start with the first half-edge of the final triangulation
    // at the root. If that belongs to no piece, since it lies on the other half of the double, any other one is taken.
    let first = faces.mesh.outgoing(root).find(|&h| !faces.mesh.is_outside(h));
    let mut any = None;
    for h in mesh.outgoing(root).filter(|&h| !mesh.is_outside(h)) {
        let corner = corner_of(mesh, h)?;
        let (piece, Some(side)) = (corner.0, pieces.final_place(corner, h).corner()) else { continue };
        if first == Some(faces.mesh.face_halfedges(pieces.final_face(piece))[side]) {
            return Ok((piece, side));
        }
        any = any.or(Some((piece, side)));
    }
    any.ok_or_else(|| Error::Layout(format!("vertex {root} has no face")))
}
