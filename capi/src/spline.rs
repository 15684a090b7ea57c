//! Triangular B-splines: construction over the plane, and access to control points, knots and patches.

use crate::arrays::{array, array_of, copy_out, optional};
use crate::choice::choices;
use crate::control::{self, ricci_control};
use crate::failure::{Failure, FailureElement, Outcome};
use crate::guard::{self, handle, shared};
use crate::memory;
use crate::mesh::ricci_mesh;
use crate::spline_memory;
use crate::status::*;
use crate::structs::{self, or, sized};
use ricci::mesh::io::Soup;
use ricci::records::SplineFigures;
use ricci::spline::{KnotOptions, PlaneDomain, Polynomial, Spline, SplineSpace, basis_size, triangulate};
use std::sync::Arc;

pub struct ricci_spline {
    pub(crate) spline: Spline,
    /// None if it was not fitted.
    pub(crate) fitted: Option<SplineFigures>,
}
handle!(ricci_spline, "spline", |spline| spline.spline.space().patches().len()
    + spline.spline.space().n_control_points());

impl From<Spline> for ricci_spline {
    fn from(spline: Spline) -> ricci_spline {
        ricci_spline { spline, fitted: None }
    }
}

choices!(enum SplinePart, PARTS = "which", [
    RICCI_SPLINE_CONTROL_POINTS => ControlPoints,
    RICCI_SPLINE_KNOTS => Knots,
    RICCI_SPLINE_ABSCISSAS => Abscissas,
    RICCI_SPLINE_HOLES => Holes,
]);

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_spline_spec {
    pub size: usize,
    pub knots: *const f64,
    pub coincident: *const u32,
    pub n_coincident: usize,
    pub creases: *const u32,
    pub n_creases: usize,
    pub spread: f64,
    pub degree: u32,
    pub reserved: u32,
}
// SAFETY: numbers and raw pointers; 8-byte alignment, size first.
sized!(ricci_spline_spec, "spec", reserved);

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_spline_summary {
    pub size: usize,
    pub degree: usize,
    pub n_patches: usize,
    pub n_basis: usize,
    pub n_control_points: usize,
    pub fit_rms: f64,
    pub fit_max: f64,
    pub n_holes: usize,
    pub n_folded_patches: usize,
    pub folded_share: f64,
    pub converged: u32,
    pub reserved: u32,
}
// SAFETY: numbers; 8-byte alignment, size first.
sized!(ricci_spline_summary, "summary", reserved);

/// The degree of a spline whose spec has degree 0.
const USUAL_DEGREE: usize = 3;

impl ricci_spline_spec {
    fn degree(&self) -> usize {
        if self.degree == 0 { USUAL_DEGREE } else { self.degree as usize }
    }

    /// The knots of each vertex of a domain: the caller's, or else those that the spec's options lead to.
    fn knots(&self, domain: &PlaneDomain) -> Outcome<Vec<Vec<[f64; 2]>>> {
        let per_vertex = self.degree().saturating_add(1);
        let n = domain.vertices.len().saturating_mul(per_vertex);
        if let Some(knots) = optional::<[f64; 2]>("knots", self.knots, n)? {
            return Ok(knots.chunks_exact(per_vertex).map(<[_]>::to_vec).collect());
        }
        let usual = KnotOptions::default();
        let options = KnotOptions {
            spread: or(self.spread, usual.spread),
            coincident: array("coincident", self.coincident, self.n_coincident)?,
            creases: array("creases", self.creases.cast(), self.n_creases)?,
        };
        Ok(domain.knots(self.degree(), &options)?)
    }
}

