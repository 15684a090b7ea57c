//! Reader and writer of MZ3, the surfaces of Surf Ice. The format is that of <https://github.com/neurolabusc/surf-ice/tree/master/mz3>:
//! little-endian, a head of 16 bytes, then triangles, vertices, colours and values.

use super::budget::Budget;
use super::kind::NumberType;
use super::scan::Location;
use super::{Attributes, Format, NumberColumn, Soup, write_atomically};
use crate::error::{Error, Result};
use crate::mesh::Point;
use std::io::Write;
use std::path::Path;

/// The first two bytes.
const MARK: &[u8] = b"MZ";
/// Bytes of the head.
const HEAD: usize = 16;
/// The parts that a file has.
const FACES: u16 = 1;
const VERTICES: u16 = 2;
const COLORS: u16 = 4;
const SINGLES: u16 = 8;
const DOUBLES: u16 = 16;
/// Bytes of a vertex or a triangle.
const TRIPLE: usize = 12;

/// True if a file begins as MZ3 does: programs of Windows have the same mark.
pub(super) fn begins(bytes: &[u8]) -> bool {
    bytes.starts_with(MARK) && bytes.len() >= HEAD && bytes[2] < 2 * DOUBLES as u8 && bytes[3] == 0
}

/// Parses an MZ3 file with triangles and vertices; values of vertices become numbers called `scalar`, `scalar_2` and so on. `path` is used in
/// errors.
///
/// # Errors
/// [`Error::Parse`] with the byte.
pub fn parse_mz3(bytes: &[u8], path: &str) -> Result<Soup> {
    let place = Location::whole(path);
    let Some(head) = bytes.first_chunk::<HEAD>().filter(|head| head.starts_with(MARK)) else {
        return place.error("this is no MZ3 file: its mark or its head is missing".into());
    };
    let word = |at: usize| u32::from_le_bytes([head[at], head[at + 1], head[at + 2], head[at + 3]]) as usize;
    let parts = u16::from_le_bytes([head[2], head[3]]);
    let [n_faces, n_vertices, skipped] = [word(4), word(8), word(12)];
    if parts & (FACES | VERTICES) != FACES | VERTICES {
        return place.error(
            "the file has no triangles or no vertices: it is data on a surface, not a surface".into(),
        );
    }
    if parts >= 2 * DOUBLES {
        return place.error(format!("the file has parts of unknown kinds (attributes {parts})"));
    }
    let mut rest = Mz3Bytes { bytes, at: HEAD, path };
    rest.take(1, skipped, "bytes of text")?;
    let mut budget = Budget::of(bytes);
    budget.take(n_faces, TRIPLE, "triangles", place)?;
    budget.take(n_vertices, size_of::<Point>(), "vertices", place)?;
    let faces = rest.take(n_faces, TRIPLE, "triangles")?.as_chunks::<TRIPLE>().0;
    let faces: Vec<[u32; 3]> = faces
        .iter()
        .map(|row| [0, 1, 2].map(|k| NumberType::U32.read(&row[4 * k..], false) as u32))
        .collect();
    let points = rest.take(n_vertices, TRIPLE, "vertices")?.as_chunks::<TRIPLE>().0;
    let positions: Vec<Point> =
        points.iter().map(|row| [0, 1, 2].map(|k| NumberType::F32.read(&row[4 * k..], false))).collect();
    let mut attributes = Attributes::default();
    if parts & COLORS != 0 {
        budget.take(n_vertices, size_of::<[f64; 4]>(), "colours", place)?;
        let rows = rest.take(n_vertices, 4, "colours")?.as_chunks::<4>().0;
        attributes.colors = Some(rows.iter().map(|row| row.map(|x| f64::from(x) / 255.0)).collect());
    }
    for (part, kind) in [(SINGLES, NumberType::F32), (DOUBLES, NumberType::F64)] {
        let size = n_vertices * kind.size();
        while parts & part != 0 && size > 0 && bytes.len() - rest.at >= size {
            budget.take(n_vertices, size_of::<f64>(), "values", place)?;
            let data = rest.take(n_vertices, kind.size(), "values")?;
            let values = data.chunks_exact(kind.size()).map(|word| kind.read(word, false)).collect();
            let name = match attributes.vertex_numbers.len() {
                0 => "scalar".to_string(),
                k => format!("scalar_{}", k + 1),
            };
            attributes.vertex_numbers.push(NumberColumn { name, kind, values });
        }
    }
    if rest.at < bytes.len() {
        attributes.unread.push(format!("{} bytes behind the last part", bytes.len() - rest.at));
    }
    Ok(Soup { positions, faces, attributes })
}

/// A file from byte `at` on.
struct Mz3Bytes<'a> {
    bytes: &'a [u8],
    at: usize,
    path: &'a str,
}

impl<'a> Mz3Bytes<'a> {
    /// The bytes of so many entries of a size.
    fn take(&mut self, count: usize, size: usize, what: &str) -> Result<&'a [u8]> {
        let end = count.checked_mul(size).and_then(|bytes| self.at.checked_add(bytes));
        let Some(found) = end.and_then(|end| self.bytes.get(self.at..end)) else {
            let left = self.bytes.len() - self.at;
            return Location::byte(self.path, self.at)
                .error(format!("{left} bytes follow, too few for {count} {what}"));
        };
        self.at += found.len();
        Ok(found)
    }
}

/// Writes an MZ3 file, atomically and not packed: positions in single precision, colours (8 bits), and numbers of vertices, whose names the
/// format has no room for. Returns what was left out.
///
/// # Errors
/// With the file untouched: [`Error::Argument`] for numbers that are not finite or not in the range of single precision and corners out of range,
/// [`Error::Size`] for attributes of another size, [`Error::TooLarge`], [`Error::Io`].
pub fn write_mz3(path: &Path, soup: &Soup) -> Result<Vec<String>> {
    soup.check_writable()?;
    let Soup { positions, faces, attributes } = soup;
    for (what, count) in [("faces", faces.len()), ("vertices", positions.len())] {
        u32::try_from(count).map_err(|_| Error::TooLarge { what, count })?;
    }
    if let Some(x) = positions.as_flattened().iter().find(|x| !(**x as f32).is_finite()) {
        return Err(Error::argument("coordinate", x, "a number in the range of single precision"));
    }
    let columns = &attributes.vertex_numbers;
    let mut parts = FACES | VERTICES;
    parts |= if attributes.colors.is_some() { COLORS } else { 0 };
    parts |= if columns.is_empty() { 0 } else { DOUBLES };
    write_atomically(path, |out| {
        out.write_all(MARK)?;
        out.write_all(&parts.to_le_bytes())?;
        for count in [faces.len() as u32, positions.len() as u32, 0] {
            out.write_all(&count.to_le_bytes())?;
        }
        faces.as_flattened().iter().try_for_each(|v| out.write_all(&v.to_le_bytes()))?;
        positions.as_flattened().iter().try_for_each(|x| out.write_all(&(*x as f32).to_le_bytes()))?;
        for x in attributes.colors.iter().flatten().flatten() {
            out.write_all(&[(255.0 * x.clamp(0.0, 1.0)).round() as u8])?;
        }
        columns.iter().flat_map(|column| &column.values).try_for_each(|x| out.write_all(&x.to_le_bytes()))
    })?;
    let names: Vec<String> =
        columns.iter().map(|column| format!("the name `{}` of numbers of vertices", column.name)).collect();
    let bare = Attributes { colors: None, vertex_numbers: Vec::new(), ..attributes.clone() };
    Ok([names, bare.all_left_out(Format::Mz3)].concat())
}
