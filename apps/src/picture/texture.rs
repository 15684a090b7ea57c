//! Patterns of a layout, filtered to the pixel: checks, and circles that show that the map is conformal.

use clap::ValueEnum;
use ricci::geometry::complex::doubled_area;
use serde::Serialize;
use std::collections::BTreeMap;

/// The pattern of a layout.
#[derive(ValueEnum, Serialize, Debug, Clone, Copy, PartialEq)]
#[serde(rename_all = "lowercase")]
pub enum TextureChoice {
    Checker,
    Circles,
    None,
}

/// Checks along the square root of the surface's area.
const CHECKS: f64 = 26.0;
/// Distance of the centres of two circles that touch, in checks.
pub const CIRCLE_SPACING: f64 = 1.6;
/// With bands: where a layout's scale varies by more than this factor, the pattern is made finer or coarser by it, so that it stays of
/// visible size on the whole surface, nested into itself.
pub const OCTAVE: f64 = 8.0;
/// Patterns with a period below the first number of pixels are faded to their mean, above the second not at all.
const FADE: [f64; 2] = [0.85, 1.6];
/// Width over which checks are averaged, pixels.
const FILTER: f64 = 1.1;
/// Radii of a circle's outer and inner edge and of the dot at its centre, over the circles' distance.
pub const RING: [f64; 3] = [0.47, 0.36, 0.11];

/// The pattern on one triangle of a panel.
pub struct TexturePatch {
    texture: TextureChoice,
    /// Pattern coordinates of the corners at level 0, in periods.
    uv: [[f64; 2]; 3],
    /// Their derivatives by x and y on the panel: `[du/dx, du/dy], [dv/dx, dv/dy]`.
    slope: [[f64; 2]; 2],
    /// Logarithm to base [`OCTAVE`] of the layout's scale at the corners, 0 at its median.
    level: [f64; 3],
    /// 1: full contrast, 0: the mean.
    contrast: f64,
}

impl TexturePatch {
    /// `uv`: layout coordinates of face `f`; `pixels`: the triangle on the panel.
    pub fn new(
        texture: TextureChoice,
        uv: [[f64; 2]; 3],
        tiles: &Tiles,
        f: usize,
        pixels: [[f64; 2]; 3],
    ) -> TexturePatch {
        let period = tiles.size * if texture == TextureChoice::Circles { CIRCLE_SPACING } else { 1.0 };
        let uv = uv.map(|p| p.map(|x| x / period));
        let area = doubled_area(pixels);
        let slope = [0, 1].map(|k| {
            let [a, b] = [1, 2].map(|i| uv[i][k] - uv[0][k]);
            let [p, q] = [1, 2].map(|i| [pixels[i][0] - pixels[0][0], pixels[i][1] - pixels[0][1]]);
            [(a * q[1] - b * p[1]) / area, (b * p[0] - a * q[0]) / area]
        });
        let level = tiles.level[f];
        let zoom = OCTAVE.powf(-((level[0] + level[1] + level[2]) / 3.0).round());
        let steepest = slope.iter().map(|s| s[0].hypot(s[1])).fold(0.0, f64::max);
        let pixels = 1.0 / (steepest * zoom);
        let contrast = ((pixels - FADE[0]) / (FADE[1] - FADE[0])).clamp(0.0, 1.0);
        TexturePatch { texture, uv, slope, level, contrast: if contrast.is_nan() { 0.0 } else { contrast } }
    }

    /// From 0 (ground) to 1 (pattern) at barycentric coordinates.
    pub fn value(&self, b: [f64; 3]) -> f64 {
        let level = (b[0] * self.level[0] + b[1] * self.level[1] + b[2] * self.level[2]).round();
        let zoom = OCTAVE.powf(-level);
        let at = [0, 1].map(|k| zoom * (b[0] * self.uv[0][k] + b[1] * self.uv[1][k] + b[2] * self.uv[2][k]));
        let slope = self.slope.map(|s| s.map(|x| x * zoom));
        let value = match self.texture {
            TextureChoice::Checker => checker(at, slope),
            TextureChoice::Circles => circles(at, slope),
            TextureChoice::None => 0.0,
        };
        let mean = self.texture.mean();
        if value.is_nan() { mean } else { mean + self.contrast * (value - mean) }
    }
}

