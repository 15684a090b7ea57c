//! Seamless metrics: cones and loops that turn by multiples of 90°.

use crate::arrays::{self, copy_out};
use crate::choice::choices;
use crate::control::{self, ricci_control};
use crate::failure::{Failure, Outcome};
use crate::guard::{self, handle, shared};
use crate::layout::ricci_layout;
use crate::memory;
use crate::mesh::ricci_mesh;
use crate::metric::{MetricState, ricci_metric};
use crate::status::ricci_status;
use crate::structs::{self, or, sized};
use ricci::Surface;
use ricci::geometry::Model;
use ricci::mesh::{EdgeId, VertexId};
use ricci::seamless::{
    ConeValence, CrossField, FieldGuide, Seamless, SeamlessCones, SeamlessOptions, curvature_guides,
    seamless, sharp_edges, stroke_guides,
};
use std::sync::Arc;

pub struct ricci_seamless {
    pub(crate) state: Arc<MetricState>,
    pub(crate) found: Seamless,
}
handle!(ricci_seamless, "seamless", |seamless| seamless.state.solution.mesh().n_vertices());

// The way in which cones are chosen.
choices!(enum ConesRule, CONES = "cones", [
    RICCI_SEAMLESS_FIELD => Field,
    RICCI_SEAMLESS_AUTO => Auto,
    RICCI_SEAMLESS_VALENCES => Given,
]);

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_seamless_options {
    pub size: usize,
    pub cones: u32,
    pub reserved: u32,
    pub n_cones: usize,
    pub vertices: *const u32,
    pub valences: *const u32,
    pub quarter_turns: *const i32,
    pub n_quarter_turns: usize,
    pub tolerance: f64,
    pub max_iterations: usize,
    pub threads: usize,
    pub features: *const u32,
    pub n_features: usize,
    pub feature_angle: f64,
    pub curvature: f64,
    pub stroke_vertices: *const u32,
    pub strokes: *const f64,
    pub n_strokes: usize,
    pub isometric_steps: usize,
    pub sizes: *const f64,
    pub n_sizes: usize,
}
// SAFETY: numbers and raw pointers; 8-byte alignment, size first.
sized!(ricci_seamless_options, "options", reserved);

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_seamless_summary {
    pub size: usize,
    pub converged: u32,
    pub reserved: u32,
    pub n_cones: usize,
    pub n_loops: usize,
    pub flow_iterations: usize,
    pub iterations: usize,
    pub n_flips: usize,
    pub error: f64,
    pub tolerance: f64,
    pub n_features: usize,
    pub conformal_change: f64,
    pub length_change: f64,
    pub n_left_out: usize,
}
// SAFETY: numbers; 8-byte alignment, size first.
sized!(ricci_seamless_summary, "summary", reserved);

/// The features that are named by their ends, and the sharp edges.
fn read_features(given: &ricci_seamless_options, surface: &Surface) -> Outcome<Vec<EdgeId>> {
    let mesh = surface.mesh();
    let mut features = Vec::new();
    for ends in arrays::array::<[u32; 2]>("features", given.features.cast(), given.n_features)? {
        let [a, b] = ends.map(VertexId);
        let before = features.len();
        if a.index() < mesh.n_vertices() {
            features.extend(mesh.outgoing(a).filter(|&h| mesh.tip(h) == b).map(|h| h.edge()));
        }
        if features.len() == before {
            return Err(Failure::argument(format!(
                "features: there is no edge between the vertices {a} and {b}"
            )));
        }
    }
    if given.feature_angle != 0.0 {
        features.extend(sharp_edges(surface, given.feature_angle)?);
    }
    Ok(features)
}

fn read_guides(given: &ricci_seamless_options, surface: &Surface) -> Outcome<Vec<FieldGuide>> {
    let mut guides = Vec::new();
    if given.curvature != 0.0 {
        guides.extend(curvature_guides(surface, given.curvature)?);
    }
    let vertices = arrays::array("stroke_vertices", given.stroke_vertices, given.n_strokes)?;
    let directions = arrays::array::<[f64; 3]>("strokes", given.strokes.cast(), given.n_strokes)?;
    let strokes: Vec<_> = vertices.into_iter().map(VertexId).zip(directions).collect();
    guides.extend(stroke_guides(surface, &strokes)?);
    Ok(guides)
}

