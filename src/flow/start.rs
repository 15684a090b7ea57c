//! Makes flows: on a surface, from a solution, from a bare metric, on the double; and sets the pins of one.

use super::Flow;
use super::memory::SolveMemory;
use super::options::{Flips, Method, Options};
use super::origin::FlowOrigin;
use super::solution::Solution;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::Space;
use crate::mesh::{Double, FixedEdges, FlipLog, Mesh, PerVertex, VertexId};
use crate::metric::{Class, Metric, Surface, Target};
use crate::parallel::Pool;
use std::sync::Arc;

impl Flow {
    /// A flow on a surface in a class.
    ///
    /// # Errors
    /// Those of [`crate::metric::delaunay_start`]; a pinned vertex or fixed edge that does not exist; options out of their range;
    /// [`Error::Cancelled`].
    pub fn new(surface: Surface, class: Class, options: &Options, control: &Control) -> Result<Flow> {
        Flow::begin(surface, class, options, options.pinned.is_empty(), control)
    }

    /// [`Flow::new`] for a flow whose first target is known: the result is the same, but nothing is doubled in vain for [`Target::Outer`].
    ///
    /// # Errors
    /// Those of [`Flow::new`].
    pub fn toward(
        target: &Target,
        surface: Surface,
        class: Class,
        options: &Options,
        control: &Control,
    ) -> Result<Flow> {
        let doubles = options.pinned.is_empty() && !matches!(target, Target::Outer(_));
        Flow::begin(surface, class, options, doubles, control)
    }

    fn begin(
        surface: Surface,
        class: Class,
        options: &Options,
        doubles: bool,
        control: &Control,
    ) -> Result<Flow> {
        control.check()?;
        let pool = Arc::new(Pool::new(options.threads)?);
        let origin = pool.run(|| {
            if is_rigid(surface.geometry(), class, options) {
                return FlowOrigin::rigid(surface, class);
            }
            let fixed = &options.fixed_edges;
            let may_double = !surface.mesh().is_closed() && doubles;
            let one_copy = FlowOrigin::delaunay(surface.clone(), class, false, fixed, control)?;
            if may_double && !one_copy.is_half {
                return FlowOrigin::delaunay(surface, class, true, fixed, control);
            }
            Ok(one_copy)
        })?;
        Flow::go_on(Solution::start(origin), options, pool)
    }

    /// Go on from a metric of the surface: on its triangulation, from its u.
    ///
    /// If edges are to be flipped now and were not before, or with other fixed edges, or on the double instead of one copy or the other way
    /// round, the flow is a new one ([`Flow::new`]), which starts from the given lengths.
    ///
    /// # Errors
    /// Those of [`Flow::new`].
    pub fn resume(from: &Solution, options: &Options, control: &Control) -> Result<Flow> {
        control.check()?;
        let given = from.given();
        let doubled = !given.is_closed() && options.pinned.is_empty();
        let fixed = FixedEdges::new(given, &options.fixed_edges)?;
        let fits = !from.followed.is_empty() && from.origin.fixed == fixed && from.suits(doubled);
        match from.class() {
            Some(class) if from.caps().is_some() => {
                Flow::new(from.surface().clone(), class, options, control)
            }
            Some(class) if !fits && !is_rigid(from.surface().geometry(), class, options) => {
                Flow::new(from.surface().clone(), class, options, control)
            }
            _ => Flow::go_on(from.clone(), options, Arc::new(Pool::new(options.threads)?)),
        }
    }

    /// A flow in the class of any metric, vertex types mixed or not, on its triangulation as it is.
    ///
    /// Edges are flipped inside the class if [`Options::flips`] allows it. There is no isometric start and no
    /// double, so targets that need them can be out of reach: [`Flow::new`] has both.
    ///
    /// # Errors
    /// Those of [`Metric::lengths`]; options out of their range.
    pub fn from_metric(mesh: Mesh, metric: Metric, options: &Options) -> Result<Flow> {
        let follows = may_flip(options, metric.space);
        let pool = Arc::new(Pool::new(options.threads)?);
        Flow::go_on(Solution::start(FlowOrigin::of_metric(mesh, &metric, follows)?), options, pool)
    }

    pub(super) fn go_on(mut now: Solution, options: &Options, pool: Arc<Pool>) -> Result<Flow> {
        options.check()?;
        let (origin, mesh) = (now.origin.clone(), now.mesh.clone());
        let rigid = origin.class.map_or(!may_flip(options, now.metric.space), |class| {
            is_rigid(origin.surface.geometry(), class, options)
        });
        let (mut fixed, mut mirror) = (FixedEdges::new(now.given(), &options.fixed_edges)?, None);
        if origin.caps.is_some() {
            fixed = FixedEdges::new(&mesh, &options.fixed_edges)?;
        }
        if let Some(double) = &origin.double {
            fixed = FixedEdges::new(&mesh, &double.with_images(&options.fixed_edges)?)?;
            mirror = Some(mirror_of(double));
            // Rounding has made u differ between mirror images, but the flow needs a symmetric start.
            let Metric { u, u_low, .. } = &mut now.metric;
            for v in mesh.vertices().skip(double.n_half_vertices()) {
                let image = double.mirror(v);
                (u[v], u_low[v]) = (u[image], u_low[image]);
            }
        }
        now.threads = options.threads;
        pool.run(|| now.metric.check_domain(&mesh))?;
        let mut flow = Flow {
            start: now.metric.u.clone(),
            start_low: now.metric.u_low.clone(),
            now,
            options: options.clone(),
            flips_allowed: !rigid,
            fixed,
            pinned: vec![false; mesh.n_vertices()],
            holds_outer: false,
            is_bounded: false,
            mirror,
            log: FlipLog::default(),
            one_copy: false,
            target: PerVertex::filled(mesh.n_vertices(), 0.0),
            system: None,
            single_serves: true,
            unseen_flips: 0,
            memory: SolveMemory::default(),
            pool,
        };
        flow.hold(&options.pinned)?;
        Ok(flow)
    }

