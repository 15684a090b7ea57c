//! A surface with everything a flow with flips takes: its double, its Delaunay triangulation, and the way back.

use super::options::{Flips, Method, Options};
use super::report::Report;
use super::solver::Solver;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::Space;
use crate::mesh::{Double, Mesh, NormalCoordinates, PerEdge, PerVertex, VertexId};
use crate::metric::refinement::{Final, Input};
use crate::metric::{Initial, Metric, Refinement, Scheme, delaunay_start, initial_metric};
use crate::parallel::Pool;

/// A surface in a conformal class, which flows to one target after the other.
///
/// With [`Flips::Auto`] the class is that of the surface's (weighted) Delaunay triangulation and edges are flipped inside it, so
/// that every admissible target is reached; a surface with boundary is solved on its double, whose metric is kept symmetric, since
/// only closed surfaces have that guarantee. [`SurfaceFlow::refinement`] carries the result back to the given triangulation.
///
/// Edges stay as they are with [`Flips::Never`], and where flips have no part: in S², in the gradient flow, for Thurston's and
/// tangential packings (Delaunay on any triangulation). Pinned vertices keep a boundary from being doubled: interior edges alone
/// are flipped.
pub struct SurfaceFlow {
    given: Mesh,
    double: Option<Double>,
    initial: Initial,
    start_flips: usize,
    solver: Solver,
}

impl SurfaceFlow {
    /// The surface with these `lengths` (E entries, read in `geometry`), to be deformed in the class of `scheme` to metrics in
    /// `space`; `pinned` vertices hold their u.
    ///
    /// Errors: those of [`initial_metric`], [`delaunay_start`] and [`Solver::new`]; a pinned vertex that does not exist.
    pub fn new(
        given: &Mesh,
        lengths: &PerEdge<f64>,
        geometry: Space,
        scheme: Scheme,
        space: Space,
        pinned: &[VertexId],
        options: &Options,
    ) -> Result<SurfaceFlow> {
        let packing = matches!(scheme, Scheme::Thurston | Scheme::Tangential);
        let rigid = options.flips == Flips::Never
            || options.method != Method::Newton
            || [space, geometry].contains(&Space::S2)
            || packing;
        if rigid {
            let initial = initial_metric(given, lengths, geometry, scheme, space)?;
            let options = Options { flips: Flips::Never, ..options.clone() };
            let mut solver = Solver::new(given.clone(), initial.metric.clone(), options)?;
            solver.pin(pinned)?;
            return Ok(SurfaceFlow { given: given.clone(), double: None, initial, start_flips: 0, solver });
        }
        let double = if given.is_closed() || !pinned.is_empty() { None } else { Some(Double::new(given)?) };
        let (mut mesh, mut lengths) = match &double {
            Some(double) => (double.mesh.clone(), double.spread_edges(lengths).into()),
            None => (given.clone(), lengths.clone()),
        };
        if let Some(e) = options.fixed_edges.iter().find(|e| e.index() >= given.n_edges()) {
            let value = e.to_string();
            return Err(Error::Argument { what: "fixed edge", value, need: "an existing edge" });
        }
        let fixed = match &double {
            Some(double) => double.with_images(&options.fixed_edges),
            None => options.fixed_edges.clone(),
        };
        let mut normal = NormalCoordinates::new(&mesh);
        let mut start_flips = 0;
        let initial = Pool::new(options.threads)?.run(|| {
            let mut record = |mesh: &Mesh, e| {
                normal.record(mesh, e);
                start_flips += 1;
            };
            let double = double.as_ref();
            delaunay_start(&mut mesh, &mut lengths, geometry, scheme, space, double, &fixed, &mut record)
        })?;
        let options = Options { fixed_edges: fixed, ..options.clone() };
        let mut solver = Solver::new(mesh, initial.metric.clone(), options)?;
        solver.follow(normal)?;
        solver.pin(pinned)?;
        if let Some(double) = &double {
            let mirror: Vec<VertexId> = solver.mesh().vertices().map(|v| double.mirror(v)).collect();
            solver.keep_symmetric(&mirror)?;
        }
        Ok(SurfaceFlow { given: given.clone(), double, initial, start_flips, solver })
    }

    /// Flow to curvature `target` (an entry per vertex of the given surface, radians): [`Solver::solve`].
    pub fn solve(&mut self, target: &PerVertex<f64>, control: &Control) -> Result<Report> {
        crate::error::check_size("target", target.len(), self.given.n_vertices())?;
        self.solver.solve(&self.target(target), control)
    }

    /// A target on the given surface as one on [`SurfaceFlow::mesh`]: curvature on both sides of the boundary adds up.
    pub fn target(&self, target: &PerVertex<f64>) -> PerVertex<f64> {
        self.double.as_ref().map_or_else(|| target.clone(), |double| double.target(target).into())
    }

    /// The triangulation that flips have led to: of the surface, or of its double.
    pub fn mesh(&self) -> &Mesh {
        self.solver.mesh()
    }

    /// The metric on it.
    pub fn metric(&self) -> &Metric {
        self.solver.metric()
    }

    /// Where the flow started, after the flips to Delaunay.
    pub fn initial(&self) -> &Initial {
        &self.initial
    }

    /// The double, if the flow is one on it.
    pub fn double(&self) -> Option<&Double> {
        self.double.as_ref()
    }

    /// Isometric flips before the flow.
    pub fn start_flips(&self) -> usize {
        self.start_flips
    }

    /// The common refinement of the given triangulation and the present one, on the given surface alone: the first half of a
    /// double.
    ///
    /// Errors: those of [`Refinement::new`].
    pub fn refinement(&self, control: &Control) -> Result<Refinement> {
        let unflipped;
        let normal = match self.solver.normal() {
            Some(normal) => normal,
            None => {
                unflipped = NormalCoordinates::new(&self.given);
                &unflipped
            }
        };
        let mesh = self.double.as_ref().map_or(&self.given, |double| &double.mesh);
        let input = Input { mesh, geometry: self.initial.input_geometry, u: &self.initial.input_u };
        let result = Final { mesh: self.solver.mesh(), metric: self.solver.metric(), normal };
        let keep = |f| self.double.as_ref().is_none_or(|double| double.is_original(f));
        self.solver.run(|| Refinement::new(input, result, &keep, control))
    }
}
