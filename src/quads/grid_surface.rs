//! A seamless map in whole numbers: corners of the metric's triangles on a grid, and across every edge a rotation by a multiple of 90° with
//! a translation, so that lines along the axes are followed without rounding.

use super::grid_vector::{Axis, GridMotion, GridPoint, cross, dot, doubled_area, minus, unit};
use crate::control::Control;
use crate::embed::{Layout, LayoutOpening, LayoutOptions, LayoutScale};
use crate::error::{Error, Result};
use crate::mesh::{EdgeId, FaceId, HalfedgeId, Mesh, PerEdge, PerHalfedge, VertexId};
use crate::seamless::Seamless;
use crate::topology::cut_graph;
use std::sync::Arc;

/// Most bits of a coordinate in units of the grid.
const MOST_BITS: i32 = 53;

/// A direction along an axis at a vertex: it leaves along the half-edge or into its face, before the next half-edge counterclockwise.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct VertexSlot {
    /// A half-edge from the vertex, in the face in whose coordinates the direction is given.
    pub halfedge: HalfedgeId,
    /// The direction.
    pub axis: Axis,
    /// True if a wall leaves in this direction.
    pub is_wall: bool,
}

/// The metric's triangulation in whole coordinates.
#[derive(Debug, Clone)]
pub(super) struct GridSurface {
    pub mesh: Arc<Mesh>,
    /// Per half-edge the place of its origin in the coordinates of its face, even numbers.
    place: PerHalfedge<GridPoint>,
    /// Per half-edge the motion from the coordinates of its face to those of the face across.
    across: PerHalfedge<GridMotion>,
    /// Edges of the boundary and features that are parallel to an axis.
    pub is_wall: PerEdge<bool>,
    /// Features that are not parallel to an axis exactly.
    pub off_axis: Vec<EdgeId>,
}

impl GridSurface {
    /// The surface of a seamless metric, cut along edges of the metric's own triangulation and brought to a grid.
    ///
    /// # Errors
    /// [`Error::Layout`] for a metric whose seams are not seamless, and where rounding to the grid turns a triangle over; those of
    /// [`Layout::of_solution`].
    pub fn new(seamless: &Seamless, control: &Control) -> Result<GridSurface> {
        let solution = &seamless.solution;
        let mesh = solution.mesh();
        let lengths = solution.metric().lengths(mesh)?;
        let cones: Vec<VertexId> =
            seamless.cones.iter().map(|cone| cone.vertex).filter(|&v| !mesh.is_boundary_vertex(v)).collect();
        let cut = cut_graph(mesh, &lengths, &cones, control)?;
        let options = LayoutOptions {
            opening: LayoutOpening::MetricCut(cut),
            cones: Some(cones),
            scale: LayoutScale::AsSolved,
            ..LayoutOptions::default()
        };
        let mut layout = Layout::of_solution(solution, &options, control)?;
        let inside = |e: &EdgeId| {
            let h = e.halfedge();
            if mesh.is_outside(h) { h.twin() } else { h }
        };
        let features: Vec<HalfedgeId> = seamless.features.iter().map(inside).collect();
        if let Some(&h) = features.first() {
            layout.align(h)?;
        }
        let inner: Vec<HalfedgeId> =
            features.iter().copied().filter(|h| !mesh.is_boundary_edge(h.edge())).collect();
        layout.make_seams_exact(&inner)?;
        GridSurface::from_places(mesh.clone(), &|h| layout.uv(h), &seamless.features)
    }

    /// The surface with dyadic coordinates, of the origin of each half-edge in its face.
    pub fn from_places(
        mesh: Arc<Mesh>,
        uv: &dyn Fn(HalfedgeId) -> [f64; 2],
        features: &[EdgeId],
    ) -> Result<GridSurface> {
        let inside = |h: &HalfedgeId| !mesh.is_outside(*h);
        let numbers = mesh.halfedges().filter(inside).flat_map(uv);
        let (mut lowest, mut highest) = (i32::MAX, i32::MIN);
        for x in numbers.filter(|x| *x != 0.0) {
            let (low, high) = bits(x);
            (lowest, highest) = (lowest.min(low), highest.max(high));
        }
        if highest.saturating_sub(lowest) > MOST_BITS || highest < lowest {
            return Err(Error::Layout(format!(
                "coordinates have bits from 2^{lowest} to 2^{highest}, more than a grid of {MOST_BITS} bits has"
            )));
        }
        let per_unit = 2f64.powi(1 - lowest);
        let mut place = PerHalfedge::filled(mesh.n_halfedges(), [0, 0]);
        for h in mesh.halfedges().filter(inside) {
            place[h] = uv(h).map(|x| (x * per_unit) as i64);
        }
        let mut surface = GridSurface {
            across: PerHalfedge::filled(mesh.n_halfedges(), GridMotion::IDENTITY),
            is_wall: PerEdge::filled(mesh.n_edges(), false),
            off_axis: Vec::new(),
            place,
            mesh,
        };
        surface.connect()?;
        surface.mark_walls(features)?;
        Ok(surface)
    }

