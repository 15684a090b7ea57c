//! A uniformization that is to be done, with what its outputs need.

use super::args::CanonicalArgs;
use crate::input::Input;
use ricci::Control;

/// The results that outputs need beside metric, layout and group.
#[derive(Clone, Copy)]
pub struct OutputNeeds {
    /// The common subdivision of the given triangulation and the metric's.
    pub subdivision: bool,
    /// The layout on the input's own faces.
    pub on_input: bool,
    /// The Dirichlet domain of the base point.
    pub domain: bool,
}

/// A surface that is to be uniformized.
pub struct CanonicalTask<'a> {
    pub input: &'a Input,
    pub args: &'a CanonicalArgs,
    pub needs: OutputNeeds,
    pub control: &'a Control,
}
