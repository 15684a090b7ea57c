//! The surface that a spline is fitted to: triangles with a normal at every corner, cut at sharp edges into smooth pieces.

use super::layout::ascending;
use crate::error::{Error, Result};
use crate::geometry::bounds::Bounds;
use crate::geometry::boxes::{BoundsNode, BoundsTree};
use crate::geometry::vector::{Vector, add, cross, dot, norm, normalised, scale, sub, triangle_normal};
use crate::mesh::Point;
use crate::mesh::check::Features;
use crate::mesh::union_find::UnionFind;
use std::collections::{BTreeMap, BTreeSet};

/// A triangle of the target.
#[derive(Debug, Clone, Copy)]
struct TargetTriangle {
    corners: [Vector; 3],
    /// The unit normals of the smooth piece at the corners.
    normals: [Vector; 3],
}

/// A smooth piece of the target.
struct SmoothPiece {
    triangles: Vec<TargetTriangle>,
    tree: BoundsTree,
}

/// The point of the target that belongs to a point of a spline.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FootPoint {
    pub point: Vector,
    /// The unit normal of the target there.
    pub normal: Vector,
}

/// Triangles with normals, cut at sharp edges into smooth pieces.
pub struct SplineTarget {
    pieces: Vec<SmoothPiece>,
    diagonal: f64,
}

impl SplineTarget {
    /// The target of a mesh in space. `crease`: the angle between normals, radians, from which an edge is sharp; normals at corners are
    /// those of the faces around them on the same side of sharp edges, weighted by area.
    ///
    /// # Errors
    /// [`Error::Size`] for a corner that does not exist; [`Error::Spline`] for a face without area, or no face.
    pub fn new(positions: &[Point], faces: &[[u32; 3]], crease: f64) -> Result<SplineTarget> {
        if let Some(&v) = faces.iter().flatten().find(|&&v| v as usize >= positions.len()) {
            return Err(Error::Size { what: "positions", expected: v as usize + 1, got: positions.len() });
        }
        let area = |f: &[u32; 3]| triangle_normal(f.map(|v| positions[v as usize]));
        let has_normal = |size: f64| size > 0.0 && size.is_finite();
        let flat = faces.iter().position(|f| !has_normal(norm(area(f))));
        if let Some(index) = flat.or(faces.is_empty().then_some(0)) {
            let message = "it has no area, so no normal: drop or repair it".into();
            return Err(Error::Spline { what: "face of the target", index, message });
        }
        let sharp: BTreeSet<[u32; 2]> = Features::new(positions, faces, crease)
            .edges
            .iter()
            .map(|edge| ascending(edge.vertices))
            .collect();
        let piece = pieces(faces, &sharp);
        let normals = corner_normals(positions, faces, &sharp);
        let mut parts: BTreeMap<u32, Vec<TargetTriangle>> = BTreeMap::new();
        for (f, face) in faces.iter().enumerate() {
            let corners = face.map(|v| positions[v as usize]);
            parts.entry(piece[f]).or_default().push(TargetTriangle { corners, normals: normals[f] });
        }
        let with_tree = |triangles: Vec<TargetTriangle>| {
            let boxes: Vec<Bounds> = triangles.iter().map(|t| Bounds::of(t.corners)).collect();
            SmoothPiece { tree: BoundsTree::new(&boxes), triangles }
        };
        let pieces = parts.into_values().map(with_tree).collect();
        Ok(SplineTarget { pieces, diagonal: crate::geometry::vector::diagonal(positions) })
    }

    /// Number of smooth pieces.
    pub fn n_pieces(&self) -> usize {
        self.pieces.len()
    }

    /// The diagonal of the bounding box.
    pub fn diagonal(&self) -> f64 {
        self.diagonal
    }

    /// The piece that is nearest to a point.
    pub fn nearest_piece(&self, point: Vector) -> usize {
        let distance = |k: usize| {
            let nearest = self.pieces[k].nearest(point);
            norm(sub(point, nearest.point()))
        };
        (0..self.pieces.len()).min_by(|&a, &b| distance(a).total_cmp(&distance(b))).unwrap_or(0)
    }

    /// The foot of a point on a piece, as on a surface that is curved between the corners of the nearest triangle [`offset`].
    pub(super) fn foot(&self, piece: usize, point: Vector) -> FootPoint {
        let nearest = self.pieces[piece].nearest(point);
        let normal = nearest.normal();
        FootPoint { point: sub(point, scale(offset(&nearest, normal, point), normal)), normal }
    }
}

/// A point of a triangle.
struct NearestPoint<'a> {
    triangle: &'a TargetTriangle,
    weights: [f64; 3],
}

impl NearestPoint<'_> {
    fn point(&self) -> Vector {
        combined(self.weights, self.triangle.corners)
    }

    fn normal(&self) -> Vector {
        normalised(combined(self.weights, self.triangle.normals))
    }
}

/// The height of a point over the surface through the corners of the triangle nearest to it: the mean, by weights there, of its heights along
/// the mean of the corner's normal and the one there, by which a chord of a sphere has height 0.
fn offset(nearest: &NearestPoint<'_>, normal: Vector, point: Vector) -> f64 {
    let TargetTriangle { corners, normals } = nearest.triangle;
    let height = |k: usize| 0.5 * dot(add(normals[k], normal), sub(point, corners[k]));
    (0..3).map(|k| nearest.weights[k] * height(k)).sum()
}

