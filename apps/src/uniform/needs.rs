//! What outputs need beside metric, layout and group, and what became of it.

use crate::failure::Failure;

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

/// What a step has made, or the text of its error.
///
/// # Errors
/// [`Failure::Cancelled`] alone.
pub fn told<T>(made: ricci::Result<T>) -> Result<Result<T, String>, Failure> {
    match made {
        Err(ricci::Error::Cancelled) => Err(Failure::Cancelled),
        made => Ok(made.map_err(|error| error.to_string())),
    }
}

/// What was made.
///
/// # Errors
/// [`Failure::Failed`] with the reason why it was not, also where no output asked for it.
pub fn known<T>(made: &Option<Result<T, String>>) -> Result<&T, Failure> {
    match made {
        Some(Ok(made)) => Ok(made),
        Some(Err(why)) => Err(Failure::Failed(why.clone())),
        None => Err(Failure::Failed("no output has asked for it".into())),
    }
}
