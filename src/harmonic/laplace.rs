//! The cotangent Laplacian with some vertices held: one factorisation for many solves.
//!
//! ```
//! use ricci::{Control, Surface, harmonic::{Domain, Laplace}, mesh::shapes};
//! let disk = Surface::from_soup(&shapes::disk(8)?)?;
//! let domain = Domain::new(&disk, &Control::new())?;
//! let mesh = domain.mesh();
//! let laplace = Laplace::new(&domain, |v| mesh.is_boundary_vertex(v), &Control::new())?;
//! // x is harmonic in the plane: from its boundary values alone it comes back.
//! let x: Vec<f64> = disk.positions().unwrap().iter().map(|p| p[0]).collect();
//! let mut u: Vec<f64> = mesh.vertices().map(|v| if mesh.is_boundary_vertex(v) { x[v.index()] } else { 0.0 }).collect();
//! laplace.extend(&mut u, None)?;
//! assert!(u.iter().zip(&x).all(|(u, x)| (u - x).abs() < 1e-12));
//! # Ok::<(), ricci::Error>(())
//! ```

use super::domain::Domain;
use crate::control::Control;
use crate::error::{Error, Result, check_size};
use crate::linalg::{Cholesky, Pattern, Symmetric};
use crate::mesh::VertexId;
use std::time::Instant;

/// The number of a vertex that is held.
const HELD: u32 = u32::MAX;

/// The matrix of [`Domain::laplacian`] between the vertices that are not held, factorised.
pub struct Laplace<'a> {
    domain: &'a Domain,
    /// Per vertex its row, or [`HELD`].
    row: Vec<u32>,
    free: Vec<u32>,
    cholesky: Cholesky,
    /// Seconds of assembling, analysing and factorising.
    pub seconds: [f64; 3],
}

impl<'a> Laplace<'a> {
    /// Assemble and factorise. Where no vertex is held, vertex 0 is, at 0: solutions are unique up to constants then.
    ///
    /// # Errors
    /// [`Error::Factorisation`] where the weights do not hold the free vertices to the held ones: on a surface of several components
    /// with none held on one, or with weights that are negative; [`Error::TooLarge`]; [`Error::Cancelled`].
    pub fn new(
        domain: &'a Domain,
        held: impl Fn(VertexId) -> bool,
        control: &Control,
    ) -> Result<Laplace<'a>> {
        control.check()?;
        let mesh = domain.mesh();
        let start = Instant::now();
        let mut row: Vec<u32> = mesh.vertices().map(|v| if held(v) { HELD } else { 0 }).collect();
        if !row.contains(&HELD) && !row.is_empty() {
            row[0] = HELD;
        }
        let free: Vec<u32> = (0..row.len() as u32).filter(|&v| row[v as usize] != HELD).collect();
        free.iter().enumerate().for_each(|(k, &v)| row[v as usize] = k as u32);
        let rows = |e| mesh.ends(e).map(|v| row[v.index()]);
        let is_inner = |[i, j]: &[u32; 2]| *i != HELD && *j != HELD && i != j;
        let pairs: Vec<_> = mesh.edges().map(rows).filter(is_inner).map(|[i, j]| (i, j)).collect();
        let pattern = Pattern::new(free.len(), &pairs)?;
        let mut values = vec![0.0; pattern.entries()];
        for e in mesh.edges() {
            let (weight, [i, j]) = (domain.weights()[e], rows(e));
            if i == j {
                continue;
            }
            [i, j]
                .into_iter()
                .filter(|&i| i != HELD)
                .for_each(|i| values[pattern.diagonal(i as usize)] += weight);
            if let Some(k) = is_inner(&[i, j]).then(|| pattern.position(i as usize, j as usize)).flatten() {
                values[k] -= weight;
            }
        }
        let assembled = Instant::now();
        control.check()?;
        let mut cholesky = Cholesky::analyse(&pattern)?;
        let analysed = Instant::now();
        control.check()?;
        cholesky.factor(Symmetric { pattern: &pattern, values: &values }).map_err(|_| Error::Factorisation {
            size: free.len(),
            message: "the Laplacian is not positive definite: hold a vertex of every component, and use the Delaunay \
                      triangulation"
                .into(),
        })?;
        let seconds = [assembled - start, analysed - assembled, analysed.elapsed()].map(|s| s.as_secs_f64());
        Ok(Laplace { domain, row, free, cholesky, seconds })
    }

    /// Number of vertices that are not held.
    pub fn n_free(&self) -> usize {
        self.free.len()
    }

    /// Number of values in the factor.
    pub fn factor_entries(&self) -> usize {
        self.cholesky.factor_entries()
    }

    /// Whether a vertex is held.
    pub fn is_held(&self, v: usize) -> bool {
        self.row[v] == HELD
    }

    /// Solve for several right sides at once: each column of V entries is a load, and becomes u with `(L u)_i = load_i` at the free
    /// vertices and u = 0 at the held ones.
    ///
    /// # Errors
    /// [`Error::Size`]; [`Error::Factorisation`] for lack of memory.
    pub fn solve(&self, columns: &mut [f64]) -> Result<()> {
        let (n, m) = (self.row.len(), self.free.len());
        check_size("loads", columns.len() % n.max(1), 0)?;
        if m > 0 {
            let load = |column: &[f64]| self.free.iter().map(|&v| column[v as usize]).collect::<Vec<_>>();
            let mut x: Vec<f64> = columns.chunks(n).flat_map(load).collect();
            self.cholesky.solve_columns(&mut x)?;
            for (column, x) in columns.chunks_mut(n).zip(x.chunks(m)) {
                self.free.iter().zip(x).for_each(|(&v, &x)| column[v as usize] = x);
            }
        }
        columns.chunks_mut(n).for_each(|c| (0..n).filter(|&v| self.is_held(v)).for_each(|v| c[v] = 0.0));
        Ok(())
    }

    /// Extend a function from the held vertices: `(L u)_i = load_i` (0 by default) at the free ones, whose values are overwritten.
    ///
    /// On the boundary a load is the flux through it: the integral of the derivative of u along the outer normal around the vertex.
    ///
    /// # Errors
    /// Those of [`Laplace::solve`].
    pub fn extend(&self, u: &mut [f64], load: Option<&[f64]>) -> Result<()> {
        check_size("function", u.len(), self.row.len())?;
        self.free.iter().for_each(|&v| u[v as usize] = 0.0);
        // Twice: the second time corrects what rounding has left.
        for _ in 0..2 {
            let mut residual = self.apply(u);
            residual.iter_mut().enumerate().for_each(|(v, r)| *r = load.map_or(0.0, |load| load[v]) - *r);
            self.solve(&mut residual)?;
            u.iter_mut().zip(residual).for_each(|(u, x)| *u += x);
        }
        Ok(())
    }

    /// `L u` (V entries).
    fn apply(&self, u: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; u.len()];
        for e in self.domain.mesh().edges() {
            let [i, j] = self.domain.mesh().ends(e).map(|v| v.index());
            let flux = self.domain.weights()[e] * (u[i] - u[j]);
            out[i] += flux;
            out[j] -= flux;
        }
        out
    }
}
