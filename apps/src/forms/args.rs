//! The options of `ricci forms`.

use crate::options::{Common, FileName, SurfaceArgs, choices};
use crate::picture::{PictureArgs, TextureChoice, Zoom, zoom};
use clap::{Args, ValueEnum};
use ricci::harmonic::Classes;
use ricci::moduli::Degree;
use serde::Serialize;

pub const HELP: &str = "\
Example: the period matrix of a surface of genus 2, its holomorphic forms, and the trajectories of one
    ricci make genus -o two.obj
    ricci forms two.obj --forms F.json --picture two.png --show trajectories --report two.json

Forms live on the intrinsic Delaunay triangulation of the surface. Form k has the integral 1 over loop k of the basis a1, b1, a2, b2, …
(of absolute classes then the boundary loops c1, …; of relative ones the arcs between boundary loops) and 0 over the others.

The period matrix of a closed surface comes with a proven bound: every entry is within its radius. It is that of the polyhedron that the file
of --forms gives; where its relative width is above --width, forms on finer triangulations narrow it.

Files
    --bounds B.json            what proves the bound: faces, lengths (the sums of lengths and lengths_lo), edges, and per form integers and a
                               function, linear on every face, with quadratic terms on edges; period matrix and gap
    --forms F.json             faces, lengths and edges of that triangulation, and per form a value for each edge; holomorphic forms
                               with integrals 1 over a loop a_i and 0 over the others; of open surfaces each form with its conjugate
    --uv OUT.obj | OUT.glb     the surface, opened, with the integral of the chosen form as texture coordinates";

#[derive(Args, Serialize, Debug)]
pub struct FormsArgs {
    #[command(flatten)]
    #[serde(flatten)]
    pub surface: SurfaceArgs,
    /// Classes of a surface with boundary: forms that flow along the boundary, or forms that are 0 along it
    #[arg(long, value_enum, default_value_t = ClassesChoice::Absolute)]
    pub classes: ClassesChoice,
    /// The vertex (numbered from 0) where the loops meet [default: one from which they are short]
    #[arg(long, value_name = "VERTEX")]
    #[serde(skip)]
    pub base: Option<u32>,
    /// The form that is drawn, with its conjugate: a coefficient for each form of the basis [default: chosen to distort areas little]
    #[arg(long, value_name = "X,X,…", value_delimiter = ',', allow_hyphen_values = true, value_parser = coefficient)]
    #[serde(skip)]
    pub combination: Vec<f64>,
    /// Largest relative width of the period matrix of a closed surface: forms on finer triangulations are tried until it is reached
    #[arg(long, value_name = "W", value_parser = width)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub width: Option<f64>,
    /// The functions of the forms that narrow the period matrix
    #[arg(long, value_enum, default_value_t = DegreeChoice::Quadratic)]
    pub degree: DegreeChoice,
    /// Write the forms that prove the width of the period matrix
    #[arg(long, value_name = "B.json")]
    pub bounds: Option<FileName>,
    /// Write the forms
    #[arg(long, value_name = "F.json")]
    pub forms: Option<FileName>,
    /// Write the surface with the integral of the chosen form as texture coordinates, .obj or .glb
    #[arg(long, value_name = "OUT.obj")]
    pub uv: Option<FileName>,
    #[command(flatten)]
    #[serde(flatten)]
    pub picture: PictureArgs,
    /// What the picture shows [default: texture]
    #[arg(long, value_enum, requires = "picture")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub show: Option<FormPictureChoice>,
    /// Pattern of the integral of the form [default: checker]
    #[arg(long, value_enum, requires = "picture")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub texture: Option<TextureChoice>,
    /// Distance between neighbouring trajectories, over the square root of the surface's area [default: 0.04]
    #[arg(long, value_name = "SHARE", requires = "picture", value_parser = crate::options::positive)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spacing: Option<f64>,
    /// Show the surroundings of a vertex (numbered from 0), of a zero maybe, so many times larger
    #[arg(long, value_name = "VERTEX,FACTOR", requires = "picture", value_parser = zoom)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub zoom: Option<Zoom>,
    #[command(flatten)]
    #[serde(flatten)]
    pub common: Common,
}

/// The contents of a picture of `ricci forms`.
#[derive(ValueEnum, Serialize, Debug, Clone, Copy, PartialEq)]
#[serde(rename_all = "lowercase")]
pub enum FormPictureChoice {
    /// The surface with the pattern of the form's integral
    Texture,
    /// The surface with horizontal (red) and vertical (green) trajectories
    Trajectories,
    /// The surface with the pattern, beside the integral in the plane
    Both,
}

choices!(ClassesChoice = Classes { Absolute, Relative });

choices!(
    DegreeChoice = Degree {
        /// Linear on every face: the width falls as 1 over the number of vertices
        Linear,
        /// Quadratic where that narrows most: the width falls about as 1 over its square
        Quadratic
    }
);

/// A relative width, at least 0.
pub fn width(text: &str) -> Result<f64, String> {
    crate::options::number(text, |x| x >= 0.0, "must be a number, at least 0")
}

/// Largest size of a coefficient, and the inverse of the least one: no square overflows or underflows.
const LARGEST: f64 = 1e100;

fn coefficient(text: &str) -> Result<f64, String> {
    let fits = |x: f64| x == 0.0 || (1.0 / LARGEST..=LARGEST).contains(&x.abs());
    crate::options::number(text, fits, "must be 0 or a number between 1e-100 and 1e100 in size")
}
