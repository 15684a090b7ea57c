//! Numbers out of text lines, with errors that name the line.

use crate::error::{Error, Result};
use std::fmt::Arguments;

/// The lines of a text (ended by LF, CR LF or CR) with their 1-based numbers, without comments, trailing blanks and byte
/// order mark.
pub(super) fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    // In a file with LF a CR is a blank at the end of its line.
    let end = if text.contains('\n') { '\n' } else { '\r' };
    let bare = |line: &'_ str| -> usize { line.find('#').unwrap_or(line.len()) };
    text.split(end).enumerate().map(move |(i, line)| (i + 1, line[..bare(line)].trim_end()))
}

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
    pub fn number(self, token: Option<&str>, what: Arguments<'_>) -> Result<f64> {
        match token {
            Some(t) => t.parse().or_else(|_| self.error(format!("{what} `{t}` is not a number"))),
            None => self.error(format!("{what} is missing")),
        }
    }

    pub fn count(self, token: Option<&str>, what: Arguments<'_>) -> Result<usize> {
        match token {
            Some(t) => t.parse().or_else(|_| self.error(format!("{what} `{t}` is not a count"))),
            None => self.error(format!("{what} is missing")),
        }
    }
}
