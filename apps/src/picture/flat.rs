//! The layout in the plane: colours or a pattern, and over them the wire, circles, boundary, seams and cones.

use super::coat::{CLAY, DARK, LIGHT, Wish, wire_opacity, wire_width};
use super::color::{INK, Rgb, cone_color, from_hex, mix, seam_color, to_hex};
use super::colormap::NO_VALUE;
use super::fit::Fit;
use super::raster::doubled_area;
use super::region::{Chain, FINEST, cells, chains, in_box, is_finite, once, outline, segment_in_box, strip};
use super::sheet::{Path, Sheet, lines, polygons};
use super::texture::{OCTAVE, Texture};
use super::{Circle, Field, Flat, Style};

/// Circles of a smaller radius (pixels) are left out.
const LEAST_RADIUS: f64 = 0.8;
/// And of a larger one: their piece of arc in the picture is a line.
const MOST_RADIUS: f64 = 1e5;
/// Colour of the frame around charts.
const FRAME: u32 = 0x9a9a9a;
pub const VERTEX_CIRCLE: u32 = 0xb5342a;
pub const DUAL_CIRCLE: u32 = 0x26539e;
/// Colours of a map that are told apart.
const COLORS: usize = 64;
/// How much darker the dark cells of a pattern make a colour.
const SHADE: f64 = 0.17;
/// How pale what lies under circles is.
const PALE: f64 = 0.75;
/// Degrees of opacity of the wire.
const WIRE_CLASSES: usize = 5;
/// Pixels beyond the panel up to which lines are drawn.
const BEYOND: f64 = 20.0;

/// Draw a layout.
pub fn draw(flat: &Flat<'_>, wish: &Wish<'_>, style: &Style) -> Sheet {
    let fit = fit(flat, style);
    let [width, height] = [fit.width as f64, fit.height as f64];
    let panel = [[-BEYOND; 2], [width + BEYOND, height + BEYOND]];
    let mut sheet = Sheet::new(fit.width, fit.height);
    let drawing = Layout { flat, wish, style, fit, panel };
    drawing.ground(&mut sheet);
    drawing.wire(&mut sheet);
    drawing.rounds(&mut sheet);
    drawing.circles(&mut sheet);
    drawing.lines(&mut sheet);
    sheet.cut("layout")
}

/// The whole layout with its circles, or the part that is to be shown.
fn fit(flat: &Flat<'_>, style: &Style) -> Fit {
    if let Some(focus) = &style.focus {
        return Fit::around(focus.at_layout, focus.radius_layout, style.size);
    }
    let ends = |c: &Circle| [-1.0, 1.0].map(|s| [c.center[0] + s * c.radius, c.center[1] + s * c.radius]);
    let points = flat.corner_uv.iter().flatten().copied();
    let points = points.chain(flat.frame.iter().map(|side| side.0));
    Fit::new(points.chain(flat.circles.iter().chain(flat.rims).flat_map(ends)), style.size)
}

struct Layout<'a> {
    flat: &'a Flat<'a>,
    wish: &'a Wish<'a>,
    style: &'a Style,
    fit: Fit,
    /// What is drawn, in pixels.
    panel: [[f64; 2]; 2],
}

