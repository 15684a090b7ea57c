//! Layouts of four-sided patches on quad meshes.

use crate::arrays::{CallerBuffer, copy_each, copy_out, copy_rows};
use crate::control::{self, ricci_control};
use crate::failure::{Failure, Outcome};
use crate::guard::{self, handle, shared};
use crate::quads::{QuadsState, read_options, reserve, ricci_quads, ricci_quads_options};
use crate::seamless::ricci_seamless;
use crate::status::ricci_status;
use crate::structs::{self, sized};
use ricci::Control;
use ricci::mesh::Point;
use ricci::quads::{LayoutArc, LayoutNode, LayoutPatch, QuadLayout, QuadOptions, QuadSize, quad_layout};
use ricci::seamless::Seamless;
use std::sync::Arc;

/// The number of quads of a unit square of a layout.
const PARTS_OF_UNIT: usize = 64;

pub struct ricci_quad_layout {
    /// The fingerprint of the seamless metric that it divides, by which it is told from layouts of others.
    pub(crate) metric: u64,
    pub(crate) quads: Arc<QuadsState>,
    nodes: Vec<LayoutNode>,
    arcs: Vec<LayoutArc>,
    patches: Vec<LayoutPatch>,
    figures: ricci_quad_layout_summary,
}
handle!(ricci_quad_layout, "layout", |layout| layout.figures.n_vertices);

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_quad_layout_summary {
    pub size: usize,
    pub n_nodes: usize,
    pub n_arcs: usize,
    pub n_patches: usize,
    pub n_units: usize,
    pub n_parts: usize,
    pub n_quads: usize,
    pub n_vertices: usize,
}
// SAFETY: numbers; 8-byte alignment, size first.
sized!(ricci_quad_layout_summary, "summary");

impl ricci_quad_layout {
    /// The layout, if it is one of this seamless metric.
    pub(crate) fn of_seamless(&self, seamless: &ricci_seamless) -> Outcome<QuadLayout> {
        if self.metric != seamless.found.fingerprint() {
            return Err(Failure::argument("the layout is that of another seamless metric"));
        }
        Ok(self.layout())
    }

    pub(crate) fn layout(&self) -> QuadLayout {
        QuadLayout {
            mesh: self.quads.mesh().clone(),
            parts: self.figures.n_parts as u32,
            nodes: self.nodes.clone(),
            arcs: self.arcs.clone(),
            patches: self.patches.clone(),
        }
    }

    /// The handle of a layout whose vertices have these positions, of the metric with this fingerprint.
    pub(crate) fn of(layout: QuadLayout, positions: Option<Vec<Point>>, metric: u64) -> ricci_quad_layout {
        let QuadLayout { mesh, parts, nodes, arcs, patches } = layout;
        let figures = ricci_quad_layout_summary {
            size: 0,
            n_nodes: nodes.len(),
            n_arcs: arcs.len(),
            n_patches: patches.len(),
            n_units: patches.iter().map(|patch| patch.size[0] as usize * patch.size[1] as usize).sum(),
            n_parts: parts as usize,
            n_quads: mesh.quads.len(),
            n_vertices: mesh.places.len(),
        };
        let quads = Arc::new(QuadsState::new(mesh, positions));
        ricci_quad_layout { metric, quads, nodes, arcs, patches, figures }
    }
}

/// The coarsest layout of a seamless metric, on this number of threads.
pub(crate) fn coarsest(seamless: &Seamless, threads: usize, control: &Control) -> Outcome<QuadLayout> {
    let options = QuadOptions { size: QuadSize::Coarse, threads };
    let _reserve = reserve(seamless, options.size, PARTS_OF_UNIT)?;
    Ok(quad_layout(seamless, &options, control)?)
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quad_layout_new(
    seamless: *const ricci_seamless,
    options: *const ricci_quads_options,
    control: *const ricci_control,
    layout: *mut *mut ricci_quad_layout,
) -> ricci_status {
    guard::make(layout, || {
        let ricci_seamless { found, .. } = shared(seamless)?;
        let options = read_options(options, QuadSize::Coarse)?;
        let _reserve = reserve(found, options.size, PARTS_OF_UNIT)?;
        let made = quad_layout(found, &options, &control::of(control)?)?;
        log::info!("layout: {} patches of {} quads", made.patches.len(), made.mesh.quads.len());
        let positions = made.mesh.positions(&found.solution);
        Ok(ricci_quad_layout::of(made, positions, found.fingerprint()))
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quad_layout_free(layout: *mut ricci_quad_layout) {
    guard::free(layout);
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quad_layout_summarise(
    layout: *const ricci_quad_layout,
    summary: *mut ricci_quad_layout_summary,
    size: usize,
) -> ricci_status {
    guard::with(layout, |layout| {
        structs::write(ricci_quad_layout_summary { size, ..layout.figures }, summary, size)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quad_layout_quads(
    layout: *const ricci_quad_layout,
    quads: *mut *mut ricci_quads,
) -> ricci_status {
    guard::make(quads, || Ok(ricci_quads(shared(layout)?.quads.clone())))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quad_layout_nodes(
    layout: *const ricci_quad_layout,
    nodes: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::with(layout, |layout| {
        let row = |node: &LayoutNode| [node.vertex, node.valence, node.is_crease.into()];
        copy_each("nodes", layout.nodes.len(), layout.nodes.iter().map(row), nodes, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quad_layout_arcs(
    layout: *const ricci_quad_layout,
    arcs: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::with(layout, |layout| {
        let row = |arc: &LayoutArc| [arc.ends[0], arc.ends[1], arc.length, arc.is_crease.into()];
        copy_each("arcs", layout.arcs.len(), layout.arcs.iter().map(row), arcs, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quad_layout_arc_vertices(
    layout: *const ricci_quad_layout,
    vertices: *mut u32,
    capacity: usize,
    starts: *mut usize,
    starts_capacity: usize,
) -> ricci_status {
    guard::with(layout, |layout| {
        copy_rows(
            "vertices",
            layout.arcs.iter().map(|arc| arc.vertices.iter().copied()),
            CallerBuffer(vertices, capacity),
            CallerBuffer(starts, starts_capacity),
        )
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quad_layout_sides(
    layout: *const ricci_quad_layout,
    sides: *mut i32,
    capacity: usize,
    starts: *mut usize,
    starts_capacity: usize,
) -> ricci_status {
    guard::with(layout, |layout| {
        copy_rows(
            "sides",
            layout.patches.iter().flat_map(|patch| &patch.sides).map(|side| side.iter().copied()),
            CallerBuffer(sides, capacity),
            CallerBuffer(starts, starts_capacity),
        )
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quad_layout_sizes(
    layout: *const ricci_quad_layout,
    sizes: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::with(layout, |layout| {
        let sizes_of = layout.patches.iter().map(|patch| patch.size);
        copy_each("sizes", layout.patches.len(), sizes_of, sizes, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_quad_layout_patches(
    layout: *const ricci_quad_layout,
    patches: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::with(layout, |layout| {
        let mut patch_of = vec![0u32; layout.figures.n_quads];
        for (k, patch) in (0..).zip(&layout.patches) {
            patch.quads.iter().for_each(|&q| patch_of[q as usize] = k);
        }
        copy_out("patches", &patch_of, patches, capacity)
    })
}
