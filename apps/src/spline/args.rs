//! The options of `ricci spline`.

use crate::options::{Common, FileName, choices, number, positive};
use crate::picture::PictureArgs;
use crate::uniformize::CornersChoice;
use clap::{Args, Subcommand, ValueEnum};
use ricci::mesh::VertexId;
use ricci::spline::{LengthUnit, SingularVertices};
use ricci::structure::AffineSource;
use serde::Serialize;
use std::path::PathBuf;
use std::str::FromStr;

pub const HELP: &str = "\
Example: a smooth cubic surface of genus 2 with one singular vertex, and a picture of it with its control net; one of genus 1 with a hole,
whose boundary has all curvature
    ricci make genus -o two.obj
    ricci spline fit two.obj --degree 3 -o two.json --report two_fit.json
    ricci spline eval two.json --picture two.png --wire --net
    ricci make torus --holes 1 -o ring.obj
    ricci spline fit ring.obj --singular 0 -o ring.json

Example: a smooth cubic surface through the heights of a mesh, some of its points with derivatives, and a fine mesh of it
    ricci make disk --height 0.3 -o hill.obj
    ricci spline fit hill.obj --planar --degree 3 -o hill.json --report fit.json
    ricci spline eval hill.json --at places.csv --derivatives -o points.csv
    ricci spline eval hill.json --tessellate 4 -o fine.obj
    ricci spline eval hill.json --closest scan.csv -o nearest.csv
    ricci spline eval hill.json --picture hill.png --wire --color curvature
    ricci spline eval hill.json --picture lines.png --color reflection
    ricci spline export hill.json -o hill.step --tolerance 1e-3

--picture draws --tessellate N x N triangles per patch, or 12 x 12; --wire draws the sides of the patches, and colours show the Gaussian
curvature of the surface itself, or reflection lines: stripes by the angle between the reflected view and the horizontal of the picture.
They have no gaps where normals are continuous, and no corners where curvatures are.

places.csv has rows patch,x,y: a triangle of the spline, numbered from 0, and a place in it, in the coordinates of its chart. Its
points are the sums of the basis functions. Around singular vertices, where a filling takes their place, a column `hole` says 1; with --filled
rows have the points of the surface with its fillings, as everything else has. Numbers after those of the patches are the charts of the holes, which have
points with --filled alone: 0,0 is the singular vertex. Around that of a sphere, which lies at infinity of the plane, nothing else has places.

scan.csv has rows x,y,z. For each of these points the nearest one of the surface is written: x,y,z,patch,u,v,X,Y,Z,distance, where u,v is
its place in the chart of the patch.

export writes bicubic B-spline patches, three to a triangle, that share their edges: a solid where the surface is closed, else a shell.
--tolerance is over the diagonal of the bounding box; patches that must turn sharply to keep it fail the check `normal_jump`.

The spline file says all that is needed to evaluate it (`ricci-spline 1`): knots and control points of each triangle, and which others
reach into it.";

#[derive(Args, Debug)]
pub struct SplineArgs {
    #[command(subcommand)]
    pub command: SplineCommand,
}

#[derive(Subcommand, Debug)]
pub enum SplineCommand {
    /// A spline near a mesh, by least squares
    Fit(FitArgs),
    /// Points, derivatives and triangles of a spline
    Eval(EvalArgs),
    /// Bicubic patches near a spline, for CAD
    Export(ExportArgs),
}

#[derive(Args, Serialize, Debug)]
pub struct FitArgs {
    /// Mesh file
    #[serde(skip)]
    pub mesh: PathBuf,
    /// Write the spline
    #[arg(short = 'o', long = "out", value_name = "S.json")]
    pub out: FileName,
    /// Degree of the spline, 1 to 5
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u8).range(1..=5))]
    pub degree: u8,
    /// Weight of the variation of bending beside the mean squared distance [default: by cross-validation, 1e-12 with --planar]
    #[arg(long, value_name = "W", value_parser = not_negative)]
    #[serde(skip)]
    pub fairness: Option<f64>,
    #[command(flatten)]
    #[serde(flatten)]
    pub whole: WholeArgs,
    /// Take x and y of the mesh as parameters: it must lie over the plane z = 0 without folds
    #[arg(long, conflicts_with_all = ["tolerance", "control_points", "atlas", "singular", "corners"])]
    pub planar: bool,
    /// With --planar, edge of the domain's triangles, in units of the mesh [default: so that there are about a quarter as many control
    /// points as vertices]
    #[arg(long, value_name = "LENGTH", value_parser = positive, requires = "planar")]
    #[serde(skip)]
    pub edge: Option<f64>,
    #[command(flatten)]
    #[serde(flatten)]
    pub common: Common,
}

/// A spline over a whole surface.
#[derive(Args, Serialize, Debug)]
pub struct WholeArgs {
    /// Largest distance of a vertex from the spline, in diagonals of the bounding box; where it is missed the exit code is 1
    #[arg(long, value_name = "T", default_value_t = 0.01, value_parser = positive)]
    pub tolerance: f64,
    /// Most control points [default: a quarter as many as vertices; where no such spline holds, twice and four times as many, up to 4000]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub control_points: Option<u32>,
    /// Where the flat metric comes from: the flow, with singular vertices as --singular says, or a holomorphic 1-form with 2g − 2
    #[arg(long, value_enum, default_value_t = AtlasChoice::Flow)]
    pub atlas: AtlasChoice,
    /// Singular vertices: `auto` for as few as keep lengths within a factor of 30 of each other in the flat metric, their number N, or the
    /// vertices V,V,… (numbered from 0; a single one as `V,`)
    #[arg(long, value_name = "auto|N|V,V,…", default_value = "auto")]
    #[serde(skip)]
    pub singular: SingularChoice,
    /// Corners of the boundary, which then has all curvature: N, V,V,… with equal angles, or V:ANGLE in degrees [default: four on a disk, as
    /// many as the boundary has quarters of a turn on other surfaces]
    #[arg(long, value_name = "V,V,…")]
    #[serde(skip)]
    pub corners: Option<CornersChoice>,
}

