//! Flows from one vertex after the other, until one ends well.

use super::puncture::{Found, Spent};
use super::star::{FLAT_POLYHEDRON, NEARLY_FLAT, Punctured};
use crate::control::Control;
use crate::error::{Error, Result};
use crate::flow::Options;
use crate::geometry::worse;
use crate::mesh::{Mesh, PerVertex, VertexId};
use crate::topology::farthest_vertices;
use crate::topology::spanning::shortest_paths_under;

/// Outlines of the first plane may turn the wrong way by this: it is only to see from which vertex the plane is best.
const ROUGHLY: f64 = 1e-4;
/// Outlines turn by minus this at least: rounding.
const STRAIGHT: f64 = 1e-12;
/// Vertices that are tried, until the flow from one ends well: first from a guess, then from the plane that was found.
const TRIES: usize = 8;
/// Newton steps from a plane that is known to the plane seen from another vertex: 1, and some where angles are narrow.
const STEPS: usize = 60;

/// A punctured surface, its plane, and how it was found.
pub(super) type Flat = (Punctured, PerVertex<[f64; 2]>, Found);

/// What was done so far, and with what.
pub(super) struct Tried<'a> {
    /// Flows that were started.
    pub flows: usize,
    /// What they have cost; their Newton steps are within the limit of the options for all of them.
    pub spent: Spent,
    /// All vertices lie on one circle.
    flat: bool,
    pub weights: &'a PerVertex<f64>,
    pub options: &'a Options,
    pub control: &'a Control,
}

