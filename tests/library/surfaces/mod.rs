//! Surfaces that the topology and layout tests share.
#![allow(dead_code)]

use ricci::geometry::Space;
use ricci::mesh::io::Soup;
use ricci::mesh::{Mesh, PerEdge, VertexId, io, shapes};
use ricci::metric::curvature as curvature_of;
use std::path::{Path, PathBuf};

use crate::common;

/// The good meshes of the corpus (none, said on stderr, where it is absent).
pub fn corpus() -> Vec<PathBuf> {
    let rows = common::index("good").map(|(folder, rows)| {
        let mut paths: Vec<_> = rows.iter().map(|row| folder.join(&row["file"])).collect();
        paths.sort();
        paths
    });
    rows.unwrap_or_default()
}

/// Gauss–Bonnet holds, as it must for every metric.
pub fn gauss_bonnet(mesh: &Mesh, space: Space, lengths: &PerEdge<f64>) {
    let residual = curvature_of(mesh, space, lengths).unwrap().gauss_bonnet;
    assert!(residual <= 1e-10, "Gauss–Bonnet residual {residual}");
}

/// A mesh file with its Euclidean edge lengths.
pub fn load(path: &Path) -> (Mesh, PerEdge<f64>) {
    let soup = io::read(path).unwrap();
    let mesh = Mesh::from_faces(soup.positions.len(), &soup.faces).unwrap();
    let lengths = PerEdge::from_fn(mesh.n_edges(), |e| {
        let [p, q] = mesh.ends(e).map(|v| soup.positions[v.index()]);
        (0..3).map(|k| (p[k] - q[k]).powi(2)).sum::<f64>().sqrt()
    });
    gauss_bonnet(&mesh, Space::E2, &lengths);
    (mesh, lengths)
}

/// Edge lengths of a mesh in the plane.
pub fn plane_lengths(mesh: &Mesh, positions: &[[f64; 2]]) -> PerEdge<f64> {
    PerEdge::from_fn(mesh.n_edges(), |e| {
        let [p, q] = mesh.ends(e).map(|v| positions[v.index()]);
        (p[0] - q[0]).hypot(p[1] - q[1])
    })
}

/// The flat torus ℂ/(ℤ + τℤ) as an n × m grid of parallelograms, each halved; legal down to 1 × 1. Face 2(i +
/// n j) is (z, z + 1/n, z + 1/n + τ/m).
pub fn flat_torus(n: usize, m: usize, tau: [f64; 2]) -> (Mesh, PerEdge<f64>) {
    shapes::flat_torus(tau, n, m).unwrap().build().unwrap()
}

/// The regular Euclidean octagon of side 1 with its sides glued by a b a⁻¹ b⁻¹ c d c⁻¹ d⁻¹: genus 2, one
/// vertex, whose cone angle is 6π.
pub fn octagon() -> (Mesh, PerEdge<f64>) {
    let sides = [1, 2, -1, -2, 3, 4, -3, -4];
    // Edges 5…9 are the diagonals from corner 0 to corners 2…6.
    let spoke = |i: usize| match i {
        1 => sides[0],
        7 => -sides[7],
        _ => i as i32 + 3,
    };
    let face_edges: Vec<_> = (1..7).map(|i| [sides[i], -spoke(i + 1), spoke(i)]).collect();
    let mesh = Mesh::from_gluing(1, &[[0; 3]; 6], &face_edges).unwrap();
    let eighth = std::f64::consts::PI / 8.0;
    let lengths = PerEdge::from_fn(9, |e: ricci::mesh::EdgeId| match e.index() {
        0..4 => 1.0,
        e => ((e - 2) as f64 * eighth).sin() / eighth.sin(),
    });
    (mesh, lengths)
}

/// The unit cube, each face halved.
pub fn cube() -> (Mesh, PerEdge<f64>) {
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let faces: Vec<[u32; 3]> = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    let mesh = Mesh::from_faces(8, &faces).unwrap();
    let lengths = PerEdge::from_fn(mesh.n_edges(), |e| {
        let [a, b] = mesh.ends(e).map(|v| v.0);
        f64::from((a ^ b).count_ones()).sqrt()
    });
    (mesh, lengths)
}

