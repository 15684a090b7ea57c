//! Reader and writer of OFF, text and binary: plain, COFF, NOFF, STOFF and their combinations (colours of faces are skipped). The format
//! is Geomview's, <http://www.geomview.org/docs/html/OFF.html>.

use super::budget::Budget;
use super::off_binary::parse_off_binary;
use super::off_extras::{Columns, Extras};
use super::polygon::Polygons;
use super::scan::{Location, Quoted, Tokens, real, tokens};
use super::shortest::Shortest;
use super::soup::{Attributes, Soup};
use super::{Format, write_atomically};
use crate::error::Result;
use crate::mesh::Point;
use std::io::Write;
use std::path::Path;

/// Parses an OFF file, text or binary. Indices count from 0. `path` is used in errors.
///
/// # Errors
///
/// [`crate::Error::Parse`] with the line or byte.
pub fn parse_off(bytes: &[u8], path: &str) -> Result<Soup> {
    match binary(bytes, path)? {
        Some((columns, body, place)) => parse_off_binary(bytes, body, columns, place),
        None => parse_off_text(&String::from_utf8_lossy(bytes), path),
    }
}

/// The columns of each vertex, the byte at which the data begin and the position of the header, if that says `BINARY`.
fn binary<'a>(bytes: &[u8], path: &'a str) -> Result<Option<(Columns, usize, Location<'a>)>> {
    let mut end = 0;
    for (i, line) in bytes.split_inclusive(|&b| b == b'\n').enumerate() {
        end += line.len();
        let line = line.split(|&b| b == b'#').next().unwrap_or_default();
        let mut words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
        if let Some(first) = words.next() {
            let place = Location::line(path, i + 1);
            let header = String::from_utf8_lossy(first);
            return match split_header(&header) {
                Some((prefix, "")) if words.next().is_some_and(|w| w.eq_ignore_ascii_case(b"BINARY")) => {
                    Ok(Some((columns(&prefix, place)?, end, place)))
                }
                _ => Ok(None),
            };
        }
    }
    Ok(None)
}

/// The text before and after `OFF`. Some programs write the header in lower case; its letters then mean the same as capitals.
pub(super) fn split_header(word: &str) -> Option<(String, &str)> {
    let upper = word.split_once("OFF").map(|(prefix, rest)| (prefix.to_string(), rest));
    upper.or_else(|| word.split_once("off").map(|(prefix, rest)| (prefix.to_ascii_uppercase(), rest)))
}

