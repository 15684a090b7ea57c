//! What a surface in its canonical shape is found from.

use super::args::CanonicalArgs;
use crate::input::Input;
use ricci::Control;

/// What some outputs need beside metric, layout and group.
#[derive(Clone, Copy)]
pub struct Needs {
    /// The common refinement of the given triangulation and the metric's.
    pub refinement: bool,
    /// The layout on the input's own faces.
    pub on_input: bool,
    /// The Dirichlet domain of the base point.
    pub domain: bool,
}

/// A surface whose canonical shape is wanted.
pub struct Task<'a> {
    pub input: &'a Input,
    pub args: &'a CanonicalArgs,
    pub needs: Needs,
    pub control: &'a Control,
}
