//! Directions of patches with a number of spans: the places at which a fit takes distances, and those at which it is measured.

use super::quintic::{LOCAL, QUINTIC, QuinticBasis, basis_size};
use crate::geometry::quadrature::gauss_legendre;

/// Places in every span and direction at which distances are taken: of patches with one span, and of others, which have fewer coefficients per
/// span. As many as there are coefficients would be interpolated, with large errors between them.
const PLACES_OF_ONE_SPAN: usize = 2 * QUINTIC;
const PLACES_OF_A_SPAN: usize = 7;
/// Places in each direction of a patch at which a fit is measured: other ones than those at which distances are taken.
pub(super) const MEASURED: usize = 23;

/// A place along a direction of a patch.
#[derive(Clone, Copy)]
pub(super) struct SpanPlace {
    pub basis: QuinticBasis,
    pub parameter: f64,
    /// The share of the direction that it stands for.
    pub weight: f64,
}

/// A direction of a patch with a number of spans.
pub(super) struct SpanDirection {
    pub places: Vec<SpanPlace>,
    /// The places between the ends at which a fit is measured, each with the number of the nearest of the others.
    pub measured: Vec<(QuinticBasis, usize)>,
    /// ∫ of the products of the derivatives of order 0, 1 and 2 of two basis functions i and j, at i · n + j of n functions.
    pub products: [Vec<f64>; 3],
}

impl SpanDirection {
    /// The direction with the places of Gauss in every span, at which products of derivatives are integrated exactly.
    pub fn new(spans: usize) -> SpanDirection {
        let in_span = gauss_legendre(if spans == 1 { PLACES_OF_ONE_SPAN } else { PLACES_OF_A_SPAN });
        let place = |s: usize, [x, w]: [f64; 2]| {
            let parameter = (s as f64 + x) / spans as f64;
            SpanPlace { basis: QuinticBasis::at(spans, parameter), parameter, weight: w / spans as f64 }
        };
        let places: Vec<SpanPlace> =
            (0..spans).flat_map(|s| in_span.iter().map(move |&at| place(s, at))).collect();
        let n = basis_size(spans);
        let product = |order: usize| {
            let mut sum = vec![0.0; n * n];
            for SpanPlace { basis: QuinticBasis { first, derivatives }, weight, .. } in &places {
                let values = derivatives[order];
                for (i, j) in (0..LOCAL).flat_map(|i| (0..LOCAL).map(move |j| (i, j))) {
                    sum[(first + i) * n + first + j] += weight * values[i] * values[j];
                }
            }
            sum
        };
        SpanDirection { products: [0, 1, 2].map(product), measured: measured(spans, &places), places }
    }
}

/// The places of a direction, but for its ends, at which a fit is measured, with the nearest of others.
fn measured(spans: usize, places: &[SpanPlace]) -> Vec<(QuinticBasis, usize)> {
    let at = |k: usize| {
        let parameter = measured_parameter(k);
        let after = places.partition_point(|place| place.parameter < parameter);
        let far = |place: usize| (places[place].parameter - parameter).abs();
        let nearest = match after {
            0 => 0,
            n if n == places.len() || far(n - 1) <= far(n) => n - 1,
            n => n,
        };
        (QuinticBasis::at(spans, parameter), nearest)
    };
    (1..MEASURED - 1).map(at).collect()
}

/// The k-th of the parameters at which a fit is measured, from 0 to 1.
pub(super) fn measured_parameter(k: usize) -> f64 {
    k as f64 / (MEASURED - 1) as f64
}
