//! The heat flow of maps to Rⁿ, `df/dt = Δf` with held values, which converges to the harmonic map and lowers the energy all the way.
//!
//! ```
//! use ricci::harmonic::{Domain, HeatOptions, MapConstraints, heat_flow, planar};
//! use ricci::{Control, Surface, mesh::shapes};
//! let disk = Surface::from_soup(&shapes::disk(6)?)?;
//! let domain = Domain::new(&disk, &Control::new())?;
//! let data = MapConstraints { values: planar::disk_values(&domain)?, flux: None };
//! let flow = heat_flow(&domain, &data, &HeatOptions::default(), &Control::new())?;
//! assert!(flow.converged && flow.energies.windows(2).all(|pair| pair[1] < pair[0] * (1.0 + 1e-14)));
//! # Ok::<(), ricci::Error>(())
//! ```

use super::domain::Domain;
use super::laplace::Laplace;
use super::map::{HarmonicMap, MapConstraints, energy, mean_value_residual, start_of};
use crate::control::{Control, Stage};
use crate::error::{Error, Result};

/// Options of [`heat_flow`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeatOptions {
    /// The length τ of a step, a time in units of area; 0, the default, for a hundredth of the surface's area.
    pub step: f64,
    /// The residual of the mean-value property up to which the map counts as harmonic ([`HarmonicMap::mean_value_residual`]). Default 1e-11.
    pub tolerance: f64,
    /// Most steps. Default 10,000.
    pub max_iterations: usize,
}

impl Default for HeatOptions {
    fn default() -> Self {
        HeatOptions { step: 0.0, tolerance: 1e-11, max_iterations: 10_000 }
    }
}

/// The map at the end of a heat flow, and its energy on the way.
#[derive(Debug, Clone, PartialEq)]
pub struct HeatFlow<const N: usize> {
    /// The last map.
    pub map: HarmonicMap<N>,
    /// The energy `½ Σ w_ij |f_i − f_j|²` at the start and after every step.
    pub energies: Vec<f64>,
    /// The length of a step, a time in units of area.
    pub step: f64,
    /// True if the last map was within the tolerance.
    pub converged: bool,
}

/// Share of the surface's area that a step is by default: a disk needs about 100 of them.
const STEP: f64 = 0.01;

/// The heat flow `⋆0 df/dt = −L f` \[JKLLG08, Eqn 7, with L ≥ 0\] by implicit steps `(⋆0 + τ L) f' = ⋆0 f`, from the map that has the given
/// values and is their mean elsewhere. One factorisation serves all steps. A step of any length lowers the energy, by
/// `|f' − f|²/τ + E(f' − f)` with the norm of ⋆0, where the weights are those of a Delaunay triangulation.
///
/// # Errors
/// [`Error::Argument`] for a step that is negative or not finite, a tolerance that is not positive, and data without a given value; those of
/// [`super::harmonic_map`]; [`Error::Cancelled`].
pub fn heat_flow<const N: usize>(
    domain: &Domain,
    data: &MapConstraints<N>,
    options: &HeatOptions,
    control: &Control,
) -> Result<HeatFlow<N>> {
    let HeatOptions { step, tolerance, max_iterations } = *options;
    if !(step >= 0.0 && step.is_finite()) {
        return Err(Error::argument(
            "step of the heat flow",
            step,
            "finite, and positive or 0 for the default",
        ));
    }
    if tolerance.is_nan() || tolerance <= 0.0 {
        return Err(Error::argument("tolerance", tolerance, "positive"));
    }
    if data.values.is_empty() {
        return Err(Error::argument(
            "given values",
            "none",
            "at least one: without any the flow ends in a point",
        ));
    }
    let (mut points, held) = start_of(domain, data)?;
    spread_mean(&mut points, &held, data);
    let area: f64 = domain.face_areas().iter().sum();
    let step = if step > 0.0 { step } else { STEP * area };
    let mass: Vec<f64> = domain.vertex_areas().iter().map(|area| area / step).collect();
    let laplace = Laplace::held_with_mass(domain, &mass, &held, control)?;
    let flux = data.flux.as_deref();
    let residual = |points: &[[f64; N]]| mean_value_residual(domain, points, flux, |v| !held[v]);
    let mut energies = vec![energy(domain, &points)];
    let mut off = residual(&points);
    while off > tolerance && energies.len() <= max_iterations {
        control.step(Stage::Flow, energies.len() as f64 / max_iterations as f64)?;
        advance(domain, &laplace, &mut points, flux)?;
        energies.push(energy(domain, &points));
        off = residual(&points);
    }
    let last = energies[energies.len() - 1];
    if !last.is_finite() {
        return Err(Error::argument("energy of the map", last, "finite: the values are too far apart"));
    }
    let map = HarmonicMap { points, energy: last, mean_value_residual: off };
    Ok(HeatFlow { map, energies, step, converged: off <= tolerance })
}

/// One step: `f' = f − (M + L)⁻¹ (L f − flux)`, which keeps the digits of f where the flow has nearly come to rest.
fn advance<const N: usize>(
    domain: &Domain,
    laplace: &Laplace<'_>,
    points: &mut [[f64; N]],
    flux: Option<&[[f64; N]]>,
) -> Result<()> {
    let n = points.len();
    let mut columns = Vec::with_capacity(N * n);
    for k in 0..N {
        let column: Vec<f64> = points.iter().map(|p| p[k]).collect();
        let image = domain.apply_laplacian(&column);
        columns.extend(image.iter().enumerate().map(|(v, x)| flux.map_or(0.0, |flux| flux[v][k]) - x));
    }
    laplace.solve(&mut columns)?;
    points.iter_mut().enumerate().for_each(|(v, p)| (0..N).for_each(|k| p[k] += columns[k * n + v]));
    Ok(())
}

/// Put the vertices without a given value at the mean of the given ones.
fn spread_mean<const N: usize>(points: &mut [[f64; N]], held: &[bool], data: &MapConstraints<N>) {
    let count = data.values.len() as f64;
    let mean: [f64; N] =
        std::array::from_fn(|k| data.values.iter().map(|(_, value)| value[k] / count).sum::<f64>());
    points.iter_mut().zip(held).filter(|(_, held)| !**held).for_each(|(p, _)| *p = mean);
}
