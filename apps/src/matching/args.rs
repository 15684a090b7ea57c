//! The options of `ricci match`.

use crate::options::{Common, FileName, MeshArgs};
use crate::picture::PictureArgs;
use clap::{Args, ValueEnum};
use ricci::matching::Boundary;
use serde::Serialize;
use std::path::PathBuf;

pub const HELP: &str = "\
Example: a torus onto a thicker one, and the first in the shape of the second
    ricci make torus --small 0.4 -o thin.obj
    ricci make torus --small 0.7 -o thick.obj
    ricci match thin.obj thick.obj --map M.csv -o shaped.obj --picture both.png --report R.json

The two surfaces have the same genus and the same number of boundary loops. The target gets its metric of constant curvature, with cones at the
landmarks and straight boundaries, and the source goes into it by a harmonic map with positive weights, which folds no face. Of the homotopy classes that
landmarks and loops leave open one of low energy is taken. Boundaries slide along each other between landmarks on them, or go to each other by
shares of their length. Spheres without landmarks are
turned until their conformal factors fit best.

Files
    --landmarks L.csv    rows source_vertex,target_vertex: pairs inside the surfaces, or on their boundaries. A sphere takes none or at least
                         three; surfaces with handles take none, a torus one
    --map M.csv          rows source_vertex,target_face,b0,b1,b2: where each vertex of the source goes, in barycentric coordinates
    --back B.csv         the same from the target to the source
    -o OUT.obj           the source's faces with its vertices where they go, .obj or .glb
    --carried C.obj      the source with the target's texture coordinates, .obj or .glb";

/// How boundaries correspond.
#[derive(ValueEnum, Serialize, Debug, Clone, Copy, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum BoundaryName {
    /// They slide along each other until the map is harmonic
    Slides,
    /// By shares of their length
    ArcLength,
}

impl From<BoundaryName> for Boundary {
    fn from(name: BoundaryName) -> Boundary {
        match name {
            BoundaryName::Slides => Boundary::Slides,
            BoundaryName::ArcLength => Boundary::ArcLength,
        }
    }
}

#[derive(Args, Serialize, Debug)]
pub struct MatchArgs {
    #[command(flatten)]
    #[serde(flatten)]
    pub source: MeshArgs,
    /// Mesh file of the surface that the source is mapped to
    pub target: PathBuf,
    /// Pairs of vertices that correspond: rows source_vertex,target_vertex
    #[arg(long, value_name = "L.csv")]
    pub landmarks: Option<FileName>,
    /// For each boundary loop of the source the target's that it goes to, numbered from 0 [default: by descending length]
    #[arg(long, value_name = "K,K,…", value_delimiter = ',')]
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub loops: Vec<usize>,
    /// How boundaries correspond between landmarks on them
    #[arg(long, value_enum, default_value = "slides")]
    pub boundary: BoundaryName,
    /// Vertices with the same number correspond: the report says how far from its partner each comes to lie
    #[arg(long)]
    pub same_numbering: bool,
    /// Write where each vertex of the source goes
    #[arg(long, value_name = "M.csv")]
    pub map: Option<FileName>,
    /// Write where each vertex of the target goes
    #[arg(long, value_name = "B.csv")]
    pub back: Option<FileName>,
    /// Write the source with its vertices where they go, .obj or .glb
    #[arg(short, long, value_name = "OUT.obj")]
    pub output: Option<FileName>,
    /// Write the source with the target's texture coordinates, .obj or .glb
    #[arg(long, value_name = "C.obj")]
    pub carried: Option<FileName>,
    #[command(flatten)]
    #[serde(flatten)]
    pub picture: PictureArgs,
    #[command(flatten)]
    #[serde(flatten)]
    pub common: Common,
}
