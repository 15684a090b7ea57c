//! Developing a common refinement into the plane: pieces lie where their final faces do.

use super::develop::{centre_to_side, times, unit};
use super::triangle::Triangle;
use crate::control::{Control, Stage};
use crate::error::{Error, Result};
use crate::geometry::Space;
use crate::mesh::{FaceId, HalfedgeId, Mesh, PerEdge, PerFace, PerHalfedge};
use crate::metric::{Metric, Refinement};
use crate::topology::spanning::Key;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// "No patch yet".
const NONE: u32 = u32::MAX;
/// Patches between two looks at the control.
const PATCHES_PER_STEP: usize = 1024;

/// The final triangles as they are, each by itself.
pub(super) struct Faces<'a> {
    pub mesh: &'a Mesh,
    pub lengths: PerEdge<f64>,
    pub triangles: PerFace<Triangle>,
}

impl<'a> Faces<'a> {
    /// Of a metric in E². Errors: [`Error::Layout`] elsewhere; those of [`Metric::lengths`].
    pub fn new(mesh: &'a Mesh, metric: &Metric) -> Result<Faces<'a>> {
        if metric.space != Space::E2 {
            return Err(Error::Layout(format!("a metric in {} has no layout in the plane", metric.space)));
        }
        let differences = metric.differences(mesh)?;
        let triangles = PerFace::from_fn(mesh.n_faces(), |f| Triangle::from_differences(differences[f]));
        Ok(Faces { mesh, lengths: metric.lengths(mesh)?, triangles })
    }

    /// Lengths of the sides k → k + 1 of a face.
    fn sides(&self, f: FaceId) -> [f64; 3] {
        self.mesh.face_halfedges(f).map(|h| self.lengths[h.edge()])
    }

    /// The longest side of a face.
    pub fn longest(&self, f: FaceId) -> f64 {
        self.sides(f).into_iter().fold(0.0, f64::max)
    }

    /// The lengths of the refinement's edges.
    pub fn refined_lengths(&self, r: &Refinement) -> PerEdge<f64> {
        let mut lengths = PerEdge::filled(r.mesh.n_edges(), 0.0);
        for f in r.mesh.faces() {
            let frame = self.frame(r.final_face[f], [1.0, 0.0]);
            let b = r.final_barycentric(f);
            for (k, h) in r.mesh.face_halfedges(f).into_iter().enumerate() {
                let [x, y] = between(frame, b[k], b[(k + 1) % 3]);
                lengths[h.edge()] = x.hypot(y);
            }
        }
        lengths
    }

    /// Vectors from corner 0 of a face to its corners 1 and 2, with side 0 → 1 in this direction.
    fn frame(&self, f: FaceId, along: [f64; 2]) -> [[f64; 2]; 2] {
        let [first, _, last] = self.sides(f);
        let way = times(along, self.triangles[f].direction[0]);
        [along.map(|x| first * x), way.map(|x| last * x)]
    }
}

/// A connected part of a final face, between cuts, in the plane.
struct Patch {
    face: FaceId,
    /// Position of the face's corners.
    corners: [[f64; 2]; 3],
    /// Unit directions of the face's sides k → k + 1.
    directions: [[f64; 2]; 3],
    /// Vectors from corner 0 to corners 1 and 2, by their directions.
    frame: [[f64; 2]; 2],
}

/// Where everything lies.
pub(super) struct Placed {
    /// Position per number of a corner.
    pub coordinates: Vec<[f64; 2]>,
    /// Vector per half-edge as its own piece has it; zero outside.
    pub vectors: PerHalfedge<[f64; 2]>,
}

/// Place the final faces of all pieces, from the smallest one outward, as [`super::develop::develop`] does: across a final edge
/// that is not cut the face there is unfolded, whole; pieces of one face with no cut between them lie in it.
///
/// Accuracy so comes from whole faces: tiny pieces lie in them, nothing is laid out from them.
pub(super) fn place(
    r: &Refinement,
    faces: &Faces,
    is_cut: &PerEdge<bool>,
    corner: &PerHalfedge<u32>,
    n_corners: usize,
    control: &Control,
) -> Result<Placed> {
    let mesh = &r.mesh;
    let size = |&f: &FaceId| faces.longest(r.final_face[f]);
    let Some(first) = mesh.faces().min_by(|f, g| size(f).total_cmp(&size(g))) else {
        return Err(Error::Layout("the surface has no face".into()));
    };
    let mut patch_of = PerFace::filled(mesh.n_faces(), NONE);
    let mut patches: Vec<Patch> = Vec::new();
    let mut queue = BinaryHeap::from([Reverse((Key(0.0), mesh.face_halfedge(first)))]);
    let mut stack = Vec::new();
    let mut coordinates = vec![[f64::NAN; 2]; n_corners];
    let mut vectors = PerHalfedge::filled(mesh.n_halfedges(), [0.0; 2]);
    while let Some(Reverse((Key(distance), entry))) = queue.pop() {
        let Some(f) = mesh.face(entry).filter(|&f| patch_of[f] == NONE) else { continue };
        if patches.len().is_multiple_of(PATCHES_PER_STEP) {
            control.step(Stage::Layout, patches.len() as f64 / faces.mesh.n_faces() as f64)?;
        }
        let from = mesh.face(entry.twin()).and_then(|g| patches.get(patch_of[g] as usize));
        let patch = match (from, r.final_halfedge(entry)) {
            (Some(from), Some(side)) => faces.unfold(from, side),
            _ => faces.lay_down(r.final_face[f]),
        };
        let number = patches.len() as u32;
        patch_of[f] = number;
        stack.push(f);
        while let Some(f) = stack.pop() {
            let b = r.final_barycentric(f);
            for (k, h) in mesh.face_halfedges(f).into_iter().enumerate() {
                let at = &mut coordinates[corner[h] as usize];
                if at[0].is_nan() {
                    *at = patch.point(b[k]);
                }
                vectors[h] = between(patch.frame, b[k], b[(k + 1) % 3]);
                let Some(g) = mesh.face(h.twin()).filter(|&g| patch_of[g] == NONE && !is_cut[h.edge()])
                else {
                    continue;
                };
                match r.final_halfedge(h) {
                    None => {
                        patch_of[g] = number;
                        stack.push(g);
                    }
                    Some(side) => {
                        let step = centre_to_side(faces.mesh, &faces.lengths, side)
                            + centre_to_side(faces.mesh, &faces.lengths, side.twin());
                        queue.push(Reverse((Key(distance + step), h.twin())));
                    }
                }
            }
        }
        patches.push(patch);
    }
    Ok(Placed { coordinates, vectors })
}

impl Faces<'_> {
    /// The first patch: corner 0 at the origin, side 0 → 1 along x.
    fn lay_down(&self, f: FaceId) -> Patch {
        let [first, last] = self.frame(f, [1.0, 0.0]);
        self.patch(f, 0, [1.0, 0.0], [[0.0; 2], first], last)
    }

