//! Lifts of edge paths, from corner to corner of a layout and on into its copies.

use super::space_layout::SpaceLayout;
use crate::error::Result;
use crate::geometry::motion::precise_point;
use crate::geometry::{Motion, Twofold};
use crate::mesh::{HalfedgeId, Mesh};
use crate::topology::corner_walk;

impl SpaceLayout {
    /// The vertices of the lift of an edge path that starts at the corner at the origin of `corner` (a half-edge of a face), in ambient
    /// coordinates: the start, then the end of each edge.
    ///
    /// A loop that starts at [`super::DeckGroup::corner`] ends where its element carries the start.
    /// [`crate::error::Error::Argument`] for a path that is none, or does not start at that corner.
    pub fn lift(&self, mesh: &Mesh, corner: HalfedgeId, path: &[HalfedgeId]) -> Result<Vec<[f64; 3]>> {
        let mut copy = Motion::identity(self.space);
        let place = |copy: &Motion<Twofold>, at: HalfedgeId| {
            copy.apply(precise_point(self.space, self.corner(at))).map(f64::from)
        };
        let walk = corner_walk(mesh, corner, path)?;
        let mut points = vec![place(&copy, corner)];
        for (crossed, at) in walk {
            copy = crossed.into_iter().fold(copy, |copy, h| copy.compose(&self.neighbour(h)));
            points.push(place(&copy, at));
        }
        Ok(points)
    }
}
