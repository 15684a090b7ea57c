//! A supersampled z-buffer for triangles in pixel coordinates.

use super::checker::Checker;

/// Linear light, each channel in [0, 1].
pub type Rgb = [f64; 3];

/// Samples per pixel side.
const SAMPLES: usize = 4;
/// Rows of one band; fixed, so that the image does not depend on the number of threads.
const BAND: usize = 45;

/// A triangle to draw. z grows towards the viewer.
pub struct Primitive {
    pub xy: [[f64; 2]; 3],
    pub z: [f64; 3],
    pub paint: Paint,
}

/// How a triangle is coloured.
pub enum Paint {
    Plain(Rgb),
    /// Lit by its corner normals (z towards the viewer), with a checkerboard where there is one.
    Lit {
        normals: [[f64; 3]; 3],
        checker: Option<Checker>,
        base: Rgb,
    },
    /// Unlit checkerboard between two light tones.
    Tiled {
        checker: Checker,
    },
}

/// Draw into a square of `size` pixels with this many threads (0: one per core); 8-bit sRGB, row by row.
pub fn render(primitives: &[Primitive], size: usize, threads: usize) -> Vec<u8> {
    let mut image = vec![0u8; 3 * size * size];
    let bands: Vec<(usize, &mut [u8])> = image.chunks_mut(3 * size * BAND).enumerate().collect();
    let queue = std::sync::Mutex::new(bands.into_iter());
    let cores = std::thread::available_parallelism().map_or(1, |n| n.get());
    let threads = if threads == 0 { cores } else { threads };
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                loop {
                    let next = queue.lock().map(|mut q| q.next()).unwrap_or(None);
                    let Some((band, rows)) = next else { break };
                    draw_band(primitives, size, band * BAND, rows);
                }
            });
        }
    });
    image
}

fn draw_band(primitives: &[Primitive], size: usize, first_row: usize, rows: &mut [u8]) {
    let height = rows.len() / (3 * size);
    let (w, h) = (size * SAMPLES, height * SAMPLES);
    let mut depth = vec![f64::NEG_INFINITY; w * h];
    let mut color = vec![[1.0f32; 3]; w * h];
    for primitive in primitives {
        draw(primitive, (w, h), first_row, &mut depth, &mut color);
    }
    for y in 0..height {
        for x in 0..size {
            let mut sum = [0.0f32; 3];
            for sy in 0..SAMPLES {
                for sx in 0..SAMPLES {
                    let c = color[(y * SAMPLES + sy) * w + x * SAMPLES + sx];
                    (0..3).for_each(|k| sum[k] += c[k]);
                }
            }
            let n = (SAMPLES * SAMPLES) as f32;
            (0..3).for_each(|k| rows[3 * (y * size + x) + k] = encode(sum[k] / n));
        }
    }
}

/// sRGB transfer function.
pub fn encode(x: f32) -> u8 {
    let x = x.clamp(0.0, 1.0);
    let y = if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 };
    (255.0 * y + 0.5) as u8
}

fn draw(p: &Primitive, (w, h): (usize, usize), first_row: usize, depth: &mut [f64], color: &mut [[f32; 3]]) {
    let s = SAMPLES as f64;
    let at = p.xy.map(|[x, y]| [s * x, s * (y - first_row as f64)]);
    if at.iter().flatten().chain(&p.z).any(|x| !x.is_finite()) {
        return;
    }
    let area = cross(at[0], at[1], at[2]);
    if area == 0.0 {
        return;
    }
    let range = |k: usize, n: usize| {
        let low = at.iter().map(|a| a[k]).fold(f64::INFINITY, f64::min);
        let high = at.iter().map(|a| a[k]).fold(f64::NEG_INFINITY, f64::max);
        ((low - 0.5).ceil().max(0.0) as usize)..((high + 0.5).ceil().clamp(0.0, n as f64) as usize)
    };
    for y in range(1, h) {
        for x in range(0, w) {
            let sample = [x as f64 + 0.5, y as f64 + 0.5];
            let b = [
                cross(sample, at[1], at[2]) / area,
                cross(at[0], sample, at[2]) / area,
                cross(at[0], at[1], sample) / area,
            ];
            if b.iter().any(|&b| b < 0.0) {
                continue;
            }
            let z = b[0] * p.z[0] + b[1] * p.z[1] + b[2] * p.z[2];
            let i = y * w + x;
            if z > depth[i] {
                depth[i] = z;
                // y runs down: a triangle seen from its front has negative area.
                color[i] = shade(&p.paint, b, area < 0.0).map(|x| x as f32);
            }
        }
    }
}

