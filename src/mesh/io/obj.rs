//! Reader of Wavefront OBJ. It keeps the file's vertex numbering, which the readers of other crates replace.

use super::budget::Budget;
use super::labels::{LabelLines, PER_LABEL};
use super::polygon::Polygons;
use super::scan::{BYTE_ORDER_MARK, Location, Quoted, bare, real, words};
use super::soup::{NO_NORMAL, NO_TEXCOORD, WHITE};
use super::{Attributes, Soup};
use crate::error::Result;
use crate::mesh::Point;
use crate::parallel;
use std::borrow::Cow;

/// Parses OBJ text: `v` (with colours after the coordinates, if there are any), `vt`, `vn` and `f` (polygons, negative indices, `v/vt/vn`
/// corners), `o`, `g`, `usemtl`, `s` and `mtllib`, line continuations; elements that are no faces are skipped and named in
/// [`Attributes::unread`]. A file that is not UTF-8 is read as Latin-1. `path` is used in errors.
///
/// Normals belong to the vertices if all corners of each vertex name equal ones, else to the corners. Missing or invalid values have the
/// defaults of [`Attributes`].
///
/// # Errors
///
/// [`crate::Error::Parse`] with the line.
pub fn parse_obj(bytes: &[u8], path: &str) -> Result<Soup> {
    read_whole(bytes, path)?.soup(Budget::of(bytes), Location::whole(path))
}

/// Parses OBJ text as [`parse_obj`], but leaves polygons whole: the positions of the vertices, and the corners of each face.
///
/// # Errors
///
/// [`crate::Error::Parse`] with the line.
pub fn parse_obj_polygons(bytes: &[u8], path: &str) -> Result<(Vec<Point>, Vec<Vec<u32>>)> {
    let ObjFile { positions, polygons, .. } = read_whole(bytes, path)?;
    let place = Location::whole(path);
    Budget::of(bytes).take(polygons.len(), size_of::<Vec<u32>>(), "faces", place)?;
    Ok((positions, polygons.all().map(<[u32]>::to_vec).collect()))
}

fn read_whole(bytes: &[u8], path: &str) -> Result<ObjFile> {
    if let Some(file) = in_parts(bytes, path) {
        return Ok(file);
    }
    let text = std::str::from_utf8(bytes);
    let latin = |_| Cow::Owned(bytes.iter().map(|&b| char::from(b)).collect());
    ObjFile::read(&text.map_or_else(latin, Cow::Borrowed), path)
}

/// Least bytes of a part of a file that is read on its own.
const PART: usize = 1 << 20;

/// A file read in parts that end with lines, in parallel inside a pool. `None` where its parts cannot be read independently: if corners
/// count back from the last vertex, a line continues after a backslash, or there is an error, which is then searched line by line.
fn in_parts(bytes: &[u8], path: &str) -> Option<ObjFile> {
    let mut ends = Vec::new();
    while bytes.len() - ends.last().unwrap_or(&0) > PART {
        let begin = ends.last().unwrap_or(&0) + PART;
        ends.push(begin + bytes[begin..].iter().position(|&b| b == b'\n')? + 1);
    }
    // The last part ends with the file, so that every part ends with a line.
    ends.pop();
    if ends.is_empty() || bytes.contains(&b'\\') {
        return None;
    }
    let starts: Vec<usize> = std::iter::once(0).chain(ends).chain([bytes.len()]).collect();
    let part = |k: usize| {
        let text = std::str::from_utf8(&bytes[starts[k]..starts[k + 1]]).ok()?;
        let is_marked = k > 0 && text.starts_with(BYTE_ORDER_MARK);
        ObjFile::read(text, path).ok().filter(|file| !(is_marked || file.counts_back))
    };
    let parts: Option<Vec<ObjFile>> = parallel::map(starts.len() - 1, part).into_iter().collect();
    Some(ObjFile::joined(parts?))
}

/// Elements that are no faces, and what they are.
const OTHERS: [(&str, &str); 5] = [
    ("l", "polylines"),
    ("p", "points"),
    ("curv", "curves"),
    ("curv2", "curves on surfaces"),
    ("surf", "free-form surfaces"),
];

/// The entry of a corner that names no texture coordinate or no normal.
const NO_ENTRY: u32 = u32::MAX;

/// The lines that have been read.
#[derive(Default)]
struct ObjFile {
    positions: Vec<Point>,
    /// Colours of the first vertices; the others are white.
    colors: Vec<[f64; 4]>,
    texcoords: Vec<[f64; 2]>,
    normals: Vec<Point>,
    polygons: Polygons,
    labels: LabelLines,
    /// The numbers of lines with the words of [`OTHERS`].
    others: [usize; 5],
    /// The entry that each of the first corners names, or `NO_ENTRY`, which also holds for all others.
    corner_texcoords: Vec<u32>,
    corner_normals: Vec<u32>,
    /// True if a corner may count back from the last entry.
    counts_back: bool,
}

