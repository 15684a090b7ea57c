//! The first eigenfunctions of the Laplacian, by Lanczos' method with blocks on its shifted inverse \[GLS94\].
//!
//! ```
//! use ricci::{Control, Surface, harmonic::{Domain, spectrum}, mesh::shapes};
//! let sphere = Surface::from_soup(&shapes::icosphere(8)?)?;
//! let domain = Domain::new(&sphere, &Control::new())?;
//! let found = spectrum(&domain, 4, &Control::new())?;
//! // On the unit sphere l (l + 1), 2 l + 1 times.
//! assert!(found.values[0].abs() < 1e-9 && found.values[1..].iter().all(|value| (value - 2.0).abs() < 0.05));
//! # Ok::<(), ricci::Error>(())
//! ```

use super::domain::Domain;
use super::laplace::Laplace;
use crate::control::{Control, Stage};
use crate::error::{Error, Result};
use crate::geometry::random::SplitMix64;
use crate::linalg::dense::{dot, symmetric_eigenpairs};
use crate::parallel;

/// The first eigenfunctions of the Laplacian of a surface, with Neumann conditions where it has a boundary.
#[derive(Debug, Clone, PartialEq)]
pub struct Spectrum {
    /// The eigenvalues, ascending, in units of 1/area.
    pub values: Vec<f64>,
    /// Per eigenvalue the function at the vertices, whose square has the mean 1 by area. The signs are arbitrary.
    pub functions: Vec<Vec<f64>>,
}

/// Vectors of one block: eigenvalues of up to this multiplicity are found at once, and a factor is read once for all of them.
const BLOCK: usize = 8;
/// Residual of an eigenpair of the inverse, over its eigenvalue, up to which it is found.
const CONVERGED: f64 = 1e-9;
/// Dimensions of the Krylov space, per wanted function and on top, at which the search gives up; twice the functions mostly suffice.
const MOST: [usize; 2] = [6, 80];
/// Length below which what is left of an image after projection is rounding; the operator has the norm 1.
const NOTHING: f64 = 1e-12;
/// Seed of the vectors that start the search.
const SEED: u64 = 0x7370_6563_7472_756d;

/// The first `count` eigenfunctions (V at most) of `L φ = λ ⋆0 φ`. The result is the same for any number of threads.
///
/// # Errors
/// [`Error::Factorisation`] for a surface of several components, and where the search does not converge; those of [`Laplace::with_mass`];
/// [`Error::Cancelled`].
pub fn spectrum(domain: &Domain, count: usize, control: &Control) -> Result<Spectrum> {
    spectrum_within(domain, count, CONVERGED, control)
}

/// [`spectrum`] with another bound of the residual of an eigenpair of the inverse, over its eigenvalue.
///
/// # Errors
/// Those of [`spectrum`].
pub(crate) fn spectrum_within(
    domain: &Domain,
    count: usize,
    tolerance: f64,
    control: &Control,
) -> Result<Spectrum> {
    let n = domain.mesh().n_vertices();
    let count = count.min(n);
    let total: f64 = domain.vertex_areas().iter().sum();
    let mass: Vec<f64> = domain.vertex_areas().iter().map(|area| area / total).collect();
    let laplace = Laplace::with_mass(domain, &mass, control)?;
    let root = mass.iter().map(|m| m.sqrt()).collect();
    let mut space = KrylovSpace {
        root,
        basis: Vec::new(),
        projected: Vec::new(),
        last: 0,
        tolerance,
        random: SplitMix64::new(SEED),
    };
    let most = (MOST[0] * count + MOST[1]).min(n);
    let mut block = space.orthonormal((0..BLOCK.min(n)).map(|_| None).collect(), &mut Vec::new());
    let mut due = 2 * count;
    loop {
        control.step(Stage::Flow, (space.basis.len() as f64 / most as f64).min(1.0))?;
        let (next, coupling) = space.extend(block, &laplace)?;
        let size = space.basis.len();
        if size >= due.min(n) {
            if let Some(found) = space.found(count, &coupling, total)? {
                return Ok(found);
            }
            due = size + size / 4;
        }
        if size >= most || next.is_empty() {
            return Err(Error::Factorisation {
                size: n,
                message: format!(
                    "{count} eigenfunctions of the Laplacian were not found in {size} dimensions"
                ),
            });
        }
        block = next;
    }
}

