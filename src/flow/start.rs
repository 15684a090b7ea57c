//! Making a flow: on a surface, from a solution, from a bare metric; going to the double, and pins.

use super::Flow;
use super::options::{Flips, Method, Options};
use super::origin::Origin;
use super::solution::Solution;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::Space;
use crate::mesh::{Double, FixedEdges, FlipLog, Mesh, NormalCoordinates, PerVertex, VertexId};
use crate::metric::{Class, Initial, Metric, Scheme, Surface};
use crate::parallel::Pool;
use std::sync::Arc;

impl Flow {
    /// A flow on a surface in a class.
    ///
    /// # Errors
    /// Those of [`crate::metric::delaunay_start`]; a pinned vertex or fixed edge that does not exist; options out of their range;
    /// [`Error::Cancelled`].
    pub fn new(surface: Surface, class: Class, options: &Options, control: &Control) -> Result<Flow> {
        control.check()?;
        let origin = match is_rigid(surface.geometry(), class, options) {
            true => Origin::rigid(surface, class)?,
            false => {
                let start = |doubled| {
                    Origin::delaunay(surface.clone(), class, doubled, &options.fixed_edges, control)
                };
                let begin = || {
                    let one_copy = start(false)?;
                    let fits = surface.mesh().is_closed() || !options.pinned.is_empty() || one_copy.is_half;
                    if fits { Ok(one_copy) } else { start(true) }
                };
                Pool::new(options.threads)?.run(begin)?
            }
        };
        Flow::go_on(Solution::start(origin), options)
    }

    /// Go on from a metric of the surface: on its triangulation, from its u.
    ///
    /// If edges are to be flipped, and have not been, or with other fixed edges, or other than [`Flow::new`] does on the double or
    /// not, the flow is a new one, which starts from the given lengths.
    ///
    /// # Errors
    /// Those of [`Flow::new`].
    pub fn resume(from: &Solution, options: &Options, control: &Control) -> Result<Flow> {
        control.check()?;
        let given = from.given();
        let doubled = !given.is_closed() && options.pinned.is_empty();
        let fixed = FixedEdges::new(given, &options.fixed_edges)?;
        let fits = !from.followed.is_empty() && from.origin.fixed == fixed && suits(from, doubled);
        match from.class() {
            Some(class) if !fits && !is_rigid(from.surface().geometry(), class, options) => {
                Flow::new(from.surface().clone(), class, options, control)
            }
            _ => Flow::go_on(from.clone(), options),
        }
    }

    /// A flow in the class of any metric, vertex types mixed or not, on its triangulation as it is.
    ///
    /// Where [`Options::flips`] allows it edges are flipped inside the class from there on. There is no isometric start and no
    /// double, so targets that need them can be out of reach: [`Flow::new`] has both.
    ///
    /// # Errors
    /// Those of [`Metric::lengths`]; options out of their range.
    pub fn from_metric(mesh: Mesh, metric: Metric, options: &Options) -> Result<Flow> {
        let follows = may_flip(options, metric.space);
        Flow::go_on(Solution::start(Origin::of_metric(mesh, &metric, follows)?), options)
    }

    /// The same flow, whose flips these are told: triangulations as curves on [`Flow::mesh`].
    pub(crate) fn following(self, followed: Vec<NormalCoordinates>) -> Flow {
        Flow { followed, ..self }
    }

    /// The triangulation, the metric, and what was told of flips.
    pub(crate) fn into_parts(self) -> (Mesh, Metric, Vec<NormalCoordinates>) {
        (self.mesh, self.metric, self.followed)
    }

    fn go_on(from: Solution, options: &Options) -> Result<Flow> {
        options.check()?;
        let Solution { origin, mesh, mut metric, followed, flips, reached, .. } = from;
        let mesh = Arc::unwrap_or_clone(mesh);
        let rigid = origin.class.map_or(!may_flip(options, metric.space), |class| {
            is_rigid(origin.surface.geometry(), class, options)
        });
        let mut fixed = FixedEdges::new(origin.surface.mesh(), &options.fixed_edges)?;
        if let Some(double) = &origin.double {
            fixed = FixedEdges::new(&mesh, &double.with_images(&options.fixed_edges)?)?;
            // Rounding has told mirror images apart: they must be the same to begin with.
            for v in mesh.vertices().skip(double.n_half_vertices()) {
                let image = double.mirror(v);
                (metric.u[v], metric.u_low[v]) = (metric.u[image], metric.u_low[image]);
            }
        }
        let pool = Arc::new(Pool::new(options.threads)?);
        pool.run(|| metric.check_domain(&mesh))?;
        let mirror = origin
            .double
            .as_ref()
            .map(|double| mesh.vertices().map(|v| double.mirror(v).0).collect::<Vec<u32>>());
        let (start, start_low) = (metric.u.clone(), metric.u_low.clone());
        let mut flow = Flow {
            pinned: vec![false; mesh.n_vertices()],
            target: PerVertex::filled(mesh.n_vertices(), 0.0),
            origin,
            mesh,
            metric,
            start,
            start_low,
            options: options.clone(),
            flips_allowed: !rigid,
            fixed,
            mirror,
            followed,
            log: FlipLog::default(),
            flips,
            reached,
            one_copy: false,
            system: None,
            unseen_flips: 0,
            pool,
        };
        flow.hold(&options.pinned)?;
        Ok(flow)
    }

