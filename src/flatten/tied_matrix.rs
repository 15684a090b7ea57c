//! The Newton matrix in the free unknowns of points that are tied to each other along seams.

use super::seam_ties::SeamTies;
use crate::error::{Error, Result};
use crate::linalg::{Pattern, Symmetric};

/// `Bᵀ H B` and `Bᵀ g`, for the matrix B that makes points of unknowns.
pub(super) struct TiedMatrix<'a> {
    ties: &'a SeamTies,
    /// Per coordinate of a point the unknowns and their coefficients, both real.
    rows: Vec<Vec<(u32, f64)>>,
    pub pattern: Pattern,
    /// The products that make up the values, in the order in which they are summed.
    products: Vec<TiedProduct>,
}

/// An entry of the matrix of the points, times a factor, in an entry of that of the unknowns.
struct TiedProduct {
    from: u32,
    to: u32,
    factor: f64,
}

impl<'a> TiedMatrix<'a> {
    /// `full`: the pattern of the matrix of the points.
    ///
    /// # Errors
    /// Those of [`Pattern::new`]; [`Error::TooLarge`].
    pub fn new(ties: &'a SeamTies, full: &Pattern) -> Result<TiedMatrix<'a>> {
        let rows = real_rows(ties);
        let zeros = vec![0.0; full.entries()];
        let entries: Vec<[usize; 2]> =
            Symmetric { pattern: full, values: &zeros }.entries().map(|(i, j, _)| [i, j]).collect();
        let pairs_of = |i: usize, j: usize| {
            let rows = &rows;
            rows[i].iter().flat_map(move |a| rows[j].iter().map(move |b| (*a, *b)))
        };
        let pairs: Vec<(u32, u32)> =
            entries.iter().flat_map(|&[i, j]| pairs_of(i, j).map(|(a, b)| (a.0, b.0))).collect();
        let pattern = Pattern::new(2 * ties.n_unknowns, &pairs)?;
        let mut products = Vec::with_capacity(pairs.len());
        for (from, &[i, j]) in entries.iter().enumerate() {
            for ((a, x), (b, y)) in pairs_of(i, j) {
                // The lower triangle alone is stored: an entry off the diagonal stands for two, the one on it for all pairs.
                if i == j && a < b {
                    continue;
                }
                let twice = if i != j && a == b { 2.0 } else { 1.0 };
                let to = pattern.position(a as usize, b as usize).unwrap_or_default();
                products.push(TiedProduct { from: from as u32, to: to as u32, factor: twice * x * y });
            }
        }
        if products.len() >= u32::MAX as usize {
            return Err(Error::TooLarge { what: "products along seams", count: products.len() });
        }
        Ok(TiedMatrix { ties, rows, pattern, products })
    }

    /// Fills in the matrix from that of the points.
    pub fn fill(&self, full: &[f64], values: &mut [f64]) {
        values.fill(0.0);
        for TiedProduct { from, to, factor } in &self.products {
            values[*to as usize] += factor * full[*from as usize];
        }
    }

    /// The slopes in the unknowns, from those in the coordinates of the points.
    pub fn slopes(&self, of_points: &[f64]) -> Vec<f64> {
        let mut slopes = vec![0.0; 2 * self.ties.n_unknowns];
        for (row, slope) in self.rows.iter().zip(of_points) {
            row.iter().for_each(|&(a, x)| slopes[a as usize] += x * slope);
        }
        slopes
    }

    /// The steps of the points, from those of the unknowns.
    pub fn steps(&self, of_unknowns: &[f64]) -> Vec<[f64; 2]> {
        self.ties.expanded(of_unknowns.as_chunks::<2>().0)
    }
}

/// Products of complex numbers as those of their parts.
fn real_rows(ties: &SeamTies) -> Vec<Vec<(u32, f64)>> {
    let mut rows = Vec::with_capacity(2 * ties.rows.len());
    for row in &ties.rows {
        let parts = |of: &dyn Fn([f64; 2]) -> [f64; 2]| -> Vec<(u32, f64)> {
            let both = row.iter().flat_map(|&(u, c)| [0, 1].map(|k| (2 * u + k, of(c)[k as usize])));
            both.filter(|(_, x)| *x != 0.0).collect()
        };
        rows.push(parts(&|[re, im]| [re, -im]));
        rows.push(parts(&|[re, im]| [im, re]));
    }
    rows
}
