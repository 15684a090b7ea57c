//! The numbering of the sides and corners of the triangles of a spline, shared ones once.

use crate::error::{Error, Result};
use crate::mesh::union_find::UnionFind;
use crate::spline::triangular::Spline;
use std::collections::HashMap;

/// A side of a triangle, by its number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct NetSide {
    /// The number of the side, which a neighbour has too.
    pub edge: u32,
    /// True if it runs against the direction that it has in its first triangle.
    pub reversed: bool,
}

/// Triangles with numbered corners and sides.
#[derive(Debug, Clone)]
pub(super) struct TriangleNet {
    /// For each triangle the vertices at its corners.
    pub vertices: Vec<[u32; 3]>,
    /// For each triangle its sides; side k is from corner k to the next.
    pub sides: Vec<[NetSide; 3]>,
    /// For each side the first triangle that has it, and the number of the side in that triangle.
    pub owners: Vec<(u32, usize)>,
    /// For each vertex the first triangle that has it, and the number of the corner in that triangle.
    pub corners: Vec<(u32, usize)>,
}

impl TriangleNet {
    /// The net of a spline. Two triangles share a side if its control points are the same in opposite directions.
    ///
    /// # Errors
    /// [`Error::Spline`] for a side of three triangles, or one that two triangles have in the same direction.
    pub fn new(spline: &Spline) -> Result<TriangleNet> {
        let triangles = spline.triangles();
        let mut net =
            TriangleNet { vertices: Vec::new(), sides: Vec::new(), owners: Vec::new(), corners: Vec::new() };
        let mut known: HashMap<Vec<u32>, (u32, bool)> = HashMap::new();
        let mut sets = UnionFind::new(3 * triangles.len());
        let corner = |triangle: usize, k: usize| (3 * triangle + k % 3) as u32;
        for (at, triangle) in triangles.iter().enumerate() {
            let mut sides = [NetSide { edge: 0, reversed: false }; 3];
            for (k, side) in sides.iter_mut().enumerate() {
                let along = triangle.along(k, spline);
                let against: Vec<u32> = along.iter().rev().copied().collect();
                if let Some((edge, is_shared)) = known.get_mut(&against) {
                    let (other, j) = net.owners[*edge as usize];
                    if *is_shared {
                        return Err(refuse(at, k, "two other patches have it too"));
                    }
                    *is_shared = true;
                    *side = NetSide { edge: *edge, reversed: true };
                    sets.join(corner(at, k), corner(other as usize, j + 1));
                    sets.join(corner(at, k + 1), corner(other as usize, j));
                } else {
                    side.edge = net.owners.len() as u32;
                    if known.insert(along, (side.edge, false)).is_some() {
                        return Err(refuse(at, k, "another patch has it in the same direction"));
                    }
                    net.owners.push((at as u32, k));
                }
            }
            net.sides.push(sides);
        }
        let mut numbers: HashMap<u32, u32> = HashMap::new();
        for at in 0..triangles.len() {
            let vertices = [0, 1, 2].map(|k| {
                *numbers.entry(sets.root(corner(at, k))).or_insert_with(|| {
                    net.corners.push((at as u32, k));
                    net.corners.len() as u32 - 1
                })
            });
            net.vertices.push(vertices);
        }
        Ok(net)
    }
}

fn refuse(patch: usize, k: usize, why: &str) -> Error {
    let message = format!(
        "{why}: the side from corner {k} to the next; patches join two at a side, with control points of its own"
    );
    Error::Spline { what: "side of patch", index: patch, message }
}
