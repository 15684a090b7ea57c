//! The record of a mesh.

use crate::archive::{Kept, in_range, stored};
use crate::error::{Result, check_size};
use crate::geometry::Space;
use crate::mesh::io::Attributes;
use crate::mesh::{Mesh, PerEdge, Place, Point};
use crate::metric::{Surface, lengths_from_positions};
use std::sync::Arc;

/// A mesh with its positions or lengths, its attributes, and, of a refined metric, the places of its vertices on the surface that it was made from.
#[derive(Debug, Clone)]
pub struct MeshRecord {
    /// The connectivity.
    pub mesh: Arc<Mesh>,
    /// A position per vertex; none of an intrinsic mesh.
    pub positions: Option<Arc<Vec<Point>>>,
    /// A length per edge and their geometry; none where they are those between the positions.
    pub lengths: Option<(Arc<PerEdge<f64>>, Space)>,
    /// The attributes that its file had.
    pub attributes: Attributes,
    /// Per vertex its place on another surface.
    pub places: Option<Vec<Place>>,
}
stored!(sections MeshRecord { mesh, positions, lengths, attributes, places } check MeshRecord::check_parts);

impl Kept for MeshRecord {
    const KIND: &'static str = "mesh";
}

impl MeshRecord {
    /// The surface of this mesh.
    ///
    /// # Errors
    /// Those of [`Surface::in_space`] and [`Surface::intrinsic`].
    pub fn surface(&self) -> Result<Surface> {
        let mesh = self.mesh.clone();
        match (&self.lengths, &self.positions) {
            (Some((lengths, space)), None) => Surface::intrinsic(mesh, lengths.clone(), *space),
            (Some((lengths, space)), Some(positions)) => {
                Surface::intrinsic(mesh, lengths.clone(), *space)?.with_positions(positions.clone())
            }
            (None, positions) => Surface::in_space(mesh, positions.clone().unwrap_or_default()),
        }
    }

    /// Checks that the arrays fit the mesh.
    fn check_parts(&self) -> Result<()> {
        let (n, m) = (self.mesh.n_vertices(), self.mesh.n_faces());
        let check = |what, got: Option<usize>, need| got.map_or(Ok(()), |got| check_size(what, got, need));
        check("positions", self.positions.as_ref().map(|all| all.len()), n)?;
        check("lengths", self.lengths.as_ref().map(|(all, _)| all.len()), self.mesh.n_edges())?;
        check("places", self.places.as_ref().map(Vec::len), n)?;
        let Attributes { normals, corner_normals, colors, uv, labels, vertex_numbers, face_numbers, .. } =
            &self.attributes;
        check("normals", normals.as_ref().map(Vec::len), n)?;
        check("corner normals", corner_normals.as_ref().map(Vec::len), m)?;
        check("colors", colors.as_ref().map(Vec::len), n)?;
        check("texture coordinates", uv.as_ref().map(Vec::len), m)?;
        vertex_numbers.iter().try_for_each(|column| check_size("numbers", column.values.len(), n))?;
        face_numbers.iter().try_for_each(|column| check_size("numbers", column.values.len(), m))?;
        let Some(labels) = labels else { return Ok(()) };
        check_size("labels", labels.of_face.len(), m)?;
        in_range("label", labels.of_face.iter().map(|&k| k as usize), labels.labels.len())
    }
}

impl From<&Surface> for MeshRecord {
    fn from(surface: &Surface) -> MeshRecord {
        let (mesh, positions) = (surface.mesh().clone(), surface.positions().cloned());
        let measured = positions.as_ref().and_then(|all| lengths_from_positions(&mesh, all).ok());
        let is_measured = surface.geometry() == Space::E2 && measured.as_ref() == Some(&**surface.lengths());
        MeshRecord {
            mesh,
            positions,
            lengths: (!is_measured).then(|| (surface.lengths().clone(), surface.geometry())),
            attributes: Attributes::default(),
            places: None,
        }
    }
}
