//! The multiples of 90° that are nearest to the turning of loops, in the energy of the field that turns by the difference.
//!
//! A field of directions with given cones differs from the one without harmonic part by harmonic fields, whose energy is that of their
//! periods. The whole numbers of least energy are those of the smoothest field of four directions with these cones.

use super::dual_loops::DualLoops;
use super::holonomy_state::HolonomyState;
use crate::error::{Error, Result};
use crate::linalg::dense::solve_definite;
use crate::linalg::{Cholesky, Pattern, Symmetric};
use std::f64::consts::FRAC_PI_2;

/// Rounds of the descent by single numbers; each ends where no number changes.
const ROUNDS: usize = 100;
/// Least relative gain for which a number is changed, so that rounding decides nothing.
const GAIN: f64 = 1e-9;
/// Relative shift of a Laplacian that rounding leaves without a factor.
const SHIFT: f64 = 1e-12;

/// For each loop the number of quarter turns nearest to its turning, together.
///
/// # Errors
/// [`Error::Factorisation`].
pub(super) fn nearest_quarter_turns(state: &HolonomyState) -> Result<Vec<i32>> {
    let wanted: Vec<f64> = state.turning().iter().map(|turning| turning / FRAC_PI_2).collect();
    if wanted.is_empty() {
        return Ok(Vec::new());
    }
    let inverse = inverse_of(&period_energies(state)?)?;
    let mut chosen: Vec<f64> = wanted.iter().map(|x| x.round()).collect();
    let n = wanted.len();
    for _ in 0..ROUNDS {
        let mut is_settled = true;
        for i in 0..n {
            // The energy is quadratic in this number; its least value lies at the difference that the others leave.
            let others: f64 =
                (0..n).filter(|&j| j != i).map(|j| inverse[i][j] * (chosen[j] - wanted[j])).sum();
            let best = wanted[i] - others / inverse[i][i];
            let energy = |k: f64| inverse[i][i] * (k - best) * (k - best);
            if energy(best.round()) < energy(chosen[i]) - GAIN * inverse[i][i] {
                (chosen[i], is_settled) = (best.round(), false);
            }
        }
        if is_settled {
            break;
        }
    }
    Ok(chosen.iter().map(|x| *x as i32).collect())
}

fn inverse_of(matrix: &[Vec<f64>]) -> Result<Vec<Vec<f64>>> {
    let n = matrix.len();
    let unit = |i: usize| (0..n).map(|j| f64::from(u8::from(i == j))).collect();
    solve_definite(matrix, &(0..n).map(unit).collect::<Vec<_>>())
}

/// The matrix `G_ij = Σ w h_i h_j` of the harmonic fields whose cochains count crossings of the loops.
fn period_energies(state: &HolonomyState) -> Result<Vec<Vec<f64>>> {
    let mesh = &state.mesh;
    let mut weights = vec![0.0; mesh.n_edges()];
    for f in mesh.faces() {
        let half_cotangents = state.half_cotangents[f];
        mesh.opposite_edges(f).iter().zip(half_cotangents).for_each(|(e, w)| weights[e.index()] += w);
    }
    let mut forms: Vec<Vec<f64>> =
        (0..state.loops.len()).map(|k| crossings(&state.loops, k, mesh.n_edges())).collect();
    let (pattern, values) = laplacian(state, &weights)?;
    let mut cholesky = Cholesky::analyse(&pattern)?;
    let failed = |_| Error::Factorisation {
        size: pattern.size(),
        message: "the Laplacian of the flat cone metric is not positive definite".into(),
    };
    cholesky.factor(Symmetric { pattern: &pattern, values: &values }).map_err(failed)?;
    for form in &mut forms {
        let mut g = vec![0.0; mesh.n_vertices()];
        for e in mesh.edges() {
            let [a, b] = mesh.ends(e).map(|v| v.index());
            let flow = weights[e.index()] * form[e.index()];
            (g[a], g[b]) = (g[a] - flow, g[b] + flow);
        }
        cholesky.solve(&mut g[1..]);
        g[0] = 0.0;
        for e in mesh.edges() {
            let [a, b] = mesh.ends(e).map(|v| v.index());
            form[e.index()] -= g[b] - g[a];
        }
    }
    let product =
        |a: &Vec<f64>, b: &Vec<f64>| a.iter().zip(b).zip(&weights).map(|((a, b), w)| a * b * w).sum();
    Ok(forms.iter().map(|a| forms.iter().map(|b| product(a, b)).collect()).collect())
}

/// Per edge, the crossings of a loop over its first half-edge less those over its second.
fn crossings(loops: &DualLoops, k: usize, n_edges: usize) -> Vec<f64> {
    let mut counts = vec![0.0; n_edges];
    loops.path(k).iter().for_each(|h| counts[h.edge().index()] += if h.0 & 1 == 0 { 1.0 } else { -1.0 });
    counts
}

/// The cotangent Laplacian between all vertices but the first.
fn laplacian(state: &HolonomyState, weights: &[f64]) -> Result<(Pattern, Vec<f64>)> {
    let mesh = &state.mesh;
    let n = mesh.n_vertices() - 1;
    let rows = |e| mesh.ends(e).map(|v| v.index().checked_sub(1));
    let pair = |e| match rows(e) {
        [Some(i), Some(j)] => Some((i as u32, j as u32)),
        _ => None,
    };
    let pattern = Pattern::new(n, &mesh.edges().filter_map(pair).collect::<Vec<_>>())?;
    let mut values = vec![0.0; pattern.entries()];
    for e in mesh.edges() {
        let w = weights[e.index()];
        let [a, b] = rows(e);
        if a == b {
            // An edge from a vertex to itself has no difference of values.
            continue;
        }
        [a, b].into_iter().flatten().for_each(|i| values[pattern.diagonal(i)] += w);
        if let (Some(i), Some(j)) = (a, b)
            && let Some(at) = pattern.position(i, j)
        {
            values[at] -= w;
        }
    }
    let mean = (0..n).map(|i| values[pattern.diagonal(i)]).sum::<f64>() / n.max(1) as f64;
    (0..n).for_each(|i| values[pattern.diagonal(i)] += SHIFT * mean);
    Ok((pattern, values))
}
