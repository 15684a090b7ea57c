//! A chart: some faces of the model, laid flat without an overlap.

use crate::error::Result;
use crate::geometry::complex::doubled_area;
use crate::geometry::vector::{norm, triangle_normal};
use crate::mesh::union_find::UnionFind;
use crate::mesh::{EdgeId, Mesh, Point};
use std::collections::HashMap;

/// Faces of the model that are connected, with vertices of their own.
#[derive(Debug, Clone, Default)]
pub(super) struct ChartFaces {
    /// Per face its number in the model.
    pub faces: Vec<u32>,
    /// Per face its corners, as numbers of vertices of the chart.
    pub corners: Vec<[u32; 3]>,
    /// Per vertex its position in space.
    pub positions: Vec<Point>,
}

/// A chart with places in the plane, in units of the surface's lengths.
#[derive(Debug, Clone, Default)]
pub(super) struct FlatChart {
    pub part: ChartFaces,
    /// Per vertex its place in the plane.
    pub points: Vec<[f64; 2]>,
}

impl ChartFaces {
    pub fn triangle(&self, f: usize) -> [Point; 3] {
        self.corners[f].map(|v| self.positions[v as usize])
    }

    /// The area in space.
    pub fn area(&self) -> f64 {
        (0..self.faces.len()).map(|f| 0.5 * norm(triangle_normal(self.triangle(f)))).sum()
    }

    /// The parts that consist of the faces with the same number, in the order of their first faces, and per vertex of each its number here.
    pub fn parts(&self, number: &[u32]) -> Vec<(ChartFaces, Vec<u32>)> {
        let most = number.iter().map(|k| *k as usize + 1).max().unwrap_or(0);
        let mut place = vec![u32::MAX; most];
        let mut members: Vec<Vec<usize>> = Vec::new();
        for (f, &k) in number.iter().enumerate() {
            if place[k as usize] == u32::MAX {
                place[k as usize] = members.len() as u32;
                members.push(Vec::new());
            }
            members[place[k as usize] as usize].push(f);
        }
        members.iter().map(|list| self.part_of(list)).collect()
    }

    /// The part of some faces, and per vertex of it its number here. A vertex that several fans of its faces meet in is there for each.
    fn part_of(&self, list: &[usize]) -> (ChartFaces, Vec<u32>) {
        let side = |k: usize, i: usize| {
            let c = self.corners[list[k]];
            [c[i], c[(i + 1) % 3]]
        };
        let mut across: HashMap<[u32; 2], u32> = HashMap::new();
        let mut fans = UnionFind::new(3 * list.len());
        for k in 0..list.len() {
            for i in 0..3 {
                let ([v, w], corner) = (side(k, i), (3 * k + i) as u32);
                if let Some(other) = across.get(&[w, v]) {
                    let after = |c: u32| 3 * (c / 3) + (c + 1) % 3;
                    fans.join(corner, after(*other));
                    fans.join(after(corner), *other);
                }
                across.insert([v, w], corner);
            }
        }
        let (mut part, mut origins) = (ChartFaces::default(), Vec::new());
        let mut number = vec![u32::MAX; 3 * list.len()];
        for (k, &f) in list.iter().enumerate() {
            part.faces.push(self.faces[f]);
            part.corners.push([0, 1, 2].map(|i| {
                let own = &mut number[fans.root((3 * k + i) as u32) as usize];
                if *own == u32::MAX {
                    let v = self.corners[f][i];
                    *own = origins.len() as u32;
                    origins.push(v);
                    part.positions.push(self.positions[v as usize]);
                }
                *own
            }));
        }
        (part, origins)
    }

    /// Per face the number of its piece: faces are connected across edges that `is_open` leaves.
    pub fn pieces(mesh: &Mesh, is_open: impl Fn(EdgeId) -> bool) -> Vec<u32> {
        let mut sets = UnionFind::new(mesh.n_faces());
        for e in mesh.edges().filter(|&e| !is_open(e)) {
            if let (Some(f), Some(g)) = (mesh.face(e.halfedge()), mesh.face(e.halfedge().twin())) {
                sets.join(f.0, g.0);
            }
        }
        (0..mesh.n_faces() as u32).map(|f| sets.root(f)).collect()
    }

    /// Per face the number of its piece: faces that are not left out are connected across their sides.
    pub fn pieces_without(&self, left_out: &[bool]) -> Vec<u32> {
        let mut across: HashMap<[u32; 2], u32> = HashMap::new();
        let mut sets = UnionFind::new(self.faces.len());
        for (f, c) in (0u32..).zip(&self.corners).filter(|(f, _)| !left_out[*f as usize]) {
            for i in 0..3 {
                let [v, w] = [c[i], c[(i + 1) % 3]];
                across.get(&[w, v]).map(|g| sets.join(f, *g));
                across.insert([v, w], f);
            }
        }
        (0..self.faces.len() as u32).map(|f| sets.root(f)).collect()
    }

    /// The chart's connectivity. Faces and vertices keep their numbers.
    ///
    /// # Errors
    /// Those of [`Mesh::from_faces`].
    pub fn mesh(&self) -> Result<Mesh> {
        Mesh::from_faces(self.positions.len(), &self.corners)
    }
}

impl FlatChart {
    /// The area in the plane.
    pub fn area(&self) -> f64 {
        self.part.corners.iter().map(|c| 0.5 * doubled_area(c.map(|v| self.points[v as usize]))).sum()
    }

    /// The chart taken apart along open edges of its mesh.
    pub fn apart(&self, mesh: &Mesh, is_open: impl Fn(EdgeId) -> bool) -> Vec<FlatChart> {
        let parts = self.part.parts(&ChartFaces::pieces(mesh, is_open));
        let placed = |(part, origins): (ChartFaces, Vec<u32>)| {
            let points = origins.iter().map(|&v| self.points[v as usize]).collect();
            FlatChart { part, points }
        };
        parts.into_iter().map(placed).collect()
    }
}
