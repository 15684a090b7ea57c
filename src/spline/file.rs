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
use serde::Deserialize;
use std::io::Write;
use std::path::Path;
use std::sync::Arc;

/// What `format` says in files that this version reads and writes.
const FORMAT: &str = "ricci-spline 1";

#[derive(Deserialize)]
struct Document {
    format: String,
    degree: usize,
    patches: Vec<PatchEntry>,
    supports: Vec<Vec<SupportEntry>>,
    control_points: Vec<Vector>,
    /// Null where there is none, as in the plane.
    hole: Option<Vec<HoleEntry>>,
}

#[derive(Deserialize)]
struct PatchEntry {
    chart: u32,
    knots: [Vec<[f64; 2]>; 3],
    control: Vec<u32>,
}

#[derive(Deserialize)]
struct SupportEntry {
    patch: u32,
    to: [[f64; 3]; 2],
}

#[derive(Deserialize)]
struct HoleEntry {
    turns: i32,
    radius: f64,
    inner: f64,
    sectors: Vec<SectorEntry>,
    coefficients: Vec<Vector>,
}

#[derive(Deserialize)]
struct SectorEntry {
    patch: u32,
    angle: f64,
    to: [[f64; 3]; 2],
}

impl Spline {
    /// The text of the spline's file. Numbers are read back as they were: a spline has finite ones alone, whose [`Debug`](std::fmt::Debug)
    /// text is JSON.
    pub fn to_json(&self) -> String {
        let space = self.space();
        let patch = |Patch { chart, knots, control }: &Patch| {
            format!("{{\"chart\":{chart},\"knots\":{knots:?},\"control\":{control:?}}}")
        };
        let support = |Support { patch, to }: &Support| format!("{{\"patch\":{patch},\"to\":{to:?}}}");
        let sector = |Sector { patch, angle, to }: &Sector| {
            format!("{{\"patch\":{patch},\"angle\":{angle:?},\"to\":{to:?}}}")
        };
        let hole = |Hole { sectors, turns, radius, inner, fill, .. }: &Hole| {
            let sectors = list(sectors.iter().map(sector));
            let coefficients = fill.as_ref().map_or(&[][..], Fill::coefficients);
            format!(
                "{{\"turns\":{turns},\"radius\":{radius:?},\"inner\":{inner:?},\"sectors\":{sectors},\"coefficients\":{coefficients:?}}}"
            )
        };
        let supports = |of: &Vec<Support>| list(of.iter().map(support));
        format!(
            "{{\"format\":{FORMAT:?},\"degree\":{},\"patches\":{},\"supports\":{},\"control_points\":{:?},\"hole\":{}}}\n",
            space.degree(),
            list(space.patches().iter().map(patch)),
            list(space.supports().iter().map(supports)),
            self.control_points(),
            if self.holes().is_empty() { "null".into() } else { list(self.holes().iter().map(hole)) },
        )
    }

    /// A spline from the text of a file, which `name` names in errors.
    ///
    /// # Errors
    /// [`Error::Parse`] for a text that is not such a file, or one of a version that this library does not know; those of
    /// [`SplineSpace::new`] and [`Spline::new`].
    pub fn from_json(text: &str, name: &str) -> Result<Spline> {
        let parse = |at: FilePosition, message: String| Error::Parse { path: name.into(), at, message };
        let document: Document = serde_json::from_str(text)
            .map_err(|why| parse(FilePosition::Line(why.line()), why.to_string()))?;
        if document.format != FORMAT {
            let message = format!("format is {:?}, this version reads {FORMAT:?}", document.format);
            return Err(parse(FilePosition::Whole, message));
        }
        let patch = |p: PatchEntry| Patch { chart: p.chart, knots: p.knots, control: p.control };
        let support = |s: SupportEntry| Support { patch: s.patch, to: s.to };
        let patches = document.patches.into_iter().map(patch).collect();
        let supports =
            document.supports.into_iter().map(|of| of.into_iter().map(support).collect()).collect();
        let space = SplineSpace::new(document.degree, patches, supports)?;
        let sector = |s: SectorEntry| Sector { patch: s.patch, angle: s.angle, to: s.to };
        let first_chart = space.patches().len();
        let hole = |(k, h): (usize, HoleEntry)| {
            let sectors = h.sectors.into_iter().map(sector).collect();
            let hole = Hole::new((first_chart + k) as u32, sectors, h.turns, h.radius)?;
            let hole = Hole { inner: h.inner, ..hole };
            hole.filled_by(&space, Fill::new(h.coefficients)?)
        };
        let holes = document.hole.unwrap_or_default().into_iter().enumerate().map(hole);
        let holes = holes.collect::<Result<_>>()?;
        Ok(Spline::new(Arc::new(space), document.control_points)?.with_holes(holes))
    }

    /// Read a spline file.
    ///
    /// # Errors
    /// [`Error::Io`]; those of [`Spline::from_json`].
    pub fn read(path: &Path) -> Result<Spline> {
        let name = path.display().to_string();
        let text = std::fs::read_to_string(path)
            .map_err(|why| Error::Io { path: name.clone(), message: why.to_string() })?;
        Spline::from_json(&text, &name)
    }

    /// Write a spline file, whole or not at all.
    ///
    /// # Errors
    /// [`Error::Io`].
    pub fn write(&self, path: &Path) -> Result<()> {
        write_atomically(path, |out| out.write_all(self.to_json().as_bytes()))
    }
}

fn list(entries: impl Iterator<Item = String>) -> String {
    format!("[{}]", entries.collect::<Vec<_>>().join(","))
}
