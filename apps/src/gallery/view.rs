//! A surface with its image, packed small enough to lie in the gallery's page, where it is turned.

use crate::failure::Failure;
use crate::picture;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use ricci::mesh::Point;
use ricci::mesh::io::{self, Soup};
use serde::Serialize;
use std::collections::HashMap;
use std::path::Path;

/// Most vertices of a view, those on a seam counted on each of its sides: it keeps a view below 1 MB, and numbers in 16 bits.
pub const MOST_VERTICES: usize = 20_000;

/// The second side of a view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Companion {
    /// Nothing.
    Alone,
    /// The texture coordinates of its file.
    Texture,
    /// Another file with the same vertices, in order.
    Image,
}

/// Coordinates as numbers of 16 bits: `from + step · k`, three to a vertex, little-endian, in base64.
#[derive(Serialize)]
struct PackedPoints {
    from: Point,
    step: f64,
    data: String,
}

/// The two sides of a view.
#[derive(Serialize)]
pub struct PageView {
    vertices: usize,
    faces: usize,
    /// Corners of faces, numbers of 16 bits, little-endian, in base64.
    corners: String,
    surface: PackedPoints,
    /// The image of each vertex; its third coordinate is 0 in a layout.
    image: Option<PackedPoints>,
    /// Whether the image lies in the plane.
    flat: bool,
    /// Directions of the surface's space that are up on the page, and whether it is first looked at from above.
    up: Point,
    lies: bool,
}

impl PageView {
    /// The view of a file, or why there is none; `other`: the file with the image, where it is shown beside one.
    ///
    /// # Errors
    /// [`Failure::Input`] for files that cannot be read, and for an image with other vertices.
    pub fn read(
        file: &Path,
        beside: Companion,
        other: &Path,
        up: Option<Point>,
    ) -> Result<Result<PageView, String>, Failure> {
        let soup = io::read(file)?;
        let (places, corners, image) = match beside {
            Companion::Alone => (soup.positions.clone(), soup.faces.clone(), None),
            Companion::Texture => {
                let (places, image, corners) = opened(&soup);
                (places, corners, Some(image))
            }
            Companion::Image => {
                let image = io::read(other)?.positions;
                if image.len() != soup.positions.len() {
                    return Err(Failure::Input(format!("{} has other vertices", other.display())));
                }
                (soup.positions.clone(), soup.faces.clone(), Some(image))
            }
        };
        let n = places.len();
        if n > MOST_VERTICES {
            let limit = "so the picture alone is shown";
            return Ok(Err(format!(
                "A view has {MOST_VERTICES} vertices at most, and this one {n}, {limit}."
            )));
        }
        let stance = picture::stance(&soup.positions, &soup.faces);
        Ok(Ok(PageView {
            vertices: n,
            faces: corners.len(),
            corners: base64(corners.as_flattened().iter().map(|&v| v as u16)),
            surface: PackedPoints::of(&places),
            image: image.as_deref().map(PackedPoints::of),
            flat: beside == Companion::Texture,
            up: up.unwrap_or(stance.up),
            lies: up.is_none() && stance.lies,
        }))
    }
}

/// Positions and texture coordinates of the different corners, and which ones each face has.
fn opened(soup: &Soup) -> (Vec<Point>, Vec<Point>, Vec<[u32; 3]>) {
    let (mut places, mut image, mut number) = (Vec::new(), Vec::new(), HashMap::new());
    let uv = soup.attributes.uv.as_deref().unwrap_or_default();
    let mut corner = |v: u32, [s, t]: [f64; 2]| {
        *number.entry((v, s.to_bits(), t.to_bits())).or_insert_with(|| {
            places.push(soup.positions[v as usize]);
            image.push([s, t, 0.0]);
            places.len() as u32 - 1
        })
    };
    let faces = soup.faces.iter().zip(uv).map(|(f, uv)| [0, 1, 2].map(|k| corner(f[k], uv[k]))).collect();
    (places, image, faces)
}

impl PackedPoints {
    /// The coordinates of points as 16-bit numbers; those that are not finite, which no written file has, would become 0.
    fn of(points: &[Point]) -> PackedPoints {
        let end = |k: usize, of: fn(f64, f64) -> f64, start| points.iter().map(|p| p[k]).fold(start, of);
        let from = [0, 1, 2].map(|k| end(k, f64::min, f64::INFINITY));
        let to = [0, 1, 2].map(|k| end(k, f64::max, f64::NEG_INFINITY));
        let longest = (0..3).map(|k| to[k] - from[k]).fold(f64::MIN_POSITIVE, f64::max);
        let step = longest / f64::from(u16::MAX);
        let number = |p: &Point| [0, 1, 2].map(|k| ((p[k] - from[k]) / step).round() as u16);
        PackedPoints { from, step, data: base64(points.iter().flat_map(number)) }
    }
}

fn base64(numbers: impl Iterator<Item = u16>) -> String {
    let bytes: Vec<u8> = numbers.flat_map(u16::to_le_bytes).collect();
    STANDARD.encode(bytes)
}

/// A picture as an address that holds it.
pub fn embedded(png: &[u8]) -> String {
    format!("data:image/png;base64,{}", STANDARD.encode(png))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers(text: &str) -> Vec<u16> {
        let bytes = STANDARD.decode(text).unwrap();
        bytes.chunks_exact(2).map(|b| u16::from_le_bytes([b[0], b[1]])).collect()
    }

    #[test]
    fn a_seam_has_two_sides_and_points_return_to_half_a_step() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("m.obj");
        let text = "v 0 0 0\nv 2 0 0\nv 0 3 0\nv 1 1 1\nvt 0 0\nvt 1 0\nvt 0 1\nvt 5 5\nvt 6 6\nvt 7 5\n\
                    f 1/1 2/2 3/3\nf 1/1 4/4 2/2\nf 3/6 2/5 4/4\n";
        std::fs::write(&path, text).unwrap();
        let view = PageView::read(&path, Companion::Texture, &path, None).unwrap().ok().unwrap();
        assert_eq!((view.vertices, view.faces), (6, 3));
        assert_eq!(numbers(&view.corners), [0, 1, 2, 0, 3, 1, 4, 5, 3]);
        let expected = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 3.0, 0.0], [1.0, 1.0, 1.0]];
        for (k, v) in [0, 1, 2, 3, 2, 1].into_iter().enumerate() {
            for (j, want) in expected[v].into_iter().enumerate() {
                let got = view.surface.from[j]
                    + view.surface.step * f64::from(numbers(&view.surface.data)[3 * k + j]);
                assert!((got - want).abs() <= 0.5 * view.surface.step + 1e-12, "{k} {j}: {got} for {want}");
            }
        }
    }
}
