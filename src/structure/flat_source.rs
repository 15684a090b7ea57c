//! What charts are developed from: a developed surface with its metric and figures, and how a flat surface becomes one.

use super::developable::DevelopableSurface;
use crate::control::Control;
use crate::error::Result;
use crate::flow::Solution;
use crate::geometry::complex::{cross, dot, sub};
use crate::harmonic::Zero;
use crate::mesh::{PerEdge, PerVertex, Place, VertexId};
use crate::metric::CommonSubdivision;
use crate::topology::{HomotopyBasis, homotopy_basis};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Length, over the longest edge, to which shorter edges are raised for the search for loops.
const SHORTEST: f64 = 1e-12;
/// Deviation, in radians, from a full turn up to which an angle counts as one.
const FULL: f64 = 1e-9;

/// A surface from which charts are developed, with its metric and figures.
pub(super) struct StructureSource {
    pub developed: DevelopableSurface,
    pub metric: Arc<Solution>,
    /// The common subdivision, if the developed surface lies on it and not on the metric's triangulation.
    pub subdivision: Option<Arc<CommonSubdivision>>,
    pub basis: HomotopyBasis,
    pub zeros: Vec<Zero>,
    pub curvature_error: f64,
    pub converged: bool,
    /// The places of the vertices on the given surface, for an integer structure.
    pub on_given: Option<Vec<Place>>,
}

/// The source of a flat surface with its metric.
pub(super) fn source_of_flat(
    mut developed: DevelopableSurface,
    metric: Solution,
    control: &Control,
) -> Result<StructureSource> {
    mark_wide_corners(&mut developed);
    Ok(StructureSource {
        basis: homotopy_basis(developed.mesh(), &lengths(&developed), None, control)?,
        developed,
        zeros: Vec::new(),
        curvature_error: metric.report().map_or(f64::NAN, |report| report.max_curvature_error),
        converged: metric.converged(),
        metric: Arc::new(metric),
        subdivision: None,
        on_given: None,
    })
}

/// Marks boundary vertices with an angle of at least a full turn: no chart in the plane can contain all faces of such a vertex.
fn mark_wide_corners(developed: &mut DevelopableSurface) {
    let mesh = developed.faces.mesh.clone();
    let mut angle = PerVertex::filled(mesh.n_vertices(), 0.0);
    for f in mesh.faces() {
        let corners = developed.faces.corners[f].map(|[x, y, _]| [x, y]);
        for (k, v) in mesh.face_vertices(f).into_iter().enumerate() {
            let [z, w] = [1, 2].map(|i| sub(corners[(k + i) % 3], corners[k]));
            angle[v] += cross(z, w).atan2(dot(z, w));
        }
    }
    let is_wide = |v: &VertexId| mesh.is_boundary_vertex(*v) && angle[*v] > TAU - FULL;
    mesh.vertices().filter(is_wide).for_each(|v| developed.singular[v] = true);
}

/// The edge lengths of a flat surface for the search for loops.
fn lengths(developed: &DevelopableSurface) -> PerEdge<f64> {
    let mesh = developed.mesh();
    let mut lengths = PerEdge::filled(mesh.n_edges(), 0.0);
    for f in mesh.faces() {
        let corners = developed.faces.corners[f];
        for (k, h) in mesh.face_halfedges(f).into_iter().enumerate() {
            let (p, q) = (corners[k], corners[(k + 1) % 3]);
            lengths[h.edge()] = (p[0] - q[0]).hypot(p[1] - q[1]);
        }
    }
    let least = SHORTEST * lengths.iter().copied().fold(0.0, f64::max);
    lengths.iter_mut().for_each(|l| *l = l.max(least));
    lengths
}