fn cross(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

fn shade(paint: &Paint, b: [f64; 3], front: bool) -> Rgb {
    match paint {
        Paint::Plain(color) => *color,
        Paint::Tiled { checker } => mix([0.94, 0.94, 0.92], [0.62, 0.72, 0.84], checker.value(b)),
        Paint::Lit { normals, checker, base } => {
            let n = [0, 1, 2].map(|k| b[0] * normals[0][k] + b[1] * normals[1][k] + b[2] * normals[2][k]);
            let length = n.iter().map(|x| x * x).sum::<f64>().sqrt();
            // Two-sided: the inside is lit like the outside and tinted.
            let n = n.map(|x| if length > 0.0 { x / length * if front { 1.0 } else { -1.0 } } else { 0.57 });
            let albedo = match checker {
                Some(checker) => mix([0.90, 0.88, 0.84], [0.10, 0.24, 0.48], checker.value(b)),
                None => *base,
            };
            let albedo = if front { albedo } else { mix(albedo, [0.5, 0.18, 0.08], 0.6) };
            let light = |direction: [f64; 3]| (0..3).map(|k| direction[k] * n[k]).sum::<f64>().max(0.0);
            let key = light([-0.45, 0.55, 0.70]);
            let fill = light([0.80, 0.05, 0.60]);
            let sky = 0.5 + 0.5 * n[1];
            let shine = light([-0.24, 0.30, 0.923]).powi(40);
            albedo.map(|a| a * (0.80 * key + 0.22 * fill + 0.10 + 0.14 * sky) + 0.08 * shine)
        }
    }
}

fn mix(a: Rgb, b: Rgb, t: f64) -> Rgb {
    [0, 1, 2].map(|k| a[k] + t * (b[k] - a[k]))
}

/// A line of `width` pixels with round-ish ends (half a width longer on both sides).
pub fn line(out: &mut Vec<Primitive>, a: [f64; 2], b: [f64; 2], z: [f64; 2], width: f64, color: Rgb) {
    let d = [b[0] - a[0], b[1] - a[1]];
    let length = d[0].hypot(d[1]);
    let t = if length > 0.0 {
        [0.5 * width * d[0] / length, 0.5 * width * d[1] / length]
    } else {
        [0.5 * width, 0.0]
    };
    let (a, b) = ([a[0] - 0.5 * t[0], a[1] - 0.5 * t[1]], [b[0] + 0.5 * t[0], b[1] + 0.5 * t[1]]);
    let corner = |p: [f64; 2], side: f64| [p[0] - side * t[1], p[1] + side * t[0]];
    let (p, q, r, s) = (corner(a, 1.0), corner(a, -1.0), corner(b, -1.0), corner(b, 1.0));
    out.push(Primitive { xy: [p, q, r], z: [z[0], z[0], z[1]], paint: Paint::Plain(color) });
    out.push(Primitive { xy: [p, r, s], z: [z[0], z[1], z[1]], paint: Paint::Plain(color) });
}

/// A disk of `radius` pixels facing the viewer, with a white rim.
pub fn dot(out: &mut Vec<Primitive>, at: [f64; 2], z: f64, radius: f64, color: Rgb) {
    const SIDES: usize = 20;
    for (radius, z, color) in [(radius + 1.3, z, [1.0; 3]), (radius, z + 0.1, color)] {
        let rim = |k: usize| {
            let (sin, cos) = (std::f64::consts::TAU * k as f64 / SIDES as f64).sin_cos();
            [at[0] + radius * cos, at[1] + radius * sin]
        };
        for k in 0..SIDES {
            out.push(Primitive { xy: [at, rim(k), rim(k + 1)], z: [z; 3], paint: Paint::Plain(color) });
        }
    }
}
