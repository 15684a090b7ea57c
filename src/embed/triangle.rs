//! A plane triangle from its side lengths.

/// Angles and area of the triangle with given sides; corner k lies opposite side k.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Triangle {
    /// `[cos, sin]` of the angle at each corner.
    pub direction: [[f64; 2]; 3],
    /// Area.
    pub area: f64,
}

impl Triangle {
    /// From positive side lengths. `Err` holds by how much the longest side exceeds the sum of the others, relative to
    /// it. A degenerate triangle is one: angles (π, 0, 0), area 0.
    ///
    /// Sums are formed from the sorted sides so that nothing cancels [Kah14, §2]: with `a ≥ b ≥ c`,
    /// `2(s−a) = c − (a−b)`. Then `cos θ_k = (s(s−l_k) − (s−l_i)(s−l_j)) / (l_i l_j)` (half-angle law), and
    /// `sin θ_k = 2·area / (l_i l_j)`.
    pub(crate) fn from_sides(sides: [f64; 3]) -> Result<Triangle, f64> {
        let mut order = [0, 1, 2];
        order.sort_by(|&i, &j| sides[j].total_cmp(&sides[i]));
        let unit = sides[order[0]];
        let [a, b, c] = order.map(|k| sides[k] / unit);
        let perimeter = a + (b + c);
        let mut deficit = [0.0; 3]; // 2(s − l_k)
        deficit[order[0]] = c - (a - b);
        deficit[order[1]] = c + (a - b);
        deficit[order[2]] = a + (b - c);
        if deficit[order[0]] < 0.0 {
            return Err(-deficit[order[0]]);
        }
        let root = deficit.map(f64::sqrt);
        let four_areas = perimeter.sqrt() * root[0] * root[1] * root[2];
        let direction = std::array::from_fn(|k| {
            let (far, near) = (perimeter * deficit[k], deficit[(k + 1) % 3] * deficit[(k + 2) % 3]);
            let (x, y) = (far - near, 2.0 * four_areas);
            let norm = x.hypot(y);
            if norm > 0.0 { [x / norm, y / norm] } else { [1.0, 0.0] }
        });
        Ok(Triangle { direction, area: 0.25 * four_areas * unit * unit })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn angles(sides: [f64; 3]) -> [f64; 3] {
        Triangle::from_sides(sides).unwrap().direction.map(|[c, s]| s.atan2(c))
    }

    #[test]
    fn right_triangle_has_its_angles_and_area_in_any_order_and_scale() {
        for scale in [1.0, 1e-12, 1e12] {
            let sides = [3.0 * scale, 4.0 * scale, 5.0 * scale];
            let [a, b, c] = angles(sides);
            assert!((a - 0.6_f64.asin()).abs() < 1e-15 && (b - 0.8_f64.asin()).abs() < 1e-15);
            assert!((c - PI / 2.0).abs() < 1e-15);
            let area = Triangle::from_sides([sides[2], sides[0], sides[1]]).unwrap().area;
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
    fn degenerate_triangle_is_flat_and_a_broken_one_is_refused_with_its_excess() {
        assert_eq!(angles([2.0, 1.0, 1.0]), [PI, 0.0, 0.0]);
        assert_eq!(Triangle::from_sides([1.0, 4.0, 1.0]).unwrap_err(), 0.5);
    }
}
