//! A surface other than a sphere in its metric of constant curvature, with the layout on the surface as it was given.

use super::task::CanonicalTask;
use crate::failure::{Failure, or_reason, required};
use crate::report::{Checks, PhaseSeconds, timed};
use crate::runner::CommandRun;
use crate::solved::SolvedMetric;
use crate::surface_layout::{OwnFaces, SurfaceLayout, is_carried_back};
use ricci::canonical::Quotient;
use ricci::embed::layout::MEETING;
use ricci::embed::{
    BoundaryLoop, DeckElement, DeckGroup, DirichletDomain, Layout, LayoutOptions, LiftedLoop,
    dirichlet_domain,
};
use ricci::flow::{Report, Solution};
use ricci::geometry::{DoubleDouble, Motion, Space, worse};
use ricci::mesh::{FaceId, PerEdge, VertexId};
use ricci::moduli::ModulusBounds;
use ricci::topology::{HomotopyBasis, Word};
use std::cmp::Ordering;
use std::f64::consts::PI;
use std::sync::Arc;

/// The origin in ambient coordinates: the base point.
pub const ORIGIN: [f64; 3] = [0.0, 0.0, 1.0];
/// Largest residual of the group's relation and of the layout's side pairings, relative to the largest matrix on the way: half of the
/// digits of a floating-point number.
const RELATION: f64 = 1e-8;
/// Largest effect of rounding on the area, per vertex, beside the curvature that the flow has left.
const AREA_ROUNDING: f64 = 1e-12;
/// Largest rotation of a deck transformation of a torus, radians: the default tolerance of a flow.
const TURNING: f64 = 1e-10;
/// Largest distance of a vertex of the boundary from the line of its side: in H² a length, in E² in units of the side.
const STRAIGHT: f64 = 1e-9;
/// Largest difference of the areas of Dirichlet domain and surface, relative: corners are known to 1e-8 of the domain's size.
const DOMAIN_AREA: f64 = 1e-7;

/// Largest distance of the end of a lifted loop from the image of its start under the loop's deck transformation, over the size of its
/// ambient coordinates, which are rounded by 1e-16 of it at every step.
const LIFT_END: f64 = 1e-9;

/// A lifted loop with the name that it has in files: a word, or the name of its rows.
pub struct NamedLift {
    pub name: String,
    pub lift: LiftedLoop,
}

/// A uniformized surface.
pub struct Uniformized {
    pub report: Report,
    /// max |K| in double-double precision.
    pub angle_defect: f64,
    pub solved: SolvedMetric,
    /// The layout of the metric's triangulation.
    pub layout: Layout,
    /// The layout on the surface as it was given, or the reason why there is none; made where an output needs it or it costs little.
    pub laid: Option<Result<SurfaceLayout, String>>,
    /// The lengths of the edges of `layout`, in the metric's own scale.
    pub lengths: PerEdge<f64>,
    pub basis: HomotopyBasis,
    pub deck: DeckGroup,
    pub boundary: Vec<BoundaryLoop>,
    /// The corners of a straight boundary with the angles inside, radians.
    pub corners: Vec<(VertexId, f64)>,
    /// The height over the base of a rectangle, or the height over the circumference of a flat cylinder.
    pub extremal_distance: Option<f64>,
    /// Proven bounds of this modulus.
    pub modulus: Option<ModulusBounds>,
    /// The words of `--lengths`, with the lengths of their closed geodesics.
    pub geodesics: Vec<(String, f64)>,
    /// The Dirichlet domain of the base point, where an output needs it, or the reason why there is none.
    pub domain: Option<Result<DirichletDomain, String>>,
    /// The copies of a cover, or the reason why there are none; the identity alone where no cover was asked for.
    pub elements: Result<Vec<DeckElement>, String>,
    /// The loops that were lifted to the cover.
    pub lifts: Vec<NamedLift>,
}

