//! Maps between two surfaces.

use crate::arrays::{array, check_buffer, copy_out};
use crate::choice::choices;
use crate::control::{self, ricci_control};
use crate::failure::{Failure, Outcome};
use crate::guard::{self, handle, shared};
use crate::map::ricci_map;
use crate::memory;
use crate::mesh::ricci_mesh;
use crate::paths::halfedges_of;
use crate::status::*;
use crate::structs::{self, sized};
use ricci::Control;
use ricci::Surface;
use ricci::flow::Options;
use ricci::matching::{
    BoundaryMatching, FoundLandmarks, LoopShape, MapQuality, MatchOptions, Matching, Place, SoftLandmark,
    SurfaceMap, cycle_error, map_quality, match_surfaces, point_error,
};
use ricci::mesh::{FaceId, HalfedgeId, VertexId};

pub struct ricci_matching {
    pub(crate) matching: Matching,
    pub(crate) source: Surface,
    pub(crate) target: Surface,
    pub(crate) quality: Option<(MapQuality, [f64; 2])>,
    pub(crate) point_error: f64,
    /// The landmarks of the map inside both surfaces, and what was found by their shapes: neither is kept in archives.
    pub(crate) landmarks: Vec<[VertexId; 2]>,
    pub(crate) found: FoundLandmarks,
    pub(crate) threads: usize,
    /// True if it came from an archive that says that its source is a mirror image.
    pub(crate) mirrored: bool,
}
handle!(ricci_matching, "matching", |matching| matching.source.mesh().n_vertices()
    + matching.target.mesh().n_vertices());

choices!(BOUNDARIES: BoundaryMatching = "correspondence of boundaries", [
    RICCI_MATCH_SLIDES => BoundaryMatching::Slides,
    RICCI_MATCH_ARC_LENGTH => BoundaryMatching::ArcLength,
]);

choices!(LOOP_SHAPES: LoopShape = "shape of boundary loops", [
    RICCI_MATCH_GEODESICS => LoopShape::Geodesics,
    RICCI_MATCH_CIRCLES => LoopShape::Circles,
]);

