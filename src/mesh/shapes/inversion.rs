//! Inversion of a surface in a sphere, which is a conformal map of space.

use super::check_size;
use super::genus::{HALF_STEP, HOLE, RIM, genus};
use crate::error::{Error, Result};
use crate::geometry::vector::{Vector, add, dot, scale, sub};
use crate::mesh::io::Soup;

/// Maps each vertex to its mirror image in the sphere about `centre` with this `radius`: `x ↦ c + R² (x − c)/|x − c|²`. Faces are turned,
/// so that the orientation is kept.
///
/// The map is conformal: the smooth surfaces before and after have the same conformal structure (moduli, period matrix), their
/// triangulations in the limit of fine meshes. A closed surface that does not contain the centre keeps its outside.
///
/// # Errors
///
/// [`Error::Argument`] for a radius outside 1e-150 … 1e150, or a vertex within 1e-12 R of the centre.
pub fn invert(soup: &mut Soup, centre: Vector, radius: f64) -> Result<()> {
    check_size("radius of the inversion", radius)?;
    let near = |p: &Vector| dot(sub(*p, centre), sub(*p, centre)) < (1e-12 * radius).powi(2);
    if let Some(v) = soup.positions.iter().position(near) {
        return Err(Error::argument(
            "centre of the inversion",
            format!("vertex {v}"),
            "away from every vertex",
        ));
    }
    for p in &mut soup.positions {
        let d = sub(*p, centre);
        *p = add(centre, scale(radius * radius / dot(d, d), d));
    }
    soup.faces.iter_mut().for_each(|face| face.swap(1, 2));
    Ok(())
}

/// Least distance of the inversion's centre from the middle of the last handle, in radii of its rim: as it approaches the rim, the image
/// of the rim grows without bound.
const CLEARANCE: f64 = 1.2;

/// [`genus`] with handles of different size: the first hole is `ratio` ≥ 1 times as wide as the last, the others are between them.
///
/// The row of equal handles is inverted in a sphere about a point of its axis, which keeps all angles up to the mesh's fineness, and so
/// the conformal structure. The scale is 1 at the middle of the row.
///
/// The ratio determines the sizes of all handles. The centre of the inversion lies beyond the last rim, so the ratio is bounded: by 6.8
/// for two handles, 17 for three, 32 for four, in proportion to the square of their number.
///
/// # Errors
///
/// Those of [`genus`]; [`Error::Argument`] for a ratio below 1, a ratio other than 1 for a single handle, and one too large for so few
/// handles.
pub fn tapered_genus(handles: usize, n: usize, ratio: f64) -> Result<Soup> {
    let mut soup = genus(handles, n)?;
    let refuse = |need| Err(Error::argument("ratio of the handles", ratio, need));
    if !(1.0..=MOST_RATIO).contains(&ratio) {
        return refuse("between 1 and 1000");
    }
    if ratio == 1.0 {
        return Ok(soup);
    }
    // A hole of radius 1 at distance d from the centre becomes one of radius R²/(d² − 1). The first and last hole, at ∓c, have the given
    // ratio where ((C + c)² − 1) = ratio ((C − c)² − 1).
    let c = HALF_STEP * (handles as f64 - 1.0);
    let k = c * (ratio + 1.0) / (ratio - 1.0);
    let centre = k + (k * k - c * c + HOLE * HOLE).sqrt();
    if handles == 1 {
        return refuse("1 for a single handle");
    }
    if centre < c + CLEARANCE * RIM {
        let reach = CLEARANCE * RIM;
        let most = ((2.0 * c + reach).powi(2) - HOLE) / (reach * reach - HOLE);
        let value = format!("{ratio}, of at most {most:.1} for {handles} handles");
        let need = "smaller: the largest handle would swallow the rest";
        return Err(Error::argument("ratio of the handles", value, need));
    }
    invert(&mut soup, [-centre, 0.0, 0.0], centre)?;
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for p in &soup.positions {
        (low, high) = (low.min(p[0]), high.max(p[0]));
    }
    soup.positions.iter_mut().for_each(|p| p[0] -= 0.5 * (low + high));
    Ok(soup)
}

/// Largest ratio of the handles' sizes.
const MOST_RATIO: f64 = 1000.0;
