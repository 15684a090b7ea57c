//! The reasons why a command ends early, and their exit codes.

use ricci::Error;
use ricci::mesh::check::Diagnosis;

/// A command that ends without a result.
#[derive(Debug)]
pub enum Failure {
    /// The run cannot deliver what was asked for (exit 1).
    Failed(String),
    /// The command line asks for something that does not exist (exit 2).
    Usage(String),
    /// The input is not what the command needs (exit 3).
    Input(String),
    /// The input's faces do not form the surface that is needed (exit 3).
    Defects(Box<Diagnosis>),
    /// The faces of an intrinsic metric do not form a surface by their vertices alone, and may be meant to be glued in a way that the file
    /// does not say (exit 3).
    Unglued(Box<Diagnosis>),
    /// Ctrl-C (exit 4).
    Cancelled,
}

/// The reason why nothing in space can be made of an intrinsic metric.
pub const NO_POSITIONS: &str = "an intrinsic metric has no positions in space";

impl Failure {
    pub fn no_positions() -> Failure {
        Failure::Failed(NO_POSITIONS.into())
    }

    pub fn exit_code(&self) -> u8 {
        match self {
            Failure::Failed(_) => 1,
            Failure::Usage(_) => 2,
            Failure::Input(_) | Failure::Defects(_) | Failure::Unglued(_) => 3,
            Failure::Cancelled => 4,
        }
    }
}

impl std::fmt::Display for Failure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Failure::Failed(message) | Failure::Usage(message) | Failure::Input(message) => {
                f.write_str(message)?;
                if names_element(message) { write!(f, " (elements are numbered from 0)") } else { Ok(()) }
            }
            Failure::Defects(diagnosis) => diagnosis.fmt(f),
            Failure::Unglued(diagnosis) => write!(
                f,
                "{diagnosis}. Faces whose vertices do not say how they are glued need `face_edges`: \
                 [[±e_bc, ±e_ca, ±e_ab], …], edges numbered from 1, the sign their direction"
            ),
            Failure::Cancelled => f.write_str("cancelled; nothing was written"),
        }
    }
}

/// True if a text names a vertex, face or edge by its number without saying where numbers begin.
pub fn names_element(text: &str) -> bool {
    const KINDS: [&str; 6] = ["vertex", "vertices", "face", "faces", "edge", "edges"];
    let words: Vec<&str> = text.split_whitespace().map(|word| word.trim_start_matches('(')).collect();
    let named = |w: &[&str]| KINDS.contains(&w[0]) && w[1].starts_with(|c: char| c.is_ascii_digit());
    words.windows(2).any(named) && !text.contains("from 0")
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        match error {
            Error::Cancelled => Failure::Cancelled,
            Error::Defects(diagnosis) => Failure::Defects(diagnosis),
            Error::Argument { .. } | Error::TargetKind { .. } => Failure::Usage(error.to_string()),
            Error::Factorisation { .. } | Error::Layout(_) => Failure::Failed(error.to_string()),
            _ => Failure::Input(error.to_string()),
        }
    }
}

/// The result of a step, or the text of its error.
///
/// # Errors
/// [`Failure::Cancelled`] alone.
pub fn or_reason<T>(result: ricci::Result<T>) -> Result<Result<T, String>, Failure> {
    match result {
        Err(Error::Cancelled) => Err(Failure::Cancelled),
        result => Ok(result.map_err(|error| error.to_string())),
    }
}

/// The result of a step that an output needs.
///
/// # Errors
/// [`Failure::Failed`] with the reason why there is none, also where no output has asked for the step.
pub fn required<T>(result: &Option<Result<T, String>>) -> Result<&T, Failure> {
    match result {
        Some(Ok(result)) => Ok(result),
        Some(Err(why)) => Err(Failure::Failed(why.clone())),
        None => Err(Failure::Failed("no output has asked for it".into())),
    }
}
