//! The result of a flow: a metric of the surface, with its report, its cones and the way back to the surface as it was given.

use super::origin::{FlippedStart, FlowOrigin, check_same_size};
use super::report::Report;
use crate::archive::{in_range, stored};
use crate::control::Control;
use crate::error::{Error, Result, check_size};
use crate::mesh::{Double, EdgeId, FaceId, Mesh, NormalCoordinates, PerVertex, VertexId};
use crate::metric::common_subdivision::{
    FinalTriangulation, InputTriangulation, IntrinsicTriangulation, Triangulations,
};
use crate::metric::delaunay::boundary_fails;
use crate::metric::{Class, CommonSubdivision, Curvature, Initial, Metric, Scheme, Surface};
use crate::parallel::within;
use std::sync::Arc;

/// A metric of a surface: the one that a [`super::Flow`] has come to, or the initial one.
///
/// It lives on a triangulation of its own, [`Solution::mesh`]: that of the given surface, of its double or of the surface with caps on its
/// loops, whose first vertices are the given ones, after edge flips. Methods say in which of the two triangulations their arrays are. Clones share the arrays of the
/// surface.
#[derive(Debug, Clone)]
pub struct Solution {
    pub(super) origin: Arc<FlowOrigin>,
    pub(super) mesh: Arc<Mesh>,
    pub(super) metric: Metric,
    /// Triangulations as curves on `mesh`: that of the given edges, and that of the start if isometric flips made another one.
    /// Empty where no edge was ever to be flipped.
    pub(super) followed: Vec<NormalCoordinates>,
    pub(super) flips: usize,
    pub(super) reached: Option<ReachedTarget>,
    pub(super) threads: usize,
}
stored!(sections Solution { origin, mesh, metric, followed, flips, reached } without { threads } check Solution::check_parts);

/// The target of a flow and its report.
#[derive(Debug, Clone)]
pub(super) struct ReachedTarget {
    pub report: Report,
    /// Per given vertex; at pinned vertices the resulting curvature.
    pub target: PerVertex<f64>,
    pub cones: Vec<VertexId>,
    /// [`Solution::is_one_piece`].
    pub is_one_piece: bool,
}
stored!(sections ReachedTarget { report, target, cones, is_one_piece });

impl Solution {
    /// Checks that the arrays of an archive fit each other.
    fn check_parts(&self) -> Result<()> {
        check_same_size(&self.mesh, self.origin.before_flips())?;
        self.metric.check_sizes(&self.mesh)?;
        self.followed.iter().try_for_each(|normal| normal.check_size(&self.mesh))?;
        let Some(ReachedTarget { report, target, cones, .. }) = &self.reached else { return Ok(()) };
        let n = self.given().n_vertices();
        check_size("target", target.len(), n)?;
        let named = report.obstruction.iter().flat_map(|found| &found.vertices);
        let named = named.chain(report.worst.iter().map(|(v, _)| v)).chain(cones);
        in_range("vertex", named.map(|v| v.index()), self.mesh.n_vertices())
    }

    /// The initial metric of the surface in a class, on the given triangulation: no flow has been made, [`Solution::report`] is none.
    ///
    /// # Errors
    /// Those of [`crate::metric::initial_metric`].
    pub fn initial_of(surface: Surface, class: Class) -> Result<Solution> {
        Ok(Solution::start(FlowOrigin::rigid(surface, class)?))
    }

    /// The initial metric of a surface on its (weighted) Delaunay triangulation, in which `fixed` edges stay.
    ///
    /// # Errors
    /// Those of [`crate::metric::delaunay_start`].
    pub(crate) fn delaunay(
        surface: Surface,
        class: Class,
        fixed: &[EdgeId],
        control: &Control,
    ) -> Result<Solution> {
        Ok(Solution::start(FlowOrigin::delaunay(surface, class, false, fixed, control)?))
    }

    /// Copies of what flows change: triangulation, metric, and the triangulations that are followed through flips.
    pub(crate) fn parts(&self) -> (Mesh, Metric, Vec<NormalCoordinates>) {
        (Mesh::clone(&self.mesh), self.metric.clone(), self.followed.clone())
    }

    /// The same surface with another metric, to whose triangulation `flips` more flips have led.
    pub(crate) fn at(
        self,
        mesh: Mesh,
        metric: Metric,
        followed: Vec<NormalCoordinates>,
        flips: usize,
    ) -> Solution {
        let mut solution =
            Solution { mesh: Arc::new(mesh), metric, followed, flips: self.flips + flips, ..self };
        solution.share_given();
        solution
    }

    /// Hold the given mesh itself where flips have led back to it.
    pub(super) fn share_given(&mut self) {
        if !self.is_unflipped() && *self.mesh == **self.given() {
            self.mesh = self.given().clone();
        }
    }

    /// The initial metric of this origin as a solution.
    pub(super) fn start(origin: FlowOrigin) -> Solution {
        let origin = Arc::new(origin);
        let (mesh, followed) = origin.start();
        let (metric, flips) = (origin.initial.metric.clone(), origin.flips);
        Solution { mesh, metric, followed, flips, origin, reached: None, threads: 0 }
    }

