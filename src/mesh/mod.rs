//! Triangle meshes: connectivity, building from index buffers, diagnosis, files and generators. Nothing here knows a metric.
//!
//! ```
//! use ricci::mesh::{Mesh, VertexId};
//! let tetrahedron = Mesh::from_faces(4, &[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])?;
//! assert_eq!((tetrahedron.n_edges(), tetrahedron.genus()), (6, 0));
//! let neighbours = tetrahedron.outgoing(VertexId(3)).map(|h| tetrahedron.tip(h).0);
//! assert_eq!(neighbours.count(), 3);
//! # Ok::<(), ricci::Error>(())
//! ```

pub mod attribute;
pub mod build;
pub mod caps;
pub mod check;
pub mod components;
pub mod double;
pub mod fill;
pub mod flip;
pub mod flip_log;
pub mod halfedge;
pub mod holes;
pub mod ids;
mod incidence;
mod insert;
pub mod io;
mod join;
pub mod normal;
pub mod normal_trace;
pub mod place;
pub mod refine;
pub mod remove;
pub mod repair;
pub mod rims;
pub mod shapes;
pub mod sheets;
pub mod tangents;
mod thin;
pub(crate) mod union_find;
mod weld;

pub use attribute::{PerEdge, PerFace, PerHalfedge, PerVertex};
pub use double::Double;
pub use fill::FilledMesh;
pub use flip::{FixedEdges, Flip};
pub use flip_log::FlipLog;
pub use halfedge::Mesh;
pub use ids::{EdgeId, FaceId, HalfedgeId, VertexId};
pub use normal::NormalCoordinates;
pub use normal_trace::Curves;
pub use place::Place;
pub use refine::{Refine, RefinedSoup};
pub use remove::{Thinned, Thinning};

/// A point of space, `[x, y, z]`.
pub type Point = [f64; 3];
