//! Tokens and numbers out of text lines, with errors that name the place.

use crate::error::{FilePosition, Error, Result};
use std::fmt::{self, Arguments};

/// What a text in Unicode may begin with.
pub(super) const BYTE_ORDER_MARK: char = '\u{feff}';

/// The lines of a text (ended by LF, CR LF or CR) with their 1-based numbers, without comments, trailing blanks and byte
/// order mark.
pub(super) fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let text = text.strip_prefix(BYTE_ORDER_MARK).unwrap_or(text);
    // In a file with LF a CR is a blank at the end of its line.
    let end = if text.contains('\n') { '\n' } else { '\r' };
    let bare = |line: &'_ str| line.find('#').unwrap_or(line.len());
    text.split(end).enumerate().map(move |(i, line)| (i + 1, line[..bare(line)].trim_end()))
}

/// The words of a line, between ASCII blanks.
pub(super) fn words(line: &str) -> impl Iterator<Item = &str> {
    let is_blank = |b: u8| matches!(b, b' ' | b'\t' | b'\r' | b'\n' | 0x0c);
    let mut rest = line;
    std::iter::from_fn(move || {
        let start = rest.bytes().position(|b| !is_blank(b))?;
        let length = rest.as_bytes()[start..].iter().position(|&b| is_blank(b));
        let end = length.map_or(rest.len(), |length| start + length);
        let word = &rest[start..end];
        rest = &rest[end..];
        Some(word)
    })
}

/// Where a token stands.
#[derive(Clone, Copy)]
pub(super) struct Location<'a> {
    pub path: &'a str,
    pub at: FilePosition,
}

impl<'a> Location<'a> {
    /// Lines count from 1.
    pub fn line(path: &'a str, line: usize) -> Self {
        Location { path, at: FilePosition::Line(line) }
    }

    /// Bytes count from 0.
    pub fn byte(path: &'a str, byte: usize) -> Self {
        Location { path, at: FilePosition::Byte(byte) }
    }

    pub fn whole(path: &'a str) -> Self {
        Location { path, at: FilePosition::Whole }
    }

    pub fn error<T>(self, message: String) -> Result<T> {
        Err(Error::Parse { path: self.path.into(), at: self.at, message })
    }

    /// A coordinate. `nan` and `inf` are accepted here; the diagnosis names their vertices.
    pub fn number(self, token: Option<&str>, what: Arguments<'_>) -> Result<f64> {
        match token {
            Some(t) => t.parse().or_else(|_| self.error(format!("{what} {} is not a number", Quoted(t)))),
            None => self.error(format!("{what} is missing")),
        }
    }

    /// A number that `what` gives as that of a vertex: a whole one that is not negative. Whether the vertex exists the diagnosis finds.
    pub fn vertex(self, number: f64, what: Arguments<'_>) -> Result<u32> {
        if number >= 0.0 && number <= f64::from(u32::MAX) && number.fract() == 0.0 {
            return Ok(number as u32);
        }
        self.error(format!("{what} names vertex {number}, which cannot be"))
    }

    pub fn count(self, token: Option<&str>, what: Arguments<'_>) -> Result<usize> {
        match token {
            Some(t) => t.parse().or_else(|_| self.error(format!("{what} {} is not a count", Quoted(t)))),
            None => self.error(format!("{what} is missing")),
        }
    }
}

/// Text of a file inside a message: between quotes, and cut after 80 characters.
pub(super) struct Quoted<'a>(pub &'a str);

impl fmt::Display for Quoted<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        const MOST: usize = 80;
        match self.0.char_indices().nth(MOST) {
            Some((end, _)) => write!(f, "`{}…`", &self.0[..end]),
            None => write!(f, "`{}`", self.0),
        }
    }
}

/// Tokens over line ends, without comments, and the line they stand on.
pub(super) struct Tokens<'a, L> {
    lines: L,
    path: &'a str,
    pub line: usize,
    pub rest: &'a str,
}

/// The tokens of a text.
pub(super) fn tokens<'a>(
    text: &'a str,
    path: &'a str,
) -> Tokens<'a, impl Iterator<Item = (usize, &'a str)> + use<'a>> {
    Tokens { lines: lines(text), path, line: 0, rest: "" }
}

impl<'a, L: Iterator<Item = (usize, &'a str)>> Tokens<'a, L> {
    /// Where the last token stands.
    pub fn place(&self) -> Location<'a> {
        if self.line == 0 { Location::whole(self.path) } else { Location::line(self.path, self.line) }
    }

    /// Skip what is left of the current line.
    pub fn end_line(&mut self) {
        self.rest = "";
    }

    pub fn next(&mut self) -> Option<&'a str> {
        loop {
            self.rest = self.rest.trim_start();
            if !self.rest.is_empty() {
                let end = self.rest.find(|c: char| c.is_ascii_whitespace()).unwrap_or(self.rest.len());
                let (token, rest) = self.rest.split_at(end);
                self.rest = rest;
                return Some(token);
            }
            let (line, text) = self.lines.next()?;
            // Blank lines do not count as the place of an error: at the end of the file that is its last
            // word.
            self.line = if text.is_empty() { self.line } else { line };
            self.rest = text;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quoted_text_is_cut_at_a_character() {
        assert_eq!(Quoted("ab").to_string(), "`ab`");
        assert_eq!(Quoted(&"é".repeat(80)).to_string(), format!("`{}`", "é".repeat(80)));
        assert_eq!(Quoted(&"é".repeat(3_000_000)).to_string(), format!("`{}…`", "é".repeat(80)));
    }
}
