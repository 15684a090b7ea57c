//! A supersampled z-buffer for triangles and round strokes in pixel coordinates.
//!
//! The z-buffer knows shapes only; what a visible point looks like is asked of a painter, once for each shape in a pixel.

use super::color::{Rgb, encode};

/// Samples per pixel side of a finished picture.
pub const SAMPLES: usize = 4;
/// Rows of one band; fixed, so that the image does not depend on the number of threads.
const BAND: usize = 16;

/// Something to draw: x to the right and y down in pixels, z towards the viewer.
#[derive(Clone, Copy)]
pub enum Shape {
    Triangle([[f64; 3]; 3]),
    /// All points within `radius` of a segment: a tube with round ends, a ball where the ends coincide.
    Capsule {
        ends: [[f64; 3]; 2],
        radius: f64,
    },
}

/// The visible point of a sample.
#[derive(Clone, Copy)]
pub struct Hit {
    /// Index of the shape.
    pub shape: usize,
    /// Barycentric coordinates on a triangle; on a capsule the unit normal (x right, y down, z towards the viewer).
    pub local: [f64; 3],
    /// Whether a triangle shows the side from which its corners run counterclockwise.
    pub front: bool,
}

/// A rectangle of 8-bit sRGB pixels, row by row.
#[derive(Clone)]
pub struct Image {
    pub width: usize,
    pub height: usize,
    pub rgb: Vec<u8>,
}

impl Image {
    pub fn white(width: usize, height: usize) -> Image {
        Image { width, height, rgb: vec![255; 3 * width * height] }
    }

    /// Put another image into this one, its top left corner at (x, y); it must fit.
    pub fn put(&mut self, other: &Image, x: usize, y: usize) {
        for (row, line) in other.rgb.chunks_exact(3 * other.width.max(1)).enumerate() {
            let start = 3 * ((y + row) * self.width + x);
            self.rgb[start..start + line.len()].copy_from_slice(line);
        }
    }
}

/// What a painter makes of a sample at (x, y): of the shape that is visible there, or of the background.
pub trait Painter: Sync {
    fn paint(&self, at: [f64; 2], hit: Option<&Hit>) -> Rgb;
}

/// Draw with this many threads (0: one per core). A painter is asked once for each shape in a pixel, in the middle of the samples that
/// show it.
pub fn render(
    shapes: &[Shape],
    width: usize,
    height: usize,
    painter: &impl Painter,
    threads: usize,
) -> Image {
    let mut image = Image::white(width, height);
    let in_band = bands(shapes, height, BAND);
    let rows: Vec<&mut [u8]> = image.rgb.chunks_mut((3 * width * BAND).max(1)).collect();
    let codes = codes();
    in_parallel(rows, threads, |band, rows| {
        let (first, n) = (band * BAND, rows.len() / (3 * width));
        let samples = Samples::new(shapes, &in_band[band], [width, first, n], SAMPLES);
        for (pixel, out) in rows.chunks_exact_mut(3).enumerate() {
            let (x, y) = (pixel % width, pixel / width);
            let mut sum = [0.0; 3];
            for (id, count, at) in samples.in_pixel(x, y) {
                let at = at.map(|c| c / count);
                let hit = shapes.get(id as usize).map(|shape| shape.hit(id as usize, at));
                let color = painter.paint(at, hit.as_ref());
                (0..3).for_each(|k| sum[k] += count * color[k]);
            }
            let share = 1.0 / (SAMPLES * SAMPLES) as f64;
            (0..3).for_each(|k| out[k] = codes[(sum[k] * share * CODES).clamp(0.0, CODES) as usize]);
        }
    });
    image
}

/// Steps of linear light that are told apart: finer than those of 8 bits, also where it is dark.
const CODES: f64 = 16384.0;

/// The 8-bit value of each step.
fn codes() -> Vec<u8> {
    (0..=CODES as usize).map(|k| encode((k as f64 + 0.5) / CODES)).collect()
}

/// The shapes that reach into each band of `rows` rows.
pub fn bands(shapes: &[Shape], height: usize, rows: usize) -> Vec<Vec<u32>> {
    let mut bands = vec![Vec::new(); height.div_ceil(rows)];
    for (index, shape) in shapes.iter().enumerate() {
        let Some([_, [low, high]]) = shape.bounds() else { continue };
        let to = |y: f64| (y / rows as f64).clamp(0.0, bands.len() as f64) as usize;
        let range = to(low)..(to(high) + 1).min(bands.len());
        bands[range].iter_mut().for_each(|band| band.push(index as u32));
    }
    bands
}

