//! Period matrices of hyperelliptic curves.
//!
//! The curve `y² = Π (x − e_j)` of genus g has N = 2g + 1 or 2g + 2 finite branch points. A segment from e_p to e_q lifts to a closed
//! curve: there on one sheet, back on the other. The 2g edges of a tree on 2g + 1 branch points give a basis of the homology [MN19, §3];
//! two of them meet only over a branch point that they share.
//!
//! ```
//! use num_complex::Complex64;
//! use ricci::geometry::{hyperelliptic::period_matrix, modulus::modulus};
//! // y² = x³ − x is the square torus.
//! let tau = period_matrix(&[-1.0, 0.0, 1.0].map(Complex64::from))?[0][0];
//! let [re, im] = modulus([[1.0, 0.0], [tau.re, tau.im]]).unwrap();
//! assert!(re.abs() < 1e-12 && (im - 1.0).abs() < 1e-12);
//! # Ok::<(), ricci::Error>(())
//! ```

use crate::error::{Error, Result};
use crate::geometry::symplectic::symplectic_basis;
use crate::geometry::worse;
use num_complex::Complex64;
use std::f64::consts::PI;

/// Relative error of the quadrature.
const ACCURACY: f64 = 1e-15;
/// Most nodes of the quadrature: enough for branch points that are 1e-8 apart ([`NEAREST`]) while the others are 1 apart.
const MOST_NODES: usize = 1 << 20;
/// Largest asymmetry of a matrix that is returned, relative to its largest entry. A period matrix is symmetric, so its asymmetry measures
/// the rounding errors.
const ASYMMETRY: f64 = 1e-9;

/// The period matrix τ (g × g, symmetric, positive definite imaginary part) of `y² = Π (x − e_j)`: with a basis of cycles a_i, b_i,
/// `a_i·b_j = δ_ij` and all other intersections 0, and the holomorphic forms ω_i with `∮_{a_j} ω_i = δ_ij`, `τ_ij = ∮_{b_j} ω_i`. Another
/// basis gives another matrix of the same Sp(2g, ℤ) orbit.
///
/// `branch_points`: the finite ones, 2g + 1 (then ∞ is one more) or 2g + 2, g ≥ 1, all different. The integrals of `x^k dx/y` along the
/// edges are computed by Gauss–Chebyshev quadrature, which converges geometrically.
///
/// # Errors
///
/// [`Error::Argument`] for fewer than three points, points that are not finite or too close to each other for f64, and so many points
/// that the forms x^k dx/y are linearly dependent in f64 (about 2g = 30).
pub fn period_matrix(branch_points: &[Complex64]) -> Result<Vec<Vec<Complex64>>> {
    let points = normalised(branch_points)?;
    let genus = (points.len() - 1) / 2;
    let edges = tree(&points);
    let mut cycles = Vec::with_capacity(edges.len());
    for &ends in &edges {
        cycles.push(LiftedSegment::new(&points, ends, genus)?);
    }
    let intersections: Vec<Vec<i64>> =
        cycles.iter().map(|c| cycles.iter().map(|d| c.intersection(d)).collect()).collect();
    let need = "fewer, or further apart: their period matrix is lost in rounding";
    let lost = || Error::argument("branch points", branch_points.len(), need);
    let basis = symplectic_basis(&intersections).ok_or_else(lost)?;
    // Periods of the forms x^k dx/y along a_1 … a_g, b_1 … b_g.
    let period = |k: usize, cycle: &[i64]| -> Complex64 {
        cycle.iter().zip(&cycles).map(|(&times, c)| c.periods[k] * times as f64).sum()
    };
    let a = (0..genus).map(|k| (0..genus).map(|j| period(k, &basis[j])).collect()).collect();
    let b = (0..genus).map(|k| (0..genus).map(|j| period(k, &basis[genus + j])).collect()).collect();
    let tau = solve(a, b);
    let largest = tau.iter().flatten().map(|z| z.norm()).fold(0.0, worse);
    let pairs = (0..genus).flat_map(|i| (0..i).map(move |j| (i, j)));
    let worst = pairs.map(|(i, j)| (tau[i][j] - tau[j][i]).norm()).fold(0.0, worse);
    if !(largest.is_finite() && worst <= ASYMMETRY * largest) {
        return Err(lost());
    }
    let entry = |i: usize, j: usize| 0.5 * (tau[i][j] + tau[j][i]);
    Ok((0..genus).map(|i| (0..genus).map(|j| entry(i, j)).collect()).collect())
}

