//! A closed surface of genus 0 on the unit sphere.

use super::args::CanonicalArgs;
use super::quotient::base;
use crate::failure::Failure;
use crate::input::Input;
use crate::job::GAUSS_BONNET;
use crate::options::MethodChoice;
use crate::report::{Attempts, Checks, Seconds, timed};
use ricci::Control;
use ricci::canonical::{Sphere, SphereOptions, SphereReport, uniformize_sphere};
use ricci::embed::layout_in_space;
use ricci::flow::{Report, SurfaceFlow};
use ricci::geometry::{Space, largest, worse};
use ricci::mesh::{FaceId, PerEdge, PerVertex, Point, VertexId};
use ricci::metric::{Curvature, Refinement, SurfaceMetric};
use std::sync::Arc;

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
    /// By the gradient flow in S², which moves no vertex to the middle.
    Flow(Box<Report>),
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
    /// The way back to the given triangulation.
    pub refinement: Refinement,
    pub failed: Attempts,
    pub seconds: Seconds,
}

/// Uniformize a closed surface of genus 0.
pub fn round(input: &Input, args: &CanonicalArgs, control: &Control) -> Result<Round, Failure> {
    let mut seconds = Seconds { read: input.seconds_read, build: input.seconds_build, ..Seconds::default() };
    let (way, metric, positions) = match args.solve.method {
        MethodChoice::Newton => timed(&mut seconds.solve, || punctured(input, args, control))?,
        MethodChoice::Gradient => timed(&mut seconds.solve, || flowed(input, args, control))?,
    };
    let failed = |error: ricci::Error| match error {
        ricci::Error::Cancelled => Failure::Cancelled,
        error => Failure::Failed(error.to_string()),
    };
    let refinement = timed(&mut seconds.refine, || metric.refinement(control)).map_err(failed)?;
    let tolerance = match &way {
        Way::Puncture(_) => args.solve.tolerance,
        Way::Flow(report) => report.tolerance,
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

fn punctured(
    input: &Input,
    args: &CanonicalArgs,
    control: &Control,
) -> Result<(Way, SurfaceMetric, PerVertex<Point>), Failure> {
    if input.mesh.n_vertices() < 4 {
        let path = input.path.display();
        let why = "a sphere of fewer than four vertices is no polyhedron; cut each triangle into four";
        return Err(Failure::Input(format!("{path}: {why}")));
    }
    let options = SphereOptions {
        tolerance: args.solve.tolerance,
        max_iterations: args.solve.max_iterations.map_or(0, |n| n as usize),
        puncture: base(input, args)?,
        threads: args.common.threads(),
    };
    let (mesh, lengths) = (Arc::new(input.mesh.clone()), Arc::new(input.lengths.clone()));
    let Sphere { metric, positions, report, .. } =
        uniformize_sphere(mesh, lengths, input.geometry, &options, control)?;
    Ok((Way::Puncture(Box::new(report)), metric, positions))
}

fn flowed(
    input: &Input,
    args: &CanonicalArgs,
    control: &Control,
) -> Result<(Way, SurfaceMetric, PerVertex<Point>), Failure> {
    let Input { mesh, lengths, geometry, .. } = input;
    let options = args.solve.options(args.common.threads());
    let scheme = args.solve.scheme.into();
    let mut flow = SurfaceFlow::new(mesh, lengths, *geometry, scheme, Space::S2, &[], &options, control)?;
    let report = flow.solve(&PerVertex::filled(mesh.n_vertices(), 0.0), control)?;
    let metric = flow.now();
    let root = base(input, args)?.unwrap_or(VertexId(0));
    let layout = layout_in_space(metric.mesh(), metric.metric(), root, None, control)?;
    let mut positions = PerVertex::filled(mesh.n_vertices(), [0.0, 0.0, 1.0]);
    for h in metric.mesh().halfedges().filter(|&h| !metric.mesh().is_outside(h)) {
        positions[metric.mesh().origin(h)] = layout.corner(h);
    }
    Ok((Way::Flow(Box::new(report)), metric, positions))
}

impl Round {
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

    /// Corners of the pieces of the common refinement on the sphere.
    pub fn piece(&self, f: FaceId) -> [Point; 3] {
        let corners =
            self.metric.mesh().face_vertices(self.refinement.final_face[f]).map(|v| self.positions[v]);
        self.refinement.final_barycentric(f).map(|w| {
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
            Way::Flow(report) => report.converged,
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
        checks.add("max_curvature_error", self.curvature_error(), self.tolerance);
        checks
    }
}
