//! The patch of a hole: refinement to the size of the edges around it, and Delaunay flips.

use crate::geometry::vector;
use crate::mesh::Point;
use std::collections::HashMap;

/// How much shorter than the distance from a centroid to the corners edges there have to be before the triangle is divided \[Lie03\].
const DENSITY: f64 = std::f64::consts::SQRT_2;
/// Most rounds of division; each makes triangles three times smaller.
const ROUNDS: usize = 40;
/// Most vertices inside a patch: beyond, its triangles stay larger than those around it.
const MOST_VERTICES: usize = 200_000;
/// Sum of opposite angles above π from which on an edge is flipped, so that rounding flips none back and forth.
const DELAUNAY: f64 = 1e-9;
/// Marks the lack of a triangle.
const NONE: u32 = u32::MAX;

/// Triangles over the corners of a loop and new vertices.
pub(super) struct HolePatch {
    /// The corners of the loop, then the new vertices.
    pub points: Vec<Point>,
    pub triangles: Vec<[u32; 3]>,
    /// Number of corners of the loop.
    pub n_corners: usize,
    /// The length of edges wanted at each point.
    scales: Vec<f64>,
    /// For each new vertex the three points between which it was put.
    parents: Vec<[u32; 3]>,
    /// The triangles of each edge, which has its lower end first.
    sides: HashMap<[u32; 2], [u32; 2]>,
}

impl HolePatch {
    pub fn new(points: Vec<Point>, triangles: Vec<[u32; 3]>, scales: Vec<f64>) -> HolePatch {
        let mut sides: HashMap<[u32; 2], [u32; 2]> = HashMap::with_capacity(2 * triangles.len());
        for (t, &[a, b, c]) in (0u32..).zip(&triangles) {
            for edge in [[a, b], [b, c], [c, a]] {
                let both = sides.entry(sorted(edge)).or_insert([NONE; 2]);
                both[usize::from(both[0] != NONE)] = t;
            }
        }
        HolePatch { n_corners: points.len(), points, triangles, scales, parents: Vec::new(), sides }
    }

    /// Puts triangle `to` in the place of `from` at an edge.
    fn replace(&mut self, edge: [u32; 2], from: u32, to: u32) {
        if let Some(both) = self.sides.get_mut(&sorted(edge)) {
            both.iter_mut().filter(|other| **other == from).for_each(|other| *other = to);
        }
    }

    fn at(&self, k: u32) -> Point {
        self.points[k as usize]
    }

    /// Divides triangles at their centroids until they are as small as those around the patch, and flips edges after each round.
    pub fn refine(&mut self, is_taken: &dyn Fn(usize, usize) -> bool) {
        self.flip_edges(is_taken);
        for _ in 0..ROUNDS {
            let before = self.points.len();
            for t in 0..self.triangles.len() {
                if self.points.len() - self.n_corners < MOST_VERTICES {
                    self.divide(t);
                }
            }
            if self.points.len() == before {
                break;
            }
            self.flip_edges(is_taken);
        }
    }

    /// Divides a triangle if edges at its centroid are to be shorter than it.
    fn divide(&mut self, t: usize) {
        let corners @ [a, b, c] = self.triangles[t];
        let third = |x: [f64; 3]| (x[0] + x[1] + x[2]) / 3.0;
        let places = corners.map(|k| self.at(k));
        let centroid = std::array::from_fn(|x| third(places.map(|p| p[x])));
        let scales = corners.map(|k| self.scales[k as usize]);
        let scale = third(scales);
        let is_large = |k: usize| DENSITY * vector::distance(centroid, places[k]) > scale.max(scales[k]);
        if !(0..3).all(is_large) {
            return;
        }
        let new = self.points.len() as u32;
        self.points.push(centroid);
        self.scales.push(scale);
        self.parents.push(corners);
        let (t, n) = (t as u32, self.triangles.len() as u32);
        self.triangles[t as usize] = [a, b, new];
        self.triangles.extend([[b, c, new], [c, a, new]]);
        self.replace([b, c], t, n);
        self.replace([c, a], t, n + 1);
        self.sides.extend([([a, new], [t, n + 1]), ([b, new], [t, n]), ([c, new], [n, n + 1])]);
    }

    /// Flips edges until all are Delaunay, or each has been flipped several times.
    fn flip_edges(&mut self, is_taken: &dyn Fn(usize, usize) -> bool) {
        let mut open: Vec<[u32; 2]> = Vec::with_capacity(3 * self.triangles.len());
        for &[a, b, c] in &self.triangles {
            open.extend([[a, b], [b, c], [c, a]].map(sorted));
        }
        open.reverse();
        let mut left = 20 * open.len();
        while let Some(edge) = open.pop() {
            if left == 0 {
                break;
            }
            if let Some(around) = self.flip(edge, is_taken) {
                left -= 1;
                open.extend(around);
            }
        }
    }

    /// Flips an edge that is not Delaunay; returns the edges around it.
    fn flip(&mut self, edge: [u32; 2], is_taken: &dyn Fn(usize, usize) -> bool) -> Option<[[u32; 2]; 4]> {
        let &[s, t] = self.sides.get(&edge)?;
        if s == NONE || t == NONE {
            return None;
        }
        // Triangle s is (a, b, c), triangle t is (b, a, d).
        let of = |t: u32| {
            let corners = self.triangles[t as usize];
            let k = (0..3).find(|&k| !edge.contains(&corners[k])).unwrap_or(0);
            [corners[(k + 1) % 3], corners[(k + 2) % 3], corners[k]]
        };
        let ([a, b, c], [_, _, d]) = (of(s), of(t));
        let angle = |at: u32| {
            let [u, v] = [a, b].map(|k| vector::sub(self.at(k), self.at(at)));
            vector::norm(vector::cross(u, v)).atan2(vector::dot(u, v))
        };
        let other = sorted([c, d]);
        let on_loop = |k: u32| (k as usize) < self.n_corners;
        let exists =
            self.sides.contains_key(&other) || on_loop(c) && on_loop(d) && is_taken(c as usize, d as usize);
        if exists || angle(c) + angle(d) <= std::f64::consts::PI + DELAUNAY {
            return None;
        }
        self.sides.remove(&edge);
        self.triangles[s as usize] = [a, d, c];
        self.triangles[t as usize] = [d, b, c];
        self.sides.insert(other, [s, t]);
        // Of the four edges around, bc changes from s to t and ad from t to s.
        self.replace([b, c], s, t);
        self.replace([a, d], t, s);
        Some([[a, d], [d, b], [b, c], [c, a]].map(sorted))
    }

    /// Values at the corners continued to all points: those of a new vertex are the mean of its three parents'.
    pub fn continued<const N: usize>(&self, known: Vec<[f64; N]>) -> Vec<[f64; N]> {
        let mut all = known;
        for parents in &self.parents {
            let values = parents.map(|k| all[k as usize]);
            all.push(std::array::from_fn(|x| (values[0][x] + values[1][x] + values[2][x]) / 3.0));
        }
        all
    }
}

/// An edge with its lower end first.
fn sorted([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}
