//! The start that flows on a surface share: the surface, its triangulation at the start, and the initial metric there.

use super::options::Options;
use crate::archive::{invalid, stored};
use crate::control::Control;
use crate::error::{Result, check_size};
use crate::mesh::{Double, EdgeId, FixedEdges, Flip, Mesh, NormalCoordinates, PerEdge};
use crate::metric::delaunay::{Triangulated, boundary_fails};
use crate::metric::start::{initial_on, make_delaunay};
use crate::metric::{Class, Initial, Metric, StartOptions, Surface};
use std::sync::Arc;

/// The start of flows on a surface.
#[derive(Debug)]
pub(super) struct FlowOrigin {
    pub surface: Surface,
    /// None for a metric of mixed types.
    pub class: Option<Class>,
    pub double: Option<Double>,
    /// The given surface with caps on its loops, if the metric lives there.
    pub caps: Option<Arc<Mesh>>,
    /// The metric that flows start from.
    pub initial: Initial,
    /// Isometric flips from the given triangulation to that of `initial`.
    pub flips: usize,
    /// The triangulation of `initial`, if isometric flips have made one.
    pub flipped: Option<FlippedStart>,
    /// Given edges that are not flipped.
    pub fixed: FixedEdges,
    /// True if edges may be flipped from here on.
    pub follows: bool,
    /// True if this start on one copy is one half of the start on the double, because no boundary edge would be flipped there.
    pub is_half: bool,
}
stored!(sections FlowOrigin { surface, class, double, caps, initial, flips, flipped, fixed, follows, is_half
    } check FlowOrigin::check_parts);

/// The triangulation that isometric flips have made.
#[derive(Debug)]
pub(super) struct FlippedStart {
    pub mesh: Arc<Mesh>,
    /// In the geometry of the surface.
    pub lengths: PerEdge<f64>,
    /// The given edges on it.
    pub given: NormalCoordinates,
}
stored!(sections FlippedStart { mesh, lengths, given });

/// Checks that a triangulation that flips have made has as many elements as the one before.
pub(super) fn check_same_size(mesh: &Mesh, before: &Mesh) -> Result<()> {
    check_size("vertices", mesh.n_vertices(), before.n_vertices())?;
    check_size("edges", mesh.n_edges(), before.n_edges())?;
    check_size("faces", mesh.n_faces(), before.n_faces())
}

impl FlowOrigin {
    /// The triangulation that flips before the flow start from: the given one, its double, or the one with caps.
    pub fn before_flips(&self) -> &Mesh {
        match (&self.double, &self.caps) {
            (Some(double), _) => &double.mesh,
            (None, Some(capped)) => capped,
            (None, None) => self.surface.mesh(),
        }
    }

    /// Checks that the arrays of an archive fit each other.
    fn check_parts(&self) -> Result<()> {
        let base = self.before_flips();
        let (given, n) = (self.surface.mesh(), base.n_vertices());
        if given.n_vertices() > n || given.n_edges() > base.n_edges() || given.n_faces() > base.n_faces() {
            return Err(invalid("triangulation of the start", "one that contains the given one"));
        }
        self.initial.metric.check_sizes(base)?;
        check_size("radii", self.initial.radii.len(), n)?;
        check_size("u of the input", self.initial.input_u.len(), n)?;
        let Some(FlippedStart { mesh, lengths, given }) = &self.flipped else { return Ok(()) };
        check_same_size(mesh, base)?;
        check_size("lengths of the start", lengths.len(), mesh.n_edges())?;
        given.check_size(mesh)
    }

    /// The initial metric on the given triangulation, whose edges stay.
    ///
    /// # Errors
    /// Those of [`Surface::initial`].
    pub fn rigid(surface: Surface, class: Class) -> Result<FlowOrigin> {
        let initial = surface.initial(class)?;
        Ok(FlowOrigin { class: Some(class), ..FlowOrigin::unflipped(surface, initial) })
    }