impl ObjFile {
    fn read(text: &str, path: &str) -> Result<ObjFile> {
        let mut file = ObjFile::default();
        // A name may have the sign of a comment in it.
        let named = |line: &str| words(line).next().is_some_and(LabelLines::begins);
        let lines = super::scan::lines(text);
        let mut lines = lines.map(|(number, line)| (number, if named(line) { line } else { bare(line) }));
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
            file.line(place, line)?;
        }
        Ok(file)
    }

    fn line(&mut self, place: Location<'_>, line: &str) -> Result<()> {
        let mut tokens = words(line);
        match tokens.next() {
            Some("v") => {
                let mut point: Point = [0.0; 3];
                for (x, name) in point.iter_mut().zip(["x", "y", "z"]) {
                    *x = place.number(tokens.next(), format_args!("coordinate {name}"))?;
                }
                self.positions.push(point);
                if let Some(color) = color(tokens) {
                    self.colors.resize(self.positions.len() - 1, WHITE);
                    self.colors.push(color);
                }
            }
            Some("vt") => self.texcoords.push(numbers(tokens)),
            Some("vn") => self.normals.push(numbers(tokens)),
            Some("f") => {
                for token in tokens {
                    match plain(token) {
                        Some(v) => self.polygons.corners.push(v),
                        None => self.corner(place, token)?,
                    }
                }
                self.polygons.end();
            }
            Some(word) if LabelLines::begins(word) => {
                let rest = line.trim_start()[word.len()..].trim();
                self.labels.line(word, rest, self.polygons.len());
            }
            Some(word) => {
                if let Some(k) = OTHERS.iter().position(|(other, _)| *other == word) {
                    self.others[k] += 1;
                }
            }
            None => {}
        }
        Ok(())
    }

    /// Reads a corner that names more than a vertex, or counts back.
    fn corner(&mut self, place: Location<'_>, token: &str) -> Result<()> {
        let number = self.polygons.corners.len();
        self.polygons.corners.push(corner(place, token, self.positions.len())?);
        self.counts_back |= token.contains('-');
        let mut parts = token.split('/').skip(1);
        let texcoord = attribute(parts.next(), self.texcoords.len());
        let normal = attribute(parts.next(), self.normals.len());
        for (entries, entry) in [(&mut self.corner_texcoords, texcoord), (&mut self.corner_normals, normal)] {
            if entry != NO_ENTRY {
                entries.resize(number, NO_ENTRY);
                entries.push(entry);
            }
        }
        Ok(())
    }

    /// The contents of the parts of a file, one after the other.
    fn joined(parts: Vec<ObjFile>) -> ObjFile {
        let mut all = ObjFile::default();
        all.positions.reserve_exact(parts.iter().map(|part| part.positions.len()).sum());
        all.polygons.reserve(parts.iter().map(|part| &part.polygons));
        for part in parts {
            let (vertices, corners) = (all.positions.len(), all.polygons.corners.len());
            all.labels.append(part.labels, all.polygons.len());
            all.others.iter_mut().zip(part.others).for_each(|(n, more)| *n += more);
            all.positions.extend(part.positions);
            append(&mut all.colors, part.colors, vertices, WHITE);
            all.texcoords.extend(part.texcoords);
            all.normals.extend(part.normals);
            append(&mut all.corner_texcoords, part.corner_texcoords, corners, NO_ENTRY);
            append(&mut all.corner_normals, part.corner_normals, corners, NO_ENTRY);
            all.polygons.append(&part.polygons);
        }
        all
    }

    fn soup(mut self, mut budget: Budget, place: Location<'_>) -> Result<Soup> {
        budget.take(self.labels.count(), PER_LABEL, "names of faces", place)?;
        if self.corner_texcoords.is_empty()
            && self.corner_normals.is_empty()
            && let Some(faces) = self.polygons.all_triangles(&mut budget, place)?
        {
            let labels = std::mem::take(&mut self.labels).finish(0..faces.len());
            let attributes = Attributes {
                colors: self.all_colors(),
                labels,
                unread: self.unread(),
                ..Attributes::default()
            };
            return Ok(Soup { positions: self.positions, faces, attributes });
        }
        let triangles = self.polygons.triangles(&self.positions, &mut budget, place)?;
        fn of<const N: usize>(list: &[[f64; N]], entries: &[u32], corner: usize) -> Option<[f64; N]> {
            let entry = list.get(*entries.get(corner)? as usize).copied();
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
        let labels = std::mem::take(&mut self.labels).finish(self.polygons.owners(&triangles));
        let (colors, unread) = (self.all_colors(), self.unread());
        let attributes =
            Attributes { normals, corner_normals, colors, uv, labels, unread, ..Attributes::default() };
        Ok(Soup { positions: self.positions, faces, attributes })
    }

    /// The elements that are no faces, and how many there are.
    fn unread(&self) -> Vec<String> {
        let told = |((word, what), n): ((&str, &str), usize)| {
            (n > 0).then(|| format!("{what}: {n} (`{word}`), for they are no faces"))
        };
        OTHERS.into_iter().zip(self.others).filter_map(told).collect()
    }

    /// The colours of all vertices, if one has a colour.
    fn all_colors(&mut self) -> Option<Vec<[f64; 4]>> {
        let mut colors = std::mem::take(&mut self.colors);
        (!colors.is_empty()).then(|| {
            colors.resize(self.positions.len(), WHITE);
            colors
        })
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

/// Appends `more` after the first `n` entries of a list; entries that are missing before are filled in.
fn append<T: Clone>(list: &mut Vec<T>, more: Vec<T>, n: usize, missing: T) {
    if !more.is_empty() {
        list.resize(n, missing);
        list.extend(more);
    }
}

/// The colour after the three coordinates of a vertex: red, green, blue and perhaps opacity (a fourth coordinate alone is a weight).
/// `None` where there is none.
fn color<'a>(tokens: impl Iterator<Item = &'a str>) -> Option<[f64; 4]> {
    let x: Option<Vec<f64>> = tokens.map(|t| real(t).filter(|x| x.is_finite())).collect();
    match x?.as_slice() {
        [r, g, b] => Some([*r, *g, *b, 1.0]),
        [r, g, b, a, ..] => Some([*r, *g, *b, *a]),
        _ => None,
    }
}

/// The first N numbers; NaN for missing ones.
fn numbers<'a, const N: usize>(mut tokens: impl Iterator<Item = &'a str>) -> [f64; N] {
    std::array::from_fn(|_| tokens.next().and_then(real).unwrap_or(f64::NAN))
}

