//! Numbers out of text lines, with errors that name the line.

use crate::error::{Error, Result};

/// Where a token stands.
#[derive(Clone, Copy)]
pub(super) struct Place<'a> {
    pub path: &'a str,
    /// 1-based.
    pub line: usize,
}

impl Place<'_> {
    pub fn error<T>(self, message: String) -> Result<T> {
        Err(Error::Parse { path: self.path.into(), line: self.line, message })
    }

    /// A coordinate; `nan` and `inf` are numbers here, the diagnosis refuses them by vertex.
    pub fn number(self, token: Option<&str>, what: &str) -> Result<f64> {
        match token {
            Some(t) => t.parse().or_else(|_| self.error(format!("{what} `{t}` is not a number"))),
            None => self.error(format!("{what} is missing")),
        }
    }

    pub fn count(self, token: Option<&str>, what: &str) -> Result<usize> {
        match token {
            Some(t) => t.parse().or_else(|_| self.error(format!("{what} `{t}` is not a count"))),
            None => self.error(format!("{what} is missing")),
        }
    }
}
