//! The options of `ricci structure`.

use crate::options::{Common, FileName, FlipsChoice, SurfaceArgs, choices, positive};
use crate::picture::PictureArgs;
use clap::Args;
use ricci::structure::{AffineSource, ChartKind, Structure};
use serde::Serialize;

pub const HELP: &str = "\
Example: the affine atlas of a surface of genus 2 with one singular vertex, and the surface with its charts in colours
    ricci make genus -o two.obj
    ricci structure two.obj --kind affine --charts patches --atlas A.json --picture two.png --report two.json

Kinds
    conformal    any surface: charts in the complex plane, transitions Möbius transformations
    spherical    genus 0: stereographic charts of the unit sphere, rotations in SU(2)
    affine       charts in the Euclidean plane, transitions its motions; a closed surface of genus other than 1 has singular vertices
    hyperbolic   negative Euler characteristic: charts in the Poincaré disk, SU(1,1)
    projective   negative Euler characteristic: charts in the Klein disk, SO(2,1)
    integer      any surface: the quads of a layout are unit squares, transitions turn by multiples of 90° and move by whole numbers

Files
    --atlas A.json             charts (vertices, coordinates, faces, and for each corner of these its place among the vertices),
                               transitions (one for each connected overlap: matrix and shared vertices), singular vertices. A
                               vertex may be in a chart more than once. Faces are those of the metric's triangulation, whose first
                               vertices are the input's; those of an integer structure are halves of quads, with `places`: for each vertex a face of
                               the input and barycentric coordinates in it";

#[derive(Args, Serialize, Debug)]
pub struct StructureArgs {
    #[command(flatten)]
    #[serde(flatten)]
    pub surface: SurfaceArgs,
    /// The structure
    #[arg(long, value_enum)]
    pub kind: KindChoice,
    /// Where an affine structure comes from: the flow to one cone or to the boundary, or a holomorphic 1-form
    #[arg(long, value_enum, default_value_t = SourceChoice::Flow)]
    pub from: SourceChoice,
    /// The singular vertex (numbered from 0) of an affine structure by the flow [default: where areas are distorted least]
    #[arg(long, value_name = "VERTEX")]
    #[serde(skip)]
    pub singular: Option<u32>,
    /// About so many quads of an integer structure [default: those of the layout with the fewest patches]
    #[arg(long, value_name = "N")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub faces: Option<usize>,
    /// Edge flips of the flow: as needed, or never, so that the faces of the atlas are the input's
    #[arg(long, value_enum, default_value_t = FlipsChoice::Auto)]
    pub flips: FlipsChoice,
    /// The charts: stars of vertices, or patches that grow until they would overlap themselves
    #[arg(long, value_enum, default_value_t = ChartsChoice::Stars)]
    pub charts: ChartsChoice,
    /// How far a patch reaches on the sphere or in the hyperbolic plane [default: three of the triangles' longest sides, at least 0.5]
    #[arg(long, value_name = "R", value_parser = positive)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub radius: Option<f64>,
    /// Write the atlas
    #[arg(long, value_name = "A.json")]
    pub atlas: Option<FileName>,
    #[command(flatten)]
    #[serde(flatten)]
    pub picture: PictureArgs,
    #[command(flatten)]
    #[serde(flatten)]
    pub common: Common,
}

choices!(KindChoice = Structure { Conformal, Spherical, Affine, Hyperbolic, Projective, Integer });
choices!(SourceChoice = AffineSource { Flow, Form });
choices!(ChartsChoice = ChartKind { Stars, Patches });
