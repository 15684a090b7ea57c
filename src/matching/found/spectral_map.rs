//! Maps between sampled surfaces that are refined from few eigenfunctions to many \[MRRSWO19\].

use crate::error::Result;
use crate::linalg::dense::solve_definite;
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
        let images: Vec<(Vec<f64>, f64)> = parallel::map(self.to.len().div_ceil(64), |part| {
            let rows = &self.to[64 * part..self.to.len().min(64 * (part + 1))];
            rows.iter()
                .map(|row| {
                    let product = |c: &Vec<f64>| c.iter().zip(*row).map(|(c, b)| c * b).sum::<f64>();
                    let image: Vec<f64> = matrix.iter().map(product).collect();
                    let square = image.iter().map(|x| x * x).sum();
                    (image, square)
                })
                .collect::<Vec<_>>()
        })
        .concat();
        parallel::map(self.from.len(), |x| nearest_image(&self.from[x][..size], &images))
    }
}

/// The place of the image nearest to a point, the first of equal ones.
fn nearest_image(point: &[f64], images: &[(Vec<f64>, f64)]) -> usize {
    let mut best = (f64::INFINITY, 0);
    for (k, (image, square)) in images.iter().enumerate() {
        let off = square - 2.0 * image.iter().zip(point).map(|(a, b)| a * b).sum::<f64>();
        if off < best.0 {
            best = (off, k);
        }
    }
    best.1
}

/// Per row the place of the nearest of other rows of the same length.
pub(super) fn nearest_rows(rows: &[Vec<f64>], others: &[Vec<f64>]) -> Vec<usize> {
    let images: Vec<(Vec<f64>, f64)> =
        others.iter().map(|row| (row.clone(), row.iter().map(|x| x * x).sum())).collect();
    parallel::map(rows.len(), |x| nearest_image(&rows[x], &images))
}
