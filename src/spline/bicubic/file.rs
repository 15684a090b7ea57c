//! Files of bicubic patches: JSON that says all that is needed to evaluate them (`ricci-patches 1`).
//!
//! `{format, points: [[X, Y, Z]…], curves: [{ends, knots, control}…], patches: [{source, knots, control, sides}…]}`: `ends` are points;
//! `control[i][j]` of a patch has i along s; `sides` are four `{curve, reversed}` along the way around; `source` is the patch of the spline
//! and its corner.

use super::surface::{BicubicPatch, BicubicSurface, PatchCurve};
use crate::error::{Error, FilePosition, Result};
use crate::geometry::vector::Vector;
use crate::mesh::io::write_atomically;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::io::Write;
use std::path::Path;

/// The value of `format` in files that this version reads and writes.
const FORMAT: &str = "ricci-patches 1";

/// The contents of a file of patches.
#[derive(Serialize, Deserialize)]
struct BicubicDocument<'a> {
    format: Cow<'a, str>,
    points: Cow<'a, [Vector]>,
    curves: Cow<'a, [PatchCurve]>,
    patches: Cow<'a, [BicubicPatch]>,
}

impl BicubicSurface {
    /// Writes the patches as JSON; numbers are read back bit for bit.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write_json(&self, out: &mut impl Write) -> std::io::Result<()> {
        let document = BicubicDocument {
            format: FORMAT.into(),
            points: (&self.points).into(),
            curves: (&self.curves).into(),
            patches: (&self.patches).into(),
        };
        serde_json::to_writer(&mut *out, &document)?;
        writeln!(out)
    }

    /// Patches from the text of a file, which `name` names in errors.
    ///
    /// # Errors
    /// [`Error::Parse`] for a text that is not such a file, or one of a version that this library does not know; those of
    /// [`BicubicSurface::check`].
    pub fn from_json(text: &str, name: &str) -> Result<BicubicSurface> {
        let parse = |at: FilePosition, message: String| Error::Parse { path: name.into(), at, message };
        let document: BicubicDocument<'_> = serde_json::from_str(text)
            .map_err(|why| parse(FilePosition::Line(why.line()), why.to_string()))?;
        if document.format != FORMAT {
            let message = format!("format is {:?}, this version reads {FORMAT:?}", document.format);
            return Err(parse(FilePosition::Whole, message));
        }
        let surface = BicubicSurface {
            points: document.points.into_owned(),
            curves: document.curves.into_owned(),
            patches: document.patches.into_owned(),
        };
        surface.check()?;
        Ok(surface)
    }

    /// Reads a file of patches.
    ///
    /// # Errors
    /// [`Error::Io`]; those of [`BicubicSurface::from_json`].
    pub fn read(path: &Path) -> Result<BicubicSurface> {
        let name = path.display().to_string();
        let text = std::fs::read_to_string(path)
            .map_err(|why| Error::Io { path: name.clone(), message: why.to_string() })?;
        BicubicSurface::from_json(&text, &name)
    }

    /// Writes a file of patches, whole or not at all.
    ///
    /// # Errors
    /// [`Error::Io`].
    pub fn write(&self, path: &Path) -> Result<()> {
        write_atomically(path, |out| self.write_json(out))
    }
}
