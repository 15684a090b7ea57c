//! The options of `ricci quads` and `ricci layout`.

use crate::options::{Common, FileName, SurfaceArgs};
use crate::picture::PictureArgs;
use crate::seamless::ConesChoice;
use clap::Args;
use ricci::quads::QuadSize;
use serde::Serialize;

pub const HELP: &str = "\
Example: a torus as about 500 quads, and where their vertices lie on it
    ricci make torus -o torus.obj
    ricci quads torus.obj -o quads.obj --faces 500 --map on.csv

All vertices have four quads but those at the cones of the seamless map, and edges run along the boundary and features. The map of each
quad onto its unit square follows from whole numbers, without a tolerance.

Files
    -o Q.obj | Q.ply    faces with four corners, vertices on the input's faces
    -o Q.glb            the same with two triangles for each quad, since glTF has no quads
    --map X.csv         rows quad_vertex,source_face,b0,b1,b2: the face of each vertex and barycentric coordinates in it";

#[derive(Args, Serialize, Debug)]
pub struct QuadsArgs {
    #[command(flatten)]
    #[serde(flatten)]
    pub source: QuadSourceArgs,
    /// The quad mesh (.obj, .ply, .glb)
    #[arg(short = 'o', long = "out", value_name = "Q.obj")]
    pub out: FileName,
    #[command(flatten)]
    #[serde(flatten)]
    pub size: QuadSizeArgs,
    /// Write the places of the vertices on the input
    #[arg(long, value_name = "X.csv")]
    pub map: Option<FileName>,
    /// Texture coordinates: in each rectangle of the T-mesh the quads are unit squares with whole coordinates (.obj)
    #[arg(long)]
    pub texture: bool,
    #[command(flatten)]
    #[serde(flatten)]
    pub picture: PictureArgs,
    #[command(flatten)]
    #[serde(flatten)]
    pub common: Common,
}

/// The surface and its seamless metric.
#[derive(Args, Serialize, Debug)]
pub struct QuadSourceArgs {
    #[command(flatten)]
    #[serde(flatten)]
    pub surface: SurfaceArgs,
    /// The cones, as for `ricci seamless`: field, auto:N, or a table vertex,valence
    #[arg(long, value_name = "CONES", default_value_t = ConesChoice::Field)]
    pub cones: ConesChoice,
    /// Take edges at which the surface turns by this much as features
    #[arg(long, value_name = "DEGREES", value_parser = crate::options::positive)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub features: Option<f64>,
    /// Largest deviation of an angle of the seamless metric from a multiple of 90°, radians
    #[arg(long, value_name = "RADIANS", default_value_t = 1e-10, value_parser = crate::options::positive)]
    pub tolerance: f64,
}

/// The size of the quads.
#[derive(Args, Serialize, Debug)]
#[group(multiple = false)]
pub struct QuadSizeArgs {
    /// The edge length, in the units of the input
    #[arg(long, value_name = "L", value_parser = crate::options::positive)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub edge: Option<f64>,
    /// About this number of quads [default: 1000]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub faces: Option<u32>,
    /// As few quads as the lines between cones allow
    #[arg(long)]
    pub coarse: bool,
}

impl QuadSizeArgs {
    pub fn size(&self) -> QuadSize {
        match (self.edge, self.faces) {
            (Some(edge), _) => QuadSize::Edge(edge),
            (_, Some(n)) => QuadSize::Quads(n as usize),
            _ if self.coarse => QuadSize::Coarse,
            _ => QuadSize::Quads(1000),
        }
    }
}

pub const LAYOUT_HELP: &str = "\
Example: a surface of genus 2 divided into few four-sided patches
    ricci make genus -o two.obj
    ricci layout two.obj -o layout.json --quads patches.obj

The patches are those of a quad mesh with as few quads as its cones allow, between lines of edges that go straight on. Sides have whole
lengths, and opposite sides the same.

Files
    -o L.json           {nodes, arcs, patches}: nodes by vertex of the input or face and weights, with valence and crease; arcs with the
                        nodes from and to, length, crease and points in space; patches with size and four sides, each a list of arcs:
                        arc a as a + 1 in its direction and −(a + 1) against it
    --quads Q.obj       the patches as quads, eight to a unit of length, each patch as a group
    --quads Q.ply       the same with the number of its patch for each quad
    --quads Q.glb       two triangles for each quad, without the patches";

#[derive(Args, Serialize, Debug)]
pub struct LayoutArgs {
    #[command(flatten)]
    #[serde(flatten)]
    pub source: QuadSourceArgs,
    /// The layout (.json)
    #[arg(short = 'o', long = "out", value_name = "L.json")]
    pub out: FileName,
    /// At most this number of patches, with sides near their lengths on the surface, in place of as few as possible
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub patches: Option<u32>,
    /// Write the patches as quads (.obj, .ply, .glb)
    #[arg(long, value_name = "Q.obj")]
    pub quads: Option<FileName>,
    /// Texture coordinates of --quads: in each patch the quads are unit squares with whole coordinates (.obj)
    #[arg(long, requires = "quads")]
    pub texture: bool,
    #[command(flatten)]
    #[serde(flatten)]
    pub picture: PictureArgs,
    #[command(flatten)]
    #[serde(flatten)]
    pub common: Common,
}
