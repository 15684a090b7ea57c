//! The flat layout as SVG.

use super::{Circle, Fit, Flat, LINE, PANEL};
use std::io::Write;

/// Write the layout as SVG: edges, circles, boundary, seams, cones.
pub fn write_svg(out: &mut impl Write, flat: &Flat<'_>) -> std::io::Result<()> {
    let fit = Fit::new(flat.corner_uv.iter().flatten().copied());
    let at = |p: [f64; 2]| {
        let [x, y] = fit.apply(p);
        format!("{x:.3} {y:.3}")
    };
    writeln!(out, r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {PANEL} {PANEL}" fill="none">"#)?;
    writeln!(out, r##"<g stroke="#9aa3ad" stroke-width="0.4">"##)?;
    for [a, b, c] in flat.corner_uv {
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
    const SEAMS: [&str; 8] =
        ["#d6242d", "#1a75d2", "#279b3f", "#dd8900", "#9330c0", "#00a9ab", "#cd2795", "#9a8127"];
    for (a, b, seam) in flat.seams {
        writeln!(out, r#"<path stroke="{}" d="M{} L{}"/>"#, SEAMS[seam % SEAMS.len()], at(*a), at(*b))?;
    }
    writeln!(out, "</g>")?;
    for (p, curvature) in flat.cones {
        let [x, y] = fit.apply(*p);
        let color = if *curvature > 0.0 { "#e52b24" } else { "#1a5ad6" };
        writeln!(out, r#"<circle cx="{x:.3}" cy="{y:.3}" r="4.5" fill="{color}" stroke="white"/>"#)?;
    }
    writeln!(out, "</svg>")
}
