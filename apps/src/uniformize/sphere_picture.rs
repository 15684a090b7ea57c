//! The picture of a sphere: the surface beside it, with one pattern.

use super::pieces::{ConvexPieces, WeldedPieces, split, whole};
use super::sphere::SphereSurface;
use crate::failure::Failure;
use crate::input::Input;
use crate::picture::{self, Picture, ShownSurface, Style, Tiles};
use ricci::geometry::Space;
use ricci::geometry::vector::{norm, triangle_normal};

/// A vertex lies on the equator if its height over it is less than this.
const LEVEL: f64 = 1e-12;

/// The picture as PNG; `beside`: the sphere too.
pub fn draw(input: &Input, s: &SphereSurface, style: &Style, beside: bool) -> Result<Vec<u8>, Failure> {
    let r = s.common_subdivision()?;
    let positions = input.positions().map(|p| r.from_vertices(0, p)).transpose()?;
    // Cut along the equator, where the pattern breaks.
    let height = |p: [f64; 3]| if p[2].abs() < LEVEL { 0.0 } else { p[2] };
    let mut pieces = ConvexPieces::default();
    for f in r.mesh.faces() {
        for piece in split(&whole(s.piece(r, f)), Space::S2, height).iter().filter(|p| !p.is_empty()) {
            pieces.add(f, piece, |p, q| (height(p) == 0.0 && height(q) == 0.0).then_some(0));
        }
    }
    let round = pieces.welded(&pieces.places);
    let in_space = positions.map(|positions| pieces.in_space(&r.mesh, &positions));
    let corners = round.triangles.iter().map(|t| t.map(|i| round.points[i as usize]));
    let (uv, scale): (Vec<_>, Vec<_>) =
        corners.map(|piece| (hemisphere(piece), 0.5 * norm(triangle_normal(piece)))).unzip();
    // On either hemisphere the pattern's scale is between 1/2 and 1 of the sphere's.
    let flat: Vec<f64> = uv.iter().map(|uv| 0.5 * picture::doubled_area(*uv).abs()).collect();
    let tiles = Tiles::new(&scale, &flat, &round.triangles, round.points.len()).banded(style.bands);
    let surface = |w| on_pieces(w, &uv);
    let drawn = Picture {
        surface: in_space.as_ref().map(surface),
        beside: beside.then(|| surface(&round)),
        pattern: Some(&tiles),
        ..Picture::default()
    };
    picture::png(&drawn, style)
}

fn on_pieces<'a>(pieces: &'a WeldedPieces, uv: &'a [[[f64; 2]; 3]]) -> ShownSurface<'a> {
    let WeldedPieces { points: positions, triangles: faces, cut: seams } = pieces;
    ShownSurface { positions, faces, corner_uv: Some(uv), seams, cones: &[], is_closed: true }
}

/// Stereographic coordinates from the farther pole of a triangle on one hemisphere.
fn hemisphere(piece: [[f64; 3]; 3]) -> [[f64; 2]; 3] {
    let north = piece.iter().map(|p| p[2]).sum::<f64>() >= 0.0;
    piece
        .map(|[x, y, z]| if north { [x / (1.0 + z), y / (1.0 + z)] } else { [x / (1.0 - z), -y / (1.0 - z)] })
}