choices!(enum MapDirection, DIRECTIONS = "direction of a matching", [
    RICCI_MATCH_FORWARD => Forward,
    RICCI_MATCH_BACKWARD => Backward,
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
    pub point_faces: *const u32,
    pub point_weights: *const f64,
    pub n_points: usize,
    pub curves: *const u32,
    pub curve_sizes: *const u32,
    pub n_curves: usize,
    pub soft: *const u32,
    pub soft_weights: *const f64,
    pub n_soft: usize,
    pub boundary: u32,
    pub loop_shape: u32,
    pub basis: *const i32,
    pub basis_sizes: *const u32,
    pub n_basis: usize,
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
    pub qc_mean: f64,
    pub qc_max: f64,
    pub area_ratio_min: f64,
    pub area_ratio_mean: f64,
    pub area_ratio_max: f64,
    pub area_log: f64,
    pub distance_mean: f64,
    pub distance_max: f64,
    pub landmark_error: f64,
    pub cycle_mean: f64,
    pub cycle_max: f64,
    pub n_points: usize,
    pub n_soft: usize,
    pub point_error: f64,
    pub n_circles: usize,
    pub roundness: f64,
}
// SAFETY: numbers; 8-byte alignment, size first.
sized!(ricci_matching_summary, "summary");

impl ricci_matching {
    /// A matching with its figures. Quality and errors are distances in space, which intrinsic surfaces do not have.
    pub fn new(
        both: [&Surface; 2],
        matching: Matching,
        landmarks: &[[VertexId; 2]],
        threads: usize,
    ) -> Outcome<ricci_matching> {
        let (mut quality, mut missed) = (None, 0.0);
        if both.iter().all(|s| s.positions().is_some()) {
            let cycle = cycle_error(both, [&matching.forward, &matching.backward])?;
            quality = Some((map_quality(both, &matching.forward, landmarks)?, cycle));
            missed = point_error(both[1], &matching)?;
        }
        let [source, target] = both.map(Surface::clone);
        Ok(ricci_matching {
            matching,
            source,
            target,
            quality,
            point_error: missed,
            landmarks: landmarks.to_vec(),
            found: FoundLandmarks::default(),
            threads,
            mirrored: false,
        })
    }

    /// The map of a direction, and the surface that it leads to.
    fn map(&self, direction: u32) -> Outcome<(&SurfaceMap, &Surface)> {
        Ok(match DIRECTIONS.choose(direction)? {
            MapDirection::Forward => (&self.matching.forward, &self.target),
            MapDirection::Backward => (&self.matching.backward, &self.source),
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
    let surfaces = [source, target];
    made(surfaces, options, control, matching, |both, options, control, threads| {
        let matching = match_surfaces(both[0], both[1], options, control)?;
        ricci_matching::new(both, matching, &options.landmarks, threads)
    })
}

/// What `make` makes of two surfaces with the caller's options and number of threads.
pub fn made(
    surfaces: [*const ricci_mesh; 2],
    options: *const ricci_match_options,
    control: *const ricci_control,
    matching: *mut *mut ricci_matching,
    make: impl FnOnce([&Surface; 2], &MatchOptions, &Control, usize) -> Outcome<ricci_matching>,
) -> ricci_status {
    guard::make(matching, || {
        let meshes = [shared(surfaces[0])?, shared(surfaces[1])?];
        let (given, control) = (structs::read(options)?, control::of(control)?);
        let _reserve = reserve(meshes)?;
        let options = to_library(meshes, &given)?;
        make([meshes[0].surface()?, meshes[1].surface()?], &options, &control, given.threads)
    })
}

/// Room for matching surfaces.
fn reserve(meshes: [&ricci_mesh; 2]) -> Outcome<memory::Reserve> {
    let [n, m] = meshes.map(|mesh| mesh.connectivity.n_vertices());
    memory::work(n.saturating_add(m), memory::LAYOUT)
}

/// The caller's options.
fn to_library(meshes: [&ricci_mesh; 2], given: &ricci_match_options) -> Outcome<MatchOptions> {
    let pairs: Vec<[u32; 2]> = array("landmarks", given.landmarks.cast(), given.n_landmarks)?;
    let loops: Vec<u32> = array("loops", given.loops, given.n_loops)?;
    Ok(MatchOptions {
        points: points(given)?,
        curves: curves(given)?,
        soft: soft(given)?,
        basis: basis(meshes, given)?,
        landmarks: pairs.into_iter().map(|pair| pair.map(VertexId)).collect(),
        loops: (!loops.is_empty()).then(|| loops.into_iter().map(|k| k as usize).collect()),
        boundary: BOUNDARIES.choose(given.boundary)?,
        loop_shape: LOOP_SHAPES.choose(given.loop_shape)?,
        flow: Options { threads: given.threads, ..Options::default() },
    })
}

/// The caller's pairs of points, each given by its face and barycentric weights.
fn points(given: &ricci_match_options) -> Outcome<Vec<[Place; 2]>> {
    let n = given.n_points;
    let faces: Vec<[u32; 2]> = array("point_faces", given.point_faces.cast(), n)?;
    let weights: Vec<[[f64; 3]; 2]> = array("point_weights", given.point_weights.cast(), n)?;
    let place = |face: u32, weights: [f64; 3]| Place { face: FaceId(face), weights };
    let pair = |([f, g], [p, q]): ([u32; 2], [[f64; 3]; 2])| [place(f, p), place(g, q)];
    Ok(faces.into_iter().zip(weights).map(pair).collect())
}

/// The caller's pairs of loops, whose edges come one after the other.
fn basis(meshes: [&ricci_mesh; 2], given: &ricci_match_options) -> Outcome<Vec<[Vec<HalfedgeId>; 2]>> {
    let sizes: Vec<[u32; 2]> = array("basis_sizes", given.basis_sizes.cast(), given.n_basis)?;
    let total = sizes.iter().flatten().fold(0usize, |sum, &n| sum.saturating_add(n as usize));
    let edges: Vec<i32> = array("basis", given.basis, total)?;
    let mut first = 0;
    let mut next = |s: usize, n: u32| -> Outcome<Vec<HalfedgeId>> {
        let own = &edges[first..first + n as usize];
        let path = halfedges_of(&meshes[s].connectivity, "basis", own, first)?;
        first += own.len();
        Ok(path)
    };
    sizes.into_iter().map(|[n, m]| Ok([next(0, n)?, next(1, m)?])).collect()
}

/// The caller's pairs of landmarks that attract with a weight.
fn soft(given: &ricci_match_options) -> Outcome<Vec<SoftLandmark>> {
    let pairs: Vec<[u32; 2]> = array("soft", given.soft.cast(), given.n_soft)?;
    let weights: Vec<f64> = array("soft_weights", given.soft_weights, given.n_soft)?;
    let soft = |(pair, weight): ([u32; 2], f64)| SoftLandmark { pair: pair.map(VertexId), weight };
    Ok(pairs.into_iter().zip(weights).map(soft).collect())
}

/// The caller's pairs of curves, whose vertices come one after the other.
fn curves(given: &ricci_match_options) -> Outcome<Vec<[Vec<VertexId>; 2]>> {
    let sizes: Vec<[u32; 2]> = array("curve_sizes", given.curve_sizes.cast(), given.n_curves)?;
    let total = sizes.iter().flatten().fold(0usize, |sum, &n| sum.saturating_add(n as usize));
    let all: Vec<u32> = array("curves", given.curves, total)?;
    let mut rest = all.into_iter().map(VertexId);
    Ok(sizes.into_iter().map(|pair| pair.map(|n| rest.by_ref().take(n as usize).collect())).collect())
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
    guard::with(matching, |ricci_matching { matching, quality, point_error, .. }| {
        let [first, second] = matching.balance;
        let of = |pick: fn(&(MapQuality, [f64; 2])) -> f64| quality.as_ref().map_or(0.0, pick);
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
            qc_mean: of(|(q, _)| q.qc_mean),
            qc_max: of(|(q, _)| q.qc_max),
            area_ratio_min: of(|(q, _)| q.area_ratio_min),
            area_ratio_mean: of(|(q, _)| q.area_ratio_mean),
            area_ratio_max: of(|(q, _)| q.area_ratio_max),
            area_log: of(|(q, _)| q.area_log),
            distance_mean: of(|(q, _)| q.distance_mean),
            distance_max: of(|(q, _)| q.distance_max),
            landmark_error: of(|(q, _)| q.landmark_error),
            cycle_mean: of(|(_, cycle)| cycle[0]),
            cycle_max: of(|(_, cycle)| cycle[1]),
            n_points: matching.points.len(),
            n_soft: matching.soft_left.len(),
            point_error: *point_error,
            n_circles: matching.holes.len(),
            roundness: matching.holes.iter().map(|hole| hole.deviation).fold(0.0, f64::max),
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

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_matching_points(
    matching: *const ricci_matching,
    faces: *mut u32,
    faces_capacity: usize,
    weights: *mut f64,
    weights_capacity: usize,
) -> ricci_status {
    guard::with(matching, |matching| {
        let points = &matching.matching.points;
        check_buffer("weights", 6 * points.len(), weights, weights_capacity)?;
        let all: Vec<[u32; 2]> = points.iter().map(|pair| pair.map(|place| place.face.0)).collect();
        copy_out("faces", &all, faces, faces_capacity)?;
        let all: Vec<[[f64; 3]; 2]> = points.iter().map(|pair| pair.map(|place| place.weights)).collect();
        copy_out("weights", &all, weights, weights_capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_matching_soft_left(
    matching: *const ricci_matching,
    left: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(matching, |matching| copy_out("left", &matching.matching.soft_left, left, capacity))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_matching_map(
    matching: *const ricci_matching,
    control: *const ricci_control,
    map: *mut *mut ricci_map,
) -> ricci_status {
    guard::make(map, || {
        let ricci_matching { matching, source, target, threads, .. } = shared(matching)?;
        let n = matching.forward.places.len().saturating_add(matching.backward.places.len());
        let _reserve = memory::work(n, memory::LAYOUT)?;
        let overlay = matching.domain.overlay(*threads, &control::of(control)?)?;
        Ok(ricci_map::of_surfaces([source, target], overlay))
    })
}