impl Uniformized {
    /// A quotient laid out on the surface as it was given. `taken`: the seconds until it was found.
    pub fn new(
        task: &CanonicalTask<'_>,
        quotient: Quotient,
        taken: f64,
        run: &mut CommandRun<'_>,
    ) -> Result<Uniformized, Failure> {
        let seconds = &mut run.seconds;
        let extremal_distance = quotient.extremal_distance();
        let Quotient {
            report,
            angle_defect,
            metric,
            layout,
            placement,
            lengths,
            basis,
            deck,
            boundary,
            corners,
        } = quotient;
        let geodesics = geodesics(task, &deck)?;
        let target = metric.final_target()?;
        seconds.add_flow(&report.seconds);
        seconds.layout = taken - report.seconds.total;
        let solved = SolvedMetric::new(metric, target)?;
        let laid = if is_carried_back(&solved.solution, task.needs.subdivision) {
            let base = BasePlacement { vertex: basis.base, motion: placement };
            Some(or_reason(on_surface(task, &solved.solution, &layout, &base, seconds))?)
        } else {
            None
        };
        let domain = if task.needs.domain {
            let form = || dirichlet_domain(&deck, ORIGIN, layout.area, task.control);
            Some(or_reason(timed(&mut seconds.layout, form))?)
        } else {
            None
        };
        let one = DeckElement { word: Default::default(), motion: Motion::identity(deck.space) };
        let elements = Ok(vec![one]);
        Ok(Uniformized {
            report,
            angle_defect,
            solved,
            layout,
            laid,
            lengths,
            basis,
            deck,
            boundary,
            corners,
            extremal_distance,
            modulus: None,
            geodesics,
            domain,
            elements,
            lifts: Vec::new(),
        })
    }

    /// The Dirichlet domain, if there is one.
    pub fn domain(&self) -> Result<&DirichletDomain, Failure> {
        required(&self.domain)
    }

    /// The layout on the surface as it was given, if there is one.
    pub fn laid(&self) -> Result<&SurfaceLayout, Failure> {
        required(&self.laid)
    }

    /// The copies of a cover, if they can be made.
    pub fn copies(&self) -> Result<&[DeckElement], Failure> {
        self.elements.as_deref().map_err(|why| Failure::Failed(why.clone()))
    }

    /// The faces that are not counterclockwise, of the layout on the given surface if there is one, else of the metric's triangulation.
    pub fn flipped(&self) -> &[FaceId] {
        self.laid().map_or(&self.layout.flipped, SurfaceLayout::flipped)
    }

    pub fn checks(&self) -> Checks {
        let mut checks = self.solved.checks(self.report.allowed_error());
        let layout = self.laid().map_or(&self.layout, |laid| &laid.layout);
        let meeting = match self.deck.space {
            Space::H2 => MEETING,
            _ => layout.consistency_limit(self.solved.total_error()),
        };
        checks.add("layout_consistency", layout.consistency(), meeting);
        match self.laid() {
            Ok(laid) => laid.check_flipped(&mut checks),
            Err(_) => checks.add_none("flipped_triangles", ["face", "faces"], self.flipped(), None),
        }
        checks.add("relation_residual", self.deck.relation_residual, RELATION);
        checks.add("side_residual", self.deck.side_residual, RELATION);
        let area = self.layout.area;
        if self.deck.space == Space::H2 {
            let exact = -2.0 * PI * self.solved.solution.given().euler() as f64;
            let n = self.solved.curvature.at.len() as f64;
            let limit = n * (self.solved.curvature_error() + AREA_ROUNDING);
            checks.add("area", (area - exact).abs(), limit);
            checks.add("not_hyperbolic", self.not_hyperbolic() as f64, 0.0);
        } else if self.corners.is_empty() {
            let turning = self.deck.generators.iter().map(|g| g.rotation_angle()).fold(0.0, worse);
            checks.add("turning", turning, TURNING);
        }
        if !self.boundary.is_empty() {
            checks.add("boundary_straightness", self.straightness(), STRAIGHT);
            checks.add("boundary_turning", self.turning(), self.report.allowed_error());
        }
        checks.add("unconverged", f64::from(u8::from(!self.report.converged())), 0.0);
        if let Some(laid) = &self.laid {
            checks.add("without_refinement", f64::from(u8::from(laid.is_err())), 0.0);
        }
        if let Some(worst) = self.lifts.iter().map(|named| named.lift.end_error).reduce(worse) {
            checks.add("lift_end", worst, LIFT_END);
        }
        if let Ok(domain) = self.domain() {
            checks.add("domain_area", (domain.area - area).abs() / area, DOMAIN_AREA);
        }
        checks
    }