impl Layout<'_> {
    /// Colours of a quantity, or one colour; then the pattern.
    fn ground(&self, sheet: &mut Sheet) {
        // Circles are to be seen, not what is under them.
        let pale =
            |hex: u32| mix(from_hex(hex), [1.0; 3], if self.flat.circles.is_empty() { 0.0 } else { PALE });
        if let Some(field) = self.wish.field {
            self.colors(sheet, field);
        }
        let texture = self.wish.texture;
        for (check, region) in self.regions() {
            let fine = check * self.fit.scale < FINEST;
            let ground = match texture {
                Texture::None => pale(CLAY),
                _ => mix(pale(LIGHT), pale(DARK), if fine { texture.mean() } else { 0.0 }),
            };
            let pixels = |polygons: &[Chain]| polygons.iter().map(|p| self.pixels(p)).collect::<Vec<_>>();
            let dark = if fine { Vec::new() } else { cells(&region, texture, check) };
            let dark = polygons(&pixels(&dark));
            match self.wish.field {
                Some(_) => sheet.add(&format!(r##"fill="#000" fill-opacity="{SHADE}""##), &dark),
                None => {
                    sheet.fill(ground, &polygons(&pixels(&region)));
                    sheet.fill(pale(DARK), &dark);
                }
            }
        }
    }

    /// The parts of the layout with checks of one size, as polygons that end with the panel, and that size.
    fn regions(&self) -> Vec<(f64, Vec<Chain>)> {
        let size = self.wish.tiles.map_or(1.0, |tiles| tiles.size);
        let uv = self.flat.corner_uv;
        let parts = self.wish.tiles.map_or_else(|| vec![(0, uv.to_vec())], |tiles| tiles.levels(uv));
        let [low, high] = self.panel.map(|p| self.fit.invert(p));
        let shown = |chain: Chain| in_box(&chain, [[low[0], high[1]], [high[0], low[1]]]);
        let region = |(level, triangles): (i32, Vec<[[f64; 2]; 3]>)| {
            let polygons = outline(triangles.into_iter()).into_iter().map(shown).collect();
            (size * OCTAVE.powi(level), polygons)
        };
        parts.into_iter().map(region).collect()
    }

    fn pixels(&self, points: &[[f64; 2]]) -> Chain {
        points.iter().map(|p| self.fit.apply(*p)).collect()
    }

    /// Each triangle in its colours, cut where one ends and the next begins. Their edges are crisp, so that neighbours leave no gap.
    fn colors(&self, sheet: &mut Sheet, field: &Field) {
        let table = field.scale.table(COLORS);
        let mut paths = vec![Path::default(); COLORS + 1];
        for (uv, values) in self.flat.corner_uv.iter().zip(&field.corners) {
            let t = values.map(|v| field.scale.place(v) * (COLORS - 1) as f64 + 0.5);
            let triangle = self.pixels(uv);
            let corners = [0, 1, 2].map(|k| [triangle[k][0], triangle[k][1], t[k]]);
            let shown = in_box(&corners, self.panel);
            if shown.is_empty() || t.iter().any(|t| t.is_nan()) {
                paths[COLORS].polygon(if shown.is_empty() { &[] } else { &triangle });
                continue;
            }
            let [low, high] = [f64::min, f64::max].map(|f| f(f(t[0], t[1]), t[2]) as usize);
            for color in low..=high {
                let part = strip(&shown, 2, [color as f64, (color + 1) as f64]);
                paths[color].polygon(&part.iter().map(|p| [p[0], p[1]]).collect::<Vec<_>>());
            }
        }
        for (color, path) in table.into_iter().chain([NO_VALUE]).zip(&paths) {
            let fill = format!(r#"fill="{}" shape-rendering="crispEdges""#, to_hex(color));
            sheet.add(&fill, path);
        }
    }

    /// The edges of the mesh, each once; paler where they are dense.
    fn wire(&self, sheet: &mut Sheet) {
        if !self.wish.wire {
            return;
        }
        let half_width = wire_width(self.style.size);
        let mut classes = vec![Vec::new(); WIRE_CLASSES + 1];
        for uv in self.flat.corner_uv.iter().filter(|uv| is_finite(&uv[..])) {
            let p = uv.map(|p| self.fit.apply(p));
            let opacity = wire_opacity(0.5 * doubled_area(p).abs());
            let sides = [0, 1, 2].map(|k| [p[k], p[(k + 1) % 3]]);
            classes[(opacity * WIRE_CLASSES as f64).round() as usize].extend(sides);
        }
        for (class, segments) in classes.into_iter().enumerate().skip(1) {
            let shown = once(segments.into_iter()).filter_map(|s| segment_in_box(s, self.panel));
            let path = lines(&chains(shown.map(|[a, b]| (a, b))));
            sheet.wire(class as f64 / WIRE_CLASSES as f64, 2.0 * half_width, &path);
        }
    }

    /// Round holes and rims.
    fn rounds(&self, sheet: &mut Sheet) {
        let (mut inside, mut edges) = (Path::default(), Path::default());
        let shown = |circle: &Circle| (LEAST_RADIUS..MOST_RADIUS).contains(&(self.fit.scale * circle.radius));
        let pixels = |circle: &Circle| (self.fit.apply(circle.center), self.fit.scale * circle.radius);
        for (at, radius) in self.flat.holes.iter().filter(|c| shown(c)).map(pixels) {
            inside.circle(at, radius);
            edges.circle(at, radius);
        }
        for (at, radius) in self.flat.rims.iter().filter(|c| shown(c)).map(pixels) {
            edges.circle(at, radius);
        }
        sheet.fill([1.0; 3], &inside);
        sheet.stroke(INK, 2.0 * self.style.line(), &edges);
    }

    /// Circles, the lines of small ones thinner.
    fn circles(&self, sheet: &mut Sheet) {
        for (circles, color) in [(self.flat.dual_circles, DUAL_CIRCLE), (self.flat.circles, VERTEX_CIRCLE)] {
            let most = (1.2e-3 * self.style.size as f64).max(0.8);
            let widths = [0.25, 0.5, 1.0].map(|share| share * most);
            let mut paths = widths.map(|_| Path::default());
            for Circle { center, radius } in circles {
                let (at, radius) = (self.fit.apply(*center), self.fit.scale * radius);
                if (LEAST_RADIUS..MOST_RADIUS).contains(&radius) {
                    let wanted = 0.24 * radius;
                    let class = widths.iter().rposition(|w| *w <= wanted).unwrap_or(0);
                    paths[class].circle(at, radius);
                }
            }
            widths.iter().zip(&paths).for_each(|(width, path)| sheet.stroke(from_hex(color), *width, path));
        }
    }

    /// Frame, boundary, seams and cones.
    fn lines(&self, sheet: &mut Sheet) {
        let Flat { frame, boundary, seams, cones, .. } = self.flat;
        let mut line = |sides: &mut dyn Iterator<Item = ([f64; 2], [f64; 2])>, color: Rgb, width: f64| {
            let shown = |(a, b)| segment_in_box([self.fit.apply(a), self.fit.apply(b)], self.panel);
            let joined = chains(sides.filter_map(shown).map(|[a, b]| (a, b)));
            sheet.stroke(color, width, &lines(&joined));
        };
        let width = 2.0 * self.style.line();
        line(&mut frame.iter().copied(), from_hex(FRAME), 0.5 * width);
        line(&mut boundary.iter().copied(), INK, width);
        for seam in 0..seams.iter().map(|s| s.2 + 1).max().unwrap_or(0) {
            let sides = seams.iter().filter(|s| s.2 == seam).map(|s| (s.0, s.1));
            line(&mut { sides }, seam_color(seam), width);
        }
        for (p, curvature) in cones.iter() {
            for (radius, color) in [(1.25, [1.0; 3]), (1.0, cone_color(*curvature))] {
                let mut path = Path::default();
                path.circle(self.fit.apply(*p), radius * self.style.cone());
                sheet.fill(color, &path);
            }
        }
    }
}
