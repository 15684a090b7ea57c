//! Harmonic maps of triangulations into flat and hyperbolic surfaces: every vertex at the mean of its neighbours.

use super::cover::{Placed, moved};
use super::matrices::{Factors, Rows, Solver};
use super::options::Boundary;
use crate::control::{Control, Stage};
use crate::error::{Error, Result};
use crate::geometry::Space;
use crate::geometry::complex::{Complex, dot, scale};
use crate::linalg::gmres::{self, GmresLimits};
use crate::linalg::lu;
use crate::mesh::{HalfedgeId, Mesh, PerHalfedge, PerVertex, VertexId};
use std::f64::consts::FRAC_1_SQRT_2;

/// Where a vertex may go.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Freedom {
    /// Anywhere.
    Free,
    /// Along the x axis of its frame, on both sides of which the surface continues as its mirror image.
    Slides,
    /// Nowhere.
    Held,
}

/// Most Newton steps of either kind.
const MOST_STEPS: usize = 60;
/// Share of the expected decrease of the energy that a step must bring (Armijo's condition).
const LEAST_DECREASE: f64 = 1e-4;
/// Halvings of a step before it counts as one that leads nowhere.
const MOST_HALVINGS: usize = 40;
/// The energy is near its minimum where a step would lower it by no more than this share: the balance by weights without symmetry starts
/// there, and needs no better place. Half the step's slope more and the minimum itself is known to about the square of this.
const ENERGY_TOLERANCE: f64 = 1e-4;
/// The same where the balance was not found from there.
const LEAST_ENERGY_TOLERANCE: f64 = 1e-12;
/// A vertex is balanced where the mean of its neighbours is within this share of their mean distance.
const BALANCED: f64 = 1e-12;
/// Balance with which a map is taken where rounding lets Newton's method come no closer: far from the origin of H² positions lose digits.
const NEARLY_BALANCED: f64 = 1e-7;
/// Energy over the least one up to which the start of a map may be nearer to the balance than what has the least energy.
const NEAR: f64 = 2.0;
/// Residual of a linear solution, as a share of the right hand side, with the first Newton step to the balance, and the share of the
/// vertices' own residual that later ones ask for.
const LINEAR: [f64; 2] = [1e-2, 0.1];
/// Residual of a linear solution that counts as one at all.
const SOLVED: f64 = 0.5;
/// Longest step of a vertex, in units of the space's curvature radius (H²).
const LONGEST_STEP: f64 = 2.0;

impl Freedom {
    /// Of a surface without marks.
    pub fn of(mesh: &Mesh, boundary: Boundary) -> PerVertex<Freedom> {
        PerVertex::from_fn(mesh.n_vertices(), |v: VertexId| match (mesh.is_boundary_vertex(v), boundary) {
            (false, _) => Freedom::Free,
            (true, Boundary::Slides) => Freedom::Slides,
            (true, Boundary::ArcLength) => Freedom::Held,
        })
    }
}

/// How many steps lowered the energy, and the energy.
pub(super) type Relaxed = (usize, f64);

/// How the balance was found.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct BalanceReport {
    /// Newton steps that lowered the energy with symmetric weights.
    pub energy_steps: usize,
    /// That energy, `½ Σ w r²`, at its minimum.
    pub energy: f64,
    /// Newton steps to the balance by mean value weights.
    pub balance_steps: usize,
    /// Largest distance of a vertex from the mean of its neighbours, as a share of their mean distance.
    pub residual: f64,
}

/// Moves the vertices so that at each free one the weighted logarithms of its neighbours add up to 0: [`relax`], then [`settle`].
///
/// # Errors
/// Those of the two.
pub(super) fn balance(
    placed: &mut Placed,
    weights: &PerHalfedge<f64>,
    freedom: &PerVertex<Freedom>,
    control: &Control,
) -> Result<BalanceReport> {
    let relaxed = relax(placed, weights, freedom, control)?;
    settle(placed, weights, freedom, relaxed, control)
}

