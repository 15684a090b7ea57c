//! `ricci make`: sample surfaces of every topology.

use crate::cli::Common;
use crate::failure::Failure;
use crate::metric_file::LengthsFile;
use crate::output::{Outputs, check_extension, check_writable, extension};
use crate::picture::SurfacePictureArgs;
use crate::report::{InputSummary, Report, peak_bytes};
use crate::say::{self, count};
use crate::shape_quality;
use crate::show;
use clap::{Args, Subcommand};
use ricci::geometry::Space;
use ricci::mesh::io::{self, Format, Soup};
use ricci::mesh::shapes::{self, Intrinsic};
use ricci::mesh::{Mesh, PerEdge};
use ricci::metric::lengths_from_positions;
use serde::Serialize;
use std::path::{Path, PathBuf};
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

#[derive(Subcommand, Serialize, Debug)]
#[serde(rename_all = "kebab-case")]
pub enum Shape {
    /// The unit sphere: an icosahedron with each edge cut into N
    #[command(alias = "icosphere")]
    Sphere {
        #[arg(short, long, default_value_t = 16)]
        n: usize,
        #[command(flatten)]
        to: ToMesh,
    },
    /// An ellipsoid: the sphere scaled along x, y, z
    Ellipsoid {
        /// Half axes
        #[arg(long, num_args = 3, value_names = ["A", "B", "C"], default_values_t = [3.0, 2.0, 1.0])]
        axes: Vec<f64>,
        #[arg(short, long, default_value_t = 16)]
        n: usize,
        #[command(flatten)]
        to: ToMesh,
    },
    /// A torus of revolution
    Torus {
        /// Radius of the centre circle
        #[arg(long, default_value_t = 2.0)]
        big: f64,
        /// Radius of the tube
        #[arg(long, default_value_t = 1.0)]
        small: f64,
        /// Vertices along the centre circle
        #[arg(short, long, default_value_t = 64)]
        n: usize,
        /// Vertices around the tube [default: in proportion to the radii]
        #[arg(short, long)]
        m: Option<usize>,
        #[command(flatten)]
        to: ToMesh,
    },
    /// The unit disk, flat or with a hill and a hollow
    Disk {
        /// Rings
        #[arg(short, long, default_value_t = 24)]
        n: usize,
        /// Height of the hill
        #[arg(long, default_value_t = 0.0, allow_negative_numbers = true, value_parser = finite)]
        height: f64,
        #[command(flatten)]
        to: ToMesh,
    },
    /// A plane ring, flat or with a hill and a hollow
    Annulus {
        /// Inner radius
        #[arg(long, default_value_t = 0.3)]
        inner: f64,
        /// Outer radius
        #[arg(long, default_value_t = 1.0)]
        outer: f64,
        /// Steps from the inner to the outer radius
        #[arg(short, long, default_value_t = 16)]
        n: usize,
        /// Vertices around [default: so that triangles are nearly equilateral]
        #[arg(short, long)]
        m: Option<usize>,
        /// Height of the hill
        #[arg(long, default_value_t = 0.0, allow_negative_numbers = true, value_parser = finite)]
        height: f64,
        #[command(flatten)]
        to: ToMesh,
    },
    /// A smooth closed surface of genus G ≥ 1: handles in a row
    Genus {
        /// Number of handles
        #[arg(short, long, default_value_t = 2)]
        genus: usize,
        /// Layers over a quarter of the tube; 8 (5 G + 1) N² + 2 − 2 G vertices
        #[arg(short, long, default_value_t = 6)]
        n: usize,
        #[command(flatten)]
        to: ToMesh,
    },
    /// The flat torus with periods 1 and τ, as edge lengths
    FlatTorus {
        /// τ, Im τ > 0
        #[arg(long, num_args = 2, value_names = ["RE", "IM"], default_values_t = [0.0, 1.0], allow_negative_numbers = true)]
        tau: Vec<f64>,
        /// Parallelograms along 1
        #[arg(short, long, default_value_t = 16)]
        n: usize,
        /// Parallelograms along τ
        #[arg(short, long, default_value_t = 16)]
        m: usize,
        #[command(flatten)]
        to: ToMetric,
    },
    /// The Bolza surface: a regular hyperbolic octagon with opposite sides glued, as edge lengths
    Bolza {
        /// Times that every triangle is cut into four
        #[arg(short, long, default_value_t = 3)]
        level: usize,
        #[command(flatten)]
        to: ToMetric,
    },
    /// A regular polygon with sides a1 b1 a1⁻¹ b1⁻¹ … glued, cut by diagonals: one vertex, as edge lengths
    OneVertex {
        #[arg(short, long, default_value_t = 2)]
        genus: usize,
        #[command(flatten)]
        to: ToMetric,
    },
    /// The same polygon, cut from its centre: two vertices, as edge lengths
    TwoVertex {
        #[arg(short, long, default_value_t = 2)]
        genus: usize,
        #[command(flatten)]
        to: ToMetric,
    },
    /// Two equilateral triangles glued along their sides, as edge lengths
    TwoTriangles {
        #[command(flatten)]
        to: ToMetric,
    },
}

