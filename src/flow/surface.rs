//! A surface with everything a flow with flips takes: its double, its Delaunay triangulation, and the way
//! back.

use super::options::{Flips, Method, Options};
use super::report::{Report, timed};
use super::solver::Solver;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::Space;
use crate::mesh::{Double, FixedEdges, Mesh, PerEdge, PerVertex, VertexId};
use crate::metric::surface::Start;
use crate::metric::{Initial, Metric, Refinement, Scheme, SurfaceMetric};
use crate::parallel::Pool;
use std::sync::Arc;

/// A surface in a conformal class, which flows to one target after the other.
///
/// With [`Flips::Auto`] the class is that of the surface's (weighted) Delaunay triangulation and edges are
/// flipped inside it, so that every admissible target is reached; a surface with boundary is solved on its
/// double, whose metric is kept symmetric, since only closed surfaces have that guarantee: on one copy for as long
/// as no edge is to be flipped across the boundary, which is all there is to do on surfaces that need no flips.
/// [`SurfaceFlow::refinement`] carries the result back to the given triangulation.
///
/// Edges stay as they are with [`Flips::Never`], and where flips have no part: in S², in the gradient flow,
/// for Thurston's and tangential packings (Delaunay on any triangulation). Between imaginary circles (virtual
/// radii) an edge need not have another diagonal: flips help there, without a guarantee. Pinned vertices keep a
/// boundary from being doubled: interior edges alone are flipped.
pub struct SurfaceFlow {
    start: Arc<Start>,
    solver: Solver,
    options: Options,
    /// All flips since the given triangulation.
    flips: usize,
    /// On one copy of a surface with boundary, as long as nothing is flipped across its boundary.
    one_copy: bool,
}

impl SurfaceFlow {
    /// The surface with these `lengths` (E entries, read in `geometry`), to be deformed in the class of
    /// `scheme` to metrics in `space`; `pinned` vertices hold their u.
    ///
    /// Errors: those of [`SurfaceMetric::new`], [`SurfaceMetric::delaunay`] and [`Solver::new`]; a pinned
    /// vertex that does not exist; [`Error::Cancelled`].
    pub fn new(
        given: &Mesh,
        lengths: &PerEdge<f64>,
        geometry: Space,
        scheme: Scheme,
        space: Space,
        pinned: &[VertexId],
        options: &Options,
        control: &Control,
    ) -> Result<SurfaceFlow> {
        let (given, lengths) = (Arc::new(given.clone()), Arc::new(lengths.clone()));
        SurfaceFlow::begin(given, lengths, (geometry, scheme, space), pinned, options, control)
    }

    fn begin(
        given: Arc<Mesh>,
        lengths: Arc<PerEdge<f64>>,
        (geometry, scheme, space): (Space, Scheme, Space),
        pinned: &[VertexId],
        options: &Options,
        control: &Control,
    ) -> Result<SurfaceFlow> {
        control.check()?;
        let from = match is_rigid(geometry, scheme, space, options) {
            true => SurfaceMetric::new(given, lengths, geometry, scheme, space)?,
            false => {
                let fixed = &options.fixed_edges;
                let start = |doubled| {
                    let (given, lengths) = (given.clone(), lengths.clone());
                    SurfaceMetric::delaunay(given, lengths, geometry, scheme, space, doubled, fixed, control)
                };
                let begin = || {
                    let one_copy = start(false)?;
                    let fits = given.is_closed() || !pinned.is_empty() || one_copy.is_symmetric();
                    if fits { Ok(one_copy) } else { start(true) }
                };
                Pool::new(options.threads)?.run(begin)?
            }
        };
        SurfaceFlow::go_on(from, pinned, options)
    }

    /// The same flow on the double, from the present u.
    fn doubled(&self, control: &Control) -> Result<SurfaceFlow> {
        let (start, fixed) = (&self.start, &self.options.fixed_edges);
        let space = start.initial.metric.space;
        let double = || {
            let (given, lengths) = (start.given.clone(), start.lengths.clone());
            SurfaceMetric::delaunay(
                given,
                lengths,
                start.initial.input_geometry,
                start.scheme,
                space,
                true,
                fixed,
                control,
            )
        };
        let mut flow = SurfaceFlow::go_on(self.solver.run(double)?, &[], &self.options)?;
        if let Some(double) = &flow.start.double {
            // Edges between imaginary circles may have no length there before they are flipped: then it begins from its own start.
            let _ = flow.solver.set_u(double.spread_vertices(&self.metric().u)?.into());
        }
        Ok(flow)
    }

