//! The patches of a layout as grids of points, from which fits start.

use super::fit::bilinear;
use super::layout::{ArcSide, PatchArc, PatchLayout};
use crate::error::{Error, Result};
use crate::geometry::vector::{Vector, cross, distance, dot, norm, sub};
use crate::mesh::union_find::UnionFind;
use crate::quads::{LayoutArc, LayoutPatch, QuadLayout};
use std::collections::BTreeMap;

/// Quads in space that lines divide into patches.
pub(super) struct DividedQuads<'a> {
    pub quads: &'a [[u32; 4]],
    /// The positions of their vertices.
    pub points: &'a [Vector],
    /// The number of edges in one unit of length.
    pub parts: u32,
    pub n_nodes: usize,
    pub arcs: &'a [LayoutArc],
    pub patches: &'a [LayoutPatch],
    /// Per arc its length, to which that in parameters is about proportional.
    pub lengths: Vec<f64>,
}

/// The points of the quad mesh in a patch: `points[i * (n + 1) + j]`, i along the first side, j along the second, m × n quads.
pub(super) struct PatchGrid {
    size: [usize; 2],
    points: Vec<Vector>,
}

impl<'a> DividedQuads<'a> {
    /// The quads of a layout, with their vertices at these points, and arcs as long as in space.
    pub fn of_layout(layout: &'a QuadLayout, points: &'a [Vector]) -> DividedQuads<'a> {
        let QuadLayout { mesh, parts, nodes, arcs, patches } = layout;
        let step = |pair: &[u32]| distance(points[pair[0] as usize], points[pair[1] as usize]);
        let lengths = arcs.iter().map(|arc| arc.vertices.windows(2).map(step).sum()).collect();
        DividedQuads {
            quads: &mesh.quads,
            points,
            parts: *parts,
            n_nodes: nodes.len(),
            arcs,
            patches,
            lengths,
        }
    }

    /// The grids of the patches.
    ///
    /// # Errors
    /// [`Error::Layout`] for a patch that is no rectangle of quads.
    pub fn grids(&self) -> Result<Vec<PatchGrid>> {
        let mut beyond: BTreeMap<[u32; 2], [u32; 2]> = BTreeMap::new();
        for quad in self.quads {
            for k in 0..4 {
                // Beyond an edge of a quad lies the one opposite to it.
                let [a, b, c, d] = [0, 1, 2, 3].map(|i| quad[(k + i) % 4]);
                beyond.insert([a, b], [d, c]);
            }
        }
        (0..self.patches.len()).map(|p| PatchGrid::new(self, p, &beyond)).collect()
    }

    /// The layout with every side of every patch as one arc. Lengths, equal on opposite sides, are the means of those of
    /// [`DividedQuads::lengths`], in units of their mean.
    ///
    /// # Errors
    /// [`Error::Layout`] for a side that is more than one arc; those of [`PatchLayout::new`].
    pub fn patch_layout(&self) -> Result<PatchLayout> {
        let side = |p: usize, side: &Vec<i32>| match side[..] {
            [signed] => Ok(ArcSide { arc: signed.unsigned_abs() - 1, reversed: signed < 0 }),
            _ => Err(Error::Layout(format!(
                "a side of patch {p} is {} arcs: divide it at its nodes",
                side.len()
            ))),
        };
        let mut patches = Vec::with_capacity(self.patches.len());
        for (p, LayoutPatch { sides: [a, b, c, d], .. }) in self.patches.iter().enumerate() {
            patches.push([side(p, a)?, side(p, b)?, side(p, c)?, side(p, d)?]);
        }
        let strips = strips(self.arcs.len(), &patches);
        let lengths = &self.lengths;
        let mut of_strip = vec![(0.0, 0.0); lengths.len()];
        for (k, length) in lengths.iter().enumerate() {
            let (sum, count) = &mut of_strip[strips[k]];
            (*sum, *count) = (*sum + length, *count + 1.0);
        }
        let unit = lengths.iter().sum::<f64>() / lengths.len().max(1) as f64;
        let mut arcs = Vec::with_capacity(lengths.len());
        for (k, LayoutArc { ends, is_crease, .. }) in self.arcs.iter().enumerate() {
            let (sum, count) = of_strip[strips[k]];
            arcs.push(PatchArc { ends: *ends, length: sum / count / unit, is_crease: *is_crease });
        }
        PatchLayout::new(self.n_nodes, arcs, patches)
    }
}

