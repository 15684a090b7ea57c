//! The options of a layout of a flow's result: where the surface is opened, which vertex lies at the origin, how lengths are scaled.

use crate::error::{Result, check_size};
use crate::mesh::{Mesh, VertexId};
use crate::metric::CommonSubdivision;
use crate::topology::CutGraph;
use std::sync::Arc;

/// Largest curvature of a vertex, in radians, that does not make it a cone: a flow with the default tolerance leaves as much.
pub const CONE_TOLERANCE: f64 = 1e-10;

/// The scale of a layout in E²; the curvature of the other spaces fixes theirs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum LayoutScale {
    /// Lengths are those of the metric.
    AsSolved,
    /// The area is that of the surface as it came, in its own geometry.
    #[default]
    InputArea,
}

/// The edges along which a layout opens the surface.
#[derive(Debug, Clone, Default)]
pub enum LayoutOpening {
    /// Edges of the surface as it came: a short cut in the metric through all cones ([`crate::topology::cut_graph`]); without cones, in H²
    /// and S², the edges where a disk that grows about the root meets itself, so that nothing lies farther out than it has to. No edge at all
    /// where the flow has made the surface one piece of the plane ([`crate::Solution::is_one_piece`]) and no cones are named.
    #[default]
    InputEdges,
    /// This cut of the surface as it came.
    InputCut(CutGraph),
    /// Edges of the metric's own triangulation, for a surface without cones: faces are added by the distance of their far corner from the
    /// root, and the surface is opened where this growing disk meets itself. The opened surface is nearly a Dirichlet domain, small and
    /// round about the root; a sphere is not cut at all. The coordinates are computed in double-double precision, as deck groups need them.
    /// If the metric lives on the double, the subdivision of its triangulation and the given half is laid out.
    MetricEdges,
    /// This cut of the metric's own triangulation, with all cones inside the surface on it. The coordinates are computed in double-double
    /// precision. If the metric lives on the double, both halves are laid out.
    MetricCut(CutGraph),
}

/// The options of [`super::Layout::of_solution`].
#[derive(Debug, Clone, Default)]
pub struct LayoutOptions {
    /// The edges along which the surface is opened.
    pub opening: LayoutOpening,
    /// The vertices of the surface through which a cut along [`LayoutOpening::InputEdges`] has to go; those on the boundary change nothing.
    /// Default: the cones of the flow ([`crate::Solution::cones`]); for a metric that no flow has led to, the interior vertices whose
    /// curvature exceeds [`CONE_TOLERANCE`] ([`cones_of`]).
    pub cones: Option<Vec<VertexId>>,
    /// The vertex of the surface at the origin. Default: in E² a corner of the smallest triangle; in H² and S², and with
    /// [`LayoutOpening::MetricEdges`], a vertex from which none is far.
    pub root: Option<VertexId>,
    /// The scale in E². Default: [`LayoutScale::InputArea`].
    pub scale: LayoutScale,
    /// [`crate::Solution::common_subdivision`] of the result, if the caller has it already.
    pub subdivision: Option<Arc<CommonSubdivision>>,
    /// In H², with a cut along edges of the surface as it came: split edges of the subdivision, but for those on the boundary, until no piece is turned over where its sides
    /// are drawn straight in the Poincaré disk, as files of [`super::Layout::coordinates`] draw them. Default: false, the subdivision of
    /// [`crate::Solution::common_subdivision`].
    pub straight_sides: bool,
    /// The number of threads, in a pool of the call's own unless the caller is in one ([`crate::parallel::within`]); default 0: as many as
    /// the flow had. The result does not depend on it.
    pub threads: usize,
}

/// The cones of a curvature, or of a target curvature (V entries): the interior vertices where its absolute value exceeds `tolerance`.
///
/// # Errors
/// [`crate::Error::Size`].
pub fn cones_of(mesh: &Mesh, curvature: &[f64], tolerance: f64) -> Result<Vec<VertexId>> {
    check_size("curvature", curvature.len(), mesh.n_vertices())?;
    let is_cone = |v: &VertexId| curvature[v.index()].abs() > tolerance && !mesh.is_boundary_vertex(*v);
    Ok(mesh.vertices().filter(is_cone).collect())
}
