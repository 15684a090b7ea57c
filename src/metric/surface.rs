//! A surface as it is given: connectivity, edge lengths and the geometry in which they are meant.

use super::class::Class;
use super::curvature::area;
use super::initial::{Initial, initial_metric};
use super::lengths::lengths_from_positions;
use crate::archive::stored;
use crate::error::{Result, check_size};
use crate::geometry::Space;
use crate::mesh::io::{self, Soup};
use crate::mesh::{Mesh, PerEdge, Point};
use crate::topology::check_lengths;
use std::path::Path;
use std::sync::Arc;

/// A triangulated surface with a metric, which flows start from. Clones share its arrays.
///
/// Lengths are positive and finite, one per edge. Vertices have positions where the surface came from space.
///
/// ```
/// # use ricci::{Surface, geometry::Space, mesh::shapes};
/// let torus = Surface::from_soup(&shapes::torus(2.0, 1.0, 24, 12)?)?;
/// assert_eq!((torus.mesh().genus(), torus.geometry()), (1, Space::E2));
/// # Ok::<(), ricci::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Surface {
    mesh: Arc<Mesh>,
    lengths: Arc<PerEdge<f64>>,
    geometry: Space,
    positions: Option<Arc<Vec<Point>>>,
}
stored!(sections Surface { mesh, lengths, geometry, positions } check Surface::check_parts);

impl Surface {
    /// Checks that the arrays of an archive fit each other.
    fn check_parts(&self) -> Result<()> {
        check_size("lengths", self.lengths.len(), self.mesh.n_edges())?;
        let positions = self.positions.as_ref();
        positions.map_or(Ok(()), |all| check_size("positions", all.len(), self.mesh.n_vertices()))
    }

    /// The surface of a mesh file ([`io::read`]).
    ///
    /// # Errors
    /// Those of [`io::read`] and [`Surface::from_soup`].
    pub fn read(path: impl AsRef<Path>) -> Result<Surface> {
        Surface::from_soup(&io::read(path.as_ref())?)
    }

    /// The surface of a triangle list in space, with Euclidean lengths.
    ///
    /// # Errors
    /// Those of [`Mesh::from_soup`] and [`lengths_from_positions`].
    pub fn from_soup(soup: &Soup) -> Result<Surface> {
        Surface::in_space(Mesh::from_soup(soup)?, soup.positions.clone())
    }

    /// A mesh with a position per vertex (V entries), with Euclidean lengths.
    ///
    /// # Errors
    /// Those of [`lengths_from_positions`].
    pub fn in_space(mesh: impl Into<Arc<Mesh>>, positions: impl Into<Arc<Vec<Point>>>) -> Result<Surface> {
        let (mesh, positions) = (mesh.into(), positions.into());
        let lengths = Arc::new(lengths_from_positions(&mesh, &positions)?);
        Ok(Surface { mesh, lengths, geometry: Space::E2, positions: Some(positions) })
    }

    /// A mesh with a length per edge (E entries), read in `geometry`.
    ///
    /// # Errors
    /// [`crate::Error::Size`]; [`crate::Error::EdgeLength`] for a length that is not positive and finite.
    pub fn intrinsic(
        mesh: impl Into<Arc<Mesh>>,
        lengths: impl Into<Arc<PerEdge<f64>>>,
        geometry: Space,
    ) -> Result<Surface> {
        let (mesh, lengths) = (mesh.into(), lengths.into());
        check_lengths(&mesh, &lengths)?;
        Ok(Surface { mesh, lengths, geometry, positions: None })
    }

    /// The same metric with positions (V entries) that only serve to draw and write the surface.
    ///
    /// # Errors
    /// [`crate::Error::Size`].
    pub fn with_positions(self, positions: impl Into<Arc<Vec<Point>>>) -> Result<Surface> {
        let positions = positions.into();
        check_size("positions", positions.len(), self.mesh.n_vertices())?;
        Ok(Surface { positions: Some(positions), ..self })
    }

    /// The same lengths, read in another geometry.
    pub fn read_in(self, geometry: Space) -> Surface {
        Surface { geometry, ..self }
    }

    /// Connectivity.
    pub fn mesh(&self) -> &Arc<Mesh> {
        &self.mesh
    }

    /// Edge lengths, E entries, in [`Surface::geometry`].
    pub fn lengths(&self) -> &Arc<PerEdge<f64>> {
        &self.lengths
    }

    /// The geometry of the triangles that have these lengths.
    pub fn geometry(&self) -> Space {
        self.geometry
    }

    /// Positions of the vertices in space, V entries, if there are any.
    pub fn positions(&self) -> Option<&Arc<Vec<Point>>> {
        self.positions.as_ref()
    }

    /// Area of the triangles in their geometry.
    ///
    /// # Errors
    /// None that a surface can have; those of [`area`].
    pub fn area(&self) -> Result<f64> {
        area(&self.mesh, self.geometry, &self.lengths)
    }

    /// The initial metric in a class, on the given triangulation ([`initial_metric`]).
    ///
    /// # Errors
    /// Those of [`initial_metric`].
    pub fn initial(&self, class: Class) -> Result<Initial> {
        initial_metric(&self.mesh, &self.lengths, self.geometry, class)
    }
}
