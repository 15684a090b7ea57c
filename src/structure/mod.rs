//! Geometric structures of surfaces by atlases: conformal, spherical, affine, hyperbolic and real projective [JKLLG08; GHQ06; GHJLQY08].
//!
//! ```
//! use ricci::structure::{AtlasOptions, Structure, atlas};
//! use ricci::{Control, Surface, mesh::{FaceId, shapes}};
//! let surface = Surface::from_soup(&shapes::genus(2, 4)?)?;
//! let options = AtlasOptions { structure: Structure::Projective, ..AtlasOptions::default() };
//! let atlas = atlas(&surface, &options, &Control::new())?;
//! assert!(atlas.cocycles.residual < 1e-9 && atlas.holonomy.relation_residual < 1e-8);
//! // A point lies in the stars of the corners of its face.
//! let places = atlas.places(FaceId(0), [0.5, 0.25, 0.25])?;
//! let moved = atlas.carry(places[0].lift, places[1].lift, places[0].coordinates)?;
//! assert!((moved[0] - places[1].coordinates[0]).abs() < 1e-12);
//! # Ok::<(), ricci::Error>(())
//! ```

mod align;
mod atlas;
mod build;
mod cocycle;
mod developable;
mod draft;
mod element;
mod flat_source;
mod growth;
mod holonomy;
#[cfg(feature = "quads")]
mod integer;
mod kind;
mod options;
mod overlaps;
mod singular;
mod source;
mod stars;

pub use atlas::{Atlas, Chart, ChartPoint};
pub use build::atlas;
pub use cocycle::CocycleCheck;
pub use element::GroupElement;
pub use holonomy::Holonomy;
pub use kind::Structure;
pub use options::{AffineSource, AtlasOptions, ChartKind};
pub use overlaps::{FaceLift, Transition};
pub use singular::least_distorting_vertex;
#[cfg(feature = "splines")]
pub(crate) use singular::singular_vertex;
