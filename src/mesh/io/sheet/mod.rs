//! Drawings for cutting: lines in the plane, each on a named layer, written as SVG or DXF.
//!
//! ```
//! use ricci::mesh::io::{CuttingSheet, SheetLayer, SheetLine, SheetUnit, write_dxf_to};
//! let points = vec![[0.0, 0.0], [30.0, 0.0], [0.0, 20.0]];
//! let line = SheetLine { layer: SheetLayer::Boundary, seam: None, points: vec![0, 1, 2], is_closed: true };
//! let mut file = Vec::new();
//! write_dxf_to(&mut file, &CuttingSheet { points, lines: vec![line] }, SheetUnit::Millimetre)?;
//! assert!(String::from_utf8_lossy(&file).contains("BOUNDARY"));
//! # Ok::<(), ricci::Error>(())
//! ```

mod allowance;
mod dxf;
mod svg;

pub use dxf::{write_dxf, write_dxf_to};
pub use svg::{write_svg, write_svg_to};

use super::soup::finite;
use crate::error::{Error, Result};

/// The layer of a line; its name in files is [`SheetLayer::name`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum SheetLayer {
    /// The boundary of the surface.
    Boundary,
    /// A side of a seam, along which the surface was opened; the other side is another line.
    Seams,
    /// An edge along which the surface in space has a crease.
    Folds,
    /// A line outside the border, where a sheet is cut that is to be sewn along it ([`CuttingSheet::with_allowance`]).
    Allowance,
}

impl SheetLayer {
    /// All layers, in the order in which files list them.
    pub const ALL: [SheetLayer; 4] =
        [SheetLayer::Boundary, SheetLayer::Seams, SheetLayer::Folds, SheetLayer::Allowance];

    /// The name of the layer in files.
    pub fn name(self) -> &'static str {
        match self {
            SheetLayer::Boundary => "BOUNDARY",
            SheetLayer::Seams => "SEAMS",
            SheetLayer::Folds => "FOLDS",
            SheetLayer::Allowance => "ALLOWANCE",
        }
    }
}

/// The unit of the coordinates of a drawing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SheetUnit {
    /// Millimetres.
    #[default]
    Millimetre,
    /// Centimetres.
    Centimetre,
    /// Metres.
    Metre,
    /// Inches of 25.4 mm.
    Inch,
}

impl SheetUnit {
    /// The length of the unit in millimetres.
    pub fn millimetres(self) -> f64 {
        match self {
            SheetUnit::Millimetre => 1.0,
            SheetUnit::Centimetre => 10.0,
            SheetUnit::Metre => 1000.0,
            SheetUnit::Inch => 25.4,
        }
    }

    /// The symbol of the unit.
    pub fn symbol(self) -> &'static str {
        match self {
            SheetUnit::Millimetre => "mm",
            SheetUnit::Centimetre => "cm",
            SheetUnit::Metre => "m",
            SheetUnit::Inch => "in",
        }
    }
}

/// A polygonal line of a drawing.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SheetLine {
    /// The layer that the line is on.
    pub layer: SheetLayer,
    /// The number of the seam that the line is a side of; `None` on the other layers.
    pub seam: Option<u32>,
    /// The points along the line, as indices into [`CuttingSheet::points`]. A closed line does not repeat its first point.
    pub points: Vec<u32>,
    /// True if the line goes on from its last point to the first.
    pub is_closed: bool,
}

/// Lines in the plane.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CuttingSheet {
    /// The points of the lines; others may be among them.
    pub points: Vec<[f64; 2]>,
    /// The lines.
    pub lines: Vec<SheetLine>,
}

impl CuttingSheet {
    /// The points along a line; a closed line does not repeat its first point.
    pub fn places<'a>(&'a self, line: &'a SheetLine) -> impl ExactSizeIterator<Item = [f64; 2]> + 'a {
        line.points.iter().map(|&k| self.points[k as usize])
    }

    /// The length of a line, the side back to the first point of a closed one included.
    pub fn length(&self, line: &SheetLine) -> f64 {
        let places: Vec<[f64; 2]> = self.places(line).collect();
        let side = |p: [f64; 2], q: [f64; 2]| (q[0] - p[0]).hypot(q[1] - p[1]);
        let open: f64 = places.windows(2).map(|pair| side(pair[0], pair[1])).sum();
        match (line.is_closed, places.first(), places.last()) {
            (true, Some(&first), Some(&last)) => open + side(last, first),
            _ => open,
        }
    }

    /// The least and the largest coordinates of the lines, `[[x, y], [x, y]]`; zeros if there are none.
    pub fn bounds(&self) -> [[f64; 2]; 2] {
        let mut places = self.lines.iter().flat_map(|line| self.places(line));
        let Some(first) = places.next() else { return [[0.0; 2]; 2] };
        places.fold([first; 2], |[low, high], p| {
            [[0, 1].map(|k| low[k].min(p[k])), [0, 1].map(|k| high[k].max(p[k]))]
        })
    }

    /// Checks that lines name points, and that these are finite.
    fn check(&self) -> Result<()> {
        finite("point", &self.points)?;
        let n = self.points.len();
        match self.lines.iter().position(|line| line.points.iter().any(|&k| k as usize >= n)) {
            Some(line) => {
                let value = format!("one of line {line}");
                Err(Error::argument("point", value, "lines must name points below their number"))
            }
            None => Ok(()),
        }
    }
}
