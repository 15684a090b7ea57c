//! Tangents of a surface along its texture coordinates, as normal maps need them.
//!
//! The tangent of a vertex is the direction of growing u, at a right angle to its normal; with the normal and a sign it spans the frame in
//! which a normal map gives its vectors: bitangent = sign · (normal × tangent) is the direction of growing v, upwards.
//!
//! At each corner of a face the direction of growing u is put into the plane at a right angle to the vertex's normal and made a unit
//! vector; a vertex has the sum of those of its corners, weighted by their angles. That is the average of MikkTSpace \[Mik08\] but for its
//! vertices: it joins those with the same position, normal and coordinates before, and parts those whose faces have other signs, while
//! here vertices are those that are given. Charts of an atlas have one sign each, so that their vertices need no parting.

use super::Point;
use crate::geometry::vector::{cross, dot, norm, perpendicular, sub, triangle_normal};

/// A surface with one normal and one pair of texture coordinates for each vertex.
#[derive(Debug, Clone, Copy)]
pub struct TangentFrames<'a> {
    /// Vertex positions.
    pub positions: &'a [Point],
    /// Their normals, of any length.
    pub normals: &'a [Point],
    /// Their texture coordinates, with v upwards.
    pub uv: &'a [[f64; 2]],
    /// The faces; each corner is below the number of vertices.
    pub faces: &'a [[u32; 3]],
}

/// For each vertex its unit tangent and the sign, 1 or −1. A vertex without a face of which u and v are coordinates has any tangent at a right
/// angle to its normal, and sign 1.
pub fn vertex_tangents(frames: &TangentFrames<'_>) -> Vec<[f64; 4]> {
    let TangentFrames { positions, normals, uv, faces } = *frames;
    let normals: Vec<Point> = normals.iter().map(|n| unit(*n).unwrap_or([0.0, 0.0, 1.0])).collect();
    let mut sums = vec![[0.0; 4]; positions.len()];
    for face in faces {
        let corners = face.map(|v| v as usize);
        let [a, b, c] = corners.map(|v| positions[v]);
        let [p, q, r] = corners.map(|v| uv[v]);
        let (along, across) = ([q[0] - p[0], q[1] - p[1]], [r[0] - p[0], r[1] - p[1]]);
        let det = along[0] * across[1] - along[1] * across[0];
        let (u, v) = (sub(b, a), sub(c, a));
        let direction = |x: f64, y: f64| [0, 1, 2].map(|k| det.signum() * (x * u[k] + y * v[k]));
        let (Some(tangent), true) = (unit(direction(across[1], -along[1])), det != 0.0) else { continue };
        let bitangent = direction(-across[0], along[0]);
        for (k, vertex) in corners.into_iter().enumerate() {
            let normal = normals[vertex];
            let Some(flat) = unit(beside(tangent, normal)) else { continue };
            let angle = corner_angle([0, 1, 2].map(|j| positions[corners[(k + j) % 3]]));
            let sign = if dot(cross(normal, flat), bitangent) < 0.0 { -1.0 } else { 1.0 };
            let sum = &mut sums[vertex];
            (0..3).for_each(|j| sum[j] += angle * flat[j]);
            sum[3] += angle * sign;
        }
    }
    let whole = |([x, y, z, sign], normal): ([f64; 4], Point)| {
        let tangent = unit(beside([x, y, z], normal))
            .or_else(|| unit(perpendicular(normal)))
            .unwrap_or([1.0, 0.0, 0.0]);
        [tangent[0], tangent[1], tangent[2], if sign < 0.0 { -1.0 } else { 1.0 }]
    };
    sums.into_iter().zip(normals).map(whole).collect()
}

