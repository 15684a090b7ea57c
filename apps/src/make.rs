//! `ricci make`: sample surfaces of every topology.

use crate::failure::Failure;
use crate::metric_file::LengthsFile;
use crate::output::{check_extension, check_mesh_extension, check_outputs, extension, format_of};
use crate::report::{Done, InputSummary};
use crate::runner::{CommandRun, Job, JobHeader, JobOutcome};
use crate::say::count;
use crate::shape::{Destination, SampleShape};
use crate::shape_quality::QualityFigures;
use crate::show;
use clap::Args;
use ricci::Surface;
use ricci::geometry::hyperelliptic::period_matrix;
use ricci::mesh::io::{self, Soup};
use ricci::mesh::shapes::{self, FenchelNielsen, IntrinsicSurface, PantsSurface, TorusKnot};
use ricci::metric::ShapeQuality;
use serde::Serialize;
use std::io::Write;
use std::path::PathBuf;

pub const HELP: &str = "\
Example: a torus, and a hyperbolic surface given by its edge lengths alone
    ricci make torus --big 3 --small 1 -o torus.obj
    ricci make bolza -o bolza.json && ricci flow bolza.json

`ricci make SHAPE --help` shows the options of a shape.";

#[derive(Args, Serialize, Debug)]
#[serde(transparent)]
#[command(
    subcommand_value_name = "SHAPE",
    subcommand_help_heading = "Shapes",
    disable_help_subcommand = true
)]
pub struct MakeArgs {
    #[command(subcommand)]
    pub shape: SampleShape,
}

/// A sample surface: as triangles in space where it has any, and by its lengths.
pub struct MakeOutcome {
    out: PathBuf,
    soup: Option<Soup>,
    surface: Surface,
    periods: Option<Vec<Vec<[f64; 2]>>>,
    /// The loops that Fenchel–Nielsen coordinates belong to: edges numbered from 1, negative against their direction.
    loops: Vec<Vec<i32>>,
}

/// The surface as the report has it.
#[derive(Serialize)]
pub struct MakeFigures {
    #[serde(flatten)]
    quality: QualityFigures,
    /// The period matrix of the curve that a hyperelliptic surface is: `[re, im]` of τ_ij.
    #[serde(skip_serializing_if = "Option::is_none")]
    period_matrix: Option<Vec<Vec<[f64; 2]>>>,
}

impl Job for MakeArgs {
    type Outcome = MakeOutcome;

    fn header(&self) -> JobHeader<'_> {
        JobHeader { name: "make", common: self.shape.destination().common(), mesh: None }
    }

    fn check(&self) -> Result<(), Failure> {
        let report = self.header().common.report.as_deref();
        match self.shape.destination() {
            Destination::Mesh(to) => {
                let picture = to.picture.base.picture.as_deref();
                check_mesh_extension("-o", Some(&to.out), &["json"])?;
                check_extension("--picture", picture, &["png"])?;
                check_outputs(&[], &[Some(&to.out), report, picture])
            }
            Destination::Metric(to) => {
                let name = "-o (this surface has no positions; its lengths are written)";
                check_extension(name, Some(&to.out), &["json"])?;
                check_extension("--loops", self.shape.loops(), &["csv"])?;
                check_outputs(&[], &[Some(&to.out), report, self.shape.loops()])
            }
        }
    }

    fn compute(&self, _: &mut CommandRun<'_>) -> Result<MakeOutcome, Failure> {
        let mut loops = Vec::new();
        let intrinsic = |given: IntrinsicSurface| -> ricci::Result<_> {
            let (mesh, lengths) = given.build()?;
            Ok((None, Surface::intrinsic(mesh, lengths, given.geometry)?))
        };
        let (soup, surface) = match (build(&self.shape)?, self.shape.destination()) {
            (SampleSurface::Metric(given), _) => intrinsic(given)?,
            (SampleSurface::Marked(marked), _) => {
                loops = marked.loops;
                intrinsic(marked.surface)?
            }
            (SampleSurface::Mesh(soup), Destination::Mesh(to)) => {
                let soup = to.spoil.apply(*soup)?;
                let surface = Surface::from_soup(&soup)?;
                (Some(soup), surface)
            }
            (SampleSurface::Mesh(soup), Destination::Metric(_)) => (None, Surface::from_soup(&soup)?),
        };
        let periods = if self.header().common.report.is_some() { known_periods(&self.shape)? } else { None };
        Ok(MakeOutcome { out: self.shape.destination().out().into(), soup, surface, periods, loops })
    }

    fn write(&self, outcome: &MakeOutcome, run: &mut CommandRun<'_>) -> Result<(), Failure> {
        let (out, surface) = (&*outcome.out, &outcome.surface);
        match &outcome.soup {
            Some(soup) if extension(out) != "json" => {
                let format = format_of(out)?;
                run.outputs.add_named(out, |path| io::write_as(path, format, soup))?;
            }
            _ => {
                let (mesh, geometry, lengths) = (surface.mesh(), surface.geometry(), surface.lengths());
                let mut file = LengthsFile::new(mesh, geometry, lengths);
                if !outcome.loops.is_empty() {
                    file = file.with_numbered_edges(mesh);
                }
                run.outputs.add_json(out, &file)?;
            }
        }
        run.file("loops", self.shape.loops(), |outputs, path| {
            outputs.add(path, |out| write_loops(out, &outcome.loops))
        })?;
        let (Some(soup), Destination::Mesh(to)) = (&outcome.soup, self.shape.destination()) else {
            return Ok(());
        };
        let draw = || show::draw_surface(soup, &to.picture, to.common.threads);
        run.draw(to.picture.base.picture.as_deref(), draw)
    }
}

