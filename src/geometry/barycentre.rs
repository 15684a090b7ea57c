//! The conformal barycentre of weighted points of the sphere, and the Möbius transformation that moves it to the centre.
//!
//! From a point y of hyperbolic 3-space the points of its sphere at infinity are seen in directions x_i(y) of the unit sphere. The
//! *conformal barycentre* is the y with `Σ w_i x_i(y) = 0` [DE86; Spr05]: the lowest point of `Σ w_i b_i`, with b_i the Busemann function
//! of point i, which is convex with gradient −x_i and Hessian `1 − x_i x_iᵀ`. It exists and is unique where no point has half of the
//! weight or more. In the upper half-space y = (p, t), and x_i is the lift of `(z_i − p)/t`.
//!
//! ```
//! use ricci::geometry::barycentre::conformal_barycentre;
//! // Four points of equal weight on the circle of radius 3 about (1, 0): it becomes the equator.
//! let points = [[4.0, 0.0], [1.0, 3.0], [-2.0, 0.0], [1.0, -3.0]];
//! let y = conformal_barycentre(&points, &[1.0; 4], 0.0)?;
//! assert!((y.scale - 3.0).abs() < 1e-12 && (y.centre[0] - 1.0).abs() < 1e-12);
//! # Ok::<(), ricci::Error>(())
//! ```

use super::complex;
use super::sphere::{SOUTH, Similarity, lift, project};
use super::vector::{Vector, add, dot, norm, scale};
use crate::error::{Error, Result, check_size};

/// Longest Newton step, a hyperbolic distance: within a distance of 1 the directions, and so the Hessian, change moderately.
const LONGEST_STEP: f64 = 1.0;
/// Most Newton steps. Steps of length 1 reach every point in fewer: coordinates in f64 lie within a hyperbolic distance of 1500.
const MAX_STEPS: usize = 2000;
/// Most halvings of a step: 2⁻³⁰ of it changes the directions by little more than their rounding.
const MAX_HALVINGS: usize = 30;
/// A residual that cannot be lowered further is taken for rounding if it is at most this many times the rounding of its sum.
const ROUNDING_UNITS: f64 = 8.0;
/// `|Σ w x|/Σ w` at which the points count as balanced, and least length of a step: a few roundings of 1.
const BALANCED: f64 = 1e-15;

/// The similarity `z ↦ (z − p)/t` after which the lifts x of the `points` of the plane (∞ has weight `at_infinity`) have
/// `Σ w x = 0`. Weights are not negative and one is positive at least; every other such Möbius transformation is a rotation after it.
///
/// # Errors
///
/// [`Error::Size`]; [`Error::Argument`] for a weight that is negative or not finite, and where no such transformation exists because half
/// of the weight or more lies at one point, or at points that nearly coincide.
pub fn conformal_barycentre(points: &[[f64; 2]], weights: &[f64], at_infinity: f64) -> Result<Similarity> {
    check_size("weights", weights.len(), points.len())?;
    let total = weights.iter().sum::<f64>() + at_infinity;
    let mut numbers = points.as_flattened().iter().chain(weights).chain([&at_infinity, &total]);
    let negative = weights.iter().chain([&at_infinity]).any(|&w| w < 0.0);
    if negative || total <= 0.0 || numbers.any(|x| !x.is_finite()) {
        let need = "finite, not negative and not all 0, at finite points";
        return Err(Error::argument("weights", format!("of sum {total}"), need));
    }
    let heavy = || {
        let largest = weights.iter().fold(at_infinity, |m, &w| m.max(w));
        let value = format!("{} of the whole at one place", largest / total);
        let need = "points of less than half of the weight each, which do not coincide";
        Error::argument("largest weight", value, need)
    };
    if weights.iter().chain([&at_infinity]).any(|&w| w >= 0.5 * total) {
        return Err(heavy());
    }
    let cloud = Cloud { points, weights, at_infinity, total };
    let mut y = Similarity::IDENTITY;
    let mut seen = cloud.moments(&y);
    for _ in 0..MAX_STEPS {
        if norm(seen.mean) <= BALANCED {
            return Ok(y);
        }
        let Some(next) = cloud.step(&y, seen) else { break };
        (y, seen) = next;
    }
    // The sum has this many terms that are rounded, and p is rounded in units of t.
    let terms = points.len() as f64 + complex::norm(y.centre) / y.scale;
    if norm(seen.mean) <= ROUNDING_UNITS * f64::EPSILON * terms { Ok(y) } else { Err(heavy()) }
}

/// Weighted points of the sphere at infinity.
struct Cloud<'a> {
    points: &'a [[f64; 2]],
    weights: &'a [f64],
    at_infinity: f64,
    total: f64,
}

/// The mean and the second moments of the directions x in which a point of hyperbolic space sees a cloud.
#[derive(Clone, Copy)]
struct Moments {
    /// `Σ w x/Σ w`.
    mean: Vector,
    /// `Σ w x xᵀ/Σ w`, by rows.
    square: [Vector; 3],
}

