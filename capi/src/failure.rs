//! Why a call fails: a status and a message.

use crate::status::ricci_status;
use ricci::Error;

/// Why a call fails.
pub struct Failure {
    pub status: ricci_status,
    pub message: String,
}

/// What the body of an entry point returns.
pub type Outcome<T = ()> = Result<T, Failure>;

impl Failure {
    pub fn new(status: ricci_status, message: impl Into<String>) -> Failure {
        Failure { status, message: message.into() }
    }

    pub fn null(what: &str) -> Failure {
        Failure::new(ricci_status::RICCI_NULL_POINTER, format!("{what} is NULL"))
    }

    pub fn argument(message: impl Into<String>) -> Failure {
        Failure::new(ricci_status::RICCI_ARGUMENT, message)
    }
}

impl From<Error> for Failure {
    fn from(error: Error) -> Failure {
        let status = ricci_status::from_code(error.code()).unwrap_or(ricci_status::RICCI_ARGUMENT);
        Failure::new(status, error.to_string())
    }
}
