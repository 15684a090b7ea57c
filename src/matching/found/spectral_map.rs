//! Maps between sampled surfaces that are refined from few eigenfunctions to many \[MRRSWO19\].

use crate::error::Result;
use crate::linalg::dense::{dot, solve_definite};
use crate::parallel;

/// Share of the mean diagonal that is added to a matrix of normal equations: samples do not tell all functions apart.
const DAMPING: f64 = 1e-9;

/// Values of the eigenfunctions of two surfaces: at the points that are mapped, with their shares of the area, and at those where they can
/// go.
pub(super) struct SpectralSides<'a> {
    pub from: &'a [&'a [f64]],
    pub shares: &'a [f64],
    pub to: &'a [&'a [f64]],
}

impl SpectralSides<'_> {
    /// The map refined with this many functions, one number after the other: the matrix C that takes the functions of the one surface to
    /// those of the other is found from the map \[MRRSWO19, Eqn 2\], and the map anew from C \[MRRSWO19, Eqn 3\].
    ///
    /// # Errors
    /// [`crate::Error::Factorisation`] where functions are alike at all samples.
    pub fn refined(&self, mut map: Vec<usize>, sizes: impl Iterator<Item = usize>) -> Result<Vec<usize>> {
        let most =
            self.from.first().map_or(0, |row| row.len()).min(self.to.first().map_or(0, |row| row.len()));
        for size in sizes.map(|size| size.min(most)) {
            map = self.nearest(&self.matrix(&map, size)?, size);
        }
        Ok(map)
    }

    /// The matrix C with φ(x) C ≈ ψ(T x) by least squares.
    fn matrix(&self, map: &[usize], size: usize) -> Result<Vec<Vec<f64>>> {
        let others: Vec<&[f64]> = map.iter().map(|&k| self.to[k]).collect();
        let mut left = self.products(self.from, size);
        let right = self.products(&others, size);
        let mean = (0..size).map(|k| left[k][k]).sum::<f64>() / size.max(1) as f64;
        (0..size).for_each(|k| left[k][k] += DAMPING * mean);
        solve_definite(&left, &right)
    }

    /// The integrals of the functions of the source times others, which are given at its points.
    fn products(&self, others: &[&[f64]], size: usize) -> Vec<Vec<f64>> {
        let mut sum = vec![vec![0.0; size]; size];
        for ((own, other), share) in self.from.iter().zip(others).zip(self.shares) {
            for (row, a) in sum.iter_mut().zip(*own) {
                row.iter_mut().zip(*other).for_each(|(s, b)| *s += share * a * b);
            }
        }
        sum
    }

    /// Per point the one where it can go whose functions, taken back by C, are nearest.
    fn nearest(&self, matrix: &[Vec<f64>], size: usize) -> Vec<usize> {
        let images = parallel::map(self.to.len(), |y| {
            SpectralPoint::new(matrix.iter().map(|row| dot(row, &self.to[y][..size])).collect())
        });
        parallel::map(self.from.len(), |x| nearest_point(&self.from[x][..size], &images))
    }
}

/// A point by its values, and the sum of their squares.
struct SpectralPoint {
    values: Vec<f64>,
    square: f64,
}

impl SpectralPoint {
    fn new(values: Vec<f64>) -> SpectralPoint {
        let square = dot(&values, &values);
        SpectralPoint { values, square }
    }
}

/// The place of the nearest of other points, the first of equal ones.
fn nearest_point(point: &[f64], others: &[SpectralPoint]) -> usize {
    let mut best = (f64::INFINITY, 0);
    for (k, other) in others.iter().enumerate() {
        let off = other.square - 2.0 * dot(&other.values, point);
        if off < best.0 {
            best = (off, k);
        }
    }
    best.1
}

/// Per row the place of the nearest of other rows of the same length.
pub(super) fn nearest_rows(rows: &[Vec<f64>], others: &[Vec<f64>]) -> Vec<usize> {
    let others: Vec<SpectralPoint> = others.iter().map(|row| SpectralPoint::new(row.clone())).collect();
    parallel::map(rows.len(), |x| nearest_point(&rows[x], &others))
}