/// Brings the energy `½ Σ w r²` with the weights made symmetric to its minimum: on lifts into the plane or the hyperbolic plane it is
/// convex \[GLM19\], so that Newton's method with a line search leads there from anywhere. The number of steps, and the energy.
///
/// # Errors
/// [`Error::Factorisation`]; [`Error::Cancelled`].
pub(super) fn relax(
    placed: &mut Placed,
    weights: &PerHalfedge<f64>,
    freedom: &PerVertex<Freedom>,
    control: &Control,
) -> Result<Relaxed> {
    let system = System::new(placed, weights, freedom);
    if system.n == 0 {
        return Ok((0, system.energy(&placed.logarithms())));
    }
    // An isometry starts in balance, the target nearly everywhere.
    let start = placed.clone();
    let off = [system.energy(&start.logarithms()), system.mean_residual(&start)];
    let relaxed = system.minimise(placed, ENERGY_TOLERANCE, control)?;
    if off[0] <= NEAR * relaxed.1 && off[1] <= system.mean_residual(placed) {
        *placed = start;
    }
    Ok(relaxed)
}

/// From near the balance, where [`relax`] left it, to it by the weights themselves. With positive weights, in the class of a homeomorphism,
/// the result is an embedding \[LWZ23\].
///
/// # Errors
/// [`Error::Matching`] where no balance is found; [`Error::Factorisation`]; [`Error::Cancelled`].
pub(super) fn settle(
    placed: &mut Placed,
    weights: &PerHalfedge<f64>,
    freedom: &PerVertex<Freedom>,
    (energy_steps, energy): Relaxed,
    control: &Control,
) -> Result<BalanceReport> {
    let system = System::new(placed, weights, freedom);
    let mut report = BalanceReport { energy_steps, energy, ..BalanceReport::default() };
    if system.n == 0 {
        return Ok(report);
    }
    let start = placed.clone();
    (report.balance_steps, report.residual) = system.settle(placed, Solver::Products(None), control)?;
    if report.residual > NEARLY_BALANCED {
        // Once more, from the minimum of the energy and by factors of the matrix itself.
        let mut other = start;
        system.minimise(&mut other, LEAST_ENERGY_TOLERANCE, control)?;
        let (steps, residual) = system.settle(&mut other, Solver::Factors, control)?;
        report.balance_steps += steps;
        if residual < report.residual {
            (*placed, report.residual) = (other, residual);
        }
    }
    if report.residual > NEARLY_BALANCED {
        return Err(Error::Matching(format!(
            "the harmonic map was not found: after {} steps a vertex is {:.1e} of its edges away from the mean of its neighbours",
            report.balance_steps, report.residual
        )));
    }
    Ok(report)
}

struct System<'a> {
    weights: &'a PerHalfedge<f64>,
    /// Half the sum of the two weights of an edge.
    even: PerHalfedge<f64>,
    freedom: &'a PerVertex<Freedom>,
    /// Number of the first unknown of each vertex.
    first: Vec<u32>,
    n: usize,
}

/// One linearisation: the sum of the weighted logarithms per unknown, and the entries of its derivative.
struct Linearised {
    force: Vec<f64>,
    entries: Vec<(u32, u32, f64)>,
}

