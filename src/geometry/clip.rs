//! Polygons cut by half-planes, by the algorithm of Sutherland and Hodgman.
//!
//! ```
//! use ricci::geometry::clip::{clip, in_box};
//! let square = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
//! assert_eq!(clip(&square, |p| 1.0 - p[0]), [[0.0, 0.0], [1.0, 0.0], [1.0, 2.0], [0.0, 2.0]]);
//! assert!(in_box(&square, [[3.0, 0.0], [4.0, 1.0]]).is_empty());
//! ```

/// The part of a closed polygon where a function is not negative that is linear along its sides; `between`: the corner at a share of the
/// way from one corner to the next, where the function is 0. Several pieces are joined by lines that run there and back and so fill
/// nothing.
pub fn clip_by<P: Copy>(
    polygon: &[P],
    side: impl Fn(&P) -> f64,
    between: impl Fn(&P, &P, f64) -> P,
) -> Vec<P> {
    let mut part = Vec::new();
    for (k, p) in polygon.iter().enumerate() {
        let q = &polygon[(k + 1) % polygon.len()];
        let (s, t) = (side(p), side(q));
        if s >= 0.0 {
            part.push(*p);
        }
        if s * t < 0.0 {
            part.push(between(p, q, s / (s - t)));
        }
    }
    part
}

/// The part of a closed polygon where an affine function of its points is not negative ([`clip_by`]).
pub fn clip<const N: usize>(polygon: &[[f64; N]], side: impl Fn(&[f64; N]) -> f64) -> Vec<[f64; N]> {
    clip_by(polygon, side, |p, q, share| std::array::from_fn(|i| p[i] + share * (q[i] - p[i])))
}

/// The part of a polygon between two values of a coordinate.
pub fn strip<const N: usize>(polygon: &[[f64; N]], axis: usize, [low, high]: [f64; 2]) -> Vec<[f64; N]> {
    clip(&clip(polygon, |p| p[axis] - low), |p| high - p[axis])
}

/// The part of a polygon in a box of the plane of the first two coordinates.
pub fn in_box<const N: usize>(polygon: &[[f64; N]], [low, high]: [[f64; 2]; 2]) -> Vec<[f64; N]> {
    strip(&strip(polygon, 0, [low[0], high[0]]), 1, [low[1], high[1]])
}

/// The part of a segment in a box; ends inside stay as they are, so that neighbours still meet there.
pub fn segment_in_box(ends: [[f64; 2]; 2], bounds: [[f64; 2]; 2]) -> Option<[[f64; 2]; 2]> {
    // As a polygon it runs there and back.
    in_box(&ends, bounds).first_chunk().copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn segments_end_at_the_box() {
        let frame = [[0.0, 0.0], [10.0, 5.0]];
        assert_eq!(segment_in_box([[-5.0, 1.0], [5.0, 1.0]], frame), Some([[0.0, 1.0], [5.0, 1.0]]));
        assert_eq!(segment_in_box([[-5.0, 9.0], [5.0, 9.0]], frame), None);
        assert_eq!(segment_in_box([[3.0, 3.0], [3.0, 3.0]], frame), Some([[3.0, 3.0], [3.0, 3.0]]));
    }
}
