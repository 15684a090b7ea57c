//! Opens folds by moving single vertices, each to the point that lies farthest inside the lines of the edges around it \[FP00\].

use super::springs::VertexFreedom;
use crate::control::{Control, Stage};
use crate::error::Result;
use crate::geometry::Space;
use crate::geometry::complex::{Complex, cross, dot, norm, sub};
use crate::matching::cover::{PlacedMesh, moved, seen_from};
use crate::mesh::{FaceId, PerVertex, VertexId};

/// Most rounds over the vertices of folded faces.
const MOST_SWEEPS: usize = 200;
/// Vertices with more neighbours stay where they are: the work grows with the fourth power of their number.
const MOST_SIDES: usize = 48;
/// Share of the size of the polygon around a vertex by which a constraint may be missed: rounding.
const SLACK: f64 = 1e-12;

/// Moves the free vertices of folded faces, one after the other, as long as faces fold. Returns the faces that remain folded.
///
/// # Errors
/// [`crate::Error::Cancelled`].
pub(crate) fn untangle(
    placed: &mut PlacedMesh,
    freedom: &PerVertex<VertexFreedom>,
    control: &Control,
) -> Result<Vec<FaceId>> {
    let mesh = placed.cover.mesh.clone();
    let mut folded = placed.flipped();
    for sweep in 0..MOST_SWEEPS {
        control.step(Stage::Layout, sweep as f64 / MOST_SWEEPS as f64)?;
        if folded.is_empty() {
            break;
        }
        let mut vertices: Vec<VertexId> = folded.iter().flat_map(|&f| mesh.face_vertices(f)).collect();
        vertices.sort_unstable();
        vertices.dedup();
        for v in vertices.into_iter().filter(|&v| freedom[v] == VertexFreedom::Free) {
            if let Some(to) = innermost(&star(placed, v)) {
                placed.at[v] = moved(&placed.at[v], logarithm_of(placed.cover.space, to)).normalised();
            }
        }
        folded = placed.flipped();
    }
    Ok(folded)
}

/// The vertices around a vertex, in order, in coordinates with this vertex at the origin in which geodesics are straight.
fn star(placed: &PlacedMesh, v: VertexId) -> Vec<Complex> {
    let at = |h| {
        let tip = placed.at[placed.cover.mesh.tip(h)];
        let tip = placed.cover.along(h).map_or(tip, |along| along.compose(&tip));
        let [x, y, w] = seen_from(&placed.at[v], &tip).map(f64::from);
        [x / w, y / w]
    };
    placed.cover.mesh.fan(v).into_iter().map(at).collect()
}

/// The point that lies farthest on the left of all sides of a polygon; `None` if a side has no length or there are too many sides.
fn innermost(star: &[Complex]) -> Option<Complex> {
    let n = star.len();
    if n > MOST_SIDES {
        return None;
    }
    // Unit normals that point to the left, and offsets.
    let mut lines = Vec::with_capacity(n);
    for k in 0..n {
        let [x, y] = sub(star[(k + 1) % n], star[k]);
        let size = x.hypot(y);
        if size == 0.0 {
            return None;
        }
        let normal = [-y / size, x / size];
        lines.push((normal, dot(normal, star[k])));
    }
    let size = star.iter().map(|&p| norm(p)).fold(0.0, f64::max);
    let depth = |p: Complex| lines.iter().map(|(n, c)| dot(*n, p) - c).fold(f64::INFINITY, f64::min);
    let mut best: Option<(f64, Complex)> = None;
    // At the point of largest depth three sides are equally far.
    for i in 0..n {
        for j in i + 1..n {
            for k in j + 1..n {
                let ([a, b, c], [p, q, r]) =
                    ([lines[i].0, lines[j].0, lines[k].0], [lines[i].1, lines[j].1, lines[k].1]);
                let (u, v) = (sub(a, b), sub(a, c));
                let det = cross(u, v);
                if det.abs() < SLACK {
                    continue;
                }
                let at = [((p - q) * v[1] - (p - r) * u[1]) / det, ((p - r) * u[0] - (p - q) * v[0]) / det];
                let deep = dot(a, at) - p;
                if depth(at) >= deep - SLACK * size && best.is_none_or(|(most, _)| deep > most) {
                    best = Some((deep, at));
                }
            }
        }
    }
    best.map(|(_, at)| at).filter(|&p| norm(p) <= size)
}

/// The vector of the geodesic from the origin to a point in coordinates in which geodesics are straight.
fn logarithm_of(space: Space, p: Complex) -> Complex {
    let r = norm(p);
    let length = match space {
        Space::E2 => r,
        Space::H2 => r.min(1.0 - f64::EPSILON).atanh(),
        Space::S2 => r.atan(),
    };
    if r > 0.0 { p.map(|x| x * (length / r)) } else { p }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_innermost_point_of_a_triangle_is_the_centre_of_its_circle_and_of_a_dented_square_in_its_kernel() {
        let triangle = [[0.0, 0.0], [3.0, 0.0], [0.0, 4.0]];
        let p = innermost(&triangle).unwrap();
        assert!((p[0] - 1.0).abs() < 1e-14 && (p[1] - 1.0).abs() < 1e-14, "{p:?}");
        let dented = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [0.0, 0.5], [-1.0, 1.0]];
        let p = innermost(&dented).unwrap();
        assert!(p[0].abs() < 1e-14 && p[1] < 0.0 && p[1] > -1.0, "{p:?}");
    }
}