impl Cloud<'_> {
    fn moments(&self, y: &Similarity) -> Moments {
        let (mut mean, mut square) = (scale(self.at_infinity, SOUTH), [[0.0; 3]; 3]);
        square[2][2] = self.at_infinity;
        for (z, w) in self.points.iter().zip(self.weights) {
            let x = lift(y.apply(*z));
            mean = add(mean, scale(*w, x));
            for (row, a) in square.iter_mut().zip(x) {
                row.iter_mut().zip(x).for_each(|(s, b)| *s += w * a * b);
            }
        }
        let share = 1.0 / self.total;
        Moments { mean: scale(share, mean), square: square.map(|row| scale(share, row)) }
    }

    /// A Newton step from `y`, halved until it leads to a lower or better balanced point; `None` where only rounding is left.
    fn step(&self, y: &Similarity, seen: Moments) -> Option<(Similarity, Moments)> {
        let step = newton(seen);
        let length = norm(step);
        if length <= BALANCED {
            return None;
        }
        let to = scale(1.0 / length, step);
        let mut distance = length.min(LONGEST_STEP);
        for _ in 0..MAX_HALVINGS {
            let next = y.towards(to, distance);
            let there = self.moments(&next);
            // The function still falls at the end of the step if the mean there points on along the step.
            let ahead = project(to).map_or(SOUTH, |z| lift(next.apply(y.before(z))));
            if dot(there.mean, ahead) >= 0.0 || norm(there.mean) < norm(seen.mean) {
                return Some((next, there));
            }
            distance *= 0.5;
        }
        None
    }
}

/// `(1 − square)⁻¹ mean`, or `mean` itself where the matrix is singular to rounding because all points are seen in one direction.
fn newton(Moments { mean, square }: Moments) -> Vector {
    let mut m = square.map(|row| row.map(|x| -x));
    (0..3).for_each(|k| m[k][k] += 1.0);
    let minor = |i: usize, j: usize| {
        let [a, b] = [(i + 1) % 3, (i + 2) % 3];
        let [c, d] = [(j + 1) % 3, (j + 2) % 3];
        m[a][c] * m[b][d] - m[a][d] * m[b][c]
    };
    let determinant = (0..3).map(|j| m[0][j] * minor(0, j)).sum::<f64>();
    let step = [0, 1, 2].map(|i| (0..3).map(|j| minor(j, i) * mean[j]).sum::<f64>() / determinant);
    if step.iter().all(|x| x.is_finite()) && dot(step, mean) > 0.0 { step } else { mean }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn residual(points: &[[f64; 2]], weights: &[f64], at_infinity: f64, y: &Similarity) -> f64 {
        let start = scale(at_infinity, SOUTH);
        norm(points.iter().zip(weights).fold(start, |sum, (z, w)| add(sum, scale(*w, lift(y.apply(*z))))))
    }

    #[test]
    fn the_vertices_of_a_cube_are_found_again_after_any_similarity() {
        let corners = (0..8u32).map(|k| [0, 1, 2].map(|i| if k >> i & 1 == 1 { 1.0 } else { -1.0 }));
        let cube: Vec<[f64; 2]> = corners.map(|x| project(scale(1.0 / 3f64.sqrt(), x)).unwrap()).collect();
        for (t, p) in [(1.0, [0.0, 0.0]), (1e-9, [0.3, 0.1]), (1e12, [-5.0, 1e3]), (3.0, [2e5, -7.0])] {
            let moved: Vec<[f64; 2]> = cube.iter().map(|z| [0, 1].map(|k| t * z[k] + p[k])).collect();
            let y = conformal_barycentre(&moved, &[1.0; 8], 0.0).unwrap_or_else(|e| panic!("{t} {p:?} {e}"));
            let rounding = 1e-15 * (1.0 + p[0].hypot(p[1]) / t);
            assert!((y.scale / t - 1.0).abs() < 10.0 * rounding, "{t} {p:?} {y:?}");
            assert!((y.centre[0] - p[0]).hypot(y.centre[1] - p[1]) < 10.0 * t * rounding);
        }
    }

    /// Three points and ∞ with equal weights form a regular ideal tetrahedron. Its centre is where, for an equilateral triangle with
    /// centre 0 and vertices at distance r, the lifts are at height (1 − r²/t²)/(1 + r²/t²) = 1/3: t = √2 r.
    #[test]
    fn an_equilateral_triangle_and_infinity() {
        let r = 5.0;
        let points = [0, 1, 2].map(|k| {
            let angle = 2.0 * std::f64::consts::PI * f64::from(k) / 3.0;
            [r * angle.cos(), r * angle.sin()]
        });
        let y = conformal_barycentre(&points, &[1.0; 3], 1.0).unwrap();
        assert!((y.scale - r * 2f64.sqrt()).abs() < 1e-13 && y.centre[0].hypot(y.centre[1]) < 1e-13);
    }

    #[test]
    fn residuals_are_at_rounding_for_points_over_sixty_orders_of_magnitude() {
        let points: Vec<[f64; 2]> = (0..400)
            .map(|k| {
                let (r, angle) = (10f64.powf(-30.0 + 0.15 * f64::from(k)), 2.4 * f64::from(k));
                [r * angle.cos(), r * angle.sin()]
            })
            .collect();
        for heavy in [0, 100, 399] {
            let weights: Vec<f64> = (0..400).map(|k| if k == heavy { 300.0 } else { 1.0 }).collect();
            let y = conformal_barycentre(&points, &weights, 10.0).unwrap();
            assert!(residual(&points, &weights, 10.0, &y) < 1e-11, "{heavy}");
        }
    }

    #[test]
    fn half_of_the_weight_has_no_barycentre() {
        let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        assert!(conformal_barycentre(&points, &[2.0, 1.0, 1.0], 0.0).is_err());
        assert!(conformal_barycentre(&points, &[1.0, 1.0, 1.0], 3.0).is_err());
        assert!(conformal_barycentre(&[points[0], points[0], points[1]], &[1.0; 3], 0.5).is_err());
        assert!(conformal_barycentre(&points, &[1.0, f64::NAN, 1.0], 0.0).is_err());
        assert!(conformal_barycentre(&points, &[1.0, 1.0, -0.1], 0.0).is_err());
        assert!(conformal_barycentre(&points, &[1.0; 2], 0.0).is_err());
        assert!(conformal_barycentre(&points, &[1.0; 3], 0.0).is_ok());
    }
}
