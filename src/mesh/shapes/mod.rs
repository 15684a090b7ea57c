//! Sample surfaces of every topology, at any resolution.

mod genus;
mod intrinsic;
mod noise;
mod plane;
mod sphere;
mod torus;

pub use genus::genus;
pub use intrinsic::{Intrinsic, bolza, flat_torus, one_vertex, two_triangle_sphere, two_vertex};
pub use noise::{SplitMix64, noise};
pub use plane::{annulus, disk};
pub use sphere::{ellipsoid, icosphere};
pub use torus::torus;

use crate::error::{Error, Result};

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

/// A positive finite size.
fn check_size(what: &'static str, size: f64) -> Result<()> {
    if size > 0.0 && size.is_finite() {
        return Ok(());
    }
    Err(Error::Argument { what, value: size.to_string(), need: "a positive finite number" })
}
