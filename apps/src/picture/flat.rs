//! The layout in the plane: colours or a pattern, and over them the wire, circles, boundary, seams and cones.

use super::canvas::PanelCanvas;
use super::coat::{CLAY, DARK, LIGHT, PanelContent, wire_opacity};
use super::color::{INK, Rgb, cone_color, from_hex, mix, seam_color, to_hex};
use super::colormap::NO_VALUE;
use super::fit::Fit;
use super::region::{FINEST, Polyline, cells, is_finite, outline};
use super::sheet::{SvgPath, VectorSheet};
use super::texture::{OCTAVE, TextureChoice};
use super::{Circle, ColorField, ShownLayout, Style};
use ricci::geometry::clip::strip;
use ricci::geometry::complex::doubled_area;

/// Circles of a smaller radius (pixels) are left out.
const LEAST_RADIUS: f64 = 0.8;
/// Circles of a larger radius (pixels) are left out too: their arcs in the picture would be straight lines.
const MOST_RADIUS: f64 = 1e5;
/// Colour of the frame around charts.
const FRAME: u32 = 0x9a9a9a;
pub const VERTEX_CIRCLE: u32 = 0xb5342a;
pub const DUAL_CIRCLE: u32 = 0x26539e;
/// Number of colours of a map in which triangles are drawn.
const COLORS: usize = 64;
/// Opacity of the dark cells of a pattern over colours.
const SHADE: f64 = 0.17;
/// Share of white in the colours under circles.
const PALE: f64 = 0.75;
/// Number of opacities of the wire.
const WIRE_CLASSES: usize = 5;

/// Draw a layout. Parts of lines may reach beyond the panel, which the caller cuts off.
pub fn draw(flat: &ShownLayout<'_>, wish: &PanelContent<'_>, style: &Style) -> VectorSheet {
    let mut canvas = PanelCanvas::new(fit(flat, style), style);
    if let Some(field) = wish.field {
        colors(flat, field, &mut canvas);
    }
    pattern(flat, wish, &mut canvas);
    if style.wire {
        wire(flat, &mut canvas);
    }
    rounds(flat, &mut canvas);
    circles(flat, &mut canvas);
    lines(flat, &mut canvas);
    canvas.sheet
}

/// The whole layout with its circles, or the part that is to be shown.
pub fn fit(flat: &ShownLayout<'_>, style: &Style) -> Fit {
    if let Some(focus) = &style.focus {
        return Fit::around(focus.at_layout, focus.radius_layout, style.size);
    }
    let ends = |c: &Circle| [-1.0, 1.0].map(|s| [c.centre[0] + s * c.radius, c.centre[1] + s * c.radius]);
    let points = flat.corner_uv.iter().flatten().copied();
    let points = points.chain(flat.frame.iter().map(|side| side.0));
    Fit::new(points.chain(flat.circles.iter().chain(flat.rims).flat_map(ends)), style.size)
}

