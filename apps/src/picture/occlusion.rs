//! How much of the sky and of the key light a point sees past the surface, by casting rays.
//!
//! Each pixel casts a few rays, sixteen different sets of them in every square of 4 × 4 pixels; the mean over such a
//! square of neighbours on the same piece of surface then counts all sets once (interleaved sampling, \[KH01\]).

use super::raster::{Shape, in_parallel, visible};
use super::vector::{V3, add, at, complement, dot, scaled, sub};
use obvhs::BvhBuildParams;
use obvhs::cwbvh::{CwBvh, builder::build_cwbvh_from_tris};
use obvhs::ray::Ray;
use obvhs::triangle::Triangle;
use std::time::Duration;

/// Rays of one pixel to the sky and to the key light.
const SKY_RAYS: usize = 8;
const KEY_RAYS: usize = 4;
/// Pixels per side of the squares that share one set of directions.
const TILE: usize = 4;
/// Angular radius of the key light, radians: the softness of its shadows.
const KEY_RADIUS: f64 = 0.16;
/// The surface hides the sky from itself up to this distance, as a share of the picture's size; what is farther away
/// hides light but also throws some back.
const REACH: f64 = 0.45;
/// Rays start this far off the surface, pixels, so that rounding to f32 does not hide it from itself.
const LIFT: f64 = 0.03;
/// Rows of one band of work.
const BAND: usize = 8;

/// Shares of the light that arrive, in [0, 1].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Open {
    pub sky: f64,
    pub key: f64,
}

impl Open {
    pub const FULLY: Open = Open { sky: 1.0, key: 1.0 };
}

/// A point that is seen, in pixel coordinates.
#[derive(Clone, Copy)]
pub struct Point {
    pub xyz: V3,
    /// Unit normal for shading.
    pub normal: V3,
    /// Unit normal of the face.
    pub flat: V3,
    pub on_ground: bool,
}

/// The plane on which a surface stands: points with `up · x = level`.
#[derive(Clone, Copy)]
pub struct Ground {
    pub up: V3,
    pub level: f64,
}

impl Ground {
    /// The ground behind a pixel.
    pub fn below(&self, [x, y]: [f64; 2]) -> Point {
        let z = (self.level - self.up[0] * x - self.up[1] * y) / self.up[2];
        Point { xyz: [x, y, z], normal: self.up, flat: self.up, on_ground: true }
    }
}

/// A surface that casts shadows.
pub struct Caster {
    triangles: Vec<Triangle>,
    tree: Option<CwBvh>,
    key: V3,
    reach: f64,
}

impl Caster {
    /// `key`: unit vector towards the key light; `size`: of the picture in pixels.
    pub fn new(shapes: &[Shape], key: V3, size: usize) -> Caster {
        let corners = shapes.iter().filter_map(|s| match s {
            Shape::Triangle(p) => Some(p),
            Shape::Capsule { .. } => None,
        });
        let triangles: Vec<Triangle> = corners
            .map(|[a, b, c]| Triangle { v0: single(*a), v1: single(*b), v2: single(*c) })
            .filter(|t| t.v0.is_finite() && t.v1.is_finite() && t.v2.is_finite())
            .collect();
        let build =
            || build_cwbvh_from_tris(&triangles, BvhBuildParams::fast_build(), &mut Duration::default());
        let tree = (!triangles.is_empty()).then(build);
        Caster { triangles, tree, key, reach: REACH * size as f64 }
    }

    /// The light that reaches a point; `set` in 0..16 chooses the directions.
    pub fn open(&self, point: &Point, set: usize) -> Open {
        let Some(tree) = &self.tree else { return Open::FULLY };
        let origin = add(point.xyz, scaled(point.flat, LIFT));
        let reach = if point.on_ground { f64::INFINITY } else { self.reach };
        let free = |direction: V3, reach: f64| {
            let ray = Ray::new(single(origin), single(direction), 0.0, reach as f32);
            tree.ray_traverse_miss(ray, |ray, i| {
                self.triangles[tree.primitive_indices[i] as usize].intersect(ray)
            })
        };
        let [a, b] = complement(point.normal);
        let (mut seen, mut cast) = (0, 0);
        for j in 0..SKY_RAYS {
            let [p, q] = disk_point(set * SKY_RAYS + j);
            let rise = (1.0 - p * p - q * q).max(0.0).sqrt();
            let direction = add(scaled(point.normal, rise), add(scaled(a, p), scaled(b, q)));
            // A direction below the face itself says nothing about what is above it.
            if dot(direction, point.flat) > 0.0 {
                cast += 1;
                seen += usize::from(free(direction, reach));
            }
        }
        let sky = if cast > 0 { seen as f64 / cast as f64 } else { 1.0 };
        if dot(self.key, point.normal) <= 0.0 {
            return Open { sky, key: 0.0 };
        }
        let [a, b] = complement(self.key);
        let lit = (0..KEY_RAYS).filter(|j| {
            let [p, q] = disk_point(set * KEY_RAYS + j).map(|x| x * KEY_RADIUS);
            free(add(self.key, add(scaled(a, p), scaled(b, q))), f64::INFINITY)
        });
        Open { sky, key: lit.count() as f64 / KEY_RAYS as f64 }
    }
}

