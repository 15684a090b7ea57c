//! A surface that is no sphere in its metric of constant curvature, laid out on the surface as it was given.

use super::needs::Task;
use crate::failure::{Failure, known, told};
use crate::laid::{Laid, is_carried_back};
use crate::report::{Checks, Seconds, timed};
use crate::solved::Solved;
use ricci::canonical::Quotient;
use ricci::embed::layout::MEETING;
use ricci::embed::{
    BoundaryLoop, DeckElement, DeckGroup, DirichletDomain, Layout, LayoutOptions, dirichlet_domain,
};
use ricci::flow::Report;
use ricci::geometry::{DoubleDouble, Motion, Space, worse};
use ricci::mesh::{FaceId, PerEdge, VertexId};
use ricci::topology::{HomotopyBasis, Word};
use std::cmp::Ordering;
use std::f64::consts::PI;
use std::sync::Arc;

/// The origin in ambient coordinates: the base point.
pub const ORIGIN: [f64; 3] = [0.0, 0.0, 1.0];
/// Largest residual of the group's relation and of the layout's side pairings, relative to the largest matrix on the way: half of
/// the digits of a double.
const RELATION: f64 = 1e-8;
/// What rounding may do to the area per vertex, beside the curvature that the flow has left.
const AREA_ROUNDING: f64 = 1e-12;
/// Largest rotation of a deck transformation of a torus, radians: the default tolerance of a flow.
const TURNING: f64 = 1e-10;
/// Largest distance of a vertex of the boundary from the line of its side: in H² a length, in E² in units of the side.
const STRAIGHT: f64 = 1e-9;
/// Largest difference of the areas of Dirichlet domain and surface, relative: corners are known to 1e-8 of the domain's size.
const DOMAIN_AREA: f64 = 1e-7;

/// A uniformized surface.
pub struct Uniformized {
    pub report: Report,
    /// max |K| to twice the digits of doubles.
    pub angle_defect: f64,
    pub solved: Solved,
    /// The layout of the metric's triangulation.
    pub layout: Layout,
    /// The same on the surface as it was given: where an output needs it or it costs little, or why there is none.
    pub laid: Option<Result<Laid, String>>,
    /// Lengths of the edges of that, in the metric's own scale.
    pub lengths: PerEdge<f64>,
    pub basis: HomotopyBasis,
    pub deck: DeckGroup,
    /// The boundary loops, and the corners of a straight boundary with the angles inside, radians.
    pub boundary: Vec<BoundaryLoop>,
    pub corners: Vec<(VertexId, f64)>,
    /// Height over base of a rectangle, height over circumference of a flat cylinder.
    pub extremal_distance: Option<f64>,
    /// The words of `--lengths`, with the lengths of their closed geodesics.
    pub geodesics: Vec<(String, f64)>,
    /// The Dirichlet domain of the base point, where an output needs it, or why there is none.
    pub domain: Option<Result<DirichletDomain, String>>,
    /// The copies of a cover, the identity alone where none was asked for; or why there are none.
    pub elements: Result<Vec<DeckElement>, String>,
}

