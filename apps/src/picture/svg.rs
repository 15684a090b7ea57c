//! The flat layout as SVG: patterns as patterns, triangles of one colour as one path, every number to a tenth of a pixel
//! or better.

use super::color::{cone_color, seam_color, to_hex};
use super::fit::Fit;
use super::flat::{DUAL_CIRCLE, FRAME, VERTEX_CIRCLE, fit};
use super::legend::Plan;
use super::texture::{CIRCLE_SPACING, RING, Texture, Tiles};
use super::{Circle, Field, Flat, Picture, Scale, Style};
use crate::failure::Failure;
use std::collections::HashMap;
use std::io::{Result, Write};

/// Colours of a map that are told apart.
const COLORS: usize = 40;
/// Circles of a smaller radius in pixels are left out.
const LEAST_RADIUS: f64 = 0.3;

/// The layout as SVG: pattern or colours, wire, circles, boundary, seams, cones, legend.
pub fn flat_svg(
    flat: &Flat<'_>,
    field: Option<&Field>,
    style: &Style,
) -> std::result::Result<Vec<u8>, Failure> {
    let mut out = Vec::new();
    let written = write_svg(&mut out, flat, field, style);
    written.map(|()| out).map_err(|e| Failure::Failed(e.to_string()))
}

fn write_svg(out: &mut Vec<u8>, flat: &Flat<'_>, field: Option<&Field>, style: &Style) -> Result<()> {
    let fit = fit(flat, style);
    let size = style.size as f64;
    let width = if field.is_some() { (fit.width as f64).max(0.75 * size) } else { fit.width as f64 };
    let legend = field.map(|f| (&f.scale, Plan::new(&f.scale, width, size)));
    let height = fit.height as f64 + legend.as_ref().map_or(0.0, |(_, plan)| plan.height);
    writeln!(
        out,
        r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {} {}" fill="none" stroke-linejoin="round">"#,
        decimal(width),
        decimal(height)
    )?;
    writeln!(out, r#"<path fill="white" d="M0 0H{}V{}H0Z"/>"#, decimal(width), decimal(height))?;
    writeln!(out, r#"<g transform="translate({} 0)">"#, decimal(0.5 * (width - fit.width as f64)))?;
    let drawing = Drawing { flat, fit, size, style };
    match field {
        Some(field) => drawing.colors(out, field)?,
        None => drawing.pattern(out, style.texture)?,
    }
    if style.wire {
        drawing.wire(out)?;
    }
    drawing.circles(out)?;
    drawing.lines(out)?;
    writeln!(out, "</g>")?;
    if let Some((scale, plan)) = &legend {
        write_legend(out, scale, plan, fit.height as f64)?;
    }
    writeln!(out, "</svg>")
}

struct Drawing<'a> {
    flat: &'a Flat<'a>,
    fit: Fit,
    size: f64,
    style: &'a Style,
}

impl Drawing<'_> {
    fn at(&self, p: [f64; 2]) -> String {
        let [x, y] = self.fit.apply(p);
        format!("{} {}", decimal(x), decimal(y))
    }

    /// Triangles in the colour of the middle of each.
    fn colors(&self, out: &mut impl Write, field: &Field) -> Result<()> {
        let table = field.scale.table(COLORS);
        let mut paths = vec![String::new(); COLORS];
        for (uv, value) in self.flat.corner_uv.iter().zip(&field.corners) {
            let t = field.scale.place((value[0] + value[1] + value[2]) / 3.0);
            if finite(uv) && !t.is_nan() {
                let [a, b, c] = uv.map(|p| self.at(p));
                paths[(t * (COLORS - 1) as f64 + 0.5) as usize] += &format!("M{a}L{b}L{c}Z");
            }
        }
        for (color, path) in table.into_iter().zip(paths).filter(|(_, path)| !path.is_empty()) {
            // The thin outline closes the gaps that anti-aliasing leaves between neighbours.
            let color = to_hex(color);
            writeln!(out, r#"<path fill="{color}" stroke="{color}" stroke-width="0.3" d="{path}"/>"#)?;
        }
        Ok(())
    }

    /// The outline of the layout, filled with the pattern at its median scale.
    fn pattern(&self, out: &mut impl Write, texture: Texture) -> Result<()> {
        let tiles = Picture { flat: Some(*self.flat), ..Picture::default() }.tiles();
        let side = tiles.map_or(1.0, |t: Tiles| t.size) * self.fit.scale;
        let [x, y] = self.fit.apply([0.0, 0.0]);
        let place = format!(r#"patternUnits="userSpaceOnUse" x="{}" y="{}""#, decimal(x), decimal(y));
        let fill = match texture {
            Texture::None => "#ede9e0",
            _ => "url(#pattern)",
        };
        match texture {
            Texture::Checker => writeln!(
                out,
                r##"<defs><pattern id="pattern" {place} width="{d}" height="{d}"><path fill="#f6f3ec" d="M0 0H{d}V{d}H0Z"/><path fill="#8fb0d1" d="M0 0H{s}V{s}H0ZM{s} {s}H{d}V{d}H{s}Z"/></pattern></defs>"##,
                s = decimal(side),
                d = decimal(2.0 * side),
            )?,
            Texture::Circles => {
                let step = side * CIRCLE_SPACING;
                let row = step * 0.75f64.sqrt();
                write!(
                    out,
                    r##"<defs><pattern id="pattern" {place} width="{0}" height="{1}"><path fill="#f6f3ec" d="M0 0H{0}V{1}H0Z"/>"##,
                    decimal(step),
                    decimal(2.0 * row)
                )?;
                let middle = 0.5 * (RING[0] + RING[1]) * step;
                let pen = (RING[0] - RING[1]) * step;
                for [x, y] in [[0.0, 0.0], [1.0, 0.0], [0.5, 1.0], [0.0, 2.0], [1.0, 2.0]] {
                    let (x, y) = (decimal(x * step), decimal(y * row));
                    write!(
                        out,
                        r##"<circle cx="{x}" cy="{y}" r="{}" stroke="#3a6ea5" stroke-width="{}"/><circle cx="{x}" cy="{y}" r="{}" fill="#3a6ea5"/>"##,
                        decimal(middle),
                        decimal(pen),
                        decimal(RING[2] * step)
                    )?;
                }
                writeln!(out, "</pattern></defs>")?;
            }
            Texture::None => {}
        }
        let sides = self.flat.boundary.iter().copied().chain(self.flat.seams.iter().map(|s| (s.0, s.1)));
        let path: String = loops(sides).iter().map(|l| self.polyline(l) + "Z").collect();
        writeln!(out, r#"<path fill="{fill}" d="{path}"/>"#)
    }

    fn polyline(&self, points: &[[f64; 2]]) -> String {
        let places: Vec<String> = points.iter().map(|p| self.at(*p)).collect();
        format!("M{}", places.join("L"))
    }

    fn wire(&self, out: &mut impl Write) -> Result<()> {
        writeln!(out, r##"<g stroke="#222" stroke-width="{}">"##, decimal(4e-4 * self.size))?;
        let faces: Vec<_> = self.flat.corner_uv.iter().filter(|uv| finite(&uv[..])).collect();
        for some in faces.chunks(500) {
            let path: String = some.iter().map(|uv| self.polyline(&uv[..]) + "Z").collect();
            writeln!(out, r#"<path d="{path}"/>"#)?;
        }
        writeln!(out, "</g>")
    }

    fn circles(&self, out: &mut impl Write) -> Result<()> {
        for (circles, color) in [(self.flat.dual_circles, DUAL_CIRCLE), (self.flat.circles, VERTEX_CIRCLE)] {
            if circles.is_empty() {
                continue;
            }
            writeln!(out, r##"<g stroke="#{color:06x}" stroke-width="{}">"##, decimal(7e-4 * self.size))?;
            for Circle { center, radius } in circles {
                let [x, y] = self.fit.apply(*center);
                let radius = self.fit.scale * radius;
                if [x, y, radius].iter().all(|v| v.is_finite()) && radius > LEAST_RADIUS {
                    let [x, y, r] = [x, y, radius].map(decimal);
                    writeln!(out, r#"<circle cx="{x}" cy="{y}" r="{r}"/>"#)?;
                }
            }
            writeln!(out, "</g>")?;
        }
        Ok(())
    }

    fn lines(&self, out: &mut impl Write) -> Result<()> {
        let (width, Flat { boundary, seams, cones, .. }) = (decimal(2.0 * self.style.line()), self.flat);
        for (a, b) in self.flat.frame {
            let (path, width) = (self.polyline(&[*a, *b]), decimal(self.style.line()));
            writeln!(out, r##"<path stroke="#{FRAME:06x}" stroke-width="{width}" d="{path}"/>"##)?;
        }
        writeln!(out, r#"<g stroke-width="{width}" stroke-linecap="round">"#)?;
        for points in loops(boundary.iter().copied()) {
            writeln!(out, r##"<path stroke="#1c1c21" d="{}"/>"##, self.polyline(&points))?;
        }
        let count = seams.iter().map(|s| s.2 + 1).max().unwrap_or(0);
        let mut of_seam = vec![Vec::new(); count];
        seams.iter().for_each(|&(a, b, seam)| of_seam[seam].push((a, b)));
        for (seam, sides) in of_seam.into_iter().enumerate() {
            let path: String = loops(sides.into_iter()).iter().map(|l| self.polyline(l)).collect();
            writeln!(out, r#"<path stroke="{}" d="{path}"/>"#, to_hex(seam_color(seam)))?;
        }
        writeln!(out, "</g>")?;
        for (p, curvature) in cones.iter().filter(|(p, _)| p.iter().all(|x| x.is_finite())) {
            let [x, y] = self.fit.apply(*p).map(decimal);
            let (r, color) = (decimal(self.style.cone()), to_hex(cone_color(*curvature)));
            writeln!(out, r#"<circle cx="{x}" cy="{y}" r="{r}" fill="{color}" stroke="white"/>"#)?;
        }
        Ok(())
    }
}

/// Chain segments end to start into lines; one that closes ends where it began.
fn loops(segments: impl Iterator<Item = ([f64; 2], [f64; 2])>) -> Vec<Vec<[f64; 2]>> {
    let segments: Vec<_> = segments.filter(|(a, b)| finite(&[*a, *b])).collect();
    let key = |p: [f64; 2]| p.map(f64::to_bits);
    let mut from: HashMap<_, Vec<usize>> = HashMap::new();
    let mut ends: HashMap<_, usize> = HashMap::new();
    for (i, (a, b)) in segments.iter().enumerate().rev() {
        from.entry(key(*a)).or_default().push(i);
        *ends.entry(key(*b)).or_default() += 1;
    }
    let mut used = vec![false; segments.len()];
    let mut chains = Vec::new();
    // Lines from their free ends first, then what is closed.
    let free = |i: &usize| !ends.contains_key(&key(segments[*i].0));
    let order: Vec<usize> = (0..segments.len()).filter(free).chain(0..segments.len()).collect();
    for first in order {
        let mut next = (!used[first]).then_some(first);
        let mut chain = Vec::new();
        while let Some(i) = next {
            used[i] = true;
            let (a, b) = segments[i];
            if chain.is_empty() {
                chain.push(a);
            }
            chain.push(b);
            let open = from.get_mut(&key(b));
            next = open.and_then(|list| {
                while list.last().is_some_and(|j| used[*j]) {
                    list.pop();
                }
                list.last().copied()
            });
        }
        if !chain.is_empty() {
            chains.push(chain);
        }
    }
    chains
}

fn write_legend(out: &mut impl Write, scale: &Scale, plan: &Plan, top: f64) -> Result<()> {
    let [left, bar_top, length, height] = plan.bar;
    writeln!(out, r#"<g transform="translate(0 {})">"#, decimal(top))?;
    write!(out, r#"<defs><linearGradient id="map">"#)?;
    // Pairs of stops, so that classes end where they end.
    const STEPS: usize = 16;
    for k in 0..STEPS {
        for t in [k as f64 + 0.001, k as f64 + 0.999].map(|x| x / STEPS as f64) {
            let color = to_hex(scale.on_bar(t));
            write!(out, r#"<stop offset="{}" stop-color="{color}"/>"#, decimal(t))?;
        }
    }
    writeln!(out, "</linearGradient></defs>")?;
    let [x, y, w, h] = [left, bar_top, length, height].map(decimal);
    writeln!(out, r#"<rect x="{x}" y="{y}" width="{w}" height="{h}" fill="url(#map)"/>"#)?;
    for &x in &plan.ticks {
        let (x, y, tick) = (decimal(x), decimal(bar_top + height), decimal(plan.tick));
        writeln!(out, r##"<path stroke="#1c1c21" stroke-width="0.8" d="M{x} {y}v{tick}"/>"##)?;
    }
    writeln!(out, r##"<g font-family="sans-serif" text-anchor="middle" fill="#1c1c21">"##)?;
    for (line, [x, y], letters) in &plan.lines {
        let (x, y, size) = (decimal(*x), decimal(*y), decimal(1.4 * letters));
        let line = line.replace('&', "&amp;").replace('<', "&lt;");
        writeln!(out, r#"<text x="{x}" y="{y}" font-size="{size}">{line}</text>"#)?;
    }
    writeln!(out, "</g></g>")
}

fn finite(points: &[[f64; 2]]) -> bool {
    points.as_flattened().iter().all(|x| x.is_finite())
}

/// Two decimals at most.
pub fn decimal(x: f64) -> String {
    let text = format!("{x:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".into() } else { text.into() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn segments_chain_into_lines_and_loops() {
        let p = |k: f64| [k, 0.0];
        let chains =
            loops([(p(2.0), p(3.0)), (p(1.0), p(2.0)), (p(7.0), p(8.0)), (p(8.0), p(7.0))].into_iter());
        assert_eq!(chains, [vec![p(1.0), p(2.0), p(3.0)], vec![p(7.0), p(8.0), p(7.0)]]);
    }

    #[test]
    fn numbers_are_short() {
        assert_eq!([1.0, -0.001, 12.345, 0.5].map(decimal), ["1", "0", "12.35", "0.5"]);
    }
}
