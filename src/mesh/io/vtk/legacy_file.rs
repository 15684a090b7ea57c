//! The words and the numbers of a legacy VTK file.

use super::poly_data::number_type;
use crate::error::Result;
use crate::mesh::io::budget::Budget;
use crate::mesh::io::kind::NumberType;
use crate::mesh::io::scan::{Location, Quoted};
use std::borrow::Cow;

/// A file from byte `at` on.
pub(super) struct LegacyFile<'a> {
    pub bytes: &'a [u8],
    pub at: usize,
    pub path: &'a str,
    pub is_binary: bool,
}

impl<'a> LegacyFile<'a> {
    pub fn place(&self) -> Location<'a> {
        Location::byte(self.path, self.at)
    }

    /// The rest of the present line; the next begins behind it.
    pub fn line(&mut self) -> Cow<'a, str> {
        let rest = &self.bytes[self.at..];
        let end = rest.iter().position(|&b| b == b'\n').unwrap_or(rest.len());
        self.at += (end + 1).min(rest.len());
        String::from_utf8_lossy(rest[..end].trim_ascii())
    }

    /// The next word; the file stands at the byte behind it.
    pub fn word(&mut self) -> Option<&'a [u8]> {
        let rest = &self.bytes[self.at..];
        let start = rest.iter().position(|b| !b.is_ascii_whitespace())?;
        let length = rest[start..].iter().position(u8::is_ascii_whitespace);
        let end = length.map_or(rest.len(), |length| start + length);
        self.at += end;
        Some(&rest[start..end])
    }

    /// The next word as text.
    pub fn text(&mut self, what: &str) -> Result<Cow<'a, str>> {
        match self.word() {
            Some(word) => Ok(String::from_utf8_lossy(word)),
            None => self.place().error(format!("the file ends before {what}")),
        }
    }

    pub fn count(&mut self, what: &str) -> Result<usize> {
        let place = self.place();
        let word = self.text(what)?;
        place.count(Some(&word), format_args!("{what}"))
    }

    pub fn kind(&mut self) -> Result<NumberType> {
        let place = self.place();
        let word = self.text("a type of numbers")?;
        match number_type(&word) {
            Some(kind) => Ok(kind),
            None => place.error(format!("numbers of the type {} are not read", Quoted(&word))),
        }
    }

    /// So many numbers, behind the line that announces them.
    pub fn numbers(
        &mut self,
        kind: NumberType,
        count: usize,
        what: &str,
        budget: &mut Budget,
    ) -> Result<Vec<f64>> {
        let place = self.place();
        if self.is_binary {
            self.line();
        }
        let left = self.bytes.len() - self.at;
        // A number of a text takes two bytes, with the blank before it.
        let size = if self.is_binary { kind.size() } else { 2 };
        if count.checked_mul(size).is_none_or(|bytes| bytes > left + 1) {
            return place.error(format!("{left} bytes follow, too few for {count} {what}"));
        }
        budget.take(count, size_of::<f64>(), what, place)?;
        if self.is_binary {
            let Some(data) = self.bytes.get(self.at..self.at + count * size) else {
                return place.error(format!("{left} bytes follow, too few for {count} {what}"));
            };
            self.at += data.len();
            return Ok(data.chunks_exact(size).map(|word| kind.read(word, true)).collect());
        }
        let mut numbers = Vec::with_capacity(count);
        for k in 0..count {
            let word = self.word().map(String::from_utf8_lossy);
            numbers.push(
                self.place().number(word.as_deref(), format_args!("number {k} of {count} of {what}:"))?,
            );
        }
        Ok(numbers)
    }

    /// Skips the lines of a block of metadata, which ends with an empty one.
    pub fn skip_metadata(&mut self) {
        self.line();
        while !self.line().is_empty() {}
    }

    /// True if the next word is this keyword; the file stands before it again where it is another.
    pub fn keyword(&mut self, wanted: &str) -> bool {
        let before = self.at;
        if self.word().is_some_and(|word| word.eq_ignore_ascii_case(wanted.as_bytes())) {
            return true;
        }
        self.at = before;
        false
    }
}
