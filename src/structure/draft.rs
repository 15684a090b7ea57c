//! A chart in the making: lifts of faces with their motions, and the vertices that they share.

use super::developable::{DevelopableSurface, straight_triangle};
use crate::control::Control;
use crate::error::Result;
use crate::geometry::triangle_flatness::{TriangleFlatness, largest_coordinate};
use crate::geometry::triangle_overlap::{TriangleCorners, overlapping};
use crate::geometry::vector::{cross, dot};
use crate::geometry::{DoubleDouble, Motion};
use crate::mesh::union_find::UnionFind;
use crate::mesh::{FaceId, VertexId};

/// The number of a face that a chart does not have.
pub(super) const NONE: u32 = u32::MAX;

/// Area of a triangle over the square of its longest side below which it is not tested for overlaps: rounding moves its corners by a good
/// part of its height.
const LOW: f64 = 1e-9;
/// Share by which triangles are shrunk about their middles before they are tested for overlaps. Those whose corners rounding may move by as
/// much are left out.
const ROUNDING: f64 = 1e-6;

/// The lifts of faces in a chart; each one but the first lies beside an earlier one.
#[derive(Default)]
pub(super) struct ChartDraft {
    pub faces: Vec<FaceId>,
    pub places: Vec<Motion<DoubleDouble>>,
    /// For each face and each of its half-edges the number of the face of the chart beyond it, or [`NONE`].
    pub neighbours: Vec<[u32; 3]>,
    /// The number of faces, first ones, that belong to the core of no other chart.
    pub n_core: usize,
    /// For each face the numbers of its corners' vertices in the chart.
    pub corners: Vec<[u32; 3]>,
    /// The vertices; `points` are their ambient coordinates.
    pub vertices: Vec<VertexId>,
    pub points: Vec<[f64; 3]>,
}

impl ChartDraft {
    pub fn push(&mut self, f: FaceId, place: Motion<DoubleDouble>) -> u32 {
        self.faces.push(f);
        self.places.push(place);
        self.neighbours.push([NONE; 3]);
        self.faces.len() as u32 - 1
    }

    /// Glues side `k` of one face to side `l` of another.
    pub fn join(&mut self, (i, k): (u32, usize), (j, l): (u32, usize)) {
        self.neighbours[i as usize][k] = j;
        self.neighbours[j as usize][l] = i;
    }

    /// Glues faces that lie beside each other, and numbers the vertices. Every face is there once, and already glued to the face from which
    /// it was reached.
    ///
    /// Two faces that share a regular vertex are glued across an edge at it, since the surface closes up around such a vertex. Around a
    /// singular vertex or a handle the chart stays open.
    pub fn close(&mut self, surface: &DevelopableSurface) {
        let mesh = surface.mesh();
        let mut same = self.joined_corners(surface);
        let mut number: Vec<(FaceId, u32)> = self.faces.iter().copied().zip(0..).collect();
        number.sort_unstable();
        let find = |f: FaceId| number.binary_search_by_key(&f, |x| x.0).ok().map(|k| number[k].1);
        let mut open: Vec<[(u32, usize); 2]> = Vec::new();
        for (i, &f) in self.faces.iter().enumerate() {
            for (k, h) in mesh.face_halfedges(f).into_iter().enumerate() {
                let beyond = mesh.corner(h.twin()).filter(|_| self.neighbours[i][k] == NONE);
                if let Some((j, l)) = beyond.and_then(|(g, l)| Some((find(g)?, l)))
                    && (i as u32, k) < (j, l)
                {
                    open.push([(i as u32, k), (j, l)]);
                }
            }
        }
        loop {
            let before = open.len();
            open.retain(|&[(i, k), (j, l)]| {
                let ends = [(k, (l + 1) % 3), ((k + 1) % 3, l)];
                let mut is_shared =
                    |&(p, q): &(usize, usize)| same.root(3 * i + p as u32) == same.root(3 * j + q as u32);
                let vertices = mesh.face_vertices(self.faces[i as usize]);
                let closes: Vec<bool> =
                    ends.iter().map(|end| is_shared(end) && !surface.singular[vertices[end.0]]).collect();
                if !closes.contains(&true) {
                    return true;
                }
                ends.iter().for_each(|&(p, q)| {
                    same.join(3 * i + p as u32, 3 * j + q as u32);
                });
                self.neighbours[i as usize][k] = j;
                self.neighbours[j as usize][l] = i;
                false
            });
            if open.len() == before {
                break;
            }
        }
        self.number_vertices(surface, same);
    }

