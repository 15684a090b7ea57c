//! The layout of a flow's result on the surface as it came.

use super::faces::{Faces, combination};
use super::frame::{Frame, PlaneFrame};
use super::layout::{Layout, distance};
use super::pieces::{Pieces, Place};
use super::place::lay_out;
use crate::control::Control;
use crate::error::{Result, check_size};
use crate::flow::Solution;
use crate::geometry::{DoubleDouble, Motion, Space};
use crate::mesh::{FaceId, HalfedgeId, Mesh, PerEdge, VertexId};
use crate::metric::curvature::area;
use crate::metric::{Metric, Refinement};
use crate::parallel::{self, within};
use crate::topology::{CutGraph, central_vertex, check_vertex, cut_about, cut_about_centre, cut_graph};
use std::cell::OnceCell;
use std::sync::Arc;

/// Curvature up to this, in radians, is no cone: what a flow with the default tolerance leaves.
pub const CONE_TOLERANCE: f64 = 1e-10;
/// Length of the shortest edge relative to the longest below which a search for a cut takes edges to have this length: paths over
/// regions that have shrunk to a point then do not cost nothing.
const SHORTEST: f64 = 1e-12;

/// Lengths in a layout in E²; other spaces have a scale of their own.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Scale {
    /// As the metric has them.
    AsSolved,
    /// So that the area is that of the surface as it came, in its own geometry.
    #[default]
    InputArea,
}

/// What [`unroll`] can be asked.
#[derive(Debug, Clone, Default)]
pub struct UnrollOptions {
    /// Vertices of the surface through which the cut has to go; those on the boundary change nothing. Default: those of the flow
    /// ([`Solution::cones`]); of a metric that no flow has led to, those inside whose curvature is more than [`CONE_TOLERANCE`] off flat
    /// ([`cones_of`]).
    pub cones: Option<Vec<VertexId>>,
    /// The vertex of the surface at the origin. Default: in E² a corner of the smallest triangle, elsewhere a vertex from which none is
    /// far.
    pub root: Option<VertexId>,
    /// Default: [`Scale::InputArea`].
    pub scale: Scale,
    /// A cut of the surface as it came, in place of one that is found.
    pub cut: Option<CutGraph>,
    /// [`Solution::refinement`] of the result, where it has been formed before.
    pub refinement: Option<Arc<Refinement>>,
    /// Threads, in a pool of the call's own unless the caller is in one ([`within`]); default 0: as many as the flow had. The result does
    /// not depend on it.
    pub threads: usize,
}

/// The cones of a curvature, or of a target of one: vertices inside the surface (V entries) where it is more than `tolerance` off flat.
///
/// # Errors
/// [`crate::Error::Size`].
pub fn cones_of(mesh: &Mesh, curvature: &[f64], tolerance: f64) -> Result<Vec<VertexId>> {
    check_size("curvature", curvature.len(), mesh.n_vertices())?;
    let is_cone = |v: &VertexId| curvature[v.index()].abs() > tolerance && !mesh.is_boundary_vertex(*v);
    Ok(mesh.vertices().filter(is_cone).collect())
}

/// Lays a metric out in its space on the surface as it came, opened along edges of that: closed or open, on its double (the given half),
/// with edges flipped (then the common refinement is laid out) or not.
///
/// The cut goes through all cones, and is short in the metric ([`cut_graph`]); without cones, in H² and S², it is where a disk that
/// grows about the root meets itself, so that nothing lies farther out than it has to.
///
/// # Errors
/// [`crate::Error::Argument`] for a cone or root that is no vertex; [`crate::Error::Layout`] for a sphere in E² with fewer than two cones,
/// a cut that does not leave a disk, several components, lengths beyond what doubles can place; those of [`Solution::refinement`] and
/// [`crate::metric::Metric::lengths`]; [`crate::Error::Cancelled`].
///
/// ```
/// use ricci::embed::{UnrollOptions, unroll};
/// use ricci::{Class, Control, Solution, Surface, geometry::Space, mesh::shapes};
/// # fn main() -> ricci::Result<()> {
/// let disk = Surface::from_soup(&shapes::disk(4)?)?;
/// let metric = Solution::initial_of(disk, Class::yamabe(Space::E2))?;
/// let layout = unroll(&metric, &UnrollOptions::default(), &Control::new())?;
/// assert!(layout.flipped.is_empty() && layout.consistency() < 1e-14);
/// # Ok(())
/// # }
/// ```
pub fn unroll(result: &Solution, options: &UnrollOptions, control: &Control) -> Result<Layout> {
    let refine = || match &options.refinement {
        Some(refinement) => Ok(Some(refinement.clone())),
        None => refinement_of(result, control),
    };
    unroll_by(result, options, refine, control)
}

/// [`Solution::refinement`] where edges were flipped; `None` where the metric lives on the given triangulation.
///
/// # Errors
/// As there.
pub fn refinement_of(result: &Solution, control: &Control) -> Result<Option<Arc<Refinement>>> {
    if result.is_unflipped() { Ok(None) } else { result.refinement(control).map(|r| Some(Arc::new(r))) }
}