fn read_options(options: *const ricci_seamless_options, surface: &Surface) -> Outcome<SeamlessOptions> {
    let given = structs::read(options)?;
    let cones = match CONES.choose(given.cones)? {
        ConesRule::Field => SeamlessCones::Field,
        ConesRule::Auto => SeamlessCones::Auto(given.n_cones),
        ConesRule::Given => {
            let vertices = arrays::array("vertices", given.vertices, given.n_cones)?;
            let valences = arrays::array("valences", given.valences, given.n_cones)?;
            let cone = |(v, valence)| ConeValence { vertex: VertexId(v), valence };
            SeamlessCones::Valences(vertices.into_iter().zip(valences).map(cone).collect())
        }
    };
    let default = SeamlessOptions::default();
    let turns = arrays::array("quarter_turns", given.quarter_turns, given.n_quarter_turns)?;
    Ok(SeamlessOptions {
        cones,
        quarter_turns: (!given.quarter_turns.is_null()).then_some(turns),
        tolerance: or(given.tolerance, default.tolerance),
        max_iterations: if given.max_iterations == 0 { default.max_iterations } else { given.max_iterations },
        threads: given.threads,
        features: read_features(&given, surface)?,
        guides: if given.n_strokes > 0 || given.curvature != 0.0 {
            read_guides(&given, surface)?
        } else {
            Vec::new()
        },
        isometric_steps: given.isometric_steps,
        sizes: arrays::optional::<f64>("sizes", given.sizes, given.n_sizes)?.map(Into::into),
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_seamless_new(
    mesh: *const ricci_mesh,
    options: *const ricci_seamless_options,
    control: *const ricci_control,
    result: *mut *mut ricci_seamless,
) -> ricci_status {
    guard::make(result, || {
        let mesh = shared(mesh)?;
        let options = read_options(options, mesh.surface()?)?;
        let _reserve = memory::work(mesh.connectivity.n_vertices(), memory::FLOW)?;
        let found = seamless(mesh.surface()?, &options, &control::of(control)?)?;
        log::info!(
            "seamless: {} cones, {} + {} iterations, angles off by {:.1e}",
            found.cones.len(),
            found.iterations[0],
            found.iterations[1],
            found.error
        );
        let state = ricci_metric::at(found.solution.clone(), None)?.0;
        Ok(ricci_seamless { state, found })
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_seamless_free(result: *mut ricci_seamless) {
    guard::free(result);
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_seamless_summarise(
    result: *const ricci_seamless,
    summary: *mut ricci_seamless_summary,
    size: usize,
) -> ricci_status {
    guard::with(result, |ricci_seamless { found, .. }| {
        let figures = ricci_seamless_summary {
            size,
            converged: found.converged().into(),
            reserved: 0,
            n_cones: found.cones.len(),
            n_loops: found.quarter_turns.len(),
            flow_iterations: found.iterations[0],
            iterations: found.iterations[1],
            n_flips: found.solution.flips(),
            error: found.error,
            tolerance: found.tolerance,
            n_features: found.features.len(),
            conformal_change: found.length_changes[0],
            length_change: found.length_changes[1],
            n_left_out: found.left_out.len(),
        };
        structs::write(figures, summary, size)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_seamless_cones(
    result: *const ricci_seamless,
    cones: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::with(result, |ricci_seamless { found, .. }| {
        let rows: Vec<[u32; 2]> = found.cones.iter().map(|cone| [cone.vertex.0, cone.valence]).collect();
        copy_out("cones", &rows, cones, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_seamless_turning(
    result: *const ricci_seamless,
    quarter_turns: *mut i32,
    capacity: usize,
) -> ricci_status {
    guard::with(result, |ricci_seamless { found, .. }| {
        copy_out("quarter_turns", &found.quarter_turns, quarter_turns, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_seamless_features(
    result: *const ricci_seamless,
    vertices: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::with(result, |ricci_seamless { found, .. }| {
        let given = found.solution.given();
        let ends: Vec<[u32; 2]> = found.features.iter().map(|&e| given.ends(e).map(|v| v.0)).collect();
        copy_out("vertices", &ends, vertices, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_seamless_field(
    mesh: *const ricci_mesh,
    options: *const ricci_seamless_options,
    control: *const ricci_control,
    directions: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(mesh, |mesh| {
        let surface = mesh.surface()?;
        let options = read_options(options, surface)?;
        arrays::check_buffer("directions", 3 * surface.mesh().n_faces(), directions, capacity)?;
        let _reserve = memory::work(mesh.connectivity.n_vertices(), memory::FLOW)?;
        let field = CrossField::new(surface, &options.features, &options.guides, &control::of(control)?)?;
        let none = || Failure::argument("a field of directions in space needs a mesh with positions");
        copy_out("directions", &field.in_space(surface).ok_or_else(none)?, directions, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_seamless_metric(
    result: *const ricci_seamless,
    metric: *mut *mut ricci_metric,
) -> ricci_status {
    guard::make(metric, || Ok(ricci_metric(shared(result)?.state.clone())))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_seamless_map(
    result: *const ricci_seamless,
    control: *const ricci_control,
    layout: *mut *mut ricci_layout,
) -> ricci_status {
    guard::make(layout, || {
        let ricci_seamless { state, found } = shared(result)?;
        let _reserve = memory::work(found.solution.given().n_vertices(), memory::LAYOUT)?;
        let map = found.map(&control::of(control)?)?;
        ricci_layout::new(state.clone(), map.layout, Model::Poincare)
    })
}
