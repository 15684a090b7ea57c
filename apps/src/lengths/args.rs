//! The options of `ricci lengths`.

use crate::options::{Common, FileName, SurfaceArgs};
use crate::picture::PictureArgs;
use clap::Args;
use serde::Serialize;

pub const HELP: &str = "\
Example: all closed geodesics up to length 5 of a surface of genus 2, and the shortest ones on it
    ricci make genus -o two.obj
    ricci lengths two.obj --below 5 --spectrum two.csv --systole systole.obj --picture two.png

Example: the Bolza surface, whose shortest closed geodesics are twelve of length 2 arcosh(1 + √2)
    ricci make bolza -o bolza.json && ricci lengths bolza.json --below 6.2

Example: a surface of genus 2 from lengths and twists, and back
    ricci make fenchel-nielsen --lengths 2,3,2.5 --twists 0.4,-1,0.7 -o fn.json --loops loops.csv
    ricci lengths fn.json --below 2 --loops loops.csv

Lengths are those of the metric of constant curvature −1 in the conformal class (of a torus flat, with the area of the surface), of loops
without an orientation. Every closed geodesic up to the length asked for is listed once, with the loops that run around another one several
times as its powers.

Files
    --spectrum L.csv           rows length,power,word: by length; the word in the generators a1, b1, …, spelled a1.b1^-1
    --systole S.obj            the shortest closed geodesics as closed lines on the surface
    --curves C.obj             all closed geodesics of the spectrum so, each once";

#[derive(Args, Serialize, Debug)]
pub struct LengthsArgs {
    #[command(flatten)]
    #[serde(flatten)]
    pub surface: SurfaceArgs,
    /// Largest length of the closed geodesics that are listed
    #[arg(long, value_name = "L", default_value_t = 5.0, value_parser = crate::options::positive)]
    pub below: f64,
    /// Tell the length of this loop too, a word in the generators such as 'a1 b1^-1' or a1.b1^-1; may be given several times
    #[arg(long = "word", value_name = "WORD")]
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub words: Vec<String>,
    /// Tell Fenchel-Nielsen coordinates: lengths and twists of the loops a_i, the commutators c_i and their products d_i, which cut a
    /// hyperbolic surface into pairs of pants
    #[arg(long)]
    pub pants: bool,
    /// As --pants, for the loops of this file as generators a1, b1, …: rows loop,edge, as `ricci make fenchel-nielsen --loops` writes them
    #[arg(long, value_name = "L.csv", conflicts_with = "pants")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub loops: Option<FileName>,
    /// As --pants, for curves of your own: a word; give it once for each of the 3g − 3 + b curves. Without loops that cross them twists are
    /// known modulo half of the length
    #[arg(long = "curve", value_name = "WORD", conflicts_with_all = ["pants", "loops"])]
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub curves_named: Vec<String>,
    /// The vertex (numbered from 0) where the loops of the generators meet [default: one from which no vertex is far]
    #[arg(long, value_name = "VERTEX")]
    #[serde(skip)]
    pub base: Option<u32>,
    /// Most deck transformations that are formed in the search
    #[arg(long, value_name = "N", default_value_t = 1_000_000, value_parser = clap::value_parser!(u32).range(1..))]
    pub limit: u32,
    /// Write the closed geodesics by length
    #[arg(long, value_name = "L.csv")]
    pub spectrum: Option<FileName>,
    /// Write the shortest closed geodesics on the surface as lines, .obj
    #[arg(long, value_name = "S.obj")]
    pub systole: Option<FileName>,
    /// Write all closed geodesics on the surface as lines, .obj
    #[arg(long, value_name = "C.obj")]
    pub curves: Option<FileName>,
    #[command(flatten)]
    #[serde(flatten)]
    pub picture: PictureArgs,
    #[command(flatten)]
    #[serde(flatten)]
    pub common: Common,
}