impl<'a> System<'a> {
    fn new(placed: &Placed, weights: &'a PerHalfedge<f64>, freedom: &'a PerVertex<Freedom>) -> System<'a> {
        let (mut first, mut n) = (Vec::with_capacity(freedom.len()), 0);
        for of in freedom.iter() {
            first.push(n as u32);
            n += dimension(*of);
        }
        let even = PerHalfedge::from_fn(placed.cover.mesh.n_halfedges(), |h: HalfedgeId| {
            0.5 * (weights[h] + weights[h.twin()])
        });
        System { weights, even, freedom, first, n }
    }

    /// The forces and their derivative by the unknowns, rows as `weights` say.
    fn linearise(
        &self,
        placed: &Placed,
        logs: &PerHalfedge<Complex>,
        weights: &PerHalfedge<f64>,
    ) -> Linearised {
        let mesh = &placed.cover.mesh;
        let mut force = vec![0.0; self.n];
        let mut entries = Vec::with_capacity(14 * mesh.n_halfedges());
        for v in mesh.vertices() {
            let (row, rows) = (self.first[v.index()], dimension(self.freedom[v]));
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
                let (column, columns) = (self.first[far.index()], dimension(self.freedom[far]));
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

    /// Lowers the energy with symmetric weights nearly to its minimum; the number of steps, and the minimum.
    fn minimise(&self, placed: &mut Placed, tolerance: f64, control: &Control) -> Result<Relaxed> {
        let mut solver: Option<Factors> = None;
        let mut logs = placed.logarithms();
        for step in 0..MOST_STEPS {
            control.step(Stage::Flow, step as f64 / MOST_STEPS as f64)?;
            let energy = self.energy(&logs);
            let at = self.linearise(placed, &logs, &self.even);
            let mut direction = at.force.clone();
            let factors = match &mut solver {
                Some(solver) => solver,
                None => solver.insert(Factors::new(self.n, &at.entries)?),
            };
            factors.factor(&at.entries)?;
            factors.solve(&mut direction);
            // The energy of each edge is counted once, its force at both ends: the decrease is that of a quadratic function.
            let slope: f64 = direction.iter().zip(&at.force).map(|(d, f)| d * f).sum();
            if slope <= tolerance * energy {
                return Ok((step, energy - 0.5 * slope));
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
            let Some((next, next_logs)) = found else { return Ok((step, energy)) };
            (*placed, logs) = (next, next_logs);
        }
        Ok((MOST_STEPS, self.energy(&logs)))
    }

    /// Newton's method for the balance by the weights themselves; the number of steps and the residual at the end.
    fn settle(&self, placed: &mut Placed, mut solver: Solver, control: &Control) -> Result<(usize, f64)> {
        let mut logs = placed.logarithms();
        let mut residual = self.residual(placed, &logs);
        for step in 0..MOST_STEPS {
            control.step(Stage::Flow, step as f64 / MOST_STEPS as f64)?;
            if residual <= BALANCED {
                return Ok((step, residual));
            }
            let tolerance = LINEAR[0].min(LINEAR[1] * residual).max(LINEAR[1] * BALANCED / residual);
            let direction = self.newton(placed, &logs, (&mut solver, tolerance))?;
            let mut length = 1.0;
            let mut found = None;
            for _ in 0..MOST_HALVINGS {
                let next = self.stepped(placed, &direction, length);
                let next_logs = next.logarithms();
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
        placed: &Placed,
        logs: &PerHalfedge<Complex>,
        (solver, tolerance): (&mut Solver, f64),
    ) -> Result<Vec<f64>> {
        if let Solver::Products(kept) = solver {
            let factors = match kept {
                Some(factors) => factors,
                None => {
                    let Linearised { entries, .. } = self.linearise(placed, logs, &self.even);
                    let mut first = Factors::new(self.n, &entries)?;
                    first.factor(&entries)?;
                    kept.insert(Box::new(first))
                }
            };
            if let Some(step) = self.newton_by_products(placed, logs, (factors, tolerance)) {
                return Ok(step);
            }
        }
        let Linearised { force, entries } = self.linearise(placed, logs, self.weights);
        let mut step: Vec<f64> = force.iter().map(|f| -f).collect();
        lu::solve(&entries, &mut step)?;
        Ok(step)
    }

    /// As [`System::newton`], with steps measured by the lengths of the edges about them; `None` where that leads nowhere.
    fn newton_by_products(
        &self,
        placed: &Placed,
        logs: &PerHalfedge<Complex>,
        (factors, tolerance): (&mut Factors, f64),
    ) -> Option<Vec<f64>> {
        let Linearised { force, entries } = self.linearise(placed, logs, self.weights);
        let rows = Rows::new(self.n, entries);
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
    fn sizes(&self, placed: &Placed, logs: &PerHalfedge<Complex>) -> Vec<f64> {
        let mesh = &placed.cover.mesh;
        let mut sizes = vec![1.0; self.n];
        for v in mesh.vertices() {
            let (mut sum, mut count) = (f64::MIN_POSITIVE, 0.0);
            for h in mesh.outgoing(v) {
                (sum, count) = (sum + logs[h][0].hypot(logs[h][1]), count + 1.0);
            }
            let first = self.first[v.index()] as usize;
            sizes[first..first + dimension(self.freedom[v])].fill(sum / count);
        }
        sizes
    }

    /// `½ Σ w r²` over the edges.
    fn energy(&self, logs: &PerHalfedge<Complex>) -> f64 {
        let of = |h: usize| {
            self.even[HalfedgeId::from(h)] * dot(logs[HalfedgeId::from(h)], logs[HalfedgeId::from(h)])
        };
        0.5 * (0..logs.len()).step_by(2).map(of).sum::<f64>()
    }

    /// The largest force of a vertex over the sum of the sizes of what it consists of.
    fn residual(&self, placed: &Placed, logs: &PerHalfedge<Complex>) -> f64 {
        self.residuals(placed, logs).into_iter().fold(0.0, crate::geometry::worse)
    }

    fn mean_residual(&self, placed: &Placed) -> f64 {
        let residuals = self.residuals(placed, &placed.logarithms());
        residuals.iter().sum::<f64>() / residuals.len().max(1) as f64
    }

    fn residuals(&self, placed: &Placed, logs: &PerHalfedge<Complex>) -> Vec<f64> {
        let mesh = &placed.cover.mesh;
        let of = |v| {
            let (mut total, mut size) = ([0.0; 2], 0.0);
            for h in mesh.outgoing(v) {
                let w = self.weights[h];
                total = [0, 1].map(|k| total[k] + w * logs[h][k]);
                size += w * logs[h][0].hypot(logs[h][1]);
            }
            let off = match self.freedom[v] {
                Freedom::Free => total[0].hypot(total[1]),
                Freedom::Slides => total[0].abs(),
                Freedom::Held => 0.0,
            };
            if size > 0.0 { off / size } else { 0.0 }
        };
        mesh.vertices().map(of).collect()
    }

    fn stepped(&self, placed: &Placed, direction: &[f64], length: f64) -> Placed {
        let mut next = placed.clone();
        let longest = if placed.cover.space == Space::E2 { f64::INFINITY } else { LONGEST_STEP };
        for (v, frame) in next.at.iter_mut().enumerate() {
            let first = self.first[v] as usize;
            let by = match dimension(self.freedom[VertexId::from(v)]) {
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

fn dimension(freedom: Freedom) -> usize {
    match freedom {
        Freedom::Free => 2,
        Freedom::Slides => 1,
        Freedom::Held => 0,
    }
}

/// `[r coth r, r/sinh r]` in H² and what corresponds to it: how the logarithm of a point at distance r changes across its direction when
/// its own foot moves, and when the point does.
fn growth(space: Space, r: f64) -> [f64; 2] {
    match space {
        Space::E2 => [1.0; 2],
        Space::H2 if r > 1e-4 => [r / r.tanh(), r / r.sinh()],
        Space::H2 => [1.0 + r * r / 3.0, 1.0 - r * r / 6.0],
        Space::S2 if r > 1e-4 => [r / r.tan(), r / r.sin()],
        Space::S2 => [1.0 - r * r / 3.0, 1.0 + r * r / 6.0],
    }
}

/// The direction of a vector; of 0, whose direction does not count, a fixed one.
fn unit(v: Complex) -> Complex {
    let size = v[0].hypot(v[1]);
    if size > 0.0 { v.map(|x| x / size) } else { [FRAC_1_SQRT_2; 2] }
}