    /// Finds the motions across edges; checks that no triangle is turned over.
    fn connect(&mut self) -> Result<()> {
        let mesh = self.mesh.clone();
        for f in mesh.faces() {
            let [a, b, c] = mesh.face_halfedges(f).map(|h| self.place[h]);
            if doubled_area(a, b, c) <= 0 {
                return Err(Error::Layout(format!("face {f} of the metric has no area on the grid")));
            }
        }
        for h in mesh.halfedges() {
            if mesh.is_boundary_edge(h.edge()) {
                continue;
            }
            let t = h.twin();
            let motion = GridMotion::between([self.place[h], self.tip(h)], [self.tip(t), self.place[t]]);
            self.across[h] = motion.ok_or_else(|| {
                Error::Layout(format!(
                    "edge {} has two sides that do not differ by a multiple of 90°",
                    h.edge()
                ))
            })?;
        }
        Ok(())
    }

    fn mark_walls(&mut self, features: &[EdgeId]) -> Result<()> {
        let mesh = self.mesh.clone();
        for h in mesh.halfedges().filter(|&h| !mesh.is_outside(h)) {
            let e = h.edge();
            let is_boundary = mesh.is_boundary_edge(e);
            let is_first = mesh.is_outside(h.twin()) || h == e.halfedge();
            if !is_first || !(is_boundary || features.binary_search(&e).is_ok()) {
                continue;
            }
            if self.axis_along(h).is_some() {
                self.is_wall[e] = true;
            } else if is_boundary {
                return Err(Error::Layout(format!("boundary edge {e} is not parallel to an axis")));
            } else {
                self.off_axis.push(e);
            }
        }
        Ok(())
    }

    /// The place of a half-edge's origin in the coordinates of its face.
    pub fn origin(&self, h: HalfedgeId) -> GridPoint {
        self.place[h]
    }

    /// The place of a half-edge's tip in the coordinates of its face.
    pub fn tip(&self, h: HalfedgeId) -> GridPoint {
        self.place[self.mesh.next(h)]
    }

    /// A half-edge as a vector in the coordinates of its face.
    pub fn vector(&self, h: HalfedgeId) -> GridPoint {
        minus(self.tip(h), self.place[h])
    }

    /// The motion from the coordinates of the half-edge's face to those of the face across.
    pub fn across(&self, h: HalfedgeId) -> GridMotion {
        self.across[h]
    }

    /// The axis along which a half-edge runs, if it does.
    pub fn axis_along(&self, h: HalfedgeId) -> Option<Axis> {
        let v = self.vector(h);
        (0..4).find(|&k| cross(unit(k), v) == 0 && dot(unit(k), v) > 0)
    }

    /// The corners of a face in its coordinates.
    pub fn corners(&self, f: FaceId) -> [GridPoint; 3] {
        self.mesh.face_halfedges(f).map(|h| self.place[h])
    }

    /// True if a point of the coordinates of a face lies in it, its border included.
    pub fn contains(&self, f: FaceId, p: GridPoint) -> bool {
        let [a, b, c] = self.corners(f);
        doubled_area(a, b, p) >= 0 && doubled_area(b, c, p) >= 0 && doubled_area(c, a, p) >= 0
    }

    /// The directions along the axes around a vertex, counterclockwise; on the boundary from one of its edges to the other.
    pub fn slots(&self, v: VertexId) -> Vec<VertexSlot> {
        let mesh = &*self.mesh;
        let mut slots = Vec::new();
        let fan = mesh.fan(v);
        for &h in &fan {
            let (begin, back) = (self.vector(h), mesh.prev(h));
            let end = minus([0, 0], self.vector(back));
            let is_within = |&k: &Axis| {
                let c = cross(begin, unit(k));
                (c > 0 || c == 0 && dot(begin, unit(k)) > 0) && cross(unit(k), end) > 0
            };
            let mut here: Vec<Axis> = (0..4).filter(is_within).collect();
            // Two directions in one corner are a right angle apart.
            if here.len() == 2 && (here[0] + 1) % 4 != here[1] {
                here.reverse();
            }
            let is_wall = |k: Axis| cross(begin, unit(k)) == 0 && self.is_wall[h.edge()];
            slots.extend(here.into_iter().map(|axis| VertexSlot {
                halfedge: h,
                axis,
                is_wall: is_wall(axis),
            }));
        }
        if let (true, Some(&h)) = (mesh.is_boundary_vertex(v), fan.last())
            && let Some(axis) = self.axis_along(mesh.prev(h))
        {
            slots.push(VertexSlot { halfedge: h, axis: (axis + 2) % 4, is_wall: true });
        }
        slots
    }
}

/// The lowest and the highest bit that is set in a number other than 0: x is a multiple of 2^low, and below 2^high.
fn bits(x: f64) -> (i32, i32) {
    let raw = x.abs().to_bits();
    let (exponent, fraction) = ((raw >> 52) as i32, raw & ((1 << 52) - 1));
    let mantissa = if exponent == 0 { fraction } else { fraction | 1 << 52 };
    let base = exponent.max(1) - 1075;
    (base + mantissa.trailing_zeros() as i32, base + 64 - mantissa.leading_zeros() as i32)
}

#[cfg(test)]
mod tests {
    use super::bits;

    #[test]
    fn bits_of_numbers() {
        assert_eq!(bits(1.0), (0, 1));
        assert_eq!(bits(-0.75), (-2, 0));
        assert_eq!(bits(6.0), (1, 3));
    }
}
