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
mod plane;
mod sphere;
mod torus;

pub use genus::genus;
pub use grading::{Sliver, grade, slivers};
pub use holes::punch;
pub use hyperelliptic::hyperelliptic;
pub use intrinsic::{Intrinsic, bolza, flat_torus, one_vertex, two_triangle_sphere, two_vertex};
pub use inversion::{invert, tapered_genus};
pub use knot::TorusKnot;
pub use noise::{SplitMix64, noise};
pub use pants::pants;
pub use plane::{annulus, disk};
pub use sphere::{ellipsoid, icosphere};
pub use torus::torus;

use crate::error::{Error, Result};
use crate::geometry::space::USABLE_LENGTHS;

/// Largest number of vertices a generator makes (half-edges are numbered in u32, six to a vertex).
const MAX_VERTICES: f64 = 5e8;

/// A count that is at least `least`, of a shape with about `vertices` vertices.
fn check_count(what: &'static str, count: usize, least: usize, vertices: f64) -> Result<()> {
    let value = count.to_string();
    if count < least {
        return Err(Error::Argument { what, value, need: "larger: the surface would be degenerate" });
    }
    if vertices > MAX_VERTICES {
        return Err(Error::Argument {
            what, value, need: "smaller: the mesh would exceed 5·10⁸ vertices"
        });
    }
    Ok(())
}

/// Least ratio of two sizes of a shape: points that differ by the smaller one alone keep four of their
/// digits.
const THIN: f64 = 1e-12;

/// A size within [`USABLE_LENGTHS`].
fn check_size(what: &'static str, size: f64) -> Result<()> {
    if USABLE_LENGTHS.contains(&size) {
        return Ok(());
    }
    Err(Error::Argument { what, value: format!("{size:e}"), need: "a number between 1e-150 and 1e150" })
}