/// The spline of a space that is the plane z = 0: its control points are the abscissas.
fn flat(space: SplineSpace) -> Outcome<ricci_spline> {
    let points = space.abscissas().into_iter().map(|[x, y]| [x, y, 0.0]).collect();
    Ok(Spline::new(Arc::new(space), points)?.into())
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_spline_domain(
    corners: *const f64,
    starts: *const usize,
    n_polygons: usize,
    edge: f64,
    domain: *mut *mut ricci_mesh,
) -> ricci_status {
    guard::make(domain, || {
        let starts = array("starts", starts, n_polygons.saturating_add(1))?;
        if let Some(i) = (0..n_polygons).find(|&i| starts[i] > starts[i + 1]) {
            let message = format!("starts[{}] is below starts[{i}]: offsets ascend", i + 1);
            return Err(Failure::argument(message).at(FailureElement::Entry, i + 1));
        }
        let all: Vec<[f64; 2]> = array("corners", corners.cast(), starts[n_polygons])?;
        let polygons: Vec<Vec<[f64; 2]>> =
            starts.windows(2).map(|ends| all[ends[0]..ends[1]].to_vec()).collect();
        let PlaneDomain { vertices, triangles } = triangulate(&polygons, edge)?;
        let positions = vertices.into_iter().map(|[x, y]| [x, y, 0.0]).collect();
        ricci_mesh::from_soup(Soup::new(positions, triangles))
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_spline_new(
    domain: *const ricci_mesh,
    spec: *const ricci_spline_spec,
    spline: *mut *mut ricci_spline,
) -> ricci_status {
    guard::make(spline, || {
        let (mesh, spec) = (shared(domain)?, structs::read(spec)?);
        let Soup { positions, faces: triangles, .. } = mesh.soup()?;
        let _reserve = memory::work(triangles.len(), spline_memory::patch(spec.degree()))?;
        let vertices = positions.into_iter().map(|[x, y, _]| [x, y]).collect();
        let domain = PlaneDomain { vertices, triangles };
        flat(SplineSpace::planar(&domain, &spec.knots(&domain)?)?)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_spline_with_points(
    spline: *const ricci_spline,
    points: *const f64,
    n_points: usize,
    result: *mut *mut ricci_spline,
) -> ricci_status {
    guard::make(result, || {
        let space = shared(spline)?.spline.space();
        let points = array_of("points", points.cast(), n_points, space.n_control_points())?;
        Ok(Spline::new(space.clone(), points)?.into())
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_spline_with_polynomial(
    spline: *const ricci_spline,
    coefficients: *const f64,
    n_coefficients: usize,
    result: *mut *mut ricci_spline,
) -> ricci_status {
    guard::make(result, || {
        let space = shared(spline)?.spline.space();
        let degree = space.degree();
        let coefficients: Vec<[f64; 3]> =
            array_of("coefficients", coefficients.cast(), n_coefficients, basis_size(degree))?;
        let points = space.control_points_of(&Polynomial::new(degree, coefficients))?;
        Ok(Spline::new(space.clone(), points)?.into())
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_spline_free(spline: *mut ricci_spline) {
    guard::free(spline);
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_spline_summarise(
    spline: *const ricci_spline,
    summary: *mut ricci_spline_summary,
    size: usize,
) -> ricci_status {
    guard::with(spline, |ricci_spline { spline, fitted }| {
        let space = spline.space();
        let of_fit = |figure: fn(&SplineFigures) -> f64| fitted.as_ref().map_or(f64::NAN, figure);
        let figures = ricci_spline_summary {
            size,
            degree: space.degree(),
            n_patches: space.patches().len(),
            n_basis: basis_size(space.degree()),
            n_control_points: space.n_control_points(),
            fit_rms: of_fit(|fit| fit.rms),
            fit_max: of_fit(|fit| fit.max),
            n_holes: spline.holes().len(),
            n_folded_patches: fitted.as_ref().map_or(0, |fit| fit.folds.len()),
            folded_share: of_fit(|fit| fit.folded_share),
            converged: fitted.as_ref().is_some_and(|fit| fit.holds).into(),
            reserved: 0,
        };
        structs::write(figures, summary, size)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_spline_folds(
    spline: *const ricci_spline,
    patches: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::with(spline, |ricci_spline { fitted, .. }| {
        let folds = fitted.as_ref().map_or(&[][..], |fit| &fit.folds);
        copy_out("patches", folds, patches, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_spline_values(
    spline: *const ricci_spline,
    which: u32,
    values: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(spline, |ricci_spline { spline, .. }| {
        let space = spline.space();
        match PARTS.choose(which)? {
            SplinePart::ControlPoints => {
                copy_out("control points", spline.control_points(), values, capacity)
            }
            SplinePart::Abscissas => copy_out("abscissas", &space.abscissas(), values, capacity),
            SplinePart::Holes => {
                let holes = spline.holes().iter().map(|hole| [hole.turns, hole.radius]);
                copy_out("holes", &holes.collect::<Vec<_>>(), values, capacity)
            }
            SplinePart::Knots => {
                let knots = space.patches().iter().flat_map(|patch| patch.knots.concat());
                copy_out("knots", &knots.collect::<Vec<_>>(), values, capacity)
            }
        }
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_spline_controls(
    spline: *const ricci_spline,
    controls: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::with(spline, |ricci_spline { spline, .. }| {
        let all = spline.space().patches().iter().flat_map(|patch| patch.control.iter().copied());
        copy_out("controls", &all.collect::<Vec<_>>(), controls, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_spline_tessellate(
    spline: *const ricci_spline,
    sides: usize,
    control: *const ricci_control,
    mesh: *mut *mut ricci_mesh,
) -> ricci_status {
    guard::make(mesh, || {
        let spline = &shared(spline)?.spline;
        let faces = spline.space().patches().len().saturating_mul(sides.saturating_mul(sides));
        let reserve = memory::work(spline_memory::tessellation(faces), 1)?;
        let threads = control::threads(control);
        let soup = spline.tessellate(sides, threads, &control::of(control)?)?;
        drop(reserve);
        ricci_mesh::from_soup(soup)
    })
}
