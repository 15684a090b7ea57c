//! Spline files: JSON that says all that is needed to evaluate a spline (`ricci-spline 1`).
//!
//! `{format, degree, patches: [{chart, knots, control}…], supports: [[{patch, to}…]…], control_points: [[X, Y, Z]…], hole}`, where
//! `knots[k][j]` is t_{k,j} in the patch's chart, `control` is in the order of [`super::multi_indices`], and `supports[I]` has each patch
//! that reaches into I with the affine map from its chart to I's. `hole` is null, or has what fills the surroundings of singular vertices:
//! `[{turns, radius, inner, sectors: [{patch, angle, to}…], coefficients}…]`, see [`Hole`].

use super::fill::Fill;
use super::hole::{Hole, Sector};
use super::patch::{Patch, Support};
use super::space::SplineSpace;
use super::surface::Spline;
use crate::error::{Error, FilePosition, Result};
use crate::geometry::vector::Vector;
use crate::mesh::io::write_atomically;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::io::Write;
use std::path::Path;
use std::sync::Arc;

/// The value of `format` in files that this version reads and writes.
const FORMAT: &str = "ricci-spline 1";

/// The contents of a spline file.
#[derive(Serialize, Deserialize)]
struct SplineDocument<'a> {
    format: Cow<'a, str>,
    degree: usize,
    patches: Cow<'a, [Patch]>,
    supports: Cow<'a, [Vec<Support>]>,
    control_points: Cow<'a, [Vector]>,
    /// Null without holes, as in the plane.
    hole: Option<Vec<HoleEntry<'a>>>,
}

/// A hole with its filling.
#[derive(Serialize, Deserialize)]
struct HoleEntry<'a> {
    turns: f64,
    radius: f64,
    inner: f64,
    sectors: Cow<'a, [Sector]>,
    coefficients: Cow<'a, [Vector]>,
}

impl Spline {
    /// The text of the spline's file; numbers are read back bit for bit.
    pub fn to_json(&self) -> String {
        let space = self.space();
        let holes = self.holes().iter().map(|hole| HoleEntry {
            turns: hole.turns,
            radius: hole.radius,
            inner: hole.inner,
            sectors: (&hole.sectors).into(),
            coefficients: hole.fill.as_ref().map_or(&[][..], Fill::coefficients).into(),
        });
        let document = SplineDocument {
            format: FORMAT.into(),
            degree: space.degree(),
            patches: space.patches().into(),
            supports: space.supports().into(),
            control_points: self.control_points().into(),
            hole: (!self.holes().is_empty()).then(|| holes.collect()),
        };
        // Numbers and strings are always written to memory without an error.
        serde_json::to_string(&document).unwrap_or_default() + "\n"
    }

    /// A spline from the text of a file, which `name` names in errors.
    ///
    /// # Errors
    /// [`Error::Parse`] for a text that is not such a file, or one of a version that this library does not know; those of
    /// [`SplineSpace::new`] and [`Spline::new`].
    pub fn from_json(text: &str, name: &str) -> Result<Spline> {
        let parse = |at: FilePosition, message: String| Error::Parse { path: name.into(), at, message };
        let document: SplineDocument<'_> = serde_json::from_str(text)
            .map_err(|why| parse(FilePosition::Line(why.line()), why.to_string()))?;
        if document.format != FORMAT {
            let message = format!("format is {:?}, this version reads {FORMAT:?}", document.format);
            return Err(parse(FilePosition::Whole, message));
        }
        let SplineDocument { degree, patches, supports, control_points, hole, .. } = document;
        let space = SplineSpace::new(degree, patches.into_owned(), supports.into_owned())?;
        let first_chart = space.patches().len();
        let filled = |(k, entry): (usize, HoleEntry<'_>)| {
            let sectors = entry.sectors.into_owned();
            let hole = Hole::new((first_chart + k) as u32, sectors, entry.turns, entry.radius)?;
            let hole = Hole { inner: entry.inner, ..hole };
            hole.filled_by(&space, Fill::new(entry.coefficients.into_owned())?)
        };
        let holes = hole.unwrap_or_default().into_iter().enumerate().map(filled).collect::<Result<_>>()?;
        Ok(Spline::new(Arc::new(space), control_points.into_owned())?.with_holes(holes))
    }

    /// Reads a spline file.
    ///
    /// # Errors
    /// [`Error::Io`]; those of [`Spline::from_json`].
    pub fn read(path: &Path) -> Result<Spline> {
        let name = path.display().to_string();
        let text = std::fs::read_to_string(path)
            .map_err(|why| Error::Io { path: name.clone(), message: why.to_string() })?;
        Spline::from_json(&text, &name)
    }

    /// Writes a spline file, whole or not at all.
    ///
    /// # Errors
    /// [`Error::Io`].
    pub fn write(&self, path: &Path) -> Result<()> {
        write_atomically(path, |out| out.write_all(self.to_json().as_bytes()))
    }
}
