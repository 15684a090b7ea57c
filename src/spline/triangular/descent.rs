//! The nearest point of a smooth surface over a triangle or another convex polygon, from a start, by Newton's method on half the squared
//! distance.

use super::point::SurfacePoint;
use crate::error::Result;
use crate::geometry::complex::{Complex, add, distance, dot, doubled_area, norm, scale, sub};
use crate::geometry::vector::{self, Vector};

/// Most steps from one start. Newton's method takes 3 to 6; more are needed for starts on the wrong side of a ridge.
const STEPS: u32 = 60;
/// Most halvings of a step.
const HALVINGS: usize = 40;
/// Share of the predicted decrease that a step must reach to be accepted.
const DECREASE: f64 = 1e-4;
/// Share of the value below which a predicted decrease is rounding, and the step is accepted without a test.
const ROUNDING: f64 = 1e-12;
/// Length of the last step, over the polygon's longest side. Steps square the error, so the error left is rounding.
const SHORT: f64 = 1e-11;
/// Least determinant of the second derivative, over that of a flat surface, at which Newton's step is taken.
const LEAST: f64 = 1e-8;

/// The end of a descent.
#[derive(Debug, Clone, Copy)]
pub(in crate::spline) struct DescentEnd {
    pub at: Complex,
    /// Distance between the target and the surface there.
    pub distance: f64,
    /// Number of steps made.
    pub steps: u32,
}

/// True if half the squared distance to a target has a positive definite second derivative at a point of the surface.
pub(in crate::spline) fn is_convex(at: &SurfacePoint, target: Vector) -> bool {
    QuadraticModel::new(at, vector::sub(at.point, target)).is_exact
}

/// The quadratic model of half the squared distance near a place: its gradient, and a positive definite second derivative xx, xy, yy.
struct QuadraticModel {
    gradient: [f64; 2],
    second: [f64; 3],
    is_exact: bool,
}

impl QuadraticModel {
    /// The model at a surface point, with `miss` = surface point − target. The second derivative is exact if that is positive definite, and
    /// that of a flat surface otherwise (Gauss–Newton).
    fn new(SurfacePoint { first: [x, y], second, .. }: &SurfacePoint, miss: Vector) -> QuadraticModel {
        let flat = [vector::dot(*x, *x), vector::dot(*x, *y), vector::dot(*y, *y)];
        let bent: [f64; 3] = std::array::from_fn(|k| flat[k] + vector::dot(second[k], miss));
        let det = |[a, b, c]: [f64; 3]| a * c - b * b;
        let is_exact = bent[0] > 0.0 && det(bent) > LEAST * det(flat).max(bent[1] * bent[1]);
        let second = if is_exact { bent } else { flat };
        QuadraticModel { gradient: [vector::dot(*x, miss), vector::dot(*y, miss)], second, is_exact }
    }

    fn times(&self, s: Complex) -> Complex {
        let [a, b, c] = self.second;
        [a * s[0] + b * s[1], b * s[0] + c * s[1]]
    }

    /// The decrease of the model by a step.
    fn decrease(&self, step: Complex) -> f64 {
        -dot(self.gradient, step) - 0.5 * dot(step, self.times(step))
    }

    /// The step to the least value of the model in a convex polygon, whose corners are given relative to the place, counterclockwise.
    fn step(&self, corners: &[Complex]) -> Complex {
        let ([a, b, c], [p, q]) = (self.second, self.gradient);
        let det = a * c - b * b;
        let newton = [(b * q - c * p) / det, (b * p - a * q) / det];
        let side = |k: usize| [corners[k], corners[(k + 1) % corners.len()]];
        let far = corners.iter().map(|&corner| norm(corner)).fold(0.0, f64::max);
        if det > LEAST * (a * c)
            && norm(newton) <= far
            && (0..corners.len()).all(|k| doubled_area([newton, side(k)[0], side(k)[1]]) >= 0.0)
        {
            return newton;
        }
        let on_side = |k: usize| {
            let [from, to] = side(k);
            let along = sub(to, from);
            let (slope, bend) =
                (dot(add(self.gradient, self.times(from)), along), dot(along, self.times(along)));
            let share = if bend > 0.0 { -slope / bend } else { f64::from(slope < 0.0) };
            add(from, scale(share.clamp(0.0, 1.0), along))
        };
        let steps = (0..corners.len()).map(on_side);
        steps.max_by(|s, t| self.decrease(*s).total_cmp(&self.decrease(*t))).unwrap_or([0.0; 2])
    }
}

/// Descends from a start in a counterclockwise convex polygon, with the surface there, to a place in it at which the distance of the
/// surface from the target has a local minimum. `surface` gives the point at a place with first and second derivatives. Except for
/// rounding, the distance is not larger than at the start.
pub(in crate::spline) fn descend<const N: usize>(
    corners: [Complex; N],
    (mut at, mut here): (Complex, SurfacePoint),
    target: Vector,
    mut surface: impl FnMut(Complex) -> Result<SurfacePoint>,
) -> Result<DescentEnd> {
    let half_square = |p: Vector| 0.5 * vector::dot(vector::sub(p, target), vector::sub(p, target));
    let size = (0..N).map(|k| distance(corners[k], corners[(k + 1) % N])).fold(0.0, f64::max);
    let mut value = half_square(here.point);
    let mut steps = 0;
    while steps < STEPS {
        let model = QuadraticModel::new(&here, vector::sub(here.point, target));
        let step = model.step(&corners.map(|c| sub(c, at)));
        let decrease = model.decrease(step);
        if decrease.is_nan() || decrease <= 0.0 {
            break;
        }
        steps += 1;
        let mut share = 1.0;
        for _ in 0..HALVINGS {
            let next = add(at, scale(share, step));
            let there = surface(next)?;
            let reached = half_square(there.point);
            if reached <= value - DECREASE * share * decrease || decrease <= ROUNDING * value {
                (at, here, value) = (next, there, reached);
                break;
            }
            share *= 0.5;
        }
        if norm(step) <= SHORT * size {
            break;
        }
    }
    Ok(DescentEnd { at, distance: vector::distance(here.point, target), steps })
}
