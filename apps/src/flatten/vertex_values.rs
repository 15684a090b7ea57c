//! Areal and shape distortion of a flat map at the vertices, as files of FreeSurfer.

use super::outcome::PlaneOutcome;
use crate::failure::Failure;
use crate::vertex_distortion::VertexDistortion;
use ricci::mesh::io::freesurfer::values_bytes;

impl PlaneOutcome {
    /// log2 of the area of the faces around each vertex in the plane over that on the surface.
    pub fn areal(&self) -> Result<Vec<u8>, Failure> {
        self.values(VertexDistortion::of_plane(&self.input.surface, &self.flat.points)?.areal)
    }

    /// The mean, weighed with areas, of log2 of the dilatation of the faces around each vertex.
    pub fn shape(&self) -> Result<Vec<u8>, Failure> {
        self.values(VertexDistortion::of_plane(&self.input.surface, &self.flat.points)?.shape)
    }

    /// The bytes of values at the vertices of the whole surface.
    fn values(&self, of_part: Vec<f64>) -> Result<Vec<u8>, Failure> {
        let mesh = self.input.mesh();
        let mut values = vec![0.0; self.n_whole];
        mesh.vertices().zip(of_part).for_each(|(v, x)| values[self.origin(v) as usize] = x);
        Ok(values_bytes(&values, mesh.n_faces())?)
    }
}