/// For each vertex the unit vector along the sum of the normals of its faces, weighted by their angles there; 0 for a vertex without a face that
/// has an area.
pub fn vertex_normals(positions: &[Point], faces: &[[u32; 3]]) -> Vec<Point> {
    let mut sums = vec![[0.0; 3]; positions.len()];
    for face in faces {
        let corners = face.map(|v| v as usize);
        let Some(normal) = unit(triangle_normal(corners.map(|v| positions[v]))) else { continue };
        for (k, vertex) in corners.into_iter().enumerate() {
            let angle = corner_angle([0, 1, 2].map(|j| positions[corners[(k + j) % 3]]));
            (0..3).for_each(|j| sums[vertex][j] += angle * normal[j]);
        }
    }
    sums.into_iter().map(|sum| unit(sum).unwrap_or([0.0; 3])).collect()
}

/// The vector without its part along a unit vector.
fn beside(x: Point, normal: Point) -> Point {
    let along = dot(x, normal);
    [0, 1, 2].map(|k| x[k] - along * normal[k])
}

/// The angle at the first corner.
fn corner_angle([a, b, c]: [Point; 3]) -> f64 {
    let (u, v) = (sub(b, a), sub(c, a));
    let angle = norm(cross(u, v)).atan2(dot(u, v));
    if angle.is_finite() { angle } else { 0.0 }
}

/// The unit vector in this direction; none of the length 0 or no finite one.
fn unit(x: Point) -> Option<Point> {
    let length = x[0].hypot(x[1]).hypot(x[2]);
    (length > 0.0 && length.is_finite()).then(|| x.map(|x| x / length))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square in the plane z = 0 whose u runs along the direction with angle 30 degrees.
    #[test]
    fn the_tangent_of_a_plane_is_the_direction_of_u() {
        let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let (c, s) = (0.75f64.sqrt(), 0.5);
        let turned = positions.map(|[x, y, _]| [c * x + s * y, c * y - s * x]);
        let mirrored = turned.map(|[u, v]| [-u, v]);
        let faces = [[0, 1, 2], [0, 2, 3]];
        let normals = [[0.0, 0.0, 3.0]; 4];
        for (uv, wanted) in [(turned, [c, s, 0.0, 1.0]), (mirrored, [-c, -s, 0.0, -1.0])] {
            let frames = TangentFrames { positions: &positions, normals: &normals, uv: &uv, faces: &faces };
            for found in vertex_tangents(&frames) {
                assert!(found.iter().zip(wanted).all(|(x, y)| (x - y).abs() < 1e-14), "{found:?}");
            }
        }
    }

    /// The three right angles at the corner of a cube weigh alike, however large their faces are.
    #[test]
    fn the_normal_of_a_corner_of_a_cube_is_its_diagonal() {
        let positions = [[0.0; 3], [-1.0, 0.0, 0.0], [0.0, -7.0, 0.0], [0.0, 0.0, -0.1], [9.0; 3]];
        let faces = [[0, 1, 2], [0, 2, 3], [0, 3, 1], [0, 0, 1]];
        let normals = vertex_normals(&positions, &faces);
        assert!(normals[0].iter().all(|x| (x - 1.0 / 3f64.sqrt()).abs() < 1e-14), "{:?}", normals[0]);
        assert_eq!(normals[4], [0.0; 3]);
    }

    #[test]
    fn without_coordinates_there_is_still_a_frame() {
        let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [5.0, 5.0, 5.0]];
        let normals = [[1.0, 2.0, 3.0], [0.0; 3], [f64::MAX; 3], [-1.0, 0.0, 0.0]];
        let frames = TangentFrames {
            positions: &positions,
            normals: &normals,
            uv: &[[0.5; 2]; 4],
            faces: &[[0, 1, 2]],
        };
        for ([x, y, z, sign], normal) in vertex_tangents(&frames).into_iter().zip(normals) {
            let tangent = [x, y, z];
            let normal = unit(normal).unwrap_or([0.0, 0.0, 1.0]);
            assert!((norm(tangent) - 1.0).abs() < 1e-14 && dot(tangent, normal).abs() < 1e-14 && sign == 1.0);
        }
    }
}
