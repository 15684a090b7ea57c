//! Figures of quad meshes: topology, recounted from the quads alone, and the shape of the quads in space.

use super::quad_mesh::QuadMesh;
use crate::flow::Solution;
use crate::geometry::triangle_tree::TriangleTree;
use crate::geometry::vector::{cross, dot, lerp, norm, sub};
use crate::mesh::Point;
use crate::parallel;
use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_2;

/// The topology of a quad mesh, from its quads alone.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct QuadTopology {
    /// V − E + F.
    pub euler: i64,
    /// Edges with more than one quad on a side, and quads that use a vertex twice.
    pub bad_edges: usize,
    /// Vertices whose quads form more than one fan.
    pub bad_vertices: usize,
    /// Vertices inside that have not four quads, and on the boundary that have not two.
    pub irregular: Vec<u32>,
}

/// The shape of quads in space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct QuadShape {
    /// The mean deviation of the corners' angles from 90°, radians.
    pub angle_mean: f64,
    /// The largest deviation of a corner's angle from 90°, radians.
    pub angle_max: f64,
    /// The mean length of the edges.
    pub edge_mean: f64,
    /// The standard deviation of the lengths of the edges over their mean.
    pub edge_deviation: f64,
}

/// How far a quad mesh and the surface are apart in space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct QuadDistance {
    /// The largest distance of a vertex of the surface from the quads, each as two triangles, or of the middle of a quad or of a side from the
    /// surface: the Hausdorff distance but for what lies between these places.
    pub max: f64,
    /// The root of the mean square of the distances of the vertices of the surface.
    pub rms: f64,
}

impl QuadMesh {
    /// The distance from the surface on which the quads lie, in its units; none for a surface without positions.
    pub fn distance(&self, solution: &Solution) -> Option<QuadDistance> {
        let (mesh, on_surface) = (solution.given(), solution.surface().positions()?);
        let positions = self.positions(solution)?;
        let at = |v: u32| positions[v as usize];
        let halves = self.quads.iter().flat_map(|&quad| QuadMesh::halves(quad).map(|t| t.map(at)));
        let quads = TriangleTree::new(halves.collect());
        let faces = mesh.faces().map(|f| mesh.face_vertices(f).map(|v| on_surface[v.index()]));
        let surface = TriangleTree::new(faces.collect());
        let of_vertices = parallel::map(on_surface.len(), |v| quads.nearest(on_surface[v]).distance);
        let mean = |a: Point, b: Point| lerp(a, b, 0.5);
        let of_quad = |k: usize| {
            let [a, b, c, d] = self.quads[k].map(at);
            let middles = [mean(a, b), mean(b, c), mean(c, d), mean(d, a), mean(mean(a, b), mean(c, d))];
            middles.into_iter().fold(0.0, |most: f64, p| most.max(surface.nearest(p).distance))
        };
        let of_quads = parallel::map(self.quads.len(), of_quad);
        let squares: f64 = of_vertices.iter().map(|x| x * x).sum();
        Some(QuadDistance {
            max: of_vertices.iter().chain(&of_quads).fold(0.0, |most, &x| most.max(x)),
            rms: (squares / of_vertices.len().max(1) as f64).sqrt(),
        })
    }

    /// The topology, from the quads alone.
    pub fn topology(&self) -> QuadTopology {
        let mut quad_beside: BTreeMap<[u32; 2], usize> = BTreeMap::new();
        let mut bad_edges = 0;
        for (k, quad) in self.quads.iter().enumerate() {
            for i in 0..4 {
                let side = [quad[i], quad[(i + 1) % 4]];
                let is_repeated = side[0] == side[1] || side[0] == quad[(i + 2) % 4];
                if quad_beside.insert(side, k).is_some() || is_repeated {
                    bad_edges += 1;
                }
            }
        }
        let n = self.places.len();
        let (mut valence, mut borders, mut n_edges) = (vec![0u32; n], vec![0u32; n], 0);
        self.quads.iter().flatten().for_each(|&v| valence[v as usize] += 1);
        for &[a, b] in quad_beside.keys() {
            let is_border = !quad_beside.contains_key(&[b, a]);
            n_edges += usize::from(is_border || a < b);
            if is_border {
                borders[a as usize] += 1;
                borders[b as usize] += 1;
            }
        }
        let irregular = |&v: &u32| {
            let k = v as usize;
            valence[k] != if borders[k] > 0 { 2 } else { 4 }
        };
        QuadTopology {
            euler: n as i64 - n_edges as i64 + self.quads.len() as i64,
            bad_edges,
            bad_vertices: self.vertices_of_several_fans(&quad_beside, &valence),
            irregular: (0..n as u32).filter(irregular).collect(),
        }
    }

    /// The number of vertices around which not all quads follow one another.
    fn vertices_of_several_fans(&self, beside: &BTreeMap<[u32; 2], usize>, valence: &[u32]) -> usize {
        let mut start: Vec<Option<usize>> = vec![None; valence.len()];
        for (k, quad) in self.quads.iter().enumerate() {
            for (i, &v) in quad.iter().enumerate() {
                // A fan on the boundary starts at the quad that has none clockwise of it.
                let is_first = !beside.contains_key(&[quad[(i + 1) % 4], v]);
                let known = &mut start[v as usize];
                if is_first || known.is_none() {
                    *known = Some(k);
                }
            }
        }
        let fan = |v: usize| {
            let Some(first) = start[v] else { return 0 };
            let (mut quad, mut n) = (first, 0);
            loop {
                n += 1;
                let corners = &self.quads[quad];
                let Some(i) = corners.iter().position(|&c| c as usize == v) else { return n };
                let before = corners[(i + 3) % 4];
                match beside.get(&[v as u32, before]) {
                    Some(&next) if next != first && n <= valence[v] => quad = next,
                    _ => return n,
                }
            }
        };
        (0..valence.len()).filter(|&v| fan(v) != valence[v]).count()
    }

    /// The shape of the quads with these positions of the vertices.
    pub fn shape(&self, positions: &[Point]) -> QuadShape {
        let (mut sum, mut most) = (0.0, 0.0f64);
        let mut lengths = Vec::new();
        for quad in &self.quads {
            let p = quad.map(|v| positions[v as usize]);
            for i in 0..4 {
                let [a, b] = [sub(p[(i + 1) % 4], p[i]), sub(p[(i + 3) % 4], p[i])];
                let off = (norm(cross(a, b)).atan2(dot(a, b)) - FRAC_PI_2).abs();
                sum += off;
                most = most.max(off);
                if quad[i] < quad[(i + 1) % 4] {
                    lengths.push(norm(a));
                }
            }
        }
        let count = lengths.len().max(1) as f64;
        let edge_mean = lengths.iter().sum::<f64>() / count;
        let variance = lengths.iter().map(|l| (l - edge_mean).powi(2)).sum::<f64>() / count;
        QuadShape {
            angle_mean: sum / (4 * self.quads.len()).max(1) as f64,
            angle_max: most,
            edge_mean,
            edge_deviation: if edge_mean > 0.0 { variance.sqrt() / edge_mean } else { 0.0 },
        }
    }
}
