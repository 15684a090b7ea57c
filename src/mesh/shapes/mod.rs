//! Sample surfaces of every topology, at any resolution.
//!
//! ```
//! use ricci::mesh::{Mesh, shapes};
//! let mesh = Mesh::from_soup(&shapes::genus(3, 2)?)?;
//! assert_eq!((mesh.genus(), mesh.is_closed()), (3, true));
//! # Ok::<(), ricci::Error>(())
//! ```

mod genus;
mod grading;
mod holes;
mod hyperelliptic;
mod intrinsic;
mod inversion;
mod knot;
mod noise;
mod pants;
mod pants_gluing;
mod plane;
mod sphere;
mod torus;

pub use crate::geometry::random::SplitMix64;
pub use genus::genus;
pub use grading::{Sliver, grade, slivers};
pub use holes::punch;
pub use hyperelliptic::{hyperelliptic, hyperelliptic_graded};
pub use intrinsic::{IntrinsicSurface, bolza, flat_torus, one_vertex, two_triangle_sphere, two_vertex};
pub use inversion::{invert, tapered_genus};
pub use knot::TorusKnot;
pub use noise::noise;
pub use pants::pants;
pub use pants_gluing::{FenchelNielsen, PantsSurface, fenchel_nielsen};
pub use plane::{annulus, disk};
pub use sphere::{ellipsoid, icosphere};
pub use torus::torus;

use crate::error::{Error, Result};
use crate::geometry::space::USABLE_LENGTHS;
use crate::mesh::Point;
use crate::mesh::io::Soup;

/// Largest number of vertices of a sample surface: a vertex has about six half-edges, and these are numbered in u32.
const MAX_VERTICES: f64 = 5e8;

/// Checks that a count is at least `least`, and that its shape, of about `vertices` vertices, is not too large.
fn check_count(what: &'static str, count: usize, least: usize, vertices: f64) -> Result<()> {
    if count < least {
        return Err(Error::argument(what, count, "larger: the surface would be degenerate"));
    }
    if vertices > MAX_VERTICES {
        return Err(Error::argument(what, count, "smaller: the mesh would exceed 5·10⁸ vertices"));
    }
    Ok(())
}

/// Checks that the corners of all faces are vertices of the list.
fn check_corners(soup: &Soup) -> Result<()> {
    match soup.faces.iter().flatten().find(|&&v| v as usize >= soup.positions.len()) {
        Some(v) => Err(Error::argument("vertex of a face", v, "an existing vertex")),
        None => Ok(()),
    }
}

/// A torus of `n` × `m` vertices: vertex (i, j), at `at(i, j)`, is `i + n j`, and each cell of the grid is halved by its diagonal from
/// (i, j) to (i + 1, j + 1).
fn torus_grid(n: usize, m: usize, at: impl Fn(usize, usize) -> Point) -> Soup {
    let mut soup = Soup::default();
    let number = |i: usize, j: usize| ((i % n) + n * (j % m)) as u32;
    for (j, i) in (0..m).flat_map(|j| (0..n).map(move |i| (j, i))) {
        soup.positions.push(at(i, j));
        let (a, b, c, d) = (number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1));
        soup.faces.extend([[a, b, c], [a, c, d]]);
    }
    soup
}

/// Least ratio of two sizes of a shape: the coordinates of points that are the smaller size apart then differ in their last four digits.
const THIN: f64 = 1e-12;

/// Checks that a size is within [`USABLE_LENGTHS`].
fn check_size(what: &'static str, size: f64) -> Result<()> {
    if USABLE_LENGTHS.contains(&size) {
        return Ok(());
    }
    Err(Error::argument(what, format!("{size:e}"), "a number between 1e-150 and 1e150"))
}
