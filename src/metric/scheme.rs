//! The five schemes as rows of (ε, η).
//!
//! ```
//! # use ricci::metric::Scheme;
//! assert_eq!("virtual".parse::<Scheme>()?.epsilon(), -1);
//! # Ok::<(), ricci::Error>(())
//! ```

use crate::archive::stored;
use crate::error::Error;

/// A discrete conformal structure: which vertex types and edge weights a metric is represented with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Scheme {
    /// Discrete Yamabe flow, vertex scaling: ε = 0, η from the lengths. Represents any metric exactly.
    Yamabe,
    /// Inversive distance circle packing: ε = 1, η > −1. Represents any metric exactly.
    Inversive,
    /// Thurston's circle packing: ε = 1, η = cos φ ∈ [0, 1]. Clamping η moves lengths; the amount is reported.
    Thurston,
    /// Tangential circle packing: ε = 1, η = 1. Depends on the connectivity alone.
    Tangential,
    /// Virtual radius circle packing (imaginary circles): ε = −1, η > 1. Represents any metric exactly.
    Virtual,
}
stored!(variants Scheme {
        Yamabe = 0,
        Inversive = 1,
        Thurston = 2,
        Tangential = 3,
        Virtual = 4,
    }
);

impl Scheme {
    /// All schemes.
    pub const ALL: [Scheme; 5] =
        [Scheme::Yamabe, Scheme::Inversive, Scheme::Thurston, Scheme::Tangential, Scheme::Virtual];

    /// The type ε of every vertex.
    pub fn epsilon(self) -> i8 {
        match self {
            Scheme::Yamabe => 0,
            Scheme::Inversive | Scheme::Thurston | Scheme::Tangential => 1,
            Scheme::Virtual => -1,
        }
    }

    /// True if this is Thurston's or a tangential packing, which are Delaunay on any triangulation: flips have no part in them.
    pub fn is_packing(self) -> bool {
        matches!(self, Scheme::Thurston | Scheme::Tangential)
    }

    /// The name used in files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Scheme::Yamabe => "yamabe",
            Scheme::Inversive => "inversive",
            Scheme::Thurston => "thurston",
            Scheme::Tangential => "tangential",
            Scheme::Virtual => "virtual",
        }
    }
}

impl std::str::FromStr for Scheme {
    type Err = Error;

    fn from_str(name: &str) -> Result<Scheme, Error> {
        Scheme::ALL.into_iter().find(|s| s.name() == name).ok_or_else(|| Error::Argument {
            what: "scheme",
            value: name.into(),
            need: "yamabe, inversive, thurston, tangential or virtual",
        })
    }
}

impl std::fmt::Display for Scheme {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}
