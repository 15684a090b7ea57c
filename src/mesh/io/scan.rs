//! Tokens and numbers of text lines, with errors that give the position in the file.

use crate::error::{Error, FilePosition, Result};
use std::fmt::{self, Arguments};

/// The character with which a text in Unicode may begin.
pub(super) const BYTE_ORDER_MARK: char = '\u{feff}';

/// The lines of a text (ended by LF, CR LF or CR) with their numbers from 1, without trailing blanks and byte order mark, with comments.
pub(super) fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let text = text.strip_prefix(BYTE_ORDER_MARK).unwrap_or(text);
    // In a file with LF a CR is a blank at the end of its line.
    let end = if text.contains('\n') { '\n' } else { '\r' };
    text.split(end).enumerate().map(move |(i, line)| (i + 1, line.trim_end()))
}

/// A line without its comment. That begins with a word that begins with `#`, unless the word is a number that is not finite, such as
/// `#QNAN`: in `-1.#IND` no comment begins either.
pub(super) fn bare(line: &str) -> &str {
    let mut from = 0;
    while let Some(at) = line[from..].find('#').map(|k| from + k) {
        let begins_word = line[..at].bytes().next_back().is_none_or(|b| b.is_ascii_whitespace());
        if begins_word && words(&line[at..]).next().and_then(not_finite).is_none() {
            return line[..at].trim_end();
        }
        from = at + 1;
    }
    line
}

/// The number that a word says, also where it is not finite in the spelling of another program.
pub(super) fn real(word: &str) -> Option<f64> {
    word.parse().ok().or_else(|| not_finite(word))
}

/// A number that is not finite as Microsoft's library writes it: `1.#INF`, `-1.#IND`, `1.#QNAN0`, `-nan(ind)`, also without `1.`.
fn not_finite(word: &str) -> Option<f64> {
    /// The letters after `#`; the last ones are what is left when the digits are rounded off.
    const NAMES: [(&str, f64); 8] = [
        ("inf", f64::INFINITY),
        ("ind", f64::NAN),
        ("qnan", f64::NAN),
        ("snan", f64::NAN),
        ("nan", f64::NAN),
        ("io", f64::NAN),
        ("qo", f64::NAN),
        ("j", f64::INFINITY),
    ];
    /// No such number is longer; other words are not looked at.
    const LONGEST: usize = 32;
    if word.len() > LONGEST || !word.contains(['#', '(']) {
        return None;
    }
    let lower = word.to_ascii_lowercase();
    let (sign, size) = match lower.strip_prefix('-') {
        Some(size) => (-1.0, size),
        None => (1.0, lower.strip_prefix('+').unwrap_or(&lower)),
    };
    if size.starts_with("nan(") && size.ends_with(')') {
        return Some(f64::NAN);
    }
    let name =
        size.strip_prefix("1.").or_else(|| size.strip_prefix("1,")).unwrap_or(size).strip_prefix('#')?;
    let is_tail = |tail: &str| tail.bytes().all(|b| b.is_ascii_digit() || matches!(b, b'e' | b'+' | b'-'));
    let matching = |(letters, _): &&(&str, f64)| name.strip_prefix(*letters).is_some_and(is_tail);
    NAMES.iter().find(matching).map(|(_, value)| sign * value)
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

/// The position of a token in a file.
#[derive(Clone, Copy)]
pub(super) struct Location<'a> {
    pub path: &'a str,
    pub at: FilePosition,
}

impl<'a> Location<'a> {
    /// A line, counted from 1.
    pub fn line(path: &'a str, line: usize) -> Self {
        Location { path, at: FilePosition::Line(line) }
    }

    /// A byte, counted from 0.
    pub fn byte(path: &'a str, byte: usize) -> Self {
        Location { path, at: FilePosition::Byte(byte) }
    }

    pub fn whole(path: &'a str) -> Self {
        Location { path, at: FilePosition::Whole }
    }

    pub fn error<T>(self, message: String) -> Result<T> {
        Err(Error::Parse { path: self.path.into(), at: self.at, message })
    }

    /// Reads a coordinate. `nan` and `inf` are accepted here; the diagnosis names their vertices.
    pub fn number(self, token: Option<&str>, what: Arguments<'_>) -> Result<f64> {
        match token {
            Some(t) => match real(t) {
                Some(number) => Ok(number),
                None => self.error(format!("{what} {} is not a number", Quoted(t))),
            },
            None => self.error(format!("{what} is missing")),
        }
    }

    /// The vertex with this number, which must be whole and not negative; `what` describes it in errors. The diagnosis checks whether the
    /// vertex exists.
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

/// Text of a file inside a message, between quotes and cut after 80 characters.
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

/// Tokens across line ends, without comments, and the line of the last one.
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
    Tokens { lines: lines(text).map(|(number, line)| (number, bare(line))), path, line: 0, rest: "" }
}

impl<'a, L: Iterator<Item = (usize, &'a str)>> Tokens<'a, L> {
    /// The position of the last token.
    pub fn place(&self) -> Location<'a> {
        if self.line == 0 { Location::whole(self.path) } else { Location::line(self.path, self.line) }
    }

    /// Skips the rest of the current line.
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
            // Blank lines are not reported as the position of an error: at the end of the file that is its last word.
            self.line = if text.is_empty() { self.line } else { line };
            self.rest = text;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_that_are_not_finite_are_read_in_every_spelling() {
        for word in [
            "nan",
            "-NaN",
            "1.#IND",
            "-1.#IND",
            "-1.#IND00",
            "1.#QNAN0",
            "1.#SNAN",
            "#QNAN",
            "-nan(ind)",
            "1,#IO",
        ] {
            assert!(real(word).unwrap().is_nan(), "{word}");
        }
        for (word, value) in
            [("1.#INF", f64::INFINITY), ("-1.#INF00", f64::NEG_INFINITY), ("#INF", f64::INFINITY)]
        {
            assert_eq!(real(word), Some(value), "{word}");
        }
        assert_eq!(real("1.#INFe+000"), Some(f64::INFINITY));
        for word in ["1.#", "#", "1.#INDIGO", "2.#INF", "nan(", "#1", "1#2", "#information"] {
            assert_eq!(real(word), None, "{word}");
        }
    }

    #[test]
    fn a_comment_begins_with_a_word() {
        for (line, expected) in [
            ("# all", ""),
            ("v 1 2 3 # last", "v 1 2 3"),
            ("v 1 2\t#3", "v 1 2"),
            ("v 0 -1.#IND 0 #x", "v 0 -1.#IND 0"),
            ("v #QNAN #INF 0", "v #QNAN #INF 0"),
            ("usemtl Blue#1", "usemtl Blue#1"),
            ("f 1 2 3", "f 1 2 3"),
        ] {
            assert_eq!(bare(line), expected, "{line}");
        }
    }

    #[test]
    fn quoted_text_is_cut_at_a_character() {
        assert_eq!(Quoted("ab").to_string(), "`ab`");
        assert_eq!(Quoted(&"é".repeat(80)).to_string(), format!("`{}`", "é".repeat(80)));
        assert_eq!(Quoted(&"é".repeat(3_000_000)).to_string(), format!("`{}…`", "é".repeat(80)));
    }
}