/// Do the work for each item of a list; which thread does what changes nothing.
pub fn in_parallel<T: Send>(items: Vec<T>, threads: usize, work: impl Fn(usize, T) + Sync) {
    let cores = std::thread::available_parallelism().map_or(1, |n| n.get());
    let threads = if threads == 0 { cores } else { threads }.min(items.len());
    let queue = std::sync::Mutex::new(items.into_iter().enumerate());
    let take = || queue.lock().map(|mut q| q.next()).unwrap_or(None);
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                while let Some((index, item)) = take() {
                    work(index, item);
                }
            });
        }
    });
}

/// Which shape is nearest at each sample of a few rows, and how far towards the viewer it is there.
pub struct Samples {
    width: usize,
    per_pixel: usize,
    first: usize,
    pub depth: Vec<f32>,
    nearest: Vec<u32>,
}

/// No shape.
const NOTHING: u32 = u32::MAX;

impl Samples {
    /// The visible ones of the `listed` shapes in `rows` pixel rows from `first` on, with `per_pixel` samples on each pixel's side.
    pub fn new(
        shapes: &[Shape],
        listed: &[u32],
        [width, first, rows]: [usize; 3],
        per_pixel: usize,
    ) -> Samples {
        let n = width * rows * per_pixel * per_pixel;
        let (depth, nearest) = (vec![f32::NEG_INFINITY; n], vec![NOTHING; n]);
        let mut samples = Samples { width: width * per_pixel, per_pixel, first, depth, nearest };
        for &index in listed {
            match &shapes[index as usize] {
                Shape::Triangle(p) => samples.triangle(*p, index),
                capsule => samples.capsule(capsule, index),
            }
        }
        samples
    }

    /// The samples of an interval of pixels: those whose middles lie in it.
    fn range(&self, [low, high]: [f64; 2], n: usize) -> std::ops::Range<usize> {
        let scale = self.per_pixel as f64;
        // Rounding up, by a conversion that is faster than the function.
        let up = |v: f64| {
            let v = v.clamp(0.0, n as f64);
            v as usize + usize::from(v > (v as usize) as f64)
        };
        let down = |v: f64| if v < 0.0 { 0 } else { (v.min(n as f64) as usize + 1).min(n) };
        up(low * scale - 0.5)..down(high * scale - 0.5)
    }

    fn put(&mut self, at: usize, z: f64, index: u32) {
        if z as f32 > self.depth[at] {
            (self.depth[at], self.nearest[at]) = (z as f32, index);
        }
    }

    /// Row by row from side to side. The line of a side meets a row at the same number for both of its triangles: no sample between them
    /// is left out.
    pub fn triangle(&mut self, p: [[f64; 3]; 3], index: u32) {
        let area = doubled_area(p.map(|p| [p[0], p[1]]));
        let Some([x, y]) = bounds(&p, 0.0).filter(|_| area != 0.0) else { return };
        let (scale, first) = (self.per_pixel as f64, self.first as f64);
        let lines = self.range(y.map(|y| y - first), self.depth.len() / self.width.max(1));
        if lines.is_empty() || self.range(x, self.width).is_empty() {
            return;
        }
        // Across side k, opposite corner k: positive inside where the area is.
        let sides = [0, 1, 2].map(|k| {
            let (u, v) = (p[(k + 1) % 3], p[(k + 2) % 3]);
            [u[1] - v[1], v[0] - u[0], u[0] * v[1] - u[1] * v[0]]
        });
        let slope = [0, 1].map(|axis| (0..3).map(|k| sides[k][axis] * p[k][2]).sum::<f64>() / area);
        for row in lines {
            let y = first + (row as f64 + 0.5) / scale;
            let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
            for [a, b, c] in sides {
                let meets = -(b * y + c) / a;
                if a == 0.0 {
                    // A level side: all of the row is on one side of it.
                    low = if (b * y + c) * area < 0.0 { f64::INFINITY } else { low };
                } else if a * area > 0.0 {
                    low = low.max(meets);
                } else {
                    high = high.min(meets);
                }
            }
            let z = p[0][2] + slope[1] * (y - p[0][1]);
            for column in self.range([low, high], self.width) {
                let x = (column as f64 + 0.5) / scale;
                self.put(row * self.width + column, z + slope[0] * (x - p[0][0]), index);
            }
        }
    }