/// [`unroll`] with what `refine` makes, which is to be [`refinement_of`] the result, beside the triangles of the metric: who calls can measure
/// its time, or keep it. [`UnrollOptions::refinement`] has no part in it.
///
/// # Errors
/// Those of [`unroll`] and of `refine`.
pub fn unroll_by(
    result: &Solution,
    options: &UnrollOptions,
    refine: impl FnOnce() -> Result<Option<Arc<Refinement>>> + Send,
    control: &Control,
) -> Result<Layout> {
    control.check()?;
    let threads = if options.threads == 0 { result.threads() } else { options.threads };
    within(threads, || unroll_in_pool(result, options, refine, control))
}

fn unroll_in_pool(
    result: &Solution,
    options: &UnrollOptions,
    refine: impl FnOnce() -> Result<Option<Arc<Refinement>>> + Send,
    control: &Control,
) -> Result<Layout> {
    let given = result.given();
    let source = Source { given, mesh: result.mesh(), metric: result.metric(), refinement: None };
    let known = result.report().map(|_| result.cones().to_vec());
    let cones = options.cones.clone().or(known);
    let options = UnrollOptions { cones, ..options.clone() };
    let is_scaled = options.scale != Scale::AsSolved && result.metric().space == Space::E2;
    let given_area =
        || is_scaled.then(|| area(given, result.initial().input_geometry, result.surface().lengths()));
    let (layout, given_area) = parallel::join(|| laid_out(source, refine, &options, control), given_area);
    let mut layout = layout?;
    match given_area {
        Some(area) => {
            layout.scale_to_area(area?)?;
        }
        None => layout.find_flat(),
    }
    Ok(layout)
}

/// A metric on a triangulation of its own, and the surface as it came.
#[derive(Debug, Clone)]
pub struct Source<'a> {
    /// The surface as it came.
    pub given: &'a Arc<Mesh>,
    /// The triangulation that the metric lives on, of the surface or of its double.
    pub mesh: &'a Mesh,
    /// The metric.
    pub metric: &'a Metric,
    /// The common refinement of both, on the surface alone; `None` where both are one.
    pub refinement: Option<Arc<Refinement>>,
}

/// [`unroll`] from its parts, in the metric's own scale.
///
/// # Errors
/// Those of [`unroll`].
pub fn unroll_source(source: Source, options: &UnrollOptions, control: &Control) -> Result<Layout> {
    let refinement = source.refinement.clone();
    let mut layout = laid_out(source, || Ok(refinement), options, control)?;
    layout.find_flat();
    Ok(layout)
}

/// The layout of a source with the refinement that `refine` makes.
fn laid_out(
    source: Source,
    refine: impl FnOnce() -> Result<Option<Arc<Refinement>>> + Send,
    options: &UnrollOptions,
    control: &Control,
) -> Result<Layout> {
    control.check()?;
    let Source { mesh, metric, .. } = source;
    let refined = |refinement| Source { refinement, ..source };
    // One thread alone forms most of a refinement.
    if metric.space == Space::E2 {
        let (refinement, faces) = parallel::join(refine, || Faces::in_plane(mesh, metric));
        return by::<PlaneFrame>(&faces?, refined(refinement?), options, control);
    }
    let (refinement, faces) = parallel::join(refine, || Faces::precise(mesh, metric));
    by::<Motion<DoubleDouble>>(&faces?, refined(refinement?), options, control)
}

fn by<F: Frame>(
    faces: &Faces<F>,
    source: Source,
    options: &UnrollOptions,
    control: &Control,
) -> Result<Layout> {
    let (given, space) = (source.given, faces.space);
    let pieces = source.refinement.map_or_else(|| Pieces::Mesh(given.clone()), Pieces::Refinement);
    let vertices = options.cones.iter().flatten().chain(&options.root);
    vertices.copied().try_for_each(|v| check_vertex(given, v))?;
    let cones = match &options.cones {
        Some(cones) => cones.clone(),
        // The curvature of a double is that of the surface at vertices inside it.
        None => {
            let mut curvature = source.metric.curvature(source.mesh)?.at.into_vec();
            curvature.truncate(given.n_vertices());
            cones_of(given, &curvature, CONE_TOLERANCE)?
        }
    };
    let needs_lengths = options.cut.is_none() || (options.root.is_none() && space != Space::E2);
    let lengths = match needs_lengths {
        true => lengths_of_input(&pieces, lengths_of_pieces(&pieces, faces), given),
        false => Vec::new().into(),
    };
    control.check()?;
    let cut_through_cones = || match &options.cut {
        Some(cut) => Ok(cut.clone()),
        None => cut_graph(given, &lengths, &cones, control),
    };
    let is_curved = space != Space::E2;
    let is_about = is_curved && options.cut.is_none() && cones.is_empty();
    let (root, cut) = match options.root {
        None if is_about => {
            let (centre, cut) = cut_about_centre(given, &lengths, control)?;
            (Some(centre), cut)
        }
        Some(root) if is_about => (Some(root), cut_about(given, &lengths, root, control)?),
        None if is_curved => (Some(central_vertex(given, &lengths, control)?), cut_through_cones()?),
        root => (root, cut_through_cones()?),
    };
    // A sphere without cones needs no cut.
    let is_whole = cut.segments.is_empty() && given.is_closed();
    let on_pieces = if is_whole { None } else { Some(pieces.cut_of_input(given, &cut)?) };
    let mut layout = lay_out(pieces, faces, root, on_pieces, control)?;
    layout.input = Some((given.clone(), cut));
    Ok(layout)
}

