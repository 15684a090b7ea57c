//! The map from the plane of a punctured sphere to the unit disk.

use super::super::star::PuncturedSurface;
use super::precise_map::{PreciseCircle, PreciseMap, PrecisePlanePoint, precise, rounded, size};
use crate::geometry::Mobius;
use crate::geometry::complex::{Complex, add, scale, sub};
use crate::geometry::double_double::two_sum;
use crate::geometry::mobius::PlaneCircle;
use crate::mesh::{FilledMesh, PerVertex, VertexId};
use crate::metric::Metric;

/// A point of the unit disk that is moved to its centre before anchors are placed. Without it the vertex that was sent to infinity and
/// the outer hub would both lie at 0, and the edge between them have no direction.
const OFF_CENTRE: Complex = [0.31, 0.17];

/// The map from the plane of a punctured sphere to the unit disk, with the circles of the hubs.
#[derive(Clone)]
pub(super) struct DiskView {
    map: PreciseMap,
    /// The same, with another point at the centre, for anchors.
    off_centre: PreciseMap,
    /// The circles of the hubs in the plane.
    circles: Vec<PreciseCircle>,
    outer: usize,
    puncture: VertexId,
    n_points: usize,
}

impl DiskView {
    /// The outside of the outer circle on the unit disk.
    pub fn new(
        on: &PuncturedSurface,
        plane: &PerVertex<PrecisePlanePoint>,
        filled: &FilledMesh,
        outer: usize,
    ) -> DiskView {
        let hubs = filled.hubs();
        let circle = |&v: &VertexId| PreciseCircle { centre: plane[v], radius: on.metric.u[v].exp().into() };
        let circles: Vec<PreciseCircle> = hubs.iter().map(circle).collect();
        let map = PreciseMap::outside(circles[outer]);
        let off_centre = PreciseMap::from(&Mobius::to_origin(OFF_CENTRE)).after(&map);
        DiskView { map, off_centre, circles, outer, puncture: on.at, n_points: plane.len() - hubs.len() }
    }

    /// Followed by a transformation of the disk.
    pub fn then(&self, next: &Mobius) -> DiskView {
        DiskView { map: PreciseMap::from(next).after(&self.map), ..self.clone() }
    }

    /// The circle of a hub in the disk.
    pub fn circle(&self, k: usize) -> PlaneCircle {
        self.circle_seen(&self.map, k).rounded()
    }

    fn circle_seen(&self, map: &PreciseMap, k: usize) -> PreciseCircle {
        if k == self.outer {
            PreciseCircle { centre: precise([0.0; 2]), radius: 1.0.into() }
        } else {
            map.apply_to_circle(self.circles[k])
        }
    }

    fn seen(&self, map: &PreciseMap, plane: &PerVertex<PrecisePlanePoint>, v: VertexId) -> PrecisePlanePoint {
        match v.index().checked_sub(self.n_points) {
            Some(k) => self.circle_seen(map, k).centre,
            None if v == self.puncture => map.at_infinity(),
            None => map.apply(plane[v]),
        }
    }

    /// The vertices in the disk, hubs at the centres of their circles.
    pub fn apply(&self, plane: &PerVertex<PrecisePlanePoint>) -> PerVertex<Complex> {
        PerVertex::from_fn(plane.len(), |v| rounded(self.seen(&self.map, plane, v)))
    }

    /// The metric of the class with the lengths of the disk.
    pub fn metric(&self, on: &PuncturedSurface, plane: &PerVertex<PrecisePlanePoint>) -> Metric {
        let mut metric = on.metric.clone();
        for v in on.mesh.vertices() {
            let by = match v.index().checked_sub(self.n_points) {
                Some(k) => {
                    (metric.u[v], metric.u_low[v]) = (self.circle(k).radius.ln(), 0.0);
                    continue;
                }
                None if v == self.puncture => self.map.log_scale_at_infinity(),
                None => self.map.log_scale(plane[v]),
            };
            let (sum, lost) = two_sum(metric.u[v], by);
            (metric.u[v], metric.u_low[v]) = two_sum(sum, lost + metric.u_low[v]);
        }
        metric
    }

    /// The anchor of hub k: the point where the edge to the vertex `to` leaves its circle. It is found in the disk moved off the centre,
    /// then brought to the disk.
    pub fn anchor(&self, plane: &PerVertex<PrecisePlanePoint>, k: usize, to: VertexId) -> Complex {
        let PreciseCircle { centre, radius } = self.circle_seen(&self.off_centre, k);
        let away = sub(self.seen(&self.off_centre, plane, to), centre);
        // The outer circle is seen from its other side.
        let radius = if to.index() == self.n_points + self.outer { -radius } else { radius };
        let at = add(centre, scale(radius / size(away), away));
        rounded(self.map.after(&self.off_centre.inverse()).apply(at))
    }
}
