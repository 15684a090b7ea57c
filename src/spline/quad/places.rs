//! Places on splines over four-sided patches, and the surface at many of them.

use super::quintic::QuinticBasis;
use super::spline::QuadSpline;
use crate::control::{Control, Stage};
use crate::error::{Error, Result};
use crate::geometry::vector::Vector;
use crate::parallel;
use crate::spline::triangular::SurfacePoint;

/// Number of places between two checks for cancellation.
const BATCH: usize = 1 << 12;

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
        in_batches(places, threads, control, |place| self.evaluate(place.patch, place.parameters))
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

/// The results `work(&all[i])` for every i, in parallel, with a report after every batch; the first error, if there is one. None is
/// begun after the call is cancelled.
pub(super) fn in_batches<A: Sync, T: Send>(
    all: &[A],
    threads: usize,
    control: &Control,
    work: impl Fn(&A) -> Result<T> + Sync + Send,
) -> Result<Vec<T>> {
    parallel::within(threads, || {
        let mut done = Vec::with_capacity(all.len());
        for batch in all.chunks(BATCH) {
            control.step(Stage::Layout, done.len() as f64 / all.len() as f64)?;
            let mut found: Vec<Option<Result<T>>> = batch.iter().map(|_| None).collect();
            parallel::fill(&mut found, |i| {
                Some(if control.is_cancelled() { Err(Error::Cancelled) } else { work(&batch[i]) })
            });
            done.extend(found.into_iter().flatten().collect::<Result<Vec<_>>>()?);
        }
        control.step(Stage::Layout, 1.0)?;
        Ok(done)
    })
}