/// The entry (0-based) that the second or third number of a corner names among `count` so far; a wrong number names none.
fn attribute(number: Option<&str>, count: usize) -> u32 {
    let entry = |number: &str| match number.parse::<i64>().ok()? {
        0 => None,
        n if n < 0 => count.checked_sub(usize::try_from(n.unsigned_abs()).ok()?)?.try_into().ok(),
        n => u32::try_from(n - 1).ok(),
    };
    number.and_then(entry).unwrap_or(NO_ENTRY)
}

/// The vertex of a corner that is only a number of up to nine digits, as most are.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parallel::Pool;
    use std::fmt::Write;

    /// A strip of quads and triangles of a few parts, with colours, texture coordinates and normals that begin somewhere inside.
    fn large() -> String {
        let mut text = String::from("\u{feff}# a strip\n");
        for k in 0..60_000u32 {
            let x = 0.1 * f64::from(k);
            write!(text, "v {x} {} {:e}", f64::from(k % 2), -x).unwrap();
            text.push_str(if k % 5 == 4 { " 0.5 0.25 1\r\n" } else { "  # plain\n" });
            match k {
                2.. if k > 40_000 && k % 3 == 0 => {
                    writeln!(text, "vt {x} 1\nvn 0 0 {}", k % 7).unwrap();
                    let entry = (k - 40_000).div_ceil(3);
                    writeln!(text, "f {}/{entry} {}//{entry} {}/9/{entry}", k - 1, k, k + 1).unwrap();
                }
                3.. if k % 11 == 0 => writeln!(text, "f {} {} {} {}", k - 2, k - 1, k + 1, k).unwrap(),
                2.. => writeln!(text, "f {} {} {}", k - 1, k, k + 1).unwrap(),
                _ => {}
            }
        }
        text
    }

    #[test]
    fn parts_read_side_by_side_are_what_lines_read_in_order_are() {
        let text = large();
        assert!(text.len() > 3 * PART);
        let soup = |file: ObjFile| file.soup(Budget::of(text.as_bytes()), Location::whole("t")).unwrap();
        let expected = soup(ObjFile::read(&text, "t").unwrap());
        let Attributes { normals, colors, uv, .. } = &expected.attributes;
        assert!(normals.is_some() && colors.is_some() && uv.is_some());
        for threads in [1, 2, 8] {
            let found = Pool::new(threads).unwrap().run(|| in_parts(text.as_bytes(), "t")).unwrap();
            assert!(soup(found) == expected, "{threads} threads");
        }
    }

    #[test]
    fn what_parts_cannot_read_is_read_line_by_line() {
        let text = large();
        let lines = text.lines().count();
        let with = |end: &str| text.clone() + end;
        assert_eq!(
            parse_obj(with("f -1 -2 -3\n").as_bytes(), "t").unwrap().faces.last(),
            Some(&[59_999, 59_998, 59_997])
        );
        assert_eq!(parse_obj(with("f 1 2 \\\n3").as_bytes(), "t").unwrap().faces.last(), Some(&[0, 1, 2]));
        let error = parse_obj(with("v 1 2 x\n").as_bytes(), "t").unwrap_err().to_string();
        assert!(error.contains(&format!("{}", lines + 1)) && error.contains("`x`"), "{error}");
    }
}