/// The singular vertices that `--singular` asks for.
#[derive(Debug, Clone, PartialEq)]
pub enum SingularChoice {
    Auto,
    Count(usize),
    At(Vec<u32>),
}

impl FromStr for SingularChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text == "auto" {
            return Ok(SingularChoice::Auto);
        }
        if let Ok(n) = text.parse() {
            return Ok(SingularChoice::Count(n));
        }
        let vertex = |part: &str| {
            part.trim().parse().map_err(|_| format!("`{part}` is neither auto nor a vertex number"))
        };
        text.trim_end_matches(',')
            .split(',')
            .map(vertex)
            .collect::<Result<_, String>>()
            .map(SingularChoice::At)
    }
}

impl SingularChoice {
    /// The library's option for it.
    pub fn to_library(&self) -> SingularVertices {
        match self {
            SingularChoice::Auto => SingularVertices::Auto,
            SingularChoice::Count(n) => SingularVertices::Count(*n),
            SingularChoice::At(vertices) => {
                SingularVertices::At(vertices.iter().map(|&v| VertexId(v)).collect())
            }
        }
    }
}

choices!(AtlasChoice = AffineSource { Flow, Form });

#[derive(Args, Serialize, Debug)]
pub struct EvalArgs {
    /// Spline file
    #[serde(skip)]
    pub spline: PathBuf,
    /// Points at these places: rows patch,x,y in the chart of the patch
    #[arg(long, value_name = "Q.csv", conflicts_with = "tessellate", requires = "out")]
    pub at: Option<FileName>,
    /// Rows of --at are those of the surface with the fillings of its holes
    #[arg(long, requires = "at")]
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub filled: bool,
    /// The nearest points of the surface to these: rows x,y,z
    #[arg(long, value_name = "P.csv", conflicts_with_all = ["at", "tessellate"], requires = "out")]
    pub closest: Option<FileName>,
    /// Add first and second derivatives, normal and principal curvatures to the rows
    #[arg(long, requires = "at")]
    pub derivatives: bool,
    /// A mesh of N × N triangles per patch, with normals
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub tessellate: Option<u16>,
    /// Write rows (.csv) or the mesh (.obj, .off, .ply, .glb, .vtk, .vtp, .mz3, .gii, FreeSurfer's; also .gz)
    #[arg(short = 'o', long = "out", value_name = "OUT", required_unless_present = "picture")]
    pub out: Option<FileName>,
    #[command(flatten)]
    #[serde(flatten)]
    pub picture: PictureArgs,
    /// Show a quantity in colours
    #[arg(long, value_enum, value_name = "QUANTITY", requires = "picture")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub color: Option<SurfaceColor>,
    /// Draw the control net over the surface
    #[arg(long, requires = "picture")]
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub net: bool,
    #[command(flatten)]
    #[serde(flatten)]
    pub common: Common,
}

/// Quantities that a picture of a spline shows in colours.
#[derive(ValueEnum, Serialize, Debug, Clone, Copy)]
#[serde(rename_all = "lowercase")]
pub enum SurfaceColor {
    /// Gaussian curvature
    Curvature,
    /// Reflections of light lines at infinity: as smooth as the normals
    Reflection,
    None,
}

#[derive(Args, Serialize, Debug)]
pub struct ExportArgs {
    /// Spline file
    #[serde(skip)]
    pub spline: PathBuf,
    /// Write the patches: STEP AP242 (.step, .stp), or plain JSON (.json)
    #[arg(short = 'o', long = "out", value_name = "OUT")]
    pub out: FileName,
    /// Largest distance from the spline, over the diagonal of its bounding box
    #[arg(long, value_name = "T", default_value_t = 1e-4, value_parser = positive)]
    pub tolerance: f64,
    /// Most control points of all patches together: where more are needed nothing is written [default: no limit]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub control_points: Option<u32>,
    /// Write patches of a spline that folds too; the exit code is 1 then
    #[arg(long)]
    pub allow_folds: bool,
    /// The unit of the coordinates, which STEP files say
    #[arg(long, value_enum, value_name = "UNIT", default_value = "mm")]
    pub unit: UnitChoice,
    /// Give each face of a STEP file a colour that differs from those of its neighbours
    #[arg(long)]
    pub colours: bool,
    #[command(flatten)]
    #[serde(flatten)]
    pub common: Common,
}

#[derive(ValueEnum, Serialize, Debug, Clone, Copy)]
#[serde(rename_all = "lowercase")]
pub enum UnitChoice {
    /// Millimetres
    Mm,
    /// Metres
    M,
}

impl UnitChoice {
    pub fn length_unit(self) -> LengthUnit {
        match self {
            UnitChoice::Mm => LengthUnit::Millimetre,
            UnitChoice::M => LengthUnit::Metre,
        }
    }
}

fn not_negative(text: &str) -> Result<f64, String> {
    number(text, |x| x >= 0.0, "must be a finite number, 0 or more")
}
