//! The picture of a sphere: the surface beside it, with one pattern.

use super::sphere::Round;
use crate::failure::Failure;
use crate::input::Input;
use crate::picture::{self, Picture, Style, Surface, Tiles};
use ricci::geometry::vector::{norm, triangle_normal};
use ricci::mesh::{FaceId, HalfedgeId};
use ricci::metric::Refinement;

/// The picture as PNG; `beside`: the sphere too.
pub fn draw(input: &Input, s: &Round, style: &Style, beside: bool) -> Result<Vec<u8>, Failure> {
    let r = s.refinement()?;
    let positions = input.positions().map(|p| r.from_input_vertices(p)).transpose()?;
    let faces = r.mesh.triangles();
    let mut on_sphere = vec![[0.0, 0.0, 1.0]; r.mesh.n_vertices()];
    let (mut uv, mut scale) = (Vec::new(), Vec::new());
    for (f, face) in r.mesh.faces().zip(&faces) {
        let piece = s.piece(r, f);
        (0..3).for_each(|k| on_sphere[face[k] as usize] = piece[k]);
        uv.push(hemisphere(piece));
        scale.push(0.5 * norm(triangle_normal(piece)));
    }
    // On either hemisphere the pattern's scale is between 1/2 and 1 of the sphere's.
    let flat: Vec<f64> = uv.iter().map(|uv| 0.5 * picture::doubled_area(*uv).abs()).collect();
    let tiles = Tiles::new(&scale, &flat, &faces, r.mesh.n_vertices()).banded(style.bands);
    let seam = equator(s, r);
    let surface =
        |positions| Surface { positions, faces: &faces, corner_uv: Some(&uv), seams: &seam, cones: &[] };
    let drawn = Picture {
        surface: positions.as_deref().map(&surface),
        beside: beside.then(|| surface(&on_sphere)),
        pattern: Some(&tiles),
        ..Picture::default()
    };
    picture::png(&drawn, style)
}

/// The edges between the hemispheres, along which the pattern breaks.
fn equator(s: &Round, r: &Refinement) -> Vec<(u32, u32, usize)> {
    let side = |f: FaceId| is_northern(s.piece(r, f));
    let breaks = |h: &HalfedgeId| match [r.mesh.face(*h), r.mesh.face(h.twin())] {
        [Some(f), Some(g)] => side(f) != side(g),
        _ => false,
    };
    let edges = r.mesh.edges().map(|e| e.halfedge()).filter(breaks);
    edges.map(|h| (r.mesh.origin(h).0, r.mesh.tip(h).0, 0)).collect()
}

fn is_northern(piece: [[f64; 3]; 3]) -> bool {
    piece.iter().map(|p| p[2]).sum::<f64>() >= 0.0
}

/// Stereographic coordinates from the farther pole of a triangle on the sphere.
fn hemisphere(piece: [[f64; 3]; 3]) -> [[f64; 2]; 3] {
    let north = is_northern(piece);
    piece
        .map(|[x, y, z]| if north { [x / (1.0 + z), y / (1.0 + z)] } else { [x / (1.0 - z), -y / (1.0 - z)] })
}
