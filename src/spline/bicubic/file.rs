//! Files of bicubic patches: JSON that says all that is needed to evaluate them (`ricci-patches 1`).
//!
//! `{format, points: [[X, Y, Z]…], curves: [{ends, knots, control}…], patches: [{source, knots, control, sides}…]}`: `ends` are points;
//! `control[i][j]` of a patch has i along s; `sides` are four `{curve, reversed}` along the way around; `source` is the patch of the spline
//! and its corner.

use super::surface::{BicubicPatch, BicubicSurface, PatchCurve, PatchSide};
use crate::error::{Error, FilePosition, Result};
use crate::geometry::vector::Vector;
use crate::mesh::io::write_atomically;
use serde::Deserialize;
use std::io::Write;
use std::path::Path;

/// What `format` says in files that this version reads and writes.
const FORMAT: &str = "ricci-patches 1";

#[derive(Deserialize)]
struct Document {
    format: String,
    points: Vec<Vector>,
    curves: Vec<CurveEntry>,
    patches: Vec<PatchEntry>,
}

#[derive(Deserialize)]
struct CurveEntry {
    ends: [u32; 2],
    knots: Vec<f64>,
    control: Vec<Vector>,
}

#[derive(Deserialize)]
struct PatchEntry {
    source: (u32, usize),
    knots: [Vec<f64>; 2],
    control: Vec<Vec<Vector>>,
    sides: [SideEntry; 4],
}

#[derive(Deserialize)]
struct SideEntry {
    curve: u32,
    reversed: bool,
}

impl BicubicSurface {
    /// Write the patches as JSON. Numbers are read back as they were: the [`Debug`](std::fmt::Debug) text of finite ones is JSON.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write_json(&self, out: &mut impl Write) -> std::io::Result<()> {
        write!(out, "{{\"format\":{FORMAT:?},\"points\":{:?},\"curves\":[", self.points)?;
        for (at, PatchCurve { ends, knots, control }) in self.curves.iter().enumerate() {
            let comma = if at > 0 { "," } else { "" };
            write!(out, "{comma}\n{{\"ends\":{ends:?},\"knots\":{knots:?},\"control\":{control:?}}}")?;
        }
        write!(out, "],\n\"patches\":[")?;
        for (at, BicubicPatch { source, knots, control, sides }) in self.patches.iter().enumerate() {
            let comma = if at > 0 { "," } else { "" };
            let (patch, corner) = source;
            write!(
                out,
                "{comma}\n{{\"source\":[{patch},{corner}],\"knots\":{knots:?},\"control\":{control:?},"
            )?;
            let side =
                |PatchSide { curve, reversed }| format!("{{\"curve\":{curve},\"reversed\":{reversed}}}");
            write!(out, "\"sides\":[{}]}}", sides.map(side).join(","))?;
        }
        writeln!(out, "]}}")
    }

    /// Patches from the text of a file, which `name` names in errors.
    ///
    /// # Errors
    /// [`Error::Parse`] for a text that is not such a file, or one of a version that this library does not know; those of
    /// [`BicubicSurface::check`].
    pub fn from_json(text: &str, name: &str) -> Result<BicubicSurface> {
        let parse = |at: FilePosition, message: String| Error::Parse { path: name.into(), at, message };
        let document: Document = serde_json::from_str(text)
            .map_err(|why| parse(FilePosition::Line(why.line()), why.to_string()))?;
        if document.format != FORMAT {
            let message = format!("format is {:?}, this version reads {FORMAT:?}", document.format);
            return Err(parse(FilePosition::Whole, message));
        }
        let curve = |c: CurveEntry| PatchCurve { ends: c.ends, knots: c.knots, control: c.control };
        let side = |s: SideEntry| PatchSide { curve: s.curve, reversed: s.reversed };
        let patch = |p: PatchEntry| BicubicPatch {
            source: p.source,
            knots: p.knots,
            control: p.control,
            sides: p.sides.map(side),
        };
        let surface = BicubicSurface {
            points: document.points,
            curves: document.curves.into_iter().map(curve).collect(),
            patches: document.patches.into_iter().map(patch).collect(),
        };
        surface.check()?;
        Ok(surface)
    }

    /// Read a file of patches.
    ///
    /// # Errors
    /// [`Error::Io`]; those of [`BicubicSurface::from_json`].
    pub fn read(path: &Path) -> Result<BicubicSurface> {
        let name = path.display().to_string();
        let text = std::fs::read_to_string(path)
            .map_err(|why| Error::Io { path: name.clone(), message: why.to_string() })?;
        BicubicSurface::from_json(&text, &name)
    }

    /// Write a file of patches, whole or not at all.
    ///
    /// # Errors
    /// [`Error::Io`].
    pub fn write(&self, path: &Path) -> Result<()> {
        write_atomically(path, |out| self.write_json(out))
    }
}
