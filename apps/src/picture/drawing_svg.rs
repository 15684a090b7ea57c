//! Drawings in a model of the plane as SVG: tiles of one colour, lines and lettering.

use super::Style;
use super::color::{INK, from_hex, mix, seam_color, to_hex};
use super::drawing::{Drawing, EMPTY, Frame, tints};
use super::fit::Fit;
use super::lettering::HALO;
use super::svg::decimal;

/// A drawing as SVG.
pub fn drawing_svg(drawing: &Drawing<'_>, style: &Style) -> Vec<u8> {
    let sheet = Sheet { fit: drawing.frame.fit(style.size), style };
    let [width, height] = [sheet.fit.width, sheet.fit.height];
    let inside = sheet.inside(drawing);
    let over = sheet.over(drawing);
    format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" fill="none" stroke-linejoin="round" stroke-linecap="round">
<path fill="white" d="M0 0H{width}V{height}H0Z"/>
{inside}{over}</svg>
"#
    )
    .into_bytes()
}

struct Sheet<'a> {
    fit: Fit,
    style: &'a Style,
}

impl Sheet<'_> {
    fn polyline(&self, points: &[[f64; 2]]) -> String {
        let at = |p: &[f64; 2]| {
            let [x, y] = self.fit.apply(*p).map(decimal);
            format!("{x} {y}")
        };
        format!("M{}", points.iter().map(at).collect::<Vec<_>>().join("L"))
    }

    /// What ends at the frame: its ground, the copies, the lines.
    fn inside(&self, drawing: &Drawing<'_>) -> String {
        let [low, high] = drawing.frame.corners();
        let ([x0, y1], [x1, y0]) = (self.fit.apply(low), self.fit.apply(high));
        let [x, y, w, h] = [x0, y0, x1 - x0, y1 - y0].map(decimal);
        let frame = format!(r#"x="{x}" y="{y}" width="{w}" height="{h}"/>"#);
        let mut text = format!(
            r#"<defs><clipPath id="frame"><rect {frame}</clipPath></defs><g clip-path="url(#frame)">
"#
        );
        let empty = to_hex(from_hex(EMPTY));
        let finite = |points: &[[f64; 2]]| points.as_flattened().iter().all(|x| x.is_finite());
        match drawing.frame {
            Frame::Disk => {
                let disk = self.polyline(&drawing.frame.border());
                text += &format!("<path fill=\"{empty}\" d=\"{disk}Z\"/>\n");
            }
            Frame::HalfPlane(_) => text += &format!("<rect fill=\"{empty}\" {frame}\n"),
            Frame::Rectangle(_) => {}
        }
        for (points, tint) in drawing.outlines.iter().filter(|(points, _)| finite(points)) {
            let [light, dark] = tints(*tint);
            let (fill, path) = (to_hex(mix(light, dark, 0.25)), self.polyline(points));
            // The outline in the same colour closes the gaps that anti-aliasing leaves between neighbours.
            text +=
                &format!("<path fill=\"{fill}\" stroke=\"{fill}\" stroke-width=\"0.3\" d=\"{path}Z\"/>\n");
        }
        for line in drawing.lines.iter().filter(|l| finite(&l.points)) {
            text += &self.stroke(
                &to_hex(line.rgb()),
                line.width * self.style.line(),
                &self.polyline(&line.points),
            );
        }
        text + "</g>\n"
    }

    /// A path in this colour with half the width of its pen.
    fn stroke(&self, color: &str, pen: f64, path: &str) -> String {
        format!("<path stroke=\"{color}\" stroke-width=\"{}\" d=\"{path}\"/>\n", decimal(2.0 * pen))
    }

    /// What lies over it all: the border of the model, dots, labels.
    fn over(&self, drawing: &Drawing<'_>) -> String {
        let mut text = String::new();
        let border = drawing.frame.border();
        if !border.is_empty() {
            text += &self.stroke(&to_hex(INK), self.style.line(), &self.polyline(&border));
        }
        for &dot in drawing.dots {
            let [x, y] = self.fit.apply(dot).map(decimal);
            let (r, color) = (decimal(0.7 * self.style.cone()), to_hex(INK));
            text += &format!("<circle cx=\"{x}\" cy=\"{y}\" r=\"{r}\" fill=\"{color}\" stroke=\"white\"/>\n");
        }
        for label in drawing.labels {
            let strokes = label.strokes(&self.fit, self.style.size as f64);
            let Some((_, pen)) = strokes.first() else { continue };
            let stroke = |ends: &[[f64; 2]; 2]| {
                let [[a, b], [c, d]] = ends.map(|p| p.map(decimal));
                format!("M{a} {b}L{c} {d}")
            };
            let path: String = strokes.iter().map(|(ends, _)| stroke(ends)).collect();
            let color = to_hex(mix(seam_color(label.color), INK, 0.35));
            text += &self.stroke("#ffffff", HALO * pen, &path);
            text += &self.stroke(&color, *pen, &path);
        }
        text
    }
}
