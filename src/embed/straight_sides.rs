//! Layouts in H² as files hold them: triangles with straight sides in the Poincaré disk, where lines of H² are arcs. A thin piece of a
//! subdivision that lies between an arc and its chord is turned over there, though it is not in H².

use super::layout::{Layout, faces_where, is_left_turn};
use crate::control::Control;
use crate::error::Result;
use crate::flow::Solution;
use crate::geometry::Space;
use crate::geometry::complex::{norm2, sub};
use crate::geometry::triangle_flatness::{TriangleOrientation, largest_coordinate};
use crate::mesh::{FaceId, PerEdge};
use crate::metric::CommonSubdivision;
use std::sync::Arc;

/// Most rounds in which edges are halved. Every round takes three quarters off the distance between an arc and its chord.
const MOST_ROUNDS: usize = 24;

impl Layout {
    /// The faces that are turned over where these coordinates of the points are joined by straight lines, as in files; ascending.
    /// `coordinates`: [`Layout::coordinates`], or those in another model of H².
    ///
    /// In E² and S² these are [`Layout::flipped`]. In H² also faces whose straight sides do not run counterclockwise, by exact arithmetic,
    /// though the face does in H² by more than rounding.
    pub fn flipped_with_straight_sides(&self, coordinates: &[[f64; 2]]) -> Vec<FaceId> {
        let mut found = self.turned_by_straight_sides(coordinates);
        found.extend(&self.flipped);
        found.sort_unstable();
        found.dedup();
        found
    }

    /// The faces that straight sides alone turn over.
    fn turned_by_straight_sides(&self, coordinates: &[[f64; 2]]) -> Vec<FaceId> {
        if self.space != Space::H2 {
            return Vec::new();
        }
        let is_whole = self.common_subdivision().is_none();
        let extent = largest_coordinate(&self.coordinates);
        let place = |h| coordinates[self.corner_index[h] as usize];
        faces_where(self.mesh(), |f| {
            let is_upright = || is_whole || self.orientation(f, extent) == TriangleOrientation::Upright;
            !is_left_turn(self.mesh().face_halfedges(f).map(place)) && is_upright()
        })
    }

    /// The layout of a flow's result, laid out again with edges inside the surface split until straight sides turn no piece of the
    /// subdivision over ([`Layout::flipped_with_straight_sides`]); the same layout if they turn none over. `again`: lays a subdivision out.
    ///
    /// # Errors
    /// Those of `again`; [`crate::Error::Cancelled`].
    pub fn with_straight_sides(
        self,
        solution: &Solution,
        control: &Control,
        again: impl Fn(Arc<CommonSubdivision>) -> Result<Layout>,
    ) -> Result<Layout> {
        let mut layout = self;
        for _ in 0..MOST_ROUNDS {
            let turned = layout.turned_by_straight_sides(&layout.coordinates);
            let Some(r) = layout.common_subdivision().filter(|_| !turned.is_empty()) else { break };
            control.check()?;
            let mut shares = PerEdge::filled(r.mesh.n_edges(), None);
            for f in turned {
                let uv = layout.face_uv(f);
                let sides = r.mesh.face_halfedges(f).into_iter().enumerate();
                let inside = sides.filter(|(_, h)| !r.mesh.is_boundary_edge(h.edge()));
                let square = |k: usize| norm2(sub(uv[(k + 1) % 3], uv[k]));
                if let Some((_, h)) = inside.max_by(|(i, _), (k, _)| square(*i).total_cmp(&square(*k))) {
                    shares[h.edge()] = Some(0.5);
                }
            }
            let split = r.with_edges_split(&shares, [solution.given(), solution.mesh()])?;
            layout = again(Arc::new(split))?;
        }
        Ok(layout)
    }
}