/// In the single precision of the tree.
fn single<T: From<[f32; 3]>>(p: V3) -> T {
    p.map(|x| x as f32).into()
}

/// Points spread evenly over the unit disk: any run of consecutive ones is. The sequence of \[Rob18\] in the square,
/// with its first coordinate as the share of the area within and its second as the angle.
fn disk_point(i: usize) -> [f64; 2] {
    let s = (0.5 + (i + 1) as f64 * 0.754_877_666_246_692_7).fract();
    let t = (0.5 + (i + 1) as f64 * 0.569_840_290_998_053_2).fract();
    let (sin, cos) = (std::f64::consts::TAU * t).sin_cos();
    [s.sqrt() * cos, s.sqrt() * sin]
}

/// The point of the smooth surface over a point of a face \[Han21\]: shadows then end where the smooth shading does, not
/// along the edges of the faces.
pub fn over(b: V3, corners: [V3; 3], normals: [V3; 3]) -> V3 {
    let p = at(b, corners);
    let lifted = [0, 1, 2].map(|k| {
        let below = dot(sub(p, corners[k]), normals[k]).min(0.0);
        sub(p, scaled(normals[k], below))
    });
    at(b, lifted)
}

/// The light at every pixel of a picture.
pub struct Field {
    width: usize,
    height: usize,
    points: Vec<Option<Point>>,
    open: Vec<Open>,
}

impl Field {
    /// `describe` names the point that a pixel shows, given the face and the barycentric coordinates, or nothing.
    pub fn new(
        caster: &Caster,
        shapes: &[Shape],
        [width, height]: [usize; 2],
        threads: usize,
        describe: impl Fn([f64; 2], Option<&super::raster::Hit>) -> Option<Point> + Sync,
    ) -> Field {
        let mut points = vec![None; width * height];
        let mut raw = vec![Open::FULLY; width * height];
        let rows = (width * BAND).max(1);
        let bands: Vec<_> = points.chunks_mut(rows).zip(raw.chunks_mut(rows)).collect();
        in_parallel(bands, threads, |band, (points, raw)| {
            let first = band * BAND;
            let samples = visible(shapes, width, first, points.len() / width, 1);
            for (i, (point, raw)) in points.iter_mut().zip(raw).enumerate() {
                let (x, y) = (i % width, i / width);
                let pixel = [x as f64 + 0.5, (first + y) as f64 + 0.5];
                *point = describe(pixel, samples.hit(shapes, x, y, pixel).as_ref());
                if let Some(point) = point {
                    *raw = caster.open(point, (first + y) % TILE * TILE + x % TILE);
                }
            }
        });
        let mut field = Field { width, height, points, open: raw };
        let mut smooth = field.open.clone();
        let bands: Vec<_> = smooth.chunks_mut(rows).collect();
        in_parallel(bands, threads, |band, out| {
            for (i, out) in out.iter_mut().enumerate() {
                let pixel = band * BAND * width + i;
                if let Some(point) = &field.points[pixel] {
                    *out = field.mean(point, [pixel % width, pixel / width]).unwrap_or(*out);
                }
            }
        });
        field.open = smooth;
        field
    }

    /// The mean over the pixels around one that show the same piece of surface.
    fn mean(&self, point: &Point, [x, y]: [usize; 2]) -> Option<Open> {
        let around = |c: usize, n: usize| c.saturating_sub(TILE / 2)..(c + TILE / 2).min(n);
        let near = around(y, self.height).flat_map(|j| around(x, self.width).map(move |i| (i, j)));
        self.average(near.map(|(i, j)| (j * self.width + i, 1.0)), point)
    }

    /// The light at a point that is seen at the pixel coordinates (x, y); `None` if no pixel near it shows its surface.
    pub fn at(&self, [x, y]: [f64; 2], point: &Point) -> Option<Open> {
        let [x, y] = [x - 0.5, y - 0.5];
        let [i, j] = [x.floor(), y.floor()];
        let tap = |(di, dj): (f64, f64)| {
            let [i, j] = [i + di, j + dj];
            let inside = i >= 0.0 && j >= 0.0 && i < self.width as f64 && j < self.height as f64;
            let weight = (1.0 - (x - i).abs()) * (1.0 - (y - j).abs());
            inside.then(|| (j as usize * self.width + i as usize, weight + 1e-3))
        };
        let taps = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)];
        self.average(taps.into_iter().filter_map(tap), point)
    }

    fn average(&self, taps: impl Iterator<Item = (usize, f64)>, point: &Point) -> Option<Open> {
        let (mut sky, mut key, mut total) = (0.0, 0.0, 0.0);
        for (pixel, weight) in taps {
            if self.points[pixel].as_ref().is_some_and(|p| p.neighbours(point)) {
                sky += weight * self.open[pixel].sky;
                key += weight * self.open[pixel].key;
                total += weight;
            }
        }
        (total > 0.0).then(|| Open { sky: sky / total, key: key / total })
    }
}

impl Point {
    /// Whether two points a few pixels apart lie on the same smooth piece of surface.
    fn neighbours(&self, other: &Point) -> bool {
        let apart = sub(self.xyz, other.xyz);
        let off = dot(apart, self.normal).abs().min(dot(apart, other.normal).abs());
        self.on_ground == other.on_ground
            && (self.on_ground || off < 2.5 && dot(self.normal, other.normal) > 0.85)
    }
}
