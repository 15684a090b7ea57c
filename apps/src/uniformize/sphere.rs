//! A closed surface of genus 0 on the unit sphere.

use super::task::CanonicalTask;
use crate::failure::{Failure, or_reason, required};
use crate::report::{Checks, timed};
use crate::runner::CommandRun;
use crate::solved::SolvedMetric;
use ricci::canonical::{FlowedSphere, Sphere, SphereReport};
use ricci::embed::Layout;
use ricci::flow::{Report, Solution};
use ricci::geometry::vector::{add, distance, dot, triangle_normal};
use ricci::geometry::worse;
use ricci::mesh::{FaceId, Mesh, PerVertex, Point};
use ricci::metric::CommonSubdivision;

/// Most that an angle may miss the Delaunay condition of an edge, or convexity of the plane's outline, radians: ten times the default
/// tolerance of the flow, whose curvature errors are the cause.
const DELAUNAY: f64 = 1e-9;
/// Largest distance of the centre of mass from the centre of the unit sphere.
const CENTRING: f64 = 1e-9;
/// Range of u up to which the polyhedron is checked for convexity: e^30 leaves positions three of their sixteen digits.
const CHECKED_RANGE: f64 = 30.0;
/// Largest height of a vertex over the plane of a face next to one of its own faces, in radii of the sphere.
const CONVEX: f64 = 1e-12;
/// Length of the longest edge below which a face on the unit sphere counts as a point: the rounding of positions, 1e-16, is then 1e-4 of
/// that length.
const POINT: f64 = 1e-12;

/// The method by which a sphere was found, with its report.
pub enum SphereSolution {
    /// The flow of the punctured sphere in the plane.
    Puncture(Box<SphereReport>),
    /// The gradient flow in S², which does not centre the sphere; with its layout.
    Flow(Box<Report>, Box<Layout>),
}

/// A surface on the unit sphere.
pub struct SphereSurface {
    pub method: SphereSolution,
    /// The limit of max |K|.
    pub tolerance: f64,
    pub solved: SolvedMetric,
    pub positions: PerVertex<Point>,
    /// The common subdivision with the given triangulation, where an output needs it, or the reason why there is none.
    pub subdivision: Option<Result<CommonSubdivision, String>>,
}

/// A sphere as the library found it.
pub struct FoundSphere {
    method: SphereSolution,
    metric: Solution,
    positions: PerVertex<Point>,
}

/// A sphere that was found by a puncture.
pub fn punctured(sphere: Sphere) -> FoundSphere {
    let Sphere { metric, positions, report, .. } = sphere;
    FoundSphere { method: SphereSolution::Puncture(Box::new(report)), metric, positions }
}

/// A sphere that was found by the gradient flow in S².
pub fn flowed(sphere: FlowedSphere) -> FoundSphere {
    let FlowedSphere { metric, report, layout, positions, .. } = sphere;
    FoundSphere { method: SphereSolution::Flow(Box::new(report), Box::new(layout)), metric, positions }
}

impl SphereSurface {
    /// `taken`: the seconds until the sphere was found.
    pub fn new(
        task: &CanonicalTask<'_>,
        found: FoundSphere,
        taken: f64,
        run: &mut CommandRun<'_>,
    ) -> Result<SphereSurface, Failure> {
        let FoundSphere { method, metric, positions } = found;
        let seconds = &mut run.seconds;
        let (flow, tolerance) = match &method {
            SphereSolution::Puncture(report) => (&report.seconds, task.args.to.solve.tolerance),
            SphereSolution::Flow(report, _) => (&report.seconds, report.allowed_error()),
        };
        seconds.add_flow(flow);
        seconds.layout = taken - flow.total;
        let refine = || metric.common_subdivision(task.control);
        let subdivision =
            if task.needs.subdivision { Some(or_reason(timed(&mut seconds.refine, refine))?) } else { None };
        let solved = SolvedMetric::new(metric, None)?;
        Ok(SphereSurface { method, tolerance, solved, positions, subdivision })
    }

    /// The triangulation on the sphere.
    pub fn mesh(&self) -> &Mesh {
        self.solved.solution.mesh()
    }

    /// The number of faces that are seen from inside the sphere, without those too small to tell.
    pub fn inward(&self) -> usize {
        let is_inward = |f: &FaceId| {
            let [a, b, c] = self.corners(*f);
            // The sign is found from differences, because the determinant of nearly equal vectors cancels.
            !self.is_point(*f) && dot(triangle_normal([a, b, c]), add(add(a, b), c)) <= 0.0
        };
        self.mesh().faces().filter(is_inward).count()
    }

    /// The number of faces whose positions cannot be told from a point in floating-point numbers.
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

    /// The common subdivision with the given triangulation, if there is one.
    pub fn common_subdivision(&self) -> Result<&CommonSubdivision, Failure> {
        required(&self.subdivision)
    }

    /// The corners of a piece of the common subdivision on the sphere.
    pub fn piece(&self, subdivision: &CommonSubdivision, f: FaceId) -> [Point; 3] {
        let corners = self.mesh().face_vertices(subdivision.faces[1][f]).map(|v| self.positions[v]);
        subdivision.barycentric(1, f).map(|w| {
            let p = [0, 1, 2].map(|k| (0..3).map(|i| w[i] * corners[i][k]).sum::<f64>());
            let length = p[0].hypot(p[1]).hypot(p[2]);
            p.map(|x| x / length)
        })
    }

    pub fn checks(&self) -> Checks {
        let mut checks = self.solved.checks(self.tolerance);
        checks.add("flipped_triangles", self.inward() as f64, 0.0);
        let converged = match &self.method {
            SphereSolution::Puncture(report) => report.converged,
            SphereSolution::Flow(report, _) => report.converged(),
        };
        checks.add("unconverged", f64::from(u8::from(!converged)), 0.0);
        if let SphereSolution::Puncture(report) = &self.method {
            checks.add("planar_curvature_error", report.max_curvature_error, self.tolerance);
            checks.add("delaunay_violation", report.delaunay_violation, DELAUNAY);
            checks.add("outline_bends_inward", worse(-report.link_turning, 0.0), DELAUNAY);
            checks.add("centring", report.centring, CENTRING);
            if report.u_range < CHECKED_RANGE {
                checks.add("nonconvexity", report.nonconvexity, CONVEX);
            }
        }
        if let SphereSolution::Flow(_, layout) = &self.method {
            let limit = layout.consistency_limit(self.solved.total_error());
            checks.add("layout_consistency", layout.consistency(), limit);
        }
        if let Some(subdivision) = &self.subdivision {
            checks.add("without_refinement", f64::from(u8::from(subdivision.is_err())), 0.0);
        }
        checks
    }
}
