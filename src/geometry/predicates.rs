//! Exact geometric predicates (Shewchuk's adaptive arithmetic, crate `robust`).
//!
//! ```
//! use ricci::geometry::predicates::orientation;
//! use std::cmp::Ordering;
//! // One rounding off the diagonal.
//! assert_eq!(orientation([0.5, 0.5], [12.0, 12.0], [24.0, 24f64.next_up()]), Ordering::Greater);
//! ```

use robust::{Coord, Coord3D, orient2d, orient3d};
use std::cmp::Ordering;

/// Largest coordinate of triangles that are first multiplied by [`LIFT`]: products of their coordinates, below 1e-240, could lose digits
/// to underflow.
const TINY: f64 = 1.0e-120;
/// 2⁵¹² = 1.3e154, which brings such coordinates back near 1; multiplying by a power of two is exact.
const LIFT: f64 = f64::from_bits((1023 + 512) << 52);

/// Bound on the relative error of a determinant of two rows of f64: above (3 + 16 ε) ε with ε = 2⁻⁵³ of \[She97, ccwerrboundA\].
const SURE: f64 = 4.0 * f64::EPSILON;

/// The side of the directed line ab on which the point c lies: `Greater` left (a, b, c counterclockwise), `Equal` on the line, `Less`
/// right [She97, ORIENT2D].
///
/// Exact for finite coordinates as long as products of coordinate differences neither overflow nor underflow;
/// triangles that are tiny as a whole (all coordinates below 1e-120) are scaled by a power of two first.
pub fn orientation(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> Ordering {
    let largest = [a, b, c].as_flattened().iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let scale = if largest < TINY { LIFT } else { 1.0 };
    let [a, b, c] = [a, b, c].map(|p| Coord { x: scale * p[0], y: scale * p[1] });
    let (there, back) = ((a.x - c.x) * (b.y - c.y), (a.y - c.y) * (b.x - c.x));
    if (there - back).abs() > SURE * (there.abs() + back.abs()) {
        return if there > back { Ordering::Greater } else { Ordering::Less };
    }
    let signed = orient2d(a, b, c);
    if signed > 0.0 {
        Ordering::Greater
    } else if signed < 0.0 {
        Ordering::Less
    } else {
        Ordering::Equal
    }
}

/// The sign of the determinant of three vectors: `Greater` if they run counterclockwise about the origin for a viewer at their ends
/// [She97, ORIENT3D]. Exact for finite coordinates whose products neither overflow nor underflow.
pub fn winding(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> Ordering {
    let [a, b, c, o] = [a, b, c, [0.0; 3]].map(|[x, y, z]| Coord3D { x, y, z });
    let signed = orient3d(a, b, c, o);
    (signed > 0.0).cmp(&(signed < 0.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orientation_is_exact_one_ulp_off_a_line() {
        let (a, b) = ([0.5, 0.5], [12.0, 12.0]);
        let on = [24.0, 24.0];
        let above = [24.0, 24.0_f64.next_up()];
        let below = [24.0, 24.0_f64.next_down()];
        assert_eq!(orientation(a, b, on), Ordering::Equal);
        assert_eq!(orientation(a, b, above), Ordering::Greater);
        assert_eq!(orientation(a, b, below), Ordering::Less);
    }

    #[test]
    fn winding_is_that_of_the_images_in_a_plane_and_exact() {
        let up = |[x, y]: [f64; 2]| [3.0 * x, 3.0 * y, 3.0];
        let (a, b) = ([0.5, 0.5], [12.0, 12.0]);
        for (c, expected) in [
            ([24.0, 24.0], Ordering::Equal),
            ([24.0, 24.0_f64.next_up()], Ordering::Greater),
            ([24.0, 24.0_f64.next_down()], Ordering::Less),
        ] {
            let [p, q] = [a, b].map(|[x, y]| [x, y, 1.0]);
            assert_eq!(winding(p, q, [c[0], c[1], 1.0]), expected);
        }
        assert_eq!(winding(up([0.0, 0.0]), up([1.0, 0.0]), up([0.0, 1.0])), Ordering::Greater);
        assert_eq!(winding([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]), Ordering::Equal);
    }

    #[test]
    fn orientation_survives_products_that_underflow() {
        let s = 1e-200;
        assert_eq!(orientation([0.0, 0.0], [s, 0.0], [0.0, s]), Ordering::Greater);
        assert_eq!(orientation([0.0, 0.0], [0.0, s], [s, 0.0]), Ordering::Less);
        assert_eq!(orientation([0.0, 0.0], [-0.0, s], [0.0, -s]), Ordering::Equal);
    }
}