    /// The face of the final half-edge `side`, unfolded from a patch across it.
    fn unfold(&self, from: &Patch, side: HalfedgeId) -> Patch {
        let local =
            |f: FaceId, h: HalfedgeId| self.mesh.face_halfedges(f).iter().position(|&x| x == h).unwrap_or(0);
        let across = local(from.face, side.twin());
        let (a, b) = (from.corners[(across + 1) % 3], from.corners[across]);
        let along = from.directions[across].map(|x| -x);
        let f = self.mesh.face(side).unwrap_or(from.face);
        let k = local(f, side);
        let [_, right, left] = [0, 1, 2].map(|i| self.sides(f)[(k + i) % 3]);
        let triangle = &self.triangles[f].direction;
        let (at_origin, at_tip) = (triangle[k], triangle[(k + 1) % 3]);
        let up_left = unit(times(along, at_origin));
        let up_right = unit(times(along.map(|x| -x), [at_tip[0], -at_tip[1]]));
        // From the nearer end: less is lost.
        let (start, way, l) = if left <= right { (a, up_left, left) } else { (b, up_right, right) };
        self.patch(f, k, along, [a, b], [start[0] + l * way[0], start[1] + l * way[1]])
    }

    /// A patch whose side k has this direction and these ends, and whose third corner is `apex`.
    fn patch(&self, face: FaceId, k: usize, along: [f64; 2], [a, b]: [[f64; 2]; 2], apex: [f64; 2]) -> Patch {
        let triangle = &self.triangles[face].direction;
        let (at_origin, at_tip) = (triangle[k], triangle[(k + 1) % 3]);
        let (mut corners, mut directions) = ([[0.0; 2]; 3], [[0.0; 2]; 3]);
        (corners[k], corners[(k + 1) % 3], corners[(k + 2) % 3]) = (a, b, apex);
        directions[k] = along;
        directions[(k + 1) % 3] = unit(times(along.map(|x| -x), [at_tip[0], -at_tip[1]]));
        directions[(k + 2) % 3] = unit(times(along, at_origin)).map(|x| -x);
        let frame = self.frame(face, directions[0]);
        Patch { face, corners, directions, frame }
    }
}

impl Patch {
    fn point(&self, b: [f64; 3]) -> [f64; 2] {
        [0, 1].map(|i| (0..3).map(|k| b[k] * self.corners[k][i]).sum())
    }
}

/// Vector between two points of a face with the given vectors from its corner 0 to the others.
fn between([first, last]: [[f64; 2]; 2], from: [f64; 3], to: [f64; 3]) -> [f64; 2] {
    let (x, y) = (to[1] - from[1], to[2] - from[2]);
    [x * first[0] + y * last[0], x * first[1] + y * last[1]]
}