    /// Go on from a metric of the surface: on its triangulation, from its u.
    ///
    /// If edges are to be flipped, and have not been, or with other `fixed_edges`, or other than
    /// [`SurfaceFlow::new`] does on the double or not, the flow is a new one, which starts from the given
    /// lengths. Errors: those of [`SurfaceFlow::new`].
    pub fn resume(
        from: &SurfaceMetric,
        pinned: &[VertexId],
        options: &Options,
        control: &Control,
    ) -> Result<SurfaceFlow> {
        control.check()?;
        let (initial, given) = (from.initial(), from.given());
        let (geometry, scheme, space) = (initial.input_geometry, from.scheme(), initial.metric.space);
        let doubled = !given.is_closed() && pinned.is_empty();
        let fits = from.was_flipped_without(&options.fixed_edges) && suits(from, doubled);
        if fits || is_rigid(geometry, scheme, space, options) {
            return SurfaceFlow::go_on(from.clone(), pinned, options);
        }
        let lengths = from.given_lengths().clone();
        SurfaceFlow::begin(given.clone(), lengths, (geometry, scheme, space), pinned, options, control)
    }

    fn go_on(from: SurfaceMetric, pinned: &[VertexId], options: &Options) -> Result<SurfaceFlow> {
        let (start, mesh, mut metric, followed, flips) = from.into_parts();
        FixedEdges::new(&start.given, &options.fixed_edges)?;
        let fixed = &options.fixed_edges;
        let rigid = is_rigid(start.initial.input_geometry, start.scheme, metric.space, options);
        let inner = Options {
            flips: if rigid { Flips::Never } else { Flips::Auto },
            fixed_edges: start.double.as_ref().map_or_else(|| Ok(fixed.clone()), |d| d.with_images(fixed))?,
            ..options.clone()
        };
        if let Some(double) = &start.double {
            // Images that rounding has told apart: they must be the same to begin with.
            for v in mesh.vertices().skip(double.n_half_vertices()) {
                let image = double.mirror(v);
                (metric.u[v], metric.u_low[v]) = (metric.u[image], metric.u_low[image]);
            }
        }
        let mut solver = Solver::new(mesh, metric, inner)?;
        for normal in followed {
            solver.follow(normal)?;
        }
        if let Some(double) = &start.double {
            let mirror: Vec<VertexId> = solver.mesh().vertices().map(|v| double.mirror(v)).collect();
            solver.keep_symmetric(&mirror)?;
        }
        let mut flow = SurfaceFlow { start, solver, options: options.clone(), flips, one_copy: false };
        flow.hold(pinned)?;
        Ok(flow)
    }

    /// Hold u at these vertices, and at no others; their curvature is then free.
    ///
    /// A surface with boundary whose edges flip is on its double if no vertex is pinned: going there and leaving
    /// it the flow begins anew, as in [`SurfaceFlow::resume`]. Errors: those of [`SurfaceFlow::new`].
    pub fn pin(&mut self, pinned: &[VertexId], control: &Control) -> Result<()> {
        let given = &self.start.given;
        let initial = &self.start.initial;
        let rigid = is_rigid(initial.input_geometry, self.start.scheme, initial.metric.space, &self.options);
        let doubled = !given.is_closed() && pinned.is_empty();
        if rigid || suits(&self.now(), doubled) {
            return self.hold(pinned);
        }
        *self = SurfaceFlow::resume(&self.now(), pinned, &self.options, control)?;
        Ok(())
    }

    fn hold(&mut self, pinned: &[VertexId]) -> Result<()> {
        let n = self.start.given.n_vertices();
        if let Some(v) = pinned.iter().find(|v| v.index() >= n) {
            let value = v.to_string();
            return Err(Error::Argument { what: "pinned vertex", value, need: "an existing vertex" });
        }
        let images = self.double().map_or_else(Vec::new, |d| pinned.iter().map(|&v| d.mirror(v)).collect());
        self.solver.pin(&[pinned, &images].concat())?;
        let start = &self.start;
        let flips = self.solver.options.flips == Flips::Auto;
        self.one_copy = flips && start.double.is_none() && !start.given.is_closed() && pinned.is_empty();
        Ok(())
    }

