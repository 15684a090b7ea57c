//! The layout of a flow's result: a [`Layout`] that starts from a [`Solution`].

use super::edge_lengths::{lengths_of_input, lengths_of_pieces, with_least_length};
use super::faces::Faces;
use super::frame::HalfedgeFrame;
use super::layout::Layout;
use super::layout_options::{CONE_TOLERANCE, LayoutOpening, LayoutOptions, LayoutScale, cones_of};
use super::pieces::LayoutPieces;
use super::unfold::{unfold, unfold_whole};
use crate::control::Control;
use crate::error::Result;
use crate::flow::Solution;
use crate::geometry::Space;
use crate::mesh::{Mesh, PerEdge, VertexId};
use crate::metric::CommonSubdivision;
use crate::metric::curvature::area;
use crate::parallel::within;
use crate::topology::{CutGraph, central_vertex, check_vertex, cut_about, cut_about_centre, cut_graph};
use std::sync::Arc;

impl Layout {
    /// The layout of a flow's result, closed or open, on the double (then of the given half), with edges flipped (then on the common
    /// subdivision) or not. By default the surface is opened along edges of the surface as it came ([`LayoutOpening`]).
    ///
    /// # Errors
    /// [`crate::Error::Argument`] for a cone or root that is no vertex; [`crate::Error::Layout`] for a sphere in E² with fewer than two
    /// cones, a cut that does not leave a disk, several components, lengths beyond what f64s can place; those of [`Solution::common_subdivision`]
    /// and [`crate::metric::Metric::lengths`]; [`crate::Error::Cancelled`].
    ///
    /// ```
    /// use ricci::embed::{Layout, LayoutOptions};
    /// use ricci::{Class, Control, Solution, Surface, geometry::Space, mesh::shapes};
    /// # fn main() -> ricci::Result<()> {
    /// let disk = Surface::from_soup(&shapes::disk(4)?)?;
    /// let metric = Solution::initial_of(disk, Class::yamabe(Space::E2))?;
    /// let layout = Layout::of_solution(&metric, &LayoutOptions::default(), &Control::new())?;
    /// assert!(layout.flipped.is_empty() && layout.consistency() < 1e-14);
    /// # Ok(())
    /// # }
    /// ```
    pub fn of_solution(solution: &Solution, options: &LayoutOptions, control: &Control) -> Result<Layout> {
        control.check()?;
        let threads = if options.threads == 0 { solution.threads() } else { options.threads };
        within(threads, || {
            let mut layout = match &options.opening {
                LayoutOpening::InputEdges | LayoutOpening::InputCut(_) => {
                    along_input_edges(solution, options, control)?
                }
                LayoutOpening::MetricEdges => along_metric_edges(solution, options, control)?,
                LayoutOpening::MetricCut(cut) => along_metric_cut(solution, options.root, cut, control)?,
            };
            if options.scale == LayoutScale::InputArea && layout.space == Space::E2 {
                let (given, geometry) = (solution.given(), solution.initial().input_geometry);
                layout.scale_to_area(area(given, geometry, solution.surface().lengths())?)?;
            } else {
                layout.find_flat();
            }
            Ok(layout)
        })
    }
}

/// The layout opened along edges of the surface as it came, at the metric's own scale.
fn along_input_edges(solution: &Solution, options: &LayoutOptions, control: &Control) -> Result<Layout> {
    let (mesh, metric) = (solution.mesh(), solution.metric());
    let pieces = match &options.subdivision {
        Some(subdivision) => LayoutPieces::Subdivision(subdivision.clone()),
        None if solution.is_unflipped() => LayoutPieces::Mesh(solution.given().clone()),
        None => LayoutPieces::Subdivision(Arc::new(solution.common_subdivision(&control.part(0.0, 0.3))?)),
    };
    if metric.space == Space::E2 {
        cut_and_unfold(solution, pieces, &Faces::in_plane(mesh, metric)?, options, control)
    } else {
        cut_and_unfold(solution, pieces, &Faces::precise(mesh, metric)?, options, control)
    }
}

/// Cuts the surface as it came and unfolds the pieces along that cut.
fn cut_and_unfold<F: HalfedgeFrame>(
    solution: &Solution,
    pieces: LayoutPieces,
    faces: &Faces<F>,
    options: &LayoutOptions,
    control: &Control,
) -> Result<Layout> {
    let given = solution.given();
    let vertices = options.cones.iter().flatten().chain(&options.root);
    vertices.copied().try_for_each(|v| check_vertex(given, v))?;
    let asks_for_cut = options.cones.is_some() || matches!(options.opening, LayoutOpening::InputCut(_));
    if solution.is_one_piece() && !asks_for_cut {
        let mut layout = unfold_whole(pieces, faces, options.root, &control.part(0.3, 0.9))?;
        layout.input = Some((given.clone(), CutGraph::empty(given)));
        return Ok(layout);
    }
    let (root, cut) = root_and_cut(solution, &pieces, faces, options, &control.part(0.3, 0.5))?;
    // A sphere without cones needs no cut.
    let is_whole = cut.segments.is_empty() && given.is_closed();
    let lay_out = |pieces: LayoutPieces| {
        let cut_of_pieces = if is_whole { None } else { Some(pieces.cut_of_input(given, &cut)?) };
        unfold(pieces, faces, root, cut_of_pieces, &control.part(0.5, 0.9))
    };
    let mut layout = lay_out(pieces)?;
    if options.straight_sides {
        let again = |r| lay_out(LayoutPieces::Subdivision(r));
        layout = layout.with_straight_sides(solution, control, again)?;
    }
    layout.input = Some((given.clone(), cut));
    Ok(layout)
}

