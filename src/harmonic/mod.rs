//! Harmonic maps and holomorphic 1-forms of any metric: the cotangent Laplacian on the intrinsic Delaunay triangulation, where all of
//! its weights are at least 0.
//!
//! ```
//! use ricci::harmonic::{Domain, FormsOptions, HarmonicForms, PeriodMatrix};
//! use ricci::{Control, Surface, geometry::Space, mesh::shapes};
//! # fn main() -> ricci::Result<()> {
//! let (mesh, lengths) = shapes::flat_torus([0.3, 1.2], 6, 6)?.build()?;
//! let torus = Surface::intrinsic(mesh, lengths, Space::E2)?;
//! let control = Control::new();
//! let domain = Domain::new(&torus, &control)?;
//! let forms = HarmonicForms::new(&domain, &FormsOptions::default(), &control)?;
//! let tau = PeriodMatrix::new(&forms)?.modulus().unwrap();
//! assert!((tau[0] - 0.3).abs() < 1e-12 && (tau[1] - 1.2).abs() < 1e-12);
//! # Ok(())
//! # }
//! ```

pub mod cohomology;
pub mod domain;
pub mod even;
pub mod factor;
pub mod forms;
pub mod heat;
pub mod integrate;
pub mod laplace;
pub mod map;
pub mod one_form;
pub mod operators;
pub mod periods;
pub mod planar;
pub mod simple;
pub mod spectrum;
pub mod sphere;
pub mod star;
pub mod trajectories;
pub mod zeros;

pub use domain::Domain;
pub use even::{even_combination, unevenness};
pub use forms::{Classes, FormsOptions, HarmonicForms};
pub use heat::{HeatFlow, HeatOptions, heat_flow};
pub use integrate::{FormLayout, integrate};
pub use laplace::Laplace;
pub use map::{HarmonicMap, MapConstraints, harmonic_map};
pub use one_form::{ComplexForm, OneForm};
pub use periods::PeriodMatrix;
pub use simple::simple_domain;
pub(crate) use spectrum::spectrum_within;
pub use spectrum::{Spectrum, spectrum};
pub use sphere::{SphereMap, SphereMapOptions, SphereMethod, sphere_map};
pub use star::with_conjugate;
pub use trajectories::{TrajectoryOptions, trajectories};
pub use zeros::{Zero, indices, zeros};
