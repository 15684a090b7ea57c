//! The pieces into which the input's edges cut the final triangles, as a triangulated surface.
//!
//! ```text
//!            2                 The curves through a final triangle are edges of the input. They cut off corners, and some may end
//!           / \                in one corner (a fan). The numbers of both give the pieces: at each corner a triangle and then strips
//!          /———\               between its curves; triangles between the curves of a fan; and one last piece with up to six corners.
//!         /   / \              A corner of a piece is a vertex or a crossing, a side is part of a final edge or of an edge of the
//!        /\  /  /\             input. Each corner knows its half-edge in the face of the input and in the final triangle.
//!       0——\———/——1
//! ```

use super::data::torn;
use super::triangulations::FinalTriangulation;
use crate::control::{Control, Stage};
use crate::error::Result;
use crate::mesh::normal::Strands;
use crate::mesh::{Curves, EdgeId, FaceId, HalfedgeId, Mesh};

/// Marks a slot whose crossing is not known yet.
const NONE: u32 = u32::MAX;
/// Faces that are cut between two looks at the control: less than a millisecond.
const FACES_PER_STEP: usize = 1024;

/// Most corners of a piece.
const MOST_CORNERS: usize = 6;

/// The place of a corner of a piece in its final triangle.
#[derive(Debug, Clone, Copy)]
enum CornerSpot {
    /// At corner k, after this many curves of its fan.
    Corner(usize, i64),
    /// The crossing at this position along side k → k + 1.
    Side(usize, i64),
}

/// The side of a piece that follows a corner, counterclockwise.
#[derive(Debug, Clone, Copy)]
enum PieceSide {
    /// Part number `.1` of side `.0` → `.0` + 1.
    Side(usize, i64),
    /// Part of a curve.
    Curve,
}

/// A corner of a triangle of the output: vertex, and the half-edges of the input's and the final face at which (vertex) or on
/// which (crossing) it lies.
#[derive(Debug, Clone, Copy)]
pub(super) struct SubdivisionCorner {
    pub vertex: u32,
    pub input: HalfedgeId,
    pub result: HalfedgeId,
}

/// Two triangulations of a surface, one drawn on the other.
#[derive(Clone, Copy)]
pub(super) struct DrawnCurves<'a> {
    pub input: &'a Mesh,
    pub result: &'a FinalTriangulation<'a>,
    /// The input's edges on the final triangulation.
    pub curves: &'a Curves,
    /// Per crossing, whether it is off the class's straight line, so that the map of a piece at it is projective in each triangle
    /// only; empty where no crossing is.
    pub moved: &'a [bool],
}

/// The pieces as triangles. The numbers of vertices and half-edges have gaps, where faces are not kept.
pub(super) struct PieceTriangles<'a> {
    pub drawn: DrawnCurves<'a>,
    /// Per final edge, its first entry in `slots`, which holds the crossings of each edge in order along half-edge 2e.
    slot_start: Vec<u32>,
    slots: Vec<u32>,
    /// Per crossing: the edge of the input.
    crossed_by: Vec<u32>,
    /// Per final edge, the number of its first part; per edge of the input that crosses any, the same.
    parts: Vec<u32>,
    curve_parts: Vec<u32>,
    /// Per edge of the output, the half-edges of the input and of the final triangulation that its half-edge 2e runs along.
    pub halfedges_along: Vec<[Option<HalfedgeId>; 2]>,
    /// Per triangle: its half-edges, corners, the piece it belongs to.
    pub sides: Vec<[u32; 3]>,
    pub corners: Vec<[SubdivisionCorner; 3]>,
    pub polygon_of: Vec<u32>,
    n_pieces: u32,
}

