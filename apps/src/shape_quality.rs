//! How well shaped the triangles of a surface are.

use ricci::Surface;
use ricci::geometry::{Space, triangle};
use ricci::mesh::{FaceId, PerEdge, Point};
use serde::Serialize;
use std::f64::consts::{FRAC_PI_2, PI};

/// Figures of all faces. Those that need what a defective list of triangles does not have are null.
#[derive(Serialize, Debug, PartialEq)]
pub struct ShapeQuality {
    pub area: f64,
    /// Smallest angle, degrees; 0 for a face without area.
    pub min_angle_degrees: Option<f64>,
    /// Fraction of the faces with an angle above 90°.
    pub obtuse_fraction: Option<f64>,
    /// Longest over shortest edge; null if an edge has length 0 or there is none.
    pub edge_ratio: Option<f64>,
    /// Fraction of the interior edges whose opposite angles add up to more than π.
    pub non_delaunay_fraction: Option<f64>,
}

/// Most that the two angles opposite an edge may exceed π, radians, in an edge that counts as Delaunay: the diagonals of a square
/// both count, whatever rounding does to their angles.
const ANGLE_ROUNDING: f64 = 1e-12;

/// Quality of a surface given by its lengths.
pub fn of_surface(surface: &Surface) -> ShapeQuality {
    let (mesh, geometry, lengths) = (surface.mesh(), surface.geometry(), surface.lengths());
    let sides = |f| mesh.opposite_edges(f).map(|e| lengths[e]);
    let mut opposite = PerEdge::filled(mesh.n_edges(), 0.0);
    for f in mesh.faces() {
        for (e, angle) in mesh.opposite_edges(f).into_iter().zip(triangle::angles(geometry, sides(f)).at) {
            opposite[e] += angle;
        }
    }
    let interior: Vec<_> = mesh.edges().filter(|&e| !mesh.is_boundary_edge(e)).collect();
    let bad = interior.iter().filter(|&&e| opposite[e] > PI + ANGLE_ROUNDING).count();
    ShapeQuality {
        non_delaunay_fraction: fraction(bad, interior.len()),
        ..of_sides(geometry, mesh.faces().map(sides))
    }
}

/// The face with the smallest angle, and that angle, degrees.
pub fn thinnest(surface: &Surface) -> Option<(FaceId, f64)> {
    let (mesh, geometry, lengths) = (surface.mesh(), surface.geometry(), surface.lengths());
    let smallest = |f: FaceId| {
        let angles = triangle::angles(geometry, mesh.opposite_edges(f).map(|e| lengths[e])).at;
        (f, angles.into_iter().fold(f64::INFINITY, f64::min).to_degrees())
    };
    mesh.faces().map(smallest).min_by(|a, b| a.1.total_cmp(&b.1))
}

/// Quality of a list of triangles, whatever its connectivity; faces that name no or a non-finite vertex are left out.
pub fn of_triangles(positions: &[Point], faces: &[[u32; 3]]) -> ShapeQuality {
    let corner = |&v: &u32| positions.get(v as usize).filter(|p| p.iter().all(|x| x.is_finite()));
    let sides = faces.iter().filter_map(|[a, b, c]| {
        let (a, b, c) = (corner(a)?, corner(b)?, corner(c)?);
        let distance = |p: &Point, q: &Point| (p[0] - q[0]).hypot(p[1] - q[1]).hypot(p[2] - q[2]);
        Some([distance(b, c), distance(c, a), distance(a, b)])
    });
    of_sides(Space::E2, sides)
}

fn of_sides(geometry: Space, faces: impl Iterator<Item = [f64; 3]>) -> ShapeQuality {
    let (mut area, mut smallest, mut obtuse, mut n) = (0.0, f64::INFINITY, 0, 0);
    let (mut shortest, mut longest) = (f64::INFINITY, 0.0f64);
    for sides in faces {
        n += 1;
        shortest = sides.into_iter().fold(shortest, f64::min);
        longest = sides.into_iter().fold(longest, f64::max);
        let angles = triangle::angles(geometry, sides).at;
        area += triangle::area(geometry, sides);
        smallest = angles.into_iter().fold(smallest, f64::min);
        obtuse += usize::from(angles.into_iter().any(|a| a > FRAC_PI_2 + ANGLE_ROUNDING));
    }
    ShapeQuality {
        area,
        min_angle_degrees: (n > 0).then(|| smallest.to_degrees()),
        obtuse_fraction: fraction(obtuse, n),
        edge_ratio: Some(longest / shortest).filter(|r| n > 0 && r.is_finite()),
        non_delaunay_fraction: None,
    }
}

fn fraction(part: usize, whole: usize) -> Option<f64> {
    (whole > 0).then(|| part as f64 / whole as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_right_isosceles_triangle_has_its_known_figures() {
        let quality = of_triangles(&[[0.0; 3], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]], &[[0, 1, 2], [0, 1, 9]]);
        assert!((quality.area - 2.0).abs() < 1e-15);
        assert!((quality.min_angle_degrees.unwrap() - 45.0).abs() < 1e-12);
        assert!((quality.edge_ratio.unwrap() - 2f64.sqrt()).abs() < 1e-15);
        assert_eq!(quality.obtuse_fraction, Some(0.0));
    }

    #[test]
    fn a_face_without_area_has_angle_zero() {
        let quality = of_triangles(&[[0.0; 3], [1.0, 0.0, 0.0], [3.0, 0.0, 0.0]], &[[0, 1, 2]]);
        assert_eq!((quality.area, quality.min_angle_degrees), (0.0, Some(0.0)));
        assert_eq!(of_triangles(&[], &[]).min_angle_degrees, None);
    }
}
