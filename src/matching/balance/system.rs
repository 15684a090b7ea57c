//! The equations of a balance: energy, forces and their derivatives by the positions of the vertices, and Newton's method for both.

use super::matrices::{BalanceSolver, SparseRows, SymmetricFactors};
use super::springs::{EnergyMinimum, Springs, VertexFreedom};
use crate::control::{Control, Stage};
use crate::error::Result;
use crate::geometry::Space;
use crate::geometry::complex::{Complex, dot, scale};
use crate::linalg::gmres::{self, GmresLimits};
use crate::linalg::lu;
use crate::matching::cover::{PlacedMesh, moved};
use crate::mesh::{HalfedgeId, PerHalfedge, VertexId};
use std::f64::consts::FRAC_1_SQRT_2;

/// Most Newton steps of either kind.
const MOST_STEPS: usize = 60;
/// Share of the expected decrease of the energy that a step must bring (Armijo's condition).
const LEAST_DECREASE: f64 = 1e-4;
/// Most halvings of a step before the search ends where it is.
const MOST_HALVINGS: usize = 40;
/// Residual of a vertex (as [`super::BalanceReport::residual`]) up to which it counts as balanced.
const BALANCED: f64 = 1e-12;
/// Residual of the linear solution, as a share of the right hand side, for the first Newton step to the balance, and for later steps as a
/// share of the vertices' own residual.
const LINEAR: [f64; 2] = [1e-2, 0.1];
/// Residual of a linear solution above which it is not used.
const SOLVED: f64 = 0.5;
/// Longest step of a vertex, in units of the space's curvature radius (H²).
const LONGEST_STEP: f64 = 2.0;

/// The unknowns of a balance.
pub(super) struct BalanceSystem<'a> {
    springs: Springs<'a>,
    /// Half the sum of the two weights of an edge.
    symmetric: PerHalfedge<f64>,
    /// Number of the first unknown of each vertex.
    first: Vec<u32>,
    /// The number of unknowns.
    pub n: usize,
}

/// One linearisation: the sum of the weighted logarithms per unknown, and the entries of its derivative.
struct Linearised {
    force: Vec<f64>,
    entries: Vec<(u32, u32, f64)>,
}

