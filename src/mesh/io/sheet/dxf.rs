//! DXF of the release R12, in text: POLYLINE entities on named layers, which every program for drawing and cutting reads.

use super::{CuttingSheet, SheetLayer, SheetLine, SheetUnit};
use crate::error::{Error, Result};
use crate::mesh::io::shortest::Shortest;
use crate::mesh::io::write_atomically;
use std::io::{self, Write};
use std::path::Path;

/// The colour of a layer, by its number in DXF: 7 is black on white, 1 red, 5 blue, 3 green.
fn color(layer: SheetLayer) -> u8 {
    match layer {
        SheetLayer::Boundary => 7,
        SheetLayer::Seams => 1,
        SheetLayer::Folds => 5,
        SheetLayer::Allowance => 3,
    }
}

/// Writes a drawing as DXF R12, with the coordinates as they are and the fewest digits that read back. R12 has no entry for the unit,
/// which a comment names.
///
/// # Errors
/// With the file untouched: [`Error::Argument`] for points that are not finite or that do not exist; [`Error::Io`].
pub fn write_dxf(path: &Path, sheet: &CuttingSheet, unit: SheetUnit) -> Result<()> {
    sheet.check()?;
    write_atomically(path, |out| drawing(out, sheet, unit))
}

/// [`write_dxf`] to a stream.
///
/// # Errors
/// Those of [`write_dxf`].
pub fn write_dxf_to(out: &mut impl Write, sheet: &CuttingSheet, unit: SheetUnit) -> Result<()> {
    sheet.check()?;
    let failed = |e: io::Error| Error::Io { path: "the stream".into(), message: e.to_string() };
    drawing(out, sheet, unit).map_err(failed)
}

fn drawing(out: &mut impl Write, sheet: &CuttingSheet, unit: SheetUnit) -> io::Result<()> {
    let [low, high] = sheet.bounds();
    write!(out, "999\nricci: one unit of the drawing is 1 {}\n", unit.symbol())?;
    write!(out, "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1009\n")?;
    for (name, [x, y]) in [("$EXTMIN", low), ("$EXTMAX", high)] {
        write!(out, "9\n{name}\n10\n{}\n20\n{}\n30\n0.0\n", Shortest(x), Shortest(y))?;
    }
    write!(out, "0\nENDSEC\n0\nSECTION\n2\nTABLES\n")?;
    write!(
        out,
        "0\nTABLE\n2\nLTYPE\n70\n1\n0\nLTYPE\n2\nCONTINUOUS\n70\n0\n3\nSolid line\n72\n65\n73\n0\n40\n0.0\n0\nENDTAB\n"
    )?;
    write!(out, "0\nTABLE\n2\nLAYER\n70\n{}\n", SheetLayer::ALL.len())?;
    for layer in SheetLayer::ALL {
        write!(out, "0\nLAYER\n2\n{}\n70\n0\n62\n{}\n6\nCONTINUOUS\n", layer.name(), color(layer))?;
    }
    write!(out, "0\nENDTAB\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n")?;
    for line in &sheet.lines {
        polyline(out, sheet, line)?;
    }
    write!(out, "0\nENDSEC\n0\nEOF\n")
}

fn polyline(out: &mut impl Write, sheet: &CuttingSheet, line: &SheetLine) -> io::Result<()> {
    let (layer, closed) = (line.layer.name(), u8::from(line.is_closed));
    write!(out, "0\nPOLYLINE\n8\n{layer}\n66\n1\n10\n0.0\n20\n0.0\n30\n0.0\n70\n{closed}\n")?;
    for [x, y] in sheet.places(line) {
        write!(out, "0\nVERTEX\n8\n{layer}\n10\n{}\n20\n{}\n30\n0.0\n", Shortest(x), Shortest(y))?;
    }
    write!(out, "0\nSEQEND\n8\n{layer}\n")
}
