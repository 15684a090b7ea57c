//! Surfaces in their canonical metrics: a flow finds the metric of constant curvature, its layout opens the surface along a cut, and the
//! layout gives every vertex a place in the universal cover.

use super::balance::mean_value_weights;
use super::cover::{PlacedMesh, UniversalCover};
use crate::control::Control;
use crate::embed::{Layout, LayoutOpening, LayoutOptions, LayoutScale};
use crate::error::{Error, Result};
use crate::flow::{Flow, Options, Solution};
use crate::geometry::{DoubleDouble, Motion, Space};
use crate::mesh::{HalfedgeId, Mesh, PerHalfedge, PerVertex, VertexId};
use crate::metric::{Class, CommonSubdivision, Surface, Target};
use crate::parallel::join;
use crate::topology::CutGraph;
use std::fmt::Display;
use std::sync::Arc;

/// What `make` makes of the source (0) and of the target (1), at the same time.
///
/// # Errors
/// Those of `make`, the source's first.
pub(super) fn for_both<T: Send>(make: impl Fn(usize) -> Result<T> + Sync) -> Result<[T; 2]> {
    let (source, target) = join(|| make(0), || make(1));
    Ok([source?, target?])
}

/// The metric of constant curvature in the conformal class of a surface.
pub(super) struct CanonicalMetric {
    pub solution: Solution,
    /// Steps of the flow.
    pub iterations: usize,
}

impl CanonicalMetric {
    /// The metric with this curvature at the vertices beside that of the space.
    ///
    /// # Errors
    /// [`Error::Matching`] if the flow does not reach its target; those of [`Flow::new`]; [`Error::Cancelled`].
    pub fn new(
        surface: &Surface,
        space: Space,
        curvature: PerVertex<f64>,
        options: &Options,
        control: &Control,
    ) -> Result<CanonicalMetric> {
        let mut flow = Flow::new(surface.clone(), Class::yamabe(space), options, &control.part(0.0, 0.1))?;
        let solution = flow.solve(&Target::All(curvature), &control.part(0.1, 1.0))?;
        let iterations = solution.report().map_or(0, |report| report.iterations);
        if !solution.converged() {
            let reason = solution.report().map(|report| report.stop_reason.to_string()).unwrap_or_default();
            return Err(not_found(iterations, reason));
        }
        Ok(CanonicalMetric { solution, iterations })
    }
}

/// The error of a flow that does not reach its target.
pub(super) fn not_found(iterations: usize, reason: impl Display) -> Error {
    Error::Matching(format!("the canonical metric was not found after {iterations} steps: {reason}"))
}

/// The way in which a surface is opened and laid out.
pub(super) struct Opening<'a> {
    pub cut: &'a CutGraph,
    /// The vertex at the origin of the layout.
    pub root: VertexId,
    /// The cones of the metric.
    pub cones: &'a [VertexId],
    /// Half-edges whose corners become the own corners of their vertices ([`UniversalCover::new`]).
    pub own_corners: &'a [HalfedgeId],
    pub scale: LayoutScale,
    /// [`Solution::common_subdivision`], if it has been formed before.
    pub subdivision: Option<Arc<CommonSubdivision>>,
    pub threads: usize,
}

impl Opening<'_> {
    /// The places of the vertices in this metric, and per segment of the cut the deck transformation across it.
    ///
    /// # Errors
    /// Those of [`Layout::of_solution`] and [`PlacedMesh::of_layout`].
    pub fn place(
        &self,
        solution: &Solution,
        mesh: &Arc<Mesh>,
        control: &Control,
    ) -> Result<(PlacedMesh, Vec<Motion<DoubleDouble>>)> {
        let layout_options = LayoutOptions {
            cones: Some(self.cones.to_vec()),
            root: Some(self.root),
            scale: self.scale,
            opening: LayoutOpening::InputCut(self.cut.clone()),
            subdivision: self.subdivision.clone(),
            threads: self.threads,
            ..LayoutOptions::default()
        };
        let layout = Layout::of_solution(solution, &layout_options, control)?;
        let pairings: Vec<_> = layout.seams.iter().map(|seam| seam.pairing).collect();
        let cover = UniversalCover::along_cut(mesh, layout.space, self.cut, &pairings, self.own_corners)?;
        Ok((PlacedMesh::of_layout(cover, &layout)?, pairings))
    }
}

/// A surface in its own canonical metric.
pub(super) struct CanonicalSurface {
    pub placed: PlacedMesh,
    /// Its mean value weights in this metric.
    pub weights: PerHalfedge<f64>,
    /// Steps of the flow to the metric.
    pub iterations: usize,
}

impl CanonicalSurface {
    /// A surface that is placed in its canonical metric.
    ///
    /// # Errors
    /// [`Error::Cancelled`].
    pub fn new(
        surface: &Surface,
        placed: PlacedMesh,
        iterations: usize,
        control: &Control,
    ) -> Result<CanonicalSurface> {
        let weights = mean_value_weights(&placed, surface, control)?;
        Ok(CanonicalSurface { placed, weights, iterations })
    }
}
