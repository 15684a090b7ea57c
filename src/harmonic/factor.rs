//! The residual of a conformal factor between two metrics in the equation that relates it to their curvatures.
//!
//! The curvature of `ḡ = e^{2λ} g` satisfies `K̄ e^{2λ} = K + Δλ`, with Δ ≥ 0 of g, and that of its boundary `k̄ e^λ = k + ∂λ/∂n`
//! \[JKLLG08, Eqn 5\]. Against the hat function of vertex i, whose integrals of curvature are K_i and K̄_i, both say
//!
//! ```text
//!     Σ_j w_ij (λ_i − λ_j) = K̄_i − K_i.
//! ```
//!
//! ```
//! use ricci::harmonic::{Domain, factor::{curvature_integrals, factor_residual}};
//! use ricci::{Control, Surface, mesh::shapes};
//! // The torus of revolution is flat over its squared distance from the axis.
//! let soup = shapes::torus(2.0, 0.8, 64, 32)?;
//! let factor: Vec<f64> = soup.positions.iter().map(|[x, y, _]| -x.hypot(*y).ln()).collect();
//! let domain = Domain::new(&Surface::from_soup(&soup)?, &Control::new())?;
//! let flat = vec![0.0; factor.len()];
//! assert!(factor_residual(&domain, &factor, &flat, &Control::new())? < 0.01);
//! # Ok::<(), ricci::Error>(())
//! ```

use super::domain::Domain;
use super::laplace::Laplace;
use crate::control::Control;
use crate::error::{Result, check_size};
use crate::flow::Solution;
use crate::geometry::{Space, triangle};
use crate::mesh::{PerVertex, VertexId};
use crate::metric::lengths::face_lengths;

/// The relative residual of a conformal factor λ (V entries) in the weak equation above, for the factor from the metric of a domain to one
/// with these integrals of curvature around its vertices ([`curvature_integrals`]; V entries). It is the norm of the residual dual to
/// `‖∇φ‖`, over that of `K̄ − K`, and equals `‖∇(λ − μ)‖ / ‖∇μ‖` with the solution μ of the equation; 0 if λ is constant and both
/// curvatures are the same.
///
/// It falls as h² for the factor of smooth metrics.
///
/// # Errors
/// [`crate::Error::Size`]; those of [`Laplace::new`].
pub fn factor_residual(domain: &Domain, factor: &[f64], curvature: &[f64], control: &Control) -> Result<f64> {
    let n = domain.mesh().n_vertices();
    check_size("conformal factor", factor.len(), n)?;
    check_size("integrals of curvature", curvature.len(), n)?;
    let given = curvature_integrals(domain.metric())?;
    let load: Vec<f64> = curvature.iter().zip(&given).map(|(after, before)| after - before).collect();
    let mut solution = vec![0.0; n];
    Laplace::new(domain, |_| false, control)?.extend(&mut solution, Some(&load))?;
    let off: Vec<f64> = factor.iter().zip(&solution).map(|(a, b)| a - b).collect();
    let (off, size) = (domain.energy(&off)?.max(0.0).sqrt(), domain.energy(&solution)?.max(0.0).sqrt());
    Ok(if off == 0.0 { 0.0 } else { off / size.max(f64::MIN_POSITIVE) })
}

/// [`factor_residual`] of the conformal factor of a flow's result, on the intrinsic Delaunay triangulation of the surface as it was given.
///
/// # Errors
/// Those of [`Domain::new`], [`curvature_integrals`], [`Solution::conformal_factor`] and [`factor_residual`].
pub fn solution_residual(solution: &Solution, control: &Control) -> Result<f64> {
    let domain = Domain::new(solution.surface(), control)?;
    factor_residual(&domain, &solution.conformal_factor()?, &curvature_integrals(solution)?, control)
}

/// The integral of curvature around every vertex of the given surface: the discrete curvature, and in H² and S² a third of the integral
/// over every face around it. The integrals add up to 2πχ.
///
/// # Errors
/// Those of [`crate::metric::Metric::lengths`].
pub fn curvature_integrals(metric: &Solution) -> Result<PerVertex<f64>> {
    let mut around = metric.curvature()?.at;
    let (mesh, space) = (metric.mesh(), metric.metric().space);
    if space == Space::E2 {
        return Ok(around);
    }
    let lengths = metric.metric().lengths(mesh)?;
    // Around a boundary vertex of a surface that was solved on its double, half of the faces are those of the mirror image.
    let is_inside = |v: VertexId| metric.double().is_none_or(|double| double.mirror(v) != v);
    for f in mesh.faces() {
        let part = space.curvature() * triangle::area(space, face_lengths(mesh, &lengths, f)) / 3.0;
        for v in mesh.face_vertices(f) {
            if let Some(sum) = around.get_mut(v.index()) {
                *sum += if is_inside(v) { part } else { 0.5 * part };
            }
        }
    }
    Ok(around)
}
