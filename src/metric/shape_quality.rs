//! How well shaped the triangles of a surface are.

use super::surface::Surface;
use crate::geometry::{Space, triangle};
use crate::mesh::io::Soup;
use crate::mesh::{FaceId, Mesh, PerEdge};
use std::f64::consts::{FRAC_PI_2, PI};

/// Figures of the shapes of all faces. Those that need what a defective list of triangles does not have are none.
///
/// ```
/// # use ricci::{Surface, mesh::shapes, metric::ShapeQuality};
/// let torus = Surface::from_soup(&shapes::torus(2.0, 1.0, 24, 12)?)?;
/// let quality = ShapeQuality::of_surface(&torus);
/// assert!(quality.min_angle.is_some_and(|angle| angle > 0.4));
/// # Ok::<(), ricci::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShapeQuality {
    /// Area of all faces.
    pub area: f64,
    /// The smallest angle, radians; 0 for a face without area.
    pub min_angle: Option<f64>,
    /// Fraction of the faces with an angle above 90°.
    pub obtuse_fraction: Option<f64>,
    /// Longest over shortest edge; none if an edge has length 0 or there is no edge.
    pub edge_ratio: Option<f64>,
    /// Fraction of the interior edges whose opposite angles add up to more than π.
    pub non_delaunay_fraction: Option<f64>,
}

/// Most that the two angles opposite an edge may exceed π, radians, in an edge that counts as Delaunay: the diagonals of a square
/// both count, whatever rounding does to their angles.
const ANGLE_ROUNDING: f64 = 1e-12;

impl ShapeQuality {
    /// The quality of a surface by its lengths.
    pub fn of_surface(surface: &Surface) -> ShapeQuality {
        let (mesh, geometry, lengths) = (surface.mesh(), surface.geometry(), surface.lengths());
        let sides = |f| mesh.opposite_edges(f).map(|e| lengths[e]);
        let mut opposite = PerEdge::filled(mesh.n_edges(), 0.0);
        for f in mesh.faces() {
            for (e, angle) in mesh.opposite_edges(f).into_iter().zip(triangle::angles(geometry, sides(f)).at)
            {
                opposite[e] += angle;
            }
        }
        let interior: Vec<_> = mesh.edges().filter(|&e| !mesh.is_boundary_edge(e)).collect();
        let bad = interior.iter().filter(|&&e| opposite[e] > PI + ANGLE_ROUNDING).count();
        ShapeQuality {
            non_delaunay_fraction: fraction(bad, interior.len()),
            ..ShapeQuality::of_sides(geometry, mesh.faces().map(sides))
        }
    }

    /// The quality of a list of triangles, as a surface if it is one. Otherwise its connectivity does not count, and faces that name no
    /// or a non-finite vertex are left out.
    pub fn of_soup(soup: &Soup) -> ShapeQuality {
        let mesh = Mesh::from_faces(soup.positions.len(), &soup.faces).ok();
        let surface = mesh.and_then(|mesh| Surface::in_space(mesh, soup.positions.clone()).ok());
        if let Some(surface) = surface {
            return ShapeQuality::of_surface(&surface);
        }
        let corner = |&v: &u32| soup.positions.get(v as usize).filter(|p| p.iter().all(|x| x.is_finite()));
        let sides = soup.faces.iter().filter_map(|[a, b, c]| {
            let (a, b, c) = (corner(a)?, corner(b)?, corner(c)?);
            let distance = |p: &[f64; 3], q: &[f64; 3]| (p[0] - q[0]).hypot(p[1] - q[1]).hypot(p[2] - q[2]);
            Some([distance(b, c), distance(c, a), distance(a, b)])
        });
        ShapeQuality::of_sides(Space::E2, sides)
    }

    /// The quality of triangles with these sides.
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
            min_angle: (n > 0).then_some(smallest),
            obtuse_fraction: fraction(obtuse, n),
            edge_ratio: Some(longest / shortest).filter(|r| n > 0 && r.is_finite()),
            non_delaunay_fraction: None,
        }
    }
}

impl Surface {
    /// The face with the smallest angle, and that angle, radians.
    pub fn thinnest_face(&self) -> Option<(FaceId, f64)> {
        let (mesh, geometry, lengths) = (self.mesh(), self.geometry(), self.lengths());
        let smallest = |f: FaceId| {
            let angles = triangle::angles(geometry, mesh.opposite_edges(f).map(|e| lengths[e])).at;
            (f, angles.into_iter().fold(f64::INFINITY, f64::min))
        };
        mesh.faces().map(smallest).min_by(|a, b| a.1.total_cmp(&b.1))
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
        let positions = vec![[0.0; 3], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]];
        let quality = ShapeQuality::of_soup(&Soup::new(positions, vec![[0, 1, 2], [0, 1, 9]]));
        assert!((quality.area - 2.0).abs() < 1e-15);
        assert!(quality.min_angle.is_some_and(|angle| (angle.to_degrees() - 45.0).abs() < 1e-12));
        assert!(quality.edge_ratio.is_some_and(|ratio| (ratio - 2f64.sqrt()).abs() < 1e-15));
        assert_eq!(quality.obtuse_fraction, Some(0.0));
        assert_eq!(quality.non_delaunay_fraction, None);
    }

    #[test]
    fn a_face_without_area_has_angle_zero() {
        let positions = vec![[0.0; 3], [1.0, 0.0, 0.0], [3.0, 0.0, 0.0]];
        let quality = ShapeQuality::of_soup(&Soup::new(positions, vec![[0, 1, 2]]));
        assert_eq!((quality.area, quality.min_angle), (0.0, Some(0.0)));
        assert_eq!(ShapeQuality::of_soup(&Soup::default()).min_angle, None);
    }
}
