//! The map from the coordinates of a drawing to the pixels of its panel.

use super::vector::ends;

/// Share of the panel's side left free on each side.
pub const MARGIN: f64 = 0.03;

/// A map onto a panel that ends a margin beyond the drawing: equal scales, y up in the drawing and down in pixels.
#[derive(Clone, Copy, Debug)]
pub struct Fit {
    /// Pixels per unit.
    pub scale: f64,
    offset: [f64; 2],
    /// The panel in pixels.
    pub width: usize,
    pub height: usize,
}

impl Fit {
    /// The longer side of the points' bounding box spans a panel of `size` pixels less its margins.
    pub fn new(points: impl Iterator<Item = [f64; 2]>, size: usize) -> Fit {
        let points: Vec<[f64; 2]> = points.filter(|p| p.iter().all(|x| x.is_finite())).collect();
        let sides = [0, 1].map(|k| ends(points.iter().map(|p| p[k])));
        let [[left, right], [bottom, top]] = if points.is_empty() { [[0.0, 1.0]; 2] } else { sides };
        let extent = [right - left, top - bottom];
        let longest = extent[0].max(extent[1]).max(f64::MIN_POSITIVE);
        let margin = size as f64 * MARGIN;
        let scale = (size as f64 - 2.0 * margin) / longest;
        let pixels = |e: f64| ((scale * e + 2.0 * margin).ceil() as usize).clamp(1, size.max(1));
        let [width, height] = extent.map(pixels);
        let offset = [
            0.5 * width as f64 - scale * 0.5 * (left + right),
            0.5 * height as f64 + scale * 0.5 * (bottom + top),
        ];
        Fit { scale, offset, width, height }
    }

    /// The square around a point. `radius`: half its side.
    pub fn around(at: [f64; 2], radius: f64, size: usize) -> Fit {
        Fit::new([-radius, radius].map(|r| at.map(|x| x + r)).into_iter(), size)
    }

    /// The point of the drawing at a pixel.
    pub fn invert(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [(x - self.offset[0]) / self.scale, (self.offset[1] - y) / self.scale]
    }

    /// Pixel coordinates, y down.
    pub fn apply(&self, p: [f64; 2]) -> [f64; 2] {
        [self.scale * p[0] + self.offset[0], self.offset[1] - self.scale * p[1]]
    }
}