    /// Numbers the vertices by the glued faces.
    pub fn finish(&mut self, surface: &DevelopableSurface) {
        let same = self.joined_corners(surface);
        self.number_vertices(surface, same);
    }

    /// The corners that are identified by gluing; corner k of face i has the number 3i + k.
    fn joined_corners(&self, surface: &DevelopableSurface) -> UnionFind {
        let mesh = surface.mesh();
        let mut same = UnionFind::new(3 * self.faces.len());
        for (i, &f) in self.faces.iter().enumerate() {
            for (k, h) in mesh.face_halfedges(f).into_iter().enumerate() {
                let j = self.neighbours[i][k];
                if let Some((_, l)) = mesh.corner(h.twin()).filter(|_| j != NONE) {
                    let number = |i: u32, k: usize| 3 * i + (k % 3) as u32;
                    same.join(number(i as u32, k), number(j, l + 1));
                    same.join(number(i as u32, k + 1), number(j, l));
                }
            }
        }
        same
    }

    fn number_vertices(&mut self, surface: &DevelopableSurface, mut same: UnionFind) {
        let mut number = vec![NONE; 3 * self.faces.len()];
        self.corners = vec![[NONE; 3]; self.faces.len()];
        (self.vertices, self.points) = (Vec::new(), Vec::new());
        for i in 0..self.faces.len() {
            let f = self.faces[i];
            let vertices = surface.mesh().face_vertices(f);
            let mut placed = None;
            for k in 0..3 {
                let root = same.root((3 * i + k) as u32) as usize;
                if number[root] == NONE {
                    number[root] = self.vertices.len() as u32;
                    self.vertices.push(vertices[k]);
                    let corners = placed.get_or_insert_with(|| surface.corners(f, &self.places[i]));
                    self.points.push(corners[k]);
                }
                self.corners[i][k] = number[root];
            }
        }
    }

    /// Rotates the chart about its origin.
    pub fn turn(&mut self, surface: &DevelopableSurface, by: &Motion<DoubleDouble>) {
        self.places.iter_mut().for_each(|place| *place = by.compose(place));
        let mut fresh = vec![true; self.vertices.len()];
        for i in 0..self.faces.len() {
            let corners = surface.corners(self.faces[i], &self.places[i]);
            for (k, &v) in self.corners[i].iter().enumerate() {
                if std::mem::replace(&mut fresh[v as usize], false) {
                    self.points[v as usize] = corners[k];
                }
            }
        }
    }

    /// The faces in coordinates in which geodesics are straight; none if one face has no such coordinates.
    pub fn triangles(&self, surface: &DevelopableSurface) -> Option<Vec<TriangleCorners>> {
        let triangle = |corners: &[u32; 3]| {
            straight_triangle(surface.faces.space, corners.map(|v| self.points[v as usize]))
        };
        self.corners.iter().map(triangle).collect()
    }

    /// True if all faces are counterclockwise, seen from outside the sphere.
    fn is_oriented(&self) -> bool {
        self.corners.iter().all(|corners| {
            let [p, q, r] = corners.map(|v| self.points[v as usize]);
            dot(p, cross(q, r)) >= 0.0
        })
    }

    /// True if the faces are counterclockwise and do not overlap, except for nearly degenerate faces ([`LOW`]) and for overlaps that
    /// rounding explains ([`ROUNDING`]).
    pub fn is_embedded(&self, surface: &DevelopableSurface, control: &Control) -> Result<bool> {
        control.check()?;
        // On a sphere, a closed fan of geodesic triangles about a common corner does not overlap either, whatever its size.
        let Some(mut triangles) = self.triangles(surface) else { return Ok(self.is_oriented()) };
        let size = largest_coordinate(triangles.as_flattened());
        if triangles.iter().any(|&t| TriangleFlatness::of(t).is_flipped(size)) {
            return Ok(false);
        }
        triangles.retain(|&t| {
            let flatness = TriangleFlatness::of(t);
            flatness.relative_area > LOW + f64::EPSILON * size / (ROUNDING * flatness.longest)
        });
        let triangles: Vec<TriangleCorners> = triangles.into_iter().map(shrunk).collect();
        Ok(overlapping(&triangles, control)?.is_empty())
    }
}

fn shrunk(triangle: TriangleCorners) -> TriangleCorners {
    let middle = [0, 1].map(|i| triangle.iter().map(|p| p[i]).sum::<f64>() / 3.0);
    triangle.map(|p| [0, 1].map(|i| p[i] + ROUNDING * (middle[i] - p[i])))
}
