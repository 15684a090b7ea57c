//! Shadows: the shares of the sky's light and of the key light that reach a point past the surface. They are found by depth maps, the surface
//! as each of many small lights sees it, at every second pixel of every second row. Pixels between take the mean of their neighbours on the
//! same piece of surface.

use super::raster::{DrawnShape, Hit, Samples, scan};
use super::vector::{V3, add, at, bounding_ball, complement, dot, scaled, sphere_point, sub};
use ricci::parallel::{each, map};

/// Numbers of lights that stand for the sky, half of them opposite to the others, and for the key light: so many that their single shadows
/// are not visible.
const SKY_LIGHTS: usize = 64;
const KEY_LIGHTS: usize = 16;
/// The lights of the key light lie as close together as this many lights on the whole sphere, so that its angular radius, and with it the
/// softness of its shadows, is 0.16.
const KEY_SPHERE: usize = 2500;
/// Pixels on the side of a depth map of the sky, and of one of the key light, whose shadows have sharper edges.
const SKY_MAP: usize = 224;
const KEY_MAP: usize = 448;
/// A point is lifted off the surface by this many pixels of a map, so that the map's steps do not hide it from itself.
const LIFT: f64 = 1.6;
/// Number of points per pixel side at which light is found.
const DENSITY: f64 = 0.5;
/// Light on the ground is averaged over this many of these points to each side, every other one, so that shadows of single lights are not
/// visible there either.
const SOFT: usize = 3;

/// Shares of the light that arrive, in [0, 1].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReceivedLight {
    pub sky: f64,
    pub key: f64,
}

impl ReceivedLight {
    pub const FULLY: ReceivedLight = ReceivedLight { sky: 1.0, key: 1.0 };
}

/// A visible point, in pixel coordinates.
#[derive(Clone, Copy)]
pub struct SeenPoint {
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
    pub fn below(&self, [x, y]: [f64; 2]) -> SeenPoint {
        let z = (self.level - self.up[0] * x - self.up[1] * y) / self.up[2];
        SeenPoint { xyz: [x, y, z], normal: self.up, flat: self.up, on_ground: true }
    }
}

/// The surface as two distant lights on opposite sides see it.
struct DepthMap {
    /// Unit vector towards the first light.
    towards: V3,
    /// The axes of the map, to the right, up and towards the first light, in pixels of the map.
    axes: [V3; 3],
    origin: V3,
    /// Pixels of the map per unit.
    scale: f64,
    size: usize,
    /// Per pixel of the map, the depths that are nearest to the first light and to the second.
    depth: Vec<[f32; 2]>,
}

impl DepthMap {
    /// `ball`: a centre and a radius that hold all points.
    fn new(points: &[V3], faces: &[[u32; 3]], towards: V3, ball: (V3, f64), size: usize) -> DepthMap {
        let ([a, b], (centre, radius)) = (complement(towards), ball);
        let scale = 0.5 * (size as f64 - 2.0) / radius;
        let axes = [a, b, towards].map(|axis| scaled(axis, scale));
        let middle = 0.5 * size as f64;
        let origin = [0, 1, 2].map(|k| [middle, middle, 0.0][k] - dot(axes[k], centre));
        let depth = vec![[f32::NEG_INFINITY, f32::INFINITY]; size * size];
        let mut map = DepthMap { towards, axes, origin, scale, size, depth };
        let seen: Vec<V3> = points.iter().map(|p| map.place(*p)).collect();
        for face in faces {
            scan(face.map(|v| seen[v as usize]), [size, size], |at, z| {
                let [first, second] = &mut map.depth[at];
                (*first, *second) = (first.max(z as f32), second.min(z as f32));
            });
        }
        map
    }

    fn place(&self, p: V3) -> V3 {
        [0, 1, 2].map(|k| dot(self.axes[k], p) + self.origin[k])
    }

    /// True if the first light, or else the second, sees a point.
    fn sees(&self, point: &SeenPoint, is_first: bool) -> bool {
        let [x, y, z] = self.place(add(point.xyz, scaled(point.flat, LIFT / self.scale)));
        let [x, y] = [x + 0.5, y + 0.5];
        let inside = |c: f64| c >= 0.0 && c < self.size as f64;
        if !(inside(x) && inside(y)) {
            return true;
        }
        let [first, second] = self.depth[y as usize * self.size + x as usize].map(f64::from);
        if is_first { first <= z } else { z <= second }
    }
}

/// A surface that casts shadows.
pub struct ShadowCaster {
    sky: Vec<DepthMap>,
    key: Vec<DepthMap>,
    towards_key: V3,
}

impl ShadowCaster {
    /// `key`: unit vector towards the key light.
    pub fn new(points: &[V3], faces: &[[u32; 3]], key: V3) -> ShadowCaster {
        let (ball, [a, b]) = (bounding_ball(points), complement(key));
        let around_key = |i: usize| {
            let [x, y, z] = sphere_point(i, KEY_SPHERE);
            add(scaled(key, z), add(scaled(a, x), scaled(b, y)))
        };
        let depth = |towards: V3, size: usize| DepthMap::new(points, faces, towards, ball, size);
        let sky = map(SKY_LIGHTS / 2, |i| depth(sphere_point(i, SKY_LIGHTS), SKY_MAP));
        let key_maps = map(KEY_LIGHTS, |i| depth(around_key(i), KEY_MAP));
        ShadowCaster { sky, key: key_maps, towards_key: key }
    }

