//! What guides a field of directions on a surface in space: sharp edges, principal curvature, strokes.

use super::aligned_field::FieldGuide;
use super::face_axes::FaceAxes;
use crate::error::{Error, Result};
use crate::geometry::vector::{self, Vector};
use crate::linalg::dense::solve_definite;
use crate::mesh::check::Features;
use crate::mesh::{EdgeId, FaceId, Mesh, Point, VertexId};
use crate::metric::Surface;

/// Largest weight of a direction of curvature, that of smoothness across a few edges.
const MOST_CURVATURE_WEIGHT: f64 = 1.0;
/// Weight of a stroke, many times that of smoothness.
const STROKE_WEIGHT: f64 = 100.0;

fn positions(surface: &Surface) -> Result<&[Point]> {
    let none = || Error::argument("surface", "one without positions", "a surface in space");
    surface.positions().map(|positions| &positions[..]).ok_or_else(none)
}

/// The edges at which the surface turns by `angle` radians or more ([`Features`]).
///
/// # Errors
/// [`Error::Argument`] for a surface without positions.
pub fn sharp_edges(surface: &Surface, angle: f64) -> Result<Vec<EdgeId>> {
    let mesh = surface.mesh();
    let found = Features::new(positions(surface)?, &mesh.triangles(), angle);
    let mut edges = Vec::new();
    for [a, b] in found.edges.iter().map(|edge| edge.vertices.map(VertexId)) {
        edges.extend(mesh.outgoing(a).filter(|&h| mesh.tip(h) == b).map(|h| h.edge()));
    }
    edges.sort_unstable();
    edges.dedup();
    Ok(edges)
}

/// Principal directions of curvature in all faces, with weights `strength · area · (κ₁ − κ₂)²`, 1 at most: none where the two curvatures are
/// equal. The curvature of a face is that of the quadratic form that the normals at its corners change by \[Rus04\].
///
/// # Errors
/// [`Error::Argument`] for a surface without positions or a strength that is negative or not finite.
pub fn curvature_guides(surface: &Surface, strength: f64) -> Result<Vec<FieldGuide>> {
    if !(strength.is_finite() && strength >= 0.0) {
        return Err(Error::argument("strength", strength, "0 or positive, and finite"));
    }
    let (mesh, positions) = (surface.mesh(), positions(surface)?);
    let mut normals = vec![[0.0; 3]; mesh.n_vertices()];
    for f in mesh.faces() {
        let corners = mesh.face_vertices(f);
        let normal = vector::triangle_normal(corners.map(|v| positions[v.index()]));
        corners.iter().for_each(|v| normals[v.index()] = vector::add(normals[v.index()], normal));
    }
    normals.iter_mut().for_each(|n| *n = vector::normalised(*n));
    let mut guides = Vec::new();
    for face in mesh.faces() {
        let corners = mesh.face_vertices(face).map(|v| v.index());
        let of_face = |f: &[Point]| corners.map(|v| f[v]);
        if let Some((angle, size)) = principal(of_face(positions), of_face(&normals)) {
            guides.push(FieldGuide { face, angle, weight: (strength * size).min(MOST_CURVATURE_WEIGHT) });
        }
    }
    Ok(guides)
}

/// The angle of a principal direction in a triangle from its first side, and area · (κ₁ − κ₂)², from the normals at its corners.
fn principal(places: [Point; 3], normals: [Vector; 3]) -> Option<(f64, f64)> {
    let frame = FaceAxes::new(places)?;
    // The form takes the side e to the change of the normals along e: three equations for its three numbers.
    let (mut matrix, mut right) = (vec![vec![0.0; 3]; 3], vec![0.0; 3]);
    for k in 0..3 {
        let next = (k + 1) % 3;
        let [x, y] = frame.flat(vector::sub(places[next], places[k]));
        let [p, q] = frame.flat(vector::sub(normals[next], normals[k]));
        for (row, value) in [([x, y, 0.0], p), ([0.0, x, y], q)] {
            for i in 0..3 {
                (0..3).for_each(|j| matrix[i][j] += row[i] * row[j]);
                right[i] += row[i] * value;
            }
        }
    }
    let right: Vec<_> = right.into_iter().map(|x| vec![x]).collect();
    let [a, b, c] = solve_definite(&matrix, &right).ok()?.concat()[..] else { return None };
    let difference = (a - c).hypot(2.0 * b);
    let angle = 0.5 * (2.0 * b).atan2(a - c);
    let size = frame.area * difference * difference;
    (angle.is_finite() && size.is_finite()).then_some((angle, size))
}

/// Guides for directions at vertices, vectors in space: in each face at the vertex the projection of the vector, unless that is short.
///
/// # Errors
/// [`Error::Argument`] for a surface without positions, a vertex that does not exist, and a vector that is 0 or not finite.
pub fn stroke_guides(surface: &Surface, strokes: &[(VertexId, Vector)]) -> Result<Vec<FieldGuide>> {
    let (mesh, positions) = (surface.mesh(), positions(surface)?);
    let mut guides = Vec::new();
    for &(v, direction) in strokes {
        if v.index() >= mesh.n_vertices() {
            return Err(Error::argument("vertex of a stroke", v, "an existing vertex"));
        }
        let size = vector::norm(direction);
        if !(size.is_finite() && size > 0.0) {
            return Err(Error::argument("direction of a stroke", size, "a finite length that is not 0"));
        }
        let faces = mesh.fan(v).into_iter().filter_map(|h| mesh.face(h));
        guides.extend(faces.filter_map(|face| stroke_in(mesh, positions, face, direction)));
    }
    Ok(guides)
}

fn stroke_in(mesh: &Mesh, positions: &[Point], face: FaceId, direction: Vector) -> Option<FieldGuide> {
    let frame = FaceAxes::new(mesh.face_vertices(face).map(|v| positions[v.index()]))?;
    let [x, y] = frame.flat(direction);
    let is_long = x.hypot(y) > 0.5 * vector::norm(direction);
    is_long.then(|| FieldGuide { face, angle: y.atan2(x), weight: STROKE_WEIGHT })
}