/// The vertex at the origin, `None` for a corner of the smallest triangle, and the cut of the surface as it came.
fn root_and_cut<F: HalfedgeFrame>(
    solution: &Solution,
    pieces: &LayoutPieces,
    faces: &Faces<F>,
    options: &LayoutOptions,
    control: &Control,
) -> Result<(Option<VertexId>, CutGraph)> {
    let given = solution.given();
    let cones = cones(solution, options)?;
    let is_curved = faces.space != Space::E2;
    let known_cut = match &options.opening {
        LayoutOpening::InputCut(cut) => Some(cut),
        _ => None,
    };
    let needs_lengths = known_cut.is_none() || (options.root.is_none() && is_curved);
    let lengths = if needs_lengths {
        lengths_of_input(pieces, lengths_of_pieces(pieces, faces), given)
    } else {
        Vec::new().into()
    };
    control.check()?;
    if is_curved && known_cut.is_none() && cones.is_empty() {
        return match options.root {
            Some(root) => Ok((Some(root), cut_about(given, &lengths, root, control)?)),
            None => {
                let (centre, cut) = cut_about_centre(given, &lengths, control)?;
                Ok((Some(centre), cut))
            }
        };
    }
    let root = match options.root {
        None if is_curved => Some(central_vertex(given, &lengths, control)?),
        root => root,
    };
    let cut = match known_cut {
        Some(cut) => cut.clone(),
        None => cut_graph(given, &lengths, &cones, control)?,
    };
    Ok((root, cut))
}

/// The cones through which the cut goes ([`LayoutOptions::cones`]).
fn cones(solution: &Solution, options: &LayoutOptions) -> Result<Vec<VertexId>> {
    if let Some(cones) = &options.cones {
        return Ok(cones.clone());
    }
    if solution.report().is_some() {
        return Ok(solution.cones().to_vec());
    }
    // At interior vertices of the given half, the curvature of the double is that of the surface.
    let given = solution.given();
    let mut curvature = solution.metric().curvature(solution.mesh())?.at.into_vec();
    curvature.truncate(given.n_vertices());
    cones_of(given, &curvature, CONE_TOLERANCE)
}

/// A layout about a base vertex, with the lengths of its edges.
#[derive(Debug, Clone)]
pub(crate) struct BasedLayout {
    pub layout: Layout,
    /// The vertex at the origin.
    pub base: VertexId,
    /// The lengths, in the metric, of the edges of [`Layout::mesh`], as searches for shortest paths take them.
    pub lengths: PerEdge<f64>,
}

impl BasedLayout {
    /// The layout of a metric without cones about a base vertex of the surface, opened along [`LayoutOpening::MetricEdges`], at the metric's own
    /// scale. `base`: default, a vertex from which none is far.
    ///
    /// # Errors
    /// Those of [`Layout::of_solution`].
    pub(crate) fn new(solution: &Solution, base: Option<VertexId>, control: &Control) -> Result<BasedLayout> {
        let mut based = BasedLayout::unmeasured(solution, base, None, control)?;
        based.layout.find_flat();
        Ok(based)
    }

    /// [`BasedLayout::new`] without the search for flipped triangles.
    fn unmeasured(
        solution: &Solution,
        base: Option<VertexId>,
        subdivision: Option<&Arc<CommonSubdivision>>,
        control: &Control,
    ) -> Result<BasedLayout> {
        let faces = Faces::precise(solution.mesh(), solution.metric())?;
        let (pieces, surface): (LayoutPieces, &Mesh) = match (solution.goes_beyond_given(), subdivision) {
            (false, _) => (LayoutPieces::Mesh(solution.mesh().clone()), solution.mesh()),
            (true, Some(subdivision)) => (LayoutPieces::Subdivision(subdivision.clone()), solution.given()),
            (true, None) => (
                LayoutPieces::Subdivision(Arc::new(solution.common_subdivision(&control.part(0.0, 0.4))?)),
                solution.given(),
            ),
        };
        let of_pieces = lengths_of_pieces(&pieces, &faces);
        let is_refined = pieces.common_subdivision().is_some();
        let base = match base {
            Some(base) => base,
            None if is_refined => {
                central_vertex(surface, &lengths_of_input(&pieces, of_pieces.clone(), surface), control)?
            }
            None => central_vertex(surface, &of_pieces, control)?,
        };
        let lengths = if is_refined { with_least_length(of_pieces) } else { of_pieces };
        let layout = unfold(pieces, &faces, Some(base), None, &control.part(0.4, 1.0))?;
        Ok(BasedLayout { layout, base, lengths })
    }
}

fn along_metric_edges(solution: &Solution, options: &LayoutOptions, control: &Control) -> Result<Layout> {
    Ok(BasedLayout::unmeasured(solution, options.root, options.subdivision.as_ref(), control)?.layout)
}

/// The layout opened along a cut of the metric's own triangulation, at the metric's own scale.
fn along_metric_cut(
    solution: &Solution,
    root: Option<VertexId>,
    cut: &CutGraph,
    control: &Control,
) -> Result<Layout> {
    let mesh = solution.mesh();
    let faces = Faces::precise(mesh, solution.metric())?;
    let root = match root {
        None if faces.space != Space::E2 => Some(central_vertex(mesh, &faces.lengths(), control)?),
        root => root,
    };
    unfold(LayoutPieces::Mesh(mesh.clone()), &faces, root, Some(cut.clone()), control)
}
