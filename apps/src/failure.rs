//! Why a command ends early, and with which exit code.

use ricci::Error;

/// A command that ends without a result.
#[derive(Debug)]
pub enum Failure {
    /// The run cannot deliver what was asked for (exit 1).
    Failed(String),
    /// The command line asks for something that does not exist (exit 2).
    Usage(String),
    /// The input is not what the command needs (exit 3).
    Input(String),
    /// Ctrl-C (exit 4).
    Cancelled,
}

impl Failure {
    pub fn exit_code(&self) -> u8 {
        match self {
            Failure::Failed(_) => 1,
            Failure::Usage(_) => 2,
            Failure::Input(_) => 3,
            Failure::Cancelled => 4,
        }
    }
}

impl std::fmt::Display for Failure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Failure::Failed(message) | Failure::Usage(message) | Failure::Input(message) => {
                f.write_str(message)
            }
            Failure::Cancelled => f.write_str("cancelled; nothing was written"),
        }
    }
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        match error {
            Error::Cancelled => Failure::Cancelled,
            Error::Argument { .. } | Error::TargetKind { .. } => Failure::Usage(error.to_string()),
            Error::Factorisation { .. } | Error::Layout(_) => Failure::Failed(error.to_string()),
            _ => Failure::Input(error.to_string()),
        }
    }
}
