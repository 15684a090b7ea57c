//! Files of layouts and charts: meshes with texture coordinates, in the format of the file's extension.

use crate::failure::{Failure, Outcome};
use crate::soup_file::write_soup;
use ricci::mesh::io::{self, Attributes, Format, Soup};
use ricci::mesh::{Mesh, PerVertex, Point};
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
    /// Writes a file in the format of its extension. `weights`: the homogeneous weights of the vertices, which only OBJ holds, and the
    /// factors by which they are multiplied at the points (all 1 if empty).
    pub fn write(self, path: &Path, weights: Option<(PerVertex<f64>, Vec<f64>)>) -> Outcome {
        let format = Format::of(path)?;
        let positions = self.positions.clone().ok_or_else(|| {
            Failure::argument("the layout is of an intrinsic mesh: it has no positions to write")
        })?;
        if format != Format::Obj {
            if weights.is_some() {
                return Err(Failure::argument(
                    "homogeneous texture coordinates are written in .obj files only",
                ));
            }
            return self.write_as(format, path, positions.to_vec());
        }
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

    /// Writes another format than OBJ, if it holds these texture coordinates.
    fn write_as(&self, format: Format, path: &Path, positions: Vec<Point>) -> Outcome {
        let uv = self.corners.iter().map(|corners| corners.map(|p| self.points[p as usize])).collect();
        if !format.has_texture_coordinates() {
            return Err(Failure::argument(
                "files of this format have no texture coordinates: write .obj, .off, .ply or .glb",
            ));
        }
        if format.has_no_seams() && self.has_seams(positions.len()) {
            return Err(Failure::argument(
                "files of this format have one pair of texture coordinates for each vertex, and this layout has seams: write .obj, .ply or .glb",
            ));
        }
        let attributes = Attributes { uv: Some(uv), ..Attributes::default() };
        write_soup(path, &Soup { attributes, ..Soup::new(positions, self.mesh.triangles()) })
    }

    /// True if a vertex lies at several points.
    fn has_seams(&self, n_vertices: usize) -> bool {
        let mut at = vec![None; n_vertices];
        let triangles = self.mesh.triangles();
        triangles.as_flattened().iter().zip(self.corners.as_flattened()).any(|(&vertex, &corner)| {
            let point = self.points[corner as usize];
            at[vertex as usize].replace(point).is_some_and(|known: [f64; 2]| known != point)
        })
    }
}