    /// The shares of the light that reach a point.
    pub fn open(&self, point: &SeenPoint) -> ReceivedLight {
        let (mut seen, mut all) = (0.0, 0.0);
        for map in &self.sky {
            // Of two opposite lights one is behind the face itself, and is left out.
            let is_first = dot(map.towards, point.flat) > 0.0;
            let weight = dot(map.towards, point.normal) * if is_first { 1.0 } else { -1.0 };
            seen += if map.sees(point, is_first) { weight.max(0.0) } else { 0.0 };
            all += weight.max(0.0);
        }
        let faces_key = dot(self.towards_key, point.normal) > 0.0;
        let lit = self.key.iter().filter(|map| faces_key && map.sees(point, true)).count();
        ReceivedLight { sky: if all > 0.0 { seen / all } else { 1.0 }, key: lit as f64 / KEY_LIGHTS as f64 }
    }
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

/// The light at every second pixel of every second row of a picture.
pub struct LightField {
    width: usize,
    /// The visible points there, if there are any, with their light.
    seen: Vec<Option<(SeenPoint, ReceivedLight)>>,
}

impl LightField {
    /// `describe`: the point that a pixel shows, from the face and the barycentric coordinates there, or none.
    pub fn new(
        caster: &ShadowCaster,
        shapes: &[DrawnShape],
        [width, height]: [usize; 2],
        describe: impl Fn([f64; 2], Option<&Hit>) -> Option<SeenPoint> + Sync,
    ) -> LightField {
        let samples = Samples::new(shapes, [width, 0, height], DENSITY);
        let mut field = LightField { width: samples.width, seen: vec![None; samples.len()] };
        each(field.seen.chunks_mut(field.width.max(1)).enumerate().collect(), |(row, out)| {
            for (out, (at, hit)) in out.iter_mut().zip(samples.row(shapes, row)) {
                *out = describe(at, hit.as_ref()).map(|point| (point, caster.open(&point)));
            }
        });
        field.soften();
        field
    }

    /// Give points on the ground the mean over those around them.
    fn soften(&mut self) {
        let (mut means, height) = (self.seen.clone(), self.seen.len() / self.width.max(1));
        let near =
            |c: usize, n: usize| (0..=2 * SOFT).map(move |k| (c + 2 * k).saturating_sub(2 * SOFT).min(n - 1));
        each(means.chunks_mut(self.width.max(1)).enumerate().collect(), |(y, out)| {
            for (x, (point, open)) in out.iter_mut().enumerate().filter_map(|(x, p)| Some((x, p.as_mut()?))) {
                if point.on_ground {
                    let taps = near(y, height).flat_map(|j| near(x, self.width).map(move |i| (j, i)));
                    *open = self.mean(taps.map(|(j, i)| (j * self.width + i, 1.0)), point).unwrap_or(*open);
                }
            }
        });
        self.seen = means;
    }

    /// The light at a point that is seen at the pixel coordinates (x, y); `None` if no pixel near it shows its surface.
    pub fn at(&self, [x, y]: [f64; 2], point: &SeenPoint) -> Option<ReceivedLight> {
        let [x, y] = [x, y].map(|c| c * DENSITY - 0.5);
        let [i, j] = [x.floor(), y.floor()];
        let tap = |(di, dj): (f64, f64)| {
            let [i, j] = [i + di, j + dj];
            let weight = (1.0 - (x - i).abs()) * (1.0 - (y - j).abs());
            (i >= 0.0 && j >= 0.0 && i < self.width as f64)
                .then(|| (j as usize * self.width + i as usize, weight + 1e-3))
        };
        let taps = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)];
        self.mean(taps.into_iter().filter_map(tap), point)
    }

    /// The weighted mean over pixels that show the piece of surface on which a point lies.
    fn mean(&self, taps: impl Iterator<Item = (usize, f64)>, point: &SeenPoint) -> Option<ReceivedLight> {
        let (mut open, mut total) = (ReceivedLight { sky: 0.0, key: 0.0 }, 0.0);
        for (pixel, weight) in taps {
            let near = self.seen.get(pixel).and_then(Option::as_ref);
            if let Some((_, light)) = near.filter(|(other, _)| other.neighbours(point)) {
                open =
                    ReceivedLight { sky: open.sky + weight * light.sky, key: open.key + weight * light.key };
                total += weight;
            }
        }
        (total > 0.0).then(|| ReceivedLight { sky: open.sky / total, key: open.key / total })
    }
}

impl SeenPoint {
    /// True if two points a few pixels apart lie on the same smooth piece of surface.
    fn neighbours(&self, other: &SeenPoint) -> bool {
        let apart = sub(self.xyz, other.xyz);
        let off = dot(apart, self.normal).abs().min(dot(apart, other.normal).abs());
        self.on_ground == other.on_ground
            && (self.on_ground || off < 2.5 && dot(self.normal, other.normal) > 0.85)
    }
}
