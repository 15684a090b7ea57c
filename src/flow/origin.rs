//! What all metrics that flow from one start share: the surface, its triangulation at the start, and the initial metric there.

use crate::control::Control;
use crate::error::Result;
use crate::mesh::{Double, EdgeId, FaceId, FixedEdges, Flip, Mesh, NormalCoordinates, PerEdge};
use crate::metric::delaunay::{Triangulated, boundary_fails};
use crate::metric::refinement::{Final, Input, Intrinsic, Triangulations};
use crate::metric::start::{initial_on, make_delaunay};
use crate::metric::{Class, Initial, Metric, Refinement, StartOptions, Surface};
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
    /// The triangulation of `initial`, if isometric flips have made one.
    pub flipped: Option<Flipped>,
    /// Given edges that are not flipped.
    pub fixed: FixedEdges,
    /// Whether edges may be flipped from here on.
    pub follows: bool,
    /// Whether this start on one copy is one half of the start on the double, as it is where no boundary edge would be flipped there.
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
    ///
    /// # Errors
    /// Those of [`Surface::initial`].
    pub fn rigid(surface: Surface, class: Class) -> Result<Origin> {
        let initial = surface.initial(class)?;
        Ok(Origin { class: Some(class), ..Origin::unflipped(surface, initial) })
    }

    /// A metric as it is, on its triangulation; `follows`: edges may be flipped from there on.
    pub fn of_metric(mesh: Mesh, metric: &Metric, follows: bool) -> Result<Origin> {
        let lengths = metric.lengths(&mesh)?;
        let initial = Initial::of_metric(metric.clone())?;
        let surface = Surface::intrinsic(mesh, lengths, metric.space)?;
        Ok(Origin { follows, ..Origin::unflipped(surface, initial) })
    }

    fn unflipped(surface: Surface, initial: Initial) -> Origin {
        Origin {
            surface,
            class: None,
            double: None,
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
    ) -> Result<Origin> {
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
        let flipped = normal.map(|given| Flipped { mesh: Arc::new(mesh), lengths, given });
        let class = Some(class);
        Ok(Origin { surface, class, double, initial, flips, flipped, fixed, follows: true, is_half })
    }

    /// The triangulation at the start, and the edges that are followed from there through flips: the given ones, and those of the
    /// start if they are others.
    pub fn start(&self) -> (Arc<Mesh>, Vec<NormalCoordinates>) {
        let mesh = match (&self.flipped, &self.double) {
            (Some(flipped), _) => flipped.mesh.clone(),
            (None, Some(double)) => Arc::new(double.mesh.clone()),
            (None, None) => self.surface.mesh().clone(),
        };
        let given = self.flipped.as_ref().map(|flipped| flipped.given.clone());
        let own = self.follows.then(|| NormalCoordinates::new(&mesh));
        (mesh, given.into_iter().chain(own).collect())
    }

    /// The common refinement of the given triangulation with that of a metric, on the given faces that `keep` names, of a double on its
    /// first half.
    pub fn refinement(
        &self,
        (mesh, metric, followed): (&Mesh, &Metric, &[NormalCoordinates]),
        keep: &dyn Fn(FaceId) -> bool,
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
        let keep = |f| keep(f) && self.double.as_ref().is_none_or(|double| double.is_original(f));
        let result = Final { mesh, metric, normal };
        Refinement::new(Triangulations { input, intrinsic, result }, &keep, control)
    }
}
