//! Searches for a vertex to puncture the surface at: flows from one vertex after the other, until one succeeds.

use super::puncture::{PlaneGoal, PlaneReport, PlaneSolver};
use super::star::{FLAT_POLYHEDRON, NEARLY_FLAT, PuncturedSurface};
use crate::error::{Error, Result};
use crate::geometry::worse;
use crate::mesh::{Mesh, PerVertex, VertexId};
use crate::topology::{farthest_vertices, shortest_paths};

/// The goal for the first plane. It is only used to find the best vertex, so its outline may turn the wrong way a little.
const FIRST_PLANE: PlaneGoal = PlaneGoal { straight: 1e-4, slivers: false };
/// The goal for the last plane: its outline is convex up to rounding.
const LAST_PLANE: PlaneGoal = PlaneGoal { straight: 1e-12, slivers: true };
/// Largest number of vertices that are tried, first from a guess, then from the first plane, until the flow from one succeeds.
const TRIES: usize = 8;
/// Largest number of Newton steps from the first plane to the plane seen from another vertex. One is usual; narrow angles take some more.
const STEPS_FROM_A_PLANE: usize = 60;

/// A punctured surface with its plane and the report of the flow.
#[derive(Clone)]
pub(super) struct FoundPlane {
    pub surface: PuncturedSurface,
    pub plane: PerVertex<[f64; 2]>,
    pub found: PlaneReport,
}

impl FoundPlane {
    /// Largest excess over π of the angles at an edge, or turning of the outline the wrong way.
    fn violation(&self) -> Result<f64> {
        Ok(worse(self.surface.delaunay_violation()?, -self.found.turning))
    }

    fn is_good(&self, goal: PlaneGoal) -> Result<bool> {
        Ok(self.found.converged && self.violation()? <= goal.straight)
    }

    /// Largest error of the curvature, or violation of the conditions on angles and outline.
    fn error(&self) -> Result<f64> {
        Ok(worse(self.found.error, self.violation()?))
    }
}

/// The search: the flows so far, and the data that all of them use.
pub(super) struct PunctureSearch<'a> {
    /// Flows that were started.
    pub flows: usize,
    /// True if all vertices lie on one circle.
    is_flat: bool,
    /// Weights of the vertices, for the centring.
    pub weights: &'a PerVertex<f64>,
    /// True at vertices that may be sent to infinity.
    may: PerVertex<bool>,
    pub solver: PlaneSolver<'a>,
}

