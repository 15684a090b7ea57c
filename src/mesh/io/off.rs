//! OFF, ascii: plain, COFF, NOFF, STOFF and their combinations (the extra columns are skipped).

use super::scan::{Place, lines};
use super::{Point, Soup, fan};
use crate::error::Result;

/// Parse OFF text. `path` is used in errors.
pub fn parse_off(text: &str, path: &str) -> Result<Soup> {
    let mut tokens = Tokens { lines: lines(text), path, line: 0, rest: "" };
    let Some(header) = tokens.next() else {
        return tokens.place().error("the file is empty".into());
    };
    // The header word is optional, and the first count may stick to it; the prefixes ST, C, N, 4 (and a dimension n) name
    // extra columns.
    let mut first = Some(header);
    if let Some((prefix, count)) = header.split_once("OFF") {
        first = Some(count).filter(|c| !c.is_empty());
        if !["", "C", "N", "CN", "ST", "STC", "STN", "STCN"].contains(&prefix) {
            return tokens.place().error(format!("OFF variant `{header}` is not three-dimensional OFF"));
        }
    }
    if tokens.rest.split_ascii_whitespace().next() == Some("BINARY") {
        return tokens.place().error("binary OFF is not read; convert it to ascii OFF".into());
    }
    let token = first.or_else(|| tokens.next());
    let n_vertices = tokens.place().count(token, "number of vertices")?;
    let token = tokens.next();
    let n_faces = tokens.place().count(token, "number of faces")?;
    // The number of edges may be missing at the end of the line.
    tokens.end_line();
    let mut soup = Soup::default();
    for v in 0..n_vertices {
        let mut point: Point = [0.0; 3];
        for (x, name) in point.iter_mut().zip(["x", "y", "z"]) {
            let token = tokens.next();
            *x = tokens.place().number(token, &format!("{name} of vertex {v} (of {n_vertices})"))?;
        }
        tokens.end_line();
        soup.positions.push(point);
    }
    let mut corners = Vec::new();
    for f in 0..n_faces {
        let token = tokens.next();
        let size = tokens.place().count(token, &format!("size of face {f} (of {n_faces})"))?;
        corners.clear();
        for k in 0..size {
            let token = tokens.next();
            let index = tokens.place().count(token, &format!("corner {k} of face {f}"))?;
            match u32::try_from(index) {
                Ok(v) => corners.push(v),
                Err(_) => return tokens.place().error(format!("face {f} names vertex {index}")),
            }
        }
        tokens.end_line();
        // Points and segments are legal in OFF and no part of the surface.
        fan(&corners, &mut soup.faces);
    }
    Ok(soup)
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
            // Blank lines do not count as the place of an error: at the end of the file that is its last word.
            self.line = if text.is_empty() { self.line } else { line };
            self.rest = text;
        }
    }
}
