//! The noise of a target, as it shows in what a fit leaves: what changes from vertex to vertex is noise, not shape that the spline misses.

use std::collections::BTreeMap;

/// The median of the absolute value of a normal distribution, over its standard deviation.
const NORMAL_MEDIAN: f64 = 0.674_489_750_196_081_7;

/// The standard deviation of the noise of heights over a surface, from their differences from the means of their neighbours: their median, so
/// that places which the surface misses do not count. 0 without neighbours.
pub(super) fn noise_of(heights: &BTreeMap<u32, f64>, edges: &[[u32; 2]]) -> f64 {
    let mut sums: BTreeMap<u32, (f64, f64)> = BTreeMap::new();
    for &[a, b] in edges {
        let (Some(at_a), Some(at_b)) = (heights.get(&a), heights.get(&b)) else { continue };
        for (v, other) in [(a, at_b), (b, at_a)] {
            let (sum, count) = sums.entry(v).or_default();
            (*sum, *count) = (*sum + other, *count + 1.0);
        }
    }
    // The mean of k neighbours has a variance of a k-th of that of each.
    let over_deviation = |(v, (sum, count)): (&u32, &(f64, f64))| {
        heights.get(v).map(|height| (height - sum / count).abs() / (1.0 + 1.0 / count).sqrt())
    };
    let mut sizes: Vec<f64> = sums.iter().filter_map(over_deviation).collect();
    if sizes.is_empty() {
        return 0.0;
    }
    let middle = sizes.len() / 2;
    *sizes.select_nth_unstable_by(middle, f64::total_cmp).1 / NORMAL_MEDIAN
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::random::SplitMix64;

    /// A grid of heights, and its edges along both directions and one diagonal.
    fn grid(height: &mut dyn FnMut(usize, usize) -> f64) -> (BTreeMap<u32, f64>, Vec<[u32; 2]>) {
        let n = 60usize;
        let number = |i: usize, j: usize| (i * n + j) as u32;
        let (mut heights, mut edges) = (BTreeMap::new(), Vec::new());
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            heights.insert(number(i, j), height(i, j));
            for (k, l) in [(i + 1, j), (i, j + 1), (i + 1, j + 1)] {
                if k < n && l < n {
                    edges.push([number(i, j), number(k, l)]);
                }
            }
        }
        (heights, edges)
    }

    #[test]
    fn noise_is_found_beside_a_shape_that_the_surface_misses() {
        let mut random = SplitMix64::new(7);
        // The sum of twelve numbers from 0 to 1 has variance 1.
        let mut deviate = || (0..12).map(|_| random.unit()).sum::<f64>() - 6.0;
        let wave = |i: usize, j: usize| (0.1 * i as f64).sin() + if i < 6 { 3.0 * j as f64 } else { 0.0 };
        let (heights, edges) = grid(&mut |i, j| wave(i, j) + 0.2 * deviate());
        assert!((noise_of(&heights, &edges) - 0.2).abs() < 0.02, "{}", noise_of(&heights, &edges));
    }

    #[test]
    fn a_slope_is_no_noise() {
        let (heights, edges) = grid(&mut |i, j| 2.0 * i as f64 - 3.0 * j as f64);
        assert!(noise_of(&heights, &edges) < 1e-12);
        assert_eq!(noise_of(&heights, &[]), 0.0);
    }
}
