//! The triangulations of which a flow's common subdivision is made: that of the input, the one that the flow started from, and the final one.

use super::super::lengths::Metric;
use crate::error::{Error, Result, check_size};
use crate::geometry::Space;
use crate::mesh::{Mesh, NormalCoordinates, PerEdge, PerVertex};

/// The surface as it came.
#[derive(Debug, Clone, Copy)]
pub struct InputTriangulation<'a> {
    /// Its triangulation, before any flip.
    pub mesh: &'a Mesh,
    /// Geometry of its lengths.
    pub geometry: Space,
    /// Variables u of its metric in that geometry (V entries): [`crate::metric::Initial::input_u`].
    pub u: &'a PerVertex<f64>,
}

/// Another triangulation of the same surface, which a flow starts from.
#[derive(Debug, Clone, Copy)]
pub struct IntrinsicTriangulation<'a> {
    /// The triangulation.
    pub mesh: &'a Mesh,
    /// Lengths of its edges, in the geometry of the input.
    pub lengths: &'a PerEdge<f64>,
    /// The input's edges on it.
    pub given: &'a NormalCoordinates,
    /// Its edges on the final triangulation.
    pub normal: &'a NormalCoordinates,
}

/// The surface after a flow.
#[derive(Debug, Clone, Copy)]
pub struct FinalTriangulation<'a> {
    /// Its triangulation, after all flips.
    pub mesh: &'a Mesh,
    /// Its metric.
    pub metric: &'a Metric,
    /// The input's edges on it: every flip recorded, isometric ones too.
    pub normal: &'a NormalCoordinates,
}

/// The triangulations of one surface between which a common subdivision leads.
#[derive(Debug, Clone, Copy)]
pub struct Triangulations<'a> {
    /// The one that the surface came with.
    pub input: InputTriangulation<'a>,
    /// The one that isometric flips of the input have led to and the flow has started from, if that is another one: the edges of the
    /// input are then drawn straight on the surface.
    pub intrinsic: Option<IntrinsicTriangulation<'a>>,
    /// The one after the flow.
    pub result: FinalTriangulation<'a>,
}

/// Half-edges of the subdivision per crossing and edge, at most: 2 · (2 sides + 3 edges inside a piece), and 2 to spare. It bounds the
/// number of crossings whose subdivision u32 can number.
const HALFEDGES_PER_CROSSING: usize = 12;

impl Triangulations<'_> {
    /// Checks that arrays have the sizes of the meshes, and that crossings can be numbered.
    pub(super) fn check(&self) -> Result<()> {
        let Triangulations { input, intrinsic, result } = self;
        check_size("final vertices", result.mesh.n_vertices(), input.mesh.n_vertices())?;
        check_size("final edges", result.mesh.n_edges(), input.mesh.n_edges())?;
        check_size("input u", input.u.len(), input.mesh.n_vertices())?;
        result.metric.check(result.mesh)?;
        let count = result.normal.check(result.mesh)?.saturating_add(input.mesh.n_edges());
        check_count("crossings of input and final edges", count)?;
        let Some(IntrinsicTriangulation { mesh, lengths, given, normal }) = intrinsic else { return Ok(()) };
        check_size("intrinsic edges", mesh.n_edges(), result.mesh.n_edges())?;
        check_size("intrinsic lengths", lengths.len(), mesh.n_edges())?;
        check_count("crossings of input and intrinsic edges", given.check(mesh)?)?;
        check_count("crossings of intrinsic and final edges", normal.check(result.mesh)?)
    }
}

fn check_count(what: &'static str, count: usize) -> Result<()> {
    if count > u32::MAX as usize / HALFEDGES_PER_CROSSING {
        return Err(Error::TooLarge { what, count });
    }
    Ok(())
}
