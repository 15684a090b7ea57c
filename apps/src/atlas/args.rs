//! The options of `ricci atlas`.

use crate::options::{Common, FileName, number};
use crate::picture::PictureArgs;
use clap::Args;
use ricci::mesh::io::SceneOptions;
use ricci::texture::TextureOptions;
use serde::Serialize;
use std::path::{Path, PathBuf};

pub const HELP: &str = "\
Example: a model of any kind with a texture atlas, and a picture of both
    ricci make genus --genus 2 -o model.obj
    ricci atlas model.obj -o atlas.obj --xref back.csv --picture atlas.png

Any model goes in: several components, edges with more than two faces, one-sided strips, faces without area. The file has the faces of
the model, in their order (polygons as triangles), and its vertices with their numbers; OBJ has texture coordinates at corners, in glTF a vertex is
repeated where a seam passes. No face is turned over and no two overlap, by exact arithmetic on the numbers of the file, which are multiples
of 2^-24: .obj and .glb hold the same ones.

--stretch S bounds how much all but a hundredth of the area is stretched or compressed along any direction; seams are added until it holds.
--fill divides charts along short paths while the page is filled less than that; 0 leaves seams shortest. Charts keep --margin texels apart on
a page of --page texels.

--density D gives every unit of length D texels, over all meshes of a scene, on as many pages of --page texels as that takes; charts that are larger than
a page are divided, and --fill has no effect. Page p is the tile 1001 + p of UDIM: its u begins at p mod 10, its v at p / 10 rounded down; the numbers are
then multiples of 2^-20.

A scene stays a scene: of a .glb or .gltf file, -o OUT.glb has the nodes, materials, cameras, animations, names and extras as they were, and one
atlas for all its meshes, with texels of one size in the scene. Vertices are repeated along seams with all their attributes and morph targets.
A mesh that several nodes show has one set of charts, in the size of the largest. Textures keep their places: the atlas is TEXCOORD_0 if no texture
uses that, else the next free set; --texcoord N asks for another one. --tangents writes tangents of the atlas for meshes
with normals; a model that is no scene gets normals where it has none.

Files
    -o OUT.obj | OUT.glb       the model with its texture coordinates
    --xref X.csv               rows texcoord,vertex,chart,page: the model's vertex of each texture coordinate of an OBJ file (numbered from 0)";

#[derive(Args, Serialize, Debug)]
pub struct TextureArgs {
    /// Mesh file (.obj, .off, .ply, .stl, .glb, .gltf, .gii, .vtk, .vtp, .mz3, FreeSurfer's; also .gz)
    #[serde(skip)]
    pub mesh: PathBuf,
    /// The model with its texture coordinates (.obj, .glb)
    #[arg(short = 'o', long = "out", value_name = "OUT")]
    pub out: FileName,
    /// The bound of the stretch, above 1
    #[arg(long, value_name = "S", default_value_t = TextureOptions::default().stretch, value_parser = above_one)]
    pub stretch: f64,
    /// Texels along a side of the page, a power of two
    #[arg(long, value_name = "TEXELS", default_value_t = TextureOptions::default().page, value_parser = power_of_two)]
    pub page: u32,
    /// Least distance of two charts in texels
    #[arg(long, value_name = "TEXELS", default_value_t = TextureOptions::default().margin)]
    pub margin: u32,
    /// The share of the page below which charts are divided to fill it
    #[arg(long, value_name = "SHARE", default_value_t = TextureOptions::default().fill, value_parser = share)]
    pub fill: f64,
    /// The set of texture coordinates of a scene that the atlas becomes, TEXCOORD_N
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=7))]
    pub texcoord: Option<u32>,
    /// Write tangents of the atlas, into .glb
    #[arg(long)]
    pub tangents: bool,
    /// Texels for a unit of length, and as many pages as that takes
    #[arg(long, value_name = "TEXELS", value_parser = above_zero)]
    pub density: Option<f64>,
    /// Write the model's vertex, the chart and the page of each texture coordinate
    #[arg(long, value_name = "X.csv")]
    pub xref: Option<FileName>,
    #[command(flatten)]
    #[serde(flatten)]
    pub picture: PictureArgs,
    #[command(flatten)]
    #[serde(flatten)]
    pub common: Common,
}

impl TextureArgs {
    /// True if a scene is read and stays one.
    pub fn is_scene(&self) -> bool {
        let is_gltf = |path: &Path| {
            let name = path.to_string_lossy().to_lowercase();
            let name = name.strip_suffix(".gz").unwrap_or(&name);
            name.ends_with(".glb") || name.ends_with(".gltf")
        };
        is_gltf(&self.mesh) && is_gltf(&self.out)
    }

    pub fn scene_options(&self) -> SceneOptions {
        SceneOptions { texcoord: self.texcoord, tangents: self.tangents }
    }

    pub fn options(&self) -> TextureOptions {
        TextureOptions {
            stretch: self.stretch,
            margin: self.margin,
            page: self.page,
            fill: self.fill,
            density: self.density.unwrap_or(0.0),
            threads: self.common.threads,
        }
    }
}

fn above_zero(text: &str) -> Result<f64, String> {
    number(text, |x| x > 0.0, "must be a number above 0")
}

fn above_one(text: &str) -> Result<f64, String> {
    number(text, |x| x > 1.0, "must be a number above 1")
}

fn share(text: &str) -> Result<f64, String> {
    number(text, |x| (0.0..=1.0).contains(&x), "must be a share from 0 to 1")
}

fn power_of_two(text: &str) -> Result<u32, String> {
    let texels = text.parse().ok().filter(|n: &u32| n.is_power_of_two() && (16..=1 << 16).contains(n));
    texels.ok_or_else(|| "must be a power of two from 16 to 65536".into())
}
