//! Steps that keep triangles at features from closing: their sides are not flipped, so they would hold Newton's method up.

use super::holonomy_state::{HolonomyState, largest};
use super::least_norm::LeastNorm;
use crate::control::Control;
use crate::error::Result;
use std::f64::consts::PI;

/// An angle opposite to a feature above which a step opens the triangle, radians.
const WIDE: f64 = 0.75 * PI;
/// The largest share of what an angle is above [`WIDE`] that one step takes back.
const OPENED: f64 = 0.5;
/// An angle opposite to a feature may change otherwise by this much, radians, at the cost of a change of one λ by 1.
const SLACK: f64 = 0.1;

/// The least change of λ that removes what is missing to first order, while wide angles opposite to features become smaller.
///
/// # Errors
/// Those of [`LeastNorm::solution`].
pub(super) fn opening_step(
    state: &HolonomyState,
    missing: &[f64],
    equations: &mut LeastNorm,
    control: &Control,
) -> Result<Vec<f64>> {
    let (mut rows, mut right) = (state.derivatives(), missing.to_vec());
    let (n, share) = (state.mesh.n_edges(), largest(missing).min(OPENED));
    let mut columns = n;
    for f in state.mesh.faces() {
        let opposite = state.mesh.opposite_edges(f);
        for k in 0..3 {
            let excess = state.angles[f][k] - WIDE;
            if excess > 0.0 && state.sectors.is_feature(opposite[k]) {
                // An unknown of its own takes up what other equations need of this angle.
                let mut row = state.angle_derivative(f, k, 1.0).to_vec();
                row.push((columns as u32, SLACK));
                columns += 1;
                rows.push(row);
                right.push(-share * excess);
            }
        }
    }
    let mut step = equations.solution(&rows, columns, &right, control)?;
    step.truncate(n);
    Ok(step)
}
