//! A supersampled z-buffer for triangles and round strokes in pixel coordinates.

use super::color::{Rgb, encode};
use super::vector::{V3, ends};
use ricci::geometry::complex::doubled_area;
use ricci::parallel::each;

/// Samples per pixel side of a finished picture.
pub const SAMPLES: usize = 4;
/// Rows of one band; fixed, so that the image does not depend on the number of threads.
const BAND: usize = 48;

/// A shape to draw: x to the right and y down in pixels, z towards the viewer.
#[derive(Clone, Copy)]
pub enum DrawnShape {
    Triangle([V3; 3]),
    /// All points within `radius` of a segment: a tube with round ends, a ball where the ends coincide.
    Capsule {
        ends: [V3; 2],
        radius: f64,
    },
}

/// The visible point of a sample.
#[derive(Clone, Copy)]
pub struct Hit {
    /// Index of the shape.
    pub shape: usize,
    /// Barycentric coordinates on a triangle; on a capsule the unit normal (x right, y down, z towards the viewer).
    pub local: V3,
    /// True if a triangle shows the side from which its corners run counterclockwise.
    pub front: bool,
}

/// A rectangle of 8-bit sRGB pixels, opaque, four bytes each, row by row.
#[derive(Clone)]
pub struct PixelImage {
    pub width: usize,
    pub height: usize,
    pub rgba: Vec<u8>,
}

impl PixelImage {
    pub fn white(width: usize, height: usize) -> PixelImage {
        PixelImage { width, height, rgba: vec![255; 4 * width * height] }
    }

    /// Put another image into this one, its top left corner at (x, y); it must fit.
    pub fn put(&mut self, other: &PixelImage, x: usize, y: usize) {
        for (row, line) in other.rgba.chunks_exact(4 * other.width.max(1)).enumerate() {
            let start = 4 * ((y + row) * self.width + x);
            self.rgba[start..start + line.len()].copy_from_slice(line);
        }
    }
}

/// The image of some shapes. `paint`: the colour at a place of a shape, or of the background; it is called once for each shape in a pixel, at
/// the mean place of the samples that show it.
pub fn render(
    shapes: &[DrawnShape],
    [width, height]: [usize; 2],
    paint: impl Fn([f64; 2], Option<&Hit>) -> Rgb + Sync,
) -> PixelImage {
    let mut image = PixelImage::white(width, height);
    let codes: Vec<u8> = (0..=CODES as usize).map(|k| encode((k as f64 + 0.5) / CODES)).collect();
    let bands = image.rgba.chunks_mut((4 * width * BAND).max(1));
    each(bands.enumerate().collect(), |(band, pixels)| {
        let rows = [width, band * BAND, pixels.len() / (4 * width)];
        let samples = Samples::new(shapes, rows, SAMPLES as f64);
        for (pixel, out) in pixels.chunks_exact_mut(4).enumerate() {
            let mut sum = [0.0; 3];
            for (id, share, at) in samples.in_pixel(pixel % width, pixel / width) {
                let hit = shapes.get(id as usize).map(|shape| shape.hit(id as usize, at));
                let color = paint(at, hit.as_ref());
                (0..3).for_each(|k| sum[k] += share * color[k]);
            }
            (0..3).for_each(|k| out[k] = codes[(sum[k] * CODES).clamp(0.0, CODES) as usize]);
        }
    });
    image
}

/// Number of steps of linear light in the table of 8-bit codes: they are finer than those of 8 bits, also in the dark.
const CODES: f64 = 16384.0;

/// The nearest shape at each sample of a few rows, and its depth there.
pub struct Samples {
    /// Samples in a row.
    pub width: usize,
    /// Samples on a pixel's side.
    scale: f64,
    /// The first pixel row.
    first: usize,
    depth: Vec<f32>,
    nearest: Vec<u32>,
}

/// The number that stands for no shape.
const NOTHING: u32 = u32::MAX;

