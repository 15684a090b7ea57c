//! Developing an opened surface into the space of its metric: face after face, outwards from the origin.

use super::faces::{Faces, Placed, corner_of, face_of};
use super::frame::{Frame, Walk};
use super::pieces::Pieces;
use crate::control::{Control, Stage};
use crate::error::{Error, Result};
use crate::geometry::{DoubleDouble, Motion};
use crate::mesh::{FaceId, HalfedgeId, PerEdge, PerFace, PerHalfedge, VertexId};
use crate::metric::Refinement;
use crate::parallel;
use crate::topology::{NearestQueue, check_vertex};
use std::hint::black_box;
use std::sync::Arc;

/// The patch number of a piece that no patch has yet.
const NONE: u32 = u32::MAX;
/// Patches between two looks at the control.
const PATCHES_PER_STEP: usize = 4096;

/// Where every piece lies. A *patch* is a part of a final face that no cut divides: its pieces lie in one copy of the face.
pub(super) struct Development<'a, F: Frame> {
    pub pieces: Pieces,
    pub faces: &'a Faces<'a, F>,
    /// Per patch the frame of the first half-edge of its final face. The first patch in a final face has the number of that face, so that
    /// patches stand in memory as the faces do; where a cut divides faces, their other patches follow.
    pub frames: Vec<F>,
    /// The patch of each piece; `u32::MAX` for a piece that was not reached.
    pub patch: PerFace<u32>,
    /// Number of patches that were reached.
    pub n_patches: usize,
    /// The pieces in the order in which they were added, patch by patch.
    order: Vec<FaceId>,
    /// The pieces of patch k are `order[spans[k][0]..spans[k][1]]`; empty for a mesh, each of whose faces is a patch.
    spans: Vec<[u32; 2]>,
    /// Edges of the pieces through which a patch grew or was entered; empty where a cut was given.
    pub crossed: PerEdge<bool>,
}

/// A development in the making: the order in which patches are added.
struct Growth<'a, F: Frame> {
    pieces: &'a Pieces,
    faces: &'a Faces<'a, F>,
    is_cut: Option<&'a PerEdge<bool>>,
    /// Per patch a frame of the first half-edge of its final face.
    frames: Vec<F::Rough>,
    /// For every patch but the first, in the order in which they were added, the half-edge of a piece through which it was entered.
    entries: Vec<HalfedgeId>,
    patch: PerFace<u32>,
    n_patches: usize,
    order: Vec<FaceId>,
    spans: Vec<[u32; 2]>,
    crossed: PerEdge<bool>,
    /// Half-edges through which the development can go on, by [`Growth::distance`].
    queue: NearestQueue<HalfedgeId>,
    /// Memory of [`Growth::next`].
    coming: Vec<FaceId>,
}

impl<'a, F: Frame> Development<'a, F> {
    /// Adds face after face, next the one behind the edge that is nearest to the origin, over no edge that `is_cut`. The vertex `root`, or
    /// a corner of the smallest final face, lies at the origin.
    ///
    /// This order keeps the largest coordinate on the way to every face small. Accuracy needs that: in H² the error of a frame is
    /// magnified by e^distance, in E² a position is rounded to the spacing of doubles there. Frames are passed on between whole final
    /// faces, and pieces are placed in these: a small piece never decides where its neighbours lie.
    ///
    /// Without a cut every face is added once, next the one whose far corner is nearest, and the edges that are not
    /// [`Development::crossed`] are where the growing disk meets itself.
    ///
    /// # Errors
    /// [`Error::Argument`] for a root that is no vertex; [`Error::Layout`] for a root without a face and for lengths beyond what doubles
    /// can place; [`Error::Cancelled`].
    pub fn grow(
        pieces: Pieces,
        faces: &'a Faces<'a, F>,
        root: Option<VertexId>,
        is_cut: Option<&PerEdge<bool>>,
        control: &Control,
    ) -> Result<Self> {
        let (piece, side) = start(&pieces, faces, root)?;
        let (n_pieces, n_final, n_edges) =
            (pieces.mesh().n_faces(), faces.mesh.n_faces(), pieces.mesh().n_edges());
        let mut growth = Growth {
            pieces: &pieces,
            faces,
            is_cut,
            frames: vec![Walk::identity(faces.space); n_final],
            entries: Vec::with_capacity(if F::IS_PRECISE { n_final } else { 0 }),
            patch: PerFace::filled(n_pieces, NONE),
            n_patches: 0,
            order: Vec::with_capacity(n_pieces),
            spans: vec![[0; 2]; if pieces.refinement().is_some() { n_final } else { 0 }],
            crossed: PerEdge::filled(if is_cut.is_none() { n_edges } else { 0 }, false),
            queue: NearestQueue::new((faces.area() / n_final as f64).sqrt()),
            coming: Vec::new(),
        };
        control.step(Stage::Layout, 0.0)?;
        growth.add(piece, side, Walk::identity(faces.space))?;
        while let Some(h) = growth.next() {
            if growth.enter(h)? && growth.n_patches.is_multiple_of(PATCHES_PER_STEP) {
                control.step(Stage::Layout, growth.order.len() as f64 / n_pieces as f64)?;
            }
        }
        let Growth { frames, entries, patch, n_patches, order, spans, crossed, .. } = growth;
        let n_frames = frames.len();
        let known: Option<Vec<F>> = frames.into_iter().map(F::of_rough).collect();
        let is_known = known.is_some();
        let frames = known.unwrap_or_else(|| vec![F::identity(faces.space); n_frames]);
        let mut grown = Development { pieces, faces, frames, patch, n_patches, order, spans, crossed };
        if !is_known {
            grown.walk((piece, side), &entries, control)?;
        }
        Ok(grown)
    }

