//! The circle domain as data, with its report.

use super::options::DomainFrame;
use super::place::hub_pairs;
use crate::archive::stored;
use crate::embed::Layout;
use crate::flow::{FlowSeconds, Solution, StopReason};
use crate::mesh::{FilledMesh, VertexId};
use crate::metric::Split;

/// A boundary loop as a circle.
#[derive(Debug, Clone, PartialEq)]
pub struct DomainCircle {
    /// The loop, by its place in [`crate::mesh::Mesh::boundary_loops`] of the surface.
    pub boundary_loop: usize,
    /// Centre in the coordinates of the layout: of the plane, of the Poincaré disk (one lift).
    pub centre: [f64; 2],
    /// Radius in the metric of the space: in E² in the units of the layout, in H² hyperbolic. In a strip that of the circle in the unit disk; 0
    /// where that is below the range of f64.
    pub radius: f64,
    /// log of the radius, which is known where the radius itself is below the range of f64.
    pub log_radius: f64,
    /// Largest difference between the radius and the distance of a vertex of the loop from the centre, as a share of the radius.
    pub deviation: f64,
    /// Vertices on the circle: those of the loop, and those that were added to it.
    pub vertices: usize,
}
stored!(sections DomainCircle { boundary_loop, centre, radius, log_radius, deviation, vertices });

/// The report of [`super::circle_domain()`].
#[derive(Debug, Clone, PartialEq)]
pub struct CircleReport {
    /// True if the domain as it is returned has K = 0 to the tolerance, loops that are round to [`super::ROUND`], no two circles that overlap,
    /// and no flipped triangle.
    pub converged: bool,
    /// Why the flow stopped. If it converged, but the domain as it is returned is not that exact, [`StopReason::RoundingFloor`]; if triangles
    /// of it are flipped or circles overlap, [`StopReason::BrokenTriangles`].
    pub stop_reason: StopReason,
    /// Newton steps of the whole call.
    pub iterations: usize,
    /// Flips on the way to the result, isometric ones before the flow included.
    pub flips: usize,
    /// Largest |K| over hubs and vertices of the flow's last metric, radians; in the plane of a punctured surface without the puncture and
    /// its link.
    pub max_curvature_error: f64,
    /// Largest |K| of [`CircleDomain::metric`], measured from its variables, at all vertices but those of the outer loop, radians.
    pub domain_curvature_error: f64,
    /// Where that is largest: a vertex of the metric's triangulation, a hub if its number is beyond the surface's vertices.
    pub worst_vertex: Option<VertexId>,
    /// The largest deviation of a loop from its circle, and the loop.
    pub deviation: f64,
    /// The loop with that deviation.
    pub worst_loop: Option<usize>,
    /// The loop whose circle was put about 0 because f64s do not hold it elsewhere.
    pub centred_on: Option<usize>,
    /// Vertices that were added to loops before the flow, by halving edges.
    pub halved_edges: usize,
    /// Vertices that were added to loops where flips crossed their edges.
    pub crossed_edges: usize,
    /// Least `η − 1` over the edges between two hubs, negative where two circles overlap; infinite where no hubs are neighbours.
    pub least_gap: f64,
    /// The vertex that was sent to infinity on the way, of a surface of genus 0.
    pub puncture: Option<VertexId>,
    /// Seconds of the flows; the rest of the call is neither in the phases nor in `total`.
    pub seconds: FlowSeconds,
}
stored!(sections CircleReport { converged, stop_reason, iterations, flips, max_curvature_error,
    domain_curvature_error, worst_vertex, deviation, worst_loop, centred_on, halved_edges, crossed_edges,
    least_gap, puncture } without { seconds });

/// A surface whose boundary loops are circles.
#[derive(Debug, Clone)]
pub struct CircleDomain {
    /// The given surface, with the vertices that were added to its loops before the flow.
    pub split: Split,
    /// That surface with a hub in each loop.
    pub filled: FilledMesh,
    /// The metric on the filled surface, flat or hyperbolic, and the way back. For a planar domain it is the metric of the unit disk: the
    /// outer hub is outside its circle then, so that the faces at it are not triangles of the plane, and K at its loop has no meaning.
    pub metric: Solution,
    /// The shape of the layout of a surface of genus 0: [`DomainFrame::Disk`] or [`DomainFrame::Strip`]; [`DomainFrame::Auto`] of higher genus.
    /// In a strip `metric` is that of the flat cylinder, without hubs.
    pub frame: DomainFrame,
    /// The layout of the surface without its holes, on the common subdivision of the surface of `split` and the metric's triangulation. That
    /// of a torus has the area of the given surface.
    pub layout: Layout,
    /// The circles, loop by loop.
    pub circles: Vec<DomainCircle>,
    /// The loop on the unit circle, of a planar domain.
    pub outer: Option<usize>,
    /// The modulus of an annulus: log of the ratio of the radii over 2π, height over circumference of the cylinder.
    pub modulus: Option<f64>,
    /// The modulus of a torus with holes, `[Re τ, Im τ]` reduced.
    pub torus_modulus: Option<[f64; 2]>,
    /// The report.
    pub report: CircleReport,
}
stored!(sections CircleDomain { split, filled, metric, frame, layout, circles, outer, modulus,
    torus_modulus, report });

impl CircleDomain {
    /// The loops whose circles overlap another one, ascending: those of two hubs that are joined by an edge with η ≤ 1. Such an edge exists
    /// wherever two disks overlap, because the union of the disks is homotopic to the part of the triangulation whose disks meet.
    pub fn overlapping(&self) -> Vec<usize> {
        if self.frame == DomainFrame::Strip {
            return Vec::new();
        }
        let (mesh, eta) = (self.metric.mesh(), &self.metric.metric().eta);
        let mut all: Vec<usize> = hub_pairs(mesh, &self.filled)
            .filter(|&(e, _)| eta[e].high <= 1.0)
            .flat_map(|(_, loops)| loops)
            .collect();
        all.sort_unstable();
        all.dedup();
        all
    }
}
