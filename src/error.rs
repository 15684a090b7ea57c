//! One error type for the whole library, with stable codes that the C face repeats.
//!
//! Codes come in blocks per family; a retired number is never given out again.
//!
//! ```
//! use ricci::{Error, mesh::shapes};
//! let error = shapes::torus(1.0, 2.0, 8, 8).unwrap_err();
//! assert!(matches!(error, Error::Argument { .. }) && error.code() == 2);
//! ```

use crate::mesh::check::Diagnosis;

/// Result of every fallible call of the library.
pub type Result<T> = std::result::Result<T, Error>;

/// A position in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FilePosition {
    /// The number of a line of text, from 1.
    Line(usize),
    /// The number of a byte, from 0: the start of what is wrong, or the file's size if something is missing at its end.
    Byte(usize),
    /// The file as a whole: something is missing from it, or it has too much of something.
    Whole,
}

/// The position as text that follows the file's name: `:12`, `, byte 40`, or nothing.
impl std::fmt::Display for FilePosition {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            FilePosition::Line(line) => write!(f, ":{line}"),
            FilePosition::Byte(byte) => write!(f, ", byte {byte}"),
            FilePosition::Whole => Ok(()),
        }
    }
}

/// An error: its kind, the element or argument concerned, and advice. Every variant that concerns an element carries its index (0-based).
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// An array does not have the size the call needs.
    #[error("{what} has {got} entries, {expected} are needed")]
    Size {
        /// The array.
        what: &'static str,
        /// Entries needed.
        expected: usize,
        /// Entries given.
        got: usize,
    },
    /// An option or argument is outside its range.
    #[error("{what} is {value}: {need}")]
    Argument {
        /// The argument.
        what: &'static str,
        /// Its value, as text.
        value: String,
        /// The condition that it must meet.
        need: &'static str,
    },
    /// More elements than a `u32` index can number.
    #[error("{count} {what} are more than a 32-bit index can number")]
    TooLarge {
        /// The kind of element.
        what: &'static str,
        /// The number of elements.
        count: usize,
    },
    /// The caller cancelled through its `Control`.
    #[error("cancelled by the caller; inputs are unchanged")]
    Cancelled,

    /// A file could not be read or written.
    #[error("{path}: {message}")]
    Io {
        /// The file.
        path: String,
        /// The message of the system.
        message: String,
    },
    /// A file's content is not what its format says.
    #[error("{path}{at}: {message}")]
    Parse {
        /// The file.
        path: String,
        /// The position in the file.
        at: FilePosition,
        /// The violation of the format.
        message: String,
    },
    /// This build has no reader or no writer for this file name.
    #[error("{path}: {message}")]
    UnknownFormat {
        /// The file.
        path: String,
        /// The extensions that it knows, or the cargo feature that it lacks.
        message: String,
    },

    /// The faces do not form the surface that is needed; the diagnosis lists every defect.
    #[error("{0}")]
    Defects(Box<Diagnosis>),
    /// The edge gluing of an intrinsic surface is inconsistent.
    #[error("face {face}: {message}")]
    Gluing {
        /// The face (0-based).
        face: usize,
        /// The fault, and how to mend it.
        message: String,
    },
    /// A connectivity invariant does not hold (an error of the library or of a caller that built its own arrays).
    #[error("connectivity of {element} {index}: {message}")]
    Connectivity {
        /// The kind of element.
        element: &'static str,
        /// Its index.
        index: usize,
        /// The broken rule.
        message: &'static str,
    },

    /// An edge length is not positive, or out of range.
    #[error(
        "edge {edge} has length {}: lengths must lie between 1e-150 and 1e150 (weld its ends, or rescale)",
        number(*length)
    )]
    EdgeLength {
        /// The edge.
        edge: usize,
        /// Its length.
        length: f64,
    },
    /// A face's lengths break the triangle inequality of the input geometry.
    #[error("face {face} breaks the triangle inequality ({}): no such triangle exists", amount("too long", *excess))]
    TriangleInequality {
        /// The face.
        face: usize,
        /// By how much the longest side exceeds the other two (relative to it); in S² the perimeter may exceed 2π.
        excess: f64,
    },
    /// The scheme cannot represent the metric on this edge.
    #[error("edge {edge}: weight η = {} is outside the scheme's range ({need})", number(*eta))]
    EdgeWeight {
        /// The edge.
        edge: usize,
        /// Its weight.
        eta: f64,
        /// The range.
        need: &'static str,
    },
    /// The conformal variables leave the domain of the metric at a vertex.
    #[error("vertex {vertex}: u = {u} is outside the metric's domain ({need})")]
    Domain {
        /// The vertex.
        vertex: usize,
        /// Its variable.
        u: f64,
        /// The domain.
        need: &'static str,
    },

    /// A prescribed curvature is too large at a vertex.
    #[error("vertex {vertex}: target curvature {curvature} must be below {limit}: {}", amount("too large", *excess))]
    TargetAtVertex {
        /// The vertex.
        vertex: usize,
        /// The curvature asked for, radians.
        curvature: f64,
        /// 2π inside, π on the boundary.
        limit: f64,
        /// The amount by which it is too large.
        excess: f64,
    },
    /// A prescribed curvature is too small for the angles that the vertex can have.
    #[error("vertex {vertex}: target curvature {curvature} must be above {limit}: {}", amount("too small", *excess))]
    TargetBelow {
        /// The vertex.
        vertex: usize,
        /// The curvature asked for, radians.
        curvature: f64,
        /// The least value, not attained.
        limit: f64,
        /// Limit minus curvature (≥ 0).
        excess: f64,
    },
    /// The prescribed curvatures do not add up to what Gauss–Bonnet asks for.
    #[error("target curvatures add up to {sum}, Gauss–Bonnet needs {need}: {}", amount("off", *miss))]
    TargetTotal {
        /// Their sum, radians.
        sum: f64,
        /// The condition.
        need: String,
        /// By how much the sum misses it.
        miss: f64,
    },
    /// This kind of target does not exist here.
    #[error("target `{target}`: {message}")]
    TargetKind {
        /// The target's name.
        target: &'static str,
        /// The reason, and what to use instead.
        message: String,
    },

    /// The linear system could not be factorised.
    #[error("the linear system of {size} unknowns could not be factorised: {message}")]
    Factorisation {
        /// Number of unknowns.
        size: usize,
        /// The reason.
        message: String,
    },

    /// The metric has no layout in this space.
    #[error("layout: {0}")]
    Layout(String),

    /// There is no map between two surfaces as it was asked for.
    #[error("matching: {0}")]
    Matching(String),

    /// A spline, or the data to make one from, is invalid.
    #[error("{what} {index}: {message}")]
    Spline {
        /// The kind of element: patch, triangle, vertex, control point.
        what: &'static str,
        /// Its number.
        index: usize,
        /// The fault, and how to mend it.
        message: String,
    },
}

