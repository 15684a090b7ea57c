//! The order of the basis functions of a patch: multi-indices.

/// Largest degree of a spline. A patch has 3 (n + 1) knots, and sets of them are numbered by the bits of a u32.
pub const MAX_DEGREE: usize = 5;

/// The multi-indices β with |β| = n, β ≥ 0, in the order (n,0,0), (n−1,1,0), (n−1,0,1), (n−2,2,0), …
///
/// ```
/// use ricci::spline::multi_indices;
/// assert_eq!(multi_indices(1).collect::<Vec<_>>(), [[1, 0, 0], [0, 1, 0], [0, 0, 1]]);
/// assert_eq!(multi_indices(3).count(), 10);
/// ```
pub fn multi_indices(degree: usize) -> impl Iterator<Item = [usize; 3]> {
    (0..=degree).rev().flat_map(move |i| (0..=degree - i).rev().map(move |j| [i, j, degree - i - j]))
}

/// The number of basis functions of a patch, (n + 1)(n + 2)/2.
pub fn basis_size(degree: usize) -> usize {
    (degree + 1) * (degree + 2) / 2
}

/// The position of β in the [`multi_indices`] of its degree.
pub(super) fn position([i, j, k]: [usize; 3]) -> usize {
    let below = j + k;
    debug_assert!(i + below <= MAX_DEGREE);
    below * (below + 1) / 2 + k
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_count_the_multi_indices() {
        for degree in 0..=MAX_DEGREE {
            assert_eq!(multi_indices(degree).count(), basis_size(degree));
            assert!(multi_indices(degree).enumerate().all(|(at, beta)| position(beta) == at));
        }
    }
}
