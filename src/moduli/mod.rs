//! Invariants of conformal structures: period matrices that are proven to lie within a radius, lengths of closed geodesics, and twists.
//!
//! ```
//! use ricci::harmonic::{Domain, FormsOptions, HarmonicForms};
//! use ricci::moduli::{BoundsOptions, period_bounds};
//! use ricci::{Control, Surface, geometry::Space, mesh::shapes};
//! # fn main() -> ricci::Result<()> {
//! let (mesh, lengths) = shapes::flat_torus([0.25, 1.5], 6, 5)?.build()?;
//! let torus = Surface::intrinsic(mesh, lengths, Space::E2)?;
//! let control = Control::new();
//! let forms = HarmonicForms::new(&Domain::new(&torus, &control)?, &FormsOptions::default(), &control)?;
//! let bounds = period_bounds(&forms, &BoundsOptions::default(), &control)?;
//! let tau = bounds.modulus().unwrap();
//! let off = (tau.value[0] - 0.25).hypot(tau.value[1] - 1.5);
//! assert!(bounds.gap < 1e-10 && off <= tau.radius + 1e-14);
//! # Ok(())
//! # }
//! ```

pub mod bounds;
mod elements;
mod energy;
pub mod fenchel_nielsen;
#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod fenchel_nielsen_tests;
mod finer;
mod gap;
pub mod geodesic;
#[cfg(test)]
#[allow(clippy::unwrap_used, clippy::print_stdout)]
mod known_tests;
mod marked_loops;
mod marking;
mod mirrored;
mod pants_words;
mod proof;
mod reduced;
mod solve;
pub mod spectrum;
#[cfg(test)]
#[allow(clippy::unwrap_used, clippy::print_stdout)]
mod spectrum_tests;

pub use bounds::{BoundsOptions, ModulusDisk, PeriodBounds, period_bounds};
pub use elements::{ClosedForm, Degree};
pub use fenchel_nielsen::{PantsCurve, fenchel_nielsen};
pub use finer::BisectedSurface;
pub use geodesic::{GeodesicOnSurface, closed_geodesic, geodesics_on_surface};
pub use marked_loops::{fenchel_nielsen_of_loops, parts_of_edges};
pub use mirrored::{ModulusBounds, modulus_bounds};
pub use pants_words::pants_of_words;
pub use reduced::ReducedPeriods;
pub use spectrum::{GeodesicClass, LengthSpectrum, SpectrumOptions, geodesic_length, length_spectrum};
