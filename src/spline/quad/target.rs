//! The surface that a spline is fitted to: triangles with a normal at every corner, cut at sharp edges into smooth pieces.

use super::layout::ascending;
use super::piece_form::{FootPoint, PieceForm};
use crate::error::{Error, Result};
use crate::geometry::triangle_tree::{NearestOfTriangles, TriangleTree, combined};
use crate::geometry::vector::{Vector, add, dot, norm, normalised, scale, sub, triangle_normal};
use crate::mesh::Point;
use crate::mesh::check::Features;
use crate::mesh::union_find::UnionFind;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// How much farther than the nearest point of the target one that faces the same way as the spline may be to be its foot, over the diagonal:
/// thicker walls are told by their distance.
const RIM: f64 = 3e-3;

/// A triangle of the target.
#[derive(Debug, Clone, Copy)]
struct TargetTriangle {
    corners: [Vector; 3],
    /// The unit normals of the smooth piece at the corners.
    normals: [Vector; 3],
}

/// A vertex of the target.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct TargetVertex {
    pub number: u32,
    pub point: Vector,
    /// The share of the area that is nearer to it than to other vertices, about: a third of that of the triangles around it.
    pub share: f64,
}

/// A smooth piece of the target.
struct SmoothPiece {
    /// Per triangle its face of the target.
    #[cfg(feature = "quads")]
    faces: Vec<u32>,
    triangles: Vec<TargetTriangle>,
    tree: TriangleTree,
    /// The plane or cylinder on which all of it lies, if it does.
    form: Option<PieceForm>,
    /// Its vertices with their unit normals, by number.
    vertices: Vec<(TargetVertex, Vector)>,
}

/// Triangles with normals, cut at sharp edges into smooth pieces.
pub struct SplineTarget {
    pieces: Vec<SmoothPiece>,
    /// The edges between its faces, ascending.
    edges: Arc<[[u32; 2]]>,
    diagonal: f64,
    /// True if piece k is for patch k.
    is_by_patch: bool,
}

impl SplineTarget {
    /// The target of a mesh in space. `crease`: the angle between normals, radians, from which an edge is sharp; normals at corners are
    /// those of the faces around them on the same side of sharp edges, weighted by area.
    ///
    /// # Errors
    /// [`Error::Size`] for a corner that does not exist; [`Error::Spline`] for a face without area, or no face.
    pub fn new(positions: &[Point], faces: &[[u32; 3]], crease: f64) -> Result<SplineTarget> {
        check_faces(positions, faces)?;
        let features = Features::new(positions, faces, crease);
        let sharp: BTreeSet<[u32; 2]> = features.edges.iter().map(|edge| ascending(edge.vertices)).collect();
        let all = TargetFaces::new(positions, faces.to_vec(), sharp.iter().copied())?;
        let mut parts: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        pieces(faces, &sharp)
            .into_iter()
            .enumerate()
            .for_each(|(f, k)| parts.entry(k).or_default().push(f as u32));
        let parts: Vec<Vec<u32>> = parts.into_values().collect();
        Ok(all.divided(&parts))
    }

    /// The target of a layout whose patches each lie on these faces; normals are continuous but across sharp edges.
    ///
    /// # Errors
    /// Those of [`SplineTarget::new`].
    pub fn of_patches(
        positions: &[Point],
        faces: &[[u32; 3]],
        sharp: impl Iterator<Item = [u32; 2]>,
        patches: &[Vec<u32>],
    ) -> Result<SplineTarget> {
        TargetFaces::new(positions, faces.to_vec(), sharp)?.of_patches(patches)
    }

    /// Number of smooth pieces.
    pub fn n_pieces(&self) -> usize {
        self.pieces.len()
    }

    /// The diagonal of the bounding box.
    pub fn diagonal(&self) -> f64 {
        self.diagonal
    }

    /// The edges between its faces, ascending.
    pub(super) fn edges(&self) -> &[[u32; 2]] {
        &self.edges
    }

