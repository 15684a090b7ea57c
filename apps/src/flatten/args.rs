//! The options of `ricci flatten`.

use crate::options::{Common, FileName, FlatArgs, SurfaceArgs, choices, number, positive};
use crate::picture::PictureArgs;
use crate::seamless::ConesChoice;
use clap::Args;
use clap::builder::TypedValueParser;
use ricci::flatten::DistortionEnergy;
use serde::Serialize;

pub const HELP: &str = "\
Example: a bowl, flat with as little stretch as possible
    ricci make disk --height 0.4 -o bowl.obj
    ricci flatten bowl.obj --uv flat.obj --picture flat.png --report flat.json

The map starts at the conformal layout that keeps the lengths of the outer loop; holes are closed while that is solved for. Newton's method then
descends the energy, the boundary free. No triangle is turned over on the way, nor in the file, which is read again to see.

--energy, by the stretches s and t of each triangle along two perpendicular directions
    isometric        lengths: s² + t² + 1/s² + 1/t², 4 where nothing is stretched
    arap             lengths: (s − 1)² + (t − 1)², as rigid as possible
    area             areas: 2 (s t + 1/(s t)), with a share of the conformal energy 2 (s/t + t/s), by default 0.1
    distance         lengths d of shortest paths between vertices that at most --rings edges separate: (|p - q|/d - 1)²

Conditions, in CSV files whose vertices and faces count from 0
    --weights W.csv            face,weight: how much faces count beside others, 1 without a row
    --pin P.csv                vertex,x,y: where vertices are, to the last digit
    --straight S.csv           piece,vertex: runs of vertices, such as parts of the border, each on a straight line
    --injective                no part lies on another one: sides of the border repel each other, and an exact test says so of the numbers written

Surfaces of genus 1 and more, and others with --cones, are cut open along seams that stay rotations by multiples of 90°, exactly so in the
    numbers of the files; a boundary is free. The cones are those of --cones field, auto:N or V.csv, as for `ricci seamless`. Where a triangle would be turned over at the start,
    edges are split; the first vertices are the input's.

Closed surfaces of genus 0 come to the sphere of their area, with --energy isometric or area, from the conformal map or one of the triangulation
    alone: --sphere S.obj has the input's vertices and faces on the unit sphere, turned as the surface is in space. It is read again as well.

Sheets: --strain 0.05,0.1 --shear 10 are the limits of a material along --warp 0 (degrees from x) and across. Where the flat sheet would be
    strained more when it takes the shape of the surface, seams open from the border inwards, one after the other, until the limits hold,
    --darts are made, or --open LENGTH is used up. The report has the strains and the darts; files have the surface cut open.

Files
    --uv OUT.obj | OUT.glb     the surface with the map as texture coordinates, in the surface's unit of length
    --sphere S.obj | .ply | .off | .glb | lh.sphere
                               the map on the unit sphere, of closed surfaces of genus 0
    --flat OUT.obj | .ply | .off | .glb | .svg | .dxf
                               the map in the plane as a mesh, or as lines for cutting
    --patch lh.patch.flat      the map as a patch of FreeSurfer: the numbers of the vertices, negative on the border, and their places, z = 0
    --areal, --shape           areal and shape distortion of each vertex, as FreeSurfer has values (curv)
    --trace T.csv              step,energy of the descent";