impl PatchGrid {
    /// The grid of a patch: the vertices along its first side, then row after row beyond.
    fn new(divided: &DividedQuads<'_>, p: usize, beyond: &BTreeMap<[u32; 2], [u32; 2]>) -> Result<PatchGrid> {
        let LayoutPatch { sides, size, .. } = &divided.patches[p];
        let [m, n] = size.map(|x| (x * divided.parts) as usize);
        let mut row: Vec<u32> = Vec::with_capacity(m + 1);
        for &signed in &sides[0] {
            let mut along = divided.arcs[signed.unsigned_abs() as usize - 1].vertices.clone();
            if signed < 0 {
                along.reverse();
            }
            row.extend(&along[usize::from(!row.is_empty())..]);
        }
        let no_grid = || Error::Layout(format!("patch {p} is no rectangle of quads"));
        let mut rows = vec![row];
        for j in 0..n {
            let pairs = rows[j].windows(2).map(|pair| beyond.get(&[pair[0], pair[1]]).copied());
            let next: Vec<[u32; 2]> = pairs.collect::<Option<_>>().ok_or_else(no_grid)?;
            let last = next.last().map(|pair| pair[1]);
            rows.push(next.iter().map(|pair| pair[0]).chain(last).collect());
        }
        if rows.iter().any(|row| row.len() != m + 1) {
            return Err(no_grid());
        }
        let at = |k: usize| divided.points[rows[k % (n + 1)][k / (n + 1)] as usize];
        Ok(PatchGrid { size: [m, n], points: (0..(m + 1) * (n + 1)).map(at).collect() })
    }

    /// The angles at the corners, radians.
    pub fn corner_angles(&self) -> [f64; 4] {
        let [m, n] = self.size;
        let point = |i: usize, j: usize| self.points[i * (n + 1) + j];
        let angle = |at: Vector, a: Vector, b: Vector| {
            let [u, v] = [sub(a, at), sub(b, at)];
            norm(cross(u, v)).atan2(dot(u, v))
        };
        [
            angle(point(0, 0), point(1, 0), point(0, 1)),
            angle(point(m, 0), point(m - 1, 0), point(m, 1)),
            angle(point(m, n), point(m - 1, n), point(m, n - 1)),
            angle(point(0, n), point(1, n), point(0, n - 1)),
        ]
    }

    /// The point at a place of the patch, bilinear in every quad.
    pub fn at(&self, uv: [f64; 2]) -> Vector {
        let [m, n] = self.size;
        let [(i, s), (j, t)] = [(uv[0], m), (uv[1], n)].map(|(x, count)| {
            let scaled = x * count as f64;
            let cell = (scaled as usize).min(count - 1);
            (cell, scaled - cell as f64)
        });
        let point = |i: usize, j: usize| self.points[i * (n + 1) + j];
        bilinear([point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)], [s, t])
    }
}

/// Per arc an arc of its strip, to which arcs belong that are opposite sides of patches, the same for all of them.
pub(super) fn strips(n_arcs: usize, patches: &[[ArcSide; 4]]) -> Vec<usize> {
    let mut same = UnionFind::new(n_arcs);
    for sides in patches {
        same.join(sides[0].arc, sides[2].arc);
        same.join(sides[1].arc, sides[3].arc);
    }
    (0..n_arcs as u32).map(|arc| same.root(arc) as usize).collect()
}
