//! Files of splines over four-sided patches: JSON that any reader of knots and control points can evaluate (`ricci-quad-spline 1`).
//!
//! `{format, degree, patches: [{knots_u, knots_v, control}…], control_points: [[X, Y, Z]…], creases: [[patch, side]…]}`: `control[i][j]` is
//! the number of a control point, i along u, j along v; `creases` are the sides of patches across which normals may jump.

use super::spline::QuadSpline;
use crate::geometry::vector::Vector;
use serde::Serialize;
use std::io::Write;

/// The value of `format`.
const FORMAT: &str = "ricci-quad-spline 1";

/// The contents of a file.
#[derive(Serialize)]
struct QuadSplineDocument<'a> {
    format: &'static str,
    degree: usize,
    patches: Vec<TensorPatch<'a>>,
    control_points: &'a [Vector],
    creases: Vec<[usize; 2]>,
}

/// A patch of a file.
#[derive(Serialize)]
struct TensorPatch<'a> {
    knots_u: Vec<f64>,
    knots_v: Vec<f64>,
    control: Vec<&'a [u32]>,
}

impl QuadSpline {
    /// Writes the patches as JSON; numbers have all digits that reading them back bit for bit takes.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write_json(&self, out: &mut impl Write) -> std::io::Result<()> {
        let layout = self.space().layout();
        let patch = |p: usize| {
            let [knots_u, knots_v] = self.knots(p);
            let [_, along_v] = self.space().sides(p);
            TensorPatch { knots_u, knots_v, control: self.space().control(p).chunks(along_v).collect() }
        };
        let is_crease = |&[p, side]: &[usize; 2]| {
            let arc = layout.patches()[p][side].arc as usize;
            layout.arcs()[arc].is_crease
        };
        let n = layout.patches().len();
        let document = QuadSplineDocument {
            format: FORMAT,
            degree: self.degree(),
            patches: (0..n).map(patch).collect(),
            control_points: self.control_points(),
            creases: (0..n).flat_map(|p| (0..4).map(move |side| [p, side])).filter(is_crease).collect(),
        };
        serde_json::to_writer(&mut *out, &document)?;
        writeln!(out)
    }
}
