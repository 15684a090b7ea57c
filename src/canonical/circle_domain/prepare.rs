//! Prepares a surface for its flow: gives loops enough edges, and fills them by hubs.

use super::options::CircleDomainOptions;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::flow::Solution;
use crate::flow::hubs::start_radius;
use crate::geometry::Space;
use crate::mesh::{EdgeId, FilledMesh, HalfedgeId, PerEdge};
use crate::metric::{Split, Surface};

/// A surface that is ready to flow.
#[derive(Clone)]
pub(super) struct PreparedSurface {
    pub split: Split,
    /// The surface of `split`.
    pub surface: Surface,
    pub filled: FilledMesh,
    /// The metric of mixed types that the flow starts from.
    pub start: Solution,
}

/// Give every loop enough edges, and a planar surface an interior vertex.
pub(super) fn refine(split: &mut Split, options: &CircleDomainOptions) -> Result<()> {
    let mesh = split.given().mesh().clone();
    for rim in mesh.boundary_loops() {
        split.refine_loop(&rim, options.least_loop)?;
    }
    let has_inside = mesh.vertices().any(|v| !mesh.is_boundary_vertex(v));
    if mesh.genus() > 0 || has_inside {
        return Ok(());
    }
    let lengths = split.given().lengths().clone();
    let inside = mesh.edges().filter(|&e| !mesh.is_boundary_edge(e));
    let longest = inside.max_by(|&a, &b| lengths[a].total_cmp(&lengths[b]));
    let need = "one with a vertex or an edge inside, to send to infinity on the way (cut each triangle into four, `ricci refine --levels 1`)";
    let edge = longest.ok_or(Error::argument("surface", "without edges inside", need))?;
    split.halve(edge)?;
    Ok(())
}

/// Halve every edge of these loops.
pub(super) fn halve_loops(split: &mut Split, loops: &[usize]) -> Result<()> {
    let surface = split.surface()?;
    let rims = surface.mesh().boundary_loops();
    for &k in loops {
        split.refine_loop(&rims[k], 2 * rims[k].len())?;
    }
    Ok(())
}

/// How many times edges of loops are parted opposite obtuse angles. Each time the angles at the new vertices are right ones, but new
/// triangles elsewhere may have obtuse ones again.
const PARTINGS: usize = 6;
/// Least share of an edge that is parted off.
const LEAST_PART: f64 = 1e-3;

impl PreparedSurface {
    /// The start of the flow, after parting the edges of loops that are opposite obtuse angles. Across such an edge the triangulation and its
    /// mirror image are not Delaunay together, so that the class would depend on more than the surface.
    pub fn new(
        mut split: Split,
        options: &CircleDomainOptions,
        control: &Control,
    ) -> Result<PreparedSurface> {
        for _ in 0..PARTINGS {
            let begin = PreparedSurface::as_it_is(split, options, control)?;
            let obtuse = begin.start.obtuse_rims(&begin.filled);
            if obtuse.is_empty() {
                return Ok(begin);
            }
            split = begin.split;
            for (edge, share) in obtuse {
                split.part(edge, share.clamp(LEAST_PART, 1.0 - LEAST_PART))?;
            }
        }
        PreparedSurface::as_it_is(split, options, control)
    }

    fn as_it_is(split: Split, options: &CircleDomainOptions, control: &Control) -> Result<PreparedSurface> {
        let surface = split.surface()?;
        let filled = FilledMesh::new(surface.mesh())?;
        let space = if surface.mesh().genus() < 2 { Space::E2 } else { Space::H2 };
        let closed = closed_surface(&surface, &filled)?;
        let start = Solution::with_hubs(closed, &filled, space, control)?.on_threads(options.flow.threads);
        Ok(PreparedSurface { split, surface, filled, start })
    }
}

/// The filled surface. The lengths of the edges at hubs only have to make triangles; nothing is measured with them.
fn closed_surface(surface: &Surface, filled: &FilledMesh) -> Result<Surface> {
    let mut lengths: Vec<f64> = surface.lengths().iter().copied().collect();
    let rims: Vec<f64> =
        (0..filled.loops.len()).map(|k| start_radius(surface.lengths(), &filled.loops[k])).collect();
    for e in (lengths.len()..filled.mesh.n_edges()).map(EdgeId::from) {
        // The half-edge 2e runs to the hub.
        let hub = filled.mesh.tip(HalfedgeId(2 * e.0));
        lengths.push(filled.loop_of(hub).map_or(0.0, |k| rims[k]));
    }
    Surface::intrinsic(filled.mesh.clone(), PerEdge::from(lengths), surface.geometry())
}
