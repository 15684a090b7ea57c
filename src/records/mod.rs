//! What the files of results hold: for each kind of result a record with everything that it takes to go on with it where it was made.
//!
//! A record is written and read by [`crate::archive`]. The C face and the Python package write and read the same records.
//!
//! ```
//! use ricci::{Class, Control, Solution, Surface, archive, embed::Layout, geometry::{Model, Space}, mesh::shapes};
//! use ricci::records::{LayoutRecord, MetricRecord};
//! # fn main() -> ricci::Result<()> {
//! let (mesh, lengths) = shapes::flat_torus([0.0, 1.0], 4, 4)?.build()?;
//! let torus = Surface::intrinsic(mesh, lengths, Space::E2)?;
//! let flat = Solution::initial_of(torus, Class::yamabe(Space::E2))?;
//! let layout = Layout::of_solution(&flat, &Default::default(), &Control::new())?;
//! let kept = LayoutRecord { metric: flat.into(), layout, model: Model::Poincare };
//! let bytes = archive::to_bytes(&kept);
//! let LayoutRecord { metric: MetricRecord { solution, .. }, layout, .. } = archive::from_bytes(&bytes)?;
//! assert_eq!(layout, kept.layout);
//! assert!(solution.is_unflipped());
//! # Ok(())
//! # }
//! ```

mod flows;
mod layouts;
mod maps;
mod meshes;
#[cfg(feature = "quads")]
mod quads;
mod shapes;
#[cfg(all(feature = "json", feature = "splines"))]
mod splines;

pub use flows::{FormsRecord, MetricRecord};
pub use layouts::{ChartsRecord, LayoutRecord};
pub use maps::{MapRecord, MatchingRecord};
pub use meshes::MeshRecord;
#[cfg(all(feature = "quads", feature = "splines"))]
pub use quads::QuadSplineRecord;
#[cfg(feature = "quads")]
pub use quads::{QuadLayoutRecord, QuadsRecord};
#[cfg(all(feature = "json", feature = "splines"))]
pub use splines::{SplineFigures, SplineRecord};
