//! A drawing in a model of the plane or of the hyperbolic plane: areas with a pattern, lines and lettering over one another.

use super::Style;
use super::canvas::PanelCanvas;
use super::coat::{DARK, LIGHT, wire_opacity};
use super::color::{INK, Rgb, from_hex, mix, seam_color};
use super::fit::Fit;
use super::region::Polyline;
use super::sheet::{SvgPath, VectorSheet};
use super::text::word;
use super::texture::Tiles;

/// The part of the plane that is shown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DrawingFrame {
    /// The unit disk.
    Disk,
    /// Of the upper half-plane, what is this far from 0 at most to the left, to the right and up.
    HalfPlane(f64),
    /// A rectangle: least and largest coordinates.
    Rectangle([[f64; 2]; 2]),
}

/// One copy of the surface.
#[derive(Clone, Debug)]
pub struct Area {
    /// Its border, a closed polygon.
    pub border: Polyline,
    /// The number of its tint ([`tints`]); 0 is that of the pattern itself.
    pub tint: u8,
    /// The dark cells of the pattern.
    pub cells: Vec<Polyline>,
    /// Parts where the cells would be too small to be seen, and the share of the dark colour there.
    pub blur: (Vec<Polyline>, f64),
    /// The edges of the mesh.
    pub wire: Vec<[[f64; 2]; 2]>,
    /// The mean area of a face, pixels.
    pub face: f64,
    /// Share of the dark colour in the ground.
    pub dark: f64,
}

/// A line through points; the colour is that of a seam, or ink.
#[derive(Clone, Debug)]
pub struct DrawnLine {
    pub points: Polyline,
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
pub struct DrawingPattern<'a> {
    pub uv: &'a [[[f64; 2]; 3]],
    pub tiles: &'a Tiles,
}

#[derive(Clone, Copy)]
pub struct Drawing<'a> {
    pub frame: DrawingFrame,
    pub areas: &'a [Area],
    pub lines: &'a [DrawnLine],
    pub dots: &'a [[f64; 2]],
    pub labels: &'a [Label],
}

/// Tints beyond the first.
pub const TINTS: u8 = 11;
/// The tint of copies in the background.
pub const PALE: u8 = TINTS + 1;
/// Colour of the part of a disk or half-plane that no copy covers.
const EMPTY: u32 = 0xefeeea;
/// Distance of a label from its point, over the size of its letters.
const AWAY: f64 = 0.9;
/// Width of the white line around letters, over their size.
const HALO: f64 = 0.22;

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

/// The colour of a copy whose grey pattern comes from a texture.
pub fn tint_color(tint: u8) -> Rgb {
    let [light, dark] = tints(tint);
    mix(light, dark, 0.3)
}

impl DrawingFrame {
    pub fn fit(&self, size: usize) -> Fit {
        let corners = match *self {
            DrawingFrame::Disk => [[-1.0; 2], [1.0; 2]],
            DrawingFrame::HalfPlane(far) => [[-far, 0.0], [far, far]],
            DrawingFrame::Rectangle(corners) => corners,
        };
        Fit::new(corners.into_iter(), size)
    }
}

/// Areas, lines, dots and labels over one another, in this order.
pub fn draw(drawing: &Drawing<'_>, style: &Style) -> VectorSheet {
    let mut canvas = PanelCanvas::new(drawing.frame.fit(style.size), style);
    let (fit, width) = (canvas.fit, 2.0 * style.line());
    // The ground of the model, and its border.
    let (mut ground, mut border) = (SvgPath::default(), SvgPath::default());
    match drawing.frame {
        DrawingFrame::Disk => {
            ground.circle(fit.apply([0.0; 2]), fit.scale);
            border = ground.clone();
        }
        DrawingFrame::HalfPlane(_) => {
            let (right, y) = (fit.width as f64, fit.apply([0.0; 2])[1]);
            ground.rectangle([0.0, 0.0, right, y]);
            border.line(&[[0.0, y], [right, y]]);
        }
        DrawingFrame::Rectangle(_) => {}
    }
    canvas.sheet.fill(from_hex(EMPTY), &ground);
    drawing.areas.iter().for_each(|copy| area(&mut canvas, copy));
    for line in drawing.lines {
        let path = canvas.lines(line.points.windows(2).map(|ends| [ends[0], ends[1]]));
        canvas.sheet.stroke(line.color.map_or(INK, seam_color), line.width * width, &path);
    }
    canvas.sheet.stroke(INK, width, &border);
    canvas.dots(drawing.dots.iter().map(|dot| (*dot, INK)), [0.6, 0.8]);
    let is_disk = drawing.frame == DrawingFrame::Disk;
    drawing.labels.iter().for_each(|text| label(&mut canvas, text, is_disk));
    canvas.sheet.cut("drawing")
}

fn area(canvas: &mut PanelCanvas<'_>, area: &Area) {
    let [light, dark] = tints(area.tint);
    let ground = mix(light, dark, area.dark);
    let [border, cells] = [canvas.polygons([&area.border]), canvas.polygons(&area.cells)];
    canvas.sheet.fill(ground, &border);
    // A line in the same colour closes the gaps that anti-aliasing leaves between neighbours.
    canvas.sheet.stroke(ground, 0.3, &border);
    let blur = canvas.polygons(&area.blur.0);
    canvas.sheet.fill(mix(light, dark, area.blur.1), &blur);
    canvas.sheet.fill(dark, &cells);
    canvas.wire(wire_opacity(area.face), area.wire.iter().copied());
}

/// A label where there is room for it; in the unit disk moved inwards until it lies inside.
fn label(canvas: &mut PanelCanvas<'_>, label: &Label, is_disk: bool) {
    let size = canvas.style.letters();
    let lettering = word(&label.text, size);
    if lettering.width > canvas.fit.scale * label.room {
        return;
    }
    let [x, y] = canvas.fit.apply(label.at);
    let length = label.away[0].hypot(label.away[1]).max(f64::MIN_POSITIVE);
    let [dx, dy] = label.away.map(|d| d / length);
    // Wide words are pushed farther where they would reach back to the line.
    let push = size * AWAY + 0.5 * (lettering.width - size * AWAY).max(0.0) * dx.abs();
    let mut at = [x + push * dx - 0.5 * lettering.width, y - push * dy];
    if is_disk {
        let (centre, radius) = (canvas.fit.apply([0.0; 2]), canvas.fit.scale);
        let middle = [at[0] + 0.5 * lettering.width, at[1] - 0.5 * size];
        let reach = (middle[0] - centre[0]).hypot(middle[1] - centre[1]) + 0.5 * lettering.width.hypot(size);
        let back = ((reach - radius) / (reach - 0.5 * lettering.width.hypot(size)).max(1.0)).clamp(0.0, 1.0);
        at = [0, 1].map(|k| at[k] + back * (centre[k] - middle[k]));
    }
    let color = mix(seam_color(label.color), INK, 0.35);
    canvas.sheet.write(&label.text, &lettering.path, (at, color), HALO * size);
}
