//! Maps between two surfaces.

use crate::arrays::{array, copy_out};
use crate::choice::choices;
use crate::control::{self, ricci_control};
use crate::failure::{Failure, Outcome};
use crate::guard::{self, handle, shared};
use crate::memory;
use crate::mesh::ricci_mesh;
use crate::status::*;
use crate::structs::{self, sized};
use ricci::Surface;
use ricci::flow::Options;
use ricci::matching::{Boundary, MatchOptions, Matching, SurfaceMap, match_surfaces};
use ricci::mesh::VertexId;

pub struct ricci_matching {
    matching: Matching,
    source: Surface,
    target: Surface,
}
handle!(ricci_matching, "matching");

#[derive(Clone, Copy, PartialEq)]
enum Direction {
    Forward,
    Backward,
}

choices!(BOUNDARIES: Boundary = "correspondence of boundaries", [
    RICCI_MATCH_SLIDES => Boundary::Slides,
    RICCI_MATCH_ARC_LENGTH => Boundary::ArcLength,
]);

choices!(DIRECTIONS: Direction = "direction of a matching", [
    RICCI_MATCH_FORWARD => Direction::Forward,
    RICCI_MATCH_BACKWARD => Direction::Backward,
]);

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_match_options {
    pub size: usize,
    pub landmarks: *const u32,
    pub n_landmarks: usize,
    pub loops: *const u32,
    pub n_loops: usize,
    pub threads: usize,
    pub boundary: u32,
    pub reserved: u32,
}
// SAFETY: numbers and raw pointers; 8-byte alignment, size first.
sized!(ricci_match_options, "options");

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_matching_summary {
    pub size: usize,
    pub n_source_vertices: usize,
    pub n_target_vertices: usize,
    pub n_flipped: usize,
    pub n_markings: usize,
    pub outside: f64,
    pub energy: f64,
    pub target_energy: f64,
    pub residual: f64,
}
// SAFETY: numbers; 8-byte alignment, size first.
sized!(ricci_matching_summary, "summary");

impl ricci_matching {
    /// A map, and the surface that it leads to.
    fn map(&self, direction: u32) -> Outcome<(&SurfaceMap, &Surface)> {
        Ok(match DIRECTIONS.choose(direction)? {
            Direction::Forward => (&self.matching.forward, &self.target),
            Direction::Backward => (&self.matching.backward, &self.source),
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_match(
    source: *const ricci_mesh,
    target: *const ricci_mesh,
    options: *const ricci_match_options,
    control: *const ricci_control,
    matching: *mut *mut ricci_matching,
) -> ricci_status {
    guard::make(matching, || {
        let (source, target) = (shared(source)?, shared(target)?);
        let (given, control) = (structs::read(options)?, control::of(control));
        let n = source.connectivity.n_vertices().saturating_add(target.connectivity.n_vertices());
        let _reserve = memory::work(n, memory::LAYOUT)?;
        let pairs: Vec<[u32; 2]> = array("landmarks", given.landmarks.cast(), given.n_landmarks)?;
        let loops: Vec<u32> = array("loops", given.loops, given.n_loops)?;
        let options = MatchOptions {
            landmarks: pairs.into_iter().map(|pair| pair.map(VertexId)).collect(),
            loops: (!loops.is_empty()).then(|| loops.into_iter().map(|k| k as usize).collect()),
            boundary: BOUNDARIES.choose(given.boundary)?,
            flow: Options { threads: given.threads, ..Options::default() },
        };
        let (source, target) = (source.surface()?, target.surface()?);
        let matching = match_surfaces(source, target, &options, &control)?;
        Ok(ricci_matching { matching, source: source.clone(), target: target.clone() })
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_matching_free(matching: *mut ricci_matching) {
    guard::free(matching);
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_matching_summarise(
    matching: *const ricci_matching,
    summary: *mut ricci_matching_summary,
    size: usize,
) -> ricci_status {
    guard::with(matching, |ricci_matching { matching, .. }| {
        let [first, second] = matching.balance;
        let figures = ricci_matching_summary {
            size: 0,
            n_source_vertices: matching.forward.places.len(),
            n_target_vertices: matching.backward.places.len(),
            n_flipped: matching.flipped.len() + matching.target_flipped.len(),
            n_markings: matching.markings,
            outside: matching.outside,
            energy: first.energy,
            target_energy: second.energy,
            residual: first.residual.max(second.residual),
        };
        structs::write(figures, summary, size)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_matching_faces(
    matching: *const ricci_matching,
    direction: u32,
    faces: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::with(matching, |matching| {
        let all: Vec<u32> = matching.map(direction)?.0.places.iter().map(|place| place.face.0).collect();
        copy_out("faces", &all, faces, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_matching_weights(
    matching: *const ricci_matching,
    direction: u32,
    weights: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(matching, |matching| {
        let all: Vec<[f64; 3]> =
            matching.map(direction)?.0.places.iter().map(|place| place.weights).collect();
        copy_out("weights", &all, weights, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_matching_carry(
    matching: *const ricci_matching,
    direction: u32,
    values: *const f64,
    n_values: usize,
    carried: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(matching, |matching| {
        let (map, to) = matching.map(direction)?;
        let n = to.mesh().n_vertices();
        if n_values == 0 || !n_values.is_multiple_of(n) {
            let message =
                format!("values has {n_values} entries: as many for each of {n} vertices are needed");
            return Err(Failure::new(RICCI_WRONG_SIZE, message).needs(n));
        }
        let columns = n_values / n;
        let values = array("values", values, n_values)?;
        let mut all = vec![0.0; columns * map.places.len()];
        for k in 0..columns {
            let column: Vec<[f64; 1]> = (0..n).map(|v| [values[columns * v + k]]).collect();
            let images = map.carry(to.mesh(), &column)?;
            images.into_iter().enumerate().for_each(|(v, [x])| all[columns * v + k] = x);
        }
        copy_out("carried", &all, carried, capacity)
    })
}
