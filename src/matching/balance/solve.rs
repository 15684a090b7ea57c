//! The way to a harmonic map: the energy first, then the balance.

use super::matrices::BalanceSolver;
use super::springs::{BalanceReport, EnergyMinimum, Springs};
use super::system::BalanceSystem;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::matching::cover::PlacedMesh;
use crate::parallel::join;

/// Share of the energy by which a Newton step has to lower it to be worth while. The balance by weights without symmetry starts from there
/// and needs no better start; the energy minus half the step's slope is the minimum up to about the square of this.
const ENERGY_TOLERANCE: f64 = 1e-4;
/// The same share if the balance was not reached from there.
const LEAST_ENERGY_TOLERANCE: f64 = 1e-12;
/// Residual ([`BalanceReport::residual`]) up to which a map is accepted if rounding lets Newton's method come no closer: far from the
/// origin of H² positions lose digits.
const NEARLY_BALANCED: f64 = 1e-7;
/// Energy of the start of a map, over the least energy, up to which the start may be kept because it is nearer to the balance.
const NEAR: f64 = 2.0;

/// Moves the vertices so that at each free one the weighted logarithms of its neighbours add up to 0: [`relax`], then [`settle`].
///
/// # Errors
/// Those of the two.
pub(crate) fn balance(placed: &mut PlacedMesh, springs: Springs, control: &Control) -> Result<BalanceReport> {
    let relaxed = relax(placed, springs, control)?;
    settle(placed, springs, relaxed, control)
}

/// Brings the energy `½ Σ w r²` with the weights made symmetric near its minimum: on lifts into the plane or the hyperbolic plane it is
/// convex \[GLM19\], so that Newton's method with a line search reaches the minimum from anywhere.
///
/// # Errors
/// [`Error::Factorisation`]; [`Error::Cancelled`].
pub(crate) fn relax(placed: &mut PlacedMesh, springs: Springs, control: &Control) -> Result<EnergyMinimum> {
    let system = BalanceSystem::new(placed, springs);
    if system.n == 0 {
        return Ok(EnergyMinimum { steps: 0, energy: system.energy(&placed.logarithms()) });
    }
    // An isometry starts in balance, and the target nearly everywhere: then the start is better than the minimum.
    let start = placed.clone();
    let energy = system.energy(&start.logarithms());
    control.check()?;
    let off = [energy, system.mean_residual(&start)];
    control.check()?;
    let relaxed = system.minimise(placed, ENERGY_TOLERANCE, control)?;
    control.check()?;
    if off[0] <= NEAR * relaxed.energy && off[1] <= system.mean_residual(placed) {
        *placed = start;
    }
    Ok(relaxed)
}

/// Brings a map that [`relax`] left near the balance to the balance by the weights themselves. With positive weights, in the class of a
/// homeomorphism, the result is an embedding \[LWZ23\].
///
/// # Errors
/// [`Error::Matching`] if no balance is found; [`Error::Factorisation`]; [`Error::Cancelled`].
fn settle(
    placed: &mut PlacedMesh,
    springs: Springs,
    relaxed: EnergyMinimum,
    control: &Control,
) -> Result<BalanceReport> {
    let system = BalanceSystem::new(placed, springs);
    let EnergyMinimum { steps: energy_steps, energy } = relaxed;
    let mut report = BalanceReport { energy_steps, energy, ..BalanceReport::default() };
    if system.n == 0 {
        return Ok(report);
    }
    let start = placed.clone();
    (report.balance_steps, report.residual) =
        system.settle(placed, BalanceSolver::Products(None), control)?;
    if report.residual > NEARLY_BALANCED {
        // Once more, from the minimum of the energy and by factors of the matrix itself.
        let mut other = start;
        system.minimise(&mut other, LEAST_ENERGY_TOLERANCE, control)?;
        let (steps, residual) = system.settle(&mut other, BalanceSolver::Factors, control)?;
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

/// [`relax`] for the source in the domain and for the target, at the same time.
///
/// # Errors
/// Those of [`relax`].
pub(crate) fn relax_both(
    [source, target]: [&mut PlacedMesh; 2],
    springs: [Springs; 2],
    control: &Control,
) -> Result<[EnergyMinimum; 2]> {
    let (first, second) = join(|| relax(source, springs[0], control), || relax(target, springs[1], control));
    Ok([first?, second?])
}

/// [`settle`] for the source in the domain and for the target, at the same time.
///
/// # Errors
/// Those of [`settle`].
pub(crate) fn settle_both(
    [source, target]: [&mut PlacedMesh; 2],
    springs: [Springs; 2],
    relaxed: [EnergyMinimum; 2],
    control: &Control,
) -> Result<[BalanceReport; 2]> {
    let (first, second) = join(
        || settle(source, springs[0], relaxed[0], control),
        || settle(target, springs[1], relaxed[1], control),
    );
    Ok([first?, second?])
}