    /// Hold u at these vertices of the given surface, and at no others; their curvature is then free.
    ///
    /// A surface with boundary whose edges flip is on its double if no vertex is pinned: going there and leaving it the flow begins
    /// anew, as in [`Flow::resume`].
    ///
    /// # Errors
    /// Those of [`Flow::new`].
    pub fn pin(&mut self, pinned: &[VertexId], control: &Control) -> Result<()> {
        let options = Options { pinned: pinned.to_vec(), ..self.options.clone() };
        let given = self.origin.surface.mesh();
        let doubled = !given.is_closed() && pinned.is_empty();
        let stays = match self.origin.class {
            Some(_) if self.flips_allowed => suits(&self.solution(), doubled),
            _ => true,
        };
        if stays {
            self.hold(pinned)?;
            self.options = options;
        } else {
            *self = Flow::resume(&self.solution(), &options, control)?;
        }
        Ok(())
    }

    fn hold(&mut self, pinned: &[VertexId]) -> Result<()> {
        let given = self.origin.surface.mesh();
        let n = given.n_vertices();
        if let Some(v) = pinned.iter().find(|v| v.index() >= n) {
            let value = v.to_string();
            return Err(Error::Argument { what: "pinned vertex", value, need: "an existing vertex" });
        }
        let on_one_copy = self.origin.class.is_some() && self.origin.double.is_none() && !given.is_closed();
        self.one_copy = self.flips_allowed && on_one_copy && pinned.is_empty();
        self.pinned.fill(false);
        for &v in pinned {
            self.pinned[v.index()] = true;
            if let Some(double) = &self.origin.double {
                self.pinned[double.mirror(v).index()] = true;
            }
        }
        self.system = None;
        Ok(())
    }

    /// Set u per vertex of [`Flow::mesh`]: the start of the next solves, and the values held at pinned vertices.
    ///
    /// # Errors
    /// Those of [`Metric::lengths`] there; nothing has changed then.
    pub fn set_u(&mut self, u: PerVertex<f64>) -> Result<()> {
        let u_low = PerVertex::filled(u.len(), 0.0);
        let metric = Metric { u, u_low, ..self.metric.clone() };
        self.pool.run(|| metric.check_domain(&self.mesh))?;
        (self.start, self.start_low) = (metric.u.clone(), metric.u_low.clone());
        self.metric = metric;
        Ok(())
    }

    /// The same flow on the double, from the present u.
    pub(super) fn doubled(&self, control: &Control) -> Result<Flow> {
        let Origin { surface, class: Some(class), .. } = &*self.origin else {
            let value = "a metric without a surface".into();
            return Err(Error::Argument {
                what: "flow",
                value,
                need: "one on a surface, which can be doubled",
            });
        };
        let fixed = &self.options.fixed_edges;
        let double = || Origin::delaunay(surface.clone(), *class, true, fixed, control);
        let mut flow = Flow::go_on(Solution::start(self.pool.run(double)?), &self.options)?;
        if let Some(double) = &flow.origin.double {
            // Edges between imaginary circles may have no length there before they are flipped: then it begins from its own start.
            let _ = flow.set_u(double.spread_vertices(&self.metric.u)?.into());
        }
        Ok(flow)
    }

    /// The present metric, with what the last solve says of it.
    pub fn solution(&self) -> Solution {
        let given = self.origin.surface.mesh();
        let mesh = if self.mesh == **given { given.clone() } else { Arc::new(self.mesh.clone()) };
        Solution {
            origin: self.origin.clone(),
            mesh,
            metric: self.metric.clone(),
            followed: self.followed.clone(),
            flips: self.flips,
            reached: self.reached.clone(),
            threads: self.options.threads,
        }
    }

    /// The surface as it was given.
    pub fn surface(&self) -> &Surface {
        &self.origin.surface
    }

    /// The triangulation that flips have led to: of the surface, or of its double.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// The metric on it: the start, or where the last solve ended, converged or not.
    pub fn metric(&self) -> &Metric {
        &self.metric
    }

    /// Where the flow started, after the flips to Delaunay.
    pub fn initial(&self) -> &Initial {
        &self.origin.initial
    }

    /// The double, if the flow is one on it.
    pub fn double(&self) -> Option<&Double> {
        self.origin.double.as_ref()
    }

    /// Isometric flips before the flow.
    pub fn start_flips(&self) -> usize {
        self.origin.flips
    }

    /// A target on the given surface as one on [`Flow::mesh`]: on a double, curvature on both sides of the boundary adds up.
    ///
    /// # Errors
    /// [`Error::Size`] unless the target has an entry per vertex of the given surface.
    pub fn spread_target(&self, target: &PerVertex<f64>) -> Result<PerVertex<f64>> {
        self.origin.spread_target(target)
    }
}

/// Whether a flow can go on from a metric with its symmetry: `doubled`, or with a boundary that is an end.
fn suits(from: &Solution, doubled: bool) -> bool {
    if doubled { from.is_symmetric() } else { from.double().is_none() }
}

/// Whether these options let edges flip at all.
fn may_flip(options: &Options, space: Space) -> bool {
    options.flips == Flips::Auto && options.method == Method::Newton && space != Space::S2
}

/// Whether edges stay as they are: flips have no part in S² and for packings that are Delaunay on any triangulation.
fn is_rigid(geometry: Space, class: Class, options: &Options) -> bool {
    let packing = matches!(class.scheme, Scheme::Thurston | Scheme::Tangential);
    !may_flip(options, class.space) || geometry == Space::S2 || packing
}
