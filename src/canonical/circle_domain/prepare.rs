//! From a surface to the start of its flow: loops with enough edges, filled by hubs.

use super::options::CircleDomainOptions;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::flow::Solution;
use crate::flow::hubs::start_radius;
use crate::geometry::Space;
use crate::mesh::{EdgeId, FilledMesh, HalfedgeId, PerEdge};
use crate::metric::{Split, Surface};

/// A surface that is ready to flow.
pub(super) struct Prepared {
    pub split: Split,
    /// The surface of `split`.
    pub surface: Surface,
    pub filled: FilledMesh,
    /// The metric of mixed types that the flow starts from.
    pub start: Solution,
}

/// Give every loop the edges that it needs, and a planar surface a vertex inside.
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
    let need =
        "one with a vertex or an edge inside, to send to infinity on the way (cut each triangle into four)";
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

/// How often edges of loops are parted opposite obtuse angles. Each time the angles of the parts are right ones; new triangles elsewhere
/// may want it again.
const PARTINGS: usize = 6;
/// Least share of an edge that is parted off.
const LEAST_PART: f64 = 1e-3;

impl Prepared {
    /// The start of the flow, with the edges of loops parted that are opposite obtuse angles: across them the triangulation is not that of
    /// a Delaunay triangulation whose mirror image continues it, so that the class would not be the surface's alone.
    pub fn new(mut split: Split, options: &CircleDomainOptions, control: &Control) -> Result<Prepared> {
        for _ in 0..PARTINGS {
            let begin = Prepared::as_it_is(split, options, control)?;
            let obtuse = begin.start.obtuse_rims(&begin.filled);
            if obtuse.is_empty() {
                return Ok(begin);
            }
            split = begin.split;
            for (edge, share) in obtuse {
                split.part(edge, share.clamp(LEAST_PART, 1.0 - LEAST_PART))?;
            }
        }
        Prepared::as_it_is(split, options, control)
    }

    fn as_it_is(split: Split, options: &CircleDomainOptions, control: &Control) -> Result<Prepared> {
        let surface = split.surface()?;
        let filled = FilledMesh::new(surface.mesh())?;
        let space = if surface.mesh().genus() < 2 { Space::E2 } else { Space::H2 };
        let closed = closed_surface(&surface, &filled)?;
        let start = Solution::with_hubs(closed, &filled, space, control)?.on_threads(options.flow.threads);
        Ok(Prepared { split, surface, filled, start })
    }
}

/// The filled surface. The edges at hubs have a length because a surface has lengths everywhere: nothing is measured with it.
fn closed_surface(surface: &Surface, filled: &FilledMesh) -> Result<Surface> {
    let mut lengths: Vec<f64> = surface.lengths().iter().copied().collect();
    let rims: Vec<f64> =
        (0..filled.loops.len()).map(|k| start_radius(surface.lengths(), filled, k)).collect();
    for e in (lengths.len()..filled.mesh.n_edges()).map(EdgeId::from) {
        // The half-edge 2e runs to the hub.
        let hub = filled.mesh.tip(HalfedgeId(2 * e.0));
        lengths.push(filled.loop_of(hub).map_or(0.0, |k| rims[k]));
    }
    Surface::intrinsic(filled.mesh.clone(), PerEdge::from(lengths), surface.geometry())
}