impl Samples {
    /// The visible shapes in `rows` pixel rows from `first` on, with `scale` samples on each pixel's side.
    pub fn new(shapes: &[DrawnShape], [width, first, rows]: [usize; 3], scale: f64) -> Samples {
        let [width, height] = [width, rows].map(|n| (n as f64 * scale).ceil() as usize);
        let (depth, nearest) = (vec![f32::NEG_INFINITY; width * height], vec![NOTHING; width * height]);
        let mut samples = Samples { width, scale, first, depth, nearest };
        for (index, shape) in (0..).zip(shapes) {
            match shape {
                DrawnShape::Triangle(p) => {
                    let place = |p: V3| [p[0] * scale - 0.5, (p[1] - first as f64) * scale - 0.5, p[2]];
                    scan(p.map(place), [width, height], |at, z| samples.put(at, z, index));
                }
                capsule => samples.capsule(capsule, index),
            }
        }
        samples
    }

    fn put(&mut self, at: usize, z: f64, index: u32) {
        if z as f32 > self.depth[at] {
            (self.depth[at], self.nearest[at]) = (z as f32, index);
        }
    }

    fn capsule(&mut self, capsule: &DrawnShape, index: u32) {
        let first = self.first as f64;
        let [x, y] = capsule.bounds();
        let [columns, rows] = [(x, 0.0, self.width), (y, first, self.depth.len() / self.width.max(1))]
            .map(|(ends, from, n)| span(ends.map(|c| (c - from) * self.scale - 0.5), n));
        for (row, column) in rows.flat_map(|row| columns.clone().map(move |column| (row, column))) {
            if let Some((z, _)) = capsule.cover(self.at(column, row)) {
                self.put(row * self.width + column, z, index);
            }
        }
    }

    /// The place of a sample in pixels.
    fn at(&self, column: usize, row: usize) -> [f64; 2] {
        [(column as f64 + 0.5) / self.scale, self.first as f64 + (row as f64 + 0.5) / self.scale]
    }

    /// The different shapes in a pixel, the share of its [`SAMPLES`]² samples that shows each, and the mean of their places.
    fn in_pixel(&self, x: usize, y: usize) -> impl Iterator<Item = (u32, f64, [f64; 2])> {
        let row = |k: usize| &self.nearest[(SAMPLES * y + k) * self.width + SAMPLES * x..][..SAMPLES];
        let first = row(0)[0];
        // In a pixel that shows one shape all samples count as one.
        let n = if (0..SAMPLES).all(|k| row(k).iter().all(|id| *id == first)) { 1 } else { SAMPLES };
        let mut seen = [(NOTHING, 0.0, [0.0; 2]); SAMPLES * SAMPLES];
        let mut count = 0;
        for (i, j) in (0..n).flat_map(|j| (0..n).map(move |i| (i, j))) {
            let id = row(j)[i];
            let k = seen[..count].iter().position(|known| known.0 == id).unwrap_or(count);
            count = count.max(k + 1);
            let (_, number, [x, y]) = seen[k];
            seen[k] = (id, number + 1.0, [x + i as f64 + 0.5, y + j as f64 + 0.5]);
        }
        let [x, y, n] = [x as f64, (self.first + y) as f64, n as f64];
        let place = move |number: f64, [i, j]: [f64; 2]| [x + i / (n * number), y + j / (n * number)];
        seen.into_iter().take(count).map(move |(id, number, sum)| (id, number / (n * n), place(number, sum)))
    }

    /// The number of samples.
    pub fn len(&self) -> usize {
        self.depth.len()
    }

    /// The samples of a row: the place of each, and the visible point there.
    pub fn row<'a>(
        &'a self,
        shapes: &'a [DrawnShape],
        row: usize,
    ) -> impl Iterator<Item = ([f64; 2], Option<Hit>)> + 'a {
        (0..self.width).map(move |column| {
            let (at, index) = (self.at(column, row), self.nearest[row * self.width + column] as usize);
            (at, shapes.get(index).map(|shape| shape.hit(index, at)))
        })
    }
}

/// The whole numbers below `n` in an interval.
fn span([low, high]: [f64; 2], n: usize) -> std::ops::Range<usize> {
    // Rounds up by a conversion, which is faster than `ceil`.
    let low = low.clamp(0.0, n as f64);
    let start = low as usize + usize::from(low > (low as usize) as f64);
    start..if high < 0.0 { 0 } else { (high.min(n as f64) as usize + 1).min(n) }
}