    fn capsule(&mut self, capsule: &Shape, index: u32) {
        let Some([x, y]) = capsule.bounds() else { return };
        let (scale, first) = (self.per_pixel as f64, self.first as f64);
        let rows = self.depth.len() / self.width.max(1);
        for row in self.range(y.map(|y| y - first), rows) {
            for column in self.range(x, self.width) {
                let at = [(column as f64 + 0.5) / scale, first + (row as f64 + 0.5) / scale];
                if let Some((z, _)) = capsule.cover(at) {
                    self.put(row * self.width + column, z, index);
                }
            }
        }
    }

    /// The different shapes in a pixel, how many samples show each, and the sum of their places.
    fn in_pixel(&self, x: usize, y: usize) -> impl Iterator<Item = (u32, f64, [f64; 2])> {
        let (n, step) = (self.per_pixel, 1.0 / self.per_pixel as f64);
        let mut seen = [(NOTHING, 0.0, [0.0; 2]); SAMPLES * SAMPLES];
        let mut count = 0;
        let row = |s: usize| &self.nearest[(y * n + s) * self.width + x * n..][..n];
        let first = row(0)[0];
        if (0..n).all(|s| row(s).iter().all(|id| *id == first)) {
            let (all, middle) = ((n * n) as f64, [x as f64 + 0.5, (self.first + y) as f64 + 0.5]);
            seen[0] = (first, all, middle.map(|c| c * all));
            return seen.into_iter().take(1);
        }
        for s in 0..n * n {
            let (column, row) = (x * n + s % n, y * n + s / n);
            let id = self.nearest[row * self.width + column];
            let k = seen[..count].iter().position(|known| known.0 == id).unwrap_or(count);
            count = count.max(k + 1);
            let (known, number, at) = &mut seen[k];
            *known = id;
            *number += 1.0;
            at[0] += (column as f64 + 0.5) * step;
            at[1] += self.first as f64 + (row as f64 + 0.5) * step;
        }
        seen.into_iter().take(count)
    }

    /// What is visible at the only sample of a pixel, whose middle is `at`.
    pub fn hit(&self, shapes: &[Shape], x: usize, y: usize, at: [f64; 2]) -> Option<Hit> {
        let index = self.nearest[y * self.width + x] as usize;
        shapes.get(index).map(|shape| shape.hit(index, at))
    }
}

/// Twice the signed area.
pub fn doubled_area(p: [[f64; 2]; 3]) -> f64 {
    (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[1][1] - p[0][1]) * (p[2][0] - p[0][0])
}

/// Least and largest x and y of some points, and of what is this far from them; nothing where a coordinate is no number.
fn bounds(points: &[[f64; 3]], by: f64) -> Option<[[f64; 2]; 2]> {
    let finite = points.as_flattened().iter().all(|x| x.is_finite());
    finite.then(|| {
        [0, 1].map(|k| {
            let low = points.iter().map(|p| p[k]).fold(f64::INFINITY, f64::min);
            let high = points.iter().map(|p| p[k]).fold(f64::NEG_INFINITY, f64::max);
            [low - by, high + by]
        })
    })
}

impl Shape {
    fn bounds(&self) -> Option<[[f64; 2]; 2]> {
        match self {
            Shape::Triangle(p) => bounds(p, 0.0),
            Shape::Capsule { ends, radius } => bounds(ends, *radius),
        }
    }

    /// What a visible point of the shape looks like; `at` may be a little beside it.
    fn hit(&self, index: usize, at: [f64; 2]) -> Hit {
        let (local, front) = match self {
            // y runs down: a triangle seen from its front has negative area.
            Shape::Triangle(p) => {
                let corners = p.map(|p| [p[0], p[1]]);
                (barycentric(corners, at), doubled_area(corners) < 0.0)
            }
            Shape::Capsule { .. } => (self.cover(at).map_or([0.0, 0.0, 1.0], |(_, normal)| normal), true),
        };
        Hit { shape: index, local, front }
    }

    /// Depth and normal where a capsule covers a point of the screen.
    fn cover(&self, at: [f64; 2]) -> Option<(f64, [f64; 3])> {
        let Shape::Capsule { ends: [a, b], radius } = self else { return None };
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
fn barycentric([a, b, c]: [[f64; 2]; 3], at: [f64; 2]) -> [f64; 3] {
    let area = doubled_area([a, b, c]);
    let weights = [doubled_area([at, b, c]), doubled_area([a, at, c]), doubled_area([a, b, at])];
    let inside = weights.map(|w| (w / area).max(0.0));
    let sum = inside[0] + inside[1] + inside[2];
    if sum > 0.0 { inside.map(|w| w / sum) } else { [1.0 / 3.0; 3] }
}