impl<'a> PunctureSearch<'a> {
    /// A search without flows yet.
    pub fn new(weights: &'a PerVertex<f64>, solver: PlaneSolver<'a>) -> PunctureSearch<'a> {
        let may = PerVertex::filled(weights.len(), true);
        PunctureSearch { flows: 0, is_flat: false, weights, may, solver }
    }

    /// The search among the vertices that `may` be sent to infinity.
    pub fn only(self, may: PerVertex<bool>) -> PunctureSearch<'a> {
        PunctureSearch { may, ..self }
    }

    /// The plane with this vertex at infinity.
    pub fn punctured_at(&mut self, begin: &PuncturedSurface, v: VertexId) -> Result<FoundPlane> {
        let first = self.guessed(begin, &[v], None)?;
        self.first_good([Ok(first.surface.clone())], Some(&first), LAST_PLANE)
    }

    /// The plane with a small range of u and no narrow angles. A first plane is used to find the best vertex for it.
    pub fn best(&mut self, begin: &PuncturedSurface) -> Result<FoundPlane> {
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
        let FoundPlane { surface, plane, .. } = &first;
        let control = self.solver.control;
        control.check()?;
        let view = surface.centre(plane, self.weights)?;
        control.check()?;
        let centred = PerVertex::from_fn(plane.len(), |v| view.apply(plane[v]));
        let u = surface.spherical(&centred, view.scale.ln()).u;
        let seen_from = |v: VertexId| {
            let mut moved = surface.clone();
            if v != surface.at {
                moved.puncture(v, plane);
            }
            Ok(moved)
        };
        let candidates = surface.candidates(plane, &u, &self.may, control)?;
        self.first_good(candidates.into_iter().take(TRIES).map(seen_from), Some(&first), LAST_PLANE)
    }

    /// A plane whose outline is nearly convex, with the first of the vertices at infinity from which the flow succeeds. The guess adds
    /// −2 log(distance) to u: the inversion of a surface that is nearly a plane.
    fn guessed(
        &mut self,
        begin: &PuncturedSurface,
        vertices: &[VertexId],
        known: Option<&FoundPlane>,
    ) -> Result<FoundPlane> {
        let (lengths, control) = (begin.metric.lengths(&begin.mesh)?, self.solver.control);
        let guess = |&v: &VertexId| {
            let distance = shortest_paths(&begin.mesh, &lengths, [v], control)?.distance;
            let mut surface = PuncturedSurface { at: v, ..begin.clone() };
            let u = |i| if i == v { 0.0 } else { begin.metric.u[i] - 2.0 * distance[i].ln() };
            surface.metric.u = PerVertex::from_fn(distance.len(), u);
            Ok(surface)
        };
        self.first_good(vertices.iter().map(guess), known, FIRST_PLANE)
    }

    /// The result of the first flow that reaches the goal; if none does, the one with the least error, `known` included.
    ///
    /// # Errors
    ///
    /// [`Error::Layout`] where all vertices lie on one circle, or no flow came to a plane; [`Error::Cancelled`].
    fn first_good(
        &mut self,
        surfaces: impl IntoIterator<Item = Result<PuncturedSurface>>,
        known: Option<&FoundPlane>,
        goal: PlaneGoal,
    ) -> Result<FoundPlane> {
        let none =
            |why: &str| Error::Layout(format!("no plane was found from any vertex that was tried: {why}"));
        let (mut best, mut failure) = (known.cloned(), none("the step limit came first"));
        for surface in surfaces {
            if self.solver.left() == 0 {
                break;
            }
            let mut surface = surface?;
            let end = self.flow(&mut surface, goal);
            // After a flow that failed, lengths may be beyond the range of f64; the surface then does not count as flat.
            let is_flat = |within| matches!(surface.is_flat(within), Ok(true));
            let [flat, nearly_flat] = [FLAT_POLYHEDRON, NEARLY_FLAT].map(is_flat);
            match end {
                Err(Error::Cancelled) => return Err(Error::Cancelled),
                _ if flat => {
                    self.is_flat = true;
                    return Err(on_a_circle(&surface.mesh));
                }
                Ok((plane, found)) => {
                    let flat = FoundPlane { surface, plane, found };
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

    /// One flow. From a guess it takes half of the remaining steps at most, but [`STEPS_FROM_A_PLANE`] at least, so that steps remain for
    /// other vertices.
    fn flow(
        &mut self,
        surface: &mut PuncturedSurface,
        goal: PlaneGoal,
    ) -> Result<(PerVertex<[f64; 2]>, PlaneReport)> {
        self.flows += 1;
        let left = self.solver.left();
        let most = if goal.slivers { STEPS_FROM_A_PLANE } else { STEPS_FROM_A_PLANE.max(left / 2) };
        let found = surface.flatten(goal, most.min(left), &mut self.solver)?;
        Ok((surface.unfold(self.solver.control)?, found))
    }
}

/// The text of an error, for use in another one.
pub(super) fn said(error: Error) -> String {
    match error {
        Error::Layout(why) => why,
        error => error.to_string(),
    }
}

/// The error of a polyhedron without volume.
pub(super) fn on_a_circle(mesh: &Mesh) -> Error {
    Error::Layout(format!(
        "all {} vertices come to lie on one circle, as those of the double of a plane polygon: no polyhedron with an inside has them for \
         corners. Put vertices inside the faces (cut each triangle into four, `ricci refine --levels 1`)",
        mesh.n_vertices()
    ))
}
