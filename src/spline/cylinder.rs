//! Circular cylinders, and those on which points lie.

use crate::geometry::vector::{Vector, add, cross, dot, norm, normalised, perpendicular, scale, sub};
use crate::linalg::dense::{solve_definite, symmetric_eigenvectors};

/// Newton steps from the axis that normals tell.
const STEPS: usize = 4;
/// The part by which the diagonal of the normal equations grows, so that they stay definite for points that leave a direction open.
const DAMPING: f64 = 1e-12;
/// The radius, over the largest distance of points from their middle, from which on they are taken to lie in a plane.
const FLAT: f64 = 1e3;

/// A circular cylinder without ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Cylinder {
    /// A point of the axis.
    pub origin: Vector,
    /// The unit direction of the axis.
    pub axis: Vector,
    pub radius: f64,
}

impl Cylinder {
    /// The cylinder that is nearest to points: the squares of their distances are least, from the axis to which `normals`, with their weights,
    /// are most nearly perpendicular. None where that is no cylinder, or one so wide that it is a plane.
    pub fn near(points: &[Vector], normals: &[(Vector, f64)]) -> Option<Cylinder> {
        let n = points.len() as f64;
        let origin = scale(1.0 / n, points.iter().fold([0.0; 3], |sum, &p| add(sum, p)));
        let entry = |i: usize, j: usize| normals.iter().map(|(m, w)| w * m[i] * m[j]).sum::<f64>();
        let products = [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j)).to_vec());
        let axis = symmetric_eigenvectors(&products).ok()?.first()?.as_slice().try_into().ok()?;
        let mut found = Cylinder { origin, axis, radius: 0.0 }.around(points)?;
        for _ in 0..STEPS {
            found = found.nearer(points)?;
        }
        let is_finite = found.origin.iter().chain(&found.axis).all(|x| x.is_finite());
        let extent = points.iter().map(|&p| norm(sub(p, origin))).fold(0.0, f64::max);
        (is_finite && found.radius > 0.0 && found.radius < FLAT * extent).then_some(found)
    }

    /// The way from the axis to a point, perpendicular to it.
    pub fn radial(&self, p: Vector) -> Vector {
        let way = sub(p, self.origin);
        sub(way, scale(dot(way, self.axis), self.axis))
    }

    /// The distance of a point from the cylinder, positive outside.
    pub fn distance(&self, p: Vector) -> f64 {
        norm(self.radial(p)) - self.radius
    }

    /// Two directions across the axis, which follow each other counterclockwise around it.
    fn across(&self) -> [Vector; 2] {
        let first = perpendicular(self.axis);
        [first, cross(self.axis, first)]
    }

    /// The one with this direction of the axis for which the squares of points' radii differ least from one number.
    fn around(&self, points: &[Vector]) -> Option<Cylinder> {
        let across = self.across();
        let rows = points.iter().map(|&p| {
            let [x, y] = across.map(|way| dot(sub(p, self.origin), way));
            ([x, y, 1.0], x * x + y * y)
        });
        let [x, y, c] = least_squares(rows)?;
        let origin = add(self.origin, add(scale(0.5 * x, across[0]), scale(0.5 * y, across[1])));
        Some(Cylinder { origin, radius: (c + 0.25 * (x * x + y * y)).sqrt(), ..*self })
    }

    /// The one after a Newton step.
    fn nearer(&self, points: &[Vector]) -> Option<Cylinder> {
        let across = self.across();
        let rows = points.iter().map(|&p| {
            let out = normalised(self.radial(p));
            let [x, y] = across.map(|way| dot(out, way));
            let along = dot(sub(p, self.origin), self.axis);
            ([x, y, along * x, along * y, 1.0], self.distance(p))
        });
        let [x, y, tilt_x, tilt_y, wider] = least_squares(rows)?;
        let moved = |x: f64, y: f64| add(scale(x, across[0]), scale(y, across[1]));
        Some(Cylinder {
            origin: add(self.origin, moved(x, y)),
            axis: normalised(add(self.axis, moved(tilt_x, tilt_y))),
            radius: self.radius + wider,
        })
    }
}

/// The coefficients with which the sums of rows are nearest to values.
fn least_squares<const N: usize>(rows: impl Iterator<Item = ([f64; N], f64)>) -> Option<[f64; N]> {
    let (mut products, mut right) = (vec![vec![0.0; N]; N], vec![vec![0.0]; N]);
    for (row, value) in rows {
        for i in 0..N {
            right[i][0] += row[i] * value;
            (0..N).for_each(|j| products[i][j] += row[i] * row[j]);
        }
    }
    let most = (0..N).map(|i| products[i][i]).fold(0.0, f64::max);
    (0..N).for_each(|i| products[i][i] += DAMPING * most);
    let found = solve_definite(&products, &right).ok()?;
    found.into_iter().map(|row| row[0]).collect::<Vec<f64>>().try_into().ok()
}

#[cfg(test)]
mod tests {
    use super::Cylinder;
    use crate::geometry::vector::{Vector, add, cross, dot, normalised, scale};

    #[test]
    fn a_part_of_a_leaning_cylinder_is_found_from_its_points() {
        let axis = normalised([0.2, -0.3, 0.9]);
        let [x, y] = Cylinder { origin: [0.0; 3], axis, radius: 1.0 }.across();
        assert!(dot(cross(x, y), axis) > 1.0 - 1e-15);
        let origin = [3.0, -2.0, 5.0];
        let direction = |k: usize| {
            let (sine, cosine) = (0.3 * k as f64).sin_cos();
            add(scale(cosine, x), scale(sine, y))
        };
        let place = |k: usize, z: f64| add(add(origin, scale(z, axis)), scale(0.7, direction(k)));
        let points: Vec<Vector> = (0..8).flat_map(|k| [0.0, 1.3].map(|z| place(k, z))).collect();
        // Normals that lean as those of thin triangles may.
        let lean = |k: usize| normalised(add(direction(k), scale(0.02 * (k % 3) as f64, axis)));
        let normals: Vec<(Vector, f64)> = (0..8).map(|k| (lean(k), 1.0)).collect();
        let found = Cylinder::near(&points, &normals).unwrap();
        assert!((found.radius - 0.7).abs() < 1e-10, "{found:?}");
        assert!(dot(found.axis, axis).abs() > 1.0 - 1e-14);
        assert!(points.iter().all(|&p| found.distance(p).abs() < 1e-10));
        assert!((found.distance(origin) + 0.7).abs() < 1e-9);
    }

    #[test]
    fn points_in_a_plane_lie_on_none() {
        // Not on a circle either, as the corners of a square are.
        let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.4, 0.3, 0.0]];
        for turn in 0..64 {
            let (sine, cosine) = (0.1 * f64::from(turn)).sin_cos();
            let turned = points.map(|[x, y, z]| [cosine * x - sine * z, y, sine * x + cosine * z]);
            let found = Cylinder::near(&turned, &[([-sine, 0.0, cosine], 1.0)]);
            assert!(found.is_none_or(|found| turned.iter().any(|&p| found.distance(p).abs() > 0.1)));
        }
    }
}
