//! Symmetric sparse matrices as their lower triangle, with a pattern that is kept while values change.
//!
//! ```
//! # use ricci::linalg::Pattern;
//! let pattern = Pattern::new(3, &[(0, 1), (1, 0), (2, 1)])?;
//! assert_eq!((pattern.size(), pattern.entries(), pattern.position(0, 2)), (3, 5, None));
//! # Ok::<(), ricci::Error>(())
//! ```

use crate::error::{Error, Result};

/// Sparsity pattern of a symmetric n×n matrix: its lower triangle by columns, the diagonal first in each column,
/// rows ascending, no entry twice.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Pattern {
    pub(super) column_start: Vec<u32>,
    pub(super) row: Vec<u32>,
}

impl Pattern {
    /// The pattern with a full diagonal and the off-diagonal entries (i, j) of `pairs` (either order; repeated
    /// pairs are one entry; pairs with i = j are on the diagonal anyway).
    ///
    /// # Errors
    ///
    /// [`Error::TooLarge`] for more entries than a u32 can number.
    ///
    /// # Panics
    ///
    /// If an index is not below `n`.
    pub fn new(n: usize, pairs: &[(u32, u32)]) -> Result<Pattern> {
        let pairs = pairs.iter().filter(|(i, j)| i != j).map(|&(i, j)| (i.max(j), i.min(j)));
        let total = n + pairs.clone().count();
        if total >= u32::MAX as usize {
            return Err(Error::TooLarge { what: "matrix entries", count: total });
        }
        // Counting sort by column, then sort and deduplicate each column.
        let mut start = vec![0u32; n + 1];
        pairs.clone().for_each(|(_, j)| start[j as usize + 1] += 1);
        for j in 0..n {
            start[j + 1] += start[j] + 1;
        }
        let mut row = vec![0u32; total];
        let mut end: Vec<u32> = start[..n].to_vec();
        for j in 0..n {
            row[end[j] as usize] = j as u32;
            end[j] += 1;
        }
        for (i, j) in pairs {
            row[end[j as usize] as usize] = i;
            end[j as usize] += 1;
        }
        let mut kept = 0usize;
        for j in 0..n {
            let column = start[j] as usize..end[j] as usize;
            row[column.clone()].sort_unstable();
            start[j] = kept as u32;
            for k in column.clone() {
                if k == column.start || row[k] != row[k - 1] {
                    row[kept] = row[k];
                    kept += 1;
                }
            }
        }
        start[n] = kept as u32;
        row.truncate(kept);
        row.shrink_to_fit();
        Ok(Pattern { column_start: start, row })
    }

    /// The pattern of a matrix with a block of this many rows and columns for each entry of this one: all of its entries are in the pattern.
    ///
    /// # Errors
    ///
    /// [`Error::TooLarge`] for more entries than a u32 can number.
    pub fn of_blocks(&self, size: usize) -> Result<Pattern> {
        let n = self.size();
        let total = size * size * (self.entries() - n) + n * size * (size + 1) / 2;
        if total >= u32::MAX as usize {
            return Err(Error::TooLarge { what: "matrix entries", count: total });
        }
        let (mut column_start, mut row) = (Vec::with_capacity(n * size + 1), Vec::with_capacity(total));
        column_start.push(0);
        let rows_of = |block: usize| (size * block) as u32..(size * (block + 1)) as u32;
        for j in 0..n {
            let below = self.column_start[j] as usize + 1..self.column_start[j + 1] as usize;
            for c in 0..size {
                row.extend(rows_of(j).skip(c));
                row.extend(self.row[below.clone()].iter().flat_map(|&i| rows_of(i as usize)));
                column_start.push(row.len() as u32);
            }
        }
        Ok(Pattern { column_start, row })
    }

    /// Number of rows.
    pub fn size(&self) -> usize {
        self.column_start.len() - 1
    }

    /// Number of stored entries.
    pub fn entries(&self) -> usize {
        self.row.len()
    }

    /// Position of the diagonal entry (j, j) among the stored values.
    pub fn diagonal(&self, j: usize) -> usize {
        self.column_start[j] as usize
    }

    /// Position of the entry (i, j) = (j, i) among the stored values, if it is stored.
    pub fn position(&self, i: usize, j: usize) -> Option<usize> {
        let (i, j) = (i.max(j), i.min(j));
        let start = *self.column_start.get(j)? as usize;
        let end = *self.column_start.get(j + 1)? as usize;
        self.row[start..end].binary_search(&(i as u32)).ok().map(|k| start + k)
    }
}

/// A symmetric matrix: the stored values of a pattern.
#[derive(Debug, Clone, Copy)]
pub struct Symmetric<'a> {
    /// The pattern.
    pub pattern: &'a Pattern,
    /// One value per stored entry.
    pub values: &'a [f64],
}

impl Symmetric<'_> {
    /// The stored entries (i, j, value), i ≥ j, by columns.
    pub fn entries(&self) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
        (0..self.pattern.size()).flat_map(move |j| {
            let column = self.pattern.column_start[j] as usize..self.pattern.column_start[j + 1] as usize;
            column.map(move |k| (self.pattern.row[k] as usize, j, self.values[k]))
        })
    }

    /// `y = A x`.
    ///
    /// # Panics
    ///
    /// If an array does not have n entries.
    pub fn product(&self, x: &[f64], y: &mut [f64]) {
        let Pattern { column_start, row } = self.pattern;
        assert!(x.len() == self.pattern.size() && y.len() == x.len(), "one entry per row");
        y.fill(0.0);
        for (j, &x_j) in x.iter().enumerate() {
            let column = column_start[j] as usize..column_start[j + 1] as usize;
            let (rows, values) = (&row[column.clone()], &self.values[column]);
            // The diagonal comes first.
            let mut sum = values[0] * x_j;
            for (&i, a) in rows.iter().zip(values).skip(1) {
                y[i as usize] += a * x_j;
                sum += a * x[i as usize];
            }
            y[j] += sum;
        }
    }

    /// `y = b − A x`.
    ///
    /// # Panics
    ///
    /// If an array does not have n entries.
    pub fn residual(&self, x: &[f64], b: &[f64], y: &mut [f64]) {
        self.product(x, y);
        y.iter_mut().zip(b).for_each(|(y, b)| *y = b - *y);
    }
}
