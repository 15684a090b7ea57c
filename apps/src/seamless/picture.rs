//! The pictures of a seamless map, the surface with squares that go on across the seams beside the map, and of a field of four directions.

use super::args::SeamlessArgs;
use super::figures::{SeamlessOutcome, WrittenMap};
use crate::failure::Failure;
use crate::picture::{self, Picture, ShownSurface, TextureChoice};
use crate::show::LayoutDrawing;
use ricci::geometry::vector::{self, Vector};
use ricci::mesh::FaceId;
use ricci::seamless::{ConeValence, CrossField};
use std::f64::consts::FRAC_PI_2;

/// The surface with the field: in each face four squares that meet at its centre, with sides along the directions of the field.
pub fn draw_field(
    outcome: &SeamlessOutcome,
    field: &CrossField,
    args: &SeamlessArgs,
) -> Result<Vec<u8>, Failure> {
    let positions = outcome.input.positions().ok_or_else(Failure::no_positions)?;
    let directions = field.in_space(&outcome.input.surface).ok_or_else(Failure::no_positions)?;
    let mesh = outcome.input.mesh();
    let corner_uv = |f: FaceId| {
        let corners = mesh.face_vertices(f).map(|v| positions[v.index()]);
        centred(corners, directions[f])
    };
    let corner_uv: Vec<_> = mesh.faces().map(corner_uv).collect();
    let (faces, cones) = (mesh.triangles(), cones(outcome));
    let surface = ShownSurface {
        positions,
        faces: &faces,
        corner_uv: Some(&corner_uv),
        seams: &[],
        cones: &cones,
        is_closed: false,
    };
    let style = args.picture.style(TextureChoice::Checker, args.common.threads);
    picture::png(&Picture { surface: Some(surface), ..Picture::default() }, &style)
}

/// The corners of a triangle seen from its centre, along a direction and the one to its left.
fn centred(corners: [Vector; 3], direction: Vector) -> [[f64; 2]; 3] {
    let normal = vector::cross(vector::sub(corners[1], corners[0]), vector::sub(corners[2], corners[0]));
    let size = vector::norm(normal).max(f64::MIN_POSITIVE);
    let left = vector::cross(normal, direction).map(|x| x / size);
    let centre = [0, 1, 2].map(|k| (corners[0][k] + corners[1][k] + corners[2][k]) / 3.0);
    corners.map(|p| [direction, left].map(|axis| vector::dot(vector::sub(p, centre), axis)))
}

/// Vertices of cones and corners, with their curvature.
fn cones(outcome: &SeamlessOutcome) -> Vec<(u32, f64)> {
    let mesh = outcome.input.mesh();
    let regular = |v| if mesh.is_boundary_vertex(v) { 2.0 } else { 4.0 };
    let of =
        |cone: &ConeValence| (cone.vertex.0, (regular(cone.vertex) - f64::from(cone.valence)) * FRAC_PI_2);
    outcome.found.cones.iter().map(of).collect()
}

pub fn draw(outcome: &SeamlessOutcome, map: &WrittenMap, args: &SeamlessArgs) -> Result<Vec<u8>, Failure> {
    let cones = cones(outcome);
    let drawing = LayoutDrawing::new(&map.laid, &cones);
    let faces = map.laid.mesh().triangles();
    let is_svg = args.picture.is_svg();
    let surface = map.laid.positions.as_deref().filter(|_| !is_svg).map(|positions| ShownSurface {
        positions,
        faces: &faces,
        corner_uv: Some(&drawing.corner_uv),
        seams: &drawing.edges,
        cones: &cones,
        is_closed: false,
    });
    let style = args.picture.style(TextureChoice::Checker, args.common.threads);
    let drawn = Picture { surface, flat: Some(drawing.flat()), ..Picture::default() };
    if is_svg { picture::svg(&drawn, &style) } else { picture::png(&drawn, &style) }
}
