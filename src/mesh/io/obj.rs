//! Wavefront OBJ. This reader keeps the file's vertex numbering, which the readers of other crates replace by one of their own.

use super::budget::Budget;
use super::polygon::Polygons;
use super::scan::{Location, Quoted, words};
use super::shortest::Shortest;
use super::soup::{NO_NORMAL, NO_TEXCOORD, WHITE};
use super::{Attributes, Soup, Textured, write_atomically};
use crate::error::Result;
use crate::mesh::Point;
use std::borrow::Cow;
use std::io::Write;
use std::path::Path;

/// Parse OBJ text: `v` (with colours behind the coordinates, if there are any), `vt`, `vn` and `f` (polygons, negative indices,
/// `v/vt/vn` corners), line continuations; everything else is skipped. `path` is used in errors.
///
/// Normals are those of the vertices where all corners of each vertex name equal ones, else those of the corners. What is missing,
/// or no number, has the default of [`Attributes`].
///
/// # Errors
///
/// [`crate::Error::Parse`] with the line.
pub fn parse_obj(bytes: &[u8], path: &str) -> Result<Soup> {
    let text = std::str::from_utf8(bytes).map_or_else(|_| String::from_utf8_lossy(bytes), Cow::Borrowed);
    let mut file = File::default();
    let mut lines = super::scan::lines(&text);
    let mut joined = String::new();
    while let Some((number, line)) = lines.next() {
        let place = Location::line(path, number);
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
        let mut tokens = words(line);
        match tokens.next() {
            Some("v") => {
                let mut point: Point = [0.0; 3];
                for (x, name) in point.iter_mut().zip(["x", "y", "z"]) {
                    *x = place.number(tokens.next(), format_args!("coordinate {name}"))?;
                }
                file.positions.push(point);
                if let Some(color) = color(tokens) {
                    file.colors.resize(file.positions.len() - 1, WHITE);
                    file.colors.push(color);
                }
            }
            Some("vt") => file.texcoords.push(numbers(tokens)),
            Some("vn") => file.normals.push(numbers(tokens)),
            Some("f") => {
                for token in tokens {
                    if let Some(v) = plain(token) {
                        file.polygons.corners.push(v);
                        file.corner_texcoords.push(NO_ENTRY);
                        file.corner_normals.push(NO_ENTRY);
                        continue;
                    }
                    file.polygons.corners.push(corner(place, token, file.positions.len())?);
                    let mut parts = token.split('/').skip(1);
                    file.corner_texcoords.push(attribute(parts.next(), file.texcoords.len()));
                    file.corner_normals.push(attribute(parts.next(), file.normals.len()));
                }
                file.polygons.end();
            }
            _ => {}
        }
    }
    file.soup(Budget::of(bytes), Location::whole(path))
}

/// The entry of a corner that names no texture coordinate or no normal.
const NO_ENTRY: u32 = u32::MAX;

/// What has been read so far.
#[derive(Default)]
struct File {
    positions: Vec<Point>,
    colors: Vec<[f64; 4]>,
    texcoords: Vec<[f64; 2]>,
    normals: Vec<Point>,
    polygons: Polygons,
    /// Per corner, the entry it names, or `NO_ENTRY`.
    corner_texcoords: Vec<u32>,
    corner_normals: Vec<u32>,
}

impl File {
    fn soup(mut self, mut budget: Budget, place: Location<'_>) -> Result<Soup> {
        let triangles = self.polygons.triangles(&self.positions, &mut budget, place)?;
        fn of<const N: usize>(list: &[[f64; N]], entries: &[u32], corner: usize) -> Option<[f64; N]> {
            let entry = list.get(entries[corner] as usize).copied();
            entry.filter(|x| x.iter().all(|x| x.is_finite()))
        }
        let texcoord = |corner: usize| of(&self.texcoords, &self.corner_texcoords, corner);
        let any = triangles.as_flattened().iter().any(|&corner| texcoord(corner).is_some());
        let uv = |t: &[usize; 3]| t.map(|corner| texcoord(corner).unwrap_or(NO_TEXCOORD));
        let uv = any.then(|| triangles.iter().map(uv).collect());
        let normal = |corner: usize| of(&self.normals, &self.corner_normals, corner);
        let mut corner_normals = None;
        let normals = self.vertex_normals(&triangles, normal);
        if normals.is_none() {
            budget.take(triangles.len(), size_of::<[Point; 3]>(), "normals", place)?;
            let of = |t: &[usize; 3]| t.map(|corner| normal(corner).unwrap_or(NO_NORMAL));
            corner_normals = Some(triangles.iter().map(of).collect());
        }
        let normals = normals.filter(|normals| !normals.is_empty());
        let faces = self.polygons.faces(&triangles);
        let colors = (!self.colors.is_empty()).then(|| {
            self.colors.resize(self.positions.len(), WHITE);
            self.colors
        });
        let attributes = Attributes { normals, corner_normals, colors, uv };
        Ok(Soup { positions: self.positions, faces, attributes })
    }

    /// The normals of the vertices, empty if corners name none; `None` where corners of a vertex name different ones.
    fn vertex_normals(
        &self,
        triangles: &[[usize; 3]],
        normal: impl Fn(usize) -> Option<Point>,
    ) -> Option<Vec<Point>> {
        let mut normals: Vec<Option<Point>> = Vec::new();
        for &corner in triangles.as_flattened() {
            let Some(normal) = normal(corner) else { continue };
            normals.resize(self.positions.len(), None);
            // The diagnosis finds corners that name a vertex which does not exist.
            if let Some(slot) = normals.get_mut(self.polygons.corners[corner] as usize)
                && *slot.get_or_insert(normal) != normal
            {
                return None;
            }
        }
        Some(normals.into_iter().map(|n| n.unwrap_or(NO_NORMAL)).collect())
    }
}