/// The pattern over colours, or on a ground of its own; without a pattern one colour.
fn pattern(flat: &ShownLayout<'_>, wish: &PanelContent<'_>, canvas: &mut PanelCanvas<'_>) {
    // Pale, so that the circles over it stand out.
    let pale = |hex: u32| mix(from_hex(hex), [1.0; 3], if flat.circles.is_empty() { 0.0 } else { PALE });
    let texture = canvas.style.texture;
    for (check, region) in regions(flat, wish, canvas) {
        let fine = check * canvas.fit.scale < FINEST;
        let ground = match texture {
            TextureChoice::None => pale(CLAY),
            _ => mix(pale(LIGHT), pale(DARK), if fine { texture.mean() } else { 0.0 }),
        };
        let dark = if fine { Vec::new() } else { cells(&region, texture, check) };
        let [region, dark] = [region, dark].map(|polygons| canvas.polygons(&polygons));
        if wish.field.is_some() {
            canvas.sheet.add(&format!(r##"fill="#000" fill-opacity="{SHADE}""##), &dark);
        } else {
            canvas.sheet.fill(ground, &region);
            canvas.sheet.fill(pale(DARK), &dark);
        }
    }
}

/// The parts of the layout with checks of one size, as polygons that end with the panel, and that size.
fn regions(
    flat: &ShownLayout<'_>,
    wish: &PanelContent<'_>,
    canvas: &PanelCanvas<'_>,
) -> Vec<(f64, Vec<Polyline>)> {
    let size = wish.tiles.map_or(1.0, |tiles| tiles.size);
    let parts =
        wish.tiles.map_or_else(|| vec![(0, flat.corner_uv.to_vec())], |tiles| tiles.levels(flat.corner_uv));
    let region = |(level, triangles): (i32, Vec<[[f64; 2]; 3]>)| {
        let polygons = outline(triangles.into_iter());
        (size * OCTAVE.powi(level), polygons.iter().map(|p| canvas.shown(p)).collect())
    };
    parts.into_iter().map(region).collect()
}

/// Each triangle in its colours, cut where one ends and the next begins. Their edges are crisp, so that neighbours leave no gap.
fn colors(flat: &ShownLayout<'_>, field: &ColorField, canvas: &mut PanelCanvas<'_>) {
    let mut paths = vec![SvgPath::default(); COLORS + 1];
    for (uv, values) in flat.corner_uv.iter().zip(&field.corners) {
        let t = values.map(|v| field.scale.place(v) * (COLORS - 1) as f64 + 0.5);
        let shown = canvas.shown(&[0, 1, 2].map(|k| [uv[k][0], uv[k][1], t[k]]));
        let [low, high] = if t.iter().any(|t| t.is_nan()) {
            [COLORS; 2]
        } else {
            [f64::min, f64::max].map(|f| f(f(t[0], t[1]), t[2]) as usize)
        };
        for color in low..=high {
            let ends = [color as f64, (color + 1) as f64];
            let part = if color == COLORS { shown.clone() } else { strip(&shown, 2, ends) };
            paths[color].polygon(&part.iter().map(|p| canvas.fit.apply([p[0], p[1]])).collect::<Vec<_>>());
        }
    }
    for (color, path) in field.scale.table(COLORS).into_iter().chain([NO_VALUE]).zip(&paths) {
        canvas.sheet.add(&format!(r#"fill="{}" shape-rendering="crispEdges""#, to_hex(color)), path);
    }
}

/// The edges of the mesh; paler where they are dense.
fn wire(flat: &ShownLayout<'_>, canvas: &mut PanelCanvas<'_>) {
    let mut classes = vec![Vec::new(); WIRE_CLASSES + 1];
    for uv in flat.corner_uv.iter().filter(|uv| is_finite(&uv[..])) {
        let opacity = wire_opacity(0.5 * doubled_area(uv.map(|p| canvas.fit.apply(p))).abs());
        let sides = [0, 1, 2].map(|k| [uv[k], uv[(k + 1) % 3]]);
        classes[(opacity * WIRE_CLASSES as f64).round() as usize].extend(sides);
    }
    for (class, sides) in classes.into_iter().enumerate().skip(1) {
        canvas.wire(class as f64 / WIRE_CLASSES as f64, sides.into_iter());
    }
}

/// Round holes and rims.
fn rounds(flat: &ShownLayout<'_>, canvas: &mut PanelCanvas<'_>) {
    let circles = |circles: &[Circle]| {
        let mut path = SvgPath::default();
        for Circle { centre, radius } in circles {
            let radius = canvas.fit.scale * radius;
            if (LEAST_RADIUS..MOST_RADIUS).contains(&radius) {
                path.circle(canvas.fit.apply(*centre), radius);
            }
        }
        path
    };
    let [holes, rims] = [circles(flat.holes), circles(flat.rims)];
    let width = 2.0 * canvas.style.line();
    canvas.sheet.fill([1.0; 3], &holes);
    canvas.sheet.stroke(INK, width, &holes);
    canvas.sheet.stroke(INK, width, &rims);
}

/// Circles, the lines of small ones thinner.
fn circles(flat: &ShownLayout<'_>, canvas: &mut PanelCanvas<'_>) {
    let most = (1.2e-3 * canvas.style.size as f64).max(0.8);
    for (circles, color) in [(flat.dual_circles, DUAL_CIRCLE), (flat.circles, VERTEX_CIRCLE)] {
        let widths = [0.25, 0.5, 1.0].map(|share| share * most);
        let mut paths = widths.map(|_| SvgPath::default());
        for Circle { centre, radius } in circles {
            let radius = canvas.fit.scale * radius;
            if (LEAST_RADIUS..MOST_RADIUS).contains(&radius) {
                let class = widths.iter().rposition(|w| *w <= 0.24 * radius).unwrap_or(0);
                paths[class].circle(canvas.fit.apply(*centre), radius);
            }
        }
        widths.iter().zip(&paths).for_each(|(w, path)| canvas.sheet.stroke(from_hex(color), *w, path));
    }
}

/// Frame, boundary, seams and cones.
fn lines(flat: &ShownLayout<'_>, canvas: &mut PanelCanvas<'_>) {
    let width = 2.0 * canvas.style.line();
    let mut line = |sides: &mut dyn Iterator<Item = [[f64; 2]; 2]>, color: Rgb, width: f64| {
        let path = canvas.lines(sides);
        canvas.sheet.stroke(color, width, &path);
    };
    let sides = |(a, b): &([f64; 2], [f64; 2])| [*a, *b];
    line(&mut flat.frame.iter().map(sides), from_hex(FRAME), 0.5 * width);
    line(&mut flat.boundary.iter().map(sides), INK, width);
    for seam in 0..flat.seams.iter().map(|s| s.2 + 1).max().unwrap_or(0) {
        let mut sides = flat.seams.iter().filter(|s| s.2 == seam).map(|s| [s.0, s.1]);
        line(&mut sides, seam_color(seam), width);
    }
    canvas.dots(flat.cones.iter().map(|(at, curvature)| (*at, cone_color(*curvature))), [1.0, 1.25]);
}
