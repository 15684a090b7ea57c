//! The options of `ricci view`.

use crate::options::{Common, FileName};
use clap::Args;
use serde::Serialize;
use std::path::PathBuf;

pub const HELP: &str = "\
Example: a surface beside its layout, with the distortion of areas and angles in colours
    ricci make torus -o t.obj && ricci flow t.obj --target auto:4 --uv flat.obj
    ricci view flat.obj -o flat.html

Example: a ball beside its image on the unit sphere, with a number at each vertex in colours
    ricci make ellipsoid -o e.obj && ricci uniformize e.obj --sphere s.obj
    ricci view e.obj --image s.obj --values thickness.csv -o ball.html

The page is one file, which any browser shows without a network. Drag to turn a surface, use the wheel to come closer, and point at a
place: the same place is marked on the other side, with its coordinates and numbers. Below a view stand the density of the checks, which lie
on both sides, the seams, and the quantities that can be shown in colours. Several files stand below each other.

What is shown
    a mesh with texture coordinates    the surface beside them, such as all files of --uv; quantities are the logarithm of the change of
                                       area and the quasi-conformal dilatation (1 where angles are kept), means of the faces around
    a mesh without                     the surface alone; with --image beside another file with the same vertices in the same order
    numbers of vertices in a PLY file  quantities under their names

Places in a page are rounded to 1/65535 of the longest side of a surface. A million vertices make a page of about 50 MB.";

#[derive(Args, Serialize, Debug)]
pub struct ViewArgs {
    /// Mesh files (.obj, .off, .ply, .stl, .glb, .gltf, .gii, .vtk, .vtp, .mz3, FreeSurfer's; also .gz), with texture coordinates or without; - for stdin
    #[arg(required = true, value_name = "FILES")]
    pub files: Vec<PathBuf>,
    /// The page
    #[arg(short = 'o', long = "out", value_name = "PAGE.html")]
    pub out: FileName,
    /// Show this mesh beside the surface, whose vertices it has in the same order, such as that of --sphere
    #[arg(long, value_name = "MESH")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub image: Option<FileName>,
    /// Show numbers at the vertices of every file in colours: rows vertex,NAME (numbered from 0); vertices without a number are grey; may be
    /// given several times
    #[arg(long, value_name = "Q.csv")]
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub values: Vec<FileName>,
    /// The direction that is up [default: by the shape of the surface]
    #[arg(long, value_name = "AXIS", allow_hyphen_values = true, value_parser = ["x", "y", "z", "-x", "-y", "-z"])]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub up: Option<String>,
    /// The title of the page [default: the names of the files]
    #[arg(long, value_name = "TEXT")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
    #[command(flatten)]
    #[serde(flatten)]
    pub common: Common,
}
