//! Reader of STL, ascii and binary. It recognises a binary file that begins with `solid` by its bytes, notices wrong counts in headers,
//! and its errors give the line or the byte.

use super::Soup;
use super::budget::Budget;
use super::polygon::Polygons;
use super::scan::{Location, Quoted, Tokens, tokens};
use crate::error::Result;
use crate::mesh::Point;
use crate::mesh::incidence::drop_unused;
use crate::mesh::weld::{check_tolerance, coincident, place_key};
use std::collections::HashMap;

/// Bytes of text before the number of triangles in a binary file.
const HEADER: usize = 80;
/// Bytes of a triangle in a binary file: its normal and corners, twelve `f32`, and two bytes of attributes.
const TRIANGLE: usize = 50;

/// Parses an STL file. Corners with exactly the same position are one vertex, numbered in order of appearance; normals, which the corners
/// determine, are skipped. `path` is used in errors.
///
/// A file is binary if its size is that of the triangles it announces, or if it begins with bytes that no text has; the first word is not
/// used. A binary file may end with part of a triangle, or announce none at all, since some programs write the number last; any other
/// disagreement is an error that gives both numbers.
///
/// # Errors
///
/// [`crate::Error::Parse`] with the line or byte.
pub fn parse_stl(bytes: &[u8], path: &str) -> Result<Soup> {
    match announced(bytes) {
        Some(count) if announces_its_size(bytes) || !is_text(bytes) => binary(bytes, count, path),
        _ => ascii(&String::from_utf8_lossy(bytes), path),
    }
}

/// The number of triangles that the header of a binary file announces.
fn announced(bytes: &[u8]) -> Option<u32> {
    bytes.get(HEADER..HEADER + 4).and_then(|b| b.first_chunk()).map(|b| u32::from_le_bytes(*b))
}

/// True if a file has the size of the triangles that it announces as a binary one.
pub(super) fn announces_its_size(bytes: &[u8]) -> bool {
    let size = |n: u32| (HEADER + 4) as u64 + TRIANGLE as u64 * u64::from(n);
    announced(bytes).is_some_and(|n| bytes.len() as u64 == size(n))
}

/// True if the beginning has no control characters except those of text. A binary file has others in the filling of its first 80 bytes,
/// in the number of triangles or in the first coordinates.
pub(super) fn is_text(bytes: &[u8]) -> bool {
    const BEGINNING: usize = 1024;
    let of_text = |b: &u8| *b >= b' ' || b.is_ascii_whitespace() || matches!(*b, 0x0b | 0x1a);
    bytes.iter().take(BEGINNING).all(of_text)
}

/// [`parse_stl`], but corners within the distance `weld` of each other, also by a chain of such corners, are one vertex at the position
/// of the first. Faces keep their numbers; those that collapse use a vertex twice, which the diagnosis finds and [`crate::mesh::repair`]
/// drops.
///
/// # Errors
///
/// [`crate::Error::Argument`] for a distance that is negative or not finite; [`crate::Error::Parse`].
pub fn parse_stl_welded(bytes: &[u8], path: &str, weld: f64) -> Result<Soup> {
    check_tolerance(weld)?;
    let Soup { positions, mut faces, attributes } = parse_stl(bytes, path)?;
    let first = coincident(&positions, weld);
    faces.as_flattened_mut().iter_mut().for_each(|v| *v = first[*v as usize]);
    let kept = drop_unused(positions.len(), &mut faces);
    let positions = kept.into_iter().map(|v| positions[v as usize]).collect();
    Ok(Soup { positions, faces, attributes })
}

/// The vertices, one for all corners with the same position.
#[derive(Default)]
struct CornerWeld {
    soup: Soup,
    known: HashMap<[u64; 3], u32>,
}

impl CornerWeld {
    fn vertex(&mut self, point: Point) -> u32 {
        // Coordinates that are NaN make a vertex, which the diagnosis names.
        *self.known.entry(place_key(point)).or_insert_with(|| {
            self.soup.positions.push(point);
            self.soup.positions.len() as u32 - 1
        })
    }
}

fn binary(bytes: &[u8], count: u32, path: &str) -> Result<Soup> {
    let body = &bytes[HEADER + 4..];
    let (whole, more) = (body.len() / TRIANGLE, body.len() % TRIANGLE);
    let count = if count == 0 && more == 0 { whole } else { count as usize };
    if count > whole {
        return Location::byte(path, bytes.len()).error(format!(
            "the file ends in triangle {whole} of the {count} that its header promises; export it again"
        ));
    }
    if count < whole {
        return Location::byte(path, HEADER).error(format!(
            "the header promises {count} triangles, behind it are {whole} and {more} bytes; export it again"
        ));
    }
    let mut weld = CornerWeld::default();
    for triangle in body.chunks_exact(TRIANGLE) {
        let number = |k: usize| {
            let at = 12 + 4 * k; // behind the normal
            triangle[at..at + 4].first_chunk().map_or(f64::NAN, |b| f64::from(f32::from_le_bytes(*b)))
        };
        let corners = [0, 3, 6].map(|k| weld.vertex([number(k), number(k + 1), number(k + 2)]));
        weld.soup.faces.push(corners);
    }
    Ok(weld.soup)
}

