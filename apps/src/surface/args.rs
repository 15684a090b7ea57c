//! The options of `ricci surface`.

use crate::options::{Common, FileName, SurfaceArgs, positive};
use crate::picture::PictureArgs;
use crate::seamless::ConesChoice;
use crate::spline::UnitChoice;
use clap::{Args, ValueEnum};
use serde::Serialize;

pub const HELP: &str = "\
Example: a surface of genus 2 as a solid of few four-sided faces
    ricci make genus -o two.obj
    ricci surface two.obj -o two.step --tolerance 1e-3 --report two_step.json

A seamless map divides the surface into patches between lines that run straight from cone to cone; a spline of degree 5 over these patches, with
common tangent planes across all sides but features, is fitted to the mesh along its normals. Where --tolerance is missed, patches get more
spans, and other cones are tried. Faces that meet share their edges. With --from-quads the input is a control mesh instead, whose Catmull–Clark
surface is fitted over patches of its own quads.

Between features (--features) pieces whose vertices lie on a plane or a cylinder are fitted to that and written as faces on it; of patches that meet
in a plane one face becomes.

Files
    -o PART.step        STEP AP242: a solid where the surface is closed, else a shell
    --patches P.json    knots and numbers of control points of every patch: tensor-product B-splines of degree 5
    --triangles M.obj   triangles of the patches, 24 parts to a side (.obj, .ply, .glb, .stl and the other formats of meshes)";

#[derive(Args, Serialize, Debug)]
pub struct ScanArgs {
    #[command(flatten)]
    #[serde(flatten)]
    pub surface: SurfaceArgs,
    /// The patches (.step, .stp)
    #[arg(short = 'o', long = "out", value_name = "PART.step")]
    pub out: FileName,
    /// Write the patches with their knots and control points (.json)
    #[arg(long, value_name = "P.json")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub patches: Option<FileName>,
    /// Write triangles of the patches
    #[arg(long, value_name = "M.obj")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub triangles: Option<FileName>,
    /// Largest distance from the mesh, over the diagonal of its bounding box [default: 1e-3 or, where that is more, four times the noise
    /// of the mesh]
    #[arg(long, value_name = "T", value_parser = positive)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
    /// The cones, as for `ricci seamless`: field, auto:N, or a table vertex,valence [default: without --features several numbers of placed
    /// cones, then those of the field, until a fit is within the tolerance; those whose fits fold at first come last]
    #[arg(long, value_name = "CONES")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cones: Option<ConesChoice>,
    /// Keep edges at which the surface turns by this much: they are sides of patches across which normals may jump
    #[arg(long, value_name = "DEGREES", value_parser = positive)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub features: Option<f64>,
    /// The file (.obj) is a control mesh of quads, or of any polygons: fit its Catmull–Clark surface, with patches between the lines of edges
    /// that go straight on from irregular vertices
    #[arg(long, conflicts_with_all = ["cones", "features", "weld", "input_geometry"])]
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub from_quads: bool,
    /// Most spans of a patch in each direction
    #[arg(long, value_name = "N", default_value_t = 6, value_parser = clap::value_parser!(u8).range(1..=32))]
    pub spans: u8,
    /// Weight of bending at the end of the fit, up to 1e-5: more for noise, less for more detail [default: 1e-8; where that misses the
    /// tolerance, as little as suits the measured noise, down to 1e-11]
    #[arg(long, value_name = "W", value_parser = positive)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bending: Option<f64>,
    /// The unit of the coordinates, which the file says
    #[arg(long, value_enum, value_name = "UNIT", default_value = "mm")]
    pub unit: UnitChoice,
    /// Give each face a colour that differs from those of its neighbours
    #[arg(long)]
    pub colours: bool,
    #[command(flatten)]
    #[serde(flatten)]
    pub picture: PictureArgs,
    /// What the picture shows in colours
    #[arg(long, value_enum, value_name = "QUANTITY", default_value = "patches", requires = "picture")]
    pub color: ScanColor,
    /// Draw combs along the sides and the middle lines of patches: as long as the curvature along the line is large
    #[arg(long, requires = "picture")]
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub combs: bool,
    #[command(flatten)]
    #[serde(flatten)]
    pub common: Common,
}

/// Quantities that a picture of patches shows in colours.
#[derive(ValueEnum, Serialize, Debug, Clone, Copy, PartialEq)]
#[serde(rename_all = "lowercase")]
pub enum ScanColor {
    /// The patches
    Patches,
    /// The distance of the mesh from the patches, over the diagonal, on the mesh
    Distance,
    /// Gaussian curvature
    Curvature,
    /// Reflections of light lines at infinity: as smooth as the normals
    Reflection,
}
