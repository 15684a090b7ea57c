//! The flat layout as SVG.

use super::flat::WIRE_FACES;
use super::raster::{Rgb, encode};
use super::{Circle, Fit, Flat, LINE, PANEL, cone_color, seam_color};
use std::io::Write;

/// Write the layout as SVG: edges, circles, boundary, seams, cones.
pub fn write_svg(out: &mut impl Write, flat: &Flat<'_>) -> std::io::Result<()> {
    let fit = Fit::of(flat);
    let at = |p: [f64; 2]| {
        let [x, y] = fit.apply(p);
        format!("{x:.3} {y:.3}")
    };
    writeln!(out, r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {PANEL} {PANEL}" fill="none">"#)?;
    writeln!(out, r##"<g stroke="#9aa3ad" stroke-width="0.4">"##)?;
    let finite = |uv: &&[[f64; 2]; 3]| uv.as_flattened().iter().all(|x| x.is_finite());
    let wired = flat.corner_uv.len() <= WIRE_FACES && flat.circles.is_empty();
    for [a, b, c] in flat.corner_uv.iter().filter(|_| wired).filter(finite) {
        writeln!(out, r#"<path d="M{} L{} L{} Z"/>"#, at(*a), at(*b), at(*c))?;
    }
    writeln!(out, "</g>")?;
    for (circles, color) in [(flat.dual_circles, "#26539e"), (flat.circles, "#b5342a")] {
        writeln!(out, r#"<g stroke="{color}" stroke-width="0.6">"#)?;
        for Circle { center, radius } in circles {
            let [x, y] = fit.apply(*center);
            writeln!(out, r#"<circle cx="{x:.3}" cy="{y:.3}" r="{:.3}"/>"#, fit.scale * radius)?;
        }
        writeln!(out, "</g>")?;
    }
    writeln!(out, r#"<g stroke-width="{LINE}" stroke-linecap="round">"#)?;
    for (a, b) in flat.boundary {
        writeln!(out, r##"<path stroke="#111" d="M{} L{}"/>"##, at(*a), at(*b))?;
    }
    for (a, b, seam) in flat.seams {
        writeln!(out, r#"<path stroke="{}" d="M{} L{}"/>"#, hex(seam_color(*seam)), at(*a), at(*b))?;
    }
    writeln!(out, "</g>")?;
    for (p, curvature) in flat.cones {
        let [x, y] = fit.apply(*p);
        let color = hex(cone_color(*curvature));
        writeln!(out, r#"<circle cx="{x:.3}" cy="{y:.3}" r="4.5" fill="{color}" stroke="white"/>"#)?;
    }
    writeln!(out, "</svg>")
}

/// `#rrggbb`.
fn hex(color: Rgb) -> String {
    let [r, g, b] = color.map(|x| encode(x as f32));
    format!("#{r:02x}{g:02x}{b:02x}")
}
