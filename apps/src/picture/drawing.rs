//! A drawing in a model of the plane or of the hyperbolic plane: cells with a pattern, lines and lettering over one another.

use super::Style;
use super::coat::{DARK, LIGHT, Wire, wire_width};
use super::color::{INK, Rgb, from_hex, mix, seam_color};
use super::fit::Fit;
use super::lettering::{HALO, lettering};
use super::raster::{Hit, Image, Painter, Shape, render};
use super::texture::{Patch, Texture, Tiles};
use std::f64::consts::TAU;

/// What of the plane is shown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Frame {
    /// The unit disk.
    Disk,
    /// Of the upper half-plane, what is this far from 0 at most to the left, to the right and up.
    HalfPlane(f64),
    /// A rectangle: least and largest coordinates.
    Rectangle([[f64; 2]; 2]),
}

/// A triangle of one copy of the pattern.
#[derive(Clone, Copy, Debug)]
pub struct Cell {
    pub corners: [[f64; 2]; 3],
    /// The triangle of the pattern that it shows; none for a plain colour.
    pub face: Option<u32>,
    /// 0: the colours of the pattern itself; others in turn, see [`tints`].
    pub tint: u8,
}

/// A line through points; the colour is that of a seam, or ink.
#[derive(Clone, Debug)]
pub struct Line {
    pub points: Vec<[f64; 2]>,
    pub color: Option<usize>,
    /// In widths of a seam.
    pub width: f64,
}

/// A word in generators beside a point, pushed away from the line there.
#[derive(Clone, Debug)]
pub struct Label {
    pub at: [f64; 2],
    pub away: [f64; 2],
    pub text: String,
    /// Left out if it is wider than this.
    pub room: f64,
    pub color: usize,
}

/// The pattern of all copies: coordinates of the corners of its triangles.
#[derive(Clone, Copy)]
pub struct Pattern<'a> {
    pub uv: &'a [[[f64; 2]; 3]],
    pub tiles: &'a Tiles,
}

#[derive(Clone, Copy)]
pub struct Drawing<'a> {
    pub frame: Frame,
    pub pattern: Option<Pattern<'a>>,
    pub cells: &'a [Cell],
    /// Polygons with a tint: the same area as that of the cells, for vector pictures.
    pub outlines: &'a [(Vec<[f64; 2]>, u8)],
    pub lines: &'a [Line],
    pub dots: &'a [[f64; 2]],
    pub labels: &'a [Label],
}

/// Tints beyond the first.
pub const TINTS: u8 = 11;
/// The one after those is for what is in the background.
pub const PALE: u8 = TINTS + 1;
/// Colour of what a disk or half-plane has no copy on.
pub const EMPTY: u32 = 0xefeeea;
/// Distance of layers that are drawn over one another, above every radius in pixels.
const LAYER: f64 = 1e4;
/// Distance of a label from its point, over the size of the panel.
const AWAY: f64 = 0.021;

/// The two colours of the pattern in a tint.
pub fn tints(tint: u8) -> [Rgb; 2] {
    const HUES: [u32; TINTS as usize] = [
        0xb5803a, 0x5d9c59, 0xa65a78, 0x6b6fb3, 0x3f9a9a, 0xb86b4b, 0x8aa03c, 0x8c62a8, 0x4f86b5, 0xb39a45,
        0x6d8a7a,
    ];
    let [light, dark] = [LIGHT, DARK].map(from_hex);
    match tint {
        0 => [light, dark],
        PALE => [mix(light, [1.0; 3], 0.5), mix(dark, [1.0; 3], 0.72)],
        k => {
            let hue = from_hex(HUES[usize::from(k - 1) % HUES.len()]);
            [mix([1.0; 3], hue, 0.16), mix([1.0; 3], hue, 0.75)]
        }
    }
}

/// A colour for what has a pattern of its own in grey.
pub fn tint_color(tint: u8) -> Rgb {
    let [light, dark] = tints(tint);
    mix(light, dark, 0.3)
}

impl Frame {
    /// Least and largest coordinates of what is shown.
    pub fn corners(&self) -> [[f64; 2]; 2] {
        match *self {
            Frame::Disk => [[-1.0; 2], [1.0; 2]],
            Frame::HalfPlane(far) => [[-far, 0.0], [far, far]],
            Frame::Rectangle(corners) => corners,
        }
    }

    pub fn fit(&self, size: usize) -> Fit {
        Fit::new(self.corners().into_iter(), size)
    }

    /// The border of the model.
    pub fn border(&self) -> Vec<[f64; 2]> {
        match *self {
            Frame::Disk => (0..=720)
                .map(|k| {
                    let (sin, cos) = (TAU * f64::from(k) / 720.0).sin_cos();
                    [cos, sin]
                })
                .collect(),
            Frame::HalfPlane(far) => vec![[-far, 0.0], [far, 0.0]],
            Frame::Rectangle(_) => Vec::new(),
        }
    }
}

impl Line {
    pub fn rgb(&self) -> Rgb {
        self.color.map_or(INK, seam_color)
    }
}