    /// Flow to curvature `target` (an entry per vertex of the given surface, radians): [`Solver::solve`].
    pub fn solve(&mut self, target: &PerVertex<f64>, control: &Control) -> Result<Report> {
        crate::error::check_size("target", target.len(), self.start.given.n_vertices())?;
        if !self.one_copy {
            let report = self.solver.solve(&self.target(target)?, control)?;
            self.flips += report.flips;
            return Ok(report);
        }
        let before = self.now();
        let [start, low] = self.solver.start().map(PerVertex::clone);
        let (mut report, left) = self.solver.solve_on(target, true, control)?;
        self.flips += report.flips;
        if !left {
            return Ok(report);
        }
        let mut took = 0.0;
        let doubled = timed(&mut took, || self.doubled(control));
        report.seconds.flip += took;
        report.seconds.total += took;
        let rest = doubled.and_then(|mut doubled| {
            let limit = self.options.iteration_limit();
            doubled.solver.options.max_iterations = limit - report.iterations;
            let rest = doubled.solve(target, control)?;
            doubled.solver.options.max_iterations = limit;
            Ok((rest, doubled))
        });
        match rest {
            Ok((rest, mut doubled)) => {
                if let (false, Some(double)) = (rest.converged, &doubled.start.double) {
                    let spread = |x: &[f64]| double.spread_vertices(x).map(PerVertex::from);
                    doubled.solver.start_from(spread(&start)?, spread(&low)?);
                }
                *self = doubled;
                Ok(report.then(rest))
            }
            Err(error) => {
                *self = SurfaceFlow::resume(&before, &[], &self.options, &Control::new())?;
                self.solver.start_from(start, low);
                Err(error)
            }
        }
    }

    /// Bring a curvature that is 0 to doubles' digits down to 0 to twice as many, on a closed surface after a flow to K̄ = 0: layouts in
    /// H² magnify what is left by e^distance. Returns the largest |K| left ([`Metric::angle_defects`]), about 1e-30 where every ε is 0
    /// in E² or H².
    ///
    /// Errors: [`Error::Cancelled`].
    pub fn flatten(&mut self, control: &Control) -> Result<f64> {
        self.solver.flatten(control)
    }

    /// A target on the given surface as one on [`SurfaceFlow::mesh`]: curvature on both sides of the boundary
    /// adds up. Errors: [`Error::Size`] unless it has an entry per vertex of the given surface.
    pub fn target(&self, target: &PerVertex<f64>) -> Result<PerVertex<f64>> {
        self.start.target(target)
    }

    /// The given triangulation.
    pub fn given(&self) -> &Mesh {
        &self.start.given
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
        &self.start.initial
    }

    /// The double, if the flow is one on it.
    pub fn double(&self) -> Option<&Double> {
        self.start.double.as_ref()
    }

    /// Isometric flips before the flow.
    pub fn start_flips(&self) -> usize {
        self.start.flips
    }

    /// The present metric with its way back, apart from the flow.
    pub fn now(&self) -> SurfaceMetric {
        let (mesh, metric) = (self.mesh().clone(), self.metric().clone());
        SurfaceMetric::at(self.start.clone(), mesh, metric, self.solver.followed().to_vec(), self.flips)
    }

    /// The common refinement of the given triangulation and the present one, on the given surface alone: the
    /// first half of a double.
    ///
    /// Errors: those of [`Refinement::new`].
    pub fn refinement(&self, control: &Control) -> Result<Refinement> {
        let (start, solver) = (&*self.start, &self.solver);
        let (mesh, metric, followed) = (solver.mesh(), solver.metric(), solver.followed());
        solver.run(|| start.refinement(mesh, metric, followed, control))
    }
}

/// Whether a flow can go on from a metric with its symmetry: `doubled`, or with a boundary that is an end.
fn suits(from: &SurfaceMetric, doubled: bool) -> bool {
    if doubled { from.is_symmetric() } else { from.double().is_none() }
}

/// Whether edges stay as they are.
fn is_rigid(geometry: Space, scheme: Scheme, space: Space, options: &Options) -> bool {
    let packing = matches!(scheme, Scheme::Thurston | Scheme::Tangential);
    options.flips == Flips::Never
        || options.method != Method::Newton
        || [space, geometry].contains(&Space::S2)
        || packing
}