impl Uniformized {
    /// A quotient laid out on the surface as it was given. `taken`: seconds until it was found.
    pub fn new(task: &Task<'_>, quotient: Quotient, taken: f64) -> Result<Uniformized, Failure> {
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
        let mut seconds = Seconds::new(task.input, &report.seconds);
        seconds.layout = taken - report.seconds.total;
        let mut solved = Solved::new(metric, target, seconds)?;
        let laid = match is_carried_back(&solved.solution, task.needs.refinement) {
            true => Some(told(on_surface(task, &mut solved, &layout, (basis.base, placement)))?),
            false => None,
        };
        let form = || dirichlet_domain(&deck, ORIGIN, layout.area, task.control);
        let domain = match task.needs.domain {
            true => Some(told(timed(&mut solved.seconds.layout, form))?),
            false => None,
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
            geodesics,
            domain,
            elements,
        })
    }

    /// The Dirichlet domain, if there is one.
    pub fn domain(&self) -> Result<&DirichletDomain, Failure> {
        known(&self.domain)
    }

    /// The layout on the surface as it was given, if there is one.
    pub fn laid(&self) -> Result<&Laid, Failure> {
        known(&self.laid)
    }

    /// The copies of a cover, if they can be made.
    pub fn copies(&self) -> Result<&[DeckElement], Failure> {
        self.elements.as_deref().map_err(|why| Failure::Failed(why.clone()))
    }

    /// Faces of the layout, of the given surface if that is laid out, that are not counterclockwise.
    pub fn flipped(&self) -> &[FaceId] {
        self.laid().map_or(&self.layout.flipped, Laid::flipped)
    }

    /// What the result is held against.
    pub fn checks(&self) -> Checks {
        let mut checks = self.solved.checks(self.report.allowed_error());
        let layout = self.laid().map_or(&self.layout, |laid| &laid.layout);
        let meeting = match self.deck.space {
            Space::H2 => MEETING,
            _ => layout.consistency_limit(self.solved.total_error()),
        };
        checks.add("layout_consistency", layout.consistency(), meeting);
        checks.add("flipped_triangles", self.flipped().len() as f64, 0.0);
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
        if let Ok(domain) = self.domain() {
            checks.add("domain_area", (domain.area - area).abs() / area, DOMAIN_AREA);
        }
        checks
    }

    /// Largest distance of a vertex of the boundary from the line of its side.
    pub fn straightness(&self) -> f64 {
        self.boundary.iter().flat_map(|around| &around.sides).map(|side| side.straightness).fold(0.0, worse)
    }

    /// Largest |K − K̄| at a vertex of the boundary: by how much the angles there miss π, or the angle of the corner.
    pub fn turning(&self) -> f64 {
        let (solved, given) = (&self.solved, self.solved.solution.given());
        // On a double the angles of both sides add up.
        let share = if solved.solution.double().is_some() { 0.5 } else { 1.0 };
        let off = |v: VertexId| share * (solved.curvature.at[v] - solved.target[v]).abs();
        given.vertices().filter(|&v| given.is_boundary_vertex(v)).map(off).fold(0.0, worse)
    }

    /// Where the layout has the corners: ambient coordinates, once each.
    pub fn corner_places(&self) -> impl Iterator<Item = [f64; 3]> {
        let mesh = self.layout.mesh();
        let inside = |v: VertexId| mesh.outgoing(v).find(|&h| !mesh.is_outside(h));
        self.corners.iter().filter_map(move |corner| Some(self.layout.corner(inside(corner.0)?)))
    }

    /// How many of the generators, and of the elements of the sides of the layout and of the Dirichlet domain, are no translations.
    fn not_hyperbolic(&self) -> usize {
        let sides = self.deck.sides.iter().chain(self.domain().into_iter().flat_map(|d| &d.sides));
        let motions = self.deck.generators.iter().chain(sides.map(|g| &g.motion));
        let exceeds_one = |x: f64| x.abs().partial_cmp(&1.0) == Some(Ordering::Greater);
        motions.filter(|g| !exceeds_one(f64::from(g.half_trace()))).count()
    }
}

/// The words that the run asks for, with the lengths of their closed geodesics.
fn geodesics(task: &Task<'_>, deck: &DeckGroup) -> Result<Vec<(String, f64)>, Failure> {
    let words = task.args.boundary.words(&deck.group)?;
    let length = |(text, word): (&String, &Word)| Ok((text.clone(), deck.motion(word)?.translation_length()));
    task.args.boundary.lengths.iter().zip(&words).map(length).collect()
}

/// The layout of a quotient on the surface as it was given, cut open at the base vertex, which is then moved with the layout.
fn on_surface(
    task: &Task<'_>,
    solved: &mut Solved,
    layout: &Layout,
    (base, placement): (VertexId, Motion<DoubleDouble>),
) -> ricci::Result<Laid> {
    let (mut seconds, solution, control) = (solved.seconds, &solved.solution, task.control);
    let refinement = match layout.refinement() {
        Some(refinement) => refinement.clone(),
        None => Arc::new(timed(&mut seconds.refine, || solution.refinement(control))?),
    };
    let laid = timed(&mut seconds.layout, || -> ricci::Result<Laid> {
        let refined = match layout.refinement() {
            Some(_) => layout.clone(),
            None => layout.on_refinement(&refinement, solution.metric(), control)?,
        };
        let mut laid = Laid::new(task.input, &solved.solution, refined)?;
        if task.needs.on_input {
            let (cones, root) = (Some(Vec::new()), Some(base));
            let refinement = Some(refinement);
            let options = LayoutOptions { cones, root, refinement, ..LayoutOptions::default() };
            let mut along_edges = Layout::of_solution(solution, &options, control)?;
            if along_edges.space == Space::E2 {
                along_edges.move_by(&placement)?;
            }
            laid.on_input = along_edges.on_input();
        }
        Ok(laid)
    });
    solved.seconds = seconds;
    laid
}
