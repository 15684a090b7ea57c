//! Files of layouts and charts: OBJ meshes with texture coordinates.

use crate::failure::{Failure, Outcome};
use ricci::mesh::{Mesh, PerVertex, Point, io};
use std::path::Path;
use std::sync::Arc;

/// A mesh with points of the plane at the corners of its faces.
pub(crate) struct TextureFile<'a> {
    pub mesh: &'a Mesh,
    pub positions: Option<Arc<Vec<Point>>>,
    pub points: &'a [[f64; 2]],
    pub corners: Vec<[u32; 3]>,
}

impl TextureFile<'_> {
    /// Writes an OBJ file. `weights`: the homogeneous weights of the vertices, and the factors by which they are multiplied at the
    /// points (all 1 if empty).
    pub fn write(self, path: &Path, weights: Option<(PerVertex<f64>, Vec<f64>)>) -> Outcome {
        let positions = self.positions.ok_or_else(|| {
            Failure::argument("the layout is of an intrinsic mesh: it has no positions to write")
        })?;
        let faces = self.mesh.triangles();
        let mut of_points = Vec::new();
        if let Some((weights, heights)) = weights {
            of_points = vec![1.0; self.points.len()];
            for (f, corners) in self.mesh.faces().zip(&self.corners) {
                let vertices = self.mesh.face_vertices(f);
                (0..3).for_each(|k| of_points[corners[k] as usize] = weights[vertices[k]]);
            }
            of_points.iter_mut().zip(&heights).for_each(|(weight, height)| *weight *= height);
        }
        let data = io::TexturedMesh {
            positions: &positions,
            faces: &faces,
            texcoords: self.points,
            texcoord_weights: &of_points,
            face_texcoords: &self.corners,
            ..io::TexturedMesh::default()
        };
        Ok(io::write_obj(path, &data)?)
    }
}
