//! The torus of revolution on a regular grid.

use super::{THIN, check_count, check_size, torus_grid};
use crate::error::{Error, Result};
use crate::mesh::io::Soup;
use std::f64::consts::TAU;

/// The torus of revolution about z with centre circle of radius `big` and tube radius `small` < `big`: `((R +
/// r cos v) cos u, (R + r cos v) sin u, r sin v)` on a regular grid of `n_u` × `n_v` angles, each cell halved
/// by its diagonal from (u, v) to the next (u, v). Vertex (i, j) is `i + n_u j`. Both counts ≥ 3.
///
/// Its flat metric has the modulus `i r/√(R² − r²)` up to SL(2, ℤ).
///
/// # Errors
///
/// [`Error::Argument`] for radii outside 1e-150 … 1e150, r/R within 1e-12 of 0 or of 1 or beyond, or
/// counts out of range.
pub fn torus(big: f64, small: f64, n_u: usize, n_v: usize) -> Result<Soup> {
    check_size("radius of the centre circle", big)?;
    check_size("radius of the tube", small)?;
    if !(THIN * big..=(1.0 - THIN) * big).contains(&small) {
        let need = "below that of the centre circle, and neither the tube nor its hole lost in rounding";
        return Err(Error::argument("radius of the tube", format!("{small:e}"), need));
    }
    let vertices = n_u as f64 * n_v as f64;
    check_count("steps around the axis", n_u, 3, vertices)?;
    check_count("steps around the tube", n_v, 3, vertices)?;
    Ok(torus_grid(n_u, n_v, |i, j| {
        let (sin_u, cos_u) = (TAU * i as f64 / n_u as f64).sin_cos();
        let (sin_v, cos_v) = (TAU * j as f64 / n_v as f64).sin_cos();
        let radius = big + small * cos_v;
        [radius * cos_u, radius * sin_u, small * sin_v]
    }))
}
