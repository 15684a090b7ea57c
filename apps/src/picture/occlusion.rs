//! How much of the sky and of the key light a point sees past the surface, by depth maps: the surface as each of many small lights
//! sees it.
//!
//! Each pixel asks a few lights, sixteen different sets of them in every square of 4 × 4 pixels; the mean over such a
//! square of neighbours on the same piece of surface then counts all sets once (interleaved sampling, \[KH01\]).

use super::raster::{Hit, Samples, Shape, bands, doubled_area, in_parallel};
use super::vector::{V3, add, at, bounding_ball, complement, dot, norm, normal, scaled, sphere_point, sub};

/// Lights of the sky and of the key light that one pixel asks: 64 and 16 in all, of which single ones cannot be told apart on a
/// surface once the mean is taken.
const SKY_LIGHTS: usize = 4;
const KEY_LIGHTS: usize = 1;
/// Pixels per side of the squares that share all lights.
const TILE: usize = 4;
const SETS: usize = TILE * TILE;
/// Angular radius of the key light, radians: the softness of its shadows.
const KEY_RADIUS: f64 = 0.16;
/// Pixels on the side of a depth map, of the sky and of the key light, whose shadows have edges.
const SKY_MAP: usize = 224;
const KEY_MAP: usize = 448;
/// A point is lifted off the surface by this many pixels of a map, so that the map's steps do not hide it from itself.
const LIFT: f64 = 1.6;
/// Area vectors of a closed surface, all faces the same way round, add up to less than this share of its area.
const CLOSED: f64 = 1e-6;
/// Squares of pixels to each side over which light on the ground is averaged, where nothing hides the steps of the maps.
const SOFT: usize = 3;
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

/// Light that some lights give to a point and would give without the surface: of the sky, and of the key light.
#[derive(Clone, Copy, Debug, Default)]
struct Light {
    sky: [f64; 2],
    key: [f64; 2],
}

impl Light {
    fn add(&mut self, other: &Light, weight: f64) {
        for k in 0..2 {
            self.sky[k] += weight * other.sky[k];
            self.key[k] += weight * other.key[k];
        }
    }

    fn open(&self) -> Open {
        let share = |[seen, all]: [f64; 2], none: f64| if all > 0.0 { seen / all } else { none };
        Open { sky: share(self.sky, 1.0), key: share(self.key, 0.0) }
    }
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

/// The surface as a light far away sees it: how near to the light it is.
struct DepthMap {
    /// To the right and up on the map, and towards the light.
    axes: [V3; 3],
    centre: V3,
    /// Pixels of the map per unit.
    scale: f64,
    size: usize,
    depth: Vec<f32>,
}

impl DepthMap {
    /// `points`: within `radius` of `centre`; `inside`: of [`enclosed`].
    fn new(
        (points, faces, inside): (&[V3], &[[u32; 3]], f64),
        towards: V3,
        (centre, radius): (V3, f64),
        size: usize,
    ) -> DepthMap {
        let [a, b] = complement(towards);
        let scale = 0.5 * (size as f64 - 2.0) / radius;
        let map = DepthMap { axes: [a, b, towards], centre, scale, size, depth: Vec::new() };
        let seen: Vec<V3> = points.iter().map(|p| map.place(*p)).collect();
        let mut samples = Samples::new(&[], &[], [size, 0, size], 1);
        for corners in faces.iter().map(|f| f.map(|v| seen[v as usize])) {
            // The far side of a solid is hidden by its near side.
            if doubled_area(corners.map(|p| [p[0], p[1]])) * inside >= 0.0 {
                samples.triangle(corners, 0);
            }
        }
        DepthMap { depth: samples.depth, ..map }
    }

    fn place(&self, p: V3) -> V3 {
        let [x, y, z] = self.axes.map(|axis| dot(axis, sub(p, self.centre)));
        let middle = 0.5 * self.size as f64;
        [middle + self.scale * x, middle + self.scale * y, self.scale * z]
    }