fn combined(weights: [f64; 3], [a, b, c]: [Vector; 3]) -> Vector {
    [0, 1, 2].map(|x| weights[0] * a[x] + weights[1] * b[x] + weights[2] * c[x])
}

impl SmoothPiece {
    /// The point of the piece that is nearest to a point; of several triangles, that with the smallest number.
    fn nearest(&self, point: Vector) -> NearestPoint<'_> {
        let mut best = (f64::INFINITY, u32::MAX, [1.0, 0.0, 0.0]);
        let mut open = vec![(self.tree.distance(0, point), 0)];
        while let Some((least, node)) = open.pop() {
            if least > best.0 {
                continue;
            }
            match self.tree.node(node) {
                BoundsNode::Inner(children) => {
                    let mut both = children.map(|child| (self.tree.distance(child, point), child));
                    both.sort_by(|a, b| b.0.total_cmp(&a.0));
                    open.extend(both);
                }
                BoundsNode::Leaf(triangles) => {
                    for &t in triangles {
                        let corners = self.triangles[t as usize].corners;
                        let weights = nearest_weights(corners, point);
                        let distance = norm(sub(combined(weights, corners), point));
                        if (distance, t) < (best.0, best.1) {
                            best = (distance, t, weights);
                        }
                    }
                }
            }
        }
        let triangle = &self.triangles[if best.1 == u32::MAX { 0 } else { best.1 as usize }];
        NearestPoint { triangle, weights: best.2 }
    }
}

/// The barycentric coordinates of the point of a triangle that is nearest to a point [Eri05, §5.1.5].
fn nearest_weights([a, b, c]: [Vector; 3], point: Vector) -> [f64; 3] {
    let (ab, ac) = (sub(b, a), sub(c, a));
    let normal = cross(ab, ac);
    let square = dot(normal, normal);
    let to = sub(point, a);
    let [v, w] = [dot(cross(to, ac), normal) / square, dot(cross(ab, to), normal) / square];
    let inside = [1.0 - v - w, v, w];
    if inside.iter().all(|&x| x >= 0.0) {
        return inside;
    }
    let corners = [a, b, c];
    let on_side = |k: usize| {
        let (from, along) = (corners[k], sub(corners[(k + 1) % 3], corners[k]));
        let t = (dot(sub(point, from), along) / dot(along, along)).clamp(0.0, 1.0);
        let mut weights = [0.0; 3];
        (weights[k], weights[(k + 1) % 3]) = (1.0 - t, t);
        (norm(sub(add(from, scale(t, along)), point)), weights)
    };
    let [first, second, third] = [0, 1, 2].map(on_side);
    [second, third].into_iter().fold(first, |best, side| if side.0 < best.0 { side } else { best }).1
}

/// The number of the smooth piece of each face.
fn pieces(faces: &[[u32; 3]], sharp: &BTreeSet<[u32; 2]>) -> Vec<u32> {
    let mut same = UnionFind::new(faces.len());
    let mut sides: BTreeMap<[u32; 2], u32> = BTreeMap::new();
    for (f, face) in faces.iter().enumerate() {
        for k in 0..3 {
            let edge = ascending([face[k], face[(k + 1) % 3]]);
            if !sharp.contains(&edge) {
                let other = *sides.entry(edge).or_insert(f as u32);
                _ = same.join(other, f as u32);
            }
        }
    }
    (0..faces.len() as u32).map(|f| same.root(f)).collect()
}

/// The unit normals at the corners of the faces: of all faces around that corner that edges which are not sharp join.
fn corner_normals(positions: &[Point], faces: &[[u32; 3]], sharp: &BTreeSet<[u32; 2]>) -> Vec<[Vector; 3]> {
    // The corners 3f + k that edges which are not sharp join at their vertex.
    let mut same = UnionFind::new(3 * faces.len());
    let mut sides: BTreeMap<[u32; 2], [u32; 2]> = BTreeMap::new();
    for (f, face) in faces.iter().enumerate() {
        for k in 0..3 {
            let l = (k + 1) % 3;
            let edge = ascending([face[k], face[l]]);
            let [mut from, mut to] = [3 * f + k, 3 * f + l].map(|c| c as u32);
            if edge[0] != face[k] {
                (from, to) = (to, from);
            }
            if !sharp.contains(&edge) {
                let [a, b] = *sides.entry(edge).or_insert([from, to]);
                _ = same.join(a, from);
                _ = same.join(b, to);
            }
        }
    }
    let mut sums = vec![[0.0; 3]; 3 * faces.len()];
    for (f, face) in faces.iter().enumerate() {
        let normal = triangle_normal(face.map(|v| positions[v as usize]));
        for k in 0..3 {
            let root = same.root((3 * f + k) as u32) as usize;
            sums[root] = add(sums[root], normal);
        }
    }
    let mut normal_at = |f: usize, k: usize| {
        let sum = sums[same.root((3 * f + k) as u32) as usize];
        // The faces around a spike may cancel out: its own normal is left.
        let own = triangle_normal(faces[f].map(|v| positions[v as usize]));
        normalised(if dot(sum, own) > 0.0 { sum } else { own })
    };
    (0..faces.len()).map(|f| [0, 1, 2].map(|k| normal_at(f, k))).collect()
}
