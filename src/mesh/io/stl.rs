//! STL, ascii and binary. Our own reader: what says `solid` may be binary, counts in headers may be wrong, and errors name
//! the line or the byte.

use super::budget::Budget;
use super::polygon::Polygons;
use super::scan::{Place, lines};
use super::{Point, Soup};
use crate::error::Result;
use crate::mesh::weld::{check_tolerance, coincident};
use std::collections::HashMap;

/// Bytes of text before the number of triangles in a binary file, and of each triangle.
const HEADER: usize = 80;
const TRIANGLE: usize = 50;

/// Parse an STL file. Corners in exactly the same place are one vertex, numbered in order of appearance; normals, which the
/// corners determine, are skipped. `path` is used in errors.
pub fn parse_stl(bytes: &[u8], path: &str) -> Result<Soup> {
    let count = bytes.get(HEADER..HEADER + 4).and_then(|b| b.first_chunk()).map(|b| u32::from_le_bytes(*b));
    let exact =
        count.is_some_and(|n| bytes.len() as u64 == (HEADER + 4) as u64 + TRIANGLE as u64 * u64::from(n));
    let text = bytes.trim_ascii_start().get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    match count {
        Some(count) if exact || !text => binary(bytes, count, path),
        _ if text => ascii(&String::from_utf8_lossy(bytes), path),
        _ => Place { path, line: 1 }.error(format!(
            "this is no STL file: it neither begins with `solid` nor has the {} bytes of a binary header",
            HEADER + 4
        )),
    }
}

/// [`parse_stl`], where corners within the distance `weld` of each other, also by a chain of such corners, are one vertex: that
/// of the first of them. Faces keep their number; those that collapse use a vertex twice, which the diagnosis finds and
/// [`crate::mesh::repair`] drops.
///
/// Errors: [`crate::Error::Argument`] for a distance that is negative or not finite; [`crate::Error::Parse`].
pub fn parse_stl_welded(bytes: &[u8], path: &str, weld: f64) -> Result<Soup> {
    check_tolerance(weld)?;
    let mut soup = parse_stl(bytes, path)?;
    let first = coincident(&soup.positions, weld);
    let mut number = vec![0; first.len()];
    let mut positions = Vec::new();
    for (v, &to) in first.iter().enumerate() {
        if v as u32 == to {
            number[v] = positions.len() as u32;
            positions.push(soup.positions[v]);
        }
    }
    soup.faces.as_flattened_mut().iter_mut().for_each(|v| *v = number[first[*v as usize] as usize]);
    soup.positions = positions;
    Ok(soup)
}

/// Corners that are in the same place become one vertex.
#[derive(Default)]
struct Weld {
    soup: Soup,
    known: HashMap<[u64; 3], u32>,
}

impl Weld {
    fn vertex(&mut self, point: Point) -> u32 {
        // −0 is 0; every NaN is a vertex of its own kind, which the diagnosis finds.
        let place = point.map(|x| if x == 0.0 { 0 } else { x.to_bits() });
        *self.known.entry(place).or_insert_with(|| {
            self.soup.positions.push(point);
            self.soup.positions.len() as u32 - 1
        })
    }
}

fn binary(bytes: &[u8], count: u32, path: &str) -> Result<Soup> {
    let body = &bytes[HEADER + 4..];
    let whole = body.len() / TRIANGLE;
    if (count as usize) > whole {
        return Place { path, line: 0 }.error(format!(
            "the file ends at byte {} in triangle {whole} of the {count} that its header promises",
            bytes.len()
        ));
    }
    let mut weld = Weld::default();
    for triangle in body.chunks_exact(TRIANGLE).take(count as usize) {
        let number = |k: usize| {
            let at = 12 + 4 * k; // behind the normal
            triangle[at..at + 4].first_chunk().map_or(f64::NAN, |b| f64::from(f32::from_le_bytes(*b)))
        };
        let corners = [0, 3, 6].map(|k| weld.vertex([number(k), number(k + 1), number(k + 2)]));
        weld.soup.faces.push(corners);
    }
    Ok(weld.soup)
}

fn ascii(text: &str, path: &str) -> Result<Soup> {
    let (mut weld, mut polygons) = (Weld::default(), Polygons::default());
    let mut corners: Option<Vec<u32>> = None;
    let mut last = 1;
    for (line, content) in lines(text) {
        let place = Place { path, line };
        let mut words = content.split_ascii_whitespace();
        let Some(word) = words.next() else { continue };
        last = line;
        match (word.to_ascii_lowercase().as_str(), &mut corners) {
            ("outer", None) => corners = Some(Vec::new()),
            ("vertex", Some(corners)) => {
                let mut point: Point = [0.0; 3];
                for (x, name) in point.iter_mut().zip(["x", "y", "z"]) {
                    *x = place.number(words.next(), format_args!("coordinate {name}"))?;
                }
                corners.push(weld.vertex(point));
            }
            ("endloop", Some(list)) => {
                if list.len() < 3 {
                    return place.error(format!("a loop of {} corners; a face has three", list.len()));
                }
                polygons.push(std::mem::take(list));
                corners = None;
            }
            ("solid" | "endsolid" | "facet" | "endfacet", None) => {}
            _ => return place.error(format!("`{word}` has no place here in an STL file")),
        }
    }
    if corners.is_some() {
        return Place { path, line: last }.error("the file ends inside a loop".into());
    }
    let (mut budget, place) = (Budget::of(text.as_bytes()), Place { path, line: last });
    let triangles = polygons.triangles(&weld.soup.positions, &mut budget, place)?;
    weld.soup.faces = triangles.iter().map(|&t| polygons.face(t)).collect();
    Ok(weld.soup)
}
