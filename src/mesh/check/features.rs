//! Sharp edges and corners, which people pick as cuts, landmarks and corners of layouts.
//!
//! ```
//! use ricci::mesh::check::Features;
//! let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
//! let found = Features::new(&square, &[[0, 1, 2], [0, 2, 3]], 40f64.to_radians());
//! assert_eq!((found.edges.len(), found.corners), (0, vec![0, 1, 2, 3]));
//! ```

use crate::geometry::vector;
use crate::mesh::Point;
use crate::mesh::incidence::{Incidence, ends, is_forward};

/// The features of a triangle list for a least angle.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Features {
    /// The edges of two faces at which the surface turns by the angle or more, in the order of their first faces.
    pub edges: Vec<SharpEdge>,
    /// The vertices at which lines of sharp edges and of the boundary end, branch, or turn by the angle or more; ascending.
    pub corners: Vec<u32>,
}

/// A sharp edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SharpEdge {
    /// Its ends, in the direction of the first of its faces.
    pub vertices: [u32; 2],
    /// The angle between the normals of its faces, radians: 0 where the surface is flat.
    pub angle: f64,
    /// Its length.
    pub length: f64,
}

impl Features {
    /// Edges and corners with an angle of at least `least` radians. Faces without area and vertices that are not finite have none.
    pub fn new(positions: &[Point], faces: &[[u32; 3]], least: f64) -> Features {
        let incidence = Incidence::new(positions.len(), faces);
        let normal = |side: u32| {
            let corners = faces[side as usize / 3].map(|v| positions[v as usize]);
            vector::normalised(vector::triangle_normal(corners))
        };
        let (mut edges, mut lines) = (Vec::new(), Vec::new());
        for sides in incidence.edges() {
            let vertices = ends(faces, sides[0]);
            match *sides {
                [_] => lines.push(vertices),
                [a, b] => {
                    let turned = if is_forward(faces, a) == is_forward(faces, b) { -1.0 } else { 1.0 };
                    let (n, m) = (normal(a), vector::scale(turned, normal(b)));
                    let angle = vector::norm(vector::cross(n, m)).atan2(vector::dot(n, m));
                    let has_normals = vector::norm(n) > 0.5 && vector::norm(m) > 0.5;
                    if has_normals && angle >= least {
                        let [p, q] = vertices.map(|v| positions[v as usize]);
                        edges.push((a, SharpEdge { vertices, angle, length: vector::distance(p, q) }));
                        lines.push(vertices);
                    }
                }
                _ => {}
            }
        }
        edges.sort_unstable_by_key(|&(side, _)| side);
        let edges = edges.into_iter().map(|(_, edge)| edge).collect();
        Features { edges, corners: corners(positions, &lines, least) }
    }
}

/// The vertices at which lines of edges end, branch or turn.
fn corners(positions: &[Point], lines: &[[u32; 2]], least: f64) -> Vec<u32> {
    let mut at: Vec<[u32; 2]> = lines.iter().flat_map(|&[a, b]| [[a, b], [b, a]]).collect();
    at.sort_unstable();
    let is_corner = |star: &&[[u32; 2]]| {
        let [[v, a], [_, b]] = **star else { return true };
        let from = |w: u32| vector::sub(positions[w as usize], positions[v as usize]);
        let (into, out) = (vector::scale(-1.0, from(a)), from(b));
        vector::norm(vector::cross(into, out)).atan2(vector::dot(into, out)) >= least
    };
    at.chunk_by(|a, b| a[0] == b[0]).filter(is_corner).map(|star| star[0][0]).collect()
}
