//! The key below a picture: what its lines, dots and circles stand for.

use super::color::{INK, Rgb, cone_color, from_hex, seam_color};
use super::content::{LineMeaning, Picture};
use super::flat::{DUAL_CIRCLE, VERTEX_CIRCLE};
use super::scene::Style;
use super::sheet::{SvgPath, VectorSheet};
use super::text::{CAPITALS, Lettering, line};

/// Most lines of different colours in the sample of an entry.
const SAMPLES: usize = 3;
/// Height of a row, radius of a circle and of a dot, width of lines, over the size of letters.
const ROW: f64 = 1.45;
const RADIUS: f64 = 0.38;
const DOT: f64 = 0.26;
const THICK: f64 = 0.12;
/// The left ends of the texts, over the size of letters.
const INDENT: f64 = 2.0;

/// The mark before the text of an entry.
enum Mark {
    Circle(Rgb),
    Dot(Rgb),
    Lines(Vec<Rgb>),
}

/// The entries for what a picture has, in the order in which they stand below one another.
fn entries(picture: &Picture<'_>) -> Vec<(Mark, &'static str)> {
    let mut entries = Vec::new();
    let flat = picture.flat.unwrap_or_default();
    let on_surface = picture.surface.iter().flat_map(|s| s.seams).map(|seam| seam.2);
    let mut seams: Vec<usize> = flat.seams.iter().map(|seam| seam.2).chain(on_surface).collect();
    seams.sort_unstable();
    seams.dedup();
    let lines = |seams: &[usize]| Mark::Lines(seams.iter().take(SAMPLES).map(|&k| seam_color(k)).collect());
    let of = |k: usize| seams.iter().copied().filter(|s| *s == k).collect::<Vec<_>>();
    if !seams.is_empty() {
        match picture.lines {
            LineMeaning::Seams => entries.push((lines(&seams), "seams: sides of one colour belong together")),
            LineMeaning::Sides => {
                entries.push((lines(&seams), "sides of one colour are carried onto each other"));
            }
            LineMeaning::Charts => entries.push((lines(&seams), "borders of cores of charts")),
            LineMeaning::Cut => entries.push((lines(&seams), "cut, across which the integral jumps")),
            LineMeaning::Trajectories => {
                entries.push((lines(&of(0)), "horizontal trajectories"));
                entries.push((lines(&of(1)), "vertical trajectories"));
            }
            LineMeaning::Quads => entries.push((lines(&seams), "edges of quads")),
            LineMeaning::Arcs => {
                let named = [(of(0), "arcs between patches"), (of(1), "arcs on features and the boundary")];
                let there = named.into_iter().filter(|(arcs, _)| !arcs.is_empty());
                entries.extend(there.map(|(arcs, name)| (lines(&arcs), name)));
            }
            LineMeaning::Geodesics => entries.push((lines(&seams), "shortest closed geodesics")),
            LineMeaning::Untold => {}
        }
    }
    let on_surface = picture.surface.iter().flat_map(|s| s.cones).map(|cone| cone.1);
    let cones: Vec<f64> = flat.cones.iter().map(|cone| cone.1).chain(on_surface).collect();
    let names = match picture.lines {
        LineMeaning::Sides => {
            ["corners of the boundary, less than 180°", "corners of the boundary, more than 180°"]
        }
        LineMeaning::Charts => ["singular vertices"; 2],
        LineMeaning::Quads | LineMeaning::Arcs => {
            ["irregular vertices with fewer quads around them", "irregular vertices with more quads"]
        }
        _ => [
            "cones of positive curvature, less than 360° around",
            "cones of negative curvature, more than 360°",
        ],
    };
    for (sign, text) in [1.0, -1.0].into_iter().zip(names) {
        if picture.lines != LineMeaning::Untold && cones.iter().any(|k| sign * k > 0.0) {
            entries.push((Mark::Dot(cone_color(sign)), text));
        }
    }
    for (circles, color, text) in [
        (flat.circles, VERTEX_CIRCLE, "circles of the vertices"),
        (flat.dual_circles, DUAL_CIRCLE, "circles of the faces, orthogonal to those"),
    ] {
        if !circles.is_empty() {
            entries.push((Mark::Circle(from_hex(color)), text));
        }
    }
    entries
}

/// The key of a picture, if there is anything to tell.
pub fn draw(picture: &Picture<'_>, style: &Style) -> Option<VectorSheet> {
    let (letters, entries) = (style.letters(), entries(picture));
    let written: Vec<Lettering> = entries.iter().map(|(_, text)| line(text, letters)).collect();
    let widest = written.iter().map(|l| l.width).fold(0.0, f64::max);
    let width = (widest + (INDENT + 1.0) * letters).ceil() as usize;
    let height = (ROW * letters * entries.len() as f64 + 0.6 * letters).ceil() as usize;
    let mut sheet = VectorSheet::new(width, height);
    for (k, ((mark, text), lettering)) in entries.iter().zip(&written).enumerate() {
        let y = ROW * letters * (k as f64 + 0.9);
        let middle = y - 0.5 * CAPITALS * letters;
        let mut path = SvgPath::default();
        match mark {
            Mark::Circle(color) => {
                path.circle([letters, middle], RADIUS * letters);
                sheet.stroke(*color, THICK * letters, &path);
            }
            Mark::Dot(color) => {
                path.circle([letters, middle], DOT * letters);
                sheet.fill(*color, &path);
            }
            Mark::Lines(colors) => {
                for (i, color) in colors.iter().enumerate() {
                    let mut path = SvgPath::default();
                    let y = middle + RADIUS * letters * (i as f64 - 0.5 * (colors.len() - 1) as f64);
                    path.line(&[[0.4 * letters, y], [1.6 * letters, y]]);
                    sheet.stroke(*color, THICK * letters, &path);
                }
            }
        }
        sheet.write(text, &lettering.path, ([INDENT * letters, y], INK), 0.0);
    }
    (!entries.is_empty()).then_some(sheet)
}

#[cfg(test)]
mod tests {
    use super::super::scene::ShownLayout;
    use super::*;

    #[test]
    fn the_key_tells_what_a_picture_has_and_nothing_else() {
        let told = |picture: &Picture<'_>| {
            let svg = draw(picture, &Style::default()).map(|sheet| String::from_utf8(sheet.svg()).unwrap());
            let svg = svg.unwrap_or_default();
            let labels = svg.split("aria-label=\"").skip(1).filter_map(|s| s.split('"').next());
            labels
                .map(|label| label.split([':', ',']).next().unwrap_or_default().to_string())
                .collect::<Vec<_>>()
        };
        assert!(told(&Picture::default()).is_empty());
        let (seams, cones) = ([([0.0; 2], [1.0; 2], 0)], [([0.0; 2], 1.0), ([1.0; 2], -1.0)]);
        let flat = Some(ShownLayout { seams: &seams, cones: &cones, ..ShownLayout::default() });
        let picture = Picture { flat, ..Picture::default() };
        assert_eq!(told(&picture), ["seams", "cones of positive curvature", "cones of negative curvature"]);
        let cut = Picture { lines: LineMeaning::Cut, ..picture };
        assert_eq!(told(&cut)[0], "cut");
        assert!(told(&Picture { lines: LineMeaning::Untold, ..picture }).is_empty());
    }
}
