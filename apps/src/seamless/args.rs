//! The options of `ricci seamless`.

use crate::options::{Common, FileName, SurfaceArgs};
use crate::picture::PictureArgs;
use clap::Args;
use serde::Serialize;
use std::fmt;
use std::path::PathBuf;
use std::str::FromStr;

pub const HELP: &str = "\
Example: a surface of genus 2 with eight cones of valence 5, in one piece of the plane whose seams a grid of squares crosses
    ricci make genus -o two.obj
    ricci seamless two.obj --cones auto:8 --uv flat.obj --report flat.json

Cones
    field      those of the smoothest field of four directions, along the boundary and features, near strokes and principal curvature
    auto:N     N cones placed so that areas change little, their angles rounded to multiples of 90°
    V.csv      a table vertex,valence: the number of right angles around the vertex, 4 at all others, 2 on the boundary; the sum of
               4 − valence, and of 2 − valence on the boundary, is 4χ

Edges of the boundary and features become straight and parallel to an axis between corners of multiples of 90°.

Files
    --field F.csv       the field in each face of the input, of which the cones come with --cones field: rows face,x,y,z, a direction of length 1
    --field F.png       a picture of it: four squares in each face with sides along the field, and the cones, red below valence 4, blue above
    --uv OUT.obj        the map as texture coordinates: each edge of a seam is, exactly in its decimal numbers, a rotation by a multiple of
                        90° and a translation of its other side
    --metric M.json     the metric on its own triangulation";

#[derive(Args, Serialize, Debug)]
pub struct SeamlessArgs {
    #[command(flatten)]
    #[serde(flatten)]
    pub surface: SurfaceArgs,
    /// The cones: field, auto:N, or a table vertex,valence
    #[arg(long, value_name = "CONES", default_value_t = ConesChoice::Field)]
    pub cones: ConesChoice,
    /// The quarter turns along each loop, in the order of the report's `holonomy` [default: the nearest to the conformal metric's]
    #[arg(long, value_name = "K,K,…", value_delimiter = ',', allow_hyphen_values = true)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub turning: Option<Vec<i32>>,
    /// Take edges at which the surface turns by this much as features
    #[arg(long, value_name = "DEGREES", value_parser = crate::options::positive)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub features: Option<f64>,
    /// Turn the field of --cones field along principal curvature, with this strength
    #[arg(long, value_name = "STRENGTH", value_parser = crate::options::positive)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub curvature: Option<f64>,
    /// Turn the field of --cones field along strokes: a table vertex,x,y,z of directions in space
    #[arg(long, value_name = "S.csv")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub strokes: Option<PathBuf>,
    /// Steps towards the lengths of the input with the same angles and turning
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub isometric: usize,
    /// How much larger lengths near each vertex are to be for --isometric, at least one step: a table vertex,factor; 1 at all others
    #[arg(long, value_name = "S.csv")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sizes: Option<PathBuf>,
    /// Largest deviation of an angle from a multiple of 90°, radians
    #[arg(long, value_name = "RADIANS", default_value_t = 1e-10, value_parser = crate::options::positive)]
    pub tolerance: f64,
    /// Write the surface with the map as texture coordinates (.obj, .glb)
    #[arg(long, value_name = "OUT.obj")]
    pub uv: Option<FileName>,
    /// Write the way back from the faces and vertices of --uv to those of the input
    #[arg(long, value_name = "X.csv")]
    pub xref: Option<FileName>,
    /// Write the field of four directions, as a table (.csv) or a picture (.png)
    #[arg(long, value_name = "F.csv")]
    pub field: Option<FileName>,
    /// Write the metric
    #[arg(long, value_name = "M.json")]
    pub metric: Option<FileName>,
    #[command(flatten)]
    #[serde(flatten)]
    pub picture: PictureArgs,
    #[command(flatten)]
    #[serde(flatten)]
    pub common: Common,
}

/// The way in which cones are chosen.
#[derive(Debug, Clone, PartialEq)]
pub enum ConesChoice {
    Field,
    Auto(usize),
    Table(PathBuf),
}

impl FromStr for ConesChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<ConesChoice, String> {
        match text.split_once(':') {
            None if text == "field" => Ok(ConesChoice::Field),
            Some(("auto", n)) => {
                n.parse().map(ConesChoice::Auto).map_err(|e| format!("auto:N needs a number: {e}"))
            }
            _ if text.ends_with(".csv") => Ok(ConesChoice::Table(text.into())),
            _ => Err("field, auto:N or a file of the kind .csv with rows vertex,valence".into()),
        }
    }
}

impl fmt::Display for ConesChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ConesChoice::Field => f.write_str("field"),
            ConesChoice::Auto(n) => write!(f, "auto:{n}"),
            ConesChoice::Table(path) => path.display().fmt(f),
        }
    }
}

impl Serialize for ConesChoice {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}
