//! Quad meshes on surfaces.

use crate::archive::stored;
use crate::flow::Solution;
use crate::mesh::{EdgeId, FaceId, Place, Point};

/// A pure quad mesh on a surface.
#[derive(Debug, Clone, PartialEq)]
pub struct QuadMesh {
    /// The corners of each quad, counterclockwise seen from outside.
    pub quads: Vec<[u32; 4]>,
    /// Per vertex its place on the surface as it came: a face and barycentric coordinates in it.
    pub places: Vec<(FaceId, [f64; 3])>,
    /// Per quad the rectangle of the T-mesh that it is a part of.
    pub rectangle: Vec<u32>,
    /// The number of rectangles of the T-mesh, and of its arcs.
    pub t_mesh_size: [usize; 2],
    /// The number of quads that were collapsed because two of their sides were the same edge: those around cones of valence 1.
    pub collapsed: usize,
    /// Edges on features and on the boundary, each by its two vertices.
    pub creases: Vec<[u32; 2]>,
    /// Features that are not parallel to an axis exactly, so that edges need not run along them.
    pub off_axis: Vec<EdgeId>,
    /// The sum over the arcs of squared differences between edges and wanted lengths in edges.
    pub cost: f64,
    /// The edge length that was asked for, or found for a number of quads, in the units of the surface's lengths.
    pub edge: f64,
}
stored!(sections QuadMesh { quads, places, rectangle, t_mesh_size, collapsed, creases, off_axis, cost, edge
});

impl QuadMesh {
    /// The two triangles of a quad, cut from its first corner to the third.
    pub fn halves([a, b, c, d]: [u32; 4]) -> [[u32; 3]; 2] {
        [[a, b, c], [a, c, d]]
    }

    /// The places of the vertices in space; none for a surface without positions.
    pub fn positions(&self, solution: &Solution) -> Option<Vec<Point>> {
        let (mesh, positions) = (solution.given(), solution.surface().positions()?);
        let at = |&(face, weights): &(FaceId, [f64; 3])| Place { face, weights }.point(mesh, positions);
        Some(self.places.iter().map(at).collect())
    }

    /// The number of quads around each vertex.
    pub fn valences(&self) -> Vec<u32> {
        let mut valence = vec![0; self.places.len()];
        self.quads.iter().flatten().for_each(|&v| valence[v as usize] += 1);
        valence
    }
}
