//! Nodes of a T-mesh: vertices, places on edges and in triangles, with the directions along the axes around them.

use super::grid_surface::GridSurface;
use super::grid_vector::{Axis, GridMotion, GridPoint, cross, dot, doubled_area, unit};
use crate::mesh::{EdgeId, FaceId, HalfedgeId, VertexId};

/// A node by its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum NodeKey {
    /// A vertex.
    Vertex(VertexId),
    /// A place inside an edge, in the coordinates of the face of its first half-edge that has one.
    Edge(EdgeId, GridPoint),
    /// A place inside a triangle, in its coordinates.
    Face(FaceId, GridPoint),
}

/// The directions around a node that is no vertex.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct NodeSlots {
    /// On the boundary the direction along it that has the surface to its left.
    first: Axis,
    /// False on the boundary.
    pub is_closed: bool,
}

impl NodeSlots {
    /// The number of the direction along an axis of the node's coordinates.
    pub fn of_axis(&self, axis: Axis) -> usize {
        usize::from((axis + 4 - self.first) % 4)
    }

    /// The axis of a direction.
    pub fn axis(&self, slot: usize) -> Axis {
        (slot as Axis + self.first) % 4
    }

    /// The number of directions that lead into the surface or along its boundary.
    pub fn len(&self) -> usize {
        if self.is_closed { 4 } else { 3 }
    }
}

impl NodeKey {
    /// A point of a face's coordinates as a node, and the quarter turns from these coordinates to the node's; none outside of the face and at
    /// its corners.
    pub fn in_face(surface: &GridSurface, f: FaceId, point: GridPoint) -> Option<(NodeKey, Axis)> {
        if !surface.contains(f, point) || surface.corners(f).contains(&point) {
            return None;
        }
        let is_on = |h: &HalfedgeId| doubled_area(surface.origin(*h), surface.tip(*h), point) == 0;
        Some(match surface.mesh.face_halfedges(f).into_iter().find(is_on) {
            Some(h) => NodeKey::on_edge(surface, h, point),
            None => (NodeKey::Face(f, point), 0),
        })
    }

    /// A point on a half-edge, in the coordinates of its face, as a node; and the quarter turns from these coordinates to the node's.
    pub fn on_edge(surface: &GridSurface, h: HalfedgeId, point: GridPoint) -> (NodeKey, Axis) {
        let first = first_halfedge(surface, h.edge());
        if h == first {
            return (NodeKey::Edge(h.edge(), point), 0);
        }
        let across = surface.across(h);
        (NodeKey::Edge(h.edge(), across.apply(point)), across.turns)
    }

    /// The directions around a node that is no vertex.
    pub fn slots(&self, surface: &GridSurface) -> NodeSlots {
        match *self {
            NodeKey::Edge(e, _) if surface.mesh.is_boundary_edge(e) => {
                let along = surface.axis_along(first_halfedge(surface, e));
                NodeSlots { first: along.unwrap_or(0), is_closed: false }
            }
            _ => NodeSlots { first: 0, is_closed: true },
        }
    }

    /// The face that lies to the left of a direction at the node, and the motion from its coordinates to those in which the node is the
    /// origin and the direction is +x.
    pub fn frame(&self, surface: &GridSurface, slot: usize) -> Option<(FaceId, GridMotion)> {
        let mesh = &surface.mesh;
        match *self {
            NodeKey::Vertex(v) => {
                let slot = *surface.slots(v).get(slot)?;
                let motion = GridMotion::to_origin(surface.origin(slot.halfedge), slot.axis);
                Some((mesh.face(slot.halfedge)?, motion))
            }
            NodeKey::Face(f, point) => {
                Some((f, GridMotion::to_origin(point, self.slots(surface).axis(slot))))
            }
            NodeKey::Edge(e, point) => {
                let h = first_halfedge(surface, e);
                let axis = self.slots(surface).axis(slot);
                let motion = GridMotion::to_origin(point, axis);
                let side = cross(surface.vector(h), unit(axis));
                if side > 0 || side == 0 && dot(surface.vector(h), unit(axis)) > 0 {
                    return Some((mesh.face(h)?, motion));
                }
                let twin = h.twin();
                Some((mesh.face(twin)?, motion.after(&surface.across(twin))))
            }
        }
    }

    /// The barycentric coordinates of the node in a triangle.
    pub fn place(&self, surface: &GridSurface) -> Option<(FaceId, [f64; 3])> {
        let mesh = &surface.mesh;
        match *self {
            NodeKey::Vertex(v) => {
                let (f, k) = mesh.corner(*mesh.fan(v).first()?)?;
                let mut weights = [0.0; 3];
                weights[k] = 1.0;
                Some((f, weights))
            }
            NodeKey::Edge(e, point) => {
                let f = mesh.face(first_halfedge(surface, e))?;
                Some((f, weights(surface.corners(f), point)))
            }
            NodeKey::Face(f, point) => Some((f, weights(surface.corners(f), point))),
        }
    }
}

/// The half-edge 2e, or the other one where that has no face.
pub(super) fn first_halfedge(surface: &GridSurface, e: EdgeId) -> HalfedgeId {
    let h = e.halfedge();
    if surface.mesh.is_outside(h) { h.twin() } else { h }
}

/// Barycentric coordinates of a point of a triangle.
fn weights([a, b, c]: [GridPoint; 3], p: GridPoint) -> [f64; 3] {
    let total = doubled_area(a, b, c) as f64;
    [doubled_area(p, b, c), doubled_area(p, c, a), doubled_area(p, a, b)].map(|area| area as f64 / total)
}
