//! Pure formulas without a mesh: the three spaces, triangles, isometries, predicates, numbers of higher precision.

pub(crate) mod arctangent;
pub mod barycentre;
pub(crate) mod bounding_line;
pub(crate) mod bounds;
pub(crate) mod boxes;
pub(crate) mod chords;
pub mod circle;
pub mod clip;
pub mod complex;
pub mod conformal;
pub mod cover_share;
pub mod disk_barycentre;
pub mod double_double;
pub mod enclosure;
mod exponentials;
pub mod flip;
pub mod hyperelliptic;
pub mod isometry;
pub mod lanes;
pub mod mobius;
pub mod model;
pub mod modulus;
pub mod motion;
pub mod packing;
pub(crate) mod plane_triangle;
pub mod polygon_triangles;
pub mod predicates;
#[cfg(feature = "splines")]
pub(crate) mod quadrature;
pub mod random;
mod real;
pub mod row_packing;
pub(crate) mod scaled;
pub(crate) mod scaling;
pub mod space;
pub mod sphere;
mod stored;
pub mod symplectic;
pub mod triangle;
pub mod triangle_flatness;
pub mod triangle_overlap;
#[cfg(any(feature = "quads", feature = "splines"))]
pub(crate) mod triangle_tree;
pub mod vector;
mod vertex;
pub mod weights;
pub mod worst;
#[cfg(feature = "splines")]
pub(crate) mod z_order;

pub use double_double::DoubleDouble;
pub use enclosure::Enclosure;
pub use isometry::PlaneIsometry;
pub use mobius::Mobius;
pub use model::Model;
pub use motion::Motion;
pub use space::Space;
pub use worst::{largest, worse};
