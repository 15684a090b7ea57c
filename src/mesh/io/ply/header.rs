//! The header of a PLY file: the elements in its body, and where the body begins.

use super::super::kind::NumberType;
use super::super::scan::{Location, Quoted};
use crate::error::Result;

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum PlyEncoding {
    Ascii,
    Little,
    Big,
}

/// A property: one number of each row, or a list of numbers after their count.
pub(super) struct PlyProperty<'a> {
    pub name: &'a [u8],
    /// The type of a list's count.
    pub count: Option<NumberType>,
    pub kind: NumberType,
}

/// An element: rows of the same properties.
pub(super) struct PlyElement<'a> {
    pub name: &'a [u8],
    pub count: usize,
    pub properties: Vec<PlyProperty<'a>>,
    /// The line that declares it.
    line: usize,
}

impl<'a> PlyElement<'a> {
    /// The index of the property with one number per row and this name (case does not matter).
    pub fn column(&self, name: &str) -> Option<usize> {
        self.property(|p| p.count.is_none() && p.name.eq_ignore_ascii_case(name.as_bytes()))
    }

    /// The index of the property with a list per row and one of these names.
    pub fn list(&self, names: &[&str]) -> Option<usize> {
        self.property(|p| p.count.is_some() && names.iter().any(|name| p.name == name.as_bytes()))
    }

    fn property(&self, is: impl FnMut(&PlyProperty<'a>) -> bool) -> Option<usize> {
        self.properties.iter().position(is)
    }

    /// The position of this element in the header.
    pub fn place<'p>(&self, path: &'p str) -> Location<'p> {
        Location::line(path, self.line)
    }
}

pub(super) struct PlyHeader<'a> {
    pub encoding: PlyEncoding,
    pub elements: Vec<PlyElement<'a>>,
    /// The start of the body: its first byte and its first line, from 1.
    pub body: usize,
    pub line: usize,
    /// The pictures that comments name as textures.
    pub pictures: Vec<String>,
}

/// The lines of a header, each with the byte after it. A lone carriage return ends a line too: if one ends the first line, line feeds
/// after others are not skipped, since they belong to a binary body.
struct HeaderLines<'a> {
    bytes: &'a [u8],
    at: usize,
    number: usize,
    only_returns: bool,
}

impl<'a> HeaderLines<'a> {
    fn next(&mut self) -> Option<&'a [u8]> {
        let rest = self.bytes.get(self.at..).filter(|rest| !rest.is_empty())?;
        let end = rest.iter().position(|b| matches!(b, b'\n' | b'\r')).unwrap_or(rest.len());
        let pair = rest[end..].starts_with(b"\r\n");
        if self.number == 0 {
            self.only_returns = rest.get(end) == Some(&b'\r') && !pair;
        }
        self.at += (end + 1 + usize::from(pair && !self.only_returns)).min(rest.len());
        self.number += 1;
        Some(rest[..end].trim_ascii())
    }
}

/// Parses the header. Blank lines, indentation and any names are accepted; elements that are read have different names.
pub(super) fn header<'a>(bytes: &'a [u8], path: &str) -> Result<PlyHeader<'a>> {
    let start = if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
    let mut lines = HeaderLines { bytes, at: start, number: 0, only_returns: false };
    if lines.next() != Some(b"ply") {
        let what = "this is no PLY file: that begins with the line `ply`";
        return Location::line(path, 1).error(what.into());
    }
    let (mut encoding, mut pictures) = (None, Vec::new());
    let mut elements: Vec<PlyElement<'a>> = Vec::new();
    while let Some(line) = lines.next() {
        let place = Location::line(path, lines.number);
        let mut words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
        match words.next() {
            Some(b"comment") if words.next() == Some(&b"TextureFile"[..]) => {
                pictures.extend(words.next().map(|name| Quoted(&text(name)).to_string()));
            }
            None | Some(b"comment" | b"obj_info") => {}
            Some(b"format") => encoding = Some(format(words.next(), place)?),
            Some(b"element") => {
                let (name, count) = (words.next().unwrap_or_default(), words.next().map(text));
                let count =
                    place.count(count.as_deref(), format_args!("rows of element `{}`:", text(name)))?;
                // Elements that are not read may have equal names: comparing any number of them would take long.
                if READ.contains(&name) && elements.iter().any(|e| e.name == name) {
                    return place.error(format!("a second element `{}`", text(name)));
                }
                elements.push(PlyElement { name, count, properties: Vec::new(), line: lines.number });
            }
            Some(b"property") => match elements.last_mut() {
                Some(element) => element.properties.push(property(words, place)?),
                None => return place.error("a property before the first element".into()),
            },
            Some(b"end_header") => {
                let Some(encoding) = encoding else {
                    return place.error("the header has no line `format`".into());
                };
                return Ok(PlyHeader {
                    encoding,
                    elements,
                    body: lines.at,
                    line: lines.number + 1,
                    pictures,
                });
            }
            Some(word) => {
                return place.error(format!("{} begins no line of a PLY header", Quoted(&text(word))));
            }
        }
    }
    Location::line(path, lines.number).error("the header has no line `end_header`".into())
}

/// The elements that are read.
const READ: [&[u8]; 3] = [b"vertex", b"face", b"tristrips"];

fn text(word: &[u8]) -> String {
    String::from_utf8_lossy(word).into_owned()
}

fn format(word: Option<&[u8]>, place: Location<'_>) -> Result<PlyEncoding> {
    match word {
        Some(b"ascii") => Ok(PlyEncoding::Ascii),
        Some(b"binary_little_endian") => Ok(PlyEncoding::Little),
        Some(b"binary_big_endian") => Ok(PlyEncoding::Big),
        _ => place.error(format!(
            "format {} is not ascii, binary_little_endian or binary_big_endian",
            Quoted(&text(word.unwrap_or_default()))
        )),
    }
}

fn property<'a>(mut words: impl Iterator<Item = &'a [u8]>, place: Location<'_>) -> Result<PlyProperty<'a>> {
    let kind = |word: Option<&[u8]>| {
        let name = text(word.unwrap_or_default());
        match NumberType::named(&name) {
            Some(kind) => Ok(kind),
            None => place.error(format!("{} is no type of a property", Quoted(&name))),
        }
    };
    let first = words.next();
    let (count, kind) = match first {
        Some(b"list") => (Some(kind(words.next())?), kind(words.next())?),
        _ => (None, kind(first)?),
    };
    if count.is_some_and(|count| !count.is_integer()) {
        return place.error("the count of a list is no integer".into());
    }
    match words.next() {
        Some(name) => Ok(PlyProperty { name, count, kind }),
        None => place.error("a property without a name".into()),
    }
}
