//! Boundary loops of triangle lists that may have defects.
//!
//! ```
//! use ricci::mesh::rims::rims;
//! let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
//! let loops = rims(&square, &[[0, 1, 2], [0, 2, 3]]);
//! assert_eq!((loops.len(), loops[0].vertices.as_slice(), loops[0].length), (1, [0, 1, 2, 3].as_slice(), 4.0));
//! ```

use super::Point;
use super::incidence::{Incidence, ends};
use crate::geometry::vector;

/// A boundary loop.
#[derive(Debug, Clone, PartialEq)]
pub struct Rim {
    /// Its vertices, in the direction of the faces at the boundary. A vertex in which the loop touches itself occurs several times.
    pub vertices: Vec<u32>,
    /// Its length; NaN if a vertex is not finite.
    pub length: f64,
    /// True if all faces along it run in its direction: they do not where neighbours disagree and on one-sided surfaces.
    pub is_oriented: bool,
    /// The side of the face along each edge, by the number `3 face + corner`; the first is the lowest.
    pub(super) sides: Vec<u32>,
}

impl Rim {
    /// The vertex with the lowest number, by which people name a loop.
    pub fn vertex(&self) -> u32 {
        self.vertices.iter().copied().min().unwrap_or_default()
    }
}

/// The boundary loops, in the order of their lowest sides, which is that of [`super::Mesh::boundary_loops`]. A chain of boundary edges that
/// ends in an edge of more than two faces is no loop and is left out.
pub fn rims(positions: &[Point], faces: &[[u32; 3]]) -> Vec<Rim> {
    rims_of(positions, faces, &Incidence::new(positions.len(), faces))
}

pub(super) fn rims_of(positions: &[Point], faces: &[[u32; 3]], incidence: &Incidence) -> Vec<Rim> {
    let partners = incidence.partners(faces.len());
    let mut open = vec![false; 3 * faces.len()];
    incidence.edges().filter(|sides| sides.len() == 1).for_each(|sides| open[sides[0] as usize] = true);
    let walk = RimWalk { faces, partners: &partners };
    let mut found = Vec::new();
    for first in 0..open.len() as u32 {
        if !open[first as usize] {
            continue;
        }
        let (mut rim, mut at) =
            (Rim { vertices: Vec::new(), length: 0.0, is_oriented: true, sides: Vec::new() }, first);
        let mut start = ends(faces, first)[0];
        let closed = loop {
            let [a, b] = ends(faces, at);
            let end = if a == start { b } else { a };
            open[at as usize] = false;
            rim.is_oriented &= a == start;
            rim.vertices.push(start);
            rim.sides.push(at);
            rim.length += vector::distance(positions[a as usize], positions[b as usize]);
            match walk.next(at, end) {
                Some(next) if next == first => break true,
                Some(next) if open[next as usize] => (at, start) = (next, end),
                _ => break false,
            }
        };
        if closed {
            found.push(rim);
        }
    }
    found
}

/// The walk around the ends of boundary sides.
struct RimWalk<'a> {
    faces: &'a [[u32; 3]],
    partners: &'a [u32],
}

impl RimWalk<'_> {
    /// The side without a partner that follows `side` at its end `v`, found by turning around v through the faces.
    fn next(&self, side: u32, v: u32) -> Option<u32> {
        let mut at = side;
        // A vertex has at most as many faces as there are.
        for _ in 0..self.faces.len() {
            let first = 3 * (at / 3);
            let other = (first..first + 3).find(|&s| s != at && ends(self.faces, s).contains(&v))?;
            match self.partners.get(other as usize) {
                Some(&partner) if partner != super::incidence::NONE => at = partner,
                _ => return Some(other),
            }
        }
        None
    }
}