/// The next three words as a point.
fn point<'a>(words: &mut Tokens<'a, impl Iterator<Item = (usize, &'a str)>>) -> Result<Point> {
    let mut point: Point = [0.0; 3];
    for (x, name) in point.iter_mut().zip(["x", "y", "z"]) {
        let token = words.next();
        *x = words.place().number(token, format_args!("coordinate {name}"))?;
    }
    Ok(point)
}

/// A word in small letters, empty if it is longer than any that has a meaning. Where an end may come, the word after `end` belongs to
/// it: some programs write `end solid`, `end facet` and `end loop`.
fn keyword<'a>(
    word: &str,
    is_end: bool,
    words: &mut Tokens<'a, impl Iterator<Item = (usize, &'a str)>>,
) -> String {
    let mut lower = if word.len() <= 8 { word.to_ascii_lowercase() } else { String::new() };
    if is_end && lower == "end" {
        lower.extend(words.next().map(str::to_ascii_lowercase));
    }
    lower
}

/// The words that may come next in a text file.
enum NextWord {
    /// The beginning or end of a solid, a facet or a loop.
    Part,
    /// Anything up to a facet or the end of this line, for the name of a solid; after `endsolid` no facet may follow in it.
    Name { line: usize, last: bool },
    /// Anything up to a loop, for the normal, which programs write in various ways.
    Normal,
    /// `loop`, after `outer`.
    Loop,
    /// A corner, or the end of the loop of these corners.
    Corner(Vec<u32>),
}

/// Reads the text word by word. Line ends have no meaning, except that one ends the name of a solid.
fn ascii(text: &str, path: &str) -> Result<Soup> {
    let mut words = tokens(text, path);
    let (mut weld, mut polygons) = (CornerWeld::default(), Polygons::default());
    let (mut expect, mut begun, mut ended, mut solids) = (NextWord::Part, false, false, 0);
    while let Some(word) = words.next() {
        let (place, line) = (words.place(), words.line);
        if let NextWord::Name { line: named, .. } = expect
            && named != line
        {
            expect = NextWord::Part;
        }
        let is_end = matches!(expect, NextWord::Part | NextWord::Corner(_));
        let lower = keyword(word, is_end, &mut words);
        solids += usize::from(lower == "solid" && matches!(expect, NextWord::Part | NextWord::Name { .. }));
        expect = match (lower.as_str(), expect) {
            ("solid", NextWord::Part | NextWord::Name { .. }) => NextWord::Name { line, last: false },
            ("endsolid", NextWord::Part | NextWord::Name { last: false, .. }) => {
                ended = true;
                NextWord::Name { line, last: true }
            }
            ("facet", NextWord::Part | NextWord::Name { last: false, .. }) => NextWord::Normal,
            ("endfacet", NextWord::Part) => NextWord::Part,
            ("outer", NextWord::Part | NextWord::Normal) => NextWord::Loop,
            ("loop", NextWord::Loop) => NextWord::Corner(Vec::new()),
            ("vertex", NextWord::Corner(mut corners)) => {
                corners.push(weld.vertex(point(&mut words)?));
                NextWord::Corner(corners)
            }
            ("endloop", NextWord::Corner(corners)) if corners.len() >= 3 => {
                polygons.push(corners);
                NextWord::Part
            }
            ("endloop", NextWord::Corner(corners)) => {
                return place.error(format!("a loop of {} corners; a face has three", corners.len()));
            }
            (_, name @ NextWord::Name { .. }) => name,
            (_, NextWord::Normal) => NextWord::Normal,
            _ if !begun => return place.error(NO_STL.into()),
            _ => return place.error(format!("{} has no place here in an STL file", Quoted(word))),
        };
        begun = true;
    }
    let place = words.place();
    match expect {
        NextWord::Corner(_) | NextWord::Loop => {
            return place.error("the file ends inside a loop".into());
        }
        NextWord::Normal => return place.error("the file ends inside a facet".into()),
        _ if !begun => return Location::whole(path).error(NO_STL.into()),
        _ if polygons.is_empty() && !ended => {
            return place.error("the file has neither a facet nor the word `endsolid`".into());
        }
        _ => {}
    }
    let mut budget = Budget::of(text.as_bytes());
    let triangles = polygons.triangles(&weld.soup.positions, &mut budget, Location::whole(path))?;
    weld.soup.faces = polygons.faces(&triangles);
    weld.soup.attributes.unread.extend((solids > 1).then(|| format!("names of {solids} solids")));
    Ok(weld.soup)
}

const NO_STL: &str = "this is no STL file: it neither begins with `solid` or `facet` nor has the 84 bytes before the triangles of a binary one";
