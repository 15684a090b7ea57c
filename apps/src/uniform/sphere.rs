//! A closed surface of genus 0 on the unit sphere.

use super::args::CanonicalArgs;
use super::quotient::{known, told};
use super::request::Needs;
use crate::failure::Failure;
use crate::input::Input;
use crate::job::GAUSS_BONNET;
use crate::report::{Attempts, Checks, Seconds, timed};
use ricci::Control;
use ricci::canonical::{Sphere, SphereReport};
use ricci::embed::{Layout, layout_of};
use ricci::flow::{Report, SurfaceFlow};
use ricci::geometry::{Space, largest, worse};
use ricci::mesh::{FaceId, PerEdge, PerVertex, Point, VertexId};
use ricci::metric::{Curvature, Refinement, SurfaceMetric};

/// Edges are Delaunay and the outline of the plane is convex to this, radians; the centre of mass is in the middle to this.
const DELAUNAY: f64 = 1e-9;
const CENTRING: f64 = 1e-9;
/// Positions with a range of u below this are convex to [`CONVEX`]: beyond it they run out of digits.
const RANGE: f64 = 30.0;
const CONVEX: f64 = 1e-12;
/// Faces with a longest edge below this are a point to their positions.
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
    pub metric: SurfaceMetric,
    pub positions: PerVertex<Point>,
    pub curvature: Curvature,
    pub lengths: PerEdge<f64>,
    pub target: PerVertex<f64>,
    /// The way back to the given triangulation, where an output needs it, or why there is none.
    pub refinement: Option<Result<Refinement, String>>,
    pub failed: Attempts,
    pub seconds: Seconds,
}

/// How a sphere was found, its metric, and where its vertices are.
pub type Found = (Way, SurfaceMetric, PerVertex<Point>);

/// What [`ricci::canonical::uniformize()`] found.
pub fn punctured(sphere: Sphere) -> Found {
    let Sphere { metric, positions, report, .. } = sphere;
    (Way::Puncture(Box::new(report)), metric, positions)
}

/// By the gradient flow in S², laid out from a vertex.
pub fn flowed(
    input: &Input,
    args: &CanonicalArgs,
    base: Option<VertexId>,
    control: &Control,
) -> Result<Found, Failure> {
    let Input { mesh, lengths, geometry, .. } = input;
    let options = args.solve.options(args.common.threads());
    let scheme = args.solve.scheme.into();
    let mut flow = SurfaceFlow::new(mesh, lengths, *geometry, scheme, Space::S2, &[], &options, control)?;
    let report = flow.solve(&PerVertex::filled(mesh.n_vertices(), 0.0), control)?;
    let metric = flow.now();
    let root = base.unwrap_or(VertexId(0));
    let layout = layout_of(metric.mesh(), metric.metric(), Some(root), None, control)?;
    let mut positions = PerVertex::filled(mesh.n_vertices(), [0.0, 0.0, 1.0]);
    for h in metric.mesh().halfedges().filter(|&h| !metric.mesh().is_outside(h)) {
        positions[metric.mesh().origin(h)] = layout.corner(h);
    }
    Ok((Way::Flow(Box::new(report), Box::new(layout)), metric, positions))
}

impl Round {
    /// A sphere with what is said of it. `taken`: seconds until it was found.
    pub fn new(
        input: &Input,
        args: &CanonicalArgs,
        (way, metric, positions): Found,
        taken: f64,
        needs: Needs,
        control: &Control,
    ) -> Result<Round, Failure> {
        let flow = match &way {
            Way::Puncture(report) => &report.seconds,
            Way::Flow(report, _) => &report.seconds,
        };
        let mut seconds = Seconds::new(input, flow);
        seconds.layout = taken - flow.total;
        let failed = |error: ricci::Error| Failure::Failed(error.to_string());
        let refinement = match needs.refinement {
            true => Some(told(timed(&mut seconds.refine, || metric.refinement(control)))?),
            false => None,
        };
        let tolerance = match &way {
            Way::Puncture(_) => args.solve.tolerance,
            Way::Flow(report, _) => report.tolerance,
        };
        Ok(Round {
            way,
            tolerance,
            curvature: metric.curvature().map_err(failed)?,
            lengths: metric.metric().lengths(metric.mesh()).map_err(failed)?,
            target: PerVertex::filled(input.mesh.n_vertices(), 0.0),
            metric,
            positions,
            refinement,
            failed: Attempts::default(),
            seconds,
        })
    }

