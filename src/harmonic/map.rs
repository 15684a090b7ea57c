//! Harmonic maps to Rⁿ with given values or fluxes, and the heat flow that converges to them.
//!
//! ```
//! use ricci::{Control, Surface, harmonic::{Domain, MapConstraints, harmonic_map}, mesh::shapes};
//! let disk = Surface::from_soup(&shapes::disk(6)?)?;
//! let domain = Domain::new(&disk, &Control::new())?;
//! let mesh = domain.mesh();
//! let place = |v: ricci::mesh::VertexId| disk.positions().unwrap()[v.index()];
//! let values = mesh.vertices().filter(|&v| mesh.is_boundary_vertex(v)).map(|v| (v, place(v))).collect();
//! let map = harmonic_map(&domain, &MapConstraints { values, flux: None }, &Control::new())?;
//! // The identity of a plane disk is harmonic.
//! assert!(mesh.vertices().all(|v| (0..3).all(|k| (map.points[v.index()][k] - place(v)[k]).abs() < 1e-12)));
//! # Ok::<(), ricci::Error>(())
//! ```

use super::domain::Domain;
use super::laplace::Laplace;
use crate::control::Control;
use crate::error::{Error, Result, check_size};
use crate::geometry::worse;
use crate::mesh::VertexId;
use crate::topology::check_vertex;

/// The values and fluxes that a harmonic map to Rⁿ must have.
#[derive(Debug, Clone, PartialEq)]
pub struct MapConstraints<const N: usize> {
    /// The vertices with given images, and these images (Dirichlet).
    pub values: Vec<(VertexId, [f64; N])>,
    /// Per vertex (V entries), the flux through the boundary around it, the integral of the derivative along the outer normal (Neumann); 0
    /// by default. Without `values` the fluxes must add up to 0.
    pub flux: Option<Vec<[f64; N]>>,
}

/// A harmonic map of the vertices to Rⁿ.
#[derive(Debug, Clone, PartialEq)]
pub struct HarmonicMap<const N: usize> {
    /// Per vertex of the domain, its image.
    pub points: Vec<[f64; N]>,
    /// The energy `½ Σ w_ij |f_i − f_j|²`.
    pub energy: f64,
    /// The residual of the mean-value property at vertices without a given value: the largest distance of an image from the weighted mean
    /// of its neighbours' images (corrected by the flux), over the size of the image.
    pub mean_value_residual: f64,
}

/// Largest sum of the fluxes, relative to the sum of their absolute values, if no value is given.
const MOST_IMBALANCE: f64 = 1e-10;

/// The harmonic map with given values and fluxes, from one factorisation for all coordinates. Without a given value, the image of vertex 0
/// is 0.
///
/// # Errors
/// [`Error::Argument`] for values that are not finite or belong to no vertex, for fluxes that do not add up to 0 if no value is given, and
/// for values so far apart that the energy overflows; [`Error::Size`]; those of [`Laplace::new`].
pub fn harmonic_map<const N: usize>(
    domain: &Domain,
    data: &MapConstraints<N>,
    control: &Control,
) -> Result<HarmonicMap<N>> {
    let (mut points, held) = start_of(domain, data)?;
    let laplace = Laplace::new(domain, |v| held[v.index()], control)?;
    for k in 0..N {
        control.check()?;
        let mut column: Vec<f64> = points.iter().map(|p| p[k]).collect();
        let load: Option<Vec<f64>> = data.flux.as_ref().map(|flux| flux.iter().map(|x| x[k]).collect());
        laplace.extend(&mut column, load.as_deref())?;
        points.iter_mut().zip(column).for_each(|(p, x)| p[k] = x);
    }
    let is_free = |v: usize| !laplace.is_held(v);
    let mean_value_residual = mean_value_residual(domain, &points, data.flux.as_deref(), is_free);
    let energy = energy(domain, &points);
    if !energy.is_finite() {
        return Err(Error::argument("energy of the map", energy, "finite: the values are too far apart"));
    }
    Ok(HarmonicMap { energy, mean_value_residual, points })
}

/// The given values, 0 at the other vertices, and per vertex whether it has a given value.
///
/// # Errors
/// As [`harmonic_map`] for the data.
pub(super) fn start_of<const N: usize>(
    domain: &Domain,
    data: &MapConstraints<N>,
) -> Result<(Vec<[f64; N]>, Vec<bool>)> {
    let n = domain.mesh().n_vertices();
    let mut points = vec![[0.0; N]; n];
    let mut held = vec![false; n];
    for &(v, value) in &data.values {
        check_vertex(domain.mesh(), v)?;
        if !value.iter().all(|x| x.is_finite()) {
            return Err(Error::argument(
                "value at a vertex",
                v,
                "a finite point for every vertex that has one",
            ));
        }
        (points[v.index()], held[v.index()]) = (value, true);
    }
    if let Some(flux) = &data.flux {
        check_flux(flux, n, data.values.is_empty())?;
    }
    Ok((points, held))
}