/// Visit the points of whole numbers in a triangle, numbered row by row of an image of this width and height, with the depth there. The
/// line of a side meets a row at the same number for both of its triangles: no point between them is left out.
pub fn scan(p: [V3; 3], [width, height]: [usize; 2], mut put: impl FnMut(usize, f64)) {
    let [[left, right], [top, bottom]] = bounds(&p);
    let rows = span([top, bottom], height);
    if rows.is_empty() || span([left, right], width).is_empty() {
        return;
    }
    let area = doubled_area(p.map(|p| [p[0], p[1]]));
    if area == 0.0 || !area.is_finite() {
        return;
    }
    // Per side k, opposite corner k: its x in row 0, the change of x from row to row, and whether it bounds the triangle on the left. A
    // horizontal side bounds no row on either side.
    let mut sides = [(0.0, 0.0, None); 3];
    let mut slope = [0.0; 2];
    for k in 0..3 {
        let (u, v) = (p[(k + 1) % 3], p[(k + 2) % 3]);
        let [a, b] = [u[1] - v[1], v[0] - u[0]];
        slope = [slope[0] + a * p[k][2] / area, slope[1] + b * p[k][2] / area];
        sides[k] = ((u[1] * v[0] - u[0] * v[1]) / a, -b / a, (a != 0.0).then_some(a * area > 0.0));
    }
    for row in rows {
        let y = row as f64;
        let (mut low, mut high) = (left, right);
        for (start, step, is_left) in sides {
            match is_left {
                Some(true) => low = low.max(start + step * y),
                Some(false) => high = high.min(start + step * y),
                None => {}
            }
        }
        let z = p[0][2] + slope[1] * (y - p[0][1]) - slope[0] * p[0][0];
        span([low, high], width).for_each(|column| put(row * width + column, z + slope[0] * column as f64));
    }
}

/// Least and largest x and y of some points.
fn bounds(points: &[V3]) -> [[f64; 2]; 2] {
    [0, 1].map(|k| ends(points.iter().map(|p| p[k])))
}

impl DrawnShape {
    fn bounds(&self) -> [[f64; 2]; 2] {
        match self {
            DrawnShape::Triangle(p) => bounds(p),
            DrawnShape::Capsule { ends: points, radius } => {
                bounds(points).map(|[low, high]| [low - radius, high + radius])
            }
        }
    }

    /// The visible point of the shape at a place, which may lie a little outside it.
    fn hit(&self, index: usize, at: [f64; 2]) -> Hit {
        let (local, front) = match self {
            // y runs down: a triangle seen from its front has negative area.
            DrawnShape::Triangle(p) => {
                let corners = p.map(|p| [p[0], p[1]]);
                (barycentric(corners, at), doubled_area(corners) < 0.0)
            }
            DrawnShape::Capsule { .. } => {
                (self.cover(at).map_or([0.0, 0.0, 1.0], |(_, normal)| normal), true)
            }
        };
        Hit { shape: index, local, front }
    }

    /// Depth and normal where a capsule covers a point of the screen.
    fn cover(&self, at: [f64; 2]) -> Option<(f64, V3)> {
        let DrawnShape::Capsule { ends: [a, b], radius } = self else { return None };
        let along = [b[0] - a[0], b[1] - a[1]];
        let square = along[0] * along[0] + along[1] * along[1];
        let t = (at[0] - a[0]) * along[0] + (at[1] - a[1]) * along[1];
        let t = if square > 0.0 { (t / square).clamp(0.0, 1.0) } else { 0.0 };
        let off = [at[0] - a[0] - t * along[0], at[1] - a[1] - t * along[1]];
        let rest = radius * radius - off[0] * off[0] - off[1] * off[1];
        (rest >= 0.0).then(|| {
            let rise = rest.sqrt();
            (a[2] + t * (b[2] - a[2]) + rise, [off[0] / radius, off[1] / radius, rise / radius])
        })
    }
}

/// Barycentric coordinates of the point of a triangle nearest to `at`, as far as clamping finds it.
fn barycentric([a, b, c]: [[f64; 2]; 3], at: [f64; 2]) -> V3 {
    let area = doubled_area([a, b, c]);
    let weights = [doubled_area([at, b, c]), doubled_area([a, at, c]), doubled_area([a, b, at])];
    let inside = weights.map(|w| (w / area).max(0.0));
    let sum = inside[0] + inside[1] + inside[2];
    if sum > 0.0 { inside.map(|w| w / sum) } else { [1.0 / 3.0; 3] }
}
