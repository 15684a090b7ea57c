//! Binary OFF: what Geomview reads and writes, and what other programs write under the same header.

use super::budget::Budget;
use super::off::{Columns, Extras};
use super::polygon::Polygons;
use super::scan::Place;
use super::{Point, Soup};
use crate::error::Result;

/// How the data behind `OFF BINARY` are laid out. The file does not say which it is.
#[derive(Clone, Copy, PartialEq)]
enum Dialect {
    /// The format's definition: big-endian, and each face ends with the number of its colour components
    /// (which may be 0) and these components.
    Geomview,
    /// Of programs that copy their memory: little-endian, no colours of faces.
    Copied,
}

/// Parse the data that begin at `start`: three `i32` counts, `columns` `f32` per vertex of which the first
/// three are the position, and per face the `i32` number of its corners and these, 0-based. The dialect is
/// the one in which the file ends where its last face does.
pub(super) fn parse_off_binary(bytes: &[u8], start: usize, has: Columns, place: Place<'_>) -> Result<Soup> {
    let read = |dialect| Words { bytes, at: start, dialect, place }.soup(has);
    let geomview = read(Dialect::Geomview);
    if geomview.is_ok() {
        return geomview;
    }
    let copied = read(Dialect::Copied);
    // Of two errors that of the likelier byte order: a number of vertices below 2¹⁶ is above it when misread.
    let count = bytes[start..].first_chunk::<4>().copied().unwrap_or([0; 4]);
    if copied.is_ok() || u32::from_le_bytes(count) < u32::from_be_bytes(count) { copied } else { geomview }
}

/// The file as words of four bytes, from byte `at`.
struct Words<'a> {
    bytes: &'a [u8],
    at: usize,
    dialect: Dialect,
    place: Place<'a>,
}

impl Words<'_> {
    fn soup(mut self, has: Columns) -> Result<Soup> {
        let columns =
            3 + 3 * usize::from(has.normal) + 4 * usize::from(has.color) + 2 * usize::from(has.texture);
        let n_vertices = self.count(|| "the number of vertices".into())?;
        let n_faces = self.count(|| "the number of faces".into())?;
        self.word(|| "the number of edges".into())?;
        let (mut positions, mut extras, mut polygons) = (Vec::new(), Extras::new(has), Polygons::default());
        for v in 0..n_vertices {
            let mut numbers = [0.0; 12];
            for x in &mut numbers[..columns] {
                *x = f64::from(f32::from_bits(self.word(|| format!("vertex {v} (of {n_vertices})"))?));
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
            if self.dialect == Dialect::Geomview {
                let what = || format!("the colour of face {f} (of {n_faces})");
                for _ in 0..self.count(what)? {
                    self.word(what)?;
                }
            }
            // Points and segments are legal in OFF and no part of the surface.
            polygons.push(corners.iter().copied());
        }
        let left = self.bytes[self.at..].trim_ascii().len();
        if left > 0 {
            let end = self.at;
            return self.place.error(format!(
                "the {n_vertices} vertices and {n_faces} faces that the header promises end at byte {end}, {left} bytes before the file does"
            ));
        }
        extras.soup(positions, &polygons, Budget::of(self.bytes), self.place)
    }

    fn word(&mut self, what: impl Fn() -> String) -> Result<u32> {
        let word = self.bytes[self.at..].first_chunk::<4>();
        let Some(&word) = word else {
            let (what, end) = (what(), self.bytes.len());
            return self.place.error(format!("the file ends at byte {end}, in {what}; export it again"));
        };
        self.at += 4;
        Ok(match self.dialect {
            Dialect::Geomview => u32::from_be_bytes(word),
            Dialect::Copied => u32::from_le_bytes(word),
        })
    }

    /// A word that is not negative as a signed number.
    fn count(&mut self, what: impl Fn() -> String) -> Result<u32> {
        let word = self.word(&what)?;
        if word > i32::MAX as u32 {
            let (what, at) = (what(), self.at - 4);
            return self
                .place
                .error(format!("{what} is {} at byte {at}: it cannot be negative", word as i32));
        }
        Ok(word)
    }
}
