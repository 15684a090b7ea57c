//! Layouts in H² as files hold them: triangles with straight sides in the Poincaré disk, where lines of H² are arcs. A thin piece of a
//! subdivision that lies between an arc and its chord is turned over there, though it is not in H².

use super::layout::{Layout, faces_where, is_left_turn};
use crate::control::Control;
use crate::error::Result;
use crate::flow::Solution;
use crate::geometry::Space;
use crate::geometry::complex::{norm2, sub};
use crate::geometry::triangle_flatness::{TriangleOrientation, largest_coordinate};
use crate::mesh::{FaceId, HalfedgeId, PerEdge};
use crate::metric::CommonSubdivision;
use std::sync::Arc;

/// Most rounds in which edges are halved. Every round takes three quarters off the distance between an arc and its chord.
const MOST_ROUNDS: usize = 24;
/// Most pieces for each piece of the subdivision; if more are needed, it stays as it is.
const MOST_PIECES: usize = 4;

impl Layout {
    /// The faces that are upright in H², but turned over where these coordinates of the points are joined by straight lines, as a viewer
    /// of the file draws them; ascending, and none in E² and S². `coordinates`: [`Layout::coordinates`], or those in another model of H².
    ///
    /// [`Layout::flipped`] has the faces that are turned over in the space itself. A face is listed if its straight sides do not run
    /// counterclockwise, by exact arithmetic, though the face does in H² by more than rounding.
    pub fn turned_by_straight_sides(&self, coordinates: &[[f64; 2]]) -> Vec<FaceId> {
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
    /// subdivision over ([`Layout::turned_by_straight_sides`]); the same layout if they turn none over, or if that takes more than four times
    /// as many pieces. `again`: lays a subdivision out.
    ///
    /// # Errors
    /// Those of `again`; [`crate::Error::Cancelled`].
    pub fn with_straight_sides(
        self,
        solution: &Solution,
        control: &Control,
        again: impl Fn(Arc<CommonSubdivision>) -> Result<Layout>,
    ) -> Result<Layout> {
        let mut straightened = None;
        for _ in 0..MOST_ROUNDS {
            let layout = straightened.as_ref().unwrap_or(&self);
            let turned = layout.turned_by_straight_sides(&layout.coordinates);
            let Some(r) = layout.common_subdivision().filter(|_| !turned.is_empty()) else { break };
            control.check()?;
            let shares = layout.edges_to_halve(turned);
            let split = r.with_edges_split(&shares, [solution.given(), solution.mesh()])?;
            if split.mesh.n_faces() > MOST_PIECES * self.mesh().n_faces() {
                return Ok(self);
            }
            straightened = Some(again(Arc::new(split))?);
        }
        Ok(straightened.unwrap_or(self))
    }

    /// The edges to be halved, with the share of their middle: the longest of each of these faces, and of each face that a halved edge
    /// would turn over, since the middle of an arc lies beside its chord.
    fn edges_to_halve(&self, turned: Vec<FaceId>) -> PerEdge<Option<f64>> {
        let mesh = self.mesh();
        let mut shares = PerEdge::filled(mesh.n_edges(), None);
        let mut faces = turned;
        while let Some(f) = faces.pop() {
            if let Some(h) = self.longest_whole_side(f, &shares) {
                shares[h.edge()] = Some(0.5);
                let beside = [h, h.twin()].into_iter().filter_map(|h| mesh.face(h));
                faces.extend(beside.filter(|&g| self.is_turned_by_halves(g, &shares)));
            }
        }
        shares
    }

    /// The longest side of a face inside the surface that is not halved yet.
    fn longest_whole_side(&self, f: FaceId, shares: &PerEdge<Option<f64>>) -> Option<HalfedgeId> {
        let (mesh, uv) = (self.mesh(), self.face_uv(f));
        let sides = mesh.face_halfedges(f).into_iter().enumerate();
        let whole = sides.filter(|(_, h)| !mesh.is_boundary_edge(h.edge()) && shares[h.edge()].is_none());
        let square = |k: usize| norm2(sub(uv[(k + 1) % 3], uv[k]));
        whole.max_by(|(i, _), (k, _)| square(*i).total_cmp(&square(*k))).map(|(_, h)| h)
    }

    /// True if the middle of a halved side of a face lies beyond one of its other sides, so that a part of the face would be turned over.
    fn is_turned_by_halves(&self, f: FaceId, shares: &PerEdge<Option<f64>>) -> bool {
        let (uv, points) = (self.face_uv(f), self.face_points(f));
        self.mesh().face_halfedges(f).into_iter().enumerate().any(|(k, h)| {
            let [i, opposite] = [(k + 1) % 3, (k + 2) % 3];
            let middle = || middle_in_disk(points[k], points[i]);
            let is_turned =
                |m| !is_left_turn([uv[k], m, uv[opposite]]) || !is_left_turn([m, uv[i], uv[opposite]]);
            shares[h.edge()].is_some() && is_turned(middle())
        })
    }
}

/// The middle of a segment of H² in the Poincaré disk; its ends in ambient coordinates.
fn middle_in_disk(a: [f64; 3], b: [f64; 3]) -> [f64; 2] {
    let [x, y, w] = [0, 1, 2].map(|i| a[i] + b[i]);
    // The sum is a multiple of the middle's ambient vector.
    let size = (w * w - x * x - y * y).max(0.0).sqrt();
    [x / (w + size), y / (w + size)]
}
