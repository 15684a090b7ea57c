//! The record of a triangular spline.

use crate::archive::{ArchiveReader, ArchiveWriter, Kept, Stored, stored};
use crate::error::Result;
use crate::spline::Spline;

/// The figures of a fit.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SplineFigures {
    /// The root mean square of the distances to the points.
    pub rms: f64,
    /// The largest of these distances.
    pub max: f64,
    /// The patches in which the spline of a surface folds, ascending.
    pub folds: Vec<u32>,
    /// The share of the surface in these patches.
    pub folded_share: f64,
    /// True for a surface that is within its tolerance and does not fold.
    pub holds: bool,
}
stored!(sections SplineFigures { rms, max, folds, folded_share, holds });

/// A spline, with the figures of its fit if it was fitted.
#[derive(Debug, Clone)]
pub struct SplineRecord {
    /// The spline.
    pub spline: Spline,
    /// The figures of the fit.
    pub figures: Option<SplineFigures>,
}
stored!(sections SplineRecord { spline, figures });

impl Kept for SplineRecord {
    const KIND: &'static str = "spline";
}

/// A spline is kept as the text of its file, which reads back bit for bit.
impl Stored for Spline {
    const LEAST: usize = String::LEAST;

    fn write(&self, to: &mut ArchiveWriter) {
        self.to_json().write(to);
    }

    fn read(from: &mut ArchiveReader<'_>) -> Result<Self> {
        let text = String::read(from)?;
        Spline::from_json(&text, "spline of the archive")
    }
}