/// The space in which eigenfunctions are searched: it is spanned by images of the first block under powers of `S (L + ⋆0)⁻¹ S`, S² = ⋆0.
struct KrylovSpace {
    /// The diagonal of S.
    root: Vec<f64>,
    basis: Vec<Vec<f64>>,
    /// The operator in this basis: row i has its entries up to the end of the block of i.
    projected: Vec<Vec<f64>>,
    /// The number of vectors in the last block of the basis.
    last: usize,
    /// Residual of an eigenpair, over its eigenvalue, up to which it is found.
    tolerance: f64,
    random: SplitMix64,
}

impl KrylovSpace {
    /// Takes a block into the basis. The next block, and its coupling: per vector of the block the coefficients of its image by the next.
    fn extend(
        &mut self,
        block: Vec<Vec<f64>>,
        laplace: &Laplace<'_>,
    ) -> Result<(Vec<Vec<f64>>, Vec<Vec<f64>>)> {
        let n = self.root.len();
        let mut columns: Vec<f64> =
            block.iter().flat_map(|q| q.iter().zip(&self.root).map(|(q, s)| q * s)).collect();
        laplace.solve(&mut columns)?;
        let recent = self.basis.len().saturating_sub(self.last);
        self.last = block.len();
        self.basis.extend(block);
        let image = |column: &[f64]| column.iter().zip(&self.root).map(|(x, s)| x * s).collect();
        let mut images: Vec<Vec<f64>> = columns.chunks(n).map(image).collect();
        // But for rounding, images have components in the last two blocks alone.
        let near = project_all_out(&self.basis[recent..], &mut images);
        let all = project_all_out(&self.basis, &mut images);
        for (mut row, near) in all.into_iter().zip(near) {
            row[recent..].iter_mut().zip(near).for_each(|(sum, c)| *sum += c);
            self.projected.push(row);
        }
        images.truncate(n - self.basis.len());
        let mut coupling = Vec::new();
        Ok((self.orthonormal(images.into_iter().map(Some).collect(), &mut coupling), coupling))
    }

    /// An orthonormal block beside the basis, from vectors that are orthogonal to it, or random ones where there are none. Per vector its
    /// coefficients by the block are added to the coupling.
    fn orthonormal(&mut self, vectors: Vec<Option<Vec<f64>>>, coupling: &mut Vec<Vec<f64>>) -> Vec<Vec<f64>> {
        let mut block: Vec<Vec<f64>> = Vec::new();
        for given in vectors {
            let mut parts = vec![0.0; block.len()];
            let mut length = 0.0;
            let mut vector = Vec::new();
            if let Some(image) = given {
                vector = image;
                parts = project_out(&block, &mut vector);
                length = length_of(&vector);
            }
            parts.push(if length > NOTHING { length } else { 0.0 });
            coupling.push(parts);
            while length <= NOTHING {
                vector = (0..self.root.len()).map(|_| self.random.unit() - 0.5).collect();
                project_out(&self.basis, &mut vector);
                project_out(&block, &mut vector);
                length = length_of(&vector);
            }
            vector.iter_mut().for_each(|x| *x /= length);
            block.push(vector);
        }
        block
    }

    /// The first eigenfunctions, if all of them have converged.
    fn found(&self, count: usize, coupling: &[Vec<f64>], total: f64) -> Result<Option<Spectrum>> {
        let size = self.basis.len();
        // Only the lower triangle is read; what lies beside the blocks next to the diagonal is rounding.
        let matrix: Vec<Vec<f64>> = self
            .projected
            .iter()
            .map(|row| (0..size).map(|j| row.get(j).copied().unwrap_or(0.0)).collect())
            .collect();
        let pairs: Vec<(f64, Vec<f64>)> =
            symmetric_eigenpairs(&matrix)?.into_iter().rev().take(count).collect();
        let open = |(value, vector): &(f64, Vec<f64>)| {
            let last = &vector[size - self.last..];
            let rest = (0..coupling.len()).map(|k| {
                let part = |(row, y): (&Vec<f64>, &f64)| row.get(k).map_or(0.0, |r| r * y);
                coupling.iter().zip(last).map(part).sum::<f64>()
            });
            rest.map(|r| r * r).sum::<f64>().sqrt() > self.tolerance * value.abs()
        };
        let is_whole = size == self.root.len();
        if !is_whole && (coupling.len() < self.last || pairs.iter().any(open)) {
            return Ok(None);
        }
        let functions = parallel::map(pairs.len(), |k| {
            let mut function = vec![0.0; self.root.len()];
            for (q, y) in self.basis.iter().zip(&pairs[k].1) {
                function.iter_mut().zip(q).for_each(|(f, q)| *f += y * q);
            }
            function.iter_mut().zip(&self.root).for_each(|(f, s)| *f /= s);
            function
        });
        let values = pairs.iter().map(|(value, _)| (1.0 / value - 1.0) / total).collect();
        Ok(Some(Spectrum { values, functions }))
    }
}

