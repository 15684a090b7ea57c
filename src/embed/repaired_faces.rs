//! The faces of the surface as it came, with its edges split, put together as a mesh.

use super::face_polygon::{BorderSpot, FacePolygon};
use super::input_splits::InputSplits;
use super::layout::{Layout, faces_where, is_left_turn};
use super::repaired_input::RepairedInput;
use crate::control::Control;
use crate::error::Result;
use crate::mesh::{EdgeId, FaceId, HalfedgeId, Mesh, PerEdge, PerHalfedge};
use crate::metric::CommonSubdivision;
use crate::metric::common_subdivision::{CORNERS, Unpacked};
use std::collections::HashMap;
use std::sync::Arc;

/// Marks a half-edge or point that has no number yet.
const NONE: u32 = u32::MAX;

impl Layout {
    /// The layout on the surface as it came ([`Layout::on_input`]), with edges split where faces fold; `None` where the cut does not run
    /// along the input's edges.
    ///
    /// Every split can be undone by none of the others. Faces that are [`RepairedInput::flipped`] are left only where rounding has turned
    /// over pieces of the layout itself, or no edge was flipped and the layout of the input has such faces.
    ///
    /// # Errors
    /// [`crate::Error::Cancelled`]; [`crate::Error::Layout`] for a subdivision that is not one of the input.
    pub fn repaired_input(&self, control: &Control) -> Result<Option<RepairedInput>> {
        let (Some((input, _)), Some(on_input)) = (&self.input, self.on_input()) else { return Ok(None) };
        let splits = InputSplits::fewest(self, input, &on_input, control)?;
        RepairedFaces::of(&splits).finish(self).map(Some)
    }
}

/// The triangles of the faces, with new numbers of half-edges and vertices.
pub(super) struct RepairedFaces<'a> {
    splits: &'a InputSplits<'a>,
    /// Per edge of the input, the number of its first part; then the number of all parts.
    first: Vec<usize>,
    /// Per half-edge, its origin.
    origin: Vec<u32>,
    /// Per half-edge, the number of the point of the layout at its origin in its face.
    corner: Vec<u32>,
    sides: Vec<[u32; 3]>,
    /// Per triangle, its face of the input and the weights of its corners there.
    source: Vec<(FaceId, [[f64; 3]; 3])>,
}

