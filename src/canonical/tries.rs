//! Flows from one vertex after the other, until one ends well.

use super::puncture::{Found, Goal, Solver};
use super::star::{FLAT_POLYHEDRON, NEARLY_FLAT, Punctured};
use crate::error::{Error, Result};
use crate::geometry::worse;
use crate::mesh::{Mesh, PerVertex, VertexId};
use crate::topology::{farthest_vertices, shortest_paths};

/// The first plane is only used to find the vertex from which the plane is best, so that its outline may turn the wrong way a little.
const FIRST_PLANE: Goal = Goal { straight: 1e-4, slivers: false };
/// The last plane: its outline is convex but for rounding.
const LAST_PLANE: Goal = Goal { straight: 1e-12, slivers: true };
/// Most vertices that are tried, first from a guess, then from the plane that was found, until the flow from one ends well.
const TRIES: usize = 8;
/// Most Newton steps from the first plane to the plane seen from another vertex. One is usual; narrow angles take some more.
const STEPS_FROM_A_PLANE: usize = 60;

/// A punctured surface, its plane, and how it was found.
#[derive(Clone)]
pub(super) struct Flat {
    pub surface: Punctured,
    pub plane: PerVertex<[f64; 2]>,
    pub found: Found,
}

impl Flat {
    /// By how much angles at an edge exceed π, or the outline turns the wrong way, at most.
    fn violation(&self) -> Result<f64> {
        Ok(worse(self.surface.delaunay_violation()?, -self.found.turning))
    }

    fn is_good(&self, goal: Goal) -> Result<bool> {
        Ok(self.found.converged && self.violation()? <= goal.straight)
    }

    /// By how much it is off a plane with a convex outline, at most.
    fn error(&self) -> Result<f64> {
        Ok(worse(self.found.error, self.violation()?))
    }
}

/// The flows that were started so far, and what they need.
pub(super) struct Tried<'a> {
    /// Flows that were started.
    pub flows: usize,
    /// All vertices lie on one circle.
    is_flat: bool,
    /// Of the vertices, for the centring.
    pub weights: &'a PerVertex<f64>,
    /// Which vertices may be sent to infinity.
    may: PerVertex<bool>,
    pub solver: Solver<'a>,
}

impl<'a> Tried<'a> {
    /// Nothing yet.
    pub fn new(weights: &'a PerVertex<f64>, solver: Solver<'a>) -> Tried<'a> {
        let may = PerVertex::filled(weights.len(), true);
        Tried { flows: 0, is_flat: false, weights, may, solver }
    }

    /// Only vertices that `may` are sent to infinity.
    pub fn only(self, may: PerVertex<bool>) -> Tried<'a> {
        Tried { may, ..self }
    }

    /// The plane with this vertex at infinity.
    pub fn punctured_at(&mut self, begin: &Punctured, v: VertexId) -> Result<Flat> {
        let first = self.guessed(begin, &[v], None)?;
        self.first_good([Ok(first.surface.clone())], Some(&first), LAST_PLANE)
    }

    /// The plane with a small range of u and no narrow angles: from any plane, the one that is best seen from there.
    pub fn best(&mut self, begin: &Punctured) -> Result<Flat> {
        let widest = begin.widest(&self.may);
        let first = match self.guessed(begin, &[widest], None) {
            Ok(first) if first.found.converged => first,
            Err(error) if self.is_flat || error == Error::Cancelled => return Err(error),
            known => {
                let lengths = begin.metric.lengths(&begin.mesh)?;
                let others = farthest_vertices(&begin.mesh, &lengths, widest, TRIES, self.solver.control)?;
                let others: Vec<VertexId> = others[1..].iter().copied().filter(|&v| self.may[v]).collect();
                self.guessed(begin, &others, known.ok().as_ref())?
            }
        };
        let Flat { surface, plane, .. } = &first;
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
        let candidates = surface.candidates(plane, &u, &self.may)?;
        self.first_good(candidates.into_iter().take(TRIES).map(seen_from), Some(&first), LAST_PLANE)
    }

    /// A plane whose outline is nearly convex, from the first of the vertices from which the flow ends well. The guess adds
    /// −2 log(distance) to u: the inversion of a surface that is nearly a plane.
    fn guessed(&mut self, begin: &Punctured, vertices: &[VertexId], known: Option<&Flat>) -> Result<Flat> {
        let (lengths, control) = (begin.metric.lengths(&begin.mesh)?, self.solver.control);
        let guess = |&v: &VertexId| {
            let distance = shortest_paths(&begin.mesh, &lengths, [v], control)?.distance;
            let mut surface = Punctured { at: v, ..begin.clone() };
            let u = |i| if i == v { 0.0 } else { begin.metric.u[i] - 2.0 * distance[i].ln() };
            surface.metric.u = PerVertex::from_fn(distance.len(), u);
            Ok(surface)
        };
        self.first_good(vertices.iter().map(guess), known, FIRST_PLANE)
    }

    /// The result of the first flow that ends well; if none does, the one with the least error, `known` included.
    ///
    /// # Errors
    ///
    /// [`Error::Layout`] where all vertices lie on one circle, or no flow came to a plane; [`Error::Cancelled`].
    fn first_good(
        &mut self,
        surfaces: impl IntoIterator<Item = Result<Punctured>>,
        known: Option<&Flat>,
        goal: Goal,
    ) -> Result<Flat> {
        let none =
            |why: &str| Error::Layout(format!("no plane was found from any vertex that was tried: {why}"));
        let (mut best, mut failure) = (known.cloned(), none("the step limit came first"));
        for surface in surfaces {
            if self.solver.left() == 0 {
                break;
            }
            let mut surface = surface?;
            let end = self.flow(&mut surface, goal);
            // A surface with lengths beyond doubles, after a flow that failed, is not known to be flat.
            let is_flat = |within| matches!(surface.is_flat(within), Ok(true));
            let [flat, nearly_flat] = [FLAT_POLYHEDRON, NEARLY_FLAT].map(is_flat);
            match end {
                Err(Error::Cancelled) => return Err(Error::Cancelled),
                _ if flat => {
                    self.is_flat = true;
                    return Err(on_a_circle(&surface.mesh));
                }
                Ok((plane, found)) => {
                    let flat = Flat { surface, plane, found };
                    if flat.is_good(goal)? {
                        return Ok(flat);
                    }
                    let is_better = match &best {
                        Some(best) => flat.error()? < best.error()?,
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

    /// One flow. From a guess it takes no more than half of the steps that are left, but [`STEPS_FROM_A_PLANE`] at least, so that
    /// other vertices have their turn.
    fn flow(&mut self, surface: &mut Punctured, goal: Goal) -> Result<(PerVertex<[f64; 2]>, Found)> {
        self.flows += 1;
        let left = self.solver.left();
        let most = if goal.slivers { STEPS_FROM_A_PLANE } else { STEPS_FROM_A_PLANE.max(left / 2) };
        let found = surface.flatten(goal, most.min(left), &mut self.solver)?;
        Ok((surface.unfold(self.solver.control)?, found))
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
