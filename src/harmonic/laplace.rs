//! Solves with the cotangent Laplacian, whose values at some vertices are held: one factorisation for many solves.
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

/// The row number of a vertex whose value is held.
const HELD: u32 = u32::MAX;

/// The factorised matrix of [`Domain::laplacian`] between the vertices that are not held, possibly with a mass added.
pub struct Laplace<'a> {
    domain: &'a Domain,
    /// Per vertex, its row, or [`HELD`].
    row: Vec<u32>,
    free: Vec<u32>,
    pattern: Pattern,
    cholesky: Cholesky,
    mass: Option<Vec<f64>>,
    /// The seconds for assembling, analysing and factorising.
    pub seconds: [f64; 3],
}

impl<'a> Laplace<'a> {
    /// Assembles and factorises the matrix. If no vertex is held, vertex 0 is held at 0, since solutions are only unique up to a constant
    /// then.
    ///
    /// # Errors
    /// [`Error::Factorisation`] if the matrix is not positive definite: on a surface of several components one of which has no held vertex,
    /// or with negative weights; [`Error::TooLarge`]; [`Error::Cancelled`].
    pub fn new(
        domain: &'a Domain,
        held: impl Fn(VertexId) -> bool,
        control: &Control,
    ) -> Result<Laplace<'a>> {
        let mut held: Vec<bool> = domain.mesh().vertices().map(held).collect();
        if !held.contains(&true)
            && let Some(first) = held.first_mut()
        {
            *first = true;
        }
        Laplace::analysed(domain, &held, None, control)
    }

    /// The matrix `M + L` for a mass per vertex (V entries, positive) with no vertex held. An implicit step of length τ of the heat flow
    /// has the mass ⋆0/τ.
    ///
    /// # Errors
    /// Those of [`Laplace::new`]; [`Error::Size`].
    pub fn with_mass(domain: &'a Domain, mass: &[f64], control: &Control) -> Result<Laplace<'a>> {
        let n = domain.mesh().n_vertices();
        check_size("masses", mass.len(), n)?;
        Laplace::analysed(domain, &vec![false; n], Some(mass.to_vec()), control)
    }

    /// As [`Laplace::with_mass`], between the vertices that are not held (V entries).
    ///
    /// # Errors
    /// Those of [`Laplace::with_mass`].
    pub fn held_with_mass(
        domain: &'a Domain,
        mass: &[f64],
        held: &[bool],
        control: &Control,
    ) -> Result<Laplace<'a>> {
        let n = domain.mesh().n_vertices();
        check_size("masses", mass.len(), n)?;
        check_size("held vertices", held.len(), n)?;
        Laplace::analysed(domain, held, Some(mass.to_vec()), control)
    }

    fn analysed(
        domain: &'a Domain,
        held: &[bool],
        mass: Option<Vec<f64>>,
        control: &Control,
    ) -> Result<Laplace<'a>> {
        control.check()?;
        let mesh = domain.mesh();
        let start = Instant::now();
        let free: Vec<u32> = (0..held.len() as u32).filter(|&v| !held[v as usize]).collect();
        let mut row = vec![HELD; held.len()];
        free.iter().enumerate().for_each(|(k, &v)| row[v as usize] = k as u32);
        let rows = |e| mesh.ends(e).map(|v| row[v.index()]);
        let pairs = mesh.edges().map(rows).filter(|[i, j]| *i != HELD && *j != HELD).map(|[i, j]| (i, j));
        let pattern = Pattern::new(free.len(), &pairs.collect::<Vec<_>>())?;
        let assembled = start.elapsed().as_secs_f64();
        control.check()?;
        let cholesky = Cholesky::analyse(&pattern)?;
        let seconds = [assembled, start.elapsed().as_secs_f64() - assembled, 0.0];
        let mut laplace = Laplace { domain, row, free, pattern, cholesky, mass, seconds };
        control.check()?;
        laplace.factor()?;
        Ok(laplace)
    }

    /// Factorises the matrix again with another mass.
    ///
    /// # Errors
    /// [`Error::Size`]; [`Error::Factorisation`].
    pub fn set_mass(&mut self, mass: &[f64]) -> Result<()> {
        check_size("masses", mass.len(), self.row.len())?;
        self.mass = Some(mass.to_vec());
        self.factor()
    }

    fn factor(&mut self) -> Result<()> {
        let start = Instant::now();
        let Laplace { domain, pattern, row, free, mass, cholesky, seconds } = self;
        let mut values = vec![0.0; pattern.entries()];
        for e in domain.mesh().edges() {
            let (weight, [i, j]) = (domain.weights()[e], domain.mesh().ends(e).map(|v| row[v.index()]));
            if i == j {
                continue;
            }
            let free = [i, j].into_iter().filter(|&i| i != HELD);
            free.for_each(|i| values[pattern.diagonal(i as usize)] += weight);
            if i != HELD
                && j != HELD
                && let Some(k) = pattern.position(i as usize, j as usize)
            {
                values[k] -= weight;
            }
        }
        for (k, &v) in free.iter().enumerate() {
            values[pattern.diagonal(k)] += mass.as_ref().map_or(0.0, |mass| mass[v as usize]);
        }
        let assembled = start.elapsed().as_secs_f64();
        let matrix = Symmetric { pattern, values: &values };
        cholesky.factor(matrix).map_err(|_| Error::Factorisation {
            size: free.len(),
            message: "the Laplacian is not positive definite: hold a vertex of every component, and use the Delaunay \
                      triangulation"
                .into(),
        })?;
        seconds[0] += assembled;
        seconds[2] += start.elapsed().as_secs_f64() - assembled;
        Ok(())
    }

    /// The mass that is added, per vertex.
    pub fn mass(&self) -> Option<&[f64]> {
        self.mass.as_deref()
    }

    /// The number of values in the factor.
    pub fn factor_entries(&self) -> usize {
        self.cholesky.factor_entries()
    }

    /// True if the value of a vertex is held.
    pub fn is_held(&self, v: usize) -> bool {
        self.row[v] == HELD
    }

    /// Solves for several right sides at once: each column of V entries is a load, and is replaced by u with `(L u)_i = load_i` at the free
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

    /// Extends a function from the held vertices so that `(L u)_i = load_i` (0 by default) at the free ones, whose values are overwritten.
    ///
    /// The load at a boundary vertex is the flux through the boundary around it: the integral of the derivative of u along the outer
    /// normal.
    ///
    /// # Errors
    /// Those of [`Laplace::solve`].
    pub fn extend(&self, u: &mut [f64], load: Option<&[f64]>) -> Result<()> {
        check_size("function", u.len(), self.row.len())?;
        self.free.iter().for_each(|&v| u[v as usize] = 0.0);
        // The second solve corrects the rounding errors of the first.
        for _ in 0..2 {
            let mut residual = self.apply(u);
            residual.iter_mut().enumerate().for_each(|(v, r)| *r = load.map_or(0.0, |load| load[v]) - *r);
            self.solve(&mut residual)?;
            u.iter_mut().zip(residual).for_each(|(u, x)| *u += x);
        }
        Ok(())
    }

    /// `L u`, or `(M + L) u` (V entries).
    fn apply(&self, u: &[f64]) -> Vec<f64> {
        let mut image = self.domain.apply_laplacian(u);
        if let Some(mass) = &self.mass {
            (0..u.len()).for_each(|v| image[v] += mass[v] * u[v]);
        }
        image
    }
}