    /// The vertices of a piece with their unit normals there, by number.
    pub(super) fn vertices_of(&self, piece: usize) -> &[(TargetVertex, Vector)] {
        &self.pieces[piece].vertices
    }

    /// The piece that is nearest to a point.
    pub fn nearest_piece(&self, point: Vector) -> usize {
        let distance = |k: usize| {
            let nearest = self.pieces[k].nearest(point);
            norm(sub(point, nearest.point()))
        };
        (0..self.pieces.len()).min_by(|&a, &b| distance(a).total_cmp(&distance(b))).unwrap_or(0)
    }

    /// The piece for a patch whose middle is near a point.
    pub(super) fn piece_of_patch(&self, patch: usize, middle: Vector) -> usize {
        if self.is_by_patch { patch } else { self.nearest_piece(middle) }
    }

    /// The face of a piece that is nearest to a point.
    #[cfg(feature = "quads")]
    pub(super) fn face_near(&self, piece: usize, point: Vector) -> u32 {
        let piece = &self.pieces[piece];
        piece.faces[piece.tree.nearest(point).triangle]
    }

    /// The foot of a point on a piece, as on a surface that is curved between the corners of the nearest triangle [`offset`].
    pub(super) fn foot(&self, piece: usize, point: Vector) -> FootPoint {
        let exact = self.pieces[piece].form.and_then(|form| form.foot(point));
        exact.unwrap_or_else(|| self.pieces[piece].nearest(point).foot(point))
    }

    /// The plane or cylinder on which a piece lies, if it does.
    pub(super) fn form(&self, piece: usize) -> Option<PieceForm> {
        self.pieces[piece].form
    }

    /// The foot of a point of a spline with this normal, on the part of a piece that faces the same way if that is about as near as the rest: the point
    /// nearest to one at the rim of a thin wall may be on its other side. It tells whether the spline is turned over there.
    /// `foot`: the nearest one, by [`SplineTarget::foot`].
    pub(super) fn foot_facing(
        &self,
        piece: usize,
        point: Vector,
        foot: FootPoint,
        normal: Option<Vector>,
    ) -> FootPoint {
        let Some(normal) = normal.filter(|&normal| dot(normal, foot.normal) <= 0.0) else { return foot };
        let within = norm(sub(foot.point, point)) + RIM * self.diagonal;
        self.pieces[piece].nearest_facing(point, normal, within).map_or(foot, |nearest| nearest.foot(point))
    }

    /// True if a spline with this normal at a point is turned over against a piece there; also where it has none.
    pub(super) fn is_turned_over(&self, piece: usize, point: Vector, normal: Option<Vector>) -> bool {
        let facing = self.foot_facing(piece, point, self.foot(piece, point), normal);
        normal.is_none_or(|normal| dot(normal, facing.normal) <= 0.0)
    }
}

/// The faces of a target, from which pieces are taken.
pub(super) struct TargetFaces<'a> {
    positions: &'a [Point],
    faces: Vec<[u32; 3]>,
    /// The unit normals at the corners of each face.
    normals: Vec<[Vector; 3]>,
    /// Per vertex its share of the area.
    shares: Vec<f64>,
    /// Their edges, ascending.
    edges: Arc<[[u32; 2]]>,
}

