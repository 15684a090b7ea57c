//! Matchings as files and in pictures.

use super::args::MatchArgs;
use super::found::Found;
use crate::failure::Failure;
use crate::input::Input;
use crate::output::{Outputs, write_textured};
use crate::picture::{self, Picture, Surface, Texture, Tiles};
use ricci::matching::SurfaceMap;
use ricci::mesh::Point;
use ricci::mesh::io::Textured;
use std::fmt::Write;
use std::path::Path;

/// Checks of the texture along the target's longest direction.
const CHECKS: f64 = 24.0;

/// A map as rows `source_vertex,target_face,b0,b1,b2`.
pub fn write_map(outputs: &mut Outputs, path: &Path, map: &SurfaceMap) -> Result<(), Failure> {
    let mut text = String::from("source_vertex,target_face,b0,b1,b2\n");
    for (v, place) in map.places.iter().enumerate() {
        let [a, b, c] = place.weights;
        // Writing to a string does not fail.
        let _ = writeln!(text, "{v},{},{a:?},{b:?},{c:?}", place.face);
    }
    outputs.add_bytes(path, text.as_bytes())
}

/// The source's faces, its vertices at their images.
pub fn write_moved(outputs: &mut Outputs, path: &Path, input: &Input, found: &Found) -> Result<(), Failure> {
    let Some(positions) = found.target.positions() else { return Err(no_positions()) };
    let images = found.matching.forward.carry(found.target.mesh(), positions)?;
    let faces = input.mesh().triangles();
    let data = Textured { positions: &images, faces: &faces, ..Textured::default() };
    write_textured(outputs, path, &data)
}

/// The source with the target's texture coordinates. Where these have seams, each vertex takes those of the face of the target that it lies in.
pub fn write_carried(
    outputs: &mut Outputs,
    path: &Path,
    input: &Input,
    found: &Found,
) -> Result<(), Failure> {
    let Some(uv) = &found.target.attributes.uv else {
        return Err(Failure::Failed("the target has no texture coordinates".into()));
    };
    let Some(positions) = input.positions() else { return Err(no_positions()) };
    let texcoords = found.matching.forward.carry_corners(found.target.mesh(), uv)?;
    let faces = input.mesh().triangles();
    let data = Textured {
        positions,
        faces: &faces,
        texcoords: &texcoords,
        face_texcoords: &faces,
        ..Textured::default()
    };
    write_textured(outputs, path, &data)
}

/// Both surfaces with one texture: on the target by its two longest directions, on the source carried over.
pub fn draw(input: &Input, found: &Found, args: &MatchArgs) -> Result<Vec<u8>, Failure> {
    let (Some(from), Some(to)) = (input.positions(), found.target.positions()) else {
        return Err(no_positions());
    };
    let uv = projected(to);
    let carried = found.matching.forward.carry(found.target.mesh(), &uv)?;
    let faces = [input.mesh().triangles(), found.target.mesh().triangles()];
    let corners = |faces: &[[u32; 3]], uv: &[[f64; 2]]| -> Vec<[[f64; 2]; 3]> {
        faces.iter().map(|f| f.map(|v| uv[v as usize])).collect()
    };
    let corner_uv = [corners(&faces[0], &carried), corners(&faces[1], &uv)];
    let surface = |k: usize, positions, is_closed| Surface {
        positions,
        faces: &faces[k],
        corner_uv: Some(&corner_uv[k]),
        seams: &[],
        cones: &[],
        is_closed,
    };
    let style = args.picture.style(Texture::Checker, args.common.threads);
    let pattern = Tiles::even(1.0 / CHECKS, faces[0].len().max(faces[1].len()));
    let both = Picture {
        pattern: Some(&pattern),
        surface: Some(surface(0, from, input.mesh().is_closed())),
        beside: Some(surface(1, to, found.target.mesh().is_closed())),
        ..Picture::default()
    };
    picture::png(&both, &style)
}

/// The coordinates along which points spread farthest, the largest spread 1.
fn projected(points: &[Point]) -> Vec<[f64; 2]> {
    let spread = |k: usize| {
        let ends =
            points.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], p| [a.min(p[k]), b.max(p[k])]);
        ends[1] - ends[0]
    };
    let mut axes = [0, 1, 2];
    axes.sort_by(|&i, &j| spread(j).total_cmp(&spread(i)));
    let size = spread(axes[0]).max(f64::MIN_POSITIVE);
    points.iter().map(|p| [p[axes[0]] / size, p[axes[1]] / size]).collect()
}

fn no_positions() -> Failure {
    Failure::Failed("an intrinsic metric has no positions in space".into())
}
