//! The common subdivision with some of its edges split: every triangle beside them is cut, and the map between the two triangulations stays
//! the same.

use super::assemble::Unpacked;
use super::data::CommonSubdivision;
use crate::error::{Result, check_size};
use crate::mesh::{EdgeId, FaceId, HalfedgeId, Mesh, PerEdge};

/// The triangles into which a triangle is cut, by the numbers of the points on its border, which are counted from the start of
/// [`first_side`].
const ONE_SPLIT: [[usize; 3]; 2] = [[0, 1, 3], [1, 2, 3]];
const TWO_SPLIT: [[usize; 3]; 3] = [[1, 2, 3], [0, 1, 4], [1, 3, 4]];
const THREE_SPLIT: [[usize; 3]; 4] = [[1, 2, 3], [3, 4, 5], [5, 0, 1], [1, 3, 5]];

impl CommonSubdivision {
    /// This subdivision with edges split. The new vertices come last, in the order of the edges. `shares`: per edge that is split, the weight
    /// of the end of its half-edge 2e at the new vertex, in faces of the second triangulation, between 0 and 1; `meshes`: the two
    /// triangulations.
    ///
    /// # Errors
    /// [`crate::Error::Size`].
    pub(crate) fn with_edges_split(
        &self,
        shares: &PerEdge<Option<f64>>,
        meshes: [&Mesh; 2],
    ) -> Result<CommonSubdivision> {
        check_size("shares of edges", shares.len(), self.mesh.n_edges())?;
        let mut pieces = SplitPieces::new(self, shares);
        self.mesh.faces().for_each(|f| pieces.add(f));
        pieces.finish(meshes)
    }

    /// The weights of the ends of a half-edge at the point that splits it, in faces of the first triangulation and of the second, and the
    /// homogeneous weight of that point. `share`: as in [`CommonSubdivision::with_edges_split`].
    fn weights_of_split(&self, h: HalfedgeId, share: f64) -> ([[f64; 2]; 2], f64) {
        // In the first triangulation weights times the homogeneous weights q of the ends are those in the second, up to a factor.
        let [from, to] = self.mesh.ends(h.edge()).map(|v| self.weight[v]);
        let (a, b) = ((1.0 - share) / from, share / to);
        let weights = [[a / (a + b), b / (a + b)], [1.0 - share, share]];
        let along = if h.0 & 1 == 0 { weights } else { weights.map(|[a, b]| [b, a]) };
        (along, 1.0 / (a + b))
    }
}

/// A point on the border of a triangle: its vertex, and its weights in the triangle's face of each triangulation.
#[derive(Clone, Copy)]
struct BorderVertex {
    vertex: u32,
    weights: [[f64; 3]; 2],
}

/// The triangles of a subdivision with edges split, with new numbers of vertices and half-edges.
struct SplitPieces<'a> {
    whole: &'a CommonSubdivision,
    shares: &'a PerEdge<Option<f64>>,
    /// Per edge of the whole, the number of its first part.
    first: Vec<u32>,
    n_vertices: usize,
    origin: Vec<u32>,
    along: Vec<[Option<HalfedgeId>; 2]>,
    sides: Vec<[u32; 3]>,
    /// Per triangle, the one that it is a part of.
    whole_of: Vec<FaceId>,
    barycentric: [Vec<[[f64; 3]; 3]>; 2],
}

