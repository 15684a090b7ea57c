//! The options of `ricci uniformize` and `ricci cover`.

use super::boundary::BoundaryArgs;
use crate::modulus::ModulusArgs;
use crate::options::{FileName, MetricArgs, choices};
use crate::picture::{PictureArgs, TextureChoice};
use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueEnum};
use ricci::geometry::model::Model;
use serde::Serialize;

pub const UNIFORMIZE_HELP: &str = "\
Example: a surface of genus 2 in the hyperbolic plane, the group of its universal cover, and a picture
    ricci make genus -o two.obj
    ricci uniformize two.obj --uv disk.obj --generators group.json --picture two.png --report two.json

Example: a pair of pants with geodesic boundary, and a bumpy disk as a rectangle
    ricci make pants --lengths 1 2 3 -o pants.json
    ricci uniformize pants.json --generators group.json --picture pants.png
    ricci make disk --height 0.4 -o disk.obj
    ricci uniformize disk.obj --boundary straight --uv rectangle.obj --picture rectangle.png

A torus comes to lie in the plane, surfaces of higher genus in the hyperbolic plane, about the base vertex. A sphere comes to lie on the
unit sphere, as a convex polyhedron with its centre of mass in the middle (with --method gradient by the flow in S², not centred).
A surface with boundary and χ < 0 gets closed geodesics for its boundary loops, in the hyperbolic plane; an annulus becomes a flat cylinder,
whose modulus is height over circumference. With --boundary straight the surface lies in the plane, its boundary straight from corner to
corner; four right angles on a disk make a rectangle, whose modulus is the length of its second side over that of its first.
Such a modulus comes with two proven bounds of that of the polyhedral surface, rounding included.

Files
    --metric M.json            the metric on its triangulation, as of ricci flow
    --uv OUT.obj | OUT.glb     the surface, opened, with its layout as texture coordinates: of the plane (scaled to the surface's
                               area), of the Poincaré disk
    --flat OUT.obj | .ply | .off | .glb | .svg | .dxf
                               a layout in the plane as a mesh, or as lines for cutting
    --sphere S.obj | S.glb     of a sphere: the input's vertices, in order, on the unit sphere, with the faces that flips have led to
    --generators C.json        space, basis (a1, b1, …), word, and a Möbius matrix per generator: of the plane, of the Poincaré disk;
                               intersections, a row per loop of the basis: how often each other one crosses it from right to left,
                               less how often from left to right";

pub const COVER_HELP: &str = "\
Example: a piece of the hyperbolic plane, tiled by copies of a surface of genus 2
    ricci make genus -o two.obj
    ricci cover two.obj --cover tiles.obj --domain domain.json --picture tiles.png

Copies are named by their deck transformation as a word in the generators, a1.b1^-1 for a1 after the inverse of b1.

Files
    --cover OUT.obj | OUT.glb  all copies of the surface opened as --uv has it: an object each, faces and texture coordinates as there
    --domain D.json            the Dirichlet domain of the base point: corners, and per side word, matrix and partner; the corners of
                               the canonical polygon, whose sides are the words of the generators
    --lift L.csv               rows loop,vertex: closed loops on the surface by name, each vertex joined to the next by an edge
    --lift-out O.json          loops lifted to the cover: points in --model, and the deck transformation from the first to the last as
                               word and matrix

Example: a loop of a genus 2 surface lifts to a path from the base point to its image under the loop's deck transformation
    ricci cover two.obj --depth 2 --word a1.b1^-1 --lift-out lift.json --picture lift.png";

/// The options of both commands.
#[derive(Args, Serialize, Debug, Clone)]
pub struct CanonicalArgs {
    #[command(flatten)]
    #[serde(flatten)]
    pub to: MetricArgs,
    /// The vertex (numbered from 0) at the origin, where the loops of the generators meet [default: one from which no vertex is far]; of a
    /// sphere, the one that is sent to infinity on the way [default: one from which sizes differ least]
    #[arg(long, value_name = "VERTEX")]
    #[serde(skip)]
    pub base: Option<u32>,
    /// Write a sphere: the final triangulation with its vertices on the unit sphere, .obj or .glb
    #[arg(long, value_name = "S.obj")]
    pub sphere: Option<FileName>,
    /// Write the generators of the deck group
    #[arg(long, value_name = "C.json")]
    pub generators: Option<FileName>,
    #[command(flatten)]
    #[serde(flatten)]
    pub boundary: BoundaryArgs,
    #[command(flatten)]
    #[serde(flatten)]
    pub picture: PictureArgs,
    /// Pattern of the layout [default: checker]
    #[arg(long, value_enum, requires = "picture")]
    #[serde(skip)]
    pub texture: Option<TextureChoice>,
}