impl<'a> PieceTriangles<'a> {
    /// Cut all final triangles, O(output); keep the pieces of those faces of the input that `keep` names. A piece with a crossing that
    /// was moved is taken apart into its triangles.
    pub fn cut(
        drawn: DrawnCurves<'a>,
        keep: &dyn Fn(FaceId) -> bool,
        control: &Control,
    ) -> Result<PieceTriangles<'a>> {
        let DrawnCurves { input, result, curves, .. } = drawn;
        let mesh = result.mesh;
        let n = |e: EdgeId| result.normal.crossings(e).max(0) as u32;
        let mut pieces = PieceTriangles {
            drawn,
            slot_start: running_sum(mesh.edges().map(n)),
            slots: vec![NONE; curves.n_crossings()],
            crossed_by: vec![0; curves.n_crossings()],
            parts: running_sum(mesh.edges().map(|e| n(e) + 1)),
            curve_parts: Vec::new(),
            halfedges_along: Vec::new(),
            sides: Vec::new(),
            corners: Vec::new(),
            polygon_of: Vec::new(),
            n_pieces: 0,
        };
        pieces.reserve(mesh);
        for e in mesh.edges() {
            let along = result.normal.along(mesh, e.halfedge());
            pieces.halfedges_along.extend((0..=n(e)).map(|_| [along, Some(e.halfedge())]));
        }
        let first = pieces.halfedges_along.len() as u32;
        let parts = |e| match curves.crossings(e).len() as u32 {
            0 => 0,
            m => m + 1,
        };
        pieces.curve_parts = running_sum(input.edges().map(parts)).into_iter().map(|k| first + k).collect();
        for e in input.edges() {
            pieces.halfedges_along.extend((0..parts(e)).map(|_| [Some(e.halfedge()), None]));
            for (c, crossing) in curves.numbers(e).zip(curves.crossings(e)) {
                let slot = pieces.slot(crossing.halfedge, i64::from(crossing.position));
                pieces.slots[slot] = c as u32;
                pieces.crossed_by[c] = e.0;
            }
        }
        for f in mesh.faces() {
            if f.index().is_multiple_of(FACES_PER_STEP) {
                control.step(Stage::Layout, f.index() as f64 / mesh.n_faces() as f64)?;
            }
            pieces.cut_face(f, keep)?;
        }
        Ok(pieces)
    }

    /// Make room for the pieces of all faces: each crossing adds three edges and two triangles to those of the final triangulation.
    fn reserve(&mut self, mesh: &Mesh) {
        let n = self.slots.len();
        self.halfedges_along.reserve_exact(mesh.n_edges() + 3 * n);
        let triangles = mesh.n_faces() + 2 * n;
        self.sides.reserve_exact(triangles);
        self.corners.reserve_exact(triangles);
        self.polygon_of.reserve_exact(triangles);
    }

    fn slot(&self, side: HalfedgeId, position: i64) -> usize {
        let e = side.edge();
        let n = self.drawn.result.normal.crossings(e);
        let along = if side.0 & 1 == 0 { position } else { n - 1 - position };
        self.slot_start[e.index()] as usize + along as usize
    }

    fn cut_face(&mut self, f: FaceId, keep: &dyn Fn(FaceId) -> bool) -> Result<()> {
        let h = self.drawn.result.mesh.face_halfedges(f);
        let n = h.map(|h| self.drawn.result.normal.crossings(h.edge()).max(0));
        if n == [0; 3] {
            return self.emit_whole(h, keep);
        }
        let Strands { arc, fan } = Strands::new(n);
        let next = |k: usize| (k + 1) % 3;
        let mut polygon: Vec<(CornerSpot, PieceSide)> = Vec::with_capacity(MOST_CORNERS);
        for k in 0..3 {
            let before = (k + 2) % 3;
            for m in 0..arc[k] {
                polygon.clear();
                let (out, back) = (CornerSpot::Side(k, m), CornerSpot::Side(before, n[before] - 1 - m));
                if m == 0 {
                    polygon.push((CornerSpot::Corner(k, 0), PieceSide::Side(k, 0)));
                } else {
                    polygon.push((CornerSpot::Side(k, m - 1), PieceSide::Side(k, m)));
                }
                polygon.push((out, PieceSide::Curve));
                polygon.push((back, PieceSide::Side(before, n[before] - m)));
                if m > 0 {
                    polygon.push((CornerSpot::Side(before, n[before] - m), PieceSide::Curve));
                }
                self.emit(h, &polygon, keep)?;
            }
        }
        // The last piece runs around the outermost curve at each corner.
        let around = |polygon: &mut Vec<(CornerSpot, PieceSide)>, k: usize| {
            let before = (k + 2) % 3;
            if arc[k] == 0 {
                polygon.push((CornerSpot::Corner(k, 0), PieceSide::Side(k, 0)));
            } else {
                polygon.push((CornerSpot::Side(before, n[before] - arc[k]), PieceSide::Curve));
                polygon.push((CornerSpot::Side(k, arc[k] - 1), PieceSide::Side(k, arc[k])));
            }
        };
        polygon.clear();
        let Some(k) = (0..3).find(|&k| fan[k] > 0) else {
            (0..3).for_each(|k| around(&mut polygon, k));
            return self.emit(h, &polygon, keep);
        };
        // The curves of the fan of corner k cross the opposite side, `far`, behind the `skip` curves that cut off its first corner.
        let (far, skip) = (next(k), arc[next(k)]);
        polygon.push((CornerSpot::Corner(k, 0), PieceSide::Side(k, 0)));
        around(&mut polygon, far);
        for m in 0..fan[k] {
            let at = skip + m;
            polygon.push((CornerSpot::Side(far, at), PieceSide::Curve));
            self.emit(h, &polygon, keep)?;
            polygon.clear();
            polygon.push((CornerSpot::Corner(k, m + 1), PieceSide::Curve));
            polygon.push((CornerSpot::Side(far, at), PieceSide::Side(far, at + 1)));
        }
        around(&mut polygon, next(far));
        self.emit(h, &polygon, keep)
    }

    /// A final face that no curve crosses, which is a face of the input: what [`PieceTriangles::emit`] makes of it.
    fn emit_whole(&mut self, h: [HalfedgeId; 3], keep: &dyn Fn(FaceId) -> bool) -> Result<()> {
        let mut corners = [SubdivisionCorner { vertex: 0, input: h[0], result: h[0] }; 3];
        for (k, corner) in corners.iter_mut().enumerate() {
            *corner = self.piece_corner(h, CornerSpot::Corner(k, 0), None)?;
        }
        let [a, b, c] = corners.map(|corner| self.drawn.input.face(corner.input));
        if a.is_none() || a != b || b != c {
            return Err(torn());
        }
        if a.is_some_and(keep) {
            let sides = [0, 1, 2].map(|k| self.side_part(h[k], 0));
            self.triangulate(&sides, &corners);
        }
        Ok(())
    }

    /// Triangulate one piece, if it lies in a face of the input that is kept.
    fn emit(
        &mut self,
        h: [HalfedgeId; 3],
        polygon: &[(CornerSpot, PieceSide)],
        keep: &dyn Fn(FaceId) -> bool,
    ) -> Result<()> {
        let size = polygon.len();
        let mut sides = [NONE; MOST_CORNERS];
        // The half-edge of the input that a curve is part of, per side of the piece.
        let mut curves = [None; MOST_CORNERS];
        for (i, &(spot, way)) in polygon.iter().enumerate() {
            (sides[i], curves[i]) = match way {
                PieceSide::Side(k, part) => (self.side_part(h[k], part), None),
                PieceSide::Curve => {
                    let (side, along) = self.curve_part(h, spot, polygon[(i + 1) % size].0)?;
                    (side, Some(along))
                }
            };
        }
        let mut face = None;
        let mut corners = [SubdivisionCorner { vertex: NONE, input: h[0], result: h[0] }; MOST_CORNERS];
        for (i, &(spot, _)) in polygon.iter().enumerate() {
            let corner = self.piece_corner(h, spot, curves[i].or(curves[(i + size - 1) % size]))?;
            let lies_in = self.drawn.input.face(corner.input).ok_or_else(torn)?;
            if *face.get_or_insert(lies_in) != lies_in {
                return Err(torn());
            }
            corners[i] = corner;
        }
        if face.is_some_and(keep) {
            self.triangulate(&sides[..size], &corners[..size]);
        }
        Ok(())
    }

    /// A corner of a piece; `curve` is the half-edge of the input that a side of the piece at it is part of.
    fn piece_corner(
        &self,
        h: [HalfedgeId; 3],
        spot: CornerSpot,
        curve: Option<HalfedgeId>,
    ) -> Result<SubdivisionCorner> {
        let FinalTriangulation { mesh, normal, .. } = self.drawn.result;
        match spot {
            CornerSpot::Corner(k, turn) => {
                let coincident = i64::from(normal.crossings(h[k].edge()) < 0);
                let input = normal.leaving(mesh, h[k], coincident + turn - 1);
                Ok(SubdivisionCorner { vertex: mesh.origin(h[k]).0, input, result: h[k] })
            }
            CornerSpot::Side(k, at) => {
                let vertex = mesh.n_vertices() as u32 + self.slots[self.slot(h[k], at)];
                Ok(SubdivisionCorner { vertex, input: curve.ok_or_else(torn)?, result: h[k] })
            }
        }
    }

    /// Append the triangles of a piece with these corners and sides (side i follows corner i): they lie around corner 0, with new edges
    /// between them.
    fn triangulate(&mut self, sides: &[u32], corners: &[SubdivisionCorner]) {
        let (size, n) = (sides.len(), self.drawn.result.mesh.n_vertices());
        // Numbers of crossings follow those of the vertices.
        let crossing = |c: &SubdivisionCorner| (c.vertex as usize).checked_sub(n);
        let is_moved = |c: &SubdivisionCorner| {
            crossing(c).and_then(|c| self.drawn.moved.get(c)).is_some_and(|&moved| moved)
        };
        let apart = corners.iter().any(is_moved);
        let mut left = sides[0];
        for i in 1..size - 1 {
            let closing = if i + 2 == size {
                sides[size - 1]
            } else {
                self.halfedges_along.push([None; 2]);
                2 * (self.halfedges_along.len() as u32 - 1)
            };
            self.sides.push([left, sides[i], closing]);
            self.corners.push([corners[0], corners[i], corners[i + 1]]);
            self.polygon_of.push(self.n_pieces);
            left = closing ^ 1;
            self.n_pieces += u32::from(apart || i + 2 == size);
        }
    }

    /// The half-edge of a part of a final half-edge.
    fn side_part(&self, side: HalfedgeId, part: i64) -> u32 {
        let e = side.edge();
        let [begin, end] = [0, 1].map(|k| self.parts[e.index() + k]);
        let (part, odd) = (part as u32, side.0 & 1);
        2 * if odd == 0 { begin + part } else { end - 1 - part } + odd
    }

    /// The half-edge of the part of a curve that runs from one spot to the next, and the half-edge of the input it is part of.
    fn curve_part(&self, h: [HalfedgeId; 3], from: CornerSpot, to: CornerSpot) -> Result<(u32, HalfedgeId)> {
        // A crossing at one end, and whether that is the start.
        let (k, at, starts) = match (from, to) {
            (CornerSpot::Side(k, at), _) => (k, at, true),
            (_, CornerSpot::Side(k, at)) => (k, at, false),
            _ => return Err(torn()),
        };
        let c = self.slots[self.slot(h[k], at)] as usize;
        let e = EdgeId(self.crossed_by[c]);
        let number = c - self.drawn.curves.numbers(e).start;
        let leaves_face = self.drawn.curves.crossings(e)[number].halfedge == h[k];
        let part = number as u32 + u32::from(!leaves_face);
        // The piece's side runs against the curve if it starts where the curve leaves the face, or ends where the curve enters it.
        let odd = u32::from(leaves_face == starts);
        Ok((2 * (self.curve_parts[e.index()] + part) + odd, HalfedgeId(e.halfedge().0 + odd)))
    }
}

fn running_sum(counts: impl Iterator<Item = u32>) -> Vec<u32> {
    let mut sum = 0;
    let sums = counts.map(|n| {
        sum += n;
        sum
    });
    std::iter::once(0).chain(sums.collect::<Vec<_>>()).collect()
}
