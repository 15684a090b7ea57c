//! Hyperbolic pairs of pants with prescribed boundary lengths.

use super::intrinsic::IntrinsicSurface;
use crate::error::{Error, Result};
use crate::geometry::Space;
use std::ops::RangeInclusive;

/// Range of the boundary lengths. The seams next to a boundary of length l are about log(4/l) long, 15 for the shortest; half of the
/// longest is far below the sides at which subdivision ends.
const BOUNDARY_LENGTHS: RangeInclusive<f64> = 1e-6..=200.0;

/// The hyperbolic pair of pants whose three boundary loops are geodesics of these `lengths` l₁, l₂, l₃: a sphere with
/// three holes, unique up to isometry [Bus92, Theorem 3.1.7]. Curvature is 0 at every vertex, the boundary's included;
/// the area is 2π.
///
/// ```text
///      5____l₁/2____0         Two copies of the right-angled hexagon with alternate sides l₁/2, l₂/2, l₃/2, glued
///  s₃₁ /            \ s₁₂     along the three seams between them: cosh s₁₂ = (cosh l₁/2 cosh l₂/2 + cosh l₃/2) /
///    4 \            / 1       (sinh l₁/2 sinh l₂/2) and so on [Bus92, Theorem 2.4.1].
///   l₃/2\__________/l₂/2
///       3   s₂₃    2
/// ```
///
/// The triangle of its corners 0, 2, 4 and the three right-angled triangles beside it make a hexagon; each triangle is subdivided `level`
/// times ([`IntrinsicSurface::subdivide`]): 8 · 4^level faces. Vertices 0 … 5 are the corners: boundary 1 passes through 5 and 0,
/// boundary 2 through 1 and 2, boundary 3 through 3 and 4.
///
/// # Errors
///
/// [`Error::Argument`] for a length outside 1e-6 … 200, or too many levels; [`Error::TriangleInequality`] where subdivided triangles next
/// to a very long or short boundary are too thin for f64.
pub fn pants(lengths: [f64; 3], level: usize) -> Result<IntrinsicSurface> {
    if let Some(l) = lengths.iter().find(|l| !BOUNDARY_LENGTHS.contains(*l)) {
        return Err(Error::argument("boundary length", l, "between 1e-6 and 200"));
    }
    let half = lengths.map(|l| 0.5 * l);
    // The seam between the boundaries k and k + 1, by 2 sinh²(s/2) = cosh s − 1.
    let seam = |k: usize| {
        let (a, b, c) = (half[k], half[(k + 1) % 3], half[(k + 2) % 3]);
        let square = ((a - b).cosh() + c.cosh()) / (2.0 * a.sinh() * b.sinh());
        2.0 * square.sqrt().asinh()
    };
    // Side i runs from corner i to corner i + 1: seam 12, boundary 2, seam 23, boundary 3, seam 31, boundary 1.
    let sides = [seam(0), half[1], seam(1), half[2], seam(2), half[0]];
    // Diagonal k runs from corner 2k to corner 2k + 2, opposite the right angle at corner 2k + 1.
    let diagonals = [0, 1, 2].map(|k| hypotenuse(sides[2 * k], sides[2 * k + 1]));
    let mut surface = IntrinsicSurface {
        n_vertices: 6,
        faces: Vec::with_capacity(8),
        face_edges: Vec::with_capacity(8),
        // Edges 1 … 6: the front's sides, seams included; 7 … 9: its diagonals; 10 … 12: the back's halves of the boundaries 2, 3, 1; 13
        // … 15: its diagonals.
        lengths: [&sides[..], &diagonals, &[half[1], half[2], half[0]], &diagonals].concat(),
        geometry: Space::H2,
    };
    for k in 0..3 {
        let (i, d) = (2 * k as u32, 7 + k);
        let (seam, front, back) = (2 * k + 1, 2 * k + 2, 10 + k);
        surface.faces.extend([[i, i + 1, (i + 2) % 6], [(i + 2) % 6, i + 1, i]]);
        surface.face_edges.extend([[front, -d, seam], [-seam, d + 6, -back]]);
    }
    surface.faces.extend([[0, 2, 4], [4, 2, 0]]);
    surface.face_edges.extend([[8, 9, 7], [-13, -15, -14]]);
    let surface = surface.subdivided(level)?;
    surface.check_triangles()?;
    Ok(surface)
}

/// The side opposite the right angle between a and b: `cosh c = cosh a cosh b`, in the form
/// `sinh²(c/2) = sinh²(a/2) cosh b + sinh²(b/2)`.
fn hypotenuse(a: f64, b: f64) -> f64 {
    let square = (0.5 * a).sinh().powi(2) * b.cosh() + (0.5 * b).sinh().powi(2);
    2.0 * square.sqrt().asinh()
}