    /// Forms the frames of the patches, each from that of the patch that it was entered from.
    fn walk(
        &mut self,
        (piece, side): (FaceId, usize),
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

    /// The frame of the final half-edge `along`, of the final face of a piece, where that piece lies.
    fn side(&self, piece: FaceId, along: HalfedgeId) -> Result<F> {
        let (face, k) = corner_of(self.faces.mesh, along)?;
        Ok(self.faces.side(face, k, self.frames[self.patch[piece] as usize]))
    }

    /// The development of a refinement all of whose final faces have their first half-edges where these frames are.
    pub fn of_frames(r: &Arc<Refinement>, faces: &'a Faces<'a, F>, frames: Vec<F>) -> Self {
        let mut order: Vec<FaceId> = r.mesh.faces().collect();
        order.sort_by_key(|&f| r.final_face[f]);
        let first = |k: usize| order.partition_point(|&f| r.final_face[f].index() < k) as u32;
        Development {
            pieces: Pieces::Refinement(r.clone()),
            faces,
            spans: (0..frames.len()).map(|k| [first(k), first(k + 1)]).collect(),
            n_patches: frames.len(),
            patch: r.final_face.iter().map(|f| f.0).collect::<Vec<_>>().into(),
            frames,
            order,
            crossed: Vec::new().into(),
        }
    }

    /// Number of pieces that were reached.
    pub fn n_reached(&self) -> usize {
        self.order.len()
    }

    /// The pieces of a patch; of a refinement none where its final face was not reached.
    pub fn pieces_of(&self, patch: usize) -> impl Iterator<Item = FaceId> + '_ {
        let of_mesh = self.spans.is_empty().then(|| FaceId::from(patch));
        let [begin, end] = self.spans.get(patch).map_or([0; 2], |span| span.map(|k| k as usize));
        of_mesh.into_iter().chain(self.order[begin..end].iter().copied())
    }