impl JobOutcome for MakeOutcome {
    type Figures = MakeFigures;

    fn input(&self) -> Option<InputSummary> {
        Some(InputSummary::new(&self.out, &**self.surface.mesh()))
    }

    fn figures(&self, _: &CommandRun<'_>) -> MakeFigures {
        let quality = ShapeQuality::of_surface(&self.surface).into();
        MakeFigures { quality, period_matrix: self.periods.clone() }
    }

    fn summary(&self, _: &Done) -> String {
        let mesh = self.surface.mesh();
        format!(
            "{}: {}, {}, genus {}, {}\n",
            self.out.display(),
            count(mesh.n_vertices(), "vertex", "vertices"),
            count(mesh.n_faces(), "face", "faces"),
            mesh.genus(),
            count(mesh.boundary_loops().len(), "boundary loop", "boundary loops"),
        )
    }
}

/// A sample surface as the library makes it.
enum SampleSurface {
    Mesh(Box<Soup>),
    Metric(IntrinsicSurface),
    Marked(Box<PantsSurface>),
}

/// Rows `loop,edge`, loops numbered from 0, edges from 1 and negative against their direction.
fn write_loops(out: &mut impl Write, loops: &[Vec<i32>]) -> std::io::Result<()> {
    writeln!(out, "loop,edge")?;
    let rows = loops.iter().enumerate().flat_map(|(k, path)| path.iter().map(move |e| (k, e)));
    rows.into_iter().try_for_each(|(k, e)| writeln!(out, "{k},{e}"))
}

