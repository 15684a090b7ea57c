//! Drawings in a model of the plane as SVG: tiles of one colour, lines and lettering.

use super::Style;
use super::color::{INK, from_hex, mix, seam_color, to_hex};
use super::drawing::{Drawing, EMPTY, Frame, tints};
use super::lettering::HALO;
use super::svg::decimal;
use std::io::{Result, Write};

/// Write a drawing.
pub fn write_drawing_svg(out: &mut impl Write, drawing: &Drawing<'_>, style: &Style) -> Result<()> {
    let fit = drawing.frame.fit(style.size);
    let size = style.size as f64;
    let [width, height] = [fit.width, fit.height];
    writeln!(
        out,
        r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" fill="none" stroke-linejoin="round" stroke-linecap="round">"#
    )?;
    let at = |p: [f64; 2]| {
        let [x, y] = fit.apply(p).map(decimal);
        format!("{x} {y}")
    };
    let polyline = |points: &[[f64; 2]]| {
        let places: Vec<String> = points.iter().map(|p| at(*p)).collect();
        format!("M{}", places.join("L"))
    };
    let [low, high] = match drawing.frame {
        Frame::Disk => [[-1.0; 2], [1.0; 2]],
        Frame::HalfPlane(far) => [[-far, 0.0], [far, far]],
        Frame::Rectangle(corners) => corners,
    };
    let ([x0, y1], [x1, y0]) = (fit.apply(low), fit.apply(high));
    let [x, y, w, h] = [x0, y0, x1 - x0, y1 - y0].map(decimal);
    writeln!(
        out,
        r#"<defs><clipPath id="frame"><rect x="{x}" y="{y}" width="{w}" height="{h}"/></clipPath></defs><g clip-path="url(#frame)">"#
    )?;
    let empty = to_hex(from_hex(EMPTY));
    match drawing.frame {
        Frame::Disk => writeln!(out, r#"<path fill="{empty}" d="{}Z"/>"#, polyline(&drawing.frame.border()))?,
        Frame::HalfPlane(_) => {
            writeln!(out, r#"<rect fill="{empty}" x="{x}" y="{y}" width="{w}" height="{h}"/>"#)?
        }
        Frame::Rectangle(_) => {}
    }
    for (points, tint) in drawing.outlines {
        if points.iter().flatten().all(|x| x.is_finite()) {
            let [light, dark] = tints(*tint);
            let fill = to_hex(mix(light, dark, 0.25));
            // The outline in the same colour closes the gaps that anti-aliasing leaves between neighbours.
            writeln!(
                out,
                r#"<path fill="{fill}" stroke="{fill}" stroke-width="0.3" d="{}Z"/>"#,
                polyline(points)
            )?;
        }
    }
    for line in drawing.lines.iter().filter(|l| l.points.iter().flatten().all(|x| x.is_finite())) {
        let (color, width) = (to_hex(line.rgb()), decimal(2.0 * line.width * style.line()));
        writeln!(out, r#"<path stroke="{color}" stroke-width="{width}" d="{}"/>"#, polyline(&line.points))?;
    }
    writeln!(out, "</g>")?;
    let border = drawing.frame.border();
    if !border.is_empty() {
        let width = decimal(2.0 * style.line());
        writeln!(
            out,
            r#"<path stroke="{}" stroke-width="{width}" d="{}"/>"#,
            to_hex(INK),
            polyline(&border)
        )?;
    }
    for &dot in drawing.dots {
        let [x, y] = fit.apply(dot).map(decimal);
        let r = decimal(0.7 * style.cone());
        writeln!(out, r#"<circle cx="{x}" cy="{y}" r="{r}" fill="{}" stroke="white"/>"#, to_hex(INK))?;
    }
    for label in drawing.labels {
        let strokes = label.strokes(&fit, size);
        let Some((_, pen)) = strokes.first() else { continue };
        let stroke = |ends: &[[f64; 2]; 2]| {
            let [[a, b], [c, d]] = ends.map(|p| p.map(decimal));
            format!("M{a} {b}L{c} {d}")
        };
        let path: String = strokes.iter().map(|(ends, _)| stroke(ends)).collect();
        let color = to_hex(mix(seam_color(label.color), INK, 0.35));
        for (color, width) in [("#ffffff", 2.0 * HALO * pen), (color.as_str(), 2.0 * pen)] {
            writeln!(out, r#"<path stroke="{color}" stroke-width="{}" d="{path}"/>"#, decimal(width))?;
        }
    }
    writeln!(out, "</svg>")
}
