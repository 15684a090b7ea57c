//! How far corners can move along a straight line before the first triangle loses its area.

use crate::geometry::complex::{cross, sub};

/// The least t > 0 at which the triangle with corners p + t d has no area; infinite if there is none. The area is a quadratic function of t
/// [SS15, Section 3.3], whose roots are found without cancellation.
pub(super) fn time_to_flat(p: [[f64; 2]; 3], d: [[f64; 2]; 3]) -> f64 {
    let ([u, v], [du, dv]) = ([sub(p[1], p[0]), sub(p[2], p[0])], [sub(d[1], d[0]), sub(d[2], d[0])]);
    least_positive_root(cross(u, v), cross(du, v) + cross(u, dv), cross(du, dv))
}

/// The least positive root of `c + b t + a t²` for c > 0; infinite if there is none, 0 for coefficients that are no numbers.
fn least_positive_root(c: f64, b: f64, a: f64) -> f64 {
    if (b * b - 4.0 * a * c).is_nan() {
        return 0.0;
    }
    positive_roots(c, b, a).into_iter().fold(f64::INFINITY, f64::min)
}

/// The positive roots of `c + b t + a t²`; infinite in place of those that there are not.
pub(super) fn positive_roots(c: f64, b: f64, a: f64) -> [f64; 2] {
    let under = b * b - 4.0 * a * c;
    let q = -0.5 * (b + b.signum() * under.sqrt());
    [q / a, c / q].map(|t| if t > 0.0 { t } else { f64::INFINITY })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_area_is_gone_at_the_first_positive_root() {
        let p = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        let moving = |d: [f64; 2]| time_to_flat(p, [[0.0; 2], [0.0; 2], d]);
        assert_eq!(
            (moving([0.0, -2.0]), moving([0.0, 2.0]), moving([3.0, 0.0])),
            (0.5, f64::INFINITY, f64::INFINITY)
        );
        // (1 − t)(1 − 2 t), (1 + t)(1 − 4 t), and one without a root.
        let shrinking = |a: f64, b: f64| time_to_flat(p, [[0.0; 2], [-a, 0.0], [0.0, -b]]);
        assert_eq!((shrinking(1.0, 2.0), shrinking(-1.0, 4.0)), (0.5, 0.25));
        assert_eq!(time_to_flat(p, [[0.0; 2], [0.0, 1.0], [-1.0, 0.0]]), f64::INFINITY);
        // The linear term all but cancels the root: 1 − t + 1e-20 t².
        assert_eq!(least_positive_root(1.0, -1.0, 1e-20), 1.0);
    }
}