impl<'a> TargetFaces<'a> {
    /// # Errors
    /// [`Error::Size`] for a corner that does not exist; [`Error::Spline`] for a face without area, or no face.
    pub fn new(
        positions: &'a [Point],
        faces: Vec<[u32; 3]>,
        sharp: impl Iterator<Item = [u32; 2]>,
    ) -> Result<TargetFaces<'a>> {
        check_faces(positions, &faces)?;
        let sharp = sharp.map(ascending).collect();
        let (normals, shares) = (corner_normals(positions, &faces, &sharp), area_shares(positions, &faces));
        let sides = faces.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]].map(ascending));
        let edges: BTreeSet<[u32; 2]> = sides.collect();
        let edges = edges.into_iter().collect();
        Ok(TargetFaces { positions, faces, normals, shares, edges })
    }

    /// The target of patches that each lie on these faces.
    ///
    /// # Errors
    /// [`Error::Spline`] for a patch without faces.
    pub fn of_patches(&self, patches: &[Vec<u32>]) -> Result<SplineTarget> {
        if let Some(index) = patches.iter().position(Vec::is_empty) {
            let message = "no face of the target belongs to it".into();
            return Err(Error::Spline { what: "patch of the target", index, message });
        }
        Ok(SplineTarget { is_by_patch: true, ..self.divided(patches) })
    }

    fn divided(&self, parts: &[Vec<u32>]) -> SplineTarget {
        let TargetFaces { positions, faces, normals, shares, edges } = self;
        let triangle = |&f: &u32| {
            let corners = faces[f as usize].map(|v| positions[v as usize]);
            TargetTriangle { corners, normals: normals[f as usize] }
        };
        let vertex = |number: u32| TargetVertex {
            number,
            point: positions[number as usize],
            share: shares[number as usize],
        };
        let diagonal = crate::geometry::vector::diagonal(positions);
        let piece = |part: &Vec<u32>| {
            let triangles: Vec<TargetTriangle> = part.iter().map(triangle).collect();
            let mut by_number = BTreeMap::new();
            for (&f, k) in part.iter().flat_map(|f| (0..3).map(move |k| (f, k))) {
                by_number.entry(faces[f as usize][k]).or_insert(normals[f as usize][k]);
            }
            let vertices = by_number.into_iter().map(|(v, normal)| (vertex(v), normal)).collect();
            let corners: Vec<[Vector; 3]> = triangles.iter().map(|t| t.corners).collect();
            let form = PieceForm::of(&corners, diagonal);
            let tree = TriangleTree::new(corners);
            SmoothPiece {
                #[cfg(feature = "quads")]
                faces: part.clone(),
                form,
                triangles,
                tree,
                vertices,
            }
        };
        let pieces = parts.iter().map(piece).collect();
        SplineTarget { pieces, edges: edges.clone(), diagonal, is_by_patch: false }
    }
}

/// Checks that corners exist and faces have an area.
fn check_faces(positions: &[Point], faces: &[[u32; 3]]) -> Result<()> {
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
    Ok(())
}

/// Per vertex a third of the area of the triangles around it, over the area of all.
fn area_shares(positions: &[Point], faces: &[[u32; 3]]) -> Vec<f64> {
    let mut shares = vec![0.0; positions.len()];
    for face in faces {
        let area = norm(triangle_normal(face.map(|v| positions[v as usize])));
        face.iter().for_each(|&v| shares[v as usize] += area);
    }
    let all: f64 = shares.iter().sum();
    shares.iter_mut().for_each(|share| *share /= all);
    shares
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

    fn foot(&self, point: Vector) -> FootPoint {
        let normal = self.normal();
        FootPoint { point: sub(point, scale(offset(self, normal, point), normal)), normal }
    }
}

/// The height of a point over the surface through the corners of the triangle nearest to it: the mean, by weights there, of its heights along
/// the mean of the corner's normal and the one there, by which a chord of a sphere has height 0.
fn offset(nearest: &NearestPoint<'_>, normal: Vector, point: Vector) -> f64 {
    let TargetTriangle { corners, normals } = nearest.triangle;
    let height = |k: usize| 0.5 * dot(add(normals[k], normal), sub(point, corners[k]));
    (0..3).map(|k| nearest.weights[k] * height(k)).sum()
}

impl SmoothPiece {
    fn nearest(&self, point: Vector) -> NearestPoint<'_> {
        self.point_at(self.tree.nearest(point))
    }

    /// The nearest point of the triangles that face a direction, if one is within a distance.
    fn nearest_facing(&self, point: Vector, direction: Vector, within: f64) -> Option<NearestPoint<'_>> {
        self.tree.nearest_facing(point, direction, within).map(|nearest| self.point_at(nearest))
    }

    fn point_at(&self, nearest: NearestOfTriangles) -> NearestPoint<'_> {
        NearestPoint { triangle: &self.triangles[nearest.triangle], weights: nearest.weights }
    }
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
