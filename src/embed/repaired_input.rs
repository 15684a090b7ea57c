//! The layout on the faces of the surface as it came, with edges split where the map that is linear on each face turns some over.
//!
//! The exact map is linear on the pieces of the common subdivision, whose vertices are those of the input and points on its edges. So with
//! all these points no face turns over, but few of them are needed. Face by face, the cheapest points are added that let the face be
//! triangulated without a fold; the faces across its split sides are then looked at again, so the search ends at the common subdivision at
//! the latest. At the end points are taken away again that the others have made unnecessary. Points lie on edges of the input, therefore
//! the surface in space stays as it is. No edge is flipped for it: the two triangles that a flip makes lie elsewhere in space wherever the
//! surface bends at the edge.
//!
//! ```
//! use ricci::embed::{Layout, LayoutOptions};
//! use ricci::{Class, Control, Flow, Surface, Target, flow::Options, geometry::Space, mesh::shapes};
//! # fn main() -> ricci::Result<()> {
//! let torus = Surface::from_soup(&shapes::torus(2.0, 1.0, 24, 12)?)?;
//! let mut flow = Flow::new(torus, Class::yamabe(Space::E2), &Options::default(), &Control::new())?;
//! let flat = flow.solve(&Target::Uniform, &Control::new())?;
//! let layout = Layout::of_solution(&flat, &LayoutOptions::default(), &Control::new())?;
//! let repaired = layout.repaired_input(&Control::new())?.unwrap();
//! assert!(repaired.flipped.is_empty());
//! # Ok(())
//! # }
//! ```

use crate::mesh::{EdgeId, FaceId, Mesh, PerHalfedge};
use crate::metric::CommonSubdivision;
use std::sync::Arc;

/// The layout on the surface as it came, with the fewest of its edges split that let the map be linear on each face without turning any
/// over.
#[derive(Debug, Clone)]
pub struct RepairedInput {
    /// The surface with its edges split, as the common subdivision of the input (side 0) and itself (side 1): its first vertices are the
    /// input's, the faces of each face of the input follow one another.
    pub refinement: Arc<CommonSubdivision>,
    /// The edges of the input that were split, ascending.
    pub split_edges: Vec<EdgeId>,
    /// Per half-edge, the index into `points` of the corner at its origin ([`super::Layout::corner_index`]).
    pub corner_index: PerHalfedge<u32>,
    /// Per vertex of the opened surface, its index in [`super::Layout::points`] and [`super::Layout::coordinates`].
    pub points: Vec<u32>,
    /// Their plane coordinates.
    pub coordinates: Vec<[f64; 2]>,
    /// Faces that are not counterclockwise in these coordinates, by exact arithmetic.
    pub flipped: Vec<FaceId>,
}

impl RepairedInput {
    /// The surface with its edges split.
    pub fn mesh(&self) -> &Mesh {
        &self.refinement.mesh
    }

    /// The number of vertices that were added to the input's.
    pub fn n_added(&self) -> usize {
        self.mesh().n_vertices() - self.refinement.n_vertices[0]
    }
}