/// `a⁻¹ b` by elimination with partial pivoting; not finite if `a` is singular. The matrices have g ≤ 15 rows.
fn solve(mut a: Vec<Vec<Complex64>>, mut b: Vec<Vec<Complex64>>) -> Vec<Vec<Complex64>> {
    let n = a.len();
    for k in 0..n {
        let pivot = (k..n).max_by(|&i, &j| a[i][k].norm().total_cmp(&a[j][k].norm())).unwrap_or(k);
        a.swap(k, pivot);
        b.swap(k, pivot);
        let inverse = a[k][k].inv();
        for x in a[k].iter_mut().chain(&mut b[k]) {
            *x *= inverse;
        }
        for i in (0..n).filter(|&i| i != k) {
            let factor = a[i][k];
            for j in 0..n {
                let (p, q) = (a[k][j], b[k][j]);
                a[i][j] -= factor * p;
                b[i][j] -= factor * q;
            }
        }
    }
    b
}

/// The points, moved and scaled so that their mean is 0 and their mean square 1. The curve is the same, since x is mapped affinely.
///
/// # Errors
///
/// As [`period_matrix`], for the points themselves.
pub fn normalised(points: &[Complex64]) -> Result<Vec<Complex64>> {
    let refuse = |value: String, need| Err(Error::argument("branch points", value, need));
    if points.len() < 3 {
        return refuse(points.len().to_string(), "at least three finite points");
    }
    let usable = |z: &Complex64| z.re.abs().max(z.im.abs()) <= 1e150;
    if let Some(j) = points.iter().position(|z| !usable(z)) {
        return refuse(format!("{} (number {j})", points[j]), "finite, below 1e150");
    }
    let n = points.len() as f64;
    let mean = points.iter().map(|z| z / n).sum::<Complex64>();
    let size = (points.iter().map(|z| (z - mean).norm_sqr() / n).sum::<f64>()).sqrt();
    let moved: Vec<Complex64> = points.iter().map(|z| (z - mean) / size).collect();
    for (j, z) in moved.iter().enumerate() {
        let near = |w: &Complex64| (z - w).norm().is_nan() || (z - w).norm() <= NEAREST;
        if let Some(k) = moved[..j].iter().position(near) {
            return refuse(format!("{} and {} (numbers {k} and {j})", points[k], points[j]), "further apart");
        }
    }
    Ok(moved)
}

/// Least distance of two branch points, in units of their spread: their difference keeps eight digits.
const NEAREST: f64 = 1e-8;

/// The edges of the shortest spanning tree. If the number of points is even, one leaf is left out (it plays the role of the point at
/// infinity). No other branch point lies in the disk over an edge, which keeps the quadrature fast.
fn tree(points: &[Complex64]) -> Vec<[usize; 2]> {
    let mut edges = Vec::with_capacity(points.len() - 1);
    // Nearest point of the tree, per point outside (Prim).
    let mut nearest: Vec<Option<usize>> = vec![Some(0); points.len()];
    nearest[0] = None;
    for _ in 1..points.len() {
        let length = |q: usize, p: usize| (points[q] - points[p]).norm();
        let outside = (0..points.len()).filter_map(|q| nearest[q].map(|p| (q, p)));
        let Some((q, p)) = outside.min_by(|&(q, p), &(r, s)| length(q, p).total_cmp(&length(r, s))) else {
            break;
        };
        edges.push([p, q]);
        nearest[q] = None;
        for r in 0..points.len() {
            if nearest[r].is_some_and(|s| length(r, q) < length(r, s)) {
                nearest[r] = Some(q);
            }
        }
    }
    if points.len().is_multiple_of(2) {
        // The last point joined is a leaf.
        edges.pop();
    }
    edges
}