    /// The initial metric from which a flow has led here.
    pub(super) fn at_start(&self) -> Solution {
        let origin = self.origin.clone();
        let (mesh, followed) = origin.start();
        let (metric, flips) = (origin.initial.metric.clone(), origin.flips);
        Solution { mesh, metric, followed, flips, origin, reached: None, threads: self.threads }
    }

    /// The surface as it was given.
    pub fn surface(&self) -> &Surface {
        &self.origin.surface
    }

    /// The given triangulation.
    pub fn given(&self) -> &Arc<Mesh> {
        self.origin.surface.mesh()
    }

    /// The class of the metric; none for a flow that began at a metric of mixed types ([`super::Flow::from_metric`]).
    pub fn class(&self) -> Option<Class> {
        self.origin.class
    }

    /// The scheme of the class.
    ///
    /// # Errors
    /// [`Error::Argument`] where there is no class.
    pub fn scheme(&self) -> Result<Scheme> {
        let none = || {
            let value = "vertices of any type".into();
            Error::Argument { what: "class of the metric", value, need: "one scheme for all vertices" }
        };
        self.class().map(|class| class.scheme).ok_or_else(none)
    }

    /// The triangulation that the metric lives on: of the surface, or of its double.
    pub fn mesh(&self) -> &Arc<Mesh> {
        &self.mesh
    }

    /// The variables of the metric on [`Solution::mesh`].
    pub fn metric(&self) -> &Metric {
        &self.metric
    }

    /// The initial metric that flows on the surface start from; on another triangulation if isometric flips came first.
    pub fn initial(&self) -> &Initial {
        &self.origin.initial
    }

    /// The double of the given surface, if the metric lives there.
    pub fn double(&self) -> Option<&Double> {
        self.origin.double.as_ref()
    }

    /// The given triangulation with caps on its loops but one, if the metric lives there: a flow to [`crate::Target::Outer`] has then
    /// flipped edges of these loops. Vertices, edges and faces of the given triangulation come first.
    pub fn caps(&self) -> Option<&Arc<Mesh>> {
        self.origin.caps.as_ref()
    }

    /// True if [`Solution::mesh`] also covers what is no part of the given surface: the mirrored half of a double, or caps.
    pub fn goes_beyond_given(&self) -> bool {
        self.double().is_some() || self.caps().is_some()
    }

    /// The report of the flow; none for an initial metric.
    pub fn report(&self) -> Option<&Report> {
        self.reached.as_ref().map(|reached| &reached.report)
    }

    /// True if a flow led here and its error is at most the tolerance asked for.
    pub fn converged(&self) -> bool {
        self.report().is_some_and(Report::converged)
    }

    /// The curvature asked for, per given vertex, at pinned vertices the resulting one, which for loops with caps is that of the surface with
    /// its caps; none for an initial metric.
    pub fn target(&self) -> Option<&PerVertex<f64>> {
        self.reached.as_ref().map(|reached| &reached.target)
    }

    /// A target on the given surface as one on [`Solution::mesh`]: on a double, curvature on both sides of the boundary adds up; on caps, and
    /// on the loops that have them, it is 0 inside and that of the metric on the boundary, where vertices are pinned.
    ///
    /// # Errors
    /// [`Error::Size`] unless the target has an entry per vertex of the given surface; with caps those of [`Metric::curvature`].
    pub fn spread_target(&self, target: &PerVertex<f64>) -> Result<PerVertex<f64>> {
        check_size("target", target.len(), self.given().n_vertices())?;
        match (self.double(), self.caps()) {
            (Some(double), _) => Ok(double.target(target)?.into()),
            (None, Some(capped)) => {
                let now = self.metric.curvature(&self.mesh)?.at;
                Ok(PerVertex::from_fn(capped.n_vertices(), |v: VertexId| match v {
                    _ if capped.is_boundary_vertex(v) => now[v],
                    _ if v.index() >= target.len() || self.given().is_boundary_vertex(v) => 0.0,
                    _ => target[v],
                }))
            }
            (None, None) => Ok(target.clone()),
        }
    }

    /// The target per vertex of [`Solution::mesh`] ([`Solution::spread_target`]).
    ///
    /// # Errors
    /// None that a solution can have; those of [`Solution::spread_target`].
    pub fn final_target(&self) -> Result<Option<PerVertex<f64>>> {
        self.target().map(|target| self.spread_target(target)).transpose()
    }

    /// The cones: interior vertices of the given surface that the caller named as cones, or whose curvature is to be off 0 by more
    /// than the tolerance of the flow. A layout is cut open through them. None for an initial metric.
    pub fn cones(&self) -> &[VertexId] {
        self.reached.as_ref().map_or(&[], |reached| &reached.cones)
    }

    /// True if the surface, unrolled into the plane, needs no cut: it has genus 0 and a flow to [`crate::Target::Outer`] has led here, so that
    /// unrolling it around any of its loops ends where it began.
    pub fn is_one_piece(&self) -> bool {
        self.reached.as_ref().is_some_and(|reached| reached.is_one_piece)
    }

