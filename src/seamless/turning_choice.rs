//! The multiples of 90° that are nearest to the turning of paths, in the energy of the field that turns by the difference.
//!
//! A field of directions with given cones differs from the one without harmonic part by harmonic fields, whose energy is that of their
//! periods. The whole numbers of least energy are those of the smoothest field of four directions with these cones. Fields along features
//! stay so if the harmonic field does not turn along them: its conjugate is free there, on each side for itself.

use super::dual_loops::{DualLoops, Passage};
use super::holonomy_state::{HolonomyState, HolonomyTarget};
use crate::error::{Error, Result};
use crate::linalg::dense::solve_definite;
use crate::linalg::{Cholesky, Pattern, Symmetric};
use crate::mesh::{HalfedgeId, Mesh};
use std::f64::consts::FRAC_PI_2;

/// Rounds of the descent by single numbers; each ends where no number changes.
const ROUNDS: usize = 100;
/// Least relative gain for which a number is changed, so that rounding decides nothing.
const GAIN: f64 = 1e-9;
/// Largest difference of an angle from its target, radians, for which a metric has the angles of the target.
const SETTLED: f64 = 1e-7;
/// Relative shift of a Laplacian that rounding leaves without a factor.
const SHIFT: f64 = 1e-12;

/// For each path the number of quarter turns nearest to its turning, together.
///
/// # Errors
/// [`Error::Factorisation`].
pub(super) fn nearest_quarter_turns(state: &HolonomyState, target: &HolonomyTarget) -> Result<Vec<i32>> {
    if state.loops.is_empty() {
        return Ok(Vec::new());
    }
    let mut harmonic = HarmonicFields::new(state)?;
    let wanted: Vec<f64> = harmonic.turning(state, target).iter().map(|x| x / FRAC_PI_2).collect();
    let inverse = inverse_of(&harmonic.period_energies(state))?;
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

/// The Laplacian whose solutions are conjugate to harmonic fields.
struct HarmonicFields {
    sides: Vec<WeightedSide>,
    cholesky: Cholesky,
    size: usize,
}

impl HarmonicFields {
    fn new(state: &HolonomyState) -> Result<HarmonicFields> {
        let sides = weighted_sides(state);
        let (pattern, values) = laplacian(&sides, state.equations().iter().flatten().count())?;
        let size = pattern.size();
        let mut cholesky = Cholesky::analyse(&pattern)?;
        let message = "the Laplacian of the flat cone metric is not positive definite";
        let failed = |_| Error::Factorisation { size, message: message.into() };
        cholesky.factor(Symmetric { pattern: &pattern, values: &values }).map_err(failed)?;
        Ok(HarmonicFields { sides, cholesky, size })
    }

    /// The turning of paths once a conformal change, of each piece for itself, has brought the angles of sectors to the target.
    fn turning(&mut self, state: &HolonomyState, target: &HolonomyTarget) -> Vec<f64> {
        let mut turning = state.turning();
        let (angles, equations) = (state.sector_angles(), state.equations());
        let mut change = vec![0.0; self.size];
        for (sector, equation) in equations.iter().enumerate() {
            // Angle sums change by −L u.
            equation.iter().for_each(|&i| change[i] = angles[sector] - target.angles[sector]);
        }
        if change.iter().all(|x| x.abs() < SETTLED) {
            return turning;
        }
        self.cholesky.solve(&mut change);
        let corners = state.sectors.of_corners(&state.mesh);
        let at = |h: HalfedgeId| equations[corners[h] as usize].map_or(0.0, |i| change[i]);
        for (k, turning) in turning.iter_mut().enumerate() {
            for passage in state.loops.passages(k) {
                let (corner, sign) = passage.pivot(&state.mesh);
                let Some((f, i)) = state.mesh.corner(corner) else { continue };
                let u = state.mesh.face_halfedges(f).map(at);
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                let w = state.half_cotangents[f];
                *turning += sign * (w[k] * (u[j] - u[i]) + w[j] * (u[k] - u[i]));
            }
        }
        turning
    }

    /// The matrix `G_ij = Σ w h_i h_j` of the harmonic fields whose cochains count crossings of the paths.
    fn period_energies(&mut self, state: &HolonomyState) -> Vec<Vec<f64>> {
        let sides = &self.sides;
        let mut forms: Vec<Vec<f64>> =
            (0..state.loops.len()).map(|k| crossings(&state.loops, k, &state.mesh)).collect();
        for form in &mut forms {
            let mut g = vec![0.0; self.size];
            for side in sides {
                let flow = side.weight * form[side.halfedge.index()];
                side.ends[0].into_iter().for_each(|i| g[i] -= flow);
                side.ends[1].into_iter().for_each(|i| g[i] += flow);
            }
            self.cholesky.solve(&mut g);
            let at = |end: Option<usize>| end.map_or(0.0, |i| g[i]);
            for side in sides {
                form[side.halfedge.index()] -= at(side.ends[1]) - at(side.ends[0]);
            }
        }
        let product = |a: &Vec<f64>, b: &Vec<f64>| {
            let at = |side: &WeightedSide| side.halfedge.index();
            sides.iter().map(|side| side.weight * a[at(side)] * b[at(side)]).sum()
        };
        forms.iter().map(|a| forms.iter().map(|b| product(a, b)).collect()).collect()
    }
}

/// A side of a face with half the cotangent of the angle opposite to it, and the unknowns at the sectors of its ends.
struct WeightedSide {
    halfedge: HalfedgeId,
    weight: f64,
    ends: [Option<usize>; 2],
}

fn weighted_sides(state: &HolonomyState) -> Vec<WeightedSide> {
    let mesh = &state.mesh;
    let (corners, unknowns) = (state.sectors.of_corners(mesh), state.equations());
    let mut sides = Vec::with_capacity(3 * mesh.n_faces());
    for f in mesh.faces() {
        let around = mesh.face_halfedges(f);
        for k in 0..3 {
            let ends = [around[(k + 1) % 3], around[(k + 2) % 3]].map(|h| unknowns[corners[h] as usize]);
            sides.push(WeightedSide {
                halfedge: around[(k + 1) % 3],
                weight: state.half_cotangents[f][k],
                ends,
            });
        }
    }
    sides
}

/// Per half-edge of a face, the times that a path leaves the face over it less the times that it comes in.
fn crossings(loops: &DualLoops, k: usize, mesh: &Mesh) -> Vec<f64> {
    let mut counts = vec![0.0; mesh.n_halfedges()];
    for Passage { entry, exit } in loops.passages(k) {
        counts[exit.index()] += 1.0;
        counts[entry.index()] -= 1.0;
    }
    counts
}

/// The cotangent Laplacian between the sectors of each piece but the last.
fn laplacian(sides: &[WeightedSide], n: usize) -> Result<(Pattern, Vec<f64>)> {
    let pair = |side: &WeightedSide| match side.ends {
        [Some(i), Some(j)] => Some((i as u32, j as u32)),
        _ => None,
    };
    let pattern = Pattern::new(n, &sides.iter().filter_map(pair).collect::<Vec<_>>())?;
    let mut values = vec![0.0; pattern.entries()];
    for side in sides {
        let [a, b] = side.ends;
        if a == b {
            // An edge from a sector to itself has no difference of values.
            continue;
        }
        [a, b].into_iter().flatten().for_each(|i| values[pattern.diagonal(i)] += side.weight);
        if let (Some(i), Some(j)) = (a, b)
            && let Some(at) = pattern.position(i, j)
        {
            values[at] -= side.weight;
        }
    }
    let mean = (0..n).map(|i| values[pattern.diagonal(i)]).sum::<f64>() / n.max(1) as f64;
    (0..n).for_each(|i| values[pattern.diagonal(i)] += SHIFT * mean);
    Ok((pattern, values))
}
