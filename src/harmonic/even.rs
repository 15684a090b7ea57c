//! A combination of harmonic forms whose drawing distorts areas little.
//!
//! ```
//! use ricci::harmonic::{Domain, FormsOptions, HarmonicForms, even_combination, unevenness};
//! use ricci::{Control, Surface, mesh::shapes};
//! let domain = Domain::new(&Surface::from_soup(&shapes::genus(2, 4)?)?, &Control::new())?;
//! let forms = HarmonicForms::new(&domain, &FormsOptions::default(), &Control::new())?;
//! let even = even_combination(&forms, &Control::new())?;
//! let least = forms.forms.iter().map(|form| unevenness(&domain, form)).fold(f64::INFINITY, f64::min);
//! assert!(unevenness(&domain, &forms.combination(&even)) <= least);
//! # Ok::<(), ricci::Error>(())
//! ```

use super::domain::Domain;
use super::forms::HarmonicForms;
use super::one_form::OneForm;
use crate::control::Control;
use crate::error::Result;
use crate::linalg::dense::solve_definite;
use crate::mesh::{FaceId, PerEdge};

/// Relative decrease of a step below which the search ends, since a smaller one changes nothing visible.
const LEAST_DECREASE: f64 = 1e-4;
/// Most steps of the search.
const STEPS: usize = 60;

/// The unevenness of the areas in a form's drawing, `|S| ∫|ω|⁴ / (∫|ω|²)²`: 1 if |ω| is the same everywhere, otherwise more.
pub fn unevenness(domain: &Domain, form: &OneForm) -> f64 {
    Evenness::new(domain, form).ratio
}

/// The coefficients of a harmonic form of energy 1 whose drawing distorts areas less than those of the basis: a local minimum of
/// [`unevenness`], found by descent from the best form of the basis.
///
/// # Errors
/// [`crate::Error::Factorisation`]; [`crate::Error::Cancelled`].
pub fn even_combination(forms: &HarmonicForms, control: &Control) -> Result<Vec<f64>> {
    let (domain, n) = (&forms.domain, forms.forms.len());
    let products = forms.inner_products();
    let normalised = |x: &[f64]| -> Vec<f64> {
        let energy: f64 = (0..n).map(|k| (0..n).map(|l| x[k] * products[k][l] * x[l]).sum::<f64>()).sum();
        x.iter().map(|x| x / energy.sqrt()).collect()
    };
    let ratios: Vec<f64> = forms.forms.iter().map(|form| unevenness(domain, form)).collect();
    let Some(best) = (0..n).min_by(|&k, &l| ratios[k].total_cmp(&ratios[l])) else { return Ok(Vec::new()) };
    let mut x = normalised(&(0..n).map(|k| f64::from(u8::from(k == best))).collect::<Vec<_>>());
    let mut here = Evenness::new(domain, &forms.combination(&x));
    let mut step = 0.25;
    for _ in 0..STEPS {
        control.check()?;
        let slope: Vec<Vec<f64>> = forms.forms.iter().map(|form| vec![here.slope(form)]).collect();
        let direction = solve_definite(&products, &slope)?;
        let before = here.ratio;
        while step > 1e-6 {
            let next = normalised(&(0..n).map(|k| x[k] - step * direction[k][0]).collect::<Vec<_>>());
            let there = Evenness::new(domain, &forms.combination(&next));
            if there.ratio < here.ratio {
                (x, here) = (next, there);
                break;
            }
            step *= 0.5;
        }
        if here.ratio >= (1.0 - LEAST_DECREASE) * before {
            break;
        }
        step *= 2.0;
    }
    Ok(x)
}

/// [`unevenness`] with its derivative.
struct Evenness {
    ratio: f64,
    /// Per edge, the derivative of the ratio with respect to the form's value there.
    derivative: PerEdge<f64>,
}

impl Evenness {
    fn new(domain: &Domain, form: &OneForm) -> Evenness {
        let mesh = domain.mesh();
        // |ω|² times the area of a face.
        let energy = |f: FaceId| -> f64 {
            let sides = mesh.opposite_edges(f).into_iter().zip(domain.cotangents()[f]);
            sides.map(|(e, cot)| 0.5 * cot * form.0[e] * form.0[e]).sum()
        };
        let energies: Vec<f64> = mesh.faces().map(energy).collect();
        let areas = domain.face_areas();
        let area: f64 = areas.iter().sum();
        let whole: f64 = energies.iter().sum();
        let fourth: f64 = energies.iter().zip(areas).map(|(q, a)| q * q / a).sum();
        let mut derivative = PerEdge::filled(mesh.n_edges(), 0.0);
        for f in mesh.faces() {
            let by_energy =
                energies[f.index()] / areas[f] / (whole * whole) - fourth / (whole * whole * whole);
            for (e, cot) in mesh.opposite_edges(f).into_iter().zip(domain.cotangents()[f]) {
                derivative[e] += 2.0 * area * by_energy * cot * form.0[e];
            }
        }
        Evenness { ratio: area * fourth / (whole * whole), derivative }
    }

    /// The derivative in the direction of another form.
    fn slope(&self, form: &OneForm) -> f64 {
        self.derivative.iter().zip(form.0.iter()).map(|(a, b)| a * b).sum()
    }
}