impl<'a> Tried<'a> {
    /// Nothing yet; `weights` of the vertices are those of the centring.
    pub fn new(weights: &'a PerVertex<f64>, options: &'a Options, control: &'a Control) -> Tried<'a> {
        Tried { flows: 0, spent: Spent::default(), flat: false, weights, options, control }
    }

    /// The plane with this vertex at infinity.
    pub fn punctured_at(&mut self, begin: &Punctured, v: VertexId) -> Result<Flat> {
        let rough = self.guessed(begin, &[v], None)?;
        let again = [Ok(rough.0.clone())].into_iter();
        self.first_good(again, Some(rough), STRAIGHT)
    }

    /// The plane with a small range of u and no narrow angles: from any plane, the one that is best seen from there.
    pub fn best(&mut self, begin: &Punctured) -> Result<Flat> {
        let first = begin.widest();
        let rough = match self.guessed(begin, &[first], None) {
            Ok(rough) if rough.2.converged => rough,
            Err(error) if self.flat || error == Error::Cancelled => return Err(error),
            known => {
                let lengths = begin.metric.lengths(&begin.mesh)?;
                let others = farthest_vertices(&begin.mesh, &lengths, first, TRIES)?;
                self.guessed(begin, &others[1..], known.ok())?
            }
        };
        let (surface, plane, _) = &rough;
        let view = surface.centre(plane, self.weights)?;
        let centred = PerVertex::from_fn(plane.len(), |v| view.apply(plane[v]));
        let u = surface.spherical(&centred, view.scale.ln()).u;
        let seen_from = |v: VertexId| {
            let mut moved = surface.clone();
            if v != surface.at {
                moved.puncture(v, plane);
            }
            Ok(moved)
        };
        let candidates = surface.candidates(plane, &u)?;
        let moved = candidates.into_iter().take(TRIES).map(seen_from);
        self.first_good(moved, Some(rough.clone()), STRAIGHT)
    }

    /// A plane whose outline is nearly convex, from the first of the vertices from which the flow ends well. The guess is
    /// `u = −2 log(distance)`, the inversion of a surface that is nearly a plane.
    fn guessed(&mut self, begin: &Punctured, vertices: &[VertexId], known: Option<Flat>) -> Result<Flat> {
        let (lengths, control) = (begin.metric.lengths(&begin.mesh)?, self.control);
        let guess = |&v: &VertexId| {
            let distance = shortest_paths_under(&begin.mesh, &lengths, [v], control)?.distance;
            let mut surface = Punctured { at: v, ..begin.clone() };
            let u = |i| if i == v { 0.0 } else { -2.0 * distance[i].ln() };
            surface.metric.u = PerVertex::from_fn(distance.len(), u);
            Ok(surface)
        };
        self.first_good(vertices.iter().map(guess), known, ROUGHLY)
    }

    /// The first flow that ends well, or the one of them and of what was `known` that is least off. Errors: [`Error::Layout`] where all
    /// vertices lie on one circle, or no flow came to a plane; [`Error::Cancelled`].
    fn first_good(
        &mut self,
        surfaces: impl Iterator<Item = Result<Punctured>>,
        known: Option<Flat>,
        straight: f64,
    ) -> Result<Flat> {
        let mut best = known;
        let off =
            |(surface, _, found): &Flat| -> Result<f64> { Ok(worse(found.error, surface.violation(found)?)) };
        let none =
            |why: &str| Error::Layout(format!("no plane was found from any vertex that was tried: {why}"));
        let mut failure = none("the step limit came first");
        for surface in surfaces {
            let left = self.left();
            if left == 0 {
                break;
            }
            let mut surface = surface?;
            let ended = self.flow(&mut surface, straight, left);
            // A surface with lengths beyond doubles, after a flow that failed, is not known to be flat.
            let is_flat = |within| matches!(surface.is_flat(within), Ok(true));
            let [flat, nearly_flat] = [FLAT_POLYHEDRON, NEARLY_FLAT].map(is_flat);
            match ended {
                Err(Error::Cancelled) => return Err(Error::Cancelled),
                _ if flat => {
                    self.flat = true;
                    return Err(on_a_circle(&surface.mesh));
                }
                Ok((plane, found)) => {
                    let flat = (surface, plane, found);
                    if flat.2.converged && flat.0.violation(&flat.2)? <= straight {
                        return Ok(flat);
                    }
                    let is_better = match &best {
                        Some(best) => off(&flat)? < off(best)?,
                        None => true,
                    };
                    if is_better {
                        best = Some(flat);
                    }
                }
                Err(_) if nearly_flat => failure = on_a_circle(&surface.mesh),
                Err(error) => failure = none(&said(error)),
            }
        }
        best.ok_or(failure)
    }

    /// Newton steps that are left of the limit for all flows.
    pub fn left(&self) -> usize {
        self.options.iteration_limit().saturating_sub(self.spent.iterations)
    }

    /// One flow: of a guess it takes no more than half of what is left, so that other vertices have their turn, but [`STEPS`] at least.
    fn flow(
        &mut self,
        surface: &mut Punctured,
        straight: f64,
        left: usize,
    ) -> Result<(PerVertex<[f64; 2]>, Found)> {
        self.flows += 1;
        let most = if straight < ROUGHLY { STEPS } else { STEPS.max(left / 2) }.min(left);
        let spent = &mut self.spent;
        let found = surface.flatten(straight, straight < ROUGHLY, most, spent, self.options, self.control)?;
        Ok((surface.lay_out(self.control)?, found))
    }
}

/// An error's words inside another.
pub(super) fn said(error: Error) -> String {
    match error {
        Error::Layout(why) => why,
        error => error.to_string(),
    }
}

/// The error of a polyhedron without inside.
pub(super) fn on_a_circle(mesh: &Mesh) -> Error {
    Error::Layout(format!(
        "all {} vertices come to lie on one circle, as those of the double of a plane polygon: no polyhedron with an inside has them for \
         corners. Put vertices inside the faces (cut each triangle into four)",
        mesh.n_vertices()
    ))
}

impl Punctured {
    /// By how much angles at an edge exceed π, or the outline turns the wrong way, at most.
    fn violation(&self, found: &Found) -> Result<f64> {
        Ok(worse(self.delaunay_violation()?, -found.turning))
    }

    /// The vertex whose shortest edge is the longest.
    fn widest(&self) -> VertexId {
        let near = |v| self.mesh.outgoing(v).map(|arc| self.bound(arc)).fold(f64::NEG_INFINITY, f64::max);
        let better = |(best, least), v| if near(v) < least { (v, near(v)) } else { (best, least) };
        self.mesh.vertices().fold((VertexId(0), f64::INFINITY), better).0
    }
}
