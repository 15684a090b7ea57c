//! A tree of boxes around the faces of an opened surface in one frame, which finds the faces that may hold a point.

use super::PlacedMesh;
use crate::geometry::Space;
use crate::geometry::bounds::Bounds;
use crate::geometry::boxes::{self, BoundsNode};
use crate::geometry::vector::{Vector, cross, dot, norm, sub};
use crate::mesh::FaceId;

/// Share of the largest coordinate by which boxes are widened: rounding.
const SLACK: f64 = 1e-12;
/// Rounding error of a determinant of f64s as a share of its size.
const ROUNDING: f64 = 1e-14;

/// The faces of an opened surface in a tree of boxes.
pub(super) struct FaceBoxes {
    tree: boxes::BoundsTree,
    /// The corners of the faces, in the coordinates of the space.
    corners: Vec<[Vector; 3]>,
    space: Space,
}

impl FaceBoxes {
    /// The boxes of a placed surface; `None` if every face has a frame of its own.
    pub fn new(placed: &PlacedMesh) -> Option<FaceBoxes> {
        let (mesh, space) = (&placed.cover.mesh, placed.cover.space);
        let shares = |f: FaceId| {
            let beside = |h: &crate::mesh::HalfedgeId| mesh.face(h.twin()).is_some();
            mesh.face_halfedges(f).into_iter().filter(beside).any(|h| placed.cover.across(h).is_none())
        };
        if mesh.n_faces() > 1 && !mesh.faces().any(shares) {
            return None;
        }
        let corners = |f: FaceId| placed.corners(f).map(|p| p.map(f64::from));
        let corners: Vec<[Vector; 3]> = mesh.faces().map(corners).collect();
        let bounds: Vec<Bounds> = corners.iter().map(|face| bounds(space, face)).collect();
        let coordinates = bounds.iter().flat_map(|b| b.low.into_iter().chain(b.high));
        let largest = coordinates.fold(0.0f64, |most, x| most.max(x.abs()));
        let bounds: Vec<Bounds> = bounds.into_iter().map(|b| b.widened(SLACK * largest)).collect();
        Some(FaceBoxes { tree: boxes::BoundsTree::new(&bounds), corners, space })
    }

    /// The faces that hold a point up to the rounding errors of f64s, by ascending number.
    pub fn around(&self, point: Vector) -> Vec<FaceId> {
        let at = flat(self.space, point);
        let (mut found, mut open) = (Vec::new(), vec![0]);
        while let Some(node) = open.pop() {
            if self.tree.distance(node, at) > 0.0 {
                continue;
            }
            match self.tree.node(node) {
                BoundsNode::Inner(children) => open.extend(children),
                BoundsNode::Leaf(faces) => found.extend(faces),
            }
        }
        found.retain(|&f| may_hold(&self.corners[f as usize], point));
        found.sort_unstable();
        found.into_iter().map(FaceId).collect()
    }
}

/// Coordinates in which geodesics are straight, or nearly so on the sphere.
fn flat(space: Space, [x, y, w]: Vector) -> Vector {
    match space {
        Space::E2 => [x, y, 0.0],
        Space::H2 => [x / w, y / w, 0.0],
        Space::S2 => [x, y, w],
    }
}

/// The box around a face.
fn bounds(space: Space, corners: &[Vector; 3]) -> Bounds {
    let points = corners.map(|p| flat(space, p));
    // The sphere bulges over a triangle of sides l by no more than l²/2, and by no more than its radius.
    let bulge = match space {
        Space::S2 => {
            let longest = (0..3).map(|k| norm(sub(points[k], points[(k + 1) % 3]))).fold(0.0, f64::max);
            (0.5 * longest * longest).min(1.0)
        }
        _ => 0.0,
    };
    Bounds::of(points).widened(bulge)
}

/// True if a point is on the left of all sides, up to rounding.
fn may_hold(corners: &[Vector; 3], point: Vector) -> bool {
    let size = norm(point);
    (0..3).all(|k| {
        let [a, b] = [sub(corners[k], point), sub(corners[(k + 1) % 3], point)];
        dot(cross(a, b), point) >= -ROUNDING * size * size * (norm(a) + norm(b))
    })
}

#[cfg(test)]
mod tests {
    use super::super::UniversalCover;
    use super::*;
    use crate::mesh::{PerVertex, VertexId, shapes};
    use crate::metric::Surface;

    #[test]
    fn every_face_of_a_sphere_holds_its_middle_and_every_vertex_is_in_all_its_faces() {
        let soup = shapes::icosphere(6).unwrap();
        let surface = Surface::from_soup(&soup).unwrap();
        let mesh = surface.mesh();
        let cover = UniversalCover::new(mesh, Space::S2, |_| None, &[]).unwrap();
        let at = PerVertex::from_fn(mesh.n_vertices(), |v: VertexId| {
            PlacedMesh::frame(Space::S2, soup.positions[v.index()])
        });
        let boxes = FaceBoxes::new(&PlacedMesh { cover, at }).unwrap();
        for f in mesh.faces() {
            let corners = mesh.face_vertices(f).map(|v| soup.positions[v.index()]);
            let sum = [0, 1, 2].map(|x| corners[0][x] + corners[1][x] + corners[2][x]);
            assert_eq!(boxes.around(sum.map(|x| x / norm(sum))), [f]);
        }
        for v in mesh.vertices() {
            assert_eq!(boxes.around(soup.positions[v.index()]).len(), mesh.fan(v).len());
        }
    }
}