impl Error {
    /// [`Error::Argument`] with the value as text.
    pub fn argument(what: &'static str, value: impl ToString, need: &'static str) -> Error {
        Error::Argument { what, value: value.to_string(), need }
    }

    /// [`Error::Connectivity`].
    pub fn connectivity(element: &'static str, index: usize, message: &'static str) -> Error {
        Error::Connectivity { element, index, message }
    }

    /// Stable number of the variant: 1–99 calls, 100s files, 200s meshes, 300s metrics, 400s targets, 500s
    /// solvers, 600s layouts and matchings, 700s splines.
    pub fn code(&self) -> u32 {
        match self {
            Error::Size { .. } => 1,
            Error::Argument { .. } => 2,
            Error::TooLarge { .. } => 3,
            Error::Cancelled => 4,
            Error::Io { .. } => 100,
            Error::Parse { .. } => 101,
            Error::UnknownFormat { .. } => 102,
            Error::Defects(_) => 200,
            Error::Gluing { .. } => 201,
            Error::Connectivity { .. } => 202,
            Error::EdgeLength { .. } => 300,
            Error::TriangleInequality { .. } => 301,
            Error::EdgeWeight { .. } => 302,
            Error::Domain { .. } => 303,
            Error::TargetAtVertex { .. } => 400,
            Error::TargetTotal { .. } => 401,
            Error::TargetKind { .. } => 402,
            Error::TargetBelow { .. } => 403,
            Error::Factorisation { .. } => 500,
            Error::Layout(_) => 600,
            Error::Matching(_) => 650,
            Error::Spline { .. } => 700,
        }
    }
}

/// A number as text, with an exponent where plain notation would need many zeros.
fn number(x: f64) -> String {
    if x == 0.0 || (1e-4..1e9).contains(&x.abs()) { x.to_string() } else { format!("{x:e}") }
}

/// A text like `too large by 1.5e-1`; for an amount of 0 it says that the bound is strict.
fn amount(how: &str, by: f64) -> String {
    if by == 0.0 { "equality is not enough".into() } else { format!("{how} by {:.4e}", by.abs()) }
}

/// Compares the size of an array with the size that a call needs.
///
/// # Errors
///
/// [`Error::Size`] where they differ.
pub fn check_size(what: &'static str, got: usize, expected: usize) -> Result<()> {
    if got == expected { Ok(()) } else { Err(Error::Size { what, expected, got }) }
}
