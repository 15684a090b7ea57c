//! OFF, text and binary: plain, COFF, NOFF, STOFF and their combinations (normals, colours and texture
//! coordinates are skipped). The format is Geomview's, <http://www.geomview.org/docs/html/OFF.html>.

use super::off_binary::parse_off_binary;
use super::scan::{Place, lines};
use super::{Point, Soup, fan};
use crate::error::Result;

/// Parse an OFF file, text or binary. Indices count from 0. `path` is used in errors.
pub fn parse_off(bytes: &[u8], path: &str) -> Result<Soup> {
    match binary(bytes, path)? {
        Some((columns, body, place)) => parse_off_binary(bytes, body, columns, place),
        None => parse_off_text(&String::from_utf8_lossy(bytes), path),
    }
}

/// Numbers per vertex, where the data begin and the place of the header, if that says `BINARY`.
fn binary<'a>(bytes: &[u8], path: &'a str) -> Result<Option<(usize, usize, Place<'a>)>> {
    let mut end = 0;
    for (i, line) in bytes.split_inclusive(|&b| b == b'\n').enumerate() {
        end += line.len();
        let line = line.split(|&b| b == b'#').next().unwrap_or_default();
        let mut words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
        if let Some(first) = words.next() {
            let place = Place { path, line: i + 1 };
            let header = String::from_utf8_lossy(first);
            return match header.strip_suffix("OFF") {
                Some(prefix) if words.next() == Some(b"BINARY") => {
                    Ok(Some((columns(prefix, place)?, end, place)))
                }
                _ => Ok(None),
            };
        }
    }
    Ok(None)
}

/// Numbers per vertex of the variant that the letters before `OFF` name, in any order.
fn columns(prefix: &str, place: Place<'_>) -> Result<usize> {
    let prefix = prefix.trim_start_matches('\u{feff}');
    let mut rest = prefix;
    let mut columns = 3;
    let mut known = vec![("ST", 2), ("N", 3), ("C", 4)];
    while let Some(i) = known.iter().position(|(letters, _)| rest.starts_with(letters)) {
        let (letters, numbers) = known.remove(i);
        (rest, columns) = (&rest[letters.len()..], columns + numbers);
    }
    match rest {
        "" => Ok(columns),
        _ if rest.contains(['4', 'n']) => place.error(format!(
            "`{prefix}OFF` has vertices of another dimension than 3; export it as OFF with x, y, z"
        )),
        _ => place.error(format!(
            "`{prefix}OFF` is no OFF header; known are OFF, COFF, NOFF, STOFF and combinations"
        )),
    }
}

fn parse_off_text(text: &str, path: &str) -> Result<Soup> {
    let mut tokens = Tokens { lines: lines(text), path, line: 0, rest: "" };
    let Some(header) = tokens.next() else {
        return tokens.place().error("the file is empty; OFF begins with `OFF` and its counts".into());
    };
    // The header word is optional, and the first count may stick to it.
    let first = match header.split_once("OFF") {
        Some((prefix, count)) => {
            columns(prefix, tokens.place())?;
            if count.is_empty() { tokens.next() } else { Some(count) }
        }
        None if header.starts_with(|c: char| c.is_ascii_digit()) => Some(header),
        None => {
            return tokens.place().error(format!("`{header}` begins no OFF file; that begins with `OFF`"));
        }
    };
    let n_vertices = tokens.place().count(first, format_args!("number of vertices"))?;
    let line = tokens.line;
    let token = tokens.next();
    let n_faces = tokens.place().count(token, format_args!("number of faces"))?;
    // The number of edges is not needed, and may be missing where the others share a line.
    if tokens.line != line {
        tokens.next();
    }
    tokens.end_line();
    let mut soup = Soup::default();
    for v in 0..n_vertices {
        let mut point: Point = [0.0; 3];
        for (x, name) in point.iter_mut().zip(["x", "y", "z"]) {
            let token = tokens.next();
            *x = tokens.place().number(token, format_args!("{name} of vertex {v} (of {n_vertices})"))?;
        }
        tokens.end_line();
        soup.positions.push(point);
    }
    let mut corners = Vec::new();
    for f in 0..n_faces {
        let token = tokens.next();
        let size = tokens.place().count(token, format_args!("size of face {f} (of {n_faces})"))?;
        corners.clear();
        for k in 0..size {
            let token = tokens.next();
            let index = tokens.place().count(token, format_args!("corner {k} of face {f}"))?;
            match u32::try_from(index) {
                Ok(v) => corners.push(v),
                Err(_) => {
                    return tokens
                        .place()
                        .error(format!("face {f} names vertex {index}, more than can be numbered"));
                }
            }
        }
        tokens.end_line();
        // Points and segments are legal in OFF and no part of the surface.
        fan(&corners, &mut soup.faces);
    }
    match tokens.next() {
        None => Ok(soup),
        Some(token) => tokens.place().error(format!(
            "`{token}` comes after the last face: the header promises {n_vertices} vertices and {n_faces} faces, each on a line of its own"
        )),
    }
}
/// Tokens over line ends, without comments, and the line they stand on.
struct Tokens<'a, L> {
    lines: L,
    path: &'a str,
    line: usize,
    rest: &'a str,
}

impl<'a, L: Iterator<Item = (usize, &'a str)>> Tokens<'a, L> {
    fn place(&self) -> Place<'a> {
        Place { path: self.path, line: self.line }
    }

    /// Skip what is left of the current line.
    fn end_line(&mut self) {
        self.rest = "";
    }

    fn next(&mut self) -> Option<&'a str> {
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