    /// Whether the light sees a point.
    fn sees(&self, point: &Point) -> bool {
        let [x, y, z] = self.place(add(point.xyz, scaled(point.flat, LIFT / self.scale)));
        let inside = |c: f64| c >= 0.0 && c < self.size as f64;
        !(inside(x) && inside(y)) || f64::from(self.depth[y as usize * self.size + x as usize]) <= z
    }
}

/// A surface that casts shadows.
pub struct Caster {
    /// The lights of set k are those whose number leaves the remainder k.
    sky: Vec<DepthMap>,
    key: Vec<DepthMap>,
    towards_key: V3,
}

impl Caster {
    /// `key`: unit vector towards the key light.
    pub fn new(points: &[V3], faces: &[[u32; 3]], key: V3, threads: usize) -> Caster {
        let (ball, surface) = (bounding_ball(points), (points, faces, enclosed(points, faces)));
        let [a, b] = complement(key);
        let around_key = |i: usize| {
            let [p, q] = disk_point(i).map(|x| x * KEY_RADIUS);
            let towards = add(key, add(scaled(a, p), scaled(b, q)));
            scaled(towards, 1.0 / dot(towards, towards).sqrt())
        };
        let lights = (0..SKY_LIGHTS * SETS).map(|i| (sphere_point(i, SKY_LIGHTS * SETS), SKY_MAP));
        let lights = lights.chain((0..KEY_LIGHTS * SETS).map(|i| (around_key(i), KEY_MAP)));
        let mut maps: Vec<_> = lights.map(|light| (light, None)).collect();
        in_parallel(maps.iter_mut().collect(), threads, |_, ((towards, size), map)| {
            *map = Some(DepthMap::new(surface, *towards, ball, *size));
        });
        let mut maps = maps.into_iter().filter_map(|(_, map)| map);
        let sky = maps.by_ref().take(SKY_LIGHTS * SETS).collect();
        Caster { sky, key: maps.collect(), towards_key: key }
    }

    /// What some lights of the sky and of the key light give to a point.
    fn light<'a>(
        &self,
        point: &Point,
        sky: impl Iterator<Item = &'a DepthMap>,
        key: impl Iterator<Item = &'a DepthMap>,
    ) -> Light {
        let mut light = Light::default();
        // A light below the face itself says nothing about what is above it.
        for map in sky.filter(|map| dot(map.axes[2], point.flat) > 0.0) {
            let weight = dot(map.axes[2], point.normal).max(0.0);
            light.sky[0] += if map.sees(point) { weight } else { 0.0 };
            light.sky[1] += weight;
        }
        for map in key {
            let lit = dot(self.towards_key, point.normal) > 0.0 && map.sees(point);
            light.key[0] += f64::from(u8::from(lit));
            light.key[1] += 1.0;
        }
        light
    }

    /// The light of one set, or of all, that reaches a point.
    fn of_set(&self, point: &Point, set: usize) -> Light {
        let (sky, key) = (self.sky.iter(), self.key.iter());
        self.light(point, sky.skip(set).step_by(SETS), key.skip(set).step_by(SETS))
    }

    /// The shares of all lights that reach a point.
    pub fn open(&self, point: &Point) -> Open {
        self.light(point, self.sky.iter(), self.key.iter()).open()
    }
}

/// What a closed surface encloses, six times its volume, negative where its faces are clockwise from outside; 0 of others.
fn enclosed(points: &[V3], faces: &[[u32; 3]]) -> f64 {
    let (mut sum, mut size, mut volume) = ([0.0; 3], 0.0, 0.0);
    for corners in faces.iter().map(|f| f.map(|v| points[v as usize])) {
        let n = normal(corners);
        (sum, size, volume) = (add(sum, n), size + norm(n), volume + dot(corners[0], n));
    }
    if border(faces).is_empty() && norm(sum) <= CLOSED * size { volume } else { 0.0 }
}