/// The columns that the letters before `OFF` name, in any order.
fn columns(prefix: &str, place: Location<'_>) -> Result<Columns> {
    let prefix = prefix.trim_start_matches('\u{feff}');
    let mut rest = prefix;
    let mut columns = Columns::default();
    loop {
        let (letters, flag) = match rest {
            _ if rest.starts_with("ST") && !columns.texture => (2, &mut columns.texture),
            _ if rest.starts_with('N') && !columns.normal => (1, &mut columns.normal),
            _ if rest.starts_with('C') && !columns.color => (1, &mut columns.color),
            _ => break,
        };
        (rest, *flag) = (&rest[letters..], true);
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

/// Reads a text file. Without letters before `OFF` a vertex has three numbers, and further numbers on its line are either columns that
/// the header does not announce, or the next vertex: the interpretation is chosen that agrees with the counts of the header. Where
/// vertices share a line, each has to be on one line as a whole, so that a file with a missing number is not read in this way.
fn parse_off_text(text: &str, path: &str) -> Result<Soup> {
    let header = tokens(text, "").next().and_then(split_header);
    let has_letters = header.is_some_and(|(prefix, _)| !prefix.trim_start_matches('\u{feff}').is_empty());
    match read_text(text, path, true) {
        Err(error) if !has_letters => read_text(text, path, false).or(Err(error)),
        soup => soup,
    }
}

/// Reads the header: the columns of vertices, their number and that of the faces.
fn header<'a>(
    tokens: &mut Tokens<'a, impl Iterator<Item = (usize, &'a str)>>,
) -> Result<(Columns, usize, usize)> {
    let Some(header) = tokens.next() else {
        return tokens.place().error("the file is empty; OFF begins with `OFF` and its counts".into());
    };
    // The header word is optional, and the first count may follow it without a space.
    let mut has = Columns::default();
    let first = match split_header(header) {
        Some((prefix, count)) => {
            has = columns(&prefix, tokens.place())?;
            if count.is_empty() { tokens.next() } else { Some(count) }
        }
        None if header.starts_with(|c: char| c.is_ascii_digit()) => Some(header),
        None => {
            let message = format!("{} begins no OFF file; that begins with `OFF`", Quoted(header));
            return tokens.place().error(message);
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
    Ok((has, n_vertices, n_faces))
}

/// Reads the text; with `by_line` each vertex has a line of its own, perhaps with further columns.
fn read_text(text: &str, path: &str, by_line: bool) -> Result<Soup> {
    let mut tokens = tokens(text, path);
    let (has, n_vertices, n_faces) = header(&mut tokens)?;
    let (mut positions, mut extras, mut polygons) = (Vec::new(), Extras::new(has), Polygons::default());
    for v in 0..n_vertices {
        let mut point: Point = [0.0; 3];
        let mut line = None;
        for (x, name) in point.iter_mut().zip(["x", "y", "z"]) {
            let token = tokens.next();
            if !by_line && *line.get_or_insert(tokens.line) != tokens.line {
                return tokens.place().error(format!("vertex {v} (of {n_vertices}) is on two lines"));
            }
            *x = tokens.place().number(token, format_args!("{name} of vertex {v} (of {n_vertices})"))?;
        }
        if by_line {
            let rest: Vec<f64> = tokens.rest.split_ascii_whitespace().map_while(real).collect();
            extras.push(&rest);
            tokens.end_line();
        }
        positions.push(point);
    }
    let mut corners = Vec::new();
    for f in 0..n_faces {
        let token = tokens.next();
        let size = tokens.place().count(token, format_args!("size of face {f} (of {n_faces})"))?;
        corners.clear();
        for k in 0..size {
            let token = tokens.next();
            let index = tokens.place().count(token, format_args!("corner {k} of face {f}"))?;
            let Ok(v) = u32::try_from(index) else {
                let message = format!("face {f} names vertex {index}, more than can be numbered");
                return tokens.place().error(message);
            };
            corners.push(v);
        }
        extras.face_colors |= !tokens.rest.trim_start().is_empty();
        tokens.end_line();
        // Points and segments are legal in OFF but not part of the surface.
        polygons.push(corners.iter().copied());
    }
    match tokens.next() {
        None => extras.soup(positions, &polygons, Budget::of(text.as_bytes()), Location::whole(path)),
        Some(token) => tokens.place().error(format!(
            "{} comes after the last face: the header promises {n_vertices} vertices and {n_faces} faces, each on a line of its own",
            Quoted(token)
        )),
    }
}

/// Writes text OFF, atomically, with the fewest digits that read back to the same numbers, with normals, colours (0 to 255) if there are
/// any, and texture coordinates if each vertex has a single pair. Returns what was left out: normals and
/// texture coordinates that differ between the corners of a vertex, and [`Attributes::unheld`].
///
/// # Errors
///
/// With the file untouched: [`crate::Error::Argument`] for numbers that are not finite and corners out of range,
/// [`crate::Error::Size`] for attributes of another size, [`crate::Error::Io`].
pub fn write_off(path: &Path, soup: &Soup) -> Result<Vec<String>> {
    soup.check_writable()?;
    let Soup { positions, faces, attributes } = soup;
    let Attributes { normals, colors, .. } = attributes;
    let texture = attributes.vertex_uv(positions.len(), faces);
    write_atomically(path, |out| {
        let letters = [(texture.is_some(), "ST"), (colors.is_some(), "C"), (normals.is_some(), "N")];
        for (_, letters) in letters.into_iter().filter(|(has, _)| *has) {
            out.write_all(letters.as_bytes())?;
        }
        writeln!(out, "OFF\n{} {} 0", positions.len(), faces.len())?;
        for (v, [x, y, z]) in positions.iter().enumerate() {
            write!(out, "{} {} {}", Shortest(*x), Shortest(*y), Shortest(*z))?;
            if let Some([x, y, z]) = normals.as_ref().map(|n| n[v]) {
                write!(out, " {} {} {}", Shortest(x), Shortest(y), Shortest(z))?;
            }
            if let Some(color) = colors.as_ref().map(|c| c[v]) {
                let [r, g, b, a] = color.map(|x| (255.0 * x.clamp(0.0, 1.0)).round() as u8);
                write!(out, " {r} {g} {b} {a}")?;
            }
            if let Some([s, t]) = texture.as_ref().map(|uv| uv[v]) {
                write!(out, " {} {}", Shortest(s), Shortest(t))?;
            }
            writeln!(out)?;
        }
        for [a, b, c] in faces {
            writeln!(out, "3 {a} {b} {c}")?;
        }
        Ok(())
    })?;
    Ok([attributes.left_out(texture.is_some()), attributes.unheld(Format::Off)].concat())
}
