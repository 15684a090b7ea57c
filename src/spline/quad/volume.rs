//! The volume that patches enclose.

use super::quintic::{QUINTIC, QuinticBasis};
use super::spline::QuadSpline;
use crate::geometry::quadrature::gauss_legendre;
use crate::geometry::vector::{cross, dot};
use crate::parallel;

/// Places along a span that integrate the triple product of a point and its first derivatives exactly, which has degree 3 × 5 − 1.
const PLACES: usize = (3 * QUINTIC).div_ceil(2);

impl QuadSpline {
    /// The volume that the surface encloses if it closes up, positive where normals point outwards: a third of the flux of the point through
    /// it. Without a meaning for surfaces with a boundary.
    pub fn volume(&self) -> f64 {
        let all: Vec<usize> = (0..self.space().layout().patches().len()).collect();
        self.volume_of(&all)
    }

    /// The part of [`QuadSpline::volume`] of these patches.
    pub(super) fn volume_of(&self, patches: &[usize]) -> f64 {
        parallel::map(patches.len(), |k| self.flux(patches[k])).iter().sum::<f64>() / 3.0
    }

    /// The flux of the point through a patch.
    fn flux(&self, patch: usize) -> f64 {
        let places = gauss_legendre(PLACES);
        let along = self.space().patch_spans(patch).map(|spans| {
            let of_span = |k: usize| {
                places.iter().map(move |[x, weight]| {
                    let parameter = (k as f64 + x) / spans as f64;
                    (QuinticBasis::at(spans, parameter), weight / spans as f64)
                })
            };
            (0..spans).flat_map(of_span).collect::<Vec<_>>()
        });
        let mut sum = 0.0;
        for (u, weight_u) in &along[0] {
            for (v, weight_v) in &along[1] {
                let at = self.combined(patch, u, v);
                sum += weight_u * weight_v * dot(at.point, cross(at.first[0], at.first[1]));
            }
        }
        sum
    }
}
