//! `ricci make`: sample surfaces of every topology.

use crate::failure::Failure;
use crate::metric_file::LengthsFile;
use crate::options::Common;
use crate::output::{Outputs, check_extension, check_outputs, extension, format_of};
use crate::report::{Checks, Counts, InputSummary, Report, Seconds};
use crate::say::{self, count};
use crate::shape::{Shape, ToMesh, ToMetric};
use crate::shape_quality::QualityFigures;
use crate::show;
use clap::Args;
use ricci::Surface;
use ricci::geometry::hyperelliptic::period_matrix;
use ricci::mesh::io::{self, Soup};
use ricci::mesh::shapes::{self, IntrinsicSurface, TorusKnot};
use ricci::metric::ShapeQuality;
use serde::Serialize;
use std::path::Path;
use std::time::Instant;

pub const HELP: &str = "\
Example: a torus, and a hyperbolic surface given by its edge lengths alone
    ricci make torus --big 3 --small 1 -o torus.obj
    ricci make bolza -o bolza.json && ricci flow bolza.json

`ricci make SHAPE --help` shows the options of a shape.";

#[derive(Args, Debug)]
#[command(
    subcommand_value_name = "SHAPE",
    subcommand_help_heading = "Shapes",
    disable_help_subcommand = true
)]
pub struct MakeArgs {
    #[command(subcommand)]
    pub shape: Shape,
}

/// Run the command.
pub fn run(args: &MakeArgs) -> Result<u8, Failure> {
    let start = Instant::now();
    let mesh = |soup, to| write_mesh(soup, to, &args.shape, start);
    let metric = |surface, to| write_metric(surface, to, &args.shape, start);
    match &args.shape {
        Shape::Sphere { n, to } => mesh(shapes::icosphere(*n), to),
        Shape::Ellipsoid { axes, n, to } => mesh(shapes::ellipsoid([axes[0], axes[1], axes[2]], *n), to),
        Shape::Torus { big, small, n, m, to } => {
            let m = m.unwrap_or_else(|| around(*n, small / big));
            mesh(shapes::torus(*big, *small, *n, m), to)
        }
        Shape::Disk { n, height, to } => mesh(shapes::disk(*n).map(|s| raise(s, *height)), to),
        Shape::Annulus { inner, outer, n, m, height, to } => {
            // Steps in geometric progression: log(outer/inner)/n each, and 2π/m around in rows of height √3/2.
            let step = (outer / inner).ln() / *n as f64;
            let m = m.unwrap_or_else(|| around(1, std::f64::consts::TAU * 0.75f64.sqrt() / step));
            mesh(shapes::annulus(*inner, *outer, *n, m).map(|s| raise(s, *height)), to)
        }
        Shape::Genus { genus, n, ratio, to } => mesh(shapes::tapered_genus(*genus, *n, *ratio), to),
        Shape::Knot { p, q, big, small, tube, n, m, to } => {
            let knot = TorusKnot { p: *p, q: *q, big: *big, small: *small };
            let m = m.unwrap_or_else(|| knot_around(&knot, *tube, *n));
            mesh(knot.torus(*tube, *n, m), to)
        }
        Shape::FlatTorus { tau, n, m, to } => metric(shapes::flat_torus([tau[0], tau[1]], *n, *m), to),
        Shape::Pants { lengths, level, to } => {
            metric(shapes::pants([lengths[0], lengths[1], lengths[2]], *level), to)
        }
        Shape::Hyperelliptic { at, n, grading, to } => {
            metric(shapes::hyperelliptic_graded(at, *n, *grading), to)
        }
        Shape::Bolza { level, to } => metric(shapes::bolza(*level), to),
        Shape::OneVertex { genus, to } => metric(shapes::one_vertex(*genus), to),
        Shape::TwoVertex { genus, to } => metric(shapes::two_vertex(*genus), to),
        Shape::TwoTriangles { to } => metric(Ok(shapes::two_triangle_sphere()), to),
    }
}

/// A count in proportion to another, at least 3.
fn around(n: usize, ratio: f64) -> usize {
    (n as f64 * ratio).round().clamp(3.0, 1e6) as usize
}

/// Vertices around a tube such that they are as far apart as its `n` cross-sections are.
fn knot_around(knot: &TorusKnot, tube: f64, n: usize) -> usize {
    let TorusKnot { p, q, big, small } = *knot;
    // The core's length: p turns around the axis and q around the tube, at right angles.
    let length = (f64::from(p) * big).hypot(f64::from(q) * small);
    around(n, tube / length)
}

