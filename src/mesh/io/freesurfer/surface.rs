//! Surfaces of FreeSurfer: lists of triangles, binary or as text.

use super::big_endian::{BigEndianWords, signed, single};
use crate::error::Result;
use crate::mesh::Point;
use crate::mesh::io::budget::Budget;
use crate::mesh::io::scan::{Location, tokens};
use crate::mesh::io::shortest::Shortest;
use crate::mesh::io::{Attributes, Format, Soup, write_atomically};
use std::io::Write;
use std::path::Path;

/// The first bytes of a list of triangles.
pub const BINARY_MARK: &[u8] = b"\xff\xff\xfe";
/// The beginning of a list as text.
pub const TEXT_MARK: &[u8] = b"#!ascii";
/// The line that says who made a file.
const CREATED: &[u8] = b"created by ricci\n\n";

/// Parses a surface of FreeSurfer, binary (three bytes of mark, two lines of text, counts, vertices in single precision, triangles) or text
/// (`#!ascii`). Coordinates are as stored, in millimetres from the centre of the volume; what follows the triangles, such as the geometry of
/// the volume, is not read. `path` is used in errors.
///
/// # Errors
/// [`crate::Error::Parse`] with the byte or the line.
pub fn parse_freesurfer(bytes: &[u8], path: &str) -> Result<Soup> {
    if bytes.starts_with(TEXT_MARK) {
        return parse_text(&String::from_utf8_lossy(bytes), path);
    }
    if !bytes.starts_with(BINARY_MARK) {
        let what = match bytes {
            [0xff, 0xff, 0xff, ..] => "values at the vertices of a surface, or a surface of quadrangles",
            [0xff, 0xff, 0xfd, ..] => "a surface of quadrangles",
            _ => {
                return Location::whole(path)
                    .error("this is no surface of FreeSurfer: its mark is missing".into());
            }
        };
        return Location::whole(path).error(format!(
            "this file of FreeSurfer holds {what}, not a list of triangles (mris_convert makes one)"
        ));
    }
    let mut words = BigEndianWords { bytes, at: BINARY_MARK.len(), path };
    for _ in 0..2 {
        let Some(end) = bytes[words.at..].iter().position(|&b| b == b'\n') else {
            return words.place().error("the file ends in the lines that say who made it".into());
        };
        words.at += end + 1;
    }
    let n_vertices = words.count("the number of vertices")?;
    let n_faces = words.count("the number of triangles")?;
    words.holds(n_vertices, 12, "vertices")?;
    let mut budget = Budget::of(bytes);
    budget.take(n_vertices, size_of::<Point>(), "vertices", words.place())?;
    let positions = (0..n_vertices).map(|_| words.point("a vertex")).collect::<Result<Vec<_>>>()?;
    words.holds(n_faces, 12, "triangles")?;
    budget.take(n_faces, size_of::<[u32; 3]>(), "triangles", words.place())?;
    let corner = |words: &mut BigEndianWords<'_>| words.count("a corner of a triangle").map(|v| v as u32);
    let face = |_| Ok([corner(&mut words)?, corner(&mut words)?, corner(&mut words)?]);
    let faces = (0..n_faces).map(face).collect::<Result<Vec<_>>>()?;
    let mut soup = Soup { positions, faces, attributes: Attributes::default() };
    if words.at < bytes.len() {
        soup.attributes.unread.push("what follows the triangles: the geometry of the volume".into());
    }
    Ok(soup)
}

/// `#!ascii …`, the two counts, then a line `x y z flag` per vertex and `a b c flag` per triangle.
fn parse_text(text: &str, path: &str) -> Result<Soup> {
    let mut tokens = tokens(text, path);
    let mut counts = [0; 2];
    for (count, what) in counts.iter_mut().zip(["vertices", "triangles"]) {
        let token = tokens.next();
        *count = tokens.place().count(token, format_args!("number of {what}"))?;
    }
    let [n_vertices, n_faces] = counts;
    let (mut positions, mut faces) = (Vec::new(), Vec::new());
    for v in 0..n_vertices {
        let mut point: Point = [0.0; 3];
        for x in &mut point {
            let token = tokens.next();
            *x = tokens.place().number(token, format_args!("vertex {v} (of {n_vertices}):"))?;
        }
        tokens.end_line();
        positions.push(point);
    }
    for f in 0..n_faces {
        let mut corners = [0; 3];
        for corner in &mut corners {
            let token = tokens.next();
            let number = tokens.place().number(token, format_args!("triangle {f} (of {n_faces}):"))?;
            *corner = tokens.place().vertex(number, format_args!("triangle {f}"))?;
        }
        tokens.end_line();
        faces.push(corners);
    }
    Ok(Soup { positions, faces, attributes: Attributes::default() })
}

/// Writes a binary list of triangles, atomically, with positions in single precision. Returns what was left out.
///
/// # Errors
/// With the file untouched: [`crate::Error::Argument`] for numbers that are not finite or not in the range of single precision and corners out of
/// range, [`crate::Error::Size`] for attributes of another size, [`crate::Error::TooLarge`], [`crate::Error::Io`].
pub fn write_freesurfer(path: &Path, soup: &Soup) -> Result<Vec<String>> {
    soup.check_writable()?;
    let mut bytes = [BINARY_MARK, CREATED].concat();
    bytes.extend(signed(soup.positions.len(), "vertices")?);
    bytes.extend(signed(soup.faces.len(), "triangles")?);
    for x in soup.positions.as_flattened() {
        bytes.extend(single(*x, "coordinate")?);
    }
    soup.faces.as_flattened().iter().for_each(|v| bytes.extend(v.to_be_bytes()));
    write_atomically(path, |out| out.write_all(&bytes))?;
    Ok(soup.attributes.all_left_out(Format::FreeSurfer))
}

/// Writes a list of triangles as text, atomically, with the fewest digits that read back to the same numbers. Returns what was left out.
///
/// # Errors
/// Those of [`write_freesurfer`] but for the range.
pub fn write_freesurfer_text(path: &Path, soup: &Soup) -> Result<Vec<String>> {
    soup.check_writable()?;
    write_atomically(path, |out| {
        writeln!(
            out,
            "#!ascii version of a surface by ricci\n{} {}",
            soup.positions.len(),
            soup.faces.len()
        )?;
        for [x, y, z] in &soup.positions {
            writeln!(out, "{} {} {} 0", Shortest(*x), Shortest(*y), Shortest(*z))?;
        }
        soup.faces.iter().try_for_each(|[a, b, c]| writeln!(out, "{a} {b} {c} 0"))
    })?;
    Ok(soup.attributes.all_left_out(Format::FreeSurfer))
}
