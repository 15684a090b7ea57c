//! Targets: the curvature that is prescribed at every vertex, by a rule or by values.

use crate::arrays::{self, copy_out};
use crate::choice::choices;
use crate::control::{self, ricci_control};
use crate::failure::{Failure, FailureElement, Outcome, no_such};
use crate::guard::{self, shared};
use crate::memory;
use crate::metric::ricci_metric;
use crate::status::*;
use crate::structs::{self, sized};
use ricci::flow::prescribed_curvature;
use ricci::geometry::Space;
use ricci::mesh::VertexId;
use ricci::{Class, Surface, Target};

choices!(enum TargetKind, KINDS = "kind", [
    RICCI_TARGET_DEFAULT => Default,
    RICCI_TARGET_UNIFORM => Uniform,
    RICCI_TARGET_BOUNDARY => Boundary,
    RICCI_TARGET_SINGLE => Single,
    RICCI_TARGET_CONES => Cones,
    RICCI_TARGET_AUTO => Auto,
    RICCI_TARGET_GIVEN => Given,
    RICCI_TARGET_OUTER => Outer,
]);

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_target {
    pub size: usize,
    pub kind: u32,
    pub reserved: u32,
    pub n: usize,
    pub vertices: *const u32,
    pub curvatures: *const f64,
}
// SAFETY: numbers and raw pointers; 8-byte alignment, size first.
sized!(ricci_target, "target", reserved);

/// The vertices of a caller's array, which must be vertices of the surface.
pub(crate) fn vertices(surface: &Surface, data: *const u32, n: usize) -> Outcome<Vec<VertexId>> {
    let count = surface.mesh().n_vertices();
    let vertices = arrays::array("vertices", data, n)?;
    match vertices.iter().find(|&&v| v as usize >= count) {
        Some(&v) => Err(no_such(FailureElement::Vertex, "vertex", v as usize, count)),
        None => Ok(vertices.into_iter().map(VertexId).collect()),
    }
}

/// The boundary loop through a vertex.
fn loop_at(surface: &Surface, v: VertexId) -> Outcome<usize> {
    let mesh = surface.mesh();
    let at = mesh.boundary_loops().iter().position(|rim| rim.iter().any(|&h| mesh.origin(h) == v));
    at.ok_or_else(|| Failure::argument(format!("vertex {v} of the outer loop is not on the boundary")))
}

/// The library's target of a caller's; NULL is the default.
pub(crate) fn target_of(target: *const ricci_target, surface: &Surface, space: Space) -> Outcome<Target> {
    let given = structs::read(target)?;
    let (n, count) = (given.n, surface.mesh().n_vertices());
    Ok(match KINDS.choose(given.kind)? {
        TargetKind::Default => Target::default_for(surface, space)?,
        TargetKind::Uniform => Target::Uniform,
        TargetKind::Boundary => Target::Boundary,
        TargetKind::Single => match vertices(surface, given.vertices, n)?[..] {
            [v] => Target::Single(v),
            _ => {
                let message = format!("a single cone has n = 1 vertex, not {n}");
                return Err(Failure::new(RICCI_WRONG_SIZE, message).needs(1));
            }
        },
        TargetKind::Cones => {
            let vertices = vertices(surface, given.vertices, n)?;
            let curvatures = arrays::array("curvatures", given.curvatures, n)?;
            Target::Cones(vertices.into_iter().zip(curvatures).collect())
        }
        TargetKind::Outer => match vertices(surface, given.vertices, n)?[..] {
            [] => Target::Outer(None),
            [v] => Target::Outer(Some(loop_at(surface, v)?)),
            _ => {
                let message = format!("an outer loop is named by n = 1 vertex or n = 0, not {n}");
                return Err(Failure::new(RICCI_WRONG_SIZE, message).needs(1));
            }
        },
        TargetKind::Auto => Target::Auto(n),
        TargetKind::Given => Target::All(arrays::array_of("curvatures", given.curvatures, n, count)?.into()),
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_target_fill(
    metric: *const ricci_metric,
    target: *const ricci_target,
    control: *const ricci_control,
    curvatures: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::call(|| {
        let solution = &shared(metric)?.0.solution;
        let (surface, space) = (solution.surface(), solution.metric().space);
        arrays::check_buffer("curvatures", surface.mesh().n_vertices(), curvatures, capacity)?;
        let _reserve = memory::work(surface.mesh().n_vertices(), memory::FLOW)?;
        let target = target_of(target, surface, space)?;
        let class = Class::new(solution.scheme()?, space);
        let values = prescribed_curvature(&target, surface, class, &control::of(control)?)?;
        copy_out("curvatures", &values, curvatures, capacity)
    })
}