    /// The same for this many threads.
    pub(crate) fn on_threads(self, threads: usize) -> Solution {
        Solution { threads, ..self }
    }

    /// Threads of the flow; 0 for one per core.
    pub fn threads(&self) -> usize {
        self.threads
    }

    /// Isometric flips before the flow.
    pub fn start_flips(&self) -> usize {
        self.origin.flips
    }

    /// All flips that were made on the way from the given triangulation.
    pub fn flips(&self) -> usize {
        self.flips
    }

    /// True if it lives on the given triangulation itself.
    pub fn is_unflipped(&self) -> bool {
        Arc::ptr_eq(&self.mesh, self.given())
    }

    /// Curvature per given vertex and the area of the given surface: of a double, half of both along the boundary; of a surface with caps,
    /// those that remain without them. Broken faces and the residual of Gauss–Bonnet are those of [`Solution::mesh`].
    ///
    /// # Errors
    /// Those of [`Metric::lengths`]; with caps also those of [`Solution::common_subdivision`].
    pub fn curvature(&self) -> Result<Curvature> {
        let mut curvature = self.metric.curvature(&self.mesh)?;
        if self.caps().is_some() {
            return self.without_caps(curvature);
        }
        if let Some(double) = self.double() {
            let half = |v: VertexId| if double.mirror(v) == v { 0.5 } else { 1.0 };
            let n = double.n_half_vertices();
            curvature.at = PerVertex::from_fn(n, |v: VertexId| half(v) * curvature.at[v]);
            curvature.area *= 0.5;
        }
        Ok(curvature)
    }

    /// [`Initial::conformal_factor`] per given vertex.
    ///
    /// # Errors
    /// Those of [`Initial::conformal_factor`].
    pub fn conformal_factor(&self) -> Result<PerVertex<f64>> {
        let mut factor = self.initial().conformal_factor(&self.metric)?.into_vec();
        factor.truncate(self.given().n_vertices());
        Ok(factor.into())
    }

    /// The number of crossings of the given edges with those of the metric's triangulation, and of the one that flows start from: the size
    /// of [`Solution::common_subdivision`] beyond that of the surface, on a double of both halves. O(E).
    ///
    /// # Errors
    /// [`crate::Error::TooLarge`] for more than can be numbered.
    pub fn crossings(&self) -> Result<usize> {
        let now = self.followed.first().map_or(Ok(0), |given| given.check(&self.mesh))?;
        let start = self.origin.flipped.as_ref().map_or(Ok(0), |start| start.given.check(&start.mesh))?;
        Ok(now + start)
    }

    /// The common subdivision of the given triangulation and the metric's, on the given surface alone: the first half of a double.
    ///
    /// # Errors
    /// Those of [`CommonSubdivision::new`].
    pub fn common_subdivision(&self, control: &Control) -> Result<CommonSubdivision> {
        self.common_subdivision_where(&|_| true, control)
    }

    /// [`Solution::common_subdivision`] of the given faces that `keep` names, whose vertices come first.
    ///
    /// # Errors
    /// Those of [`CommonSubdivision::new`].
    pub(crate) fn common_subdivision_where(
        &self,
        keep: &(dyn Fn(FaceId) -> bool + Sync),
        control: &Control,
    ) -> Result<CommonSubdivision> {
        let Solution { mesh, metric, followed, origin, .. } = self;
        let unflipped;
        let normal = match &followed[..] {
            [normal, ..] => normal,
            [] => {
                unflipped = NormalCoordinates::new(mesh);
                &unflipped
            }
        };
        let intrinsic = origin.flipped.as_ref().zip(followed.get(1)).map(|(flipped, normal)| {
            let FlippedStart { mesh, lengths, given } = flipped;
            IntrinsicTriangulation { mesh, lengths, given, normal }
        });
        let given: &Mesh = match (&origin.double, &origin.caps) {
            (Some(double), _) => &double.mesh,
            (None, Some(capped)) => capped,
            (None, None) => self.given(),
        };
        let Initial { input_geometry: geometry, input_u: u, .. } = &origin.initial;
        let input = InputTriangulation { mesh: given, geometry: *geometry, u };
        let n_faces = self.given().n_faces();
        let keep = |f: FaceId| f.index() < n_faces && keep(f);
        let all = Triangulations { input, intrinsic, result: FinalTriangulation { mesh, metric, normal } };
        within(self.threads, || CommonSubdivision::new(all, &keep, control))
    }

    /// True if a flow can go on from here. A flow that is to be `doubled` can on the double, or on one copy that is one half of it: Delaunay
    /// along the boundary too, now as at the start. Any other flow can if there is no double. None goes on with caps.
    pub(super) fn suits(&self, doubled: bool) -> bool {
        if self.caps().is_some() {
            return false;
        }
        let fails = || boundary_fails(&self.mesh, &self.metric, &self.metric.u, &self.origin.fixed);
        match self.double() {
            Some(_) => doubled,
            None => !doubled || (self.origin.is_half && !fails()),
        }
    }
}
