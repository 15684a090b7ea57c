//! SVG drawings true to size: the view box is in the unit of the coordinates, width and height in millimetres or inches.

use super::{CuttingSheet, SheetLayer, SheetUnit};
use crate::error::{Error, Result};
use crate::mesh::io::shortest::Shortest;
use crate::mesh::io::write_atomically;
use std::io::{self, Write};
use std::path::Path;

/// The room around the lines, as a share of the diagonal of their bounding box, so that strokes are not cut off.
const MARGIN: f64 = 0.01;
/// The width of the lines, as a share of the same diagonal.
const STROKE: f64 = 0.001;

fn color(layer: SheetLayer) -> &'static str {
    match layer {
        SheetLayer::Boundary => "#000000",
        SheetLayer::Seams => "#ff0000",
        SheetLayer::Folds => "#0000ff",
        SheetLayer::Allowance => "#00a000",
    }
}

/// Writes a drawing as SVG: a group for each layer, which bears its name as its id and is a layer in Inkscape, and a path for each line. The
/// coordinates are (x, −y), since y runs down in SVG, with the fewest digits that read back.
///
/// # Errors
/// With the file untouched: [`Error::Argument`] for points that are not finite or that do not exist; [`Error::Io`].
pub fn write_svg(path: &Path, sheet: &CuttingSheet, unit: SheetUnit) -> Result<()> {
    sheet.check()?;
    write_atomically(path, |out| drawing(out, sheet, unit))
}

/// [`write_svg`] to a stream.
///
/// # Errors
/// Those of [`write_svg`].
pub fn write_svg_to(out: &mut impl Write, sheet: &CuttingSheet, unit: SheetUnit) -> Result<()> {
    sheet.check()?;
    let failed = |e: io::Error| Error::Io { path: "the stream".into(), message: e.to_string() };
    drawing(out, sheet, unit).map_err(failed)
}

fn drawing(out: &mut impl Write, sheet: &CuttingSheet, unit: SheetUnit) -> io::Result<()> {
    let [low, high] = sheet.bounds();
    let diagonal = (high[0] - low[0]).hypot(high[1] - low[1]);
    let margin = MARGIN * diagonal;
    let size = [0, 1].map(|k| high[k] - low[k] + 2.0 * margin);
    // SVG knows no metres.
    let (scale, symbol) = match unit {
        SheetUnit::Metre => (unit.millimetres(), SheetUnit::Millimetre.symbol()),
        unit => (1.0, unit.symbol()),
    };
    let [width, height] = size.map(|side| format!("{}{symbol}", Shortest(scale * side)));
    let [x, y] = [low[0] - margin, -high[1] - margin].map(Shortest);
    let [w, h] = size.map(Shortest);
    writeln!(
        out,
        r#"<svg xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" width="{width}" height="{height}" viewBox="{x} {y} {w} {h}" fill="none" stroke-width="{}">"#,
        Shortest(STROKE * diagonal)
    )?;
    for layer in SheetLayer::ALL {
        let (name, color) = (layer.name(), color(layer));
        writeln!(
            out,
            r#"<g id="{name}" inkscape:groupmode="layer" inkscape:label="{name}" stroke="{color}">"#
        )?;
        for line in sheet.lines.iter().filter(|line| line.layer == layer) {
            write!(out, r#"<path d="M"#)?;
            for (k, [x, y]) in sheet.places(line).enumerate() {
                // 0 − y has no negative zero.
                write!(out, "{}{} {}", if k > 0 { "L" } else { "" }, Shortest(x), Shortest(0.0 - y))?;
            }
            writeln!(out, r#"{}"/>"#, if line.is_closed { "Z" } else { "" })?;
        }
        writeln!(out, "</g>")?;
    }
    writeln!(out, "</svg>")
}