    /// max |K| of the spherical metric.
    pub fn curvature_error(&self) -> f64 {
        largest(self.curvature.at.iter())
    }

    /// Faces seen from inside the sphere, those too small to tell left out.
    pub fn inward(&self) -> usize {
        let is_inward = |f: &FaceId| {
            let [a, b, c] = self.corners(*f);
            // From the differences: the determinant of nearly equal vectors would cancel.
            let [p, q] = [b, c].map(|x| [0, 1, 2].map(|k| x[k] - a[k]));
            let n = [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
            !self.is_point(*f) && (0..3).map(|k| n[k] * (a[k] + b[k] + c[k])).sum::<f64>() <= 0.0
        };
        self.metric.mesh().faces().filter(is_inward).count()
    }

    /// Faces whose positions in doubles cannot be told from a point.
    pub fn points(&self) -> usize {
        self.metric.mesh().faces().filter(|f| self.is_point(*f)).count()
    }

    fn is_point(&self, f: FaceId) -> bool {
        let [a, b, c] = self.corners(f);
        let far = |p: Point, q: Point| (0..3).map(|k| (p[k] - q[k]).powi(2)).sum::<f64>().sqrt();
        far(a, b).max(far(b, c)).max(far(c, a)) < POINT
    }

    fn corners(&self, f: FaceId) -> [Point; 3] {
        self.metric.mesh().face_vertices(f).map(|v| self.positions[v])
    }

    /// The way back to the given triangulation, if there is one.
    pub fn refinement(&self) -> Result<&Refinement, Failure> {
        known(&self.refinement)
    }

    /// Corners of a piece of the common refinement on the sphere.
    pub fn piece(&self, refinement: &Refinement, f: FaceId) -> [Point; 3] {
        let corners = self.metric.mesh().face_vertices(refinement.final_face[f]).map(|v| self.positions[v]);
        refinement.final_barycentric(f).map(|w| {
            let p = [0, 1, 2].map(|k| (0..3).map(|i| w[i] * corners[i][k]).sum::<f64>());
            let length = p[0].hypot(p[1]).hypot(p[2]);
            p.map(|x| x / length)
        })
    }

    /// What the result is held against.
    pub fn checks(&self) -> Checks {
        let mut checks = Checks::default();
        checks.add("gauss_bonnet", self.curvature.gauss_bonnet, GAUSS_BONNET);
        checks.add("broken_triangles", self.curvature.broken.len() as f64, 0.0);
        checks.add("flipped_triangles", self.inward() as f64, 0.0);
        let converged = match &self.way {
            Way::Puncture(report) => report.converged,
            Way::Flow(report, _) => report.converged,
        };
        checks.add("unconverged", f64::from(u8::from(!converged)), 0.0);
        if let Way::Puncture(report) = &self.way {
            checks.add("planar_curvature_error", report.max_curvature_error, self.tolerance);
            checks.add("delaunay_violation", report.delaunay_violation, DELAUNAY);
            checks.add("outline_bends_inward", worse(-report.link_turning, 0.0), DELAUNAY);
            checks.add("centring", report.centring, CENTRING);
            if report.u_range < RANGE {
                checks.add("nonconvexity", report.nonconvexity, CONVEX);
            }
        }
        if let Way::Flow(_, layout) = &self.way {
            let errors = self.curvature.at.iter().map(|k| k.abs()).sum();
            checks.add("layout_consistency", layout.consistency(), layout.consistency_limit(errors));
        }
        checks.add("max_curvature_error", self.curvature_error(), self.tolerance);
        if let Some(refinement) = &self.refinement {
            checks.add("without_refinement", f64::from(u8::from(refinement.is_err())), 0.0);
        }
        checks
    }
}