impl Label {
    /// The strokes of its letters in pixels and the radius of their pen; none where there is no room.
    pub fn strokes(&self, fit: &Fit, size: f64) -> Vec<([[f64; 2]; 2], f64)> {
        let (strokes, width) = lettering(&self.text, size);
        if width > fit.scale * self.room {
            return Vec::new();
        }
        let [x, y] = fit.apply(self.at);
        let length = self.away[0].hypot(self.away[1]).max(f64::MIN_POSITIVE);
        let [dx, dy] = self.away.map(|d| d / length);
        // Wide words are pushed farther where they would reach back to the line.
        let push = AWAY * size + 0.5 * (width - AWAY * size).max(0.0) * dx.abs();
        let by = [x + push * dx - 0.5 * width, y - push * dy];
        strokes.into_iter().map(|(ends, pen)| (ends.map(|p| [p[0] + by[0], p[1] + by[1]]), pen)).collect()
    }
}

/// Cells, lines, dots and labels over one another, in this order.
pub fn draw(drawing: &Drawing<'_>, style: &Style) -> Image {
    let fit = drawing.frame.fit(style.size);
    let mut shapes: Vec<Shape> = drawing
        .cells
        .iter()
        .map(|cell| {
            Shape::Triangle(cell.corners.map(|p| {
                let [x, y] = fit.apply(p);
                [x, y, 0.0]
            }))
        })
        .collect();
    let mut strokes = Vec::new();
    let mut line = |ends: [[f64; 2]; 2], layer: f64, radius: f64, color: Rgb| {
        shapes.push(Shape::Capsule { ends: ends.map(|[x, y]| [x, y, layer * LAYER]), radius });
        strokes.push(color);
    };
    let border = Line { points: drawing.frame.border(), color: None, width: 1.0 };
    for (layer, each) in drawing.lines.iter().map(|l| (1.0, l)).chain([(2.0, &border)]) {
        let radius = each.width * style.line();
        for ends in each.points.windows(2) {
            line([fit.apply(ends[0]), fit.apply(ends[1])], layer, radius, each.rgb());
        }
    }
    for &dot in drawing.dots {
        let at = fit.apply(dot);
        line([at; 2], 3.0, 0.8 * style.cone(), [1.0; 3]);
        line([at; 2], 4.0, 0.6 * style.cone(), INK);
    }
    for label in drawing.labels {
        for (ends, pen) in label.strokes(&fit, style.size as f64) {
            line(ends, 5.0, HALO * pen, [1.0; 3]);
            line(ends, 6.0, pen, mix(seam_color(label.color), INK, 0.35));
        }
    }
    let pattern = drawing.pattern.filter(|_| style.texture != Texture::None);
    let panel = Panel {
        drawing,
        fit,
        pattern,
        texture: style.texture,
        strokes,
        wire: style.wire.then(|| wire_width(style.size)),
    };
    render(&shapes, fit.width, fit.height, &panel, style.threads)
}

struct Panel<'a> {
    drawing: &'a Drawing<'a>,
    fit: Fit,
    pattern: Option<Pattern<'a>>,
    texture: Texture,
    strokes: Vec<Rgb>,
    /// Half the width of the edges of the mesh, where they are drawn.
    wire: Option<f64>,
}

impl Painter for Panel<'_> {
    fn paint(&self, pixel: [f64; 2], hit: Option<&Hit>) -> Rgb {
        let cells = self.drawing.cells;
        let [x, y] = self.fit.invert(pixel);
        if let Some(stroke) = hit.and_then(|hit| hit.shape.checked_sub(cells.len())) {
            let beyond = |far: f64| y > far || x.abs() > far;
            let outside = matches!(self.drawing.frame, Frame::HalfPlane(far) if beyond(far));
            return if outside { [1.0; 3] } else { self.strokes[stroke] };
        }
        let (inside, empty) = match self.drawing.frame {
            Frame::Disk => (x.hypot(y) < 1.0, from_hex(EMPTY)),
            Frame::HalfPlane(far) => (y > 0.0 && y < far && x.abs() < far, from_hex(EMPTY)),
            Frame::Rectangle(_) => (true, [1.0; 3]),
        };
        let Some((hit, cell)) = hit.filter(|_| inside).map(|hit| (hit, &cells[hit.shape])) else {
            return if inside { empty } else { [1.0; 3] };
        };
        let [light, dark] = tints(cell.tint);
        let pixels = cell.corners.map(|p| self.fit.apply(p));
        let share = match (self.pattern, cell.face) {
            (Some(Pattern { uv, tiles }), Some(f)) => {
                let f = f as usize;
                Patch::new(self.texture, uv[f], tiles, f, pixels).value(hit.local)
            }
            (Some(_), None) => 0.5,
            (None, _) => 0.25,
        };
        let wire = self.wire.filter(|_| cell.face.is_some());
        let wire = wire.map_or(0.0, |half_width| Wire::new(pixels, half_width).opacity(hit.local));
        mix(mix(light, dark, share), INK, wire)
    }
}
