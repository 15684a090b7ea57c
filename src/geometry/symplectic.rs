//! Symplectic bases of integer lattices.
//!
//! ```
//! use ricci::geometry::symplectic::symplectic_basis;
//! // Two curves that meet once: the intersection number of the first with the second is −1.
//! let basis = symplectic_basis(&[vec![0, -1], vec![1, 0]]).unwrap();
//! assert_eq!(basis, [[1, 0], [0, -1]]);
//! ```

/// A basis a_1 … a_g, b_1 … b_g of ℤ^{2g} with `a_i·b_j = δ_ij` and `a_i·a_j = b_i·b_j = 0`, where x·y is the value of the antisymmetric form
/// with this matrix (2g × 2g). Row k of the result is the k-th new basis vector in coordinates of the old basis, the a's first, then the b's.
///
/// Integer elimination: take a vector, combine the others by Euclid's algorithm until exactly one has a product with it that is not 0, which
/// must be ±1, and make the rest orthogonal to both. `None` if the matrix is not square, antisymmetric and unimodular.
pub fn symplectic_basis(form: &[Vec<i64>]) -> Option<Vec<Vec<i64>>> {
    let n = form.len();
    let antisymmetric = (0..n).all(|i| form[i].len() == n && (0..=i).all(|j| form[i][j] == -form[j][i]));
    if n % 2 == 1 || !antisymmetric {
        return None;
    }
    let pair = |x: &[i64], y: &[i64]| -> i64 {
        x.iter().zip(form).map(|(xi, row)| xi * row.iter().zip(y).map(|(m, yj)| m * yj).sum::<i64>()).sum()
    };
    let add = |x: &mut [i64], times: i64, y: &[i64]| {
        x.iter_mut().zip(y).for_each(|(x, y)| *x += times * y);
    };
    let mut rest: Vec<Vec<i64>> = (0..n).map(|i| (0..n).map(|j| i64::from(i == j)).collect()).collect();
    let (mut first, mut second) = (Vec::new(), Vec::new());
    while !rest.is_empty() {
        let a = rest.swap_remove(0);
        // Euclid's algorithm: the others are reduced by the vector with the smallest product with a, until only that one has a product
        // that is not 0.
        let b = loop {
            let paired = (0..rest.len()).filter(|&i| pair(&a, &rest[i]) != 0);
            let smallest = paired.min_by_key(|&i| pair(&a, &rest[i]).abs())?;
            let divisor = pair(&a, &rest[smallest]);
            let by = rest[smallest].clone();
            let mut alone = true;
            for i in (0..rest.len()).filter(|&i| i != smallest) {
                let times = pair(&a, &rest[i]).div_euclid(divisor);
                add(&mut rest[i], -times, &by);
                alone &= pair(&a, &rest[i]) == 0;
            }
            if alone {
                if divisor.abs() != 1 {
                    return None;
                }
                let b = rest.swap_remove(smallest);
                break b.into_iter().map(|x| divisor * x).collect::<Vec<i64>>();
            }
        };
        for u in &mut rest {
            let (with_a, with_b) = (pair(u, &a), pair(u, &b));
            add(u, -with_b, &a);
            add(u, with_a, &b);
        }
        first.push(a);
        second.push(b);
    }
    first.extend(second);
    Some(first)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn basis_has_the_standard_products() {
        // Successive curves of a chain meet once.
        let chain = |n: usize| -> Vec<Vec<i64>> {
            (0..n).map(|i| (0..n).map(|j| i64::from(j == i + 1) - i64::from(i == j + 1)).collect()).collect()
        };
        let degenerate = vec![vec![0, 2, 3, 1], vec![-2, 0, 1, 1], vec![-3, -1, 0, 1], vec![-1, -1, -1, 0]];
        for form in [chain(2), chain(4), chain(10)] {
            check(&form);
        }
        // det = (2·1 − 3·1 + 1·1)² = 0: not unimodular.
        assert!(symplectic_basis(&degenerate).is_none());
        // A unimodular form with larger entries.
        let larger_entries =
            vec![vec![0, 2, 3, 2], vec![-2, 0, 1, 1], vec![-3, -1, 0, 1], vec![-2, -1, -1, 0]];
        check(&larger_entries);
        assert!(symplectic_basis(&[vec![0, 2], vec![-2, 0]]).is_none());
        assert!(symplectic_basis(&[vec![0, 1], vec![1, 0]]).is_none());
        assert!(symplectic_basis(&[vec![0]]).is_none());
    }

    fn check(form: &[Vec<i64>]) {
        let n = form.len();
        let basis = symplectic_basis(form).unwrap();
        for i in 0..n {
            for j in 0..n {
                let product: i64 = (0..n)
                    .flat_map(|k| (0..n).map(move |l| (k, l)))
                    .map(|(k, l)| basis[i][k] * form[k][l] * basis[j][l])
                    .sum();
                let expected = i64::from(j == i + n / 2) - i64::from(i == j + n / 2);
                assert_eq!(product, expected, "{form:?}");
            }
        }
    }
}