/// Checks of side 1, averaged over a box.
fn checker(at: [f64; 2], slope: [[f64; 2]; 2]) -> f64 {
    // The square wave that is 1 in even intervals and −1 in odd ones has this integral.
    let integral = |x: f64| 1.0 - (x.rem_euclid(2.0) - 1.0).abs();
    let mean = |k: usize| {
        let width = FILTER * (slope[k][0].abs() + slope[k][1].abs()).max(1e-12);
        (integral(at[k] + 0.5 * width) - integral(at[k] - 0.5 * width)) / width
    };
    0.5 - 0.5 * mean(0) * mean(1)
}

/// Rings with a dot at their centre, around the points of a triangular lattice of distance 1.
fn circles(at: [f64; 2], slope: [[f64; 2]; 2]) -> f64 {
    let height = 0.75f64.sqrt();
    let row = (at[1] / height).floor();
    let off = |row: f64| {
        let shift = 0.5 * row.rem_euclid(2.0);
        let x = at[0] - shift;
        [x - x.round(), at[1] - row * height]
    };
    let [p, q] = [off(row), off(row + 1.0)];
    let nearest = if p[0].hypot(p[1]) <= q[0].hypot(q[1]) { p } else { q };
    let distance = nearest[0].hypot(nearest[1]);
    let outward = nearest.map(|x| x / distance.max(1e-12));
    // The growth of the distance per pixel.
    let rate = [0, 1].map(|k| outward[0] * slope[0][k] + outward[1] * slope[1][k]);
    let rate = rate[0].hypot(rate[1]).max(1e-12);
    let within = |radius: f64| ((radius - distance) / rate + 0.5).clamp(0.0, 1.0);
    within(RING[0]) - within(RING[1]) + within(RING[2])
}

impl TextureChoice {
    /// The share of the plane that is dark.
    pub fn mean(self) -> f64 {
        let [outer, inner, dot] = RING.map(|r| r * r);
        match self {
            TextureChoice::Checker => 0.5,
            TextureChoice::Circles => std::f64::consts::PI * (outer - inner + dot) / 0.75f64.sqrt(),
            TextureChoice::None => 0.0,
        }
    }
}

/// The size of the pattern, which is the same on the surface and in the layout.
pub struct Tiles {
    /// Side of a check at the median scale, in the layout.
    pub size: f64,
    /// Per face and corner: logarithm to base [`OCTAVE`] of the layout's scale over the median.
    pub level: Vec<[f64; 3]>,
}

impl Tiles {
    /// From the areas of the faces on the surface and in the layout; `faces` over `n` vertices joins the corners.
    pub fn new(surface: &[f64], layout: &[f64], faces: &[[u32; 3]], n: usize) -> Tiles {
        let scale = |(s, l): (&f64, &f64)| (l / s).sqrt();
        let mut order: Vec<(f64, f64)> =
            surface.iter().zip(layout).map(|(s, l)| (scale((s, l)), *s)).collect();
        order.retain(|(x, s)| x.is_finite() && *x > 0.0 && s.is_finite());
        order.sort_by(|a, b| a.0.total_cmp(&b.0));
        let total: f64 = order.iter().map(|(_, s)| s).sum();
        let mut sum = 0.0;
        let middle = order.iter().find(|(_, s)| {
            sum += s;
            2.0 * sum >= total
        });
        let median = middle.map_or(1.0, |m| m.0);
        let size = median * total.max(f64::MIN_POSITIVE).sqrt() / CHECKS;
        // Averaged over the faces at each vertex, so that levels change along smooth lines.
        let mut mean = vec![(0.0, 0.0); n];
        for (face, pair) in faces.iter().zip(surface.iter().zip(layout)) {
            let x = scale(pair);
            if x.is_finite() && x > 0.0 {
                for v in face {
                    mean[*v as usize].0 += (x / median).log(OCTAVE);
                    mean[*v as usize].1 += 1.0;
                }
            }
        }
        let level = |v: u32| mean[v as usize].0 / f64::max(mean[v as usize].1, 1.0);
        Tiles { size, level: faces.iter().map(|f| f.map(level)).collect() }
    }

    /// Checks of one size on as many faces.
    pub fn even(size: f64, n_faces: usize) -> Tiles {
        Tiles { size, level: vec![[0.0; 3]; n_faces] }
    }

