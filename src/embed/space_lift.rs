//! Lifts of edge paths, from corner to corner of a layout and on into its copies.

use super::space_layout::SpaceLayout;
use crate::error::{Error, Result};
use crate::geometry::motion::precise_point;
use crate::geometry::{Motion, Twofold};
use crate::mesh::{HalfedgeId, Mesh};
use crate::topology::check_path;

impl SpaceLayout {
    /// The vertices of the lift of an edge path that starts at the corner at the origin of `corner` (a half-edge of a face), in ambient
    /// coordinates: the start, then the end of each edge.
    ///
    /// A loop that starts at [`super::DeckGroup::corner`] ends where its element carries the start. [`Error::Argument`] for a path that
    /// is none, or does not start at that corner.
    pub fn lift(&self, mesh: &Mesh, corner: HalfedgeId, path: &[HalfedgeId]) -> Result<Vec<[f64; 3]>> {
        check_path(mesh, path)?;
        let starts = |h: HalfedgeId| {
            !mesh.is_outside(h) && path.first().is_none_or(|&p| mesh.origin(p) == mesh.origin(h))
        };
        if corner.index() >= mesh.n_halfedges() || !starts(corner) {
            return Err(Error::Argument {
                what: "corner",
                value: format!("half-edge {corner}"),
                need: "take a half-edge of a face at the vertex where the path starts",
            });
        }
        let (mut at, mut copy) = (corner, Motion::identity(self.space));
        let place = |copy: &Motion<Twofold>, at: HalfedgeId| {
            copy.apply(precise_point(self.space, self.corner(at))).map(f64::from)
        };
        let mut points = vec![place(&copy, at)];
        for &h in path {
            // Outside the surface the way back along the twin.
            let (from, to) = match mesh.is_outside(h) {
                false => (h, mesh.next(h)),
                true => (mesh.next(h.twin()), h.twin()),
            };
            copy = copy.compose(&self.turn(mesh, at, from));
            at = to;
            points.push(place(&copy, at));
        }
        Ok(points)
    }

    /// Into which copy of the opened surface one comes, turning about a vertex from one of its corners to another: counterclockwise,
    /// unless the boundary is in the way.
    fn turn(&self, mesh: &Mesh, from: HalfedgeId, to: HalfedgeId) -> Motion<Twofold> {
        let (mut h, mut copy) = (from, Motion::identity(self.space));
        while h != to && !mesh.is_boundary_edge(mesh.prev(h).edge()) {
            copy = copy.compose(&self.neighbour(mesh.prev(h)));
            h = mesh.prev(h).twin();
        }
        if h == to {
            return copy;
        }
        (h, copy) = (from, Motion::identity(self.space));
        while h != to && !mesh.is_boundary_edge(h.edge()) {
            copy = copy.compose(&self.neighbour(h));
            h = mesh.next(h.twin());
        }
        copy
    }
}
