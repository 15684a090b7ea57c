//! Wavefront OBJ. Our own reader, because the contract needs the file's vertex numbering, which the OBJ
//! crates replace by one of their own.

use super::scan::Place;
use super::{Point, Soup, fan, write_atomically};
use crate::error::{Error, Result};
use std::io::Write;
use std::path::Path;

/// Parse OBJ text: `v` and `f` (polygons, negative indices, `v/vt/vn` corners), line continuations;
/// everything else is skipped. `path` is used in errors.
pub fn parse_obj(bytes: &[u8], path: &str) -> Result<Soup> {
    let text = String::from_utf8_lossy(bytes);
    let mut soup = Soup::default();
    let mut corners = Vec::new();
    let mut lines = super::scan::lines(&text);
    let mut joined = String::new();
    while let Some((number, line)) = lines.next() {
        let place = Place { path, line: number };
        let mut line = line;
        if line.ends_with('\\') {
            joined.clear();
            while let Some(head) = line.strip_suffix('\\') {
                joined.push_str(head);
                joined.push(' ');
                line = lines.next().map_or("", |(_, next)| next);
            }
            joined.push_str(line);
            line = &joined;
        }
        let mut tokens = line.split_ascii_whitespace();
        match tokens.next() {
            Some("v") => {
                let mut point: Point = [0.0; 3];
                for (x, name) in point.iter_mut().zip(["x", "y", "z"]) {
                    *x = place.number(tokens.next(), format_args!("coordinate {name}"))?;
                }
                soup.positions.push(point);
            }
            Some("f") => {
                corners.clear();
                for token in tokens {
                    corners.push(corner(place, token, soup.positions.len())?);
                }
                // Faces of one or two corners occur in the wild; they are no part of the surface.
                fan(&corners, &mut soup.faces);
            }
            _ => {}
        }
    }
    Ok(soup)
}

/// The vertex of a corner `v`, `v/vt`, `v//vn`, `v/vt/vn`: 1-based, or negative from the last vertex so far.
fn corner(place: Place<'_>, token: &str, vertices: usize) -> Result<u32> {
    let index = token.split('/').next().unwrap_or("");
    let Ok(number) = index.parse::<i64>() else {
        return place.error(format!("corner `{token}` does not start with a vertex number"));
    };
    let zero_based = match number {
        0 => return place.error("vertex number 0: OBJ counts from 1".into()),
        n if n < 0 && n.unsigned_abs() > vertices as u64 => {
            return place.error(format!(
                "corner `{token}` counts back past the first of the {vertices} vertices so far"
            ));
        }
        n if n < 0 => vertices as i64 + n,
        n => n - 1,
    };
    match u32::try_from(zero_based) {
        Ok(v) => Ok(v),
        Err(_) => place.error(format!("corner `{token}` is more than can be numbered")),
    }
}

/// What [`write_obj`] writes.
#[derive(Debug, Clone, Copy, Default)]
pub struct ObjData<'a> {
    /// `v` lines.
    pub positions: &'a [Point],
    /// `vt` lines; empty for none.
    pub texcoords: &'a [[f64; 2]],
    /// Corners of the faces, 0-based into `positions`.
    pub faces: &'a [[u32; 3]],
    /// Corners of the faces, 0-based into `texcoords`; as many as faces, or empty for none.
    pub face_texcoords: &'a [[u32; 3]],
}

/// Write an OBJ file with 17 significant digits (which read back to the same doubles), atomically.
///
/// Errors, with the file untouched: [`Error::Argument`] for numbers that are not finite and corners out of
/// range, [`Error::Size`], [`Error::Io`].
pub fn write_obj(path: &Path, data: &ObjData<'_>) -> Result<()> {
    if !data.face_texcoords.is_empty() {
        crate::error::check_size("face_texcoords", data.face_texcoords.len(), data.faces.len())?;
    }
    finite("position", data.positions)?;
    finite("texture coordinate", data.texcoords)?;
    in_range("vertex", data.faces, data.positions.len())?;
    in_range("texture vertex", data.face_texcoords, data.texcoords.len())?;
    write_atomically(path, |out| {
        for [x, y, z] in data.positions {
            writeln!(out, "v {x:.16e} {y:.16e} {z:.16e}")?;
        }
        for [s, t] in data.texcoords {
            writeln!(out, "vt {s:.16e} {t:.16e}")?;
        }
        for (f, corners) in data.faces.iter().enumerate() {
            let [a, b, c] = corners.map(|v| v + 1);
            match data.face_texcoords.get(f).map(|t| t.map(|t| t + 1)) {
                Some([s, t, u]) => writeln!(out, "f {a}/{s} {b}/{t} {c}/{u}")?,
                None => writeln!(out, "f {a} {b} {c}")?,
            }
        }
        Ok(())
    })
}

fn finite<const N: usize>(what: &'static str, points: &[[f64; N]]) -> Result<()> {
    match points.iter().position(|p| p.iter().any(|x| !x.is_finite())) {
        Some(i) => {
            let value = format!("{:?} at entry {i}", points[i]);
            Err(Error::Argument { what, value, need: "a file holds finite numbers only" })
        }
        None => Ok(()),
    }
}

fn in_range(what: &'static str, faces: &[[u32; 3]], n: usize) -> Result<()> {
    match faces.iter().position(|corners| corners.iter().any(|&v| v as usize >= n)) {
        Some(f) => {
            let value = format!("one of {:?} in face {f}", faces[f]);
            Err(Error::Argument {
                what,
                value,
                need: "corners must be below the number of entries they name",
            })
        }
        None => Ok(()),
    }
}