    /// The largest distance of a vertex of the boundary from the line of its side.
    pub fn straightness(&self) -> f64 {
        self.boundary.iter().flat_map(|around| &around.sides).map(|side| side.straightness).fold(0.0, worse)
    }

    /// The largest |K − K̄| at a vertex of the boundary, by which the angles there miss π or the angle of the corner.
    pub fn turning(&self) -> f64 {
        let (solved, given) = (&self.solved, self.solved.solution.given());
        // On the double the angles of both halves add up.
        let share = if solved.solution.double().is_some() { 0.5 } else { 1.0 };
        let off = |v: VertexId| share * (solved.curvature.at[v] - solved.target[v]).abs();
        given.vertices().filter(|&v| given.is_boundary_vertex(v)).map(off).fold(0.0, worse)
    }

    /// The places of the corners in the layout, in ambient coordinates, once each.
    pub fn corner_places(&self) -> impl Iterator<Item = [f64; 3]> {
        let mesh = self.layout.mesh();
        let inside = |v: VertexId| mesh.outgoing(v).find(|&h| !mesh.is_outside(h));
        self.corners.iter().filter_map(move |corner| Some(self.layout.corner(inside(corner.0)?)))
    }

    /// The number of generators, and of elements of the sides of the layout and of the Dirichlet domain, that are no translations.
    fn not_hyperbolic(&self) -> usize {
        let sides = self.deck.sides.iter().chain(self.domain().into_iter().flat_map(|d| &d.sides));
        let motions = self.deck.generators.iter().chain(sides.map(|g| &g.motion));
        let exceeds_one = |x: f64| x.abs().partial_cmp(&1.0) == Some(Ordering::Greater);
        motions.filter(|g| !exceeds_one(f64::from(g.half_trace()))).count()
    }
}

/// The words of `--lengths`, with the lengths of their closed geodesics.
fn geodesics(task: &CanonicalTask<'_>, deck: &DeckGroup) -> Result<Vec<(String, f64)>, Failure> {
    let words = task.args.boundary.words(&deck.group)?;
    let length = |(text, word): (&String, &Word)| Ok((text.clone(), deck.motion(word)?.translation_length()));
    task.args.boundary.lengths.iter().zip(&words).map(length).collect()
}

/// The base vertex at which a surface is cut open, and the motion that then brings the layout to its place.
struct BasePlacement {
    vertex: VertexId,
    motion: Motion<DoubleDouble>,
}

/// The layout of a quotient on the surface as it was given.
fn on_surface(
    task: &CanonicalTask<'_>,
    solution: &Solution,
    layout: &Layout,
    base: &BasePlacement,
    seconds: &mut PhaseSeconds,
) -> ricci::Result<SurfaceLayout> {
    let control = task.control;
    let subdivision = match layout.common_subdivision() {
        Some(subdivision) => subdivision.clone(),
        None => Arc::new(timed(&mut seconds.refine, || solution.common_subdivision(control))?),
    };
    timed(&mut seconds.layout, || {
        let again = |r| layout.on_subdivision(&r, solution.metric(), control);
        let refined = match layout.common_subdivision() {
            Some(_) => layout.clone(),
            None => again(subdivision.clone())?.with_straight_sides(solution, control, again)?,
        };
        let mut laid = SurfaceLayout::new(task.input, solution, refined)?;
        if task.needs.on_input {
            let (cones, root) = (Some(Vec::new()), Some(base.vertex));
            let subdivision = Some(subdivision);
            let options = LayoutOptions { cones, root, subdivision, ..LayoutOptions::default() };
            let mut along_edges = Layout::of_solution(solution, &options, control)?;
            if along_edges.space == Space::E2 {
                along_edges.move_by(&base.motion)?;
            }
            laid.on_input = along_edges.on_input();
            laid.own_faces = OwnFaces::new(&along_edges, task.input, task.args.to.repair, control)?;
        }
        Ok(laid)
    })
}
