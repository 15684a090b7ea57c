//! The options of `ricci harmonic`.

use crate::options::{Common, FileName, FlatArgs, SurfaceArgs, positive};
use crate::picture::PictureArgs;
use clap::Args;
use serde::Serialize;

pub const HELP: &str = "\
Example: a disk onto the unit disk, without a flipped triangle
    ricci make disk --height 0.4 -o d.obj
    ricci harmonic d.obj --to disk --uv flat.obj --picture flat.png

Maps are linear on the intrinsic Delaunay triangulation of the surface, where the weights of the Laplacian are at least 0: maps of disks onto
convex regions then flip no triangle. Where two edges of it have the same ends, around spikes, vertices are added first.

--to
    disk             a disk onto the unit disk, the boundary by its length
    polygon[:N]      a disk onto the regular polygon with N corners, at the boundary vertices of --corners or evenly by length
    rectangle        a disk onto the rectangle of its modulus, four boundary vertices (--corners) at the corners
    sphere           a closed surface of genus 0 onto the unit sphere, centred
    file:F.csv       rows vertex,x,y: where these vertices go; the others are free

--to rectangle reports the modulus, width over height, with a lower and an upper bound that hold for the surface of flat triangles itself.

--method heat follows the heat flow df/dt = Δf from the mean of the given values, in implicit steps, and to the sphere the flow of the
tangential part, in explicit ones; the energy falls at every step.

Files
    --trace T.csv              step,energy of the heat flow
    --uv OUT.obj | OUT.glb     the surface with the map to the plane as texture coordinates
    --flat OUT.obj | .ply | .off | .glb | .svg | .dxf
                               the image in the plane as a mesh, or as lines for cutting
    --sphere S.obj | S.glb     the input's vertices on the unit sphere, with the faces of the intrinsic Delaunay triangulation";

#[derive(Args, Serialize, Debug)]
pub struct HarmonicArgs {
    #[command(flatten)]
    #[serde(flatten)]
    pub surface: SurfaceArgs,
    /// Where to: disk, polygon:N, rectangle, sphere or file:F.csv [default: sphere for closed surfaces, else disk]
    #[arg(long, value_name = "TARGET", value_parser = target)]
    #[serde(skip)]
    pub to: Option<MapTarget>,
    /// Corners of the polygon or the rectangle, which has four: boundary vertices (numbered from 0), in order with the surface on the left
    /// [default: evenly by the length of the boundary]
    #[arg(long, value_name = "V,V,…", value_delimiter = ',')]
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub corners: Vec<u32>,
    /// Solve for the map, or follow the heat flow to it
    #[arg(long, value_enum, default_value_t = HarmonicMethodChoice::Solve)]
    pub method: HarmonicMethodChoice,
    /// Length of a step of --method heat to the plane, a time in units of area [default: 1/100 of the surface's area]
    #[arg(long, value_name = "T", value_parser = positive)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub step: Option<f64>,
    /// Most steps of --method heat [default: 10000 to the plane, 2000 to the sphere]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_iterations: Option<u32>,
    /// Write the energy at each step of --method heat
    #[arg(long, value_name = "T.csv")]
    pub trace: Option<FileName>,
    /// Write the surface with its map to the plane as texture coordinates, .obj or .glb
    #[arg(long, value_name = "OUT.obj")]
    pub uv: Option<FileName>,
    #[command(flatten)]
    #[serde(flatten)]
    pub flat: FlatArgs,
    /// Write the map to the sphere, .obj or .glb
    #[arg(long, value_name = "S.obj")]
    pub sphere: Option<FileName>,
    #[command(flatten)]
    #[serde(flatten)]
    pub picture: PictureArgs,
    #[command(flatten)]
    #[serde(flatten)]
    pub common: Common,
}

/// The way to a harmonic map.
#[derive(clap::ValueEnum, Serialize, Debug, Clone, Copy, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub enum HarmonicMethodChoice {
    /// Linear solves; to the sphere, implicit steps in the metric of the image
    Solve,
    /// The heat flow
    Heat,
}

/// The image that a surface is mapped onto.
#[derive(Serialize, Debug, Clone, PartialEq)]
#[serde(rename_all = "lowercase")]
pub enum MapTarget {
    Disk,
    /// A polygon with this many corners; none where `--corners` names them.
    Polygon(Option<u32>),
    Rectangle,
    Sphere,
    File(FileName),
}

fn target(text: &str) -> Result<MapTarget, String> {
    match text {
        "disk" => Ok(MapTarget::Disk),
        "polygon" => Ok(MapTarget::Polygon(None)),
        "rectangle" => Ok(MapTarget::Rectangle),
        "sphere" => Ok(MapTarget::Sphere),
        _ => match (text.strip_prefix("polygon:"), text.strip_prefix("file:")) {
            (Some(n), _) => match n.parse() {
                Ok(n) if n >= 3 => Ok(MapTarget::Polygon(Some(n))),
                _ => Err(format!("polygon:{n}: the number of corners is whole, at least 3 and below 2^32")),
            },
            (_, Some(path)) if !path.is_empty() => Ok(MapTarget::File(std::ffi::OsString::from(path).into())),
            _ => Err("must be disk, polygon:N, rectangle, sphere or file:F.csv".into()),
        },
    }
}
