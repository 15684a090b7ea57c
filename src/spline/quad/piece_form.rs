//! Planes and cylinders on which smooth pieces of a target lie, as those of parts made by machines do.

use crate::geometry::vector::{Vector, add, dot, norm, normalised, scale, sub, triangle_normal};
use crate::spline::cylinder::Cylinder;

/// The distance from a plane, over the diagonal, within which the vertices of a flat piece lie: single precision and six digits leave less.
const FLAT: f64 = 1e-6;
/// That from a cylinder: programs write its vertices as they come from splines near it.
const ROUND: f64 = 1e-5;
/// The most that the radius of a cylinder is, over the diagonal.
const WIDEST: f64 = 1.0;
/// Fewest directions from the axis in which vertices lie: there is a cylinder through any two plane faces that meet. The sine of the angle from
/// which directions are different ones.
const DIRECTIONS: usize = 5;
const APART: f64 = 1e-3;
/// The least cosine between the normals of a cylinder and of the triangles between its vertices.
const ALONG_NORMAL: f64 = 0.7;

/// The point of the target that belongs to a point of a spline.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FootPoint {
    pub point: Vector,
    /// The unit normal of the target there.
    pub normal: Vector,
}

impl FootPoint {
    /// The foot of a point on the plane through this one.
    fn foot_in_plane(&self, point: Vector) -> FootPoint {
        let height = dot(sub(point, self.point), self.normal);
        FootPoint { point: sub(point, scale(height, self.normal)), normal: self.normal }
    }
}

/// What a piece lies on.
#[derive(Debug, Clone, Copy)]
pub(super) enum PieceForm {
    /// The plane through a point.
    Plane(FootPoint),
    /// A cylinder, and 1 if its piece has the normals that point away from the axis, else -1.
    Cylinder(Cylinder, f64),
}

impl PieceForm {
    /// The plane or cylinder on which the corners of triangles lie, if they do.
    pub fn of(triangles: &[[Vector; 3]], diagonal: f64) -> Option<PieceForm> {
        let plane = plane_of(triangles, FLAT * diagonal).map(PieceForm::Plane);
        plane.or_else(|| cylinder_of(triangles, diagonal))
    }

    /// The foot of a point; none on the axis of a cylinder.
    pub fn foot(&self, point: Vector) -> Option<FootPoint> {
        match self {
            PieceForm::Plane(plane) => Some(plane.foot_in_plane(point)),
            PieceForm::Cylinder(cylinder, side) => {
                let radial = cylinder.radial(point);
                let far = norm(radial);
                let out = scale(1.0 / far, radial);
                let foot = sub(point, scale(far - cylinder.radius, out));
                (far > 0.0).then_some(FootPoint { point: foot, normal: scale(*side, out) })
            }
        }
    }
}

/// A point of the plane of triangles with their mean normal, if all corners are within a distance of it.
fn plane_of(triangles: &[[Vector; 3]], within: f64) -> Option<FootPoint> {
    let sum = triangles.iter().fold([0.0; 3], |sum, &t| add(sum, triangle_normal(t)));
    let plane = FootPoint { point: triangles.first()?[0], normal: normalised(sum) };
    let is_near = |p: &Vector| dot(sub(*p, plane.point), plane.normal).abs() <= within;
    let has_normal = norm(plane.normal) > 0.5;
    (has_normal && triangles.iter().flatten().all(is_near)).then_some(plane)
}

/// The cylinder on which the corners of triangles lie.
fn cylinder_of(triangles: &[[Vector; 3]], diagonal: f64) -> Option<PieceForm> {
    let points: Vec<Vector> = triangles.iter().flatten().copied().collect();
    let across: Vec<Vector> = triangles.iter().map(|&t| triangle_normal(t)).collect();
    let normals: Vec<(Vector, f64)> = across.iter().map(|&n| (normalised(n), norm(n))).collect();
    let found = Cylinder::near(&points, &normals)?;
    let is_on = |&p: &Vector| found.distance(p).abs() <= ROUND * diagonal;
    if found.radius > WIDEST * diagonal || !points.iter().all(is_on) {
        return None;
    }
    let middle = |(&[a, b, c], normal): (&[Vector; 3], &Vector)| {
        let centre = scale(1.0 / 3.0, add(a, add(b, c)));
        dot(normalised(found.radial(centre)), normalised(*normal))
    };
    let cosines: Vec<f64> = triangles.iter().zip(&across).map(middle).collect();
    let side = cosines.first()?.signum();
    let is_along = cosines.iter().all(|cosine| side * cosine >= ALONG_NORMAL);
    (is_along && n_directions(&found, &points) >= DIRECTIONS).then_some(PieceForm::Cylinder(found, side))
}

/// The number of different directions from the axis to points, up to those that are enough.
fn n_directions(cylinder: &Cylinder, points: &[Vector]) -> usize {
    let mut known: Vec<Vector> = Vec::new();
    for &p in points {
        let way = normalised(cylinder.radial(p));
        if known.iter().all(|&other| norm(sub(other, way)) > APART) {
            known.push(way);
        }
        if known.len() == DIRECTIONS {
            break;
        }
    }
    known.len()
}