fn build(shape: &SampleShape) -> ricci::Result<SampleSurface> {
    Ok(match shape {
        SampleShape::Sphere { n, .. } => SampleSurface::Mesh(Box::new(shapes::icosphere(*n)?)),
        SampleShape::Ellipsoid { axes, n, .. } => {
            SampleSurface::Mesh(Box::new(shapes::ellipsoid([axes[0], axes[1], axes[2]], *n)?))
        }
        SampleShape::Torus { big, small, n, m, .. } => {
            let m = m.unwrap_or_else(|| around(*n, small / big));
            SampleSurface::Mesh(Box::new(shapes::torus(*big, *small, *n, m)?))
        }
        SampleShape::Disk { n, height, .. } => {
            SampleSurface::Mesh(Box::new(raise(shapes::disk(*n)?, *height)))
        }
        SampleShape::Annulus { inner, outer, n, m, height, .. } => {
            // Steps in geometric progression: log(outer/inner)/n each, and 2π/m around in rows of height √3/2.
            let step = (outer / inner).ln() / *n as f64;
            let m = m.unwrap_or_else(|| around(1, std::f64::consts::TAU * 0.75f64.sqrt() / step));
            SampleSurface::Mesh(Box::new(raise(shapes::annulus(*inner, *outer, *n, m)?, *height)))
        }
        SampleShape::Genus { genus, n, ratio, .. } => {
            SampleSurface::Mesh(Box::new(shapes::tapered_genus(*genus, *n, *ratio)?))
        }
        SampleShape::Knot { p, q, big, small, tube, n, m, .. } => {
            let knot = TorusKnot { p: *p, q: *q, big: *big, small: *small };
            let m = m.unwrap_or_else(|| knot_around(&knot, *tube, *n));
            SampleSurface::Mesh(Box::new(knot.torus(*tube, *n, m)?))
        }
        SampleShape::FlatTorus { tau, n, m, .. } => {
            SampleSurface::Metric(shapes::flat_torus([tau[0], tau[1]], *n, *m)?)
        }
        SampleShape::Pants { lengths, level, .. } => {
            SampleSurface::Metric(shapes::pants([lengths[0], lengths[1], lengths[2]], *level)?)
        }
        SampleShape::FenchelNielsen { genus, lengths, twists, boundaries, level, .. } => {
            let twist = |k: usize| if twists.is_empty() { Some(0.0) } else { twists.get(k).copied() };
            if !twists.is_empty() && twists.len() != lengths.len() {
                let (expected, got) = (lengths.len(), twists.len());
                return Err(ricci::Error::Size { what: "twists", expected, got });
            }
            let curves = lengths.iter().enumerate().filter_map(|(k, &l)| Some([l, twist(k)?])).collect();
            let given = FenchelNielsen { genus: *genus, curves, boundaries: boundaries.clone() };
            SampleSurface::Marked(Box::new(shapes::fenchel_nielsen(&given, *level)?))
        }
        SampleShape::Hyperelliptic { at, n, grading, .. } => {
            SampleSurface::Metric(shapes::hyperelliptic_graded(at, *n, *grading)?)
        }
        SampleShape::Bolza { level, .. } => SampleSurface::Metric(shapes::bolza(*level)?),
        SampleShape::OneVertex { genus, .. } => SampleSurface::Metric(shapes::one_vertex(*genus)?),
        SampleShape::TwoVertex { genus, .. } => SampleSurface::Metric(shapes::two_vertex(*genus)?),
        SampleShape::TwoTriangles { .. } => SampleSurface::Metric(shapes::two_triangle_sphere()),
    })
}

/// The period matrix of a hyperelliptic surface, as `[re, im]` of τ_ij; none for the other shapes.
fn known_periods(shape: &SampleShape) -> ricci::Result<Option<Vec<Vec<[f64; 2]>>>> {
    let SampleShape::Hyperelliptic { at, .. } = shape else { return Ok(None) };
    let tau = period_matrix(at)?;
    Ok(Some(tau.iter().map(|row| row.iter().map(|z| [z.re, z.im]).collect()).collect()))
}

/// The number of vertices around that is in this ratio to `n`, at least 3.
fn around(n: usize, ratio: f64) -> usize {
    (n as f64 * ratio).round().clamp(3.0, 1e6) as usize
}

/// The number of vertices around a tube for which they are as far apart as its `n` cross-sections.
fn knot_around(knot: &TorusKnot, tube: f64, n: usize) -> usize {
    let TorusKnot { p, q, big, small } = *knot;
    // The core's length: p turns around the axis and q around the tube, at right angles.
    let length = (f64::from(p) * big).hypot(f64::from(q) * small);
    around(n, tube / length)
}

/// Bend a plane piece into a hill of this height and a hollow of half that depth.
fn raise(mut soup: Soup, height: f64) -> Soup {
    let bump = |x: f64, y: f64| (-7.0 * (x * x + y * y)).exp();
    for [x, y, z] in &mut soup.positions {
        *z += height * (bump(*x - 0.25, *y - 0.15) - 0.5 * bump(*x + 0.4, *y + 0.35));
    }
    soup
}
