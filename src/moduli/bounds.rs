//! The period matrix of a closed surface with a proven bound of its error.
//!
//! The energies G of harmonic forms are symplectic, `G⁻¹ = S G Sᵀ` with their wedge products S, and any closed forms of the same classes have
//! energies M above them: `Sᵀ M⁻¹ S ⪯ G ⪯ M`. So the symplectic eigenvalues d ≥ 1 of M measure what is not known. In the frame where the
//! geometric mean Ĝ of both bounds is 1, all G between Ĝ/d and d Ĝ have period matrices `i cosh r + sinh r K`, `‖K‖ ≤ 1`, r = log d: a ball
//! of Siegel's upper half-space \[Sie43\]. For a torus it is the hyperbolic disk of radius log d.

use super::elements::{ClosedForm, Degree};
use super::energy::upper_energies;
use super::finer::BisectedSurface;
use super::gap::Gap;
use super::marking::refine;
use super::proof::{mean_period_matrix, proven_gap, symplectic};
use super::solve::least_forms;
use crate::control::{Control, Stage};
use crate::error::{Error, Result};
use crate::geometry::Enclosure;
use crate::geometry::complex::Complex;
use crate::harmonic::HarmonicForms;
use crate::mesh::PerFace;

/// The options of [`period_bounds`].
#[derive(Debug, Clone, Copy)]
pub struct BoundsOptions {
    /// The largest gap d − 1 that is aimed at (at least 0); an infinite one refines nothing. Default: 1e-3.
    pub width: f64,
    /// The functions.
    pub degree: Degree,
    /// The largest number of unknowns; default: 4 for every vertex and 200,000 more.
    pub most_unknowns: Option<usize>,
}

impl Default for BoundsOptions {
    fn default() -> Self {
        BoundsOptions { width: 1e-3, degree: Degree::default(), most_unknowns: None }
    }
}

/// A period matrix and how far it may be off.
///
/// What is said is true of the polyhedral surface whose triangles have exactly the lengths of [`crate::harmonic::Domain::lengths`]. The lengths
/// on finer triangulations, their cotangents and the matrices are enclosed in double-double precision, and the values of forms are exact; see
/// [`BisectedSurface`] for what is taken for exact on the way, and paid for.
#[derive(Debug, Clone)]
pub struct PeriodBounds {
    /// The period matrix Π̂ of the geometric mean of both bounds (g × g, symmetric), in the basis of the forms.
    pub matrix: Vec<Vec<Complex>>,
    /// A proven d − 1 ≥ 0: the energies G of the surface and Ĝ of the matrix have `Ĝ/d ⪯ G ⪯ d Ĝ`.
    pub gap: f64,
    /// Energies of closed forms (2g × 2g, in the order of the loops a1, b1, …), rounded: above those of the harmonic ones.
    pub upper: Vec<Vec<f64>>,
    /// The gap on the triangulation of the forms with linear functions, not proven to the last digits.
    pub first_gap: f64,
    /// True if the gap is at most the width asked for.
    pub is_reached: bool,
    /// The triangulation on which the bound was found.
    pub surface: BisectedSurface,
    /// The closed forms that prove it, one per class.
    pub forms: Vec<ClosedForm>,
    /// Number of vertices that were added.
    pub n_added: usize,
    /// Number of unknowns of the last system.
    pub n_unknowns: usize,
    /// Number of systems that were solved.
    pub rounds: usize,
}

/// The modulus of a torus, with a bound of its error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModulusDisk {
    /// τ, reduced to |Re τ| ≤ ½, |τ| ≥ 1.
    pub value: Complex,
    /// The modulus of the surface, in the same basis, is within this distance.
    pub radius: f64,
}

/// Most systems that are solved.
const MOST_ROUNDS: usize = 120;
/// Rounds in a row without a smaller gap after which the search ends.
const MOST_BEHIND: usize = 4;
/// Share of the width that is aimed at, since the proof raises the gap by rounding.
const AIM: f64 = 0.99;
/// Unknowns allowed by default: so many for every vertex, and beyond them.
const UNKNOWNS: [usize; 2] = [4, 200_000];
/// Most steps of the reduction of a modulus.
const MOST_STEPS: usize = 1000;

impl PeriodBounds {
    /// The energies of harmonic forms that belong to the matrix, `(Y + X Y⁻¹ X, −X Y⁻¹; −Y⁻¹ X, Y⁻¹)` in the order a1, b1, … (2g × 2g), rounded:
    /// those of the surface lie between 1/d and d times these.
    pub fn energies(&self) -> Vec<Vec<f64>> {
        let mean = symplectic(&self.matrix).unwrap_or_default();
        mean.iter().map(|row| row.iter().map(|x| x.nearest()).collect()).collect()
    }

    /// The radius of a disk around entry i, j of the matrix that contains the entry of the surface: `(d − 1) √(Y_ii Y_jj)`, Y = Im Π̂.
    ///
    /// It bounds `sinh r √(Y_ii Y_jj)` around `X + i cosh r Y`, r = log d.
    pub fn radius(&self, i: usize, j: usize) -> f64 {
        let product = Enclosure::from(self.matrix[i][i][1]) * self.matrix[j][j][1].into();
        (product.sqrt() * self.gap.into()).upper()
    }

