//! Connectivity, building from index buffers, diagnosis, files and generators. Nothing here knows a metric.

pub mod attribute;
pub mod build;
pub mod check;
pub mod double;
pub mod flip;
pub mod flip_log;
pub mod halfedge;
pub mod ids;
mod incidence;
pub mod io;
mod join;
pub mod normal;
pub mod normal_trace;
pub mod repair;
pub mod shapes;
mod weld;

pub use attribute::{PerEdge, PerFace, PerHalfedge, PerVertex};
pub use double::Double;
pub use flip::{FixedEdges, Flip};
pub use flip_log::FlipLog;
pub use halfedge::Mesh;
pub use ids::{EdgeId, FaceId, HalfedgeId, VertexId};
pub use normal::NormalCoordinates;
pub use normal_trace::Curves;

/// A point of space, `[x, y, z]`.
pub type Point = [f64; 3];