impl<'a> BalanceSystem<'a> {
    /// The unknowns of the vertices that these springs let move.
    pub fn new(placed: &PlacedMesh, springs: Springs<'a>) -> BalanceSystem<'a> {
        let (mut first, mut n) = (Vec::with_capacity(springs.freedom.len()), 0);
        for freedom in springs.freedom.iter() {
            first.push(n as u32);
            n += dimension(*freedom);
        }
        let symmetric = PerHalfedge::from_fn(placed.cover.mesh.n_halfedges(), |h: HalfedgeId| {
            0.5 * (springs.weights[h] + springs.weights[h.twin()])
        });
        BalanceSystem { springs, symmetric, first, n }
    }

    /// The forces by these weights and their derivative by the unknowns.
    fn linearise(
        &self,
        placed: &PlacedMesh,
        logs: &PerHalfedge<Complex>,
        weights: &PerHalfedge<f64>,
    ) -> Linearised {
        let mesh = &placed.cover.mesh;
        let mut force = vec![0.0; self.n];
        let mut entries = Vec::with_capacity(14 * mesh.n_halfedges());
        for v in mesh.vertices() {
            let (row, rows) = (self.first[v.index()], dimension(self.springs.freedom[v]));
            if rows == 0 {
                continue;
            }
            let (mut total, mut own) = ([0.0; 2], [[0.0; 2]; 2]);
            for h in mesh.outgoing(v) {
                let (w, ahead) = (weights[h], logs[h]);
                let back = logs[h.twin()].map(|x| -x);
                let r = ahead[0].hypot(ahead[1]);
                let [turning, carried] = growth(placed.cover.space, r);
                let [u, to] = [unit(ahead), unit(back)];
                let [n, m] = [u, to].map(|[x, y]| [-y, x]);
                total = [0, 1].map(|k| total[k] + w * ahead[k]);
                let far = mesh.tip(h);
                let (column, columns) = (self.first[far.index()], dimension(self.springs.freedom[far]));
                for i in 0..2 {
                    for j in 0..2 {
                        own[i][j] -= w * (u[i] * u[j] + turning * n[i] * n[j]);
                        if i < rows && j < columns {
                            let value = w * (u[i] * to[j] + carried * n[i] * m[j]);
                            entries.push((row + i as u32, column + j as u32, value));
                        }
                    }
                }
            }
            for i in 0..rows {
                force[row as usize + i] = total[i];
                (0..rows).for_each(|j| entries.push((row + i as u32, row + j as u32, own[i][j])));
            }
        }
        Linearised { force, entries }
    }

    /// Lowers the energy with symmetric weights until a step would lower it by no more than this share.
    ///
    /// # Errors
    /// [`crate::Error::Factorisation`]; [`crate::Error::Cancelled`].
    pub fn minimise(
        &self,
        placed: &mut PlacedMesh,
        tolerance: f64,
        control: &Control,
    ) -> Result<EnergyMinimum> {
        let mut solver: Option<SymmetricFactors> = None;
        let mut logs = placed.logarithms();
        for steps in 0..MOST_STEPS {
            control.step(Stage::Flow, steps as f64 / MOST_STEPS as f64)?;
            let energy = self.energy(&logs);
            let at = self.linearise(placed, &logs, &self.symmetric);
            control.check()?;
            let mut direction = at.force.clone();
            let factors = match &mut solver {
                Some(solver) => solver,
                None => solver.insert(SymmetricFactors::new(self.n, &at.entries)?),
            };
            control.check()?;
            factors.factor(&at.entries)?;
            control.check()?;
            factors.solve(&mut direction);
            // The energy of each edge is counted once, its force at both ends: the decrease is that of a quadratic function.
            let slope: f64 = direction.iter().zip(&at.force).map(|(d, f)| d * f).sum();
            if slope <= tolerance * energy {
                return Ok(EnergyMinimum { steps, energy: energy - 0.5 * slope });
            }
            let mut length = 1.0;
            let mut found = None;
            for _ in 0..MOST_HALVINGS {
                let next = self.stepped(placed, &direction, length);
                let next_logs = next.logarithms();
                if self.energy(&next_logs) <= energy - LEAST_DECREASE * length * slope {
                    found = Some((next, next_logs));
                    break;
                }
                length *= 0.5;
            }
            let Some((next, next_logs)) = found else { return Ok(EnergyMinimum { steps, energy }) };
            (*placed, logs) = (next, next_logs);
        }
        Ok(EnergyMinimum { steps: MOST_STEPS, energy: self.energy(&logs) })
    }

    /// Newton's method for the balance by the weights themselves: the number of steps and the residual at the end.
    ///
    /// # Errors
    /// [`crate::Error::Factorisation`]; [`crate::Error::Cancelled`].
    pub fn settle(
        &self,
        placed: &mut PlacedMesh,
        mut solver: BalanceSolver,
        control: &Control,
    ) -> Result<(usize, f64)> {
        let mut logs = placed.logarithms();
        control.check()?;
        let mut residual = self.residual(placed, &logs);
        for step in 0..MOST_STEPS {
            control.step(Stage::Flow, step as f64 / MOST_STEPS as f64)?;
            if residual <= BALANCED {
                return Ok((step, residual));
            }
            let tolerance = LINEAR[0].min(LINEAR[1] * residual).max(LINEAR[1] * BALANCED / residual);
            let direction = self.newton(placed, &logs, &mut solver, tolerance)?;
            control.check()?;
            let mut length = 1.0;
            let mut found = None;
            for _ in 0..MOST_HALVINGS {
                let next = self.stepped(placed, &direction, length);
                control.check()?;
                let next_logs = next.logarithms();
                control.check()?;
                let after = self.residual(&next, &next_logs);
                if after < residual {
                    found = Some((next, next_logs, after));
                    break;
                }
                length *= 0.5;
            }
            let Some((next, next_logs, after)) = found else { return Ok((step, residual)) };
            (*placed, logs, residual) = (next, next_logs, after);
        }
        Ok((MOST_STEPS, residual))
    }

    /// The step that brings the forces by the weights themselves to 0.
    fn newton(
        &self,
        placed: &PlacedMesh,
        logs: &PerHalfedge<Complex>,
        solver: &mut BalanceSolver,
        tolerance: f64,
    ) -> Result<Vec<f64>> {
        if let BalanceSolver::Products(kept) = solver {
            let factors = match kept {
                Some(factors) => factors,
                None => {
                    let Linearised { entries, .. } = self.linearise(placed, logs, &self.symmetric);
                    let mut first = SymmetricFactors::new(self.n, &entries)?;
                    first.factor(&entries)?;
                    kept.insert(Box::new(first))
                }
            };
            if let Some(step) = self.newton_by_products(placed, logs, factors, tolerance) {
                return Ok(step);
            }
        }
        let Linearised { force, entries } = self.linearise(placed, logs, self.springs.weights);
        let mut step: Vec<f64> = force.iter().map(|f| -f).collect();
        lu::solve(&entries, &mut step)?;
        Ok(step)
    }

    /// As [`BalanceSystem::newton`], by products with the matrix, steps being measured by the lengths of the edges about their vertices;
    /// `None` if no solution is found.
    fn newton_by_products(
        &self,
        placed: &PlacedMesh,
        logs: &PerHalfedge<Complex>,
        factors: &mut SymmetricFactors,
        tolerance: f64,
    ) -> Option<Vec<f64>> {
        let Linearised { force, entries } = self.linearise(placed, logs, self.springs.weights);
        let rows = SparseRows::new(self.n, entries);
        let sizes = self.sizes(placed, logs);
        let mut side = force;
        factors.solve(&mut side);
        side.iter_mut().zip(&sizes).for_each(|(x, size)| *x /= size);
        let (mut step, mut wide) = (vec![0.0; self.n], vec![0.0; self.n]);
        let apply = |x: &[f64], y: &mut [f64]| {
            wide.iter_mut().zip(x).zip(&sizes).for_each(|((w, x), size)| *w = x * size);
            rows.apply(&wide, y);
            factors.solve(y);
            y.iter_mut().zip(&sizes).for_each(|(y, size)| *y /= -size);
        };
        let left = gmres::solve(apply, &side, &mut step, GmresLimits::to(tolerance));
        log::debug!("linear residual {left:.1e} of {tolerance:.1e}");
        if left > SOLVED {
            return None;
        }
        step.iter_mut().zip(&sizes).for_each(|(x, size)| *x *= size);
        Some(step)
    }

    /// Per unknown, the mean length of the edges at its vertex.
    fn sizes(&self, placed: &PlacedMesh, logs: &PerHalfedge<Complex>) -> Vec<f64> {
        let mesh = &placed.cover.mesh;
        let mut sizes = vec![1.0; self.n];
        for v in mesh.vertices() {
            let (mut sum, mut count) = (f64::MIN_POSITIVE, 0.0);
            for h in mesh.outgoing(v) {
                (sum, count) = (sum + logs[h][0].hypot(logs[h][1]), count + 1.0);
            }
            let first = self.first[v.index()] as usize;
            sizes[first..first + dimension(self.springs.freedom[v])].fill(sum / count);
        }
        sizes
    }

    /// `½ Σ w r²` over the edges, with symmetric weights.
    pub fn energy(&self, logs: &PerHalfedge<Complex>) -> f64 {
        let of = |h: usize| {
            self.symmetric[HalfedgeId::from(h)] * dot(logs[HalfedgeId::from(h)], logs[HalfedgeId::from(h)])
        };
        0.5 * (0..logs.len()).step_by(2).map(of).sum::<f64>()
    }

    /// The largest residual of a vertex: the size of the force over the sum of the sizes of its parts.
    fn residual(&self, placed: &PlacedMesh, logs: &PerHalfedge<Complex>) -> f64 {
        self.residuals(placed, logs).into_iter().fold(0.0, crate::geometry::worse)
    }

    /// The mean residual of the vertices.
    pub fn mean_residual(&self, placed: &PlacedMesh) -> f64 {
        let residuals = self.residuals(placed, &placed.logarithms());
        residuals.iter().sum::<f64>() / residuals.len().max(1) as f64
    }

    fn residuals(&self, placed: &PlacedMesh, logs: &PerHalfedge<Complex>) -> Vec<f64> {
        let mesh = &placed.cover.mesh;
        let of = |v| {
            let (mut total, mut size) = ([0.0; 2], 0.0);
            for h in mesh.outgoing(v) {
                let w = self.springs.weights[h];
                total = [0, 1].map(|k| total[k] + w * logs[h][k]);
                size += w * logs[h][0].hypot(logs[h][1]);
            }
            let off = match self.springs.freedom[v] {
                VertexFreedom::Free => total[0].hypot(total[1]),
                VertexFreedom::Slides => total[0].abs(),
                VertexFreedom::Held => 0.0,
            };
            if size > 0.0 { off / size } else { 0.0 }
        };
        mesh.vertices().map(of).collect()
    }

    /// The places after this share of a step.
    fn stepped(&self, placed: &PlacedMesh, direction: &[f64], length: f64) -> PlacedMesh {
        let mut next = placed.clone();
        let longest = if placed.cover.space == Space::E2 { f64::INFINITY } else { LONGEST_STEP };
        for (v, frame) in next.at.iter_mut().enumerate() {
            let first = self.first[v] as usize;
            let by = match dimension(self.springs.freedom[VertexId::from(v)]) {
                0 => continue,
                1 => [direction[first], 0.0],
                _ => [direction[first], direction[first + 1]],
            };
            let by = scale(length, by);
            let size = by[0].hypot(by[1]);
            *frame = moved(frame, if size > longest { scale(longest / size, by) } else { by });
        }
        next
    }
}

fn dimension(freedom: VertexFreedom) -> usize {
    match freedom {
        VertexFreedom::Free => 2,
        VertexFreedom::Slides => 1,
        VertexFreedom::Held => 0,
    }
}

/// `[r coth r, r/sinh r]` in H² and the corresponding factors in the other spaces: the change of the logarithm of a point at distance r,
/// across its direction, when the foot of the logarithm moves, and when the point moves.
fn growth(space: Space, r: f64) -> [f64; 2] {
    match space {
        Space::E2 => [1.0; 2],
        Space::H2 if r > 1e-4 => [r / r.tanh(), r / r.sinh()],
        Space::H2 => [1.0 + r * r / 3.0, 1.0 - r * r / 6.0],
        Space::S2 if r > 1e-4 => [r / r.tan(), r / r.sin()],
        Space::S2 => [1.0 - r * r / 3.0, 1.0 + r * r / 6.0],
    }
}

/// The direction of a vector; a fixed direction for 0, whose direction does not count.
fn unit(v: Complex) -> Complex {
    let size = v[0].hypot(v[1]);
    if size > 0.0 { v.map(|x| x / size) } else { [FRAC_1_SQRT_2; 2] }
}