    /// The modulus of a torus; `None` for another genus.
    pub fn modulus(&self) -> Option<ModulusDisk> {
        if self.matrix.len() != 1 {
            return None;
        }
        let mut tau = self.matrix[0][0].map(Enclosure::from);
        for _ in 0..MOST_STEPS {
            tau[0] = tau[0] - tau[0].nearest().round().into();
            let square = tau[0] * tau[0] + tau[1] * tau[1];
            if square.nearest() >= 1.0 - 1e-12 {
                break;
            }
            tau = [-tau[0] / square, tau[1] / square];
        }
        // Reductions are isometries of the hyperbolic plane, so the disk keeps its radius log d.
        let value = tau.map(Enclosure::nearest);
        let off = (0..2).map(|k| (tau[k] - value[k].into()).upper().abs() + tau[k].radius()).sum::<f64>();
        let radius = ((tau[1] * self.gap.into()).upper() + off) * (1.0 + 1e-15);
        Some(ModulusDisk { value, radius })
    }
}

/// The period matrix of a closed surface of genus 1 or more with a bound of its error, and where that is wider than asked for, closed forms on
/// finer triangulations until it is not.
///
/// A surface in H² or S² is replaced by the polyhedron of its chords, as its forms are.
///
/// # Errors
/// [`Error::Argument`] for forms of a surface with boundary or of genus 0, or a width below 0; [`Error::EdgeLength`] for lengths more than 1e35
/// apart; [`Error::Factorisation`] where nothing is proven; [`Error::TooLarge`]; [`Error::Cancelled`].
pub fn period_bounds(
    forms: &HarmonicForms,
    options: &BoundsOptions,
    control: &Control,
) -> Result<PeriodBounds> {
    check(forms, options)?;
    let mut surface = BisectedSurface::new(forms)?;
    surface.make_delaunay(control)?;
    let given = surface.mesh.n_vertices();
    let most = options.most_unknowns.unwrap_or(UNKNOWNS[0] * given + UNKNOWNS[1]);
    let (mut first_gap, mut rounds, mut best, mut behind) = (None, 0, None::<Round>, 0);
    let best = loop {
        rounds += 1;
        // How many rounds there will be is not known: each takes a part of what is left.
        let control = control.part(1.0 - 1.0 / rounds as f64, 1.0 - 1.0 / (rounds + 1) as f64);
        let cotangents = surface.cotangents();
        if rounds > 1 {
            surface.take_centres(&cotangents);
        }
        let (closed, n_unknowns) = least_forms(&surface, &cotangents, &control)?;
        let Gap { gap, shares } = Gap::new(&surface, &closed, &cotangents, &control)?;
        first_gap.get_or_insert(gap);
        // On flipped triangulations there may be no form as good as those before.
        let is_best = best.as_ref().is_none_or(|best| gap < best.gap);
        behind = if is_best { 0 } else { behind + 1 };
        let (aim, total) = (AIM * options.width, shares.iter().sum::<f64>());
        let goes_on =
            gap > aim && n_unknowns < most && rounds < MOST_ROUNDS && total > 0.0 && behind < MOST_BEHIND;
        if is_best {
            best = Some(Round { surface: surface.clone(), forms: closed, cotangents, n_unknowns, gap });
        }
        match best.take() {
            Some(best) if !goes_on => break best,
            kept => best = kept,
        }
        // The shares fall with the gap.
        refine(&mut surface, &shares, 0.7 * total * aim / gap, options.degree, &control)?;
    };
    let upper = upper_energies(&best.surface, &best.forms, &best.cotangents, control)?;
    let matrix = mean_period_matrix(&upper)?;
    let proven = proven_gap(&matrix, &upper)?;
    control.step(Stage::Flow, 1.0)?;
    Ok(PeriodBounds {
        is_reached: proven <= options.width,
        upper: upper.iter().map(|row| row.iter().map(|x| x.nearest()).collect()).collect(),
        n_added: best.surface.mesh.n_vertices() - given,
        first_gap: first_gap.unwrap_or(best.gap),
        gap: proven,
        forms: best.forms,
        matrix,
        surface: best.surface,
        n_unknowns: best.n_unknowns,
        rounds,
    })
}

/// Refuses surfaces without a period matrix, and widths that are none.
fn check(forms: &HarmonicForms, options: &BoundsOptions) -> Result<()> {
    let group = &forms.basis.group;
    if group.boundaries > 0 || group.genus == 0 {
        let value = format!("of genus {} with {} boundary loops", group.genus, group.boundaries);
        return Err(Error::argument(
            "surface",
            value,
            "closed and of genus 1 or more, to have a period matrix",
        ));
    }
    if options.width.is_nan() || options.width < 0.0 {
        return Err(Error::argument("width", options.width, "at least 0"));
    }
    Ok(())
}

/// A triangulation with the forms that were found on it.
struct Round {
    surface: BisectedSurface,
    forms: Vec<ClosedForm>,
    cotangents: PerFace<[Enclosure; 3]>,
    n_unknowns: usize,
    gap: f64,
}