    /// The triangles with each rounded level.
    pub fn levels(&self, uv: &[[[f64; 2]; 3]]) -> Vec<(i32, Vec<[[f64; 2]; 3]>)> {
        let mut levels: BTreeMap<i32, Vec<_>> = BTreeMap::new();
        for (corners, level) in uv.iter().zip(&self.level) {
            levels.entry((level.iter().sum::<f64>() / 3.0).round() as i32).or_default().push(*corners);
        }
        levels.into_iter().collect()
    }

    /// The same pattern with or without its steps in size.
    pub fn banded(mut self, bands: bool) -> Tiles {
        if !bands {
            self.level.fill([0.0; 3]);
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PIXELS: [[f64; 2]; 3] = [[0.0, 0.0], [100.0, 0.0], [0.0, 100.0]];

    fn tiles(size: f64) -> Tiles {
        Tiles { size, level: vec![[0.0; 3]] }
    }

    #[test]
    fn patterns_finer_than_a_pixel_fade_to_their_mean() {
        let patch = |texture, size| TexturePatch::new(texture, PIXELS, &tiles(size), 0, PIXELS);
        let at = [0.31, 0.305, 0.385];
        assert_eq!(patch(TextureChoice::Checker, 0.5).value(at), 0.5);
        assert_eq!(patch(TextureChoice::Circles, 0.5).value(at), TextureChoice::Circles.mean());
        let full = patch(TextureChoice::Checker, 50.0).value(at);
        assert!(full.min(1.0 - full).abs() < 1e-12, "{full}");
        // The mean is that of the pattern.
        for texture in [TextureChoice::Checker, TextureChoice::Circles] {
            let patch = patch(texture, 5.0);
            let n = 600;
            let points = (0..n).flat_map(|i| (0..n - i).map(move |j| (i as f64 + 0.3, j as f64 + 0.3)));
            let points = points.map(|(i, j)| [i, j, n as f64 - i - j].map(|x| x / n as f64));
            let values: Vec<f64> = points.map(|b| patch.value(b)).collect();
            let mean = values.iter().sum::<f64>() / values.len() as f64;
            let expected = texture.mean();
            assert!((mean - expected).abs() < 0.02, "{texture:?}: {mean} of {expected}");
        }
    }

    #[test]
    fn checks_average_exactly() {
        // A box two checks wide holds as much of either.
        let wide = [[2.0 / FILTER, 0.0], [0.0, 1e-9]];
        for x in [0.0, 0.3, 0.77] {
            assert!((checker([x, 0.4], wide) - 0.5).abs() < 1e-9);
        }
        // At an edge half.
        assert!((checker([1.0, 0.4], [[0.1, 0.0], [0.0, 0.1]]) - 0.5).abs() < 1e-9);
    }

    #[test]
    fn circles_are_round_under_rotation_and_ovals_under_shear() {
        // The edge of the ring at (0, 0) lies at the same distance in every direction of the layout.
        let fine = [[1e-6, 0.0], [0.0, 1e-6]];
        for k in 0..36 {
            let (sin, cos) = (k as f64 * 0.1745).sin_cos();
            let at = |r: f64| circles([r * cos, r * sin], fine);
            assert_eq!(
                [at(0.05), at(0.2), at(0.355), at(0.365), at(0.46), at(0.475)],
                [1.0, 0.0, 0.0, 1.0, 1.0, 0.0]
            );
        }
        // The edge is one pixel wide on the panel, however the layout is stretched there.
        let stretched = [[0.01, 0.0], [0.0, 0.04]];
        assert!((circles([0.47 + 0.0025, 0.0], stretched) - 0.25).abs() < 1e-9);
        assert!((circles([0.0, 0.47 + 0.01], stretched) - 0.25).abs() < 1e-9);
    }

    #[test]
    fn levels_count_octaves_of_eight_from_the_median_scale() {
        let faces: Vec<[u32; 3]> = (0..5).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]).collect();
        let tiles = Tiles::new(&[1.0; 5], &[1.0, 1.0, 1.0, 64.0, 64.0 * 64.0], &faces, 15);
        assert!((tiles.level[3][0] - 1.0).abs() < 1e-12 && (tiles.level[4][2] - 2.0).abs() < 1e-12);
    }
}
