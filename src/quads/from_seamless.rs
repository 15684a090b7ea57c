//! Quad meshes and layouts of seamless metrics.

use super::options::QuadOptions;
use super::quad_division::QuadDivision;
use super::quad_layout::QuadLayout;
use super::quad_mesh::QuadMesh;
use crate::control::Control;
use crate::error::Result;
use crate::parallel::Pool;
use crate::seamless::Seamless;

/// Edges of the quad mesh of a layout to a unit of length: arcs have so many points between their ends that they follow the surface, and no
/// two edges have the same ends.
const PARTS: u32 = 8;

/// The quad mesh of a seamless metric: the motorcycle graph of its map, a whole number for each arc, and the integer points of the map in
/// which each rectangle has whole sides. The squares are embedded in the flat metric without folds. Every vertex that is no cone or corner has
/// four quads, two on the boundary.
///
/// # Errors
/// [`crate::Error::Argument`] for a size that is not positive; [`crate::Error::Layout`] for a metric so far from a seamless one that its seams
/// do not turn by multiples of 90°; [`crate::Error::Cancelled`].
pub fn quad_mesh(seamless: &Seamless, options: &QuadOptions, control: &Control) -> Result<QuadMesh> {
    options.check()?;
    Pool::new(options.threads)?.run(|| {
        let division = QuadDivision::new(seamless, &control.part(0.0, 0.2))?;
        division.mesh(options.size, 1, true, &control.part(0.2, 1.0))
    })
}

/// The layout of a seamless metric: the patches of its quad mesh of this size, with each edge divided in [`QuadLayout::parts`].
/// [`super::QuadSize::Coarse`] makes as few as the lines between cones allow.
///
/// # Errors
/// Those of [`quad_mesh`].
pub fn quad_layout(seamless: &Seamless, options: &QuadOptions, control: &Control) -> Result<QuadLayout> {
    options.check()?;
    Pool::new(options.threads)?.run(|| {
        let division = QuadDivision::new(seamless, &control.part(0.0, 0.1))?;
        QuadLayout::new(division.mesh(options.size, PARTS, false, &control.part(0.1, 1.0))?, PARTS)
    })
}
