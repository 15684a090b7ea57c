//! A supersampled z-buffer for triangles and round strokes in pixel coordinates.
//!
//! The z-buffer knows shapes only; what a visible point looks like is asked of a painter, once per visible sample.

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

/// Draw with this many threads (0: one per core).
pub fn render(
    shapes: &[Shape],
    width: usize,
    height: usize,
    painter: &impl Painter,
    threads: usize,
) -> Image {
    let mut image = Image::white(width, height);
    let bands: Vec<&mut [u8]> = image.rgb.chunks_mut((3 * width * BAND).max(1)).collect();
    in_parallel(bands, threads, |band, rows| {
        let samples = visible(shapes, width, band * BAND, rows.len() / (3 * width), SAMPLES);
        let step = 1.0 / SAMPLES as f64;
        for (pixel, out) in rows.chunks_exact_mut(3).enumerate() {
            let (x, y) = (pixel % width, pixel / width);
            if samples.nothing_in(x, y) {
                // The background is smooth: one look is enough.
                let color = painter.paint([x as f64 + 0.5, (band * BAND + y) as f64 + 0.5], None);
                (0..3).for_each(|k| out[k] = encode(color[k]));
                continue;
            }
            let mut sum = [0.0; 3];
            for s in 0..SAMPLES * SAMPLES {
                let (sx, sy) = (x * SAMPLES + s % SAMPLES, y * SAMPLES + s / SAMPLES);
                let at = [(sx as f64 + 0.5) * step, (band * BAND) as f64 + (sy as f64 + 0.5) * step];
                let color = painter.paint(at, samples.hit(shapes, sx, sy, at).as_ref());
                (0..3).for_each(|k| sum[k] += color[k]);
            }
            (0..3).for_each(|k| out[k] = encode(sum[k] * step * step));
        }
    });
    image
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

/// Which shape is nearest at each sample of a few rows.
pub struct Samples {
    width: usize,
    nearest: Vec<(f64, u32)>,
}

/// No shape.
const NOTHING: u32 = u32::MAX;

/// Find the visible shapes of `rows` pixel rows from `first` on, with `per_pixel` samples on each pixel's side.
pub fn visible(shapes: &[Shape], width: usize, first: usize, rows: usize, per_pixel: usize) -> Samples {
    let (w, h) = (width * per_pixel, rows * per_pixel);
    let mut samples = Samples { width: w, nearest: vec![(f64::NEG_INFINITY, NOTHING); w * h] };
    let scale = per_pixel as f64;
    let pixel = |x: usize, y: usize| [(x as f64 + 0.5) / scale, first as f64 + (y as f64 + 0.5) / scale];
    for (index, shape) in shapes.iter().enumerate() {
        let Some([x, y]) = shape.bounds() else { continue };
        let range = |[low, high]: [f64; 2], n: usize| {
            let to = |v: f64| (v - 0.5).ceil().clamp(0.0, n as f64) as usize;
            to(low * scale)..to(high * scale + 1.0)
        };
        for sy in range(y.map(|y| y - first as f64), h) {
            for sx in range(x, w) {
                if let Some((z, _)) = shape.cover(pixel(sx, sy)) {
                    let nearest = &mut samples.nearest[sy * w + sx];
                    if z > nearest.0 {
                        *nearest = (z, index as u32);
                    }
                }
            }
        }
    }
    samples
}

impl Samples {
    /// Whether no sample of a pixel shows a shape.
    fn nothing_in(&self, x: usize, y: usize) -> bool {
        let row = |s: usize| (y * SAMPLES + s) * self.width + x * SAMPLES;
        (0..SAMPLES).all(|s| self.nearest[row(s)..row(s) + SAMPLES].iter().all(|n| n.1 == NOTHING))
    }

    /// What is visible at a sample, whose pixel coordinates are `at`.
    pub fn hit(&self, shapes: &[Shape], x: usize, y: usize, at: [f64; 2]) -> Option<Hit> {
        let (_, index) = self.nearest[y * self.width + x];
        let shape = shapes.get(index as usize)?;
        let (_, local) = shape.cover(at)?;
        // y runs down: a triangle seen from its front has negative area.
        let front = match shape {
            Shape::Triangle(p) => doubled_area(p.map(|p| [p[0], p[1]])) < 0.0,
            Shape::Capsule { .. } => true,
        };
        Some(Hit { shape: index as usize, local, front })
    }
}

/// Twice the signed area.
pub fn doubled_area(p: [[f64; 2]; 3]) -> f64 {
    (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[1][1] - p[0][1]) * (p[2][0] - p[0][0])
}

impl Shape {
    /// Least and largest x and y; nothing where a coordinate is no number.
    fn bounds(&self) -> Option<[[f64; 2]; 2]> {
        let of = |points: &[[f64; 3]], by: f64| {
            let finite = points.iter().flatten().all(|x| x.is_finite());
            finite.then(|| {
                [0, 1].map(|k| {
                    let low = points.iter().map(|p| p[k]).fold(f64::INFINITY, f64::min);
                    let high = points.iter().map(|p| p[k]).fold(f64::NEG_INFINITY, f64::max);
                    [low - by, high + by]
                })
            })
        };
        match self {
            Shape::Triangle(p) => of(p, 0.0),
            Shape::Capsule { ends, radius } => of(ends, *radius),
        }
    }

    /// Depth and local coordinates where the shape covers a point of the screen.
    #[inline]
    fn cover(&self, at: [f64; 2]) -> Option<(f64, [f64; 3])> {
        match self {
            Shape::Triangle(p) => {
                let [a, b, c] = p.map(|p| [p[0], p[1]]);
                let area = doubled_area([a, b, c]);
                if area == 0.0 {
                    return None;
                }
                let weights = [
                    doubled_area([at, b, c]) / area,
                    doubled_area([a, at, c]) / area,
                    doubled_area([a, b, at]) / area,
                ];
                let inside = weights.iter().all(|&w| w >= 0.0);
                let z = weights[0] * p[0][2] + weights[1] * p[1][2] + weights[2] * p[2][2];
                inside.then_some((z, weights))
            }
            Shape::Capsule { ends: [a, b], radius } => {
                let along = [b[0] - a[0], b[1] - a[1]];
                let square = along[0] * along[0] + along[1] * along[1];
                let t = (at[0] - a[0]) * along[0] + (at[1] - a[1]) * along[1];
                let t = if square > 0.0 { (t / square).clamp(0.0, 1.0) } else { 0.0 };
                let off = [at[0] - a[0] - t * along[0], at[1] - a[1] - t * along[1]];
                let rest = radius * radius - off[0] * off[0] - off[1] * off[1];
                if rest < 0.0 {
                    return None;
                }
                let rise = rest.sqrt();
                let normal = [off[0] / radius, off[1] / radius, rise / radius];
                Some((a[2] + t * (b[2] - a[2]) + rise, normal))
            }
        }
    }
}
