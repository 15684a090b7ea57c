//! The surface of glued pairs of pants, with its loops and generators.

use super::decomposition::FenchelNielsen;
use super::loops::generator_loops;
use super::tiles::HexagonTiles;
use crate::error::Result;
use crate::geometry::{DoubleDouble, Motion};
use crate::mesh::shapes::check_count;
use crate::mesh::shapes::intrinsic::IntrinsicSurface;

/// A hyperbolic surface with the loops that its coordinates belong to.
#[derive(Debug, Clone)]
pub struct PantsSurface {
    /// The surface. Curvature is 0 at every vertex, the boundary's included.
    pub surface: IntrinsicSurface,
    /// Loops at vertex 0 of the canonical generators a1, b1, …, ag, bg, c1, …, cb: edges numbered from 1, negative against their direction.
    pub loops: Vec<Vec<i32>>,
    /// The isometries of the generators; vertex 0 is at the origin.
    pub generators: Vec<Motion<DoubleDouble>>,
}

/// The hyperbolic surface with these lengths and twists, as pairs of pants of two right-angled hexagons each, glued along their cuffs
/// \[Bus92, Theorem 3.1.7\]. Hexagons are cut into triangles from a point inside, and each triangle into four `level` times.
///
/// The hexagons, their frames and the generators are computed in double-double precision, edge lengths from these.
///
/// # Errors
/// [`crate::Error::Argument`] for a surface without a hyperbolic metric, lengths outside 1e-3 … 30, twists beyond 30, or too many levels;
/// [`crate::Error::Size`] for another number of curves; [`crate::Error::TriangleInequality`] where triangles are too thin for f64.
pub fn fenchel_nielsen(coordinates: &FenchelNielsen, level: usize) -> Result<PantsSurface> {
    coordinates.check()?;
    let all = coordinates.decomposition();
    let (placed, local) = (all.placed(), coordinates.local_generators(&all));
    let in_frame = |(p, g): &(usize, Motion<DoubleDouble>)| g.conjugated_by(&placed[*p].frame).normalised();
    let generators = local.iter().map(in_frame).collect();
    let tiles = HexagonTiles::new(&all)?;
    let mut loops = generator_loops(&tiles, &placed, &local)?;
    let mut surface = tiles.surface();
    surface.check_triangles()?;
    check_count("level", level, 0, surface.faces.len() as f64 * 4f64.powi(level.min(60) as i32))?;
    for _ in 0..level {
        surface = surface.subdivide()?;
        // Edge e becomes 2e − 1 and 2e, in its direction.
        let halves = |&e: &i32| if e > 0 { [2 * e - 1, 2 * e] } else { [2 * e, 2 * e + 1] };
        loops.iter_mut().for_each(|path| *path = path.iter().flat_map(halves).collect());
    }
    surface.check_triangles()?;
    Ok(PantsSurface { surface, loops, generators })
}
