//! A metric of a surface on a triangulation of its own, with all that leads back to the surface as it was
//! given.

use super::class::Class;
use super::curvature::Curvature;
use super::delaunay::boundary_fails;
use super::initial::{Initial, initial_metric};
use super::isometric::Triangulated;
use super::lengths::Metric;
use super::refinement::{Final, Input, Intrinsic, Refinement, Triangulations};
use super::scheme::Scheme;
use super::start::{StartOptions, delaunay_start};
use crate::control::Control;
use crate::error::{Result, check_size};
use crate::geometry::Space;
use crate::mesh::{Double, EdgeId, FixedEdges, Flip, Mesh, NormalCoordinates, PerEdge, PerVertex, VertexId};
use std::sync::Arc;

/// What all metrics that flow from one start share.
#[derive(Debug)]
pub(crate) struct Start {
    pub given: Arc<Mesh>,
    /// Of the given edges, in `initial.input_geometry`.
    pub lengths: Arc<PerEdge<f64>>,
    pub scheme: Scheme,
    pub double: Option<Double>,
    pub initial: Initial,
    /// Isometric flips from the given triangulation to that of `initial`.
    pub flips: usize,
    /// The latter, if that is another one.
    pub flipped: Option<Flipped>,
    /// Given edges that are not flipped.
    pub fixed: FixedEdges,
    /// Whether the start, of one copy, is half of what its double's is: there no boundary edge would be flipped.
    pub is_half: bool,
}

/// The triangulation that isometric flips have made.
#[derive(Debug)]
pub(crate) struct Flipped {
    pub mesh: Arc<Mesh>,
    /// In `initial.input_geometry`.
    pub lengths: PerEdge<f64>,
    /// The given edges on it.
    pub given: NormalCoordinates,
}

impl Start {
    /// A target on the given surface as one on its double, if that is what flows.
    pub fn target(&self, target: &PerVertex<f64>) -> Result<PerVertex<f64>> {
        check_size("target", target.len(), self.given.n_vertices())?;
        match &self.double {
            Some(double) => Ok(double.target(target)?.into()),
            None => Ok(target.clone()),
        }
    }

    /// The common refinement of the given triangulation with that of a metric.
    pub fn refinement(
        &self,
        mesh: &Mesh,
        metric: &Metric,
        followed: &[NormalCoordinates],
        control: &Control,
    ) -> Result<Refinement> {
        let unflipped;
        let normal = match followed {
            [normal, ..] => normal,
            [] => {
                unflipped = NormalCoordinates::new(mesh);
                &unflipped
            }
        };
        let intrinsic = self.flipped.as_ref().zip(followed.get(1)).map(|(flipped, normal)| {
            let Flipped { mesh, lengths, given } = flipped;
            Intrinsic { mesh, lengths, given, normal }
        });
        let given = self.double.as_ref().map_or(&*self.given, |double| &double.mesh);
        let input = Input { mesh: given, geometry: self.initial.input_geometry, u: &self.initial.input_u };
        let keep = |f| self.double.as_ref().is_none_or(|double| double.is_original(f));
        let result = Final { mesh, metric, normal };
        Refinement::new(Triangulations { input, intrinsic, result }, &keep, control)
    }
}

/// A metric of a surface: the initial one, or one that a flow ([`crate::flow::SurfaceFlow`]) has come to.
///
/// It lives on a triangulation of its own, [`SurfaceMetric::mesh`]: of the given surface or of its double,
/// whose first vertices are the given ones, after edge flips. What is asked per vertex of the given surface
/// is answered per vertex of the given surface.
#[derive(Debug, Clone)]
pub struct SurfaceMetric {
    pub(crate) start: Arc<Start>,
    mesh: Arc<Mesh>,
    metric: Metric,
    /// Triangulations on `mesh`: that of the given edges, and that of the start if it is another one. None where no edge was ever to
    /// be flipped.
    followed: Vec<NormalCoordinates>,
    flips: usize,
}

impl SurfaceMetric {
    /// The initial metric on the given triangulation: [`initial_metric`].
    pub fn new(
        given: Arc<Mesh>,
        lengths: Arc<PerEdge<f64>>,
        geometry: Space,
        scheme: Scheme,
        space: Space,
    ) -> Result<SurfaceMetric> {
        let initial = initial_metric(&given, &lengths, geometry, scheme, space)?;
        let (mesh, metric) = (given.clone(), initial.metric.clone());
        let start = Start {
            given,
            lengths,
            scheme,
            double: None,
            initial,
            flips: 0,
            flipped: None,
            fixed: FixedEdges::none(),
            is_half: false,
        };
        Ok(SurfaceMetric { start: Arc::new(start), mesh, metric, followed: Vec::new(), flips: 0 })
    }

