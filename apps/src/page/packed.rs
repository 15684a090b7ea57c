//! The data of a view, packed small enough to lie in a page: coordinates and quantities as numbers of 16 bits.

use super::sides::ViewSides;
use crate::picture;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use ricci::mesh::Point;
use serde::Serialize;

/// The shares of a quantity's values that lie below and above the range of its colours.
const ENDS: [f64; 2] = [0.01, 0.99];

/// Numbers of the vertices of a file, of which those that are not finite are shown in grey.
#[derive(Clone, Debug)]
pub struct VertexQuantity {
    pub name: String,
    pub values: Vec<f64>,
}

/// Coordinates as numbers of 16 bits: `from + step · k`, three to a vertex, little-endian, in base64.
#[derive(Serialize)]
struct PackedPoints {
    from: Point,
    step: f64,
    data: String,
}

/// A quantity as a number of 16 bits for each vertex: from 0 for `low` and below to 65534 for `high` and above, 65535 for no number.
#[derive(Serialize)]
struct PackedQuantity {
    name: String,
    low: f64,
    high: f64,
    data: String,
}

/// The two sides of a view, as the scripts of the page read them.
#[derive(Serialize)]
pub struct PageView {
    vertices: usize,
    faces: usize,
    /// Whether the corners are numbers of 32 bits.
    wide: bool,
    /// Corners of faces, little-endian, in base64.
    corners: String,
    surface: PackedPoints,
    image: Option<PackedPoints>,
    /// Whether the image lies in the plane.
    flat: bool,
    /// Whether lines show where the surface is cut open.
    cut: bool,
    /// The direction of the surface's space that is up on the page, and whether it is first looked at from above.
    up: Point,
    lies: bool,
    quantities: Vec<PackedQuantity>,
}

impl PageView {
    /// The view of a surface; `up`: the direction that is up, else it is chosen by the shape.
    pub fn new(sides: &ViewSides, up: Option<Point>, quantities: &[VertexQuantity]) -> PageView {
        let ViewSides { places, corners, image, flat, origins, .. } = sides;
        let wide = places.len() > usize::from(u16::MAX);
        let numbers = corners.as_flattened().iter();
        let stance = picture::stance(places, corners);
        PageView {
            vertices: places.len(),
            faces: corners.len(),
            wide,
            corners: if wide {
                base64(numbers.flat_map(|v| v.to_le_bytes()))
            } else {
                base64(numbers.flat_map(|&v| (v as u16).to_le_bytes()))
            },
            surface: PackedPoints::of(places),
            image: image.as_deref().map(PackedPoints::of),
            flat: *flat,
            cut: *flat,
            up: up.unwrap_or(stance.up),
            lies: up.is_none() && stance.lies,
            quantities: quantities.iter().map(|given| PackedQuantity::of(given, origins)).collect(),
        }
    }

    /// The number of vertices, those on a seam counted on each of its sides.
    pub fn vertices(&self) -> usize {
        self.vertices
    }

    /// The number of faces.
    pub fn faces(&self) -> usize {
        self.faces
    }
}

impl PackedPoints {
    /// The coordinates of points as 16-bit numbers; those that are not finite, which no view has, would become 0.
    fn of(points: &[Point]) -> PackedPoints {
        let end = |k: usize, of: fn(f64, f64) -> f64, start| points.iter().map(|p| p[k]).fold(start, of);
        let from = [0, 1, 2].map(|k| end(k, f64::min, f64::INFINITY));
        let to = [0, 1, 2].map(|k| end(k, f64::max, f64::NEG_INFINITY));
        let longest = (0..3).map(|k| to[k] - from[k]).fold(f64::MIN_POSITIVE, f64::max);
        let step = longest / f64::from(u16::MAX);
        let number = |p: &Point| [0, 1, 2].map(|k| ((p[k] - from[k]) / step).round_ties_even() as u16);
        PackedPoints { from, step, data: base64(points.iter().flat_map(number).flat_map(u16::to_le_bytes)) }
    }
}

impl PackedQuantity {
    /// A quantity of a file's vertices at those of a view, which come from `origins`.
    fn of(given: &VertexQuantity, origins: &[u32]) -> PackedQuantity {
        let values: Vec<f64> = origins.iter().map(|&v| given.values[v as usize]).collect();
        let mut finite: Vec<f64> = values.iter().copied().filter(|x| x.is_finite()).collect();
        finite.sort_unstable_by(f64::total_cmp);
        let [mut low, mut high] = ENDS.map(|share| quantile(&finite, share));
        if high <= low {
            [low, high] = [finite.first(), finite.last()].map(|x| x.copied().unwrap_or(0.0));
        }
        let range = if high > low { high - low } else { 1.0 };
        let most = u16::MAX - 1;
        let number = |x: &f64| match x.is_finite() {
            true => (((x - low) / range).clamp(0.0, 1.0) * f64::from(most)).round_ties_even() as u16,
            false => u16::MAX,
        };
        let data = base64(values.iter().map(number).flat_map(u16::to_le_bytes));
        PackedQuantity { name: given.name.clone(), low, high, data }
    }
}

/// The number that this share of sorted numbers lies below, linear between two of them; 0 of none.
fn quantile(sorted: &[f64], share: f64) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else { return 0.0 };
    let at = share * last as f64;
    let (below, part) = (at as usize, at.fract());
    let [a, b] = [sorted[below], sorted[(below + 1).min(last)]];
    if part < 0.5 { a + (b - a) * part } else { b - (b - a) * (1.0 - part) }
}

fn base64(bytes: impl Iterator<Item = u8>) -> String {
    STANDARD.encode(bytes.collect::<Vec<u8>>())
}

#[cfg(test)]
mod tests {
    use super::*;
    use ricci::mesh::io;

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
        let sides = ViewSides::textured(&io::read(&path).unwrap());
        let quantity = VertexQuantity { name: "x".into(), values: vec![0.0, 2.0, f64::NAN, 1.0] };
        let view = PageView::new(&sides, None, &[quantity]);
        assert_eq!((view.vertices, view.faces, view.wide, view.flat), (6, 3, false, true));
        assert_eq!(numbers(&view.corners), [0, 1, 2, 0, 3, 1, 4, 5, 3]);
        let expected = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 3.0, 0.0], [1.0, 1.0, 1.0]];
        for (k, v) in [0, 1, 2, 3, 2, 1].into_iter().enumerate() {
            for (j, want) in expected[v].into_iter().enumerate() {
                let got = view.surface.from[j]
                    + view.surface.step * f64::from(numbers(&view.surface.data)[3 * k + j]);
                assert!((got - want).abs() <= 0.5 * view.surface.step + 1e-12, "{k} {j}: {got} for {want}");
            }
        }
        let shares = numbers(&view.quantities[0].data);
        assert_eq!([shares[0], shares[1], shares[2], shares[4], shares[5]], [0, 65534, 65535, 65535, 65534]);
        // Of the values 0, 2, 1, 2 a hundredth lies below 0.03.
        assert!((view.quantities[0].low - 0.03).abs() < 1e-12 && view.quantities[0].high == 2.0);
    }

    #[test]
    fn quantiles_lie_between_the_numbers() {
        assert_eq!(quantile(&[], 0.5), 0.0);
        assert_eq!(quantile(&[3.0], 0.99), 3.0);
        assert_eq!(
            [0.0, 0.25, 0.625, 1.0].map(|share| quantile(&[0.0, 1.0, 3.0], share)),
            [0.0, 0.5, 1.5, 3.0]
        );
    }
}
