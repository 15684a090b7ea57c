//! Triangles of a surface cut into convex pieces along lines on which a linear function of ambient coordinates is 0.

use ricci::geometry::Space;
use ricci::geometry::clip::clip_by;
use ricci::geometry::vector::norm;
use ricci::mesh::{FaceId, Mesh, Point};
use std::collections::HashMap;

/// Distance below which two points are the same, as a share of the largest coordinate.
const SAME: f64 = 1e-9;

/// A corner of a piece: ambient coordinates in the plane or on the sphere, barycentric ones in its face.
pub type PieceCorner = ([f64; 3], [f64; 3]);

/// The face with these ambient coordinates as a piece.
pub fn whole(corners: [[f64; 3]; 3]) -> Vec<PieceCorner> {
    let unit = |k: usize| [0, 1, 2].map(|j| f64::from(u8::from(j == k)));
    (0..3).map(|k| (corners[k], unit(k))).collect()
}

/// The parts of a piece where a function is negative, and where it is positive.
pub fn split(piece: &[PieceCorner], space: Space, value: impl Fn([f64; 3]) -> f64) -> [Vec<PieceCorner>; 2] {
    let between = |&(p, b): &PieceCorner, &(q, c): &PieceCorner, t: f64| {
        let point = middle(space, &[p.map(|x| (1.0 - t) * x), q.map(|x| t * x)]);
        (point, [0, 1, 2].map(|k| b[k] + t * (c[k] - b[k])))
    };
    let parts = [-1.0, 1.0].map(|sign| clip_by(piece, |corner| sign * value(corner.0), between));
    parts.map(|part| if part.len() > 2 { part } else { Vec::new() })
}

/// The point of the plane, sphere or hyperboloid whose ambient coordinates are proportional to the sum of some.
pub fn middle(space: Space, points: &[[f64; 3]]) -> [f64; 3] {
    let sum = [0, 1, 2].map(|k| points.iter().map(|p| p[k]).sum::<f64>());
    let [x, y, w] = sum;
    let length = match space {
        Space::H2 => ((w - x.hypot(y)) * (w + x.hypot(y))).sqrt(),
        Space::E2 => w,
        Space::S2 => norm(sum),
    };
    sum.map(|x| x / length)
}

/// The convex pieces of faces, as triangles.
#[derive(Default)]
pub struct ConvexPieces {
    /// Ambient coordinates of the corners of each piece.
    pub places: Vec<[f64; 3]>,
    corners: Vec<(FaceId, [f64; 3])>,
    triangles: Vec<[u32; 3]>,
    /// Edges along the cut, with a number.
    cut: Vec<(u32, u32, usize)>,
}

/// Pieces as triangles over different points, with the edges of the cut.
pub struct WeldedPieces {
    pub points: Vec<[f64; 3]>,
    pub triangles: Vec<[u32; 3]>,
    pub cut: Vec<(u32, u32, usize)>,
}

impl ConvexPieces {
    /// Add a piece of a face; `along`: the number of the line that two points lie on.
    pub fn add(
        &mut self,
        f: FaceId,
        piece: &[PieceCorner],
        along: impl Fn([f64; 3], [f64; 3]) -> Option<usize>,
    ) {
        let (first, n) = (self.places.len() as u32, piece.len() as u32);
        self.triangles.extend((2..n).map(|i| [first, first + i - 1, first + i]));
        for (i, (p, b)) in (0..).zip(piece) {
            let next = (i + 1) % n;
            let number = along(*p, piece[next as usize].0);
            self.cut.extend(number.map(|number| (first + i, first + next, number)));
            self.places.push(*p);
            self.corners.push((f, *b));
        }
    }

    /// The pieces in space.
    pub fn in_space(&self, mesh: &Mesh, positions: &[Point]) -> WeldedPieces {
        let place = |(f, b): &(FaceId, [f64; 3])| {
            let corners = mesh.face_vertices(*f).map(|v| positions[v.index()]);
            [0, 1, 2].map(|c| (0..3).map(|j| b[j] * corners[j][c]).sum())
        };
        self.welded(&self.corners.iter().map(place).collect::<Vec<_>>())
    }

    /// The pieces with a point for each of their corners, equal ones made one.
    pub fn welded(&self, points: &[[f64; 3]]) -> WeldedPieces {
        let size = points.as_flattened().iter().fold(f64::MIN_POSITIVE, |m, x| m.max(x.abs()));
        let (mut different, mut known) = (Vec::new(), HashMap::new());
        let number = points.iter().map(|p| {
            let key = p.map(|x| (x / (SAME * size)).round() as i64);
            *known.entry(key).or_insert_with(|| {
                different.push(*p);
                different.len() as u32 - 1
            })
        });
        let number: Vec<u32> = number.collect();
        let to = |i: u32| number[i as usize];
        let triangles = self.triangles.iter().map(|t| t.map(to)).collect();
        let edge = |&(a, b, k): &(u32, u32, usize)| (to(a).min(to(b)), to(a).max(to(b)), k);
        let mut cut: Vec<_> = self.cut.iter().map(edge).collect();
        cut.sort_unstable();
        cut.dedup();
        WeldedPieces { points: different, triangles, cut }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ricci::geometry::vector::{distance, triangle_normal};
    use ricci::mesh::shapes;

    #[test]
    fn a_sphere_is_cut_along_its_whole_equator() {
        let soup = shapes::icosphere(7).unwrap();
        let mesh = Mesh::from_faces(soup.positions.len(), &soup.faces).unwrap();
        let height = |p: [f64; 3]| if p[2].abs() < 1e-12 { 0.0 } else { p[2] };
        let mut pieces = ConvexPieces::default();
        for f in mesh.faces() {
            let corners = mesh.face_vertices(f).map(|v| soup.positions[v.index()]);
            for piece in split(&whole(corners), Space::S2, height).iter().filter(|p| !p.is_empty()) {
                assert!(piece.iter().all(|c| c.0[2] >= 0.0) || piece.iter().all(|c| c.0[2] <= 1e-15));
                pieces.add(f, piece, |p, q| (height(p) == 0.0 && height(q) == 0.0).then_some(0));
            }
        }
        let round = pieces.welded(&pieces.places);
        let length: f64 = round
            .cut
            .iter()
            .map(|&(a, b, _)| distance(round.points[a as usize], round.points[b as usize]))
            .sum();
        assert!((length / std::f64::consts::TAU - 1.0).abs() < 0.01, "{length}");
        // Every point of the cut joins two of its edges.
        let mut ends: Vec<u32> = round.cut.iter().flat_map(|&(a, b, _)| [a, b]).collect();
        ends.sort_unstable();
        assert!(ends.chunk_by(|a, b| a == b).all(|run| run.len() == 2), "{ends:?}");
        // In space the faces stay where they are.
        let area = |points: &[[f64; 3]], faces: &[[u32; 3]]| -> f64 {
            faces.iter().map(|f| norm(triangle_normal(f.map(|v| points[v as usize])))).sum()
        };
        let in_space = pieces.in_space(&mesh, &soup.positions);
        let whole = area(&soup.positions, &soup.faces);
        assert!((area(&in_space.points, &in_space.triangles) - whole).abs() < 1e-12 * whole);
        assert!(in_space.triangles.len() > soup.faces.len());
    }
}