#[derive(Args, Debug, Clone)]
pub struct UniformizeArgs {
    #[command(flatten)]
    pub canonical: CanonicalArgs,
    #[command(flatten)]
    pub modulus: ModulusArgs,
    /// What the picture shows [default: both; without positions in space, and in .svg, dirichlet]
    #[arg(long, value_enum, requires = "picture")]
    pub show: Option<UniformPictureChoice>,
    /// Model of the hyperbolic plane in pictures
    #[arg(long, value_name = "MODEL", requires = "picture", value_parser = model_that_is_drawn())]
    pub model: Option<ModelChoice>,
}

#[derive(Args, Debug, Clone)]
pub struct CoverArgs {
    #[command(flatten)]
    pub canonical: CanonicalArgs,
    /// Copies of word length N at most, which leave gaps beside the first where words are longer [default: every copy that touches the
    /// domain]
    #[arg(long, value_name = "N", conflicts_with = "radius", value_parser = clap::value_parser!(u16).range(0..=64))]
    pub depth: Option<u16>,
    /// Instead: copies whose base point is this far from the base point at most
    #[arg(long, value_name = "DISTANCE", value_parser = crate::options::radius, allow_negative_numbers = true)]
    pub radius: Option<f64>,
    /// Most copies that are made
    #[arg(long, value_name = "N", default_value_t = 10_000, value_parser = clap::value_parser!(u32).range(1..))]
    pub limit: u32,
    /// Write the copies, .obj or .glb
    #[arg(long, value_name = "OUT.obj")]
    pub cover: Option<FileName>,
    /// Write the Dirichlet domain
    #[arg(long, value_name = "D.json")]
    pub domain: Option<FileName>,
    /// Lift this loop from the base point, a word in the generators such as 'a1 b1^-1' or a1.b1^-1; may be given several times
    #[arg(long = "word", value_name = "WORD")]
    pub words: Vec<String>,
    /// Lift the closed loops of these rows loop,vertex
    #[arg(long, value_name = "L.csv")]
    pub lift: Option<FileName>,
    /// Write the lifted loops
    #[arg(long, value_name = "O.json")]
    pub lift_out: Option<FileName>,
    /// What the picture shows [default: tiles]
    #[arg(long, value_enum, requires = "picture")]
    pub show: Option<CoverPictureChoice>,
    /// Model of the hyperbolic plane in --cover, --domain and pictures, where the hyperboloid is drawn as poincare [default: poincare]
    #[arg(long, value_enum, value_name = "MODEL")]
    pub model: Option<ModelChoice>,
}

/// The contents of a picture of `ricci uniformize`.
#[derive(ValueEnum, Serialize, Debug, Clone, Copy, PartialEq)]
#[serde(rename_all = "lowercase")]
pub enum UniformPictureChoice {
    /// The surface, cut along the sides of the Dirichlet domain of the base point, beside that
    Both,
    /// The surface alone
    Surface,
    /// The layout, its sides along edges, coloured in pairs and named by their words
    Domain,
    /// The canonical polygon, geodesic from lift to lift of the base point
    Polygon,
    /// The Dirichlet domain of the base point, its sides coloured in pairs
    Dirichlet,
}

/// The contents of a picture of `ricci cover`.
#[derive(ValueEnum, Serialize, Debug, Clone, Copy, PartialEq)]
#[serde(rename_all = "lowercase")]
pub enum CoverPictureChoice {
    /// The copies of the layout, cut open along edges
    Copies,
    /// The copies of the Dirichlet domain, whose sides are geodesics
    Tiles,
}

/// The contents of a picture of either command.
#[derive(Serialize, Debug, Clone, Copy)]
#[serde(untagged)]
pub enum CanonicalPictureChoice {
    Uniform(UniformPictureChoice),
    Cover(CoverPictureChoice),
}

choices!(
    /// A model of the hyperbolic plane.
    ModelChoice = Model { Poincare, Klein, HalfPlane, Hyperboloid }
);

/// The models that lie in the plane, and can be drawn.
fn model_that_is_drawn() -> impl TypedValueParser<Value = ModelChoice> {
    let drawn = ModelChoice::value_variants().iter().filter(|model| **model != ModelChoice::Hyperboloid);
    PossibleValuesParser::new(drawn.filter_map(ValueEnum::to_possible_value))
        .try_map(|name| ModelChoice::from_str(&name, false))
}