/// The colour behind the three coordinates of a vertex: red, green, blue and perhaps opacity (a fourth coordinate alone is a
/// weight). `None` where it is none.
fn color<'a>(tokens: impl Iterator<Item = &'a str>) -> Option<[f64; 4]> {
    let x: Option<Vec<f64>> = tokens.map(|t| t.parse().ok().filter(|x: &f64| x.is_finite())).collect();
    match x?.as_slice() {
        [r, g, b] => Some([*r, *g, *b, 1.0]),
        [r, g, b, a, ..] => Some([*r, *g, *b, *a]),
        _ => None,
    }
}

/// The first N numbers; NaN for those that are missing.
fn numbers<'a, const N: usize>(mut tokens: impl Iterator<Item = &'a str>) -> [f64; N] {
    std::array::from_fn(|_| tokens.next().and_then(|t| t.parse().ok()).unwrap_or(f64::NAN))
}

/// The entry (0-based) that the second or third number of a corner names among `count` so far; a wrong one names none.
fn attribute(number: Option<&str>, count: usize) -> u32 {
    let entry = |number: &str| match number.parse::<i64>().ok()? {
        0 => None,
        n if n < 0 => count.checked_sub(usize::try_from(n.unsigned_abs()).ok()?)?.try_into().ok(),
        n => u32::try_from(n - 1).ok(),
    };
    number.and_then(entry).unwrap_or(NO_ENTRY)
}

/// The vertex of a corner that is nothing but a number of up to nine digits, as most are.
fn plain(token: &str) -> Option<u32> {
    let digit = |n: u32, b: &u8| b.is_ascii_digit().then(|| 10 * n + u32::from(b - b'0'));
    let number = if token.len() <= 9 { token.as_bytes().iter().try_fold(0, digit) } else { None };
    number?.checked_sub(1)
}

/// The vertex of a corner `v`, `v/vt`, `v//vn`, `v/vt/vn`: 1-based, or negative from the last vertex so far.
fn corner(place: Location<'_>, token: &str, vertices: usize) -> Result<u32> {
    let index = token.split('/').next().unwrap_or("");
    let Ok(number) = index.parse::<i64>() else {
        return place.error(format!("corner {} does not start with a vertex number", Quoted(token)));
    };
    let zero_based = match number {
        0 => return place.error("vertex number 0: OBJ counts from 1".into()),
        n if n < 0 && n.unsigned_abs() > vertices as u64 => {
            return place.error(format!(
                "corner {} counts back past the first of the {vertices} vertices so far",
                Quoted(token)
            ));
        }
        n if n < 0 => vertices as i64 + n,
        n => n - 1,
    };
    match u32::try_from(zero_based) {
        Ok(v) => Ok(v),
        Err(_) => place.error(format!("corner {} is more than can be numbered", Quoted(token))),
    }
}

/// Write an OBJ file, its numbers with the fewest digits that read back to the same doubles, atomically. With
/// [`Textured::texcoord_weights`] a comment on the first line says that the `vt` are homogeneous.
///
/// # Errors
///
/// With the file untouched: [`crate::Error::Argument`] for numbers that are not finite and corners out of
/// range, [`crate::Error::Size`], [`crate::Error::Io`].
pub fn write_obj(path: &Path, data: &Textured<'_>) -> Result<()> {
    data.check()?;
    write_atomically(path, |out| {
        if !data.texcoord_weights.is_empty() {
            writeln!(
                out,
                "# vt are homogeneous: (q x, q y, q), linear within each face; the texture is at (x, y)"
            )?;
        }
        for (v, [x, y, z]) in data.positions.iter().enumerate() {
            write!(out, "v {} {} {}", Shortest(*x), Shortest(*y), Shortest(*z))?;
            if let Some([r, g, b, a]) = data.colors.get(v) {
                write!(out, " {r:.6} {g:.6} {b:.6}")?;
                if *a != 1.0 {
                    write!(out, " {a:.6}")?;
                }
            }
            writeln!(out)?;
        }
        for (k, [s, t]) in data.texcoords.iter().enumerate() {
            match data.texcoord_weights.get(k) {
                Some(q) => writeln!(out, "vt {} {} {}", Shortest(q * s), Shortest(q * t), Shortest(*q))?,
                None => writeln!(out, "vt {} {}", Shortest(*s), Shortest(*t))?,
            }
        }
        for [x, y, z] in data.normals {
            writeln!(out, "vn {} {} {}", Shortest(*x), Shortest(*y), Shortest(*z))?;
        }
        let normals = !data.normals.is_empty();
        for (f, corners) in data.faces.iter().enumerate() {
            let [a, b, c] = corners.map(|v| v + 1);
            let [l, m, n] = data.face_normals.get(f).map_or([a, b, c], |n| n.map(|n| n + 1));
            match data.face_texcoords.get(f).map(|t| t.map(|t| t + 1)) {
                Some([s, t, u]) if normals => writeln!(out, "f {a}/{s}/{l} {b}/{t}/{m} {c}/{u}/{n}")?,
                Some([s, t, u]) => writeln!(out, "f {a}/{s} {b}/{t} {c}/{u}")?,
                None if normals => writeln!(out, "f {a}//{l} {b}//{m} {c}//{n}")?,
                None => writeln!(out, "f {a} {b} {c}")?,
            }
        }
        Ok(())
    })
}