#[derive(Args, Serialize, Debug)]
pub struct FlattenArgs {
    #[command(flatten)]
    #[serde(flatten)]
    pub surface: SurfaceArgs,
    /// What is kept: lengths, as a sum of squares and inverse squares or as rigidly as possible, areas, or lengths of shortest paths
    #[arg(long, value_enum, default_value_t = EnergyChoice::Isometric)]
    pub energy: EnergyChoice,
    /// Share of the conformal energy, from 0 to 1: with more of it angles are kept better and lengths worse [default: 0; 0.1 with --energy area]
    #[arg(long, value_name = "SHARE", value_parser = share)]
    #[serde(skip)]
    pub conformal: Option<f64>,
    /// Most edges between two vertices whose distance --energy distance keeps
    #[arg(long, value_name = "K", default_value_t = ricci::flatten::RINGS, value_parser = rings())]
    pub rings: usize,
    /// Cut the surface open along seams between cones: field, auto:N, or a table vertex,valence [default: field for genus 1 and more]
    #[arg(long, value_name = "CONES")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cones: Option<ConesChoice>,
    /// Let no part of the map lie on another one
    #[arg(long)]
    pub injective: bool,
    /// Weights of faces: CSV face,weight
    #[arg(long, value_name = "W.csv", conflicts_with = "label")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub weights: Option<FileName>,
    /// Places of vertices in the plane: CSV vertex,x,y
    #[arg(long, value_name = "P.csv")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pin: Option<FileName>,
    /// Runs of vertices that become straight: CSV piece,vertex
    #[arg(long, value_name = "S.csv")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub straight: Option<FileName>,
    /// Largest strain of a sheet along warp and weft, from the plane to the surface: where one is passed, darts are suggested as cuts
    #[arg(long, value_name = "WARP,WEFT", value_parser = pair)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub strain: Option<[f64; 2]>,
    /// Largest shear, degrees between warp and weft
    #[arg(long, value_name = "DEGREES", value_parser = positive)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shear: Option<f64>,
    /// The direction of the warp in the plane, degrees from the x axis
    #[arg(long, value_name = "DEGREES", default_value_t = 0.0, allow_hyphen_values = true, value_parser = finite)]
    pub warp: f64,
    /// Most darts
    #[arg(long, value_name = "N", default_value_t = 8)]
    pub darts: usize,
    /// Most length of all darts together, in the surface's unit
    #[arg(long, value_name = "LENGTH", value_parser = positive)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub open: Option<f64>,
    /// Newton decrement of a converged map, about the root of twice the energy that is still to be lost
    #[arg(long, value_name = "T", default_value_t = ricci::flatten::TOLERANCE, value_parser = positive)]
    pub tolerance: f64,
    /// Newton steps before giving up; 0 is the conformal map itself
    #[arg(long, value_name = "N", default_value_t = ricci::flatten::MAX_ITERATIONS)]
    pub max_iterations: usize,
    /// Write the energy at each step
    #[arg(long, value_name = "T.csv")]
    pub trace: Option<FileName>,
    /// Write the surface with its map to the plane as texture coordinates, .obj or .glb
    #[arg(long, value_name = "OUT.obj")]
    pub uv: Option<FileName>,
    /// Write the map of a closed surface of genus 0 to the unit sphere as a mesh
    #[arg(long, value_name = "S.obj")]
    pub sphere: Option<FileName>,
    #[command(flatten)]
    #[serde(flatten)]
    pub flat: FlatArgs,
    /// Flatten the largest piece of the surface whose faces lie in this label of FreeSurfer, such as a cortex without its medial wall
    #[arg(long, value_name = "lh.cortex.label")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub label: Option<FileName>,
    /// Write log2 of the area around each vertex in the plane over that on the surface, as values of FreeSurfer; 0 outside a label
    #[arg(long, value_name = "lh.areal")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub areal: Option<FileName>,
    /// Write log2 of the dilatation around each vertex, the larger stretch over the smaller one, as values of FreeSurfer; 0 outside a label
    #[arg(long, value_name = "lh.shape")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shape: Option<FileName>,
    /// Write the map as a patch of FreeSurfer, with the vertices of the border marked
    #[arg(long, value_name = "lh.patch.flat")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub patch: Option<FileName>,
    #[command(flatten)]
    #[serde(flatten)]
    pub picture: PictureArgs,
    #[command(flatten)]
    #[serde(flatten)]
    pub common: Common,
}

choices!(EnergyChoice = DistortionEnergy { Isometric, Arap, Area, Distance });

/// More rings than this make more pairs than memory holds.
fn rings() -> impl TypedValueParser<Value = usize> {
    clap::value_parser!(u8).range(1..=10).map(usize::from)
}

fn finite(text: &str) -> Result<f64, String> {
    number(text, |_| true, "must be a number")
}

/// Two positive numbers.
fn pair(text: &str) -> Result<[f64; 2], String> {
    let parts: Vec<f64> = text.split(',').filter_map(|x| x.trim().parse().ok()).collect();
    match parts[..] {
        [a, b] if a > 0.0 && b > 0.0 && a.is_finite() && b.is_finite() => Ok([a, b]),
        _ => Err("must be two numbers above 0, such as 0.05,0.1".into()),
    }
}

fn share(text: &str) -> Result<f64, String> {
    number(text, |x| (0.0..=1.0).contains(&x), "must be a share from 0 to 1")
}
