//! Finer triangle lists of the same surface, and finer triangulations of the same metric.

use crate::arrays::{check_buffer, copy_out};
use crate::control::{self, ricci_control};
use crate::guard::{self, shared};
use crate::memory;
use crate::mesh::ricci_mesh;
use crate::soup::ricci_soup;
use crate::status::ricci_status;
use crate::structs::{self, or, sized};
use ricci::mesh::refine::{Refine, least_faces, refine};
use ricci::metric::angle_refinement::{AngleRefinement, FinerMetric, refine_to_angle};

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_refine_options {
    pub size: usize,
    pub levels: usize,
    pub longest_edge: f64,
    pub least_angle: f64,
    pub most_added: usize,
}
// SAFETY: numbers; 8-byte alignment, size first.
sized!(ricci_refine_options, "options");

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_refine_summary {
    pub size: usize,
    pub n_inside: usize,
    pub n_on_boundary: usize,
    pub n_flips: usize,
    pub n_below: usize,
    pub n_forced: usize,
    pub given_angle: f64,
    pub least_angle: f64,
}
// SAFETY: numbers; 8-byte alignment, size first.
sized!(ricci_refine_summary, "summary");

/// The face of a vertex that no face uses, where its place is asked for.
const NO_FACE: u32 = u32::MAX;

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_soup_refine(
    soup: *const ricci_soup,
    options: *const ricci_refine_options,
    refined: *mut *mut ricci_soup,
) -> ricci_status {
    guard::make(refined, || {
        let control = control::of_thread()?;
        let (given, soup) = (structs::read(options)?, &shared(soup)?.soup);
        let longest_edge = (given.longest_edge != 0.0).then_some(given.longest_edge);
        let options = Refine { levels: given.levels, longest_edge };
        let _reserve = memory::work(soup.positions.len().max(least_faces(soup, &options)?), memory::MESH)?;
        Ok(ricci_soup::refined(refine(soup, &options, &control)?))
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_soup_places(
    refined: *const ricci_soup,
    faces: *mut u32,
    faces_capacity: usize,
    vertex_faces: *mut u32,
    vertex_faces_capacity: usize,
    weights: *mut f64,
    weights_capacity: usize,
) -> ricci_status {
    guard::with(refined, |list| {
        let (face_origin, vertex_place) = list.places()?;
        let (found, at): (Vec<u32>, Vec<[f64; 3]>) = vertex_place
            .iter()
            .map(|place| place.map_or((NO_FACE, [0.0; 3]), |place| (place.face.0, place.weights)))
            .unzip();
        check_buffer("vertex_faces", found.len(), vertex_faces, vertex_faces_capacity)?;
        check_buffer("weights", 3 * at.len(), weights, weights_capacity)?;
        copy_out("faces", face_origin, faces, faces_capacity)?;
        copy_out("vertex_faces", &found, vertex_faces, vertex_faces_capacity)?;
        copy_out("weights", &at, weights, weights_capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_mesh_refine_angle(
    mesh: *const ricci_mesh,
    options: *const ricci_refine_options,
    control: *const ricci_control,
    summary: *mut ricci_refine_summary,
    size: usize,
    refined: *mut *mut ricci_mesh,
) -> ricci_status {
    guard::make(refined, || {
        let (given, control, mesh) = (structs::read(options)?, control::of(control)?, shared(mesh)?);
        let usual = AngleRefinement::default();
        let least_angle = or(given.least_angle, usual.least_angle);
        let options = AngleRefinement { least_angle, most_added: given.most_added };
        let _reserve = memory::work(mesh.connectivity.n_vertices(), memory::MESH)?;
        let FinerMetric { surface: finer, places, report } =
            refine_to_angle(mesh.surface()?, &options, &control)?;
        if !summary.is_null() {
            let figures = ricci_refine_summary {
                size,
                n_inside: report.inside,
                n_on_boundary: report.on_boundary,
                n_flips: report.flips,
                n_below: report.below,
                n_forced: report.forced,
                given_angle: report.given_angle,
                least_angle: report.least_angle,
            };
            structs::write(figures, summary, size)?;
        }
        let made = ricci_mesh::intrinsic(finer.mesh().clone(), finer.lengths().clone(), finer.geometry());
        Ok(made.placed(places))
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_mesh_places(
    refined: *const ricci_mesh,
    faces: *mut u32,
    faces_capacity: usize,
    weights: *mut f64,
    weights_capacity: usize,
) -> ricci_status {
    guard::with(refined, |mesh| {
        let (found, at): (Vec<u32>, Vec<[f64; 3]>) =
            mesh.places()?.iter().map(|place| (place.face.0, place.weights)).unzip();
        check_buffer("weights", 3 * at.len(), weights, weights_capacity)?;
        copy_out("faces", &found, faces, faces_capacity)?;
        copy_out("weights", &at, weights, weights_capacity)
    })
}
