//! Places on splines over quad layouts: the surface there, those nearest to points, triangle meshes, the patches of faces.

use crate::arrays::{array, check_buffer, copy_out};
use crate::choice::choices;
use crate::control::{self, ricci_control};
use crate::failure::{Failure, Outcome};
use crate::guard::{self, shared};
use crate::memory;
use crate::mesh::ricci_mesh;
use crate::quad_spline::ricci_quad_spline;
use crate::spline_memory;
use crate::spline_places::ricci_spline_places;
use crate::status::*;
use crate::structs;
use ricci::Control;
use ricci::geometry::vector::Vector;
use ricci::spline::{NearestPlace, NearestPlaces, PatchPlace, SurfacePoint, TessellationSize};

choices!(enum QuadSplineQuantity, QUANTITIES = "which", [
    RICCI_QUAD_SPLINE_POINT => Point,
    RICCI_QUAD_SPLINE_FIRST => First,
    RICCI_QUAD_SPLINE_SECOND => Second,
    RICCI_QUAD_SPLINE_THIRD => Third,
    RICCI_QUAD_SPLINE_SHAPE => Shape,
]);

/// The largest distance of triangles from a surface, over its diagonal, where the caller gives none.
const USUAL_CHORD: f64 = 1e-3;

impl QuadSplineQuantity {
    /// The count of numbers per point.
    fn size(self) -> usize {
        match self {
            QuadSplineQuantity::Point => 3,
            QuadSplineQuantity::First => 9,
            QuadSplineQuantity::Second => 18,
            QuadSplineQuantity::Third => 30,
            QuadSplineQuantity::Shape => 5,
        }
    }

    /// Appends the numbers of this quantity, but for third derivatives.
    fn add(self, at: &SurfacePoint, row: &mut Vec<f64>) {
        if self == QuadSplineQuantity::Shape {
            row.extend(at.normal().unwrap_or([f64::NAN; 3]));
            row.extend(at.principal_curvatures().unwrap_or([f64::NAN; 2]));
            return;
        }
        let derivatives = at.first.iter().chain(&at.second).flatten();
        row.extend(at.point.iter().chain(derivatives).take(self.size()));
    }
}

impl ricci_quad_spline {
    /// The search structure for nearest places, made where there is none yet.
    fn nearest(&self, threads: usize, control: &Control) -> Outcome<&NearestPlaces> {
        if let Some(made) = self.nearest.get() {
            return Ok(made);
        }
        let _reserve = memory::work(self.fit.spline.control_points().len(), spline_memory::QUAD_CELLS)?;
        let made = self.fit.spline.nearest_places(threads, control)?;
        Ok(self.nearest.get_or_init(|| made))
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quad_spline_evaluate(
    spline: *const ricci_quad_spline,
    places: *const ricci_spline_places,
    which: u32,
    control: *const ricci_control,
    values: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(spline, |ricci_quad_spline { fit, .. }| {
        let (places, which) = (structs::read(places)?, QUANTITIES.choose(which)?);
        check_buffer("values", places.n.saturating_mul(which.size()), values, capacity)?;
        let _reserve = memory::work(places.n, spline_memory::POINT)?;
        let patches = array("patches", places.patches, places.n)?;
        let parameters: Vec<[f64; 2]> = array("parameters", places.parameters.cast(), places.n)?;
        let place = |(patch, parameters): (u32, [f64; 2])| PatchPlace { patch: patch as usize, parameters };
        let at: Vec<PatchPlace> = patches.into_iter().zip(parameters).map(place).collect();
        let found = fit.spline.evaluate_places(&at, places.threads, &control::of(control)?)?;
        let mut all = Vec::with_capacity(found.len() * which.size());
        for (point, &place) in found.iter().zip(&at) {
            which.add(point, &mut all);
            if which == QuadSplineQuantity::Third {
                all.extend(fit.spline.third_derivatives(place)?.as_flattened());
            }
        }
        copy_out("values", &all, values, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quad_spline_closest(
    spline: *const ricci_quad_spline,
    points: *const f64,
    n: usize,
    control: *const ricci_control,
    patches: *mut u32,
    values: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(spline, |spline| {
        check_buffer("values", n.saturating_mul(6), values, capacity)?;
        check_buffer("patches", n, patches, n)?;
        let _reserve = memory::work(n, spline_memory::POINT)?;
        let points: Vec<Vector> = array("points", points.cast(), n)?;
        let (threads, control) = (control::threads(control), control::of(control)?);
        let nearest = spline.nearest(threads, &control.part(0.0, 0.3))?;
        let found = nearest.find(&points, threads, &control.part(0.3, 1.0))?;
        let row = |at: &NearestPlace| {
            let ([u, v], [x, y, z]) = (at.place.parameters, at.point);
            [u, v, x, y, z, at.distance]
        };
        let numbers: Vec<u32> = found.iter().map(|at| at.place.patch as u32).collect();
        copy_out("patches", &numbers, patches, n)?;
        copy_out("values", &found.iter().map(row).collect::<Vec<_>>(), values, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quad_spline_tessellate(
    spline: *const ricci_quad_spline,
    parts: usize,
    tolerance: f64,
    control: *const ricci_control,
    mesh: *mut *mut ricci_mesh,
) -> ricci_status {
    guard::make(mesh, || {
        let ricci_quad_spline { fit, diagonal, .. } = shared(spline)?;
        let size = match (parts, tolerance) {
            (0, 0.0) => TessellationSize::Chord(USUAL_CHORD * diagonal),
            (0, tolerance) => TessellationSize::Chord(tolerance),
            (parts, 0.0) => TessellationSize::Parts(parts),
            _ => return Err(Failure::argument("parts and tolerance: one of both is 0")),
        };
        let (threads, control) = (control::threads(control), control::of(control)?);
        let faces = fit.spline.tessellation_faces(size)?;
        let reserve = memory::work(faces, spline_memory::POINT)?;
        let soup = fit.spline.tessellate(size, threads, &control.part(0.0, 0.6))?;
        drop(reserve);
        ricci_mesh::from_soup(soup)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quad_spline_patch_of_faces(
    spline: *const ricci_quad_spline,
    mesh: *const ricci_mesh,
    control: *const ricci_control,
    patches: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::with(spline, |spline| {
        let mesh = shared(mesh)?;
        let faces = mesh.connectivity.triangles();
        check_buffer("patches", faces.len(), patches, capacity)?;
        let _reserve = memory::work(faces.len(), spline_memory::POINT)?;
        let (threads, control) = (control::threads(control), control::of(control)?);
        let nearest = spline.nearest(threads, &control.part(0.0, 0.3))?;
        let found = nearest.patches_of_faces(mesh.positions()?, &faces, threads, &control.part(0.3, 1.0))?;
        copy_out("patches", &found, patches, capacity)
    })
}
