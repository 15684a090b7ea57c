//! The options of `ricci flow`.

use crate::options::{FileName, MetricArgs, distance, positive};
use crate::picture::FlowPictureArgs;
use clap::{Args, ValueEnum};
use ricci::flow::StepRule;
use ricci::geometry::Space;
use serde::Serialize;
use std::path::PathBuf;
use std::str::FromStr;

pub const HELP: &str = "\
Example: a flat torus, its layout as texture coordinates and a picture of both
    ricci make torus -o torus.obj
    ricci flow torus.obj --uv flat.obj --picture flat.png --report flat.json
Example: eight cones, and charts in the unit square
    ricci flow torus.obj --target auto:8 --charts --uv atlas.obj --picture atlas.svg
Example: a sheet for cutting, with the boundary's own lengths
    ricci make disk --height 0.4 -o dome.obj
    ricci flow dome.obj --pin boundary --flat dome.dxf
Example: a surface with holes in one piece without seams, whose longest loop keeps its lengths (the default); its boundary as straight
         as it can be; all loops with their lengths
    ricci make sphere --holes 7 -o swiss.obj
    ricci flow swiss.obj --uv swiss_flat.obj --picture swiss.svg
    ricci flow swiss.obj --target boundary --picture swiss_straight.svg
    ricci flow swiss.obj --pin boundary --picture swiss_pinned.svg

Files
    --target cones:FILE.csv    rows `vertex,curvature`, vertices numbered from 0, radians; 0 where none is named
    --metric M.json            faces, lengths, eta (per face, opposite the corners: bc, ca, ab), u,
                               conformal_factor, epsilon, target, boundary; `input_geometry` is the
                               geometry that `lengths` are in, so the file can be read back as a MESH
    --uv OUT.obj | OUT.glb     the surface with the layout as texture coordinates, in E² scaled to its area, in
                               H² of the Poincaré disk, and the input's colours and normals; with --homogeneous (.obj) each vt is
                               `qx qy q`: linear in a face are these three, the texture is at (x, y); with --on input the input's
                               own vertices and faces, in order, the map made linear on each: faces that fold then fail the check
                               flipped_triangles; --repair splits the fewest edges of the input so that none does, --xref says where
                               own vertices and faces, in order, the map made linear on each
    --flat OUT.obj | .ply | .off | .glb
                               the layout in E² as a mesh of points (x, y, 0), a vertex for each vt of --uv, in the input's unit: with
                               the area of the input, or with --pin the lengths of the metric, which keeps those between pinned vertices
    --flat OUT.svg | OUT.dxf   lines for cutting, on the layers BOUNDARY, SEAMS (both sides of each) and FOLDS (--fold-angle); an SVG is true
                               to size (--flat-unit), DXF is R12, both with the coordinates of the mesh
    --circles C.json           vertex circles and the circles orthogonal to them, in the layout's coordinates
    --trace T.csv              step,energy,max_curvature_error,area,step_size (gradient flow)";