/// Rows of vectors that are worked on at once: those of a block stay in the cache while the basis is read once for all of them.
const ROWS: usize = 1024;

/// Takes the components along an orthonormal basis from vectors; returns them, per vector.
fn project_all_out(basis: &[Vec<f64>], vectors: &mut [Vec<f64>]) -> Vec<Vec<f64>> {
    let parts: Vec<Vec<f64>> =
        parallel::map(basis.len(), |k| vectors.iter().map(|vector| dot(&basis[k], vector)).collect());
    let n = vectors.first().map_or(0, Vec::len);
    let pieces = parallel::map(n.div_ceil(ROWS), |c| {
        let rows = ROWS * c..n.min(ROWS * (c + 1));
        let mut pieces: Vec<Vec<f64>> = vectors.iter().map(|vector| vector[rows.clone()].to_vec()).collect();
        for (q, parts) in basis.iter().zip(&parts) {
            for (piece, c) in pieces.iter_mut().zip(parts) {
                piece.iter_mut().zip(&q[rows.clone()]).for_each(|(x, q)| *x -= c * q);
            }
        }
        pieces
    });
    for (c, pieces) in pieces.into_iter().enumerate() {
        for (vector, piece) in vectors.iter_mut().zip(pieces) {
            vector[ROWS * c..][..piece.len()].copy_from_slice(&piece);
        }
    }
    (0..vectors.len()).map(|i| parts.iter().map(|row| row[i]).collect()).collect()
}

/// Takes the components along an orthonormal basis from a vector, twice because the first time leaves rounding; returns them.
fn project_out(basis: &[Vec<f64>], vector: &mut [f64]) -> Vec<f64> {
    let mut all = vec![0.0; basis.len()];
    for _ in 0..2 {
        let parts = parallel::map(basis.len(), |k| dot(&basis[k], vector));
        parallel::in_parts(vector, |start, part| {
            for (q, c) in basis.iter().zip(&parts) {
                part.iter_mut().zip(&q[start..]).for_each(|(x, q)| *x -= c * q);
            }
        });
        all.iter_mut().zip(parts).for_each(|(sum, c)| *sum += c);
    }
    all
}

fn length_of(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Surface;
    use crate::geometry::Space;
    use crate::linalg::dense::symmetric_eigenvalues;
    use crate::mesh::shapes;

    #[test]
    fn the_spectrum_of_a_small_mesh_is_that_of_its_dense_matrix() {
        let sphere = Surface::from_soup(&shapes::ellipsoid([1.0, 1.4, 0.7], 3).unwrap()).unwrap();
        let domain = Domain::new(&sphere, &Control::new()).unwrap();
        let n = domain.mesh().n_vertices();
        let root: Vec<f64> = domain.vertex_areas().iter().map(|a| a.sqrt()).collect();
        let column = |j: usize| {
            let mut unit = vec![0.0; n];
            unit[j] = 1.0 / root[j];
            domain.apply_laplacian(&unit).iter().zip(&root).map(|(x, s)| x / s).collect::<Vec<_>>()
        };
        let dense = symmetric_eigenvalues(&(0..n).map(column).collect::<Vec<_>>()).unwrap();
        for count in [6, n] {
            let found = spectrum(&domain, count, &Control::new()).unwrap();
            for (a, b) in found.values.iter().zip(&dense) {
                assert!((a - b).abs() < 1e-7 * (1.0 + b), "{a} instead of {b}");
            }
        }
    }

    #[test]
    fn a_square_torus_has_eigenvalues_of_multiplicity_four() {
        let (mesh, lengths) = shapes::flat_torus([0.0, 1.0], 16, 16).unwrap().build().unwrap();
        let torus = Surface::intrinsic(mesh, lengths, Space::E2).unwrap();
        let domain = Domain::new(&torus, &Control::new()).unwrap();
        let found = spectrum(&domain, 9, &Control::new()).unwrap();
        // 4 π² (a² + b²), for all whole numbers a and b.
        let unit = 4.0 * std::f64::consts::PI.powi(2);
        let exact = [0.0, 1.0, 1.0, 1.0, 1.0, 2.0, 2.0, 2.0, 2.0];
        for (found, exact) in found.values.iter().zip(exact) {
            assert!((found / unit - exact).abs() < 0.03 * (1.0 + exact), "{} {exact}", found / unit);
        }
    }
}
