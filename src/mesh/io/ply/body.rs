//! The rows of a PLY file, read number by number.

use super::super::kind::NumberType;
use super::super::scan::{Location, Quoted, real};
use super::header::{PlyElement, PlyEncoding, PlyHeader};
use crate::error::Result;
use std::iter::Peekable;

/// The part of the body that has not been read. In text each row is a line: further numbers on it are skipped, and so are blank lines.
pub(super) struct PlyBody<'a> {
    path: &'a str,
    bytes: &'a [u8],
    source: BodySource<'a>,
}

enum BodySource<'a> {
    Text {
        lines: Peekable<Box<dyn Iterator<Item = (usize, &'a [u8])> + 'a>>,
        /// The rest of the line, and its number.
        rest: &'a [u8],
        line: usize,
    },
    Binary {
        at: usize,
        big_endian: bool,
    },
}

/// The values of the properties of interest in one row.
pub(super) struct PlyRow {
    /// For each property with one number that number; otherwise 0.
    pub numbers: Vec<f64>,
    /// The lists that were asked for.
    pub lists: Vec<Vec<f64>>,
}

impl<'a> PlyBody<'a> {
    pub fn new(bytes: &'a [u8], header: &PlyHeader<'_>, path: &'a str) -> PlyBody<'a> {
        let source = match header.encoding {
            PlyEncoding::Ascii => {
                let (body, first) = (&bytes[header.body..], header.line);
                // In a file with LF a CR is a blank at the end of its line.
                let end = if body.contains(&b'\n') { b'\n' } else { b'\r' };
                let lines = body.split(move |&b| b == end).map(<[u8]>::trim_ascii);
                let lines = lines.enumerate().map(move |(i, line)| (first + i, line));
                let lines: Box<dyn Iterator<Item = _>> = Box::new(lines.filter(|(_, line)| !line.is_empty()));
                BodySource::Text { lines: lines.peekable(), rest: &[], line: first }
            }
            encoding => BodySource::Binary { at: header.body, big_endian: encoding == PlyEncoding::Big },
        };
        PlyBody { path, bytes, source }
    }

    /// The position of the last row, or of the byte after it.
    pub fn place(&self) -> Location<'a> {
        match self.source {
            BodySource::Text { line, .. } => Location::line(self.path, line),
            BodySource::Binary { at, .. } => Location::byte(self.path, at),
        }
    }

    /// Passes each row of an element, with its number and position and with the lists of these properties, to a function. A row takes at
    /// least a byte of the file: elements without properties have no rows.
    pub fn each(
        &mut self,
        element: &PlyElement<'_>,
        lists: &[Option<usize>],
        mut take: impl FnMut(usize, &PlyRow, Location<'a>) -> Result<()>,
    ) -> Result<()> {
        if element.properties.is_empty() {
            return Ok(());
        }
        let mut row =
            PlyRow { numbers: vec![0.0; element.properties.len()], lists: vec![Vec::new(); lists.len()] };
        for number in 0..element.count {
            let place = self.row(element, number, lists, &mut row)?;
            take(number, &row, place)?;
        }
        Ok(())
    }

    /// Skips all rows of an element.
    pub fn skip(&mut self, element: &PlyElement<'_>) -> Result<()> {
        self.each(element, &[], |_, _, _| Ok(()))
    }

    /// Reads a row; returns its position.
    fn row(
        &mut self,
        element: &PlyElement<'_>,
        number: usize,
        lists: &[Option<usize>],
        row: &mut PlyRow,
    ) -> Result<Location<'a>> {
        if let BodySource::Text { lines, rest, line } = &mut self.source {
            let Some((next, text)) = lines.next() else { return self.ended(element) };
            (*rest, *line) = (text, next);
        }
        let place = self.place();
        for (k, property) in element.properties.iter().enumerate() {
            let Some(count) = property.count else {
                row.numbers[k] = self.number(property.kind, element, number, k)?;
                continue;
            };
            let count = self.number(count, element, number, k)?;
            if !(count >= 0.0 && count.fract() == 0.0) {
                let name = String::from_utf8_lossy(property.name);
                return place.error(format!("list `{name}` of row {number} has {count} entries"));
            }
            let mut list = lists.iter().position(|list| *list == Some(k)).map(|i| &mut row.lists[i]);
            if let Some(list) = &mut list {
                list.clear();
            }
            for _ in 0..count as u64 {
                let x = self.number(property.kind, element, number, k)?;
                if let Some(list) = &mut list {
                    list.push(x);
                }
            }
        }
        Ok(place)
    }

    /// Reads the next number, of property `k`.
    fn number(&mut self, kind: NumberType, element: &PlyElement<'_>, row: usize, k: usize) -> Result<f64> {
        match &mut self.source {
            BodySource::Binary { at, big_endian } => {
                let Some(bytes) = self.bytes.get(*at..*at + kind.size()) else { return self.ended(element) };
                *at += kind.size();
                Ok(kind.read(bytes, *big_endian))
            }
            BodySource::Text { lines, rest, line } => {
                let place = Location::line(self.path, *line);
                let end = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
                let (token, behind) = rest.split_at(end);
                *rest = behind.trim_ascii_start();
                let token = std::str::from_utf8(token).ok();
                let number = match kind {
                    // The file says that the number has 32 bits, so it is rounded to these.
                    NumberType::F32 => {
                        let narrow = |t: &str| t.parse::<f32>().ok().map(f64::from).or_else(|| real(t));
                        token.and_then(narrow)
                    }
                    _ => token.and_then(real),
                };
                if let Some(number) = number {
                    return Ok(number);
                }
                let name = String::from_utf8_lossy(element.properties[k].name);
                match token {
                    Some("") if lines.peek().is_none() => self.ended(element),
                    Some("") => place.error(format!("row {row} of {} ends before `{name}`", said(element))),
                    token => place.error(format!(
                        "`{name}` of row {row} of {}: {} is not a number",
                        said(element),
                        Quoted(token.unwrap_or("�"))
                    )),
                }
            }
        }
    }

    fn ended<T>(&self, element: &PlyElement<'_>) -> Result<T> {
        let place = match self.source {
            BodySource::Text { line, .. } => Location::line(self.path, line),
            BodySource::Binary { .. } => Location::byte(self.path, self.bytes.len()),
        };
        place.error(format!("the file ends inside {} of {} rows", said(element), element.count))
    }
}

fn said(element: &PlyElement<'_>) -> String {
    format!("element `{}`", String::from_utf8_lossy(element.name))
}