#[derive(Args, Serialize, Debug)]
pub struct FlowArgs {
    #[command(flatten)]
    #[serde(flatten)]
    pub to: MetricArgs,
    /// Background geometry; auto is h2 on closed surfaces of genus ≥ 2 and e2 elsewhere
    #[arg(long, value_enum, default_value_t = SpaceChoice::Auto)]
    #[serde(skip)]
    pub space: SpaceChoice,
    /// Curvature: uniform, outer, boundary, single:V, auto:N, cones:FILE.csv or file:FILE.csv [default: by the surface's topology]
    #[arg(long, value_name = "TARGET", long_help = TARGET_HELP)]
    #[serde(skip)]
    pub target: Option<TargetChoice>,
    /// The loop that keeps its lengths with --target outer, numbered from 0 in the order of ricci info [default: the longest]
    #[arg(long, value_name = "LOOP")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub outer: Option<usize>,
    /// Keep the total area during the gradient flow (E²)
    #[arg(long)]
    pub area_normalised: bool,
    /// Step size of the gradient flow: armijo, stable or fixed:H, with which the energy falls at every step, or barzilai-borwein, with which it
    /// may rise on the way [default: armijo]
    #[arg(long, value_name = "RULE")]
    #[serde(skip)]
    pub steps: Option<StepsChoice>,
    /// Hold the conformal factor at 0 at these vertices, whose curvature is then free: boundary, or V,V,… (numbered from 0)
    #[arg(long, value_name = "VERTICES")]
    #[serde(skip)]
    pub pin: Option<PinChoice>,
    /// A file of several components: flow each, and write their layouts side by side; result.components has a row for each
    #[arg(long, value_enum, value_name = "WHICH")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub components: Option<ComponentsChoice>,
    /// Edges that are not flipped (seams, feature lines), a CSV of rows vertex,vertex (numbered from 0)
    #[arg(long, value_name = "E.csv")]
    pub keep_edges: Option<FileName>,
    /// Write homogeneous texture coordinates to --uv, `vt qx qy q`: the projective map of each piece is linear in them
    #[arg(long, requires = "uv")]
    pub homogeneous: bool,
    /// Write the vertex circles and dual circles of the layout (circle schemes, E²)
    #[arg(long, value_name = "C.json")]
    pub circles: Option<FileName>,
    #[command(flatten)]
    #[serde(flatten)]
    pub picture: FlowPictureArgs,
    /// Write the steps of the gradient flow
    #[arg(long, value_name = "T.csv")]
    pub trace: Option<FileName>,
    /// Cut a layout that overlaps itself into charts that do not, packed into the unit square (--uv, --picture)
    #[arg(long)]
    pub charts: bool,
    /// Least distance of two charts, in sides of the unit square
    #[arg(long, value_name = "DISTANCE", default_value_t = 1.0 / 256.0, value_parser = distance, requires = "charts")]
    pub margin: f64,
}

const TARGET_HELP: &str = "\
Prescribed curvature in radians:
  uniform         2πχ/V at every vertex of a closed surface in E²; 0 everywhere in H² and S²
  outer           0 inside; the outer loop (the longest, or --outer LOOP) keeps its lengths, holes are filled while the flow runs:
                  one piece without seams, isometric if the surface can be unrolled (E², genus 0 with boundary)
  boundary        0 inside, 2πχ shared over the boundary in proportion to its length (E², open surfaces)
  single:V        all of 2πχ at vertex V (numbered from 0), 0 elsewhere (E²)
  auto:N          N cones where they lower the distortion of area most, 0 elsewhere inside (E²)
  cones:FILE.csv  the curvatures of the file's rows `vertex,curvature`, 0 elsewhere
  file:FILE.csv   the curvature of every vertex
[default: outer on open surfaces of genus 0 in E², auto:N on those with handles, N = |χ| from 4 to 64; four cones of π on closed surfaces of genus 0 in E²; uniform elsewhere;
with --pin 0 at every vertex that is not pinned]";

#[derive(ValueEnum, Serialize, Debug, Clone, Copy, PartialEq)]
#[serde(rename_all = "lowercase")]
pub enum SpaceChoice {
    Auto,
    E2,
    H2,
    S2,
}

impl SpaceChoice {
    /// The space asked for; `None` is auto.
    pub fn space(self) -> Option<Space> {
        match self {
            SpaceChoice::Auto => None,
            SpaceChoice::E2 => Some(Space::E2),
            SpaceChoice::H2 => Some(Space::H2),
            SpaceChoice::S2 => Some(Space::S2),
        }
    }
}

/// The components of a file that are flattened.
#[derive(ValueEnum, Serialize, Debug, Clone, Copy, PartialEq)]
#[serde(rename_all = "lowercase")]
pub enum ComponentsChoice {
    /// Each alone, those with the most faces first
    All,
}

/// A target as it is asked for.
#[derive(Debug, Clone, PartialEq)]
pub enum TargetChoice {
    Uniform,
    Outer,
    Boundary,
    Single(u32),
    Auto(usize),
    Cones(PathBuf),
    File(PathBuf),
}

