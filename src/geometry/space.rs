//! The three background geometries.
//!
//! ```
//! use ricci::geometry::Space;
//! let space: Space = "h2".parse()?;
//! assert_eq!((space, space.curvature()), (Space::H2, -1.0));
//! # Ok::<(), ricci::Error>(())
//! ```

use crate::archive::stored;
use crate::error::Error;
use std::ops::RangeInclusive;

/// Range of the lengths that the library accepts, in any space: the squares of smaller and larger ones leave the range of f64.
pub const USABLE_LENGTHS: RangeInclusive<f64> = 1e-150..=1e150;

/// Background geometry of constant curvature.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Space {
    /// The Euclidean plane, λ = 0.
    E2,
    /// The hyperbolic plane, λ = −1.
    H2,
    /// The unit sphere, λ = +1.
    S2,
}
stored!(variants Space {
        E2 = 0,
        H2 = 1,
        S2 = 2,
    }
);

impl Space {
    /// Constant curvature λ.
    pub fn curvature(self) -> f64 {
        match self {
            Space::E2 => 0.0,
            Space::H2 => -1.0,
            Space::S2 => 1.0,
        }
    }

    /// The name used in files and on the command line: `e2`, `h2`, `s2`.
    pub fn name(self) -> &'static str {
        match self {
            Space::E2 => "e2",
            Space::H2 => "h2",
            Space::S2 => "s2",
        }
    }
}

impl std::str::FromStr for Space {
    type Err = Error;

    fn from_str(name: &str) -> Result<Space, Error> {
        [Space::E2, Space::H2, Space::S2]
            .into_iter()
            .find(|s| s.name().eq_ignore_ascii_case(name))
            .ok_or_else(|| Error::argument("space", name, "e2, h2 or s2"))
    }
}

impl std::fmt::Display for Space {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}
