//! The angles and the area of a plane triangle, from the lengths of its sides.

use super::triangle::half_differences;

/// The angles and the area of a plane triangle; corner k lies opposite side k.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PlaneTriangle {
    /// `[cos, sin]` of the angle at each corner.
    pub direction: [[f64; 2]; 3],
    pub area: f64,
    /// The part of the longest side by which it exceeds the sum of the others; 0 if it does not exceed it.
    pub excess: f64,
}

impl PlaneTriangle {
    /// The triangle with these positive side lengths. If it is degenerate or breaks the triangle inequality, its angles are (π, 0, 0) and
    /// its area is 0.
    ///
    /// With `s` and `r_k = s − l_k` formed without cancellation ([`half_differences`]), `cos θ_k ∝ s r_k − r_i r_j` and
    /// `sin θ_k ∝ 2·area` with the same factor `1/(s r_k + r_i r_j) = 1/(l_i l_j)` (half-angle law).
    pub(crate) fn from_sides(sides: [f64; 3]) -> PlaneTriangle {
        PlaneTriangle::from_differences(half_differences(sides))
    }

    /// The triangle with these half-perimeter differences `r_k = s − l_k`.
    pub(crate) fn from_differences(r: [f64; 3]) -> PlaneTriangle {
        let (r, unit) = in_longest(r);
        let excess = excess(r);
        let (s, r) = (r[0] + r[1] + r[2], r.map(|x| x.max(0.0)));
        let area = area(s, r);
        let direction = std::array::from_fn(|k| direction(s, r, area, k));
        PlaneTriangle { direction, area: area * unit * unit, excess }
    }

    /// `[cos, sin]` of the angle at corner k alone, and the excess.
    pub(crate) fn direction_at(sides: [f64; 3], k: usize) -> ([f64; 2], f64) {
        let (r, _) = in_longest(half_differences(sides));
        let excess = excess(r);
        let (s, r) = (r[0] + r[1] + r[2], r.map(|x| x.max(0.0)));
        (direction(s, r, area(s, r), k), excess)
    }
}

/// The half-perimeter differences in units of the longest side, and that side.
fn in_longest(r: [f64; 3]) -> ([f64; 3], f64) {
    let longest = r[0] + r[1] + r[2] - r.into_iter().fold(f64::INFINITY, f64::min);
    (r.map(|x| x / longest), longest)
}

fn excess(r: [f64; 3]) -> f64 {
    r.into_iter().fold(0.0, |m, x| f64::max(m, -2.0 * x))
}

/// The area, from half the perimeter `s` and differences that are not negative.
fn area(s: f64, r: [f64; 3]) -> f64 {
    let square = s * r[0] * r[1] * r[2];
    if square > LEAST_SQUARE {
        return square.sqrt();
    }
    let root = r.map(f64::sqrt);
    s.sqrt() * root[0] * root[1] * root[2] // the roots first: r_i r_j may underflow
}

/// Least product `s r_0 r_1 r_2`, in units of the longest side, whose partial products surely do not underflow.
const LEAST_SQUARE: f64 = 1e-280;

fn direction(s: f64, r: [f64; 3], area: f64, k: usize) -> [f64; 2] {
    let (far, near) = (s * r[k], r[(k + 1) % 3] * r[(k + 2) % 3]);
    let norm = far + near;
    if norm > 0.0 { [(far - near) / norm, 2.0 * area / norm] } else { [1.0, 0.0] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn angles(sides: [f64; 3]) -> [f64; 3] {
        PlaneTriangle::from_sides(sides).direction.map(|[c, s]| s.atan2(c))
    }

    #[test]
    fn right_triangle_has_its_angles_and_area_in_any_order_and_scale() {
        for scale in [1.0, 1e-12, 1e12] {
            let sides = [3.0 * scale, 4.0 * scale, 5.0 * scale];
            let [a, b, c] = angles(sides);
            assert!((a - 0.6_f64.asin()).abs() < 1e-15 && (b - 0.8_f64.asin()).abs() < 1e-15);
            assert!((c - PI / 2.0).abs() < 1e-15);
            let area = PlaneTriangle::from_sides([sides[2], sides[0], sides[1]]).area;
            assert!((area / (6.0 * scale * scale) - 1.0).abs() < 1e-15);
        }
    }

    #[test]
    fn needle_keeps_its_small_angle_to_full_relative_precision() {
        for c in [1e-8, 1e-15, 1e-300] {
            let [a, b, small] = angles([1.0, 1.0, c]);
            assert!((small / c - 1.0).abs() < 1e-15, "{small}");
            assert!((a - PI / 2.0).abs() < 1e-8 && (b - PI / 2.0).abs() < 1e-8);
        }
    }

    #[test]
    fn degenerate_and_broken_triangles_are_flat_and_only_the_broken_one_has_an_excess() {
        assert_eq!(angles([2.0, 1.0, 1.0]), [PI, 0.0, 0.0]);
        assert_eq!(PlaneTriangle::from_sides([2.0, 1.0, 1.0]).excess, 0.0);
        assert_eq!(angles([1.0, 4.0, 1.0]), [0.0, PI, 0.0]);
        assert_eq!(PlaneTriangle::from_sides([1.0, 4.0, 1.0]).excess, 0.5);
    }
}
