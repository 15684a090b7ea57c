//! Evaluation of splines, and the search for the patches in which points of the domain lie.

use crate::arrays::{array, array_of, check_buffer, copy_each, copy_out};
use crate::choice::choices;
use crate::control::{self, ricci_control};
use crate::failure::{Failure, FailureElement, Outcome};
use crate::guard;
use crate::memory;
use crate::spline::ricci_spline;
use crate::spline_memory;
use crate::status::*;
use crate::structs::{self, sized};
use ricci::Control;
use ricci::spline::{Locator, Parameter, SplineSpace, SurfacePoint};

choices!(enum SplineQuantity, QUANTITIES = "which", [
    RICCI_SPLINE_POINT => Point,
    RICCI_SPLINE_FIRST => First,
    RICCI_SPLINE_SECOND => Second,
    RICCI_SPLINE_SHAPE => Shape,
]);

impl SplineQuantity {
    /// The number of derivatives that are needed, and the count of numbers per point.
    fn sizes(self) -> (usize, usize) {
        match self {
            SplineQuantity::Point => (0, 3),
            SplineQuantity::First => (1, 9),
            SplineQuantity::Second => (2, 18),
            SplineQuantity::Shape => (2, 5),
        }
    }

    /// Appends the numbers of this quantity at a point.
    fn add(self, at: &SurfacePoint, row: &mut Vec<f64>) {
        if self == SplineQuantity::Shape {
            row.extend(at.normal().unwrap_or([f64::NAN; 3]));
            row.extend(at.principal_curvatures().unwrap_or([f64::NAN; 2]));
            return;
        }
        let derivatives = at.first.iter().chain(&at.second).flatten();
        row.extend(at.point.iter().chain(derivatives).take(self.sizes().1));
    }
}

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_spline_places {
    pub size: usize,
    pub patches: *const u32,
    pub parameters: *const f64,
    pub n: usize,
    pub threads: usize,
}
// SAFETY: numbers and raw pointers; 8-byte alignment, size first.
sized!(ricci_spline_places, "places");

impl ricci_spline_places {
    pub(crate) fn read(&self, space: &SplineSpace, control: &Control) -> Outcome<Vec<Parameter>> {
        let points: Vec<[f64; 2]> = array("parameters", self.parameters.cast(), self.n)?;
        if self.patches.is_null() {
            return located(space, &points, control);
        }
        let patches = array("patches", self.patches, self.n)?;
        let place = |(patch, [x, y]): (u32, [f64; 2])| Parameter { patch, x, y };
        Ok(patches.into_iter().zip(points).map(place).collect())
    }
}

/// Number of points between two looks at the control.
const POINTS_PER_LOOK: usize = 256;

/// The places of points of the domain: the patch in which each lies.
pub(crate) fn located(
    space: &SplineSpace,
    points: &[[f64; 2]],
    control: &Control,
) -> Outcome<Vec<Parameter>> {
    let domain = space.domain()?;
    let locator = Locator::new(&domain);
    let place = |(i, &[x, y]): (usize, &[f64; 2])| {
        if i.is_multiple_of(POINTS_PER_LOOK) {
            control.check()?;
        }
        locator.locate([x, y]).ok_or_else(|| {
            let message = format!("point {i}: ({x}, {y}) lies outside the domain");
            Failure::new(RICCI_SPLINE, message).at(FailureElement::Entry, i)
        })
    };
    points.iter().enumerate().map(place).collect()
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_spline_locate(
    spline: *const ricci_spline,
    points: *const f64,
    n: usize,
    patches: *mut i32,
    capacity: usize,
) -> ricci_status {
    guard::with(spline, |ricci_spline { spline, .. }| {
        let _reserve = memory::work(n.saturating_add(spline.space().patches().len()), spline_memory::POINT)?;
        let points: Vec<[f64; 2]> = array("points", points.cast(), n)?;
        let domain = spline.space().domain()?;
        let locator = Locator::new(&domain);
        let found = points.iter().map(|&p| locator.locate(p).map_or(-1, |at| at.patch as i32));
        copy_each("patches", n, found, patches, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_spline_evaluate(
    spline: *const ricci_spline,
    places: *const ricci_spline_places,
    which: u32,
    control: *const ricci_control,
    values: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(spline, |ricci_spline { spline, .. }| {
        let (places, which) = (structs::read(places)?, QUANTITIES.choose(which)?);
        let (order, size) = which.sizes();
        check_buffer("values", places.n.saturating_mul(size), values, capacity)?;
        let _reserve = memory::work(places.n, spline_memory::POINT)?;
        let control = control::of(control)?;
        let at = places.read(spline.space(), &control)?;
        let found = spline.evaluate(&at, order, places.threads, &control)?;
        let mut all = Vec::with_capacity(found.len() * size);
        found.iter().for_each(|at| which.add(at, &mut all));
        copy_out("values", &all, values, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_spline_blossom(
    spline: *const ricci_spline,
    patch: usize,
    arguments: *const f64,
    n_arguments: usize,
    point: *mut f64,
) -> ricci_status {
    guard::with(spline, |ricci_spline { spline, .. }| {
        let degree = spline.space().degree();
        let arguments: Vec<[f64; 2]> = array_of("arguments", arguments.cast(), n_arguments, degree)?;
        copy_out("point", &spline.blossom(patch, &arguments)?, point, 3)
    })
}
