//! Hyperbolic surfaces with given Fenchel–Nielsen coordinates: pairs of pants glued along curves of given lengths, with given twists.

mod decomposition;
mod glued;
mod hexagon;
mod loops;
mod tiles;

pub use decomposition::FenchelNielsen;
pub use glued::{PantsSurface, fenchel_nielsen};