/// The edges of exactly one face.
pub fn border(faces: &[[u32; 3]]) -> Vec<(u32, u32)> {
    let sides = faces.iter().flat_map(|f| [0, 1, 2].map(|k| (f[k], f[(k + 1) % 3])));
    let mut edges: Vec<(u32, u32)> = sides.map(|(a, b)| (a.min(b), a.max(b))).collect();
    edges.sort_unstable();
    let alone = |run: &[(u32, u32)]| (run.len() == 1).then(|| run[0]);
    edges.chunk_by(|a, b| a == b).filter_map(alone).collect()
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
    light: Vec<Light>,
}

impl Field {
    /// `describe` names the point that a pixel shows, given the face and the barycentric coordinates, or nothing.
    pub fn new(
        caster: &Caster,
        shapes: &[Shape],
        [width, height]: [usize; 2],
        threads: usize,
        describe: impl Fn([f64; 2], Option<&Hit>) -> Option<Point> + Sync,
    ) -> Field {
        let mut points = vec![None; width * height];
        let mut raw = vec![Light::default(); width * height];
        let rows = (width * BAND).max(1);
        let in_band = bands(shapes, height, BAND);
        let work: Vec<_> = points.chunks_mut(rows).zip(raw.chunks_mut(rows)).collect();
        in_parallel(work, threads, |band, (points, raw)| {
            let first = band * BAND;
            let samples = Samples::new(shapes, &in_band[band], [width, first, points.len() / width], 1);
            for (i, (point, raw)) in points.iter_mut().zip(raw).enumerate() {
                let (x, y) = (i % width, i / width);
                let pixel = [x as f64 + 0.5, (first + y) as f64 + 0.5];
                *point = describe(pixel, samples.hit(shapes, x, y, pixel).as_ref());
                if let Some(point) = point {
                    *raw = caster.of_set(point, (first + y) % TILE * TILE + x % TILE);
                }
            }
        });
        let mut field = Field { width, height, points, light: raw };
        let near = |c: usize| (c.saturating_sub(TILE / 2)..c + TILE / 2).collect();
        field.average(threads, |_| true, near);
        // On the ground the shadows of single lights would be told apart: there the mean is taken over more pixels.
        let far = |c: usize| (0..=2 * SOFT).map(|k| (c + TILE * k).saturating_sub(TILE * SOFT)).collect();
        field.average(threads, |point| point.on_ground, far);
        field
    }

    /// Give the points that are chosen the mean over pixels around theirs that show the same piece of surface: those of the rows and of the
    /// columns that are named for the pixel's own.
    fn average(
        &mut self,
        threads: usize,
        chosen: impl Fn(&Point) -> bool + Sync,
        around: impl Fn(usize) -> Vec<usize>,
    ) {
        let (mut means, field) = (self.light.clone(), &*self);
        let table = |n: usize| -> Vec<Vec<usize>> {
            let within = |c| around(c).into_iter().map(|i| i.min(n - 1)).collect();
            (0..n).map(within).collect()
        };
        let (columns, rows) = (table(field.width), table(field.height));
        in_parallel(means.chunks_mut(field.width.max(1)).collect(), threads, |y, out| {
            for (x, out) in out.iter_mut().enumerate() {
                if let Some(point) = field.points[y * field.width + x].as_ref().filter(|p| chosen(p)) {
                    let near = rows[y].iter().flat_map(|j| columns[x].iter().map(move |i| (j, i)));
                    *out = field.sum(near.map(|(j, i)| (j * field.width + i, 1.0)), point).0;
                }
            }
        });
        self.light = means;
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
        let (light, total) = self.sum(taps.into_iter().filter_map(tap), point);
        (total > 0.0).then(|| light.open())
    }

    /// The weighted sum over pixels that show the piece of surface on which a point lies, and of the weights.
    fn sum(&self, taps: impl Iterator<Item = (usize, f64)>, point: &Point) -> (Light, f64) {
        let (mut light, mut total) = (Light::default(), 0.0);
        for (pixel, weight) in taps {
            if self.points[pixel].as_ref().is_some_and(|p| p.neighbours(point)) {
                light.add(&self.light[pixel], weight);
                total += weight;
            }
        }
        (light, total)
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