    /// The final face of a piece where it lies.
    pub fn placed(&self, piece: FaceId) -> Placed<'_, F> {
        Placed::new(self.faces, self.pieces.final_face(piece), self.frames[self.patch[piece] as usize])
    }

    /// Ambient coordinates per number of a corner: each from the first patch that has it; NaN for what was not reached.
    pub fn points(&self, corner: &PerHalfedge<u32>, n_corners: usize) -> Vec<[f64; 3]> {
        self.points_and_remainders(corner, n_corners).0
    }

    /// [`Development::points`], and what their doubles miss of x and y at the corners of final faces.
    pub fn points_and_remainders(
        &self,
        corner: &PerHalfedge<u32>,
        n_corners: usize,
    ) -> (Vec<[f64; 3]>, Vec<[f64; 2]>) {
        let mesh = self.pieces.mesh();
        // The corner of a piece that each number is taken from: 3f + k.
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

    /// The two places of one frame, of a half-edge `h` on the cut: as the face on its left and as the face on its right has it. The
    /// isometry that carries the second onto the first pairs the sides of the cut.
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

impl<F: Frame> Growth<'_, F> {
    /// Adds a patch: a piece, whose final face has the frame of its half-edge number `k`, and all that hang together with it in that face.
    fn add(&mut self, piece: FaceId, k: usize, frame: F::Rough) -> Result<()> {
        let (mesh, faces, pieces) = (self.pieces.mesh(), self.faces, self.pieces);
        let face = pieces.final_face(piece);
        let is_refined = pieces.refinement().is_some();
        let (own, sides) = (faces.mesh.face_halfedges(face), faces.around(face, k, frame));
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
                        let k = match is_refined {
                            true => number_in(own, along)?,
                            false => number_in_piece,
                        };
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

    /// By which distance the face beyond side `k` of a final face, whose sides have these frames, is to be added: with a cut by how far the
    /// ends of the side are from the origin, on the average, without one by the distance of its far corner.
    fn distance(&self, sides: &[F::Rough; 3], k: usize, along: HalfedgeId) -> Result<f64> {
        let distance = match self.is_cut {
            Some(_) => Some(0.5 * (sides[k].distance() + sides[(k + 1) % 3].distance())),
            None => self.faces.distance_beyond(sides[k], along),
        };
        let beyond = || Error::Layout(format!("edge {} lies beyond the range of doubles", along.edge()));
        distance.filter(|far| far.is_finite()).ok_or_else(beyond)
    }

    /// The number of a new patch in a final face with this frame.
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

    /// The next half-edge through which the development may go on.
    fn next(&mut self) -> Option<HalfedgeId> {
        let Growth { queue, faces, pieces, patch, frames, spans, coming, .. } = self;
        let mesh = pieces.mesh();
        // One array after the other, so that no read waits for one of the same half-edge.
        let read = |ahead: &[(i64, HalfedgeId)]| {
            coming.clear();
            coming.extend(ahead.iter().filter_map(|&(_, h)| mesh.face(h)));
            coming.retain(|&piece| patch[piece] == NONE);
            for &piece in &*coming {
                let sides = mesh.face_halfedges(piece);
                black_box(sides.map(|h| (mesh.face(h.twin()), pieces.final_halfedge(h))));
            }
            for piece in coming.iter_mut() {
                *piece = pieces.final_face(*piece);
                faces.read(*piece);
                black_box((frames[piece.index()], spans.get(piece.index()).copied()));
            }
        };
        queue.pop_looking_ahead(read).map(|(_, h)| h)
    }

    /// Adds the patch that a half-edge leads into, unless the half-edge's piece has its place; whether it did.
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
    let torn = || Error::Layout("a piece of the refinement does not lie in its face".into());
    sides.iter().position(|&side| side == along).ok_or_else(torn)
}

/// The half-edge of a final face that a half-edge of a piece, through which a development goes on, runs along.
fn final_side(pieces: &Pieces, h: HalfedgeId) -> Result<HalfedgeId> {
    let inside =
        || Error::Layout(format!("edge {} lies inside a face of the metric's triangulation", h.edge()));
    pieces.final_halfedge(h).ok_or_else(inside)
}

/// The piece to begin with, and the number of the half-edge of its final face that is to lie along the x axis from the origin: one that
/// leaves the root, or of the smallest final face.
fn start<F: Frame>(pieces: &Pieces, faces: &Faces<F>, root: Option<VertexId>) -> Result<(FaceId, usize)> {
    let mesh = pieces.mesh();
    let Some(root) = root else {
        let sized = mesh.faces().map(|f| (f, faces.longest(pieces.final_face(f))));
        let smallest = sized.min_by(|(_, a), (_, b)| a.total_cmp(b)).map(|(f, _)| f);
        return Ok((smallest.ok_or_else(|| Error::Layout("the surface has no face".into()))?, 0));
    };
    check_vertex(faces.mesh, root)?;
    check_vertex(mesh, root)?;
    // Layouts of the final triangulation and of its refinement lie the same way where both begin with the first half-edge of the final
    // triangulation at the root. Where that belongs to no piece, on the other half of a double, any other does.
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
