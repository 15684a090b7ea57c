//! Rectangles side by side in rows, none scaled or turned.
//!
//! ```
//! use ricci::geometry::row_packing::in_rows;
//! let corners = in_rows(&[[1.0, 1.0], [2.0, 3.0], [1.0, 2.0]]);
//! assert_eq!(corners[1], [0.0, 0.0]); // the highest comes first
//! ```

/// Distance of neighbours, in units of the longest side of all rectangles.
const GAP: f64 = 0.02;
/// Width of a row, in units of the side of the square with the area of all rectangles.
const ROW: f64 = 1.2;

/// The lower left corner of each rectangle of these widths and heights: in rows from the highest to the lowest, the whole about as wide as
/// high.
pub fn in_rows(sizes: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let longest = sizes.as_flattened().iter().fold(0.0, |m: f64, &x| m.max(x));
    let gap = GAP * longest;
    let area: f64 = sizes.iter().map(|[w, h]| (w + gap) * (h + gap)).sum();
    let width = sizes.iter().fold(ROW * area.sqrt(), |m, [w, _]| m.max(*w));
    let mut order: Vec<usize> = (0..sizes.len()).collect();
    order.sort_by(|&a, &b| sizes[b][1].total_cmp(&sizes[a][1]).then(a.cmp(&b)));
    let mut corners = vec![[0.0; 2]; sizes.len()];
    let ([mut x, mut y], mut highest) = ([0.0, 0.0], 0.0);
    for k in order {
        let [w, h] = sizes[k];
        if x > 0.0 && x + w > width {
            (x, y, highest) = (0.0, y + highest + gap, 0.0);
        }
        corners[k] = [x, y];
        x += w + gap;
        highest = f64::max(highest, h);
    }
    corners
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::random::SplitMix64;

    #[test]
    fn no_two_rectangles_meet() {
        let mut random = SplitMix64::new(3);
        let sizes: Vec<[f64; 2]> =
            (0..60).map(|_| [0.01 + random.unit().powi(3), 0.01 + random.unit()]).collect();
        let corners = in_rows(&sizes);
        for i in 0..60 {
            for j in 0..i {
                let apart = |k: usize| {
                    corners[i][k] >= corners[j][k] + sizes[j][k]
                        || corners[j][k] >= corners[i][k] + sizes[i][k]
                };
                assert!(apart(0) || apart(1), "{i} and {j}");
            }
        }
        let extent = |k: usize| (0..60).map(|i| corners[i][k] + sizes[i][k]).fold(0.0, f64::max);
        let used: f64 = sizes.iter().map(|[w, h]| w * h).sum();
        assert!(used > 0.5 * extent(0) * extent(1));
        assert!(in_rows(&[]).is_empty());
    }
}
