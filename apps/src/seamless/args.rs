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
    field      those of the smoothest field of four directions
    auto:N     N cones placed so that areas change little, their angles rounded to multiples of 90°
    V.csv      a table vertex,valence: the number of right angles around the vertex, 4 at all others; the sum of 4 − valence is 4χ

Files
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
    /// Largest deviation of an angle from a multiple of 90°, radians
    #[arg(long, value_name = "RADIANS", default_value_t = 1e-10, value_parser = crate::options::positive)]
    pub tolerance: f64,
    /// Write the surface with the map as texture coordinates (.obj, .glb)
    #[arg(long, value_name = "OUT.obj")]
    pub uv: Option<FileName>,
    /// Write the way back from the faces and vertices of --uv to those of the input
    #[arg(long, value_name = "X.csv")]
    pub xref: Option<FileName>,
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