impl<'a> RepairedFaces<'a> {
    pub fn of(splits: &'a InputSplits<'a>) -> RepairedFaces<'a> {
        let input = splits.input;
        let mut first = Vec::with_capacity(input.n_edges() + 1);
        first.push(0);
        splits.taken.iter().enumerate().for_each(|(e, taken)| first.push(first[e] + taken.len() + 1));
        let n = 2 * first[input.n_edges()];
        let (origin, corner) = (vec![NONE; n], vec![NONE; n]);
        let mut faces =
            RepairedFaces { splits, first, origin, corner, sides: Vec::new(), source: Vec::new() };
        for e in input.edges() {
            let [from, to] = input.ends(e);
            let (first, parts) = (faces.first[e.index()], splits.taken[e.index()].len() + 1);
            for k in 0..parts {
                faces.origin[2 * (first + k)] = if k == 0 { from.0 } else { faces.added(e, k - 1) };
                faces.origin[2 * (first + k) + 1] = if k + 1 == parts { to.0 } else { faces.added(e, k) };
            }
        }
        input.faces().for_each(|f| faces.add(f));
        faces
    }

    /// The number of the vertex at an edge's split number k.
    fn added(&self, e: EdgeId, k: usize) -> u32 {
        (self.splits.input.n_vertices() + self.first[e.index()] - e.index() + k) as u32
    }

    /// Part number k of a half-edge of the input, counted in its direction.
    fn part(&self, h: HalfedgeId, k: usize) -> u32 {
        let (first, parts) = (self.first[h.edge().index()], self.splits.taken[h.edge().index()].len() + 1);
        if h.0 & 1 == 0 { 2 * (first + k) as u32 } else { 2 * (first + parts - 1 - k) as u32 + 1 }
    }

    /// Adds the triangles of a face.
    fn add(&mut self, f: FaceId) {
        let (polygon, found) = self.splits.triangulation(f);
        let border = self.splits.input.face_halfedges(f);
        let n = polygon.points.len();
        let mut inside: HashMap<[usize; 2], u32> = HashMap::new();
        for triangle in found.triangles {
            let sides = [0, 1, 2].map(|k| {
                let (a, b) = (triangle[k], triangle[(k + 1) % 3]);
                if b == (a + 1) % n {
                    let side = (0..3).rfind(|&k| polygon.start[k] <= a).unwrap_or(0);
                    return self.part(border[side], a - polygon.start[side]);
                }
                let ends = [a.min(b), a.max(b)];
                let edge = *inside.entry(ends).or_insert_with(|| {
                    self.origin.extend(ends.map(|i| self.vertex(f, &polygon, i)));
                    self.corner.extend([NONE; 2]);
                    self.origin.len() as u32 / 2 - 1
                });
                2 * edge + u32::from(a > b)
            });
            for k in 0..3 {
                self.corner[sides[k] as usize] = polygon.points[triangle[k]].corner;
            }
            self.sides.push(sides);
            self.source.push((f, triangle.map(|i| polygon.points[i].weights)));
        }
    }

    /// The vertex at a point of the border of a face.
    fn vertex(&self, f: FaceId, polygon: &FacePolygon, i: usize) -> u32 {
        match polygon.points[i].spot {
            BorderSpot::Corner(k) => self.splits.input.face_vertices(f)[k].0,
            BorderSpot::Crossing(e, crossing) => {
                self.added(e, self.splits.taken[e.index()].partition_point(|&c| c < crossing))
            }
        }
    }

    pub fn finish(self, layout: &Layout) -> Result<RepairedInput> {
        let input = self.splits.input;
        let split_edges: Vec<EdgeId> =
            input.edges().filter(|e| !self.splits.taken[e.index()].is_empty()).collect();
        let n_parts = self.first[input.n_edges()];
        let n_vertices = input.n_vertices() + n_parts - input.n_edges();
        let mut along: Vec<[Option<HalfedgeId>; 2]> = Vec::with_capacity(self.origin.len() / 2);
        for e in input.edges() {
            along.resize(self.first[e.index() + 1], [Some(e.halfedge()), None]);
        }
        along.resize(self.origin.len() / 2, [None; 2]);
        along.iter_mut().enumerate().for_each(|(e, along)| along[1] = Some(EdgeId::from(e).halfedge()));
        let mesh = Mesh::assemble(n_vertices, self.origin, &self.sides)?;
        let (corner_index, points) = numbered(&mesh, &self.corner);
        let coordinates: Vec<_> = points.iter().map(|&k| layout.coordinates[k as usize]).collect();
        let place = |h: HalfedgeId| coordinates[corner_index[h] as usize];
        let flipped = faces_where(&mesh, |f| !is_left_turn(mesh.face_halfedges(f).map(place)));
        let n = mesh.n_faces();
        let own = mesh.clone();
        let parts = Unpacked {
            n_vertices: [input.n_vertices(), n_vertices],
            crossings: Vec::new(),
            weight: vec![1.0; n_vertices].into(),
            polygon_of: (0..n as u32).collect::<Vec<_>>().into(),
            faces: [
                self.source.iter().map(|s| s.0).collect::<Vec<_>>().into(),
                mesh.faces().collect::<Vec<_>>().into(),
            ],
            halfedges_along: PerEdge::from(along),
            barycentric: [self.source.iter().map(|s| s.1).collect(), vec![CORNERS; n]],
            mesh,
        };
        let refinement = Arc::new(CommonSubdivision::from_barycentric(parts, [input, &own]));
        Ok(RepairedInput { refinement, split_edges, corner_index, points, coordinates, flipped })
    }
}

/// The points at the corners of a mesh, numbered in the order of its half-edges, and per half-edge the number of its own; outside the
/// surface that in the face across the edge.
fn numbered(mesh: &Mesh, corner: &[u32]) -> (PerHalfedge<u32>, Vec<u32>) {
    let (mut number, mut points) = (HashMap::new(), Vec::new());
    let index = PerHalfedge::from_fn(mesh.n_halfedges(), |h| {
        let at = if mesh.is_outside(h) { mesh.next(h.twin()) } else { h };
        let point = corner[at.index()];
        *number.entry(point).or_insert_with(|| {
            points.push(point);
            points.len() as u32 - 1
        })
    });
    (index, points)
}
