//! The layout in the plane.

use super::checker::{Checker, Tiles};
use super::raster::{Paint, Primitive, Rgb, dot, line};
use super::{Circle, Fit, Flat, LINE, cone_color, seam_color};

/// Layouts of at most this many faces show their edges.
pub const WIRE_FACES: usize = 5000;
/// Circles of a smaller radius (pixels) are left out.
const LEAST_RADIUS: f64 = 1.0;
/// And of a larger one: their piece of arc in the picture is a line.
const MOST_RADIUS: f64 = 1e5;
const WIRE: Rgb = [0.35, 0.38, 0.42];
const BOUNDARY: Rgb = [0.01, 0.01, 0.015];
const VERTEX_CIRCLE: Rgb = [0.70, 0.06, 0.03];
const DUAL_CIRCLE: Rgb = [0.02, 0.15, 0.55];

pub fn primitives(flat: &Flat<'_>, tiles: &Tiles) -> Vec<Primitive> {
    let fit = Fit::of(flat);
    let mut out = Vec::new();
    for (f, uv) in flat.corner_uv.iter().enumerate() {
        let xy = uv.map(|p| fit.apply(p));
        let checker = Checker::new(*uv, tiles, f, xy);
        out.push(Primitive { xy, z: [0.0; 3], paint: Paint::Tiled { checker } });
    }
    if flat.corner_uv.len() <= WIRE_FACES && flat.circles.is_empty() {
        for uv in flat.corner_uv {
            let [a, b, c] = uv.map(|p| fit.apply(p));
            for (p, q) in [(a, b), (b, c), (c, a)] {
                line(&mut out, p, q, [1.0; 2], 0.5, WIRE);
            }
        }
    }
    for (circles, color, z) in [(flat.dual_circles, DUAL_CIRCLE, 2.0), (flat.circles, VERTEX_CIRCLE, 3.0)] {
        circles.iter().for_each(|circle| outline(&mut out, &fit, circle, z, color));
    }
    for &(a, b) in flat.boundary {
        line(&mut out, fit.apply(a), fit.apply(b), [4.0; 2], LINE, BOUNDARY);
    }
    for &(a, b, seam) in flat.seams {
        line(&mut out, fit.apply(a), fit.apply(b), [5.0; 2], LINE, seam_color(seam));
    }
    for &(p, curvature) in flat.cones {
        dot(&mut out, fit.apply(p), 6.0, 4.5, cone_color(curvature));
    }
    out
}

/// A circle as a polygon with a sagitta below a tenth of a pixel.
fn outline(out: &mut Vec<Primitive>, fit: &Fit, circle: &Circle, z: f64, color: Rgb) {
    let radius = fit.scale * circle.radius;
    let center = fit.apply(circle.center);
    let visible = (LEAST_RADIUS..MOST_RADIUS).contains(&radius);
    if !visible || !center.iter().all(|x| x.is_finite()) {
        return;
    }
    let sides = ((radius * 50.0).sqrt() as usize).clamp(10, 400);
    let point = |k: usize| {
        let (sin, cos) = (std::f64::consts::TAU * k as f64 / sides as f64).sin_cos();
        [center[0] + radius * cos, center[1] + radius * sin]
    };
    let width = (0.25 * radius).clamp(0.25, 1.1);
    (0..sides).for_each(|k| line(out, point(k), point(k + 1), [z; 2], width, color));
}