fn check_flux<const N: usize>(flux: &[[f64; N]], n: usize, is_all: bool) -> Result<()> {
    check_size("flux", flux.len(), n)?;
    for k in 0..N {
        let (sum, size) = flux.iter().fold((0.0, 0.0), |(sum, size), x| (sum + x[k], size + x[k].abs()));
        let fits = size.is_finite() && (!is_all || f64::abs(sum) <= MOST_IMBALANCE * size);
        if !fits {
            return Err(Error::argument("sum of the fluxes", sum, "finite, and 0 where no value is given"));
        }
    }
    Ok(())
}

/// The energy `½ Σ w_ij |f_i − f_j|²` of a map (V entries).
pub fn energy<const N: usize>(domain: &Domain, points: &[[f64; N]]) -> f64 {
    let mesh = domain.mesh();
    let square = |[p, q]: [[f64; N]; 2]| (0..N).map(|k| (p[k] - q[k]) * (p[k] - q[k])).sum::<f64>();
    mesh.edges().map(|e| 0.5 * domain.weights()[e] * square(mesh.ends(e).map(|v| points[v.index()]))).sum()
}

/// [`HarmonicMap::mean_value_residual`] over the vertices that count.
pub(super) fn mean_value_residual<const N: usize>(
    domain: &Domain,
    points: &[[f64; N]],
    flux: Option<&[[f64; N]]>,
    counts: impl Fn(usize) -> bool,
) -> f64 {
    let mesh = domain.mesh();
    let total = |v: VertexId| mesh.outgoing(v).map(|h| domain.weights()[h.edge()]).sum::<f64>();
    let (mut worst, mut size) = (0.0, 0.0);
    for k in 0..N {
        let column: Vec<f64> = points.iter().map(|p| p[k]).collect();
        let range = column.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], &x| [a.min(x), b.max(x)]);
        size = worse(size, range[1] - range[0]);
        let image = domain.apply_laplacian(&column);
        for v in mesh.vertices().filter(|v| counts(v.index())) {
            let off = image[v.index()] - flux.map_or(0.0, |flux| flux[v.index()][k]);
            worst = worse(worst, (off / total(v)).abs());
        }
    }
    if size > 0.0 { worst / size } else { worst }
}

/// One implicit step `(⋆0 + τ L) f' = ⋆0 f` of the heat flow `df/dt = −⋆0⁻¹ L f` of a map, which lowers its energy. `step`: τ, in units of
/// area.
///
/// # Errors
/// [`Error::Argument`] for a step that is not positive; [`Error::Size`]; those of [`Laplace::with_mass`].
pub fn heat_step<const N: usize>(
    domain: &Domain,
    points: &mut [[f64; N]],
    step: f64,
    control: &Control,
) -> Result<()> {
    check_size("map", points.len(), domain.mesh().n_vertices())?;
    if !(step > 0.0 && step.is_finite()) {
        return Err(Error::argument("step of the heat flow", step, "positive and finite"));
    }
    let mass: Vec<f64> = domain.vertex_areas().iter().map(|area| area / step).collect();
    let heat = Laplace::with_mass(domain, &mass, control)?;
    heat.step(points)
}

impl Laplace<'_> {
    /// Replaces a map f (V entries) by `(M + L)⁻¹ M f`, if the matrix has a mass M ([`Laplace::with_mass`]).
    ///
    /// # Errors
    /// [`Error::Argument`] for a matrix without mass; those of [`Laplace::solve`].
    pub fn step<const N: usize>(&self, points: &mut [[f64; N]]) -> Result<()> {
        let Some(mass) = self.mass() else {
            return Err(Error::argument("mass", "none", "one per vertex, for a step of the heat flow"));
        };
        let column = |k: usize| points.iter().zip(mass).map(move |(p, m)| m * p[k]);
        let mut columns: Vec<f64> = (0..N).flat_map(column).collect();
        self.solve(&mut columns)?;
        let n = points.len();
        points.iter_mut().enumerate().for_each(|(v, p)| *p = std::array::from_fn(|k| columns[k * n + v]));
        Ok(())
    }
}