    /// A metric as it is, on its triangulation; `follows`: edges may be flipped from there on.
    pub fn of_metric(mesh: Mesh, metric: &Metric, follows: bool) -> Result<FlowOrigin> {
        let lengths = metric.lengths(&mesh)?;
        let initial = Initial::of_metric(metric.clone())?;
        let surface = Surface::intrinsic(mesh, lengths, metric.space)?;
        Ok(FlowOrigin { follows, ..FlowOrigin::unflipped(surface, initial) })
    }

    fn unflipped(surface: Surface, initial: Initial) -> FlowOrigin {
        FlowOrigin {
            surface,
            class: None,
            double: None,
            caps: None,
            initial,
            flips: 0,
            flipped: None,
            fixed: FixedEdges::none(),
            follows: false,
            is_half: false,
        }
    }

    /// The initial metric on the (weighted) Delaunay triangulation of the surface or, if it is `doubled`, of its double
    /// ([`crate::metric::delaunay_start`]). `fixed` edges are not flipped.
    pub fn delaunay(
        surface: Surface,
        class: Class,
        doubled: bool,
        fixed: &[EdgeId],
        control: &Control,
    ) -> Result<FlowOrigin> {
        let given = surface.mesh();
        let double = if doubled { Some(Double::new(given)?) } else { None };
        let (mesh, lengths, all_fixed) = match &double {
            Some(d) => (d.mesh.clone(), d.spread_edges(surface.lengths())?.into(), d.with_images(fixed)?),
            None => (Mesh::clone(given), PerEdge::clone(surface.lengths()), fixed.to_vec()),
        };
        let all_fixed = FixedEdges::new(&mesh, &all_fixed)?;
        // The first flip makes the normal coordinates, on the triangulation before it, which is still the given one.
        let (mut normal, mut flips) = (None, 0);
        let mut record = |mesh: &Mesh, flip: Flip| {
            normal.get_or_insert_with(|| NormalCoordinates::new(mesh)).record(mesh, flip.edge);
            flips += 1;
        };
        let mut triangulated = Triangulated { mesh, lengths, geometry: surface.geometry() };
        let options = StartOptions { class, double: double.as_ref(), fixed: &all_fixed };
        let radii = make_delaunay(&mut triangulated, options, &mut record, control)?;
        let fixed = FixedEdges::new(given, fixed)?;
        let initial = initial_on(&triangulated, class, radii)?;
        let Triangulated { mesh, lengths, .. } = triangulated;
        let metric = &initial.metric;
        let is_half = double.is_none() && !boundary_fails(&mesh, metric, &metric.u, &all_fixed);
        let flipped = normal.map(|given| FlippedStart { mesh: Arc::new(mesh), lengths, given });
        let class = Some(class);
        Ok(FlowOrigin {
            surface,
            class,
            double,
            caps: None,
            initial,
            flips,
            flipped,
            fixed,
            follows: true,
            is_half,
        })
    }

    /// The initial metric on the Delaunay triangulation of a surface with caps on its loops, whose vertices, edges and faces come first
    /// among those of `capped`.
    pub fn with_caps(
        surface: Surface,
        capped: Surface,
        class: Class,
        options: &Options,
        control: &Control,
    ) -> Result<FlowOrigin> {
        let mesh = capped.mesh().clone();
        let origin = FlowOrigin::delaunay(capped, class, false, &options.fixed_edges, control)?;
        Ok(FlowOrigin { surface, caps: Some(mesh), ..origin })
    }

    /// The triangulation at the start, and the edges that are followed from there through flips: the given ones, and those of the
    /// start if they are others.
    pub fn start(&self) -> (Arc<Mesh>, Vec<NormalCoordinates>) {
        let mesh = match (&self.flipped, &self.double, &self.caps) {
            (Some(flipped), ..) => flipped.mesh.clone(),
            (None, Some(double), _) => Arc::new(double.mesh.clone()),
            (None, None, Some(capped)) => capped.clone(),
            (None, None, None) => self.surface.mesh().clone(),
        };
        let given = self.flipped.as_ref().map(|flipped| flipped.given.clone());
        let own = self.follows.then(|| NormalCoordinates::new(&mesh));
        (mesh, given.into_iter().chain(own).collect())
    }
}
