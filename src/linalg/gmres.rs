//! Linear systems without symmetry, by generalised minimal residuals (GMRES, \[SS86\]), which need only products with the matrix.
//!
//! faer's `bicgstab` was measured as a replacement: on mean value Laplacians of 10,000 unknowns, preconditioned by their symmetric part, it
//! needs as many products (3 to 15 for residuals of 1e-2 to 1e-11) and as much time. But where it breaks down, as for a singular matrix, it
//! spends all products and returns NaN, and it does not report the residual that it has reached, which callers here use.
//!
//! ```
//! // [[2, 1], [0, 4]] x = [4, 8]
//! let apply = |x: &[f64], y: &mut [f64]| (y[0], y[1]) = (2.0 * x[0] + x[1], 4.0 * x[1]);
//! let mut x = [0.0; 2];
//! let left = ricci::linalg::gmres::solve(apply, &[4.0, 8.0], &mut x, ricci::linalg::gmres::GmresLimits::to(1e-14));
//! assert!(left < 1e-14 && (x[0] - 1.0).abs() < 1e-12 && (x[1] - 2.0).abs() < 1e-12);
//! ```

use super::dot;

/// Factor by which the residual must fall between two restarts for the iteration to go on.
const PROGRESS: f64 = 0.9;

/// Share of a product below which its part outside the space spanned before is rounding.
const ROUNDING: f64 = 1e-14;

/// The conditions under which the iteration stops.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GmresLimits {
    /// Norm of the residual to reach, relative to that of the right-hand side.
    pub tolerance: f64,
    /// Products with the matrix between two restarts, which is the number of vectors kept.
    pub kept: usize,
    /// Most products with the matrix.
    pub products: usize,
}

impl GmresLimits {
    /// The limits for this tolerance, with 50 vectors and 400 products.
    pub fn to(tolerance: f64) -> GmresLimits {
        GmresLimits { tolerance, kept: 50, products: 400 }
    }
}

/// Solves `A x = b`, starting from the x given (n numbers), and returns the norm of the remaining residual relative to that of b (0 for
/// b = 0). `apply(x, y)` sets y to A x. The tolerance is not reached if the products are used up, a restart brings no progress, or a
/// number is not finite.
pub fn solve(
    mut apply: impl FnMut(&[f64], &mut [f64]),
    b: &[f64],
    x: &mut [f64],
    limits: GmresLimits,
) -> f64 {
    let (size, mut products) = (norm(b), 0);
    if size == 0.0 {
        x.fill(0.0);
        return 0.0;
    }
    let mut rest = vec![0.0; b.len()];
    let mut before = f64::INFINITY;
    loop {
        apply(x, &mut rest);
        rest.iter_mut().zip(b).for_each(|(r, b)| *r = b - *r);
        let left = norm(&rest) / size;
        let is_over = left <= limits.tolerance || products >= limits.products;
        // False for NaN too.
        let is_nearer = left < PROGRESS * before;
        if is_over || !is_nearer {
            return if left.is_finite() { left } else { f64::INFINITY };
        }
        before = left;
        let most = limits.kept.min(limits.products - products);
        products += cycle(&mut apply, &rest, x, most, limits.tolerance * size).max(1);
    }
}

/// Adds to x the best correction for the residual `rest` in the space spanned by at most `most` products, and returns their number.
fn cycle(
    apply: &mut impl FnMut(&[f64], &mut [f64]),
    rest: &[f64],
    x: &mut [f64],
    most: usize,
    enough: f64,
) -> usize {
    let first = norm(rest);
    let mut basis = vec![rest.iter().map(|r| r / first).collect::<Vec<f64>>()];
    // The upper triangular matrix by columns, the rotations that made it, and the right-hand side after these rotations.
    let (mut columns, mut rotations, mut side) =
        (Vec::<Vec<f64>>::new(), Vec::<[f64; 2]>::new(), vec![first]);
    for k in 0..most {
        let mut next = vec![0.0; rest.len()];
        apply(&basis[k], &mut next);
        let whole = norm(&next);
        let mut column: Vec<f64> = Vec::with_capacity(k + 2);
        for v in &basis {
            let along = dot(v, &next);
            next.iter_mut().zip(v).for_each(|(n, v)| *n -= along * v);
            column.push(along);
        }
        let size = norm(&next);
        for (j, [c, s]) in rotations.iter().enumerate() {
            let (a, b) = (column[j], column[j + 1]);
            (column[j], column[j + 1]) = (c * a + s * b, c * b - s * a);
        }
        let radius = column[k].hypot(size);
        if radius <= ROUNDING * whole || !radius.is_finite() {
            break;
        }
        let [c, s] = [column[k] / radius, size / radius];
        column[k] = radius;
        columns.push(column);
        rotations.push([c, s]);
        side.push(-s * side[k]);
        side[k] *= c;
        if side[k + 1].abs() <= enough || size == 0.0 {
            break;
        }
        next.iter_mut().for_each(|n| *n /= size);
        basis.push(next);
    }
    let n = columns.len();
    for k in (0..n).rev() {
        let known: f64 = (k + 1..n).map(|j| columns[j][k] * side[j]).sum();
        side[k] = (side[k] - known) / columns[k][k];
    }
    for (v, share) in basis.iter().zip(&side[..n]) {
        x.iter_mut().zip(v).for_each(|(x, v)| *x += share * v);
    }
    n
}

fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn product(n: usize) -> impl Fn(&[f64], &mut [f64]) {
        move |x, y| {
            for i in 0..n {
                y[i] = (4.0 + (i as f64).sin()) * x[i] + x[(i * 7 + 3) % n] - 0.5 * x[(i * 11 + 5) % n];
            }
        }
    }

    #[test]
    fn solution_leaves_no_residual() {
        let n = 400;
        let b: Vec<f64> = (0..n).map(|i| (i as f64).cos()).collect();
        for kept in [5, 50] {
            let mut x = vec![0.0; n];
            let limits = GmresLimits { kept, ..GmresLimits::to(1e-13) };
            assert!(solve(product(n), &b, &mut x, limits) <= 1e-13);
            let mut y = vec![0.0; n];
            product(n)(&x, &mut y);
            assert!(y.iter().zip(&b).all(|(y, b)| (y - b).abs() < 1e-11));
        }
    }

    #[test]
    fn a_matrix_without_an_inverse_leaves_what_it_cannot_reach() {
        let apply = |x: &[f64], y: &mut [f64]| (y[0], y[1]) = (x[0] + x[1], x[0] + x[1]);
        let mut x = [0.0; 2];
        let left = solve(apply, &[1.0, 0.0], &mut x, GmresLimits::to(1e-12));
        assert!((left - 0.5f64.sqrt()).abs() < 1e-9, "{left}");
    }
}
