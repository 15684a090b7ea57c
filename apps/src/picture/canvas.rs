//! A panel to draw on in the coordinates of a drawing. Parts of the drawing beyond the panel are left out.

use super::Style;
use super::coat::wire_width;
use super::color::Rgb;
use super::fit::Fit;
use super::region::{Polyline, chains, once};
use super::sheet::{SvgPath, VectorSheet, paths};
use ricci::geometry::clip::{in_box, segment_in_box};

/// Pixels beyond the panel up to which something is drawn, so that the ends of lines do not show.
const BEYOND: f64 = 20.0;

/// A panel of vectors, and the map from the drawing's coordinates to its pixels.
pub struct PanelCanvas<'a> {
    pub sheet: VectorSheet,
    pub fit: Fit,
    pub style: &'a Style,
    /// The rectangle that is drawn, in the drawing's coordinates.
    panel: [[f64; 2]; 2],
}

impl<'a> PanelCanvas<'a> {
    pub fn new(fit: Fit, style: &'a Style) -> PanelCanvas<'a> {
        let [width, height] = [fit.width as f64, fit.height as f64];
        let [low, high] =
            [[-BEYOND, height + BEYOND], [width + BEYOND, -BEYOND]].map(|pixel| fit.invert(pixel));
        PanelCanvas { sheet: VectorSheet::new(fit.width, fit.height), fit, style, panel: [low, high] }
    }

    pub fn pixels(&self, points: &[[f64; 2]]) -> Polyline {
        points.iter().map(|p| self.fit.apply(*p)).collect()
    }

    /// The part of a polygon that is shown; further coordinates follow the first two.
    pub fn shown<const N: usize>(&self, polygon: &[[f64; N]]) -> Vec<[f64; N]> {
        in_box(polygon, self.panel)
    }

    /// Polygons in pixels.
    pub fn polygons<'p>(&self, polygons: impl IntoIterator<Item = &'p Polyline>) -> SvgPath {
        paths(polygons.into_iter().map(|p| self.pixels(&self.shown(p))), SvgPath::polygon)
    }

    /// Segments in pixels, each once, joined into lines.
    pub fn lines(&self, segments: impl Iterator<Item = [[f64; 2]; 2]>) -> SvgPath {
        let shown = once(segments).filter_map(|side| segment_in_box(side, self.panel));
        paths(chains(shown.map(|[a, b]| (a, b))).iter().map(|line| self.pixels(line)), SvgPath::line)
    }

    /// Draw edges of a mesh.
    pub fn wire(&mut self, opacity: f64, sides: impl Iterator<Item = [[f64; 2]; 2]>) {
        let path = self.lines(sides);
        self.sheet.wire(opacity, 2.0 * wire_width(self.style.size), &path);
    }

    /// Draw dots in white rings. `radius`: that of a dot, `ring`: that of its ring, both over the radius of a cone.
    pub fn dots(&mut self, dots: impl Iterator<Item = ([f64; 2], Rgb)> + Clone, [radius, ring]: [f64; 2]) {
        let disk = |at: [f64; 2], radius: f64| {
            let mut path = SvgPath::default();
            path.circle(self.fit.apply(at), radius * self.style.cone());
            path
        };
        for (at, color) in dots {
            self.sheet.fill([1.0; 3], &disk(at, ring));
            self.sheet.fill(color, &disk(at, radius));
        }
    }
}
