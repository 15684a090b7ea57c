//! The options of `ricci circles`.

use crate::modulus::ModulusArgs;
use crate::options::{Common, FileName, FlatArgs, SurfaceArgs, choices, positive};
use crate::picture::{PictureArgs, TextureChoice};
use clap::Args;
use ricci::canonical::DomainFrame;
use serde::Serialize;
use std::str::FromStr;

pub const HELP: &str = "\
Example: a planar domain with seven holes in the unit disk
    ricci make sphere --holes 7 -o swiss.obj
    ricci circles swiss.obj --uv round.obj --picture round.png --report round.json

A surface of genus 0 comes to lie in the unit disk, one of its loops on the unit circle; one of genus 1 in a flat torus, with round holes;
one of higher genus in a hyperbolic surface with round holes. Loops are numbered from 0, in the order of their first edges.

Files
    --uv OUT.obj | OUT.glb     the surface with its layout as texture coordinates: of the unit disk, of the strip (--frame strip), of the
                               plane (a torus, scaled to the surface's area), of the Poincaré disk. Vertices beyond the input's lie on its edges
    --flat OUT.obj | .ply | .off | .glb | .svg | .dxf
                               the layout in the disk or the plane as a mesh, or as lines for cutting
    --metric M.json            the metric with the disks: a hub per loop after the surface's vertices, epsilon 1, whose circle the loop lies on;
                               in the unit disk without the outer loop's hub; of a strip the flat cylinder, without hubs";

#[derive(Args, Serialize, Debug, Clone)]
pub struct CirclesArgs {
    #[command(flatten)]
    #[serde(flatten)]
    pub surface: SurfaceArgs,
    /// The loop that becomes the unit circle (genus 0) [default: the longest]
    #[arg(long, value_name = "LOOP")]
    #[serde(skip)]
    pub outer: Option<usize>,
    /// The vertex at the centre of the unit disk [default: the barycentre of the area; of an annulus both circles lie about the centre]
    #[arg(long = "center", value_name = "VERTEX", conflicts_with = "three")]
    #[serde(rename = "center", skip_serializing_if = "Option::is_none")]
    pub centre: Option<u32>,
    /// Three vertices of the outer loop, counterclockwise, to lie at 1, e^(2πi/3) and e^(4πi/3); or each with its angle in degrees, V:ANGLE
    #[arg(long, value_name = "V,V,V")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub three: Option<ThreeVertices>,
    /// Shape of a surface of genus 0: the unit disk; for an annulus also the strip of its log coordinates, [0, 2π] × [0, 2π modulus] with the
    /// outer loop at y = 0, where (x, y) is the point of the disk with angle x and radius e^(−y); auto: the disk, and the strip where
    /// doubles do not hold the inner circle in the disk
    #[arg(long, value_enum, value_name = "SHAPE", default_value_t = FrameChoice::Auto)]
    #[serde(skip)]
    pub frame: FrameChoice,
    /// Halve edges of loops that have fewer than this
    #[arg(long, value_name = "EDGES", default_value_t = ricci::canonical::circle_domain::LEAST_LOOP, value_parser = edges)]
    pub least_loop: usize,
    /// Largest |K| of a converged metric, radians
    #[arg(long, value_name = "T", default_value = "1e-10", value_parser = positive)]
    pub tolerance: f64,
    /// Newton steps before giving up
    #[arg(long, value_name = "N", default_value_t = 500, value_parser = clap::value_parser!(u32).range(1..))]
    pub max_iterations: u32,
    /// Write the metric
    #[arg(long, value_name = "M.json")]
    pub metric: Option<FileName>,
    /// Write the surface with its layout as texture coordinates, .obj or .glb
    #[arg(long, value_name = "OUT.obj")]
    pub uv: Option<FileName>,
    /// Write where the faces and vertices of --uv lie in the input's: rows output_face,source_face, then
    /// output_vertex,source_face,b0,b1,b2
    #[arg(long, value_name = "X.csv", requires = "uv")]
    pub xref: Option<FileName>,
    #[command(flatten)]
    #[serde(flatten)]
    pub flat: FlatArgs,
    #[command(flatten)]
    #[serde(flatten)]
    pub modulus: ModulusArgs,
    #[command(flatten)]
    #[serde(flatten)]
    pub picture: PictureArgs,
    /// Pattern of the layout [default: circles]
    #[arg(long, value_enum, requires = "picture")]
    #[serde(skip)]
    pub texture: Option<TextureChoice>,
    #[command(flatten)]
    #[serde(flatten)]
    pub common: Common,
}

choices!(FrameChoice = DomainFrame { Auto, Disk, Strip });

/// Edges that a loop may be asked to have: more than a million make no circle rounder that doubles can hold.
fn edges(text: &str) -> Result<usize, String> {
    text.parse()
        .ok()
        .filter(|n| (0..=1_000_000).contains(n))
        .ok_or("must be a number of edges, 1000000 at most".into())
}

/// Three vertices of a loop, and the angles on the unit circle that they get, in degrees.
#[derive(Serialize, Debug, Clone, PartialEq)]
pub struct ThreeVertices {
    pub vertices: [u32; 3],
    pub degrees: [f64; 3],
}

impl FromStr for ThreeVertices {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let mut three = ThreeVertices { vertices: [0; 3], degrees: [0.0, 120.0, 240.0] };
        let parts: Vec<&str> = text.split(',').collect();
        if parts.len() != 3 {
            return Err("must be three vertices, V,V,V or V:ANGLE,V:ANGLE,V:ANGLE".into());
        }
        for (k, part) in parts.into_iter().enumerate() {
            let (vertex, angle) = part.split_once(':').map_or((part, None), |(v, angle)| (v, Some(angle)));
            three.vertices[k] =
                vertex.trim().parse().map_err(|_| format!("`{vertex}` is not a vertex number"))?;
            if let Some(angle) = angle {
                three.degrees[k] =
                    crate::options::number(angle.trim(), |_| true, "an angle must be a number of degrees")?;
            }
        }
        Ok(three)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_vertices_have_the_angles_of_a_triangle_unless_they_name_others() {
        let three = |text: &str| text.parse::<ThreeVertices>();
        assert_eq!(
            three("4,5,6").unwrap(),
            ThreeVertices { vertices: [4, 5, 6], degrees: [0.0, 120.0, 240.0] }
        );
        assert_eq!(three("4:10,5:-20,6:90.5").unwrap().degrees, [10.0, -20.0, 90.5]);
        for text in ["", "1,2", "1,2,3,4", "a,1,2", "1:x,2,3", "1:inf,2,3"] {
            assert!(three(text).is_err(), "{text}");
        }
    }
}
