//! The layout in the plane.

use super::coat::{Coat, Wish};
use super::color::{INK, Rgb, cone_color, from_hex, mix, seam_color};
use super::fit::Fit;
use super::raster::{Hit, Image, Painter, Shape, render};
use super::{Circle, Flat, Style};

/// Circles of a smaller radius (pixels) are left out.
const LEAST_RADIUS: f64 = 1.0;
/// And of a larger one: their piece of arc in the picture is a line.
const MOST_RADIUS: f64 = 1e5;
/// Colour of the frame around charts.
pub const FRAME: u32 = 0x9a9a9a;
pub const VERTEX_CIRCLE: u32 = 0xb5342a;
pub const DUAL_CIRCLE: u32 = 0x26539e;
/// Distance of layers that are drawn over one another, above every radius in pixels.
const LAYER: f64 = 1e4;

/// Draw a layout; the pattern, circles, boundary, seams and cones lie over one another in this order.
pub fn draw(flat: &Flat<'_>, wish: &Wish<'_>, style: &Style) -> Image {
    let fit = fit(flat, style);
    let size = style.size as f64;
    let triangles: Vec<[[f64; 2]; 3]> = flat.corner_uv.iter().map(|uv| uv.map(|p| fit.apply(p))).collect();
    let mut shapes: Vec<Shape> =
        triangles.iter().map(|t| Shape::Triangle(t.map(|[x, y]| [x, y, 0.0]))).collect();
    let mut strokes = Vec::new();
    let mut line = |a: [f64; 2], b: [f64; 2], layer: f64, radius: f64, color: Rgb| {
        shapes.push(Shape::Capsule { ends: [a, b].map(|[x, y]| [x, y, layer * LAYER]), radius });
        strokes.push(color);
    };
    let circles = [(flat.dual_circles, DUAL_CIRCLE, 2.0), (flat.circles, VERTEX_CIRCLE, 3.0)];
    for (circles, color, layer) in circles {
        for circle in circles {
            let (points, radius) = outline(&fit, circle, size);
            points.windows(2).for_each(|p| line(p[0], p[1], layer, radius, from_hex(color)));
        }
    }
    for &(a, b) in flat.frame {
        line(fit.apply(a), fit.apply(b), 1.0, 0.5 * style.line(), from_hex(FRAME));
    }
    for &(a, b) in flat.boundary {
        line(fit.apply(a), fit.apply(b), 4.0, style.line(), INK);
    }
    for &(a, b, seam) in flat.seams {
        line(fit.apply(a), fit.apply(b), 5.0, style.line(), seam_color(seam));
    }
    for &(p, curvature) in flat.cones {
        let p = fit.apply(p);
        line(p, p, 6.0, 1.25 * style.cone(), [1.0; 3]);
        line(p, p, 7.0, style.cone(), cone_color(curvature));
    }
    let coat = Coat::new(wish, &triangles);
    // Circles are to be seen, not what is under them.
    let pale = if flat.circles.is_empty() { 0.0 } else { 0.75 };
    let panel = Panel { n_faces: triangles.len(), coat, strokes, pale };
    render(&shapes, fit.width, fit.height, &panel, style.threads)
}

/// The whole layout with its circles, or the part that is to be shown.
pub fn fit(flat: &Flat<'_>, style: &Style) -> Fit {
    if let Some(focus) = &style.focus {
        return Fit::around(focus.at_layout, focus.radius_layout, style.size);
    }
    let ends = |c: &Circle| [-1.0, 1.0].map(|s| [c.center[0] + s * c.radius, c.center[1] + s * c.radius]);
    let points = flat.corner_uv.iter().flatten().copied();
    let points = points.chain(flat.frame.iter().map(|side| side.0));
    Fit::new(points.chain(flat.circles.iter().flat_map(ends)), style.size)
}

struct Panel<'a> {
    n_faces: usize,
    coat: Coat<'a>,
    strokes: Vec<Rgb>,
    pale: f64,
}

impl Painter for Panel<'_> {
    fn paint(&self, _: [f64; 2], hit: Option<&Hit>) -> Rgb {
        match hit {
            None => [1.0; 3],
            Some(hit) if hit.shape < self.n_faces => {
                mix(self.coat.color(hit.shape, hit.local), [1.0; 3], self.pale)
            }
            Some(hit) => self.strokes[hit.shape - self.n_faces],
        }
    }
}

/// A circle as a polygon with a sagitta below a tenth of a pixel, and half the width of its line.
fn outline(fit: &Fit, circle: &Circle, size: f64) -> (Vec<[f64; 2]>, f64) {
    let radius = fit.scale * circle.radius;
    let center = fit.apply(circle.center);
    let visible = (LEAST_RADIUS..MOST_RADIUS).contains(&radius);
    if !visible || !center.iter().all(|x| x.is_finite()) {
        return (Vec::new(), 0.0);
    }
    let sides = ((radius * 50.0).sqrt() as usize).clamp(10, 400);
    let point = |k: usize| {
        let (sin, cos) = (std::f64::consts::TAU * k as f64 / sides as f64).sin_cos();
        [center[0] + radius * cos, center[1] + radius * sin]
    };
    let width = (0.12 * radius).clamp(0.12, (6e-4 * size).max(0.12));
    ((0..=sides).map(point).collect(), width)
}
