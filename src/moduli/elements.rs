//! Closed 1-forms on a finer triangulation: integers plus the derivative of a function, linear on every face with quadratic terms on some
//! edges.
//!
//! In a face with corners 0, 1, 2, side k goes from corner k + 1 to corner k + 2. A form is `p + d Σ_k 4 b_k λ_{k+1} λ_{k+2}` there, p with
//! the integrals p_k over the sides. At the midpoint of side m its value on the vector of side k is `p_k`, `p_k + t_m`, `p_k − t_m` for k = m,
//! m + 1, m + 2, with `t_m = 2 (b_{m+1} + b_{m+2} − b_m)`, and the integral of a square over the face is a third of the sum over midpoints,
//! times the area. The square of a vector is `Σ_k cot θ_k v_k² / 2` over the area, v_k its products with the sides.

use super::finer::{BisectedSurface, double_area};
use crate::geometry::Enclosure;
use crate::mesh::{EdgeId, FaceId, PerEdge, PerFace, PerVertex};
use crate::parallel;

/// The functions whose derivatives are added to forms.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Degree {
    /// Linear on the faces. The gap falls as 1/V.
    Linear,
    /// Quadratic where that lowers the gap. The gap falls about as 1/V².
    #[default]
    Quadratic,
}

/// The exact part of a closed form, whose other part is one of [`BisectedSurface::cochains`].
#[derive(Debug, Clone, PartialEq)]
pub struct ClosedForm {
    /// The function at the vertices (V entries).
    pub potential: PerVertex<f64>,
    /// What the function has beyond the mean of the ends at the midpoint of each edge (E entries, 0 where it is linear).
    pub curve: PerEdge<f64>,
}

/// A form on one face.
#[derive(Clone, Copy)]
pub(super) struct OnFace {
    /// The integrals of its linear part over the sides.
    pub sides: [f64; 3],
    /// The t_m, all 0 on a face without quadratic terms.
    pub turns: [f64; 3],
}

impl OnFace {
    /// The values at the midpoint of side m on the vectors of the sides.
    pub fn at_midpoint(self, m: usize) -> [f64; 3] {
        let mut values = self.sides;
        values[(m + 1) % 3] += self.turns[m];
        values[(m + 2) % 3] -= self.turns[m];
        values
    }
}

impl BisectedSurface {
    /// Closed form k with this exact part on a face. Without rounding for forms made by [`quantised`].
    pub(super) fn on_face(&self, k: usize, form: &ClosedForm, f: FaceId) -> OnFace {
        let halfedges = self.mesh.face_halfedges(f);
        let at = [0, 1, 2].map(|k| form.potential[self.mesh.origin(halfedges[k])]);
        let sides = [0, 1, 2].map(|s| {
            let integer = f64::from(self.along(k, halfedges[(s + 1) % 3]));
            integer + (at[(s + 2) % 3] - at[(s + 1) % 3])
        });
        let curve = self.mesh.opposite_edges(f).map(|e: EdgeId| form.curve[e]);
        let turns = [0, 1, 2].map(|m| 2.0 * (curve[(m + 1) % 3] + curve[(m + 2) % 3] - curve[m]));
        OnFace { sides, turns }
    }

    /// The cotangents of the angles at the corners of every face (F entries).
    pub(super) fn cotangents(&self) -> PerFace<[Enclosure; 3]> {
        let mut all = vec![[Enclosure::from(0.0); 3]; self.mesh.n_faces()];
        parallel::fill(&mut all, |f| {
            let l = self.mesh.opposite_edges(FaceId::from(f)).map(|e| self.lengths[e]);
            let four_areas = double_area(l[0], l[1], l[2]).times_power(2.0);
            [0, 1, 2].map(|k| {
                let [a, b, c] = [l[k], l[(k + 1) % 3], l[(k + 2) % 3]];
                ((b - a) * (b + a) + c * c) / four_areas
            })
        });
        all.into()
    }
}

/// Number of binary digits of the numbers of a closed form: sums of ten of them are exact in 53.
const DIGITS: i32 = 47;

/// Rounds numbers to multiples of one power of two, so that sums of ten of them, and of integers up to `largest`, are exact.
pub(super) fn quantised(numbers: &mut [f64], largest: f64) {
    let largest = numbers.iter().fold(largest, |most, x| most.max(x.abs()));
    let quantum = 2f64.powi(largest.max(f64::MIN_POSITIVE).log2().ceil() as i32 - DIGITS);
    numbers.iter_mut().for_each(|x| *x = (*x / quantum).round() * quantum);
}