/// The regular tetrahedron of side 1.
pub fn tetrahedron() -> (Mesh, PerEdge<f64>) {
    let mesh = Mesh::from_faces(4, &[[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]).unwrap();
    (mesh, PerEdge::filled(6, 1.0))
}

/// A jittered n × n grid of the unit square with diagonals of either kind, without the cells of `holes`.
pub fn square(n: usize, holes: &[(usize, usize)], random: &mut Random) -> (Mesh, Vec<[f64; 2]>) {
    let step = 1.0 / n as f64;
    let mut positions = Vec::new();
    for j in 0..=n {
        for i in 0..=n {
            let mut jitter = || 0.3 * step * (random.real() - 0.5);
            positions.push([i as f64 * step + jitter(), j as f64 * step + jitter()]);
        }
    }
    let vertex = |i: usize, j: usize| (i + (n + 1) * j) as u32;
    let mut faces = Vec::new();
    for j in 0..n {
        for i in (0..n).filter(|&i| !holes.contains(&(i, j))) {
            let [a, b, c, d] = [vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)];
            if random.below(2) == 0 {
                faces.extend([[a, b, c], [a, c, d]]);
            } else {
                faces.extend([[b, c, d], [b, d, a]]);
            }
        }
    }
    (Mesh::from_faces(positions.len(), &faces).unwrap(), positions)
}

/// Rings of `m` vertices with radii 1, q, …, q^(n−1) around the apex (removed) of a cone of angle `angle`.
pub fn cone(n: usize, m: usize, q: f64, angle: f64) -> (Mesh, PerEdge<f64>) {
    let vertex = |j: usize, i: usize| (j * m + i % m) as u32;
    let mut faces = Vec::new();
    for j in 0..n - 1 {
        for i in 0..m {
            let [a, b] = [vertex(j, i), vertex(j, i + 1)];
            let [c, d] = [vertex(j + 1, i), vertex(j + 1, i + 1)];
            faces.extend([[a, b, d], [a, d, c]]);
        }
    }
    let mesh = Mesh::from_faces(n * m, &faces).unwrap();
    let half = (angle / (2 * m) as f64).sin();
    let lengths = PerEdge::from_fn(mesh.n_edges(), |e| {
        let [a, b] = mesh.ends(e).map(|v| (v.index() / m, v.index() % m));
        let [r, s] = [a, b].map(|(j, _)| q.powi(j as i32));
        let turn = if a.1 == b.1 { 0.0 } else { half };
        ((r - s).powi(2) + 4.0 * r * s * turn * turn).sqrt()
    });
    (mesh, lengths)
}

/// A small linear congruential generator (Knuth's MMIX constants).
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        self.0 >> 33
    }
    pub fn below(&mut self, n: usize) -> usize {
        self.next() as usize % n
    }
    /// In [0, 1).
    pub fn real(&mut self) -> f64 {
        self.next() as f64 / (1u64 << 31) as f64
    }
    pub fn vertices(&mut self, mesh: &Mesh, n: usize) -> Vec<VertexId> {
        (0..n).map(|_| VertexId::from(self.below(mesh.n_vertices()))).collect()
    }
}

/// A plate of 70 × 3 × 0.05 with two holes through it, in triangles of very different lengths: genus 2.
pub fn pierced_plate() -> Soup {
    let (xs, ys) = ([0.0, 1.0, 20.0, 50.0, 60.0, 70.0], [0.0, 1.0, 2.0, 3.0]);
    let positions = (0..48).map(|v| [xs[v % 6], ys[v / 6 % 4], 0.05 * (v / 24) as f64]).collect();
    let at = |[i, j]: [usize; 2], k: usize| ((4 * k + j) * 6 + i) as u32;
    let is_solid = |i: usize, j: usize| i < 5 && j < 3 && !(j == 1 && (i == 1 || i == 3));
    let mut faces = Vec::new();
    for (i, j) in (0..15).map(|k| (k / 3, k % 3)).filter(|&(i, j)| is_solid(i, j)) {
        let square = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]];
        let [[a, b, c, d], [e, f, g, h]] = [1, 0].map(|k| square.map(|p| at(p, k)));
        faces.extend([[a, b, c], [a, c, d], [e, g, f], [e, h, g]]);
        let beside = [(i, j.wrapping_sub(1)), (i + 1, j), (i, j + 1), (i.wrapping_sub(1), j)];
        for (side, _) in beside.into_iter().enumerate().filter(|&(_, (i, j))| !is_solid(i, j)) {
            let (p, q) = (square[side], square[(side + 1) % 4]);
            let [a, b, c, d] = [at(p, 0), at(q, 0), at(q, 1), at(p, 1)];
            faces.extend([[a, b, c], [a, c, d]]);
        }
    }
    Soup::new(positions, faces)
}
