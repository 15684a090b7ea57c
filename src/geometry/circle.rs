//! Circles of a circle pattern in the plane: the circle orthogonal to the three vertex circles of a triangle.
//!
//! A vertex circle has centre p, radius γ > 0 and type ε: a real circle (ε = 1), a point (ε = 0) or a circle of
//! imaginary radius (ε = −1). The power of a point x with respect to it is `|x − p|² − ε γ²`.
//!
//! ```
//! use ricci::geometry::circle::power_circle;
//! let triangle = [[0.0, 0.0], [3.0, 0.0], [0.0, 4.0]];
//! let circumcircle = power_circle(triangle, [0; 3], [0.0; 3]).unwrap();
//! assert_eq!((circumcircle.centre, circumcircle.power.sqrt()), ([1.5, 2.0], 2.5));
//! ```

use super::complex::{add, cross, norm2, sub};

/// A point with equal power to three circles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PowerCircle {
    /// The power centre.
    pub centre: [f64; 2],
    /// The common power: the squared radius of the circle about `centre` that is orthogonal to the real vertex circles,
    /// passes through the points among them, and meets those of imaginary radius in diameters. Where it is negative
    /// there is no such real circle.
    pub power: f64,
}

/// The power centre of three circles and its power.
///
/// `centres`: corners of the triangle; `epsilon` ∈ {−1, 0, 1} and `radii` per corner. ε = 0 everywhere gives the
/// circumcircle. `None` when the centres are collinear.
///
/// With origin `p_0`, `a = p_1 − p_0`, `b = p_2 − p_0`, equal powers mean `2⟨a, x⟩ = |a|² − ε_1γ_1² + ε_0γ_0²` and the
/// like for b. [JKLLG08, §4.1: the circle orthogonal to the three vertex circles of a face].
pub fn power_circle(centres: [[f64; 2]; 3], epsilon: [i8; 3], radii: [f64; 3]) -> Option<PowerCircle> {
    let [p, q, r] = centres;
    let (a, b) = (sub(q, p), sub(r, p));
    let s: [f64; 3] = std::array::from_fn(|i| f64::from(epsilon[i]) * radii[i] * radii[i]);
    let f = 0.5 * (norm2(a) - s[1] + s[0]);
    let g = 0.5 * (norm2(b) - s[2] + s[0]);
    let det = cross(a, b);
    let x = [(f * b[1] - g * a[1]) / det, (g * a[0] - f * b[0]) / det];
    let circle = PowerCircle { centre: add(p, x), power: norm2(x) - s[0] };
    (circle.power.is_finite() && circle.centre.iter().all(|c| c.is_finite())).then_some(circle)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TRIANGLE: [[f64; 2]; 3] = [[0.1, 0.2], [1.3, -0.1], [0.6, 1.1]];

    fn distance2(a: [f64; 2], b: [f64; 2]) -> f64 {
        (a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2)
    }

    #[test]
    fn the_dual_circle_is_orthogonal_to_the_vertex_circles() {
        for (epsilon, radii) in
            [([1, 1, 1], [0.5, 0.4, 0.6]), ([1, 0, -1], [0.3, 9.0, 0.2]), ([-1; 3], [0.4, 0.1, 0.2])]
        {
            let dual = power_circle(TRIANGLE, epsilon, radii).unwrap();
            for i in 0..3 {
                // Orthogonal circles: d² = R² + r², r² = εγ².
                let r2 = f64::from(epsilon[i]) * radii[i] * radii[i];
                assert!((distance2(dual.centre, TRIANGLE[i]) - dual.power - r2).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn tangential_circles_have_the_incircle_as_dual() {
        let side = |i: usize, j: usize| distance2(TRIANGLE[i], TRIANGLE[j]).sqrt();
        let (a, b, c) = (side(1, 2), side(2, 0), side(0, 1));
        let s = 0.5 * (a + b + c);
        let dual = power_circle(TRIANGLE, [1; 3], [s - a, s - b, s - c]).unwrap();
        let inradius2 = (s - a) * (s - b) * (s - c) / s;
        assert!((dual.power - inradius2).abs() < 1e-14);
    }

    #[test]
    fn points_have_the_circumcircle_as_dual() {
        let dual = power_circle([[0.0, 0.0], [3.0, 0.0], [0.0, 4.0]], [0; 3], [7.0; 3]).unwrap();
        assert_eq!(dual, PowerCircle { centre: [1.5, 2.0], power: 6.25 });
    }

    #[test]
    fn large_vertex_circles_leave_no_real_dual_circle_and_a_line_no_centre() {
        assert!(power_circle(TRIANGLE, [1; 3], [2.0; 3]).unwrap().power < 0.0);
        assert_eq!(power_circle([[0.0, 0.0], [1.0, 1.0], [3.0, 3.0]], [0; 3], [1.0; 3]), None);
    }
}