/// The lift of a segment from one branch point to another.
struct LiftedSegment {
    ends: [usize; 2],
    /// The direction in which the cycle passes through each end, in the coordinate `√(x − e)` there, up to a factor that all cycles
    /// through that branch point share.
    directions: [Complex64; 2],
    /// `∮ x^k dx/y` for k = 0 … g − 1.
    periods: Vec<Complex64>,
}

impl LiftedSegment {
    /// With `x = m + h t`, t from −1 to 1: `y = i h √(1 − t²) G(t)`, `G = Π √(x − e_i)` over the other branch points,
    /// continued along the segment.
    fn new(points: &[Complex64], ends: [usize; 2], genus: usize) -> Result<LiftedSegment> {
        let [p, q] = ends.map(|j| points[j]);
        let (middle, half) = (0.5 * (p + q), 0.5 * (q - p));
        let others: Vec<Complex64> =
            (0..points.len()).filter(|j| !ends.contains(j)).map(|j| points[j]).collect();
        let root = |t: f64| -> Complex64 {
            let x = middle + half * t;
            // Seen from another point, the half segment turns by less than a straight angle, so no sign is lost.
            others.iter().map(|e| (middle - e).sqrt() * ((x - e) / (middle - e)).sqrt()).product()
        };
        let sum = |nodes: usize| -> Vec<Complex64> {
            let mut sum = vec![Complex64::ZERO; genus];
            for j in 0..nodes {
                let t = ((2 * j + 1) as f64 * PI / (2 * nodes) as f64).cos();
                let mut term = (Complex64::I * root(t)).inv() * (2.0 * PI / nodes as f64);
                for s in &mut sum {
                    *s += term;
                    term *= middle + half * t;
                }
            }
            sum
        };
        let mut nodes = 32;
        let mut periods = sum(nodes);
        loop {
            nodes *= 2;
            let finer = sum(nodes);
            let size = finer.iter().map(|z| z.norm()).fold(0.0, f64::max);
            let change = finer.iter().zip(&periods).map(|(a, b)| (a - b).norm()).fold(0.0, worse);
            periods = finer;
            // Convergence is geometric: when doubling the nodes changes little, the next doubling changes its square.
            if change <= ACCURACY.sqrt() * 1e-2 * size || nodes >= MOST_NODES {
                break;
            }
        }
        let along = Complex64::I * half;
        Ok(LiftedSegment { ends, directions: [along * root(-1.0), -along * root(1.0)], periods })
    }

