//! A closed surface of genus 0 on the unit sphere.

use super::needs::Task;
use crate::failure::{Failure, known, told};
use crate::report::{Checks, Seconds, timed};
use crate::solved::Solved;
use ricci::canonical::{FlowedSphere, Sphere, SphereReport};
use ricci::embed::Layout;
use ricci::flow::{Report, Solution};
use ricci::geometry::vector::{add, distance, dot, triangle_normal};
use ricci::geometry::worse;
use ricci::mesh::{FaceId, Mesh, PerVertex, Point};
use ricci::metric::Refinement;

/// Most that an angle may miss the Delaunay condition of an edge, or convexity of the plane's outline, radians: ten times the
/// default tolerance of the flow whose curvature errors it consists of.
const DELAUNAY: f64 = 1e-9;
/// Largest distance of the centre of mass from the centre of the unit sphere.
const CENTRING: f64 = 1e-9;
/// Range of u up to which the polyhedron is checked for convexity: e^30 leaves positions three of their sixteen digits.
const CHECKED_RANGE: f64 = 30.0;
/// Most that a vertex may lie over the plane of the face next to one of its faces, in radii of the sphere.
const CONVEX: f64 = 1e-12;
/// Length below which the longest edge of a face on the unit sphere counts as a point: rounding of positions, 1e-16, is then 1e-4
/// of it.
const POINT: f64 = 1e-12;

/// How the sphere was found.
pub enum Way {
    /// By a puncture, in the plane.
    Puncture(Box<SphereReport>),
    /// By the gradient flow in S², which moves no vertex to the middle; with its layout.
    Flow(Box<Report>, Box<Layout>),
}

/// A surface on the unit sphere.
pub struct Round {
    pub way: Way,
    /// What max |K| is held against.
    pub tolerance: f64,
    pub solved: Solved,
    pub positions: PerVertex<Point>,
    /// The way back to the given triangulation, where an output needs it, or why there is none.
    pub refinement: Option<Result<Refinement, String>>,
}

/// How a sphere was found, its metric, and where its vertices are.
pub type Found = (Way, Solution, PerVertex<Point>);

/// A sphere that was found by a puncture.
pub fn punctured(sphere: Sphere) -> Found {
    let Sphere { metric, positions, report, .. } = sphere;
    (Way::Puncture(Box::new(report)), metric, positions)
}

/// A sphere that was found by the gradient flow in S².
pub fn flowed(sphere: FlowedSphere) -> Found {
    let FlowedSphere { metric, report, layout, positions, .. } = sphere;
    (Way::Flow(Box::new(report), Box::new(layout)), metric, positions)
}

impl Round {
    /// A sphere with what is said of it. `taken`: seconds until it was found.
    pub fn new(task: &Task<'_>, (way, metric, positions): Found, taken: f64) -> Result<Round, Failure> {
        let (flow, tolerance) = match &way {
            Way::Puncture(report) => (&report.seconds, task.args.to.solve.tolerance),
            Way::Flow(report, _) => (&report.seconds, report.allowed_error()),
        };
        let mut seconds = Seconds::new(task.input, flow);
        seconds.layout = taken - flow.total;
        let refine = || metric.refinement(task.control);
        let refinement = match task.needs.refinement {
            true => Some(told(timed(&mut seconds.refine, refine))?),
            false => None,
        };
        let solved = Solved::new(metric, None, seconds)?;
        Ok(Round { way, tolerance, solved, positions, refinement })
    }

    /// The triangulation on the sphere.
    pub fn mesh(&self) -> &Mesh {
        self.solved.solution.mesh()
    }

    /// Faces seen from inside the sphere, those too small to tell left out.
    pub fn inward(&self) -> usize {
        let is_inward = |f: &FaceId| {
            let [a, b, c] = self.corners(*f);
            // From the differences: the determinant of nearly equal vectors would cancel.
            !self.is_point(*f) && dot(triangle_normal([a, b, c]), add(add(a, b), c)) <= 0.0
        };
        self.mesh().faces().filter(is_inward).count()
    }

    /// Faces whose positions in doubles cannot be told from a point.
    pub fn points(&self) -> usize {
        self.mesh().faces().filter(|f| self.is_point(*f)).count()
    }

    fn is_point(&self, f: FaceId) -> bool {
        let [a, b, c] = self.corners(f);
        distance(a, b).max(distance(b, c)).max(distance(c, a)) < POINT
    }

    fn corners(&self, f: FaceId) -> [Point; 3] {
        self.mesh().face_vertices(f).map(|v| self.positions[v])
    }

    /// The way back to the given triangulation, if there is one.
    pub fn refinement(&self) -> Result<&Refinement, Failure> {
        known(&self.refinement)
    }

    /// Corners of a piece of the common refinement on the sphere.
    pub fn piece(&self, refinement: &Refinement, f: FaceId) -> [Point; 3] {
        let corners = self.mesh().face_vertices(refinement.final_face[f]).map(|v| self.positions[v]);
        refinement.final_barycentric(f).map(|w| {
            let p = [0, 1, 2].map(|k| (0..3).map(|i| w[i] * corners[i][k]).sum::<f64>());
            let length = p[0].hypot(p[1]).hypot(p[2]);
            p.map(|x| x / length)
        })
    }

    /// What the result is held against.
    pub fn checks(&self) -> Checks {
        let mut checks = self.solved.checks(self.tolerance);
        checks.add("flipped_triangles", self.inward() as f64, 0.0);
        let converged = match &self.way {
            Way::Puncture(report) => report.converged,
            Way::Flow(report, _) => report.converged(),
        };
        checks.add("unconverged", f64::from(u8::from(!converged)), 0.0);
        if let Way::Puncture(report) = &self.way {
            checks.add("planar_curvature_error", report.max_curvature_error, self.tolerance);
            checks.add("delaunay_violation", report.delaunay_violation, DELAUNAY);
            checks.add("outline_bends_inward", worse(-report.link_turning, 0.0), DELAUNAY);
            checks.add("centring", report.centring, CENTRING);
            if report.u_range < CHECKED_RANGE {
                checks.add("nonconvexity", report.nonconvexity, CONVEX);
            }
        }
        if let Way::Flow(_, layout) = &self.way {
            let limit = layout.consistency_limit(self.solved.total_error());
            checks.add("layout_consistency", layout.consistency(), limit);
        }
        if let Some(refinement) = &self.refinement {
            checks.add("without_refinement", f64::from(u8::from(refinement.is_err())), 0.0);
        }
        checks
    }
}
