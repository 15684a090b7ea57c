//! Pure formulas, no mesh: spaces, triangles, isometries, predicates.

mod arctangent;
pub mod barycentre;
pub(crate) mod bounds;
pub(crate) mod boxes;
pub(crate) mod chords;
pub mod circle;
pub mod complex;
pub mod conformal;
pub mod disk_barycentre;
mod exponentials;
pub mod flip;
pub mod hyperelliptic;
pub mod isometry;
pub mod lanes;
pub mod mobius;
pub mod model;
pub mod modulus;
pub mod motion;
pub mod predicates;
mod real;
pub(crate) mod scaled;
pub mod space;
pub mod sphere;
pub mod symplectic;
pub mod triangle;
pub mod twofold;
pub mod vector;
pub mod weights;
pub mod worst;

pub use isometry::PlaneIsometry;
pub use mobius::Mobius;
pub use model::Model;
pub use motion::Motion;
pub use space::Space;
pub use twofold::Twofold;
pub use worst::{largest, worse};
