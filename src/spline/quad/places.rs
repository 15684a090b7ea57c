//! Places on splines over four-sided patches, and the surface at many of them.

use super::quintic::QuinticBasis;
use super::spline::QuadSpline;
use crate::control::Control;
use crate::error::Result;
use crate::geometry::vector::Vector;
use crate::spline::batches::in_batches;
use crate::spline::triangular::SurfacePoint;

/// Number of places between two reports.
pub(super) const BATCH: usize = 1 << 12;

/// A place on a spline over four-sided patches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PatchPlace {
    /// The patch.
    pub patch: usize,
    /// u and v, from 0 to 1 each.
    pub parameters: [f64; 2],
}

impl QuadSpline {
    /// The surface at places, in parallel.
    ///
    /// # Errors
    /// Those of [`QuadSpline::evaluate`] for the first place that does not exist; [`crate::Error::Cancelled`].
    pub fn evaluate_places(
        &self,
        places: &[PatchPlace],
        threads: usize,
        control: &Control,
    ) -> Result<Vec<SurfacePoint>> {
        in_batches(places, BATCH, threads, control, |(): &mut (), place| {
            self.evaluate(place.patch, place.parameters)
        })
    }

    /// The third derivatives uuu, uuv, uvv, vvv at a place; at an inner knot those behind it.
    ///
    /// # Errors
    /// Those of [`QuadSpline::evaluate`].
    pub fn third_derivatives(&self, PatchPlace { patch, parameters }: PatchPlace) -> Result<[Vector; 4]> {
        self.check_place(patch, parameters)?;
        let [m, n] = self.space().patch_spans(patch);
        let [along_u, along_v] = [QuinticBasis::at(m, parameters[0]), QuinticBasis::at(n, parameters[1])];
        let orders = [[3, 0], [2, 1], [1, 2], [0, 3]];
        Ok(orders.map(|of| self.derivative(patch, [&along_u, &along_v], of)))
    }
}
