//! The energies of closed forms as enclosures of a matrix that is certainly not below them.
//!
//! An energy is a sum of terms `c v vᵀ`, v the values of the forms on a vector, half a cotangent (or a sixth) for c. The values are exact
//! ([`super::elements::quantised`]), so rounding every c upwards gives a matrix above the energies. What is left is the rounding of its sums.

use super::elements::{ClosedForm, OnFace};
use super::finer::BisectedSurface;
use crate::control::Control;
use crate::error::Result;
use crate::geometry::{DoubleDouble, Enclosure};
use crate::mesh::{EdgeId, FaceId, PerEdge, PerFace};
use crate::parallel;

/// Terms that are summed together, in order.
const PER_SUM: usize = 2048;
/// Bound of the rounding error of a sum of products c v v' over the sum of their sizes: two products in f64, and a sum in double-double
/// precision whose error is far below one more.
const SUM_ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Sums of products of values, and of the sizes of the squares.
struct Sums {
    products: Vec<Vec<DoubleDouble>>,
    sizes: Vec<f64>,
}

impl Sums {
    fn new(n: usize) -> Sums {
        Sums { products: (0..n).map(|i| vec![DoubleDouble::from(0.0); i + 1]).collect(), sizes: vec![0.0; n] }
    }

    fn add(&mut self, c: f64, values: &[f64]) {
        for (i, row) in self.products.iter_mut().enumerate() {
            let scaled = c * values[i];
            self.sizes[i] += (scaled * values[i]).abs();
            row.iter_mut().zip(values).for_each(|(sum, v)| *sum = sum.plus(scaled * v));
        }
    }

    fn join(&mut self, other: &Sums) {
        for (row, more) in self.products.iter_mut().zip(&other.products) {
            row.iter_mut().zip(more).for_each(|(sum, &x)| *sum = *sum + x);
        }
        self.sizes.iter_mut().zip(&other.sizes).for_each(|(sum, x)| *sum += x);
    }

    /// The symmetric matrix, each entry within its error.
    fn enclosures(&self) -> Vec<Vec<Enclosure>> {
        // Sizes are sums of positive numbers, whose own relative error is below 1e-8 for fewer than 1e7 terms.
        let root: Vec<f64> = self.sizes.iter().map(|s| (s * (1.0 + 1e-8)).sqrt()).collect();
        let n = root.len();
        let entry = |i: usize, j: usize| {
            let radius = SUM_ROUNDING * root[i] * root[j] * (1.0 + 1e-12) + f64::MIN_POSITIVE;
            Enclosure::new(self.products[i.max(j)][i.min(j)], radius)
        };
        (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect()
    }
}

/// A matrix that is not below the energies `∫ h_k ∧ ⋆h_l` of the forms on the given surface, in the order of definite matrices.
///
/// # Errors
/// [`crate::Error::Cancelled`].
pub(super) fn upper_energies(
    surface: &BisectedSurface,
    forms: &[ClosedForm],
    cotangents: &PerFace<[Enclosure; 3]>,
    control: &Control,
) -> Result<Vec<Vec<Enclosure>>> {
    let n = forms.len();
    let weights = weights(surface, cotangents);
    let mut total = Sums::new(n);
    let (n_edges, n_faces) = (surface.mesh.n_edges(), surface.mesh.n_faces());
    let of_edges = parallel::map(n_edges.div_ceil(PER_SUM), |part| {
        let mut sums = Sums::new(n);
        for e in (part * PER_SUM..n_edges.min((part + 1) * PER_SUM)).map(EdgeId::from) {
            let [i, j] = surface.mesh.ends(e);
            let value = |(k, form): (usize, &ClosedForm)| {
                f64::from(surface.cochains[k][e]) + (form.potential[j] - form.potential[i])
            };
            let values: Vec<f64> = forms.iter().enumerate().map(value).collect();
            sums.add(weights[e], &values);
        }
        sums
    });
    of_edges.iter().for_each(|sums| total.join(sums));
    control.check()?;
    let of_faces = parallel::map(n_faces.div_ceil(PER_SUM), |part| {
        let mut sums = Sums::new(n);
        for f in (part * PER_SUM..n_faces.min((part + 1) * PER_SUM)).map(FaceId::from) {
            if surface.has_curved_side(f) {
                add_face(&mut sums, surface, forms, f, cotangents[f]);
            }
        }
        sums
    });
    of_faces.iter().for_each(|sums| total.join(sums));
    let factor = Enclosure::from(1.0) + surface.distortion.into();
    Ok(total.enclosures().into_iter().map(|row| row.into_iter().map(|x| factor * x).collect()).collect())
}

/// Upper bounds of the weights of the edges: half of the cotangents opposite, of faces with quadratic terms a sixth, for the values at the
/// midpoint of the edge itself.
fn weights(surface: &BisectedSurface, cotangents: &PerFace<[Enclosure; 3]>) -> PerEdge<f64> {
    let mut weights = PerEdge::filled(surface.mesh.n_edges(), Enclosure::from(0.0));
    for f in surface.mesh.faces() {
        let is_curved = surface.has_curved_side(f);
        for (e, cot) in surface.mesh.opposite_edges(f).into_iter().zip(cotangents[f]) {
            let half = cot.times_power(0.5);
            weights[e] = weights[e] + if is_curved { half / 3.0.into() } else { half };
        }
    }
    PerEdge::from_fn(weights.len(), |e| weights[e].upper())
}

/// Add the terms of a face with quadratic terms at the midpoints of its sides, on the vectors of the other sides.
fn add_face(
    sums: &mut Sums,
    surface: &BisectedSurface,
    forms: &[ClosedForm],
    f: FaceId,
    cot: [Enclosure; 3],
) {
    let factor = cot.map(|cot| (cot.times_power(0.5) / 3.0.into()).upper());
    let on: Vec<OnFace> = forms.iter().enumerate().map(|(k, form)| surface.on_face(k, form, f)).collect();
    let mut values = vec![0.0; forms.len()];
    for m in 0..3 {
        for s in [(m + 1) % 3, (m + 2) % 3] {
            values.iter_mut().zip(&on).for_each(|(value, form)| *value = form.at_midpoint(m)[s]);
            sums.add(factor[s], &values);
        }
    }
}
