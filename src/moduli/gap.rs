//! The gap between the energies of closed forms and the lower bound that they give, in all and by faces.
//!
//! With the energies `G = L Lᵀ` of forms h in a symplectic basis and `S = ∫ h ∧ h`, the true energies lie between G and `Sᵀ G⁻¹ S`. In the
//! frame `e = L⁻¹ h` the lower bound is `K Kᵀ`, `K = L⁻¹ S L⁻ᵀ`, whose eigenvalues are 1/d² for the symplectic eigenvalues d ≥ 1 of G, each
//! twice, and `1 − K Kᵀ` is the integral over the faces of the products of `e + ⋆(K e)`.

use super::elements::ClosedForm;
use super::finer::BisectedSurface;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::Enclosure;
use crate::linalg::dense::{cholesky, symmetric_eigenvalues};
use crate::mesh::{FaceId, PerFace};
use crate::parallel;

/// Faces whose sums are formed together, in order.
const FACES_PER_SUM: usize = 2048;

/// Energies of forms and what is missing between them and their lower bound.
pub(super) struct Gap {
    /// The largest symplectic eigenvalue minus 1.
    pub gap: f64,
    /// Per face, the share of it in `Σ (1 − 1/d²)` over all 2g eigenvalues (F entries).
    pub shares: PerFace<f64>,
}

impl Gap {
    /// The gap of one closed form per class, rounded.
    ///
    /// # Errors
    /// [`Error::Factorisation`] where rounding has made the energies indefinite; [`Error::Cancelled`].
    pub fn new(
        surface: &BisectedSurface,
        forms: &[ClosedForm],
        cotangents: &PerFace<[Enclosure; 3]>,
        control: &Control,
    ) -> Result<Gap> {
        control.check()?;
        let energies = energies(surface, forms, cotangents);
        let lower = cholesky(&energies)?;
        let frame = inverse(&lower);
        let wedge = wedge_in(&frame);
        let square = product(&wedge, &transposed(&wedge));
        let least = symmetric_eigenvalues(&square)?.first().copied().unwrap_or(f64::NAN);
        let gap = least.sqrt().recip() - 1.0;
        if !gap.is_finite() {
            let message = format!("the lower bound of the energies of forms has the eigenvalue {least:e}");
            return Err(Error::Factorisation { size: forms.len(), message });
        }
        control.check()?;
        // Row a of e + ⋆ K e is a combination of forms h and of their stars.
        let starred = product(&wedge, &frame);
        let mut shares = vec![0.0; surface.mesh.n_faces()];
        parallel::fill(&mut shares, |f| {
            let f = FaceId::from(f);
            share(surface, forms, f, cotangents[f], [&frame, &starred])
        });
        Ok(Gap { gap: gap.max(0.0), shares: shares.into() })
    }
}

/// The products of the forms, in f64.
fn energies(
    surface: &BisectedSurface,
    forms: &[ClosedForm],
    cotangents: &PerFace<[Enclosure; 3]>,
) -> Vec<Vec<f64>> {
    let (n, faces) = (forms.len(), surface.mesh.n_faces());
    let parts = parallel::map(faces.div_ceil(FACES_PER_SUM), |part| {
        let mut sum = vec![vec![0.0; n]; n];
        for f in part * FACES_PER_SUM..faces.min((part + 1) * FACES_PER_SUM) {
            let f = FaceId::from(f);
            let cot = cotangents[f].map(Enclosure::nearest);
            let on: Vec<_> = forms.iter().enumerate().map(|(k, form)| surface.on_face(k, form, f)).collect();
            let (midpoints, weight) = if surface.has_curved_side(f) { (3, 1.0 / 6.0) } else { (1, 0.5) };
            for m in 0..midpoints {
                let values: Vec<[f64; 3]> = on.iter().map(|form| form.at_midpoint(m)).collect();
                for (i, row) in sum.iter_mut().enumerate() {
                    let scaled = [0, 1, 2].map(|s| weight * cot[s] * values[i][s]);
                    for (x, v) in row[..=i].iter_mut().zip(&values) {
                        *x += scaled[0] * v[0] + scaled[1] * v[1] + scaled[2] * v[2];
                    }
                }
            }
        }
        sum
    });
    let mut total = vec![vec![0.0; n]; n];
    for part in parts {
        for (row, add) in total.iter_mut().zip(part) {
            row.iter_mut().zip(add).for_each(|(x, y)| *x += y);
        }
    }
    (0..n).map(|i| (0..n).map(|j| total[i.max(j)][i.min(j)]).collect()).collect()
}

/// The integral over a face of the squares of the combinations `frame h + ⋆ starred h`.
fn share(
    surface: &BisectedSurface,
    forms: &[ClosedForm],
    f: FaceId,
    cotangents: [Enclosure; 3],
    [frame, starred]: [&Vec<Vec<f64>>; 2],
) -> f64 {
    // Corner 0 at the origin, corner 1 on the x axis, and corner 2 at (x, y).
    let c = surface.lengths[surface.mesh.opposite_edges(f)[2]].nearest();
    let [cot0, cot1, _] = cotangents.map(Enclosure::nearest);
    let y = c / (cot0 + cot1);
    let x = cot0 * y;
    let (midpoints, weight) = if surface.has_curved_side(f) { (3, c * y / 6.0) } else { (1, 0.5 * c * y) };
    let on: Vec<_> = forms.iter().enumerate().map(|(k, form)| surface.on_face(k, form, f)).collect();
    let mut total = 0.0;
    for m in 0..midpoints {
        let vector = |values: [f64; 3]| {
            let along = values[2] / c;
            [along, (-values[1] - along * x) / y]
        };
        let h: Vec<[f64; 2]> = on.iter().map(|form| vector(form.at_midpoint(m))).collect();
        let combined = |row: &Vec<f64>| {
            row.iter().zip(&h).fold([0.0, 0.0], |[p, q], (t, [x, y])| [p + t * x, q + t * y])
        };
        for (row, star) in frame.iter().zip(starred) {
            let ([p, q], [s, t]) = (combined(row), combined(star));
            total += (p - t) * (p - t) + (q + s) * (q + s);
        }
    }
    total * weight
}

/// `F S Fᵀ` for the wedge products S of a basis a1, b1, a2, b2, …
pub(super) fn wedge_in(frame: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let pair = |x: &[f64], y: &[f64]| {
        x.chunks(2).zip(y.chunks(2)).map(|(x, y)| x[0] * y[1] - x[1] * y[0]).sum::<f64>()
    };
    frame.iter().map(|x| frame.iter().map(|y| pair(x, y)).collect()).collect()
}

pub(super) fn transposed(a: &[Vec<f64>]) -> Vec<Vec<f64>> {
    (0..a.len()).map(|j| a.iter().map(|row| row[j]).collect()).collect()
}

pub(super) fn product(a: &[Vec<f64>], b: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let n = b.len();
    let entry = |row: &Vec<f64>, j: usize| (0..n).map(|k| row[k] * b[k][j]).sum();
    a.iter().map(|row| (0..n).map(|j| entry(row, j)).collect()).collect()
}

/// The inverse of a lower triangle with a positive diagonal.
pub(super) fn inverse(lower: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let n = lower.len();
    let mut inverse = vec![vec![0.0; n]; n];
    for i in 0..n {
        for j in 0..=i {
            let sum: f64 = (j..i).map(|k| lower[i][k] * inverse[k][j]).sum();
            inverse[i][j] = (f64::from(u8::from(i == j)) - sum) / lower[i][i];
        }
    }
    inverse
}
