//! Reader of binary OFF, in Geomview's layout and in those that other programs write with the same header.

use super::budget::Budget;
use super::off_extras::{Columns, Extras};
use super::polygon::Polygons;
use super::scan::Location;
use super::soup::{Soup, in_range};
use crate::error::Result;
use crate::mesh::Point;

/// The layout of the data after `OFF BINARY`. The file does not say which it is.
#[derive(Clone, Copy, PartialEq)]
struct Dialect {
    big_endian: bool,
    /// Each face ends with the number of its colour components (which may be 0) and these components.
    face_colors: bool,
    /// The number of components of a vertex's colour.
    color: usize,
}

/// The layout that Geomview's manual defines.
const GEOMVIEW: Dialect = Dialect { big_endian: true, face_colors: true, color: 4 };
/// The layout of programs that copy their memory to the file.
const COPIED: Dialect = Dialect { big_endian: false, face_colors: false, color: 4 };

/// Parses the data that begin at `start`: three `i32` counts, `columns` `f32` per vertex of which the first three are the position, and
/// per face the `i32` number of its corners and their 0-based vertices. The dialect is the one in which the file ends at the end of its
/// last face; colours may also be integers up to 255.
pub(super) fn parse_off_binary(
    bytes: &[u8],
    start: usize,
    has: Columns,
    place: Location<'_>,
) -> Result<Soup> {
    let read = |dialect| Words { bytes, at: start, dialect, place }.soup(has);
    let first = read(GEOMVIEW);
    if first.is_ok() {
        return first;
    }
    let second = read(COPIED);
    if second.is_ok() {
        return second;
    }
    // OpenMesh writes either byte order, and colours of three components. A truncated file may end at the end of a face in one of these
    // dialects, but its corners then name vertices that do not exist.
    let opaque = Dialect { color: 3, ..COPIED };
    let others = [Dialect { big_endian: true, ..COPIED }, opaque, Dialect { big_endian: true, ..opaque }];
    let known = others.into_iter().filter(|dialect| has.color || dialect.color == 4);
    let sound = |soup: &Soup| in_range("vertex", &soup.faces, soup.positions.len()).is_ok();
    if let Some(soup) = known.filter_map(|dialect| read(dialect).ok()).find(sound) {
        return Ok(soup);
    }
    // The error is that of the more likely byte order: a number of vertices below 2¹⁶ is above 2¹⁶ in the other order.
    let count = bytes[start..].first_chunk::<4>().copied().unwrap_or([0; 4]);
    if u32::from_le_bytes(count) < u32::from_be_bytes(count) { second } else { first }
}

/// The file as words of four bytes, from byte `at` on.
struct Words<'a> {
    bytes: &'a [u8],
    at: usize,
    dialect: Dialect,
    place: Location<'a>,
}

impl Words<'_> {
    fn soup(mut self, has: Columns) -> Result<Soup> {
        let Dialect { color, face_colors, .. } = self.dialect;
        let before = 3 + 3 * usize::from(has.normal);
        let after = before + color * usize::from(has.color);
        let columns = after + 2 * usize::from(has.texture);
        let n_vertices = self.count(|| "the number of vertices".into())?;
        let n_faces = self.count(|| "the number of faces".into())?;
        self.word(|| "the number of edges".into())?;
        let (mut positions, mut extras, mut polygons) = (Vec::new(), Extras::new(has), Polygons::default());
        for v in 0..n_vertices {
            let mut numbers = [0.0; 12];
            for (k, x) in numbers[..columns].iter_mut().enumerate() {
                let word = self.word(|| format!("vertex {v} (of {n_vertices})"))?;
                // As an `f32` such an integer would be below 1e-42.
                let integer = (before..after).contains(&k) && word <= 255;
                *x = if integer { f64::from(word) } else { f64::from(f32::from_bits(word)) };
            }
            let position: Point = [numbers[0], numbers[1], numbers[2]];
            positions.push(position);
            extras.push(&numbers[3..columns]);
        }
        let mut corners = Vec::new();
        for f in 0..n_faces {
            let size = self.count(|| format!("the size of face {f} (of {n_faces})"))?;
            corners.clear();
            for k in 0..size {
                corners.push(self.count(|| format!("corner {k} of face {f} (of {n_faces})"))?);
            }
            if face_colors {
                let what = || format!("the colour of face {f} (of {n_faces})");
                for _ in 0..self.count(what)? {
                    self.word(what)?;
                    extras.face_colors = true;
                }
            }
            // Points and segments are legal in OFF but not part of the surface.
            polygons.push(corners.iter().copied());
        }
        let left = self.bytes[self.at..].trim_ascii().len();
        if left > 0 {
            let end = self.at;
            return self.at(end).error(format!(
                "the {n_vertices} vertices and {n_faces} faces that the header promises end here, {left} bytes before the file does"
            ));
        }
        extras.soup(positions, &polygons, Budget::of(self.bytes), Location::whole(self.place.path))
    }

    fn at(&self, byte: usize) -> Location<'_> {
        Location::byte(self.place.path, byte)
    }

    fn word(&mut self, what: impl Fn() -> String) -> Result<u32> {
        let word = self.bytes[self.at..].first_chunk::<4>();
        let Some(&word) = word else {
            let what = what();
            return self.at(self.bytes.len()).error(format!("the file ends in {what}; export it again"));
        };
        self.at += 4;
        Ok(if self.dialect.big_endian { u32::from_be_bytes(word) } else { u32::from_le_bytes(word) })
    }

    /// Reads a word that is not negative as a signed number.
    fn count(&mut self, what: impl Fn() -> String) -> Result<u32> {
        let word = self.word(&what)?;
        if word > i32::MAX as u32 {
            let what = what();
            let message = format!("{what} is {}: it cannot be negative", word as i32);
            return self.at(self.at - 4).error(message);
        }
        Ok(word)
    }
}