/// Raise a plane piece to a hill of this height and a hollow of half the depth.
fn raise(mut soup: Soup, height: f64) -> Soup {
    let bump = |x: f64, y: f64| (-7.0 * (x * x + y * y)).exp();
    for [x, y, z] in &mut soup.positions {
        *z += height * (bump(*x - 0.25, *y - 0.15) - 0.5 * bump(*x + 0.4, *y + 0.35));
    }
    soup
}

fn write_mesh(soup: ricci::Result<Soup>, to: &ToMesh, shape: &Shape, start: Instant) -> Result<u8, Failure> {
    check_extension("-o", Some(&to.out), &["obj", "off", "ply", "glb", "json"])?;
    let (report, picture) = (to.common.report.as_deref(), to.picture.base.picture.as_deref());
    check_extension("--picture", picture, &["png"])?;
    check_outputs(&[], &[Some(&to.out), report, picture])?;
    let soup = to.spoil.apply(soup?)?;
    let surface = Surface::from_soup(&soup)?;
    let mut outputs = Outputs::default();
    if extension(&to.out) == "json" {
        write_lengths(&mut outputs, &to.out, &surface)?;
    } else {
        let format = format_of(&to.out)?;
        outputs.add_named(&to.out, |path| io::write_as(path, format, &soup))?;
    }
    if let Some(path) = picture {
        outputs.add_bytes(path, &show::draw_surface(&soup, &to.picture, to.common.threads)?)?;
    }
    Made { out: &to.out, surface, outputs, start }.finish(shape, &to.common)
}

fn write_metric(
    surface: ricci::Result<IntrinsicSurface>,
    to: &ToMetric,
    shape: &Shape,
    start: Instant,
) -> Result<u8, Failure> {
    let name = "-o (this surface has no positions; its lengths are written)";
    check_extension(name, Some(&to.out), &["json"])?;
    check_outputs(&[], &[Some(&to.out), to.common.report.as_deref()])?;
    let given = surface?;
    let (mesh, lengths) = given.build()?;
    let surface = Surface::intrinsic(mesh, lengths, given.geometry)?;
    let mut outputs = Outputs::default();
    write_lengths(&mut outputs, &to.out, &surface)?;
    Made { out: &to.out, surface, outputs, start }.finish(shape, &to.common)
}

fn write_lengths(outputs: &mut Outputs, path: &Path, surface: &Surface) -> Result<(), Failure> {
    outputs.add_json(path, &LengthsFile::new(surface.mesh(), surface.geometry(), surface.lengths()))
}

/// What the report says of the surface.
#[derive(Serialize)]
struct MadeResult {
    #[serde(flatten)]
    quality: QualityFigures,
    /// Of the curve that a hyperelliptic surface is: `[re, im]` of τ_ij.
    #[serde(skip_serializing_if = "Option::is_none")]
    period_matrix: Option<Vec<Vec<[f64; 2]>>>,
}

fn known_periods(shape: &Shape) -> ricci::Result<Option<Vec<Vec<[f64; 2]>>>> {
    let Shape::Hyperelliptic { at, .. } = shape else { return Ok(None) };
    let tau = period_matrix(at)?;
    Ok(Some(tau.iter().map(|row| row.iter().map(|z| [z.re, z.im]).collect()).collect()))
}

/// A surface that was made, with its files.
struct Made<'a> {
    out: &'a Path,
    surface: Surface,
    outputs: Outputs,
    start: Instant,
}

impl Made<'_> {
    /// Write the report, put the files in place, say what was made.
    fn finish(mut self, shape: &Shape, common: &Common) -> Result<u8, Failure> {
        let summary = InputSummary::new(self.out, &**self.surface.mesh());
        let Counts { vertices, faces, genus, boundary_loops, .. } = summary.counts;
        let text = format!(
            "{}: {}, {}, genus {}, {}\n",
            self.out.display(),
            count(vertices, "vertex", "vertices"),
            count(faces, "face", "faces"),
            genus.unwrap_or(0),
            count(boundary_loops, "boundary loop", "boundary loops"),
        );
        if let Some(path) = &common.report {
            let quality = ShapeQuality::of_surface(&self.surface).into();
            let result = MadeResult { quality, period_matrix: known_periods(shape)? };
            let seconds = Seconds { total: self.start.elapsed().as_secs_f64(), ..Seconds::default() };
            let report = Report::new("make", summary, shape, result).finished(Checks::default(), seconds);
            self.outputs.add_report(path, &report)?;
        }
        let files = self.outputs.commit()?;
        if !common.quiet {
            say::lines(&text, &files)?;
        }
        Ok(0)
    }
}