impl<'a> SplitPieces<'a> {
    fn new(whole: &'a CommonSubdivision, shares: &'a PerEdge<Option<f64>>) -> SplitPieces<'a> {
        let mesh = &whole.mesh;
        let mut pieces = SplitPieces {
            whole,
            shares,
            first: Vec::with_capacity(mesh.n_edges()),
            n_vertices: mesh.n_vertices(),
            origin: Vec::new(),
            along: Vec::new(),
            sides: Vec::new(),
            whole_of: Vec::new(),
            barycentric: [Vec::new(), Vec::new()],
        };
        for e in mesh.edges() {
            pieces.first.push(pieces.along.len() as u32);
            let [from, to] = mesh.ends(e).map(|v| v.0);
            let mut at = from;
            if shares[e].is_some() {
                let added = pieces.n_vertices as u32;
                pieces.n_vertices += 1;
                pieces.push_edge([at, added], whole.halfedges_along[e]);
                at = added;
            }
            pieces.push_edge([at, to], whole.halfedges_along[e]);
        }
        pieces
    }

    fn push_edge(&mut self, ends: [u32; 2], along: [Option<HalfedgeId>; 2]) {
        self.origin.extend(ends);
        self.along.push(along);
    }

    /// The parts of a half-edge, in its direction.
    fn parts(&self, h: HalfedgeId) -> [Option<u32>; 2] {
        let (e, first, back) = (h.edge(), 2 * self.first[h.edge().index()], h.0 & 1);
        match (self.shares[e].is_some(), back) {
            (false, back) => [Some(first + back), None],
            (true, 0) => [Some(first), Some(first + 2)],
            (true, _) => [Some(first + 3), Some(first + 1)],
        }
    }

    /// The point that splits side k of a triangle, if it is split.
    fn split(&self, f: FaceId, k: usize, corners: &[BorderVertex; 3]) -> Option<BorderVertex> {
        let h = self.whole.mesh.face_halfedges(f)[k];
        let (weights, _) = self.whole.weights_of_split(h, self.shares[h.edge()]?);
        let [a, b] = [corners[k], corners[(k + 1) % 3]];
        let of_side = |side: usize| {
            let ([s, t], u, v) = (weights[side], a.weights[side], b.weights[side]);
            [0, 1, 2].map(|i| s * u[i] + t * v[i])
        };
        let first = 2 * self.first[h.edge().index()] as usize;
        Some(BorderVertex { vertex: self.origin[first + 1], weights: [of_side(0), of_side(1)] })
    }

    /// Adds the parts of a triangle.
    fn add(&mut self, f: FaceId) {
        let (mesh, whole) = (&self.whole.mesh, self.whole);
        let halfedges = mesh.face_halfedges(f);
        let weights = [0, 1].map(|side| whole.barycentric(side, f));
        let corners = [0, 1, 2].map(|k| BorderVertex {
            vertex: mesh.origin(halfedges[k]).0,
            weights: [weights[0][k], weights[1][k]],
        });
        let (start, triangles) = cut(halfedges.map(|h| self.shares[h.edge()].is_some()));
        let (mut points, mut border) = (Vec::with_capacity(6), Vec::with_capacity(6));
        for k in [start, (start + 1) % 3, (start + 2) % 3] {
            points.push(corners[k]);
            points.extend(self.split(f, k, &corners));
            border.extend(self.parts(halfedges[k]).into_iter().flatten());
        }
        let mut inside: Vec<([usize; 2], u32)> = Vec::new();
        for triangle in triangles {
            let sides = [0, 1, 2].map(|k| {
                let (a, b) = (triangle[k], triangle[(k + 1) % 3]);
                if b == (a + 1) % points.len() {
                    return border[a];
                }
                let ends = [a.min(b), a.max(b)];
                let known = inside.iter().find(|(known, _)| *known == ends).map(|(_, edge)| *edge);
                let edge = known.unwrap_or_else(|| {
                    let edge = self.along.len() as u32;
                    self.push_edge(ends.map(|i| points[i].vertex), [None; 2]);
                    inside.push((ends, edge));
                    edge
                });
                2 * edge + u32::from(a > b)
            });
            self.sides.push(sides);
            self.whole_of.push(f);
            for side in 0..2 {
                self.barycentric[side].push(triangle.map(|i| points[i].weights[side]));
            }
        }
    }

    fn finish(self, meshes: [&Mesh; 2]) -> Result<CommonSubdivision> {
        let whole = self.whole;
        let mut weight = whole.weight.to_vec();
        let of_split = |e: EdgeId| Some(whole.weights_of_split(e.halfedge(), self.shares[e]?).1);
        weight.extend(whole.mesh.edges().filter_map(of_split));
        let of = |values: &dyn Fn(FaceId) -> FaceId| -> Vec<FaceId> {
            self.whole_of.iter().map(|&f| values(f)).collect()
        };
        let faces = [of(&|f| whole.faces[0][f]).into(), of(&|f| whole.faces[1][f]).into()];
        let polygon_of: Vec<u32> = self.whole_of.iter().map(|&f| whole.polygon_of[f]).collect();
        let parts = Unpacked {
            mesh: Mesh::assemble(self.n_vertices, self.origin, &self.sides)?,
            n_vertices: whole.n_vertices,
            crossings: whole.crossings.clone(),
            weight: weight.into(),
            polygon_of: polygon_of.into(),
            faces,
            halfedges_along: self.along.into(),
            barycentric: self.barycentric,
        };
        Ok(CommonSubdivision::from_barycentric(parts, meshes))
    }
}

/// The side from whose start the border of a triangle with these sides split is counted, and the triangles into which it is cut.
fn cut(is_split: [bool; 3]) -> (usize, &'static [[usize; 3]]) {
    let side = |wanted: bool| is_split.iter().position(|&split| split == wanted).unwrap_or(0);
    match is_split.iter().filter(|&&split| split).count() {
        0 => (0, &[[0, 1, 2]]),
        1 => (side(true), &ONE_SPLIT),
        2 => ((side(false) + 1) % 3, &TWO_SPLIT),
        _ => (0, &THREE_SPLIT),
    }
}
