//! What all metrics that flow from one start share: the surface, its triangulation at the start, and the initial metric there.

use crate::control::Control;
use crate::error::{Error, Result};
use crate::mesh::{Double, EdgeId, Mesh, NormalCoordinates, PerEdge, PerVertex};
use crate::metric::delaunay::boundary_fails;
use crate::metric::refinement::{Final, Input, Intrinsic};
use crate::metric::{Class, Initial, Metric, Refinement, Surface, delaunay_start};
use std::sync::Arc;

/// Where flows on a surface start.
#[derive(Debug)]
pub(super) struct Origin {
    pub surface: Surface,
    /// None for a metric of mixed types.
    pub class: Option<Class>,
    pub double: Option<Double>,
    /// The metric that flows start from.
    pub initial: Initial,
    /// Isometric flips from the given triangulation to that of `initial`.
    pub flips: usize,
    /// The latter, if that is another one.
    pub flipped: Option<Flipped>,
    /// Given edges that are not flipped, ascending.
    pub fixed: Vec<EdgeId>,
    /// Whether edges may be flipped from here on.
    pub follows: bool,
    /// Whether this start, of one copy, is half of what its double's is: there no boundary edge would be flipped.
    pub is_half: bool,
}

/// The triangulation that isometric flips have made.
#[derive(Debug)]
pub(super) struct Flipped {
    pub mesh: Arc<Mesh>,
    /// In the geometry of the surface.
    pub lengths: PerEdge<f64>,
    /// The given edges on it.
    pub given: NormalCoordinates,
}

impl Origin {
    /// The initial metric on the given triangulation, whose edges stay.
    pub fn rigid(surface: Surface, class: Class) -> Result<Origin> {
        let initial = surface.initial(class)?;
        Ok(Origin {
            surface,
            class: Some(class),
            double: None,
            initial,
            flips: 0,
            flipped: None,
            fixed: Vec::new(),
            follows: false,
            is_half: false,
        })
    }

    /// A metric as it is, on its triangulation; `follows`: edges may be flipped from there on.
    pub fn of_metric(mesh: Mesh, metric: &Metric, follows: bool) -> Result<Origin> {
        let lengths = metric.lengths(&mesh)?;
        let initial = Initial::of_metric(metric.clone());
        let surface = Surface::intrinsic(mesh, lengths, metric.space)?;
        Ok(Origin {
            surface,
            class: None,
            double: None,
            initial,
            flips: 0,
            flipped: None,
            fixed: Vec::new(),
            follows,
            is_half: false,
        })
    }

    /// The initial metric on the (weighted) Delaunay triangulation, of the surface or, if it is `doubled`, of its double:
    /// [`delaunay_start`]. `fixed` edges are not flipped.
    pub fn delaunay(
        surface: Surface,
        class: Class,
        doubled: bool,
        fixed: &[EdgeId],
        control: &Control,
    ) -> Result<Origin> {
        check_fixed(surface.mesh(), fixed)?;
        let given = surface.mesh();
        let double = if doubled { Some(Double::new(given)?) } else { None };
        let (mut mesh, mut lengths, all_fixed) = match &double {
            Some(d) => (d.mesh.clone(), d.spread_edges(surface.lengths()).into(), d.with_images(fixed)),
            None => (Mesh::clone(given), PerEdge::clone(surface.lengths()), fixed.to_vec()),
        };
        let mut normal = NormalCoordinates::new(&mesh);
        let mut flips = 0;
        let mut record = |mesh: &Mesh, e| {
            normal.record(mesh, e);
            flips += 1;
        };
        let initial = delaunay_start(
            &mut mesh,
            &mut lengths,
            surface.geometry(),
            class.scheme,
            class.space,
            double.as_ref(),
            &all_fixed,
            &mut record,
            control,
        )?;
        let metric = &initial.metric;
        let is_half = double.is_none() && !boundary_fails(&mesh, metric, &metric.u, fixed);
        let flipped = (flips > 0).then(|| Flipped { mesh: Arc::new(mesh), lengths, given: normal });
        let (class, fixed) = (Some(class), ascending(fixed));
        Ok(Origin { surface, class, double, initial, flips, flipped, fixed, follows: true, is_half })
    }

    /// The triangulation at the start, and what is followed through flips from there: the given edges, and those of the start if
    /// they are others.
    pub fn start(&self) -> (Arc<Mesh>, Vec<NormalCoordinates>) {
        let unflipped = || match &self.double {
            Some(double) => Arc::new(double.mesh.clone()),
            None => self.surface.mesh().clone(),
        };
        match &self.flipped {
            Some(flipped) => {
                (flipped.mesh.clone(), vec![flipped.given.clone(), NormalCoordinates::new(&flipped.mesh)])
            }
            None if self.follows => {
                let mesh = unflipped();
                let normal = NormalCoordinates::new(&mesh);
                (mesh, vec![normal])
            }
            None => (unflipped(), Vec::new()),
        }
    }

    /// A target on the given surface as one on what flows: on a double, curvature on both sides of the boundary adds up.
    pub fn spread_target(&self, target: &PerVertex<f64>) -> PerVertex<f64> {
        self.double.as_ref().map_or_else(|| target.clone(), |double| double.target(target).into())
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
        let given = self.double.as_ref().map_or(&**self.surface.mesh(), |double| &double.mesh);
        let input = Input { mesh: given, geometry: self.initial.input_geometry, u: &self.initial.input_u };
        let keep = |f| self.double.as_ref().is_none_or(|double| double.is_original(f));
        Refinement::new(input, intrinsic, Final { mesh, metric, normal }, &keep, control)
    }
}

/// Every edge exists.
pub(super) fn check_fixed(given: &Mesh, fixed: &[EdgeId]) -> Result<()> {
    let missing = fixed.iter().find(|e| e.index() >= given.n_edges());
    missing.map_or(Ok(()), |e| {
        Err(Error::Argument { what: "fixed edge", value: e.to_string(), need: "an existing edge" })
    })
}

pub(super) fn ascending(edges: &[EdgeId]) -> Vec<EdgeId> {
    let mut edges = edges.to_vec();
    edges.sort_unstable();
    edges.dedup();
    edges
}