    /// The initial metric on the (weighted) Delaunay triangulation, of the surface or, if it is `doubled`, of
    /// its double: [`delaunay_start`]. `fixed` edges are not flipped.
    pub fn delaunay(
        given: Arc<Mesh>,
        lengths: Arc<PerEdge<f64>>,
        geometry: Space,
        scheme: Scheme,
        space: Space,
        doubled: bool,
        fixed: &[EdgeId],
        control: &Control,
    ) -> Result<SurfaceMetric> {
        let double = if doubled { Some(Double::new(&given)?) } else { None };
        let (mesh, all, all_fixed) = match &double {
            Some(d) => (d.mesh.clone(), d.spread_edges(&lengths)?.into(), d.with_images(fixed)?),
            None => (Mesh::clone(&given), PerEdge::clone(&lengths), fixed.to_vec()),
        };
        let all_fixed = FixedEdges::new(&mesh, &all_fixed)?;
        let mut normal = NormalCoordinates::new(&mesh);
        let mut flips = 0;
        let mut record = |mesh: &Mesh, flip: Flip| {
            normal.record(mesh, flip.edge);
            flips += 1;
        };
        let mut surface = Triangulated { mesh, lengths: all, geometry };
        let options =
            StartOptions { class: Class::new(scheme, space), double: double.as_ref(), fixed: &all_fixed };
        let initial = delaunay_start(&mut surface, options, &mut record, control)?;
        let Triangulated { mesh, lengths: all, .. } = surface;
        let (mesh, metric) = (Arc::new(mesh), initial.metric.clone());
        let mut followed = vec![normal];
        let flipped = (flips > 0).then(|| {
            followed.push(NormalCoordinates::new(&mesh));
            Flipped { mesh: mesh.clone(), lengths: all, given: followed[0].clone() }
        });
        let is_half = double.is_none() && !boundary_fails(&mesh, &metric, &metric.u, &all_fixed);
        let fixed = FixedEdges::new(&given, fixed)?;
        let start = Start { given, lengths, scheme, double, initial, flips, flipped, fixed, is_half };
        Ok(SurfaceMetric { start: Arc::new(start), mesh, metric, followed, flips })
    }

    /// What the metric has become. `flips`: all from the given triangulation to this one.
    pub(crate) fn at(
        start: Arc<Start>,
        mesh: Mesh,
        metric: Metric,
        followed: Vec<NormalCoordinates>,
        flips: usize,
    ) -> SurfaceMetric {
        let mesh = if mesh == *start.given { start.given.clone() } else { Arc::new(mesh) };
        SurfaceMetric { start, mesh, metric, followed, flips }
    }

    pub(crate) fn into_parts(self) -> (Arc<Start>, Mesh, Metric, Vec<NormalCoordinates>, usize) {
        (self.start, Arc::unwrap_or_clone(self.mesh), self.metric, self.followed, self.flips)
    }

    /// The given triangulation.
    pub fn given(&self) -> &Arc<Mesh> {
        &self.start.given
    }

    /// The lengths that its edges were given with, in [`Initial::input_geometry`].
    pub fn given_lengths(&self) -> &Arc<PerEdge<f64>> {
        &self.start.lengths
    }

    /// The scheme of its class.
    pub fn scheme(&self) -> Scheme {
        self.start.scheme
    }

    /// The triangulation that it lives on.
    pub fn mesh(&self) -> &Arc<Mesh> {
        &self.mesh
    }

    /// Its variables there.
    pub fn metric(&self) -> &Metric {
        &self.metric
    }

    /// Where flows on the surface start; on another triangulation if edges have been flipped.
    pub fn initial(&self) -> &Initial {
        &self.start.initial
    }

    /// The double of the given surface, if the metric lives there.
    pub fn double(&self) -> Option<&Double> {
        self.start.double.as_ref()
    }

    /// Isometric flips before the flow.
    pub fn start_flips(&self) -> usize {
        self.start.flips
    }

    /// All flips that were made on the way from the given triangulation.
    pub fn flips(&self) -> usize {
        self.flips
    }

    /// Whether flips were allowed on the way here, and these given edges kept from them.
    pub(crate) fn was_flipped_without(&self, fixed: &[EdgeId]) -> bool {
        let is_same = |fixed| self.start.fixed == fixed;
        !self.followed.is_empty() && FixedEdges::new(self.given(), fixed).is_ok_and(is_same)
    }

    /// Whether it lives on the surface's double, or on one copy that it could be reflected from: Delaunay along the boundary too, and
    /// so it was at the start.
    pub(crate) fn is_symmetric(&self) -> bool {
        let fails = || boundary_fails(&self.mesh, &self.metric, &self.metric.u, &self.start.fixed);
        self.double().is_some() || (self.start.is_half && !fails())
    }

    /// Whether it lives on the given triangulation itself.
    pub fn is_unflipped(&self) -> bool {
        self.mesh == self.start.given
    }

    /// Curvature per given vertex and the area of the given surface: of a double, half of both along the
    /// boundary. Broken faces and the residual of Gauss–Bonnet are those of [`SurfaceMetric::mesh`].
    pub fn curvature(&self) -> Result<Curvature> {
        let mut curvature = self.metric.curvature(&self.mesh)?;
        if let Some(double) = self.double() {
            let half = |v: VertexId| if double.mirror(v) == v { 0.5 } else { 1.0 };
            let n = double.n_half_vertices();
            curvature.at = PerVertex::from_fn(n, |v: VertexId| half(v) * curvature.at[v]);
            curvature.area *= 0.5;
        }
        Ok(curvature)
    }

    /// [`Initial::conformal_factor`] per given vertex.
    pub fn conformal_factor(&self) -> Result<PerVertex<f64>> {
        let mut factor = self.initial().conformal_factor(&self.metric)?.into_vec();
        factor.truncate(self.given().n_vertices());
        Ok(factor.into())
    }

    /// How often the given edges cross those of the metric's triangulation, and of the one that flows start from: the size of
    /// [`SurfaceMetric::refinement`] beyond that of the surface, on a double of both halves. O(E).
    ///
    /// Errors: [`crate::Error::TooLarge`] for more than can be numbered.
    pub fn crossings(&self) -> Result<usize> {
        let now = self.followed.first().map_or(Ok(0), |given| given.check(&self.mesh))?;
        let start = self.start.flipped.as_ref().map_or(Ok(0), |start| start.given.check(&start.mesh))?;
        Ok(now + start)
    }

    /// The common refinement of the given triangulation and the metric's, on the given surface alone: the
    /// first half of a double.
    ///
    /// Errors: those of [`Refinement::new`].
    pub fn refinement(&self, control: &Control) -> Result<Refinement> {
        self.start.refinement(&self.mesh, &self.metric, &self.followed, control)
    }
}