/// A layout about a base vertex, and lengths of the edges of what is laid out, in the metric, as searches for paths take them.
#[derive(Debug, Clone)]
pub struct About {
    /// The layout.
    pub layout: Layout,
    /// Its base vertex, at the origin.
    pub base: VertexId,
    /// Per edge of [`Layout::mesh`].
    pub lengths: PerEdge<f64>,
}

/// Lays a metric without cones out about a base vertex of the surface, with twice the digits of doubles, as deck groups need them: where
/// the disk that grows about the base meets itself the surface is opened ([`super::layout_of`]).
///
/// What is laid out is the metric's triangulation; of one on a double, the refinement of that and the surface as it came, on the given
/// half. `base`: default, a vertex from which none is far.
///
/// # Errors
/// Those of [`super::layout_of`] and [`Solution::refinement`].
pub fn layout_about(result: &Solution, base: Option<VertexId>, control: &Control) -> Result<About> {
    let faces = Faces::precise(result.mesh(), result.metric())?;
    let (pieces, centre) = match result.double() {
        None => (Pieces::Mesh(result.mesh().clone()), result.mesh()),
        Some(_) => (Pieces::Refinement(Arc::new(result.refinement(control)?)), result.given()),
    };
    let parts = lengths_of_pieces(&pieces, &faces);
    let lengths = match pieces.refinement() {
        None => parts.clone(),
        Some(_) => with_least(parts.clone()),
    };
    let base = match base {
        Some(base) => base,
        None if pieces.refinement().is_none() => central_vertex(centre, &lengths, control)?,
        None => central_vertex(centre, &lengths_of_input(&pieces, parts, centre), control)?,
    };
    let mut layout = lay_out(pieces, &faces, Some(base), None, control)?;
    layout.find_flat();
    Ok(About { layout, base, lengths })
}

/// Lengths of the edges of the pieces in the metric.
fn lengths_of_pieces<F: Frame>(pieces: &Pieces, faces: &Faces<F>) -> PerEdge<f64> {
    let mesh = pieces.mesh();
    if pieces.refinement().is_none() {
        return faces.lengths();
    }
    // Of the two sides of an edge inside, the one with the even half-edge counts.
    let counts = |h: HalfedgeId| h.0 & 1 == 0 || mesh.is_outside(h.twin());
    let mut parts = vec![[0.0; 3]; mesh.n_faces()];
    parallel::fill(&mut parts, |f| {
        let f = FaceId::from(f);
        let (face, sides) = (pieces.final_face(f), mesh.face_halfedges(f));
        let places = [0, 1, 2].map(|k| pieces.final_place((f, k), sides[k]));
        let corners = OnceCell::new();
        let point = |k: usize| {
            let corners = *corners.get_or_init(|| faces.local(face));
            combination(faces.space, corners, places[k].weights())
        };
        [0, 1, 2].map(|k| match [places[k], places[(k + 1) % 3]].map(Place::rounded) {
            _ if !counts(sides[k]) => 0.0,
            // A whole side of the final face.
            [Some(from), Some(to)] if from != to => faces.length(face, 3 - from - to),
            _ => distance(faces.space, point(k), point((k + 1) % 3)),
        })
    });
    let mut lengths = PerEdge::filled(mesh.n_edges(), 0.0);
    for f in mesh.faces() {
        let sides = mesh.face_halfedges(f).into_iter().zip(parts[f.index()]);
        sides.filter(|(h, _)| counts(*h)).for_each(|(h, part)| lengths[h.edge()] = part);
    }
    lengths
}

/// Lengths of the input's edges, each along itself: sums over those of the pieces.
fn lengths_of_input(pieces: &Pieces, parts: PerEdge<f64>, given: &Mesh) -> PerEdge<f64> {
    if pieces.refinement().is_none() {
        return with_least(parts);
    }
    let mut lengths = PerEdge::filled(given.n_edges(), 0.0);
    for part in pieces.mesh().edges() {
        if let Some(e) = pieces.input_edge(part) {
            lengths[e] += parts[part];
        }
    }
    with_least(lengths)
}

/// Lengths, none below [`SHORTEST`].
fn with_least(mut lengths: PerEdge<f64>) -> PerEdge<f64> {
    let least = SHORTEST * lengths.iter().copied().fold(0.0, f64::max);
    lengths.iter_mut().for_each(|l| *l = l.max(least));
    lengths
}