impl FromStr for TargetChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.split_once(':') {
            None if text == "uniform" => Ok(TargetChoice::Uniform),
            None if text == "outer" => Ok(TargetChoice::Outer),
            None if text == "boundary" => Ok(TargetChoice::Boundary),
            Some(("single", v)) => {
                v.parse().map(TargetChoice::Single).map_err(|_| format!("`{v}` is not a vertex number"))
            }
            Some(("cones", file)) if !file.is_empty() => Ok(TargetChoice::Cones(file.into())),
            Some(("file", file)) if !file.is_empty() => Ok(TargetChoice::File(file.into())),
            Some(("auto", n)) => {
                n.parse().map(TargetChoice::Auto).map_err(|_| format!("`{n}` is not a number of cones"))
            }
            _ => {
                Err("must be uniform, outer, boundary, single:V, auto:N, cones:FILE.csv or file:FILE.csv"
                    .into())
            }
        }
    }
}

impl std::fmt::Display for TargetChoice {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            TargetChoice::Uniform => f.write_str("uniform"),
            TargetChoice::Outer => f.write_str("outer"),
            TargetChoice::Boundary => f.write_str("boundary"),
            TargetChoice::Single(v) => write!(f, "single:{v}"),
            TargetChoice::Auto(n) => write!(f, "auto:{n}"),
            TargetChoice::Cones(file) => write!(f, "cones:{}", file.display()),
            TargetChoice::File(file) => write!(f, "file:{}", file.display()),
        }
    }
}

/// The step rule of the gradient flow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepsChoice(pub StepRule);

impl FromStr for StepsChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.split_once(':') {
            None if text == "armijo" => Ok(StepsChoice(StepRule::Armijo)),
            None if text == "barzilai-borwein" => Ok(StepsChoice(StepRule::BarzilaiBorwein)),
            None if text == "stable" => Ok(StepsChoice(StepRule::Stable)),
            Some(("fixed", size)) => positive(size).map(|h| StepsChoice(StepRule::Fixed(h))),
            _ => Err("must be armijo, barzilai-borwein, stable or fixed:H".into()),
        }
    }
}

impl std::fmt::Display for StepsChoice {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.0 {
            StepRule::Armijo => f.write_str("armijo"),
            StepRule::BarzilaiBorwein => f.write_str("barzilai-borwein"),
            StepRule::Stable => f.write_str("stable"),
            StepRule::Fixed(h) => write!(f, "fixed:{h}"),
        }
    }
}

/// Vertices whose conformal factor is held.
#[derive(Debug, Clone, PartialEq)]
pub enum PinChoice {
    Boundary,
    Vertices(Vec<u32>),
}

impl FromStr for PinChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text == "boundary" {
            return Ok(PinChoice::Boundary);
        }
        let vertex = |v: &str| v.trim().parse().map_err(|_| format!("`{v}` is not a vertex number"));
        text.split(',').map(vertex).collect::<Result<_, _>>().map(PinChoice::Vertices)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn step_rules_read_back_as_written() {
        for text in ["armijo", "barzilai-borwein", "stable", "fixed:0.25"] {
            assert_eq!(text.parse::<StepsChoice>().unwrap().to_string(), text);
        }
        for text in ["", "fixed", "fixed:0", "fixed:-1", "fixed:nan", "Armijo"] {
            assert!(text.parse::<StepsChoice>().is_err(), "{text}");
        }
    }

    #[test]
    fn targets_read_back_as_written() {
        for text in ["uniform", "outer", "boundary", "single:7", "auto:4", "cones:a:b.csv", "file:/x/y.csv"] {
            assert_eq!(text.parse::<TargetChoice>().unwrap().to_string(), text);
        }
        for text in ["", "single", "single:-1", "cones:", "auto:", "auto:-1", "Uniform"] {
            assert!(text.parse::<TargetChoice>().is_err(), "{text}");
        }
    }
}