    /// The intersection number: +1 if the other cycle crosses from right to left.
    fn intersection(&self, other: &LiftedSegment) -> i64 {
        let mut sum = 0;
        for (j, d) in self.ends.iter().zip(self.directions) {
            for (k, e) in other.ends.iter().zip(other.directions) {
                if j == k && self.ends != other.ends {
                    sum += (d.conj() * e).im.signum() as i64;
                }
            }
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::modulus::modulus;

    fn z(re: f64, im: f64) -> Complex64 {
        Complex64::new(re, im)
    }

    fn reduced(tau: Complex64) -> [f64; 2] {
        modulus([[1.0, 0.0], [tau.re, tau.im]]).unwrap()
    }

    /// The arithmetic–geometric mean.
    fn agm(mut a: f64, mut b: f64) -> f64 {
        while (a - b).abs() > 1e-15 * a {
            (a, b) = (0.5 * (a + b), (a * b).sqrt());
        }
        a
    }

    #[test]
    fn genus_one_agrees_with_the_arithmetic_geometric_mean() {
        // y² = x (x − 1)(x − λ): periods 2π/agm(√λ …) by Gauss; τ = i agm(1, √(1−k²))/agm(1, k), k² = 1/λ for 0 < k < 1.
        for lambda in [1.5f64, 2.0, 3.7, 40.0, 1e4] {
            let tau = period_matrix(&[z(0.0, 0.0), z(1.0, 0.0), z(lambda, 0.0)]).unwrap()[0][0];
            let k = lambda.recip().sqrt();
            let known = z(0.0, agm(1.0, (1.0 - k * k).sqrt()) / agm(1.0, k));
            let (got, known) = (reduced(tau), reduced(known));
            assert!(
                (got[0] - known[0]).abs() < 1e-13 && (got[1] / known[1] - 1.0).abs() < 1e-13,
                "{got:?} {known:?}"
            );
        }
        // Symmetric lattices: the square and the hexagonal one, also with all four points finite.
        let square = [z(1.0, 0.0), z(0.0, 1.0), z(-1.0, 0.0), z(0.0, -1.0)];
        let hexagonal: Vec<_> =
            (0..3).map(|k| Complex64::from_polar(1.0, 2.0 * PI * k as f64 / 3.0)).collect();
        for (points, known) in [(&square[..], [0.0, 1.0]), (&hexagonal, [0.5, 0.75f64.sqrt()])] {
            let got = reduced(period_matrix(points).unwrap()[0][0]);
            assert!((got[0] - known[0]).abs() < 1e-14 && (got[1] - known[1]).abs() < 1e-14, "{got:?}");
        }
    }

    fn positive_definite(m: &[Vec<Complex64>]) -> bool {
        // Cholesky of the imaginary part.
        let n = m.len();
        let mut l = vec![vec![0.0f64; n]; n];
        for i in 0..n {
            for j in 0..=i {
                let s = m[i][j].im - (0..j).map(|k| l[i][k] * l[j][k]).sum::<f64>();
                if i == j && s <= 0.0 {
                    return false;
                }
                l[i][j] = if i == j { s.sqrt() } else { s / l[j][j] };
            }
        }
        true
    }

    #[test]
    fn riemann_relations_hold_for_every_genus() {
        // The asymmetry is checked inside; two spanning trees give equivalent matrices, not equal ones.
        for n in 3..=14usize {
            let spiral = |j: usize| Complex64::from_polar(0.5 + 0.2 * j as f64, 2.4 * j as f64);
            let points: Vec<_> = (0..n).map(spiral).collect();
            let tau = period_matrix(&points).unwrap();
            assert_eq!(tau.len(), (n - 1) / 2);
            assert!(positive_definite(&tau), "{n} points: {tau:?}");
        }
    }

    #[test]
    fn determinant_of_the_imaginary_part_depends_on_the_curve_alone() {
        // A Möbius map of the points keeps the curve; a polynomial in τ that is invariant under a change of basis in
        // genus 1 is the reduced modulus itself.
        let points = [z(0.3, 0.1), z(-0.7, 0.4), z(1.2, -0.5), z(0.1, 1.3)];
        let image = points.map(|x| (x * z(0.2, 1.0) + z(0.5, 0.0)) / (x * z(0.3, -0.4) + z(1.0, 0.2)));
        let [a, b] = [&points, &image].map(|p| reduced(period_matrix(p).unwrap()[0][0]));
        assert!((a[0] - b[0]).abs() < 1e-13 && (a[1] - b[1]).abs() < 1e-13, "{a:?} {b:?}");
    }

    #[test]
    fn degenerate_points_are_refused() {
        assert!(period_matrix(&[z(0.0, 0.0), z(1.0, 0.0)]).is_err());
        assert!(period_matrix(&[z(0.0, 0.0), z(1.0, 0.0), z(1.0, 0.0)]).is_err());
        assert!(period_matrix(&[z(0.0, 0.0), z(1.0, 0.0), z(f64::NAN, 0.0)]).is_err());
        assert!(period_matrix(&[z(0.0, 0.0), z(1.0, 0.0), z(1.0, 1e-9)]).is_err());
    }
}
