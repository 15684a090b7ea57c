//! The options of `ricci spline`.

use crate::options::{Common, FileName, number, positive};
use crate::picture::SurfacePictureArgs;
use clap::{Args, Subcommand};
use serde::Serialize;
use std::path::PathBuf;

pub const HELP: &str = "\
Example: a smooth cubic surface through the heights of a mesh, some of its points with derivatives, and a fine mesh of it
    ricci make disk --height 0.3 -o hill.obj
    ricci spline fit hill.obj --planar --degree 3 -o hill.json --report fit.json
    ricci spline eval hill.json --at places.csv --derivatives -o points.csv
    ricci spline eval hill.json --tessellate 4 -o fine.obj
    ricci spline eval hill.json --closest scan.csv -o nearest.csv
    ricci spline eval hill.json --picture hill.png --wire --color curvature

--picture draws --tessellate N x N triangles per patch, or 12 x 12; --wire draws the sides of the patches, and colours show the Gaussian
curvature of the surface itself.

places.csv has rows patch,x,y: a triangle of the spline, numbered from 0, and a place in it, in the coordinates of its chart. Its
points are the sums of the basis functions. Around singular vertices, where a filling takes their place, a column `hole` says 1; with --filled
rows have the points of the surface with its fillings, as everything else has.

scan.csv has rows x,y,z. For each of these points the nearest one of the surface is written: x,y,z,patch,u,v,X,Y,Z,distance, where u,v is
its place in the chart of the patch.

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
}

#[derive(Args, Serialize, Debug)]
pub struct FitArgs {
    /// Mesh file
    #[serde(skip)]
    pub mesh: PathBuf,
    /// Write the spline
    #[arg(short = 'o', long = "out", value_name = "S.json")]
    pub out: FileName,
    /// Take x and y of the mesh as parameters: it must lie over the plane z = 0 without folds
    #[arg(long, required = true)]
    pub planar: bool,
    /// Degree of the spline, 1 to 5
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u8).range(1..=5))]
    pub degree: u8,
    /// Edge of the domain's triangles, in units of the mesh [default: so that there are about a quarter as many control points as vertices]
    #[arg(long, value_name = "LENGTH", value_parser = positive)]
    #[serde(skip)]
    pub edge: Option<f64>,
    /// Weight of the bending energy beside the mean squared distance
    #[arg(long, value_name = "W", default_value_t = 1e-12, value_parser = not_negative)]
    pub fairness: f64,
    #[command(flatten)]
    #[serde(flatten)]
    pub common: Common,
}

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
    /// Write rows (.csv) or the mesh (.obj, .off, .ply, .glb)
    #[arg(short = 'o', long = "out", value_name = "OUT", required_unless_present = "picture")]
    pub out: Option<FileName>,
    #[command(flatten)]
    #[serde(flatten)]
    pub picture: SurfacePictureArgs,
    /// Draw the control net over the surface
    #[arg(long, requires = "picture")]
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub net: bool,
    #[command(flatten)]
    #[serde(flatten)]
    pub common: Common,
}

fn not_negative(text: &str) -> Result<f64, String> {
    number(text, |x| x >= 0.0, "must be a finite number, 0 or more")
}