/// Where a surface in space goes.
#[derive(Args, Serialize, Debug)]
pub struct ToMesh {
    /// Mesh (.obj, .off, .ply), or its edge lengths (.json)
    #[arg(short = 'o', long = "out", value_name = "OUT")]
    pub out: PathBuf,
    /// Move every vertex by up to this fraction of the mean edge length in each coordinate
    #[arg(long, default_value_t = 0.0, value_name = "A")]
    pub noise: f64,
    /// Seed of the noise
    #[arg(long, default_value_t = 0)]
    pub seed: u64,
    #[command(flatten)]
    #[serde(flatten)]
    pub picture: SurfacePictureArgs,
    #[command(flatten)]
    #[serde(skip)]
    pub common: Common,
}

/// Where a surface that is given by its edge lengths goes.
#[derive(Args, Serialize, Debug)]
pub struct ToMetric {
    /// Edge lengths (.json)
    #[arg(short = 'o', long = "out", value_name = "M.json")]
    pub out: PathBuf,
    #[command(flatten)]
    #[serde(skip)]
    pub common: Common,
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
        Shape::Genus { genus, n, to } => mesh(shapes::genus(*genus, *n), to),
        Shape::FlatTorus { tau, n, m, to } => metric(shapes::flat_torus([tau[0], tau[1]], *n, *m), to),
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

/// Raise a plane piece to a hill of this height and a hollow of half the depth.
fn raise(mut soup: Soup, height: f64) -> Soup {
    let bump = |x: f64, y: f64| (-7.0 * (x * x + y * y)).exp();
    for [x, y, z] in &mut soup.positions {
        *z += height * (bump(*x - 0.25, *y - 0.15) - 0.5 * bump(*x + 0.4, *y + 0.35));
    }
    soup
}

fn write_mesh(soup: ricci::Result<Soup>, to: &ToMesh, shape: &Shape, start: Instant) -> Result<u8, Failure> {
    check_extension("-o", &to.out, &["obj", "off", "ply", "json"])?;
    check_writable(&to.out)?;
    to.common.report.as_deref().map_or(Ok(()), check_writable)?;
    if let Some(path) = &to.picture.base.picture {
        check_extension("--picture", path, &["png"])?;
        check_writable(path)?;
    }
    let mut soup = soup?;
    if to.noise != 0.0 {
        shapes::noise(&mut soup, to.noise, to.seed)?;
    }
    let mesh = Mesh::from_soup(&soup)?;
    let Soup { positions, faces, .. } = &soup;
    let lengths = lengths_from_positions(&mesh, positions)?;
    let mut outputs = Outputs::default();
    if extension(&to.out) == "json" {
        outputs.add_json(&to.out, &LengthsFile::new(&mesh, Space::E2, &lengths))?;
    } else {
        let format = Format::of(&to.out)?;
        outputs.add_named(&to.out, |path| io::write_as(path, format, &soup))?;
    }
    if let Some(path) = &to.picture.base.picture {
        outputs
            .add(path, |out| show::draw_surface(out, positions, faces, &to.picture, to.common.threads()))?;
    }
    let made = Made { out: &to.out, mesh: &mesh, geometry: Space::E2, lengths: &lengths };
    made.finish(outputs, shape, &to.common, start)
}

fn write_metric(
    surface: ricci::Result<Intrinsic>,
    to: &ToMetric,
    shape: &Shape,
    start: Instant,
) -> Result<u8, Failure> {
    if extension(&to.out) != "json" {
        let out = to.out.display();
        return Err(Failure::Usage(format!(
            "-o {out}: this surface has no positions; write its lengths, .json"
        )));
    }
    check_writable(&to.out)?;
    to.common.report.as_deref().map_or(Ok(()), check_writable)?;
    let surface = surface?;
    let (mesh, lengths) = surface.build()?;
    let mut outputs = Outputs::default();
    outputs.add_json(&to.out, &LengthsFile::new(&mesh, surface.geometry, &lengths))?;
    let made = Made { out: &to.out, mesh: &mesh, geometry: surface.geometry, lengths: &lengths };
    made.finish(outputs, shape, &to.common, start)
}

/// The surface that was made.
struct Made<'a> {
    out: &'a Path,
    mesh: &'a Mesh,
    geometry: Space,
    lengths: &'a PerEdge<f64>,
}

impl Made<'_> {
    /// Write the report, put the files in place, say what was made.
    fn finish(
        self,
        mut outputs: Outputs,
        shape: &Shape,
        common: &Common,
        start: Instant,
    ) -> Result<u8, Failure> {
        let Made { out, mesh, geometry, lengths } = self;
        if let Some(path) = &common.report {
            let summary = InputSummary::of_mesh(out, mesh);
            let mut report =
                Report::new("make", summary, shape, shape_quality::of_surface(mesh, geometry, lengths));
            report.seconds.total = start.elapsed().as_secs_f64();
            report.peak_bytes = peak_bytes();
            outputs.add_report(path, &report)?;
        }
        outputs.commit()?;
        if !common.quiet {
            say::lines(&format!(
                "{}: {}, {}, genus {}, {}\n",
                out.display(),
                count(mesh.n_vertices(), "vertex", "vertices"),
                count(mesh.n_faces(), "face", "faces"),
                mesh.genus(),
                count(mesh.boundary_loops().len(), "boundary loop", "boundary loops"),
            ));
        }
        Ok(0)
    }
}

fn finite(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|x: &f64| x.is_finite()).ok_or_else(|| "must be a number".into())
}