    /// Hold u at these vertices of the given surface, and at no others; their curvature is then free.
    ///
    /// A surface with boundary whose edges flip is solved on its double if no vertex is pinned. A flow that goes there or comes from there
    /// begins anew, as in [`Flow::resume`].
    ///
    /// # Errors
    /// Those of [`Flow::new`].
    pub fn pin(&mut self, pinned: &[VertexId], control: &Control) -> Result<()> {
        let options = Options { pinned: pinned.to_vec(), ..self.options.clone() };
        let doubled = !self.given().is_closed() && pinned.is_empty();
        if self.class().is_none() || !self.flips_allowed || self.suits(doubled) {
            self.hold(pinned)?;
            self.options = options;
        } else {
            *self = Flow::resume(&self.now, &options, control)?;
        }
        Ok(())
    }

    fn hold(&mut self, pinned: &[VertexId]) -> Result<()> {
        let Flow { now, pinned: held, .. } = self;
        let n = now.given().n_vertices();
        if let Some(v) = pinned.iter().find(|v| v.index() >= n) {
            let value = v.to_string();
            return Err(Error::Argument { what: "pinned vertex", value, need: "an existing vertex" });
        }
        let on_one_copy = now.class().is_some() && now.double().is_none() && !now.given().is_closed();
        self.one_copy = self.flips_allowed && on_one_copy && pinned.is_empty();
        held.fill(false);
        for &v in pinned {
            held[v.index()] = true;
            if let Some(double) = now.double() {
                held[double.mirror(v).index()] = true;
            }
        }
        self.system = None;
        Ok(())
    }

    /// Set u per vertex of [`Solution::mesh`]: the start of the next solves, and the values held at pinned vertices.
    ///
    /// # Errors
    /// Those of [`Metric::lengths`] there; nothing has changed then.
    pub fn set_u(&mut self, u: PerVertex<f64>) -> Result<()> {
        let u_low = PerVertex::filled(u.len(), 0.0);
        let metric = Metric { u, u_low, ..self.metric.clone() };
        let mesh = self.now.mesh();
        self.pool.run(|| metric.check_domain(mesh))?;
        (self.start, self.start_low) = (metric.u.clone(), metric.u_low.clone());
        self.now.metric = metric;
        Ok(())
    }

    /// [`Flow::set_u`] in double-double precision.
    pub(super) fn set_start(&mut self, u: PerVertex<f64>, u_low: PerVertex<f64>) -> Result<()> {
        self.set_u(u)?;
        self.start_low = u_low.clone();
        self.now.metric.u_low = u_low;
        Ok(())
    }

    /// The class of the flow, which one on the double has.
    pub(super) fn scheme_class(&self) -> Result<Class> {
        self.class().ok_or_else(|| {
            Error::argument("flow", "a metric without a surface", "one on a surface, which can be doubled")
        })
    }

    /// The same flow on the double, from the present u.
    pub(super) fn doubled(&self, control: &Control) -> Result<Flow> {
        let (surface, class) = (self.surface().clone(), self.scheme_class()?);
        let fixed = &self.options.fixed_edges;
        let double = || FlowOrigin::delaunay(surface, class, true, fixed, control);
        let mut flow =
            Flow::go_on(Solution::start(self.pool.run(double)?), &self.options, self.pool.clone())?;
        if let Some(double) = flow.now.double() {
            // Edges between imaginary circles may have no length at this u before they are flipped. Then the flow keeps its own start.
            let u = double.spread_vertices(&self.metric.u)?;
            let _ = flow.set_u(u.into());
        }
        Ok(flow)
    }

    /// The present metric, with the report of the last solve.
    pub fn solution(&self) -> Solution {
        self.now.clone()
    }
}

/// True if these options let edges flip at all.
fn may_flip(options: &Options, space: Space) -> bool {
    options.flips == Flips::Auto && options.method == Method::Newton && space != Space::S2
}

/// True if edges stay as they are: nothing is flipped in S², nor in packings, which are Delaunay on any triangulation.
fn is_rigid(geometry: Space, class: Class, options: &Options) -> bool {
    !may_flip(options, class.space) || geometry == Space::S2 || class.scheme.is_packing()
}

/// Per vertex of a double, its mirror image.
fn mirror_of(double: &Double) -> Vec<u32> {
    double.mesh.vertices().map(|v| double.mirror(v).0).collect()
}
