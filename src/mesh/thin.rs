//! Steps of a repair that change faces: vertices put on boundary edges on which they lie, and faces without area mended.

use super::Point;
use super::check::{has_zero_area, t_junctions};
use super::repair::{CornerWeights, RepairState};
use crate::geometry::vector;
use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

/// Shortest over longest edge up to which a face without area is mended by collapsing its shortest edge: two of its corners nearly
/// coincide. Above, its third corner lies on the edge between the others.
const NEEDLE: f64 = 1e-9;
/// Most steps for each face without area; every step shortens the longest edges of such faces, but rounding may not see it.
const MOST_STEPS: usize = 16;

impl RepairState {
    /// Divides faces at the vertices that lie on their boundary edges; returns the number of vertices. Positions of vertices do not
    /// change: the edges bend towards them.
    pub(super) fn split_t_junctions(&mut self, positions: &[Point]) -> usize {
        let mut junctions = t_junctions(positions, &self.faces);
        junctions.sort_by(|a, b| (a.face, a.edge).cmp(&(b.face, b.edge)).then(a.share.total_cmp(&b.share)));
        // The pieces of each face; one of them has the rest of the edge.
        let mut pieces: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        let mut done = 0;
        for edge in junctions.chunk_by(|a, b| (a.face, a.edge) == (b.face, b.edge)) {
            let ([mut start, end], mut before) = (edge[0].edge, 0.0);
            for t in edge {
                let parts = pieces.entry(t.face).or_insert_with(|| vec![t.face]);
                let side = parts.iter().find_map(|&f| Some((f, self.corner_before(f, [start, end])?)));
                let Some((f, k)) = side.filter(|_| start != t.vertex) else { continue };
                parts.push(self.split_side(f, k, t.vertex, (t.share - before) / (1.0 - before)));
                (start, before, done) = (t.vertex, t.share, done + 1);
            }
        }
        done
    }

    /// The corner at which a face has the side between two vertices, in this direction.
    fn corner_before(&self, f: u32, [a, b]: [u32; 2]) -> Option<usize> {
        let corners = self.faces[f as usize];
        (0..3).find(|&k| corners[k] == a && corners[(k + 1) % 3] == b)
    }

    /// Divides face f at the point `share` of its side from corner k, where vertex v comes to lie: f keeps the half at corner k, the other
    /// half is the new face that is returned.
    fn split_side(&mut self, f: u32, k: usize, v: u32, share: f64) -> u32 {
        let f = f as usize;
        let weights = self.corner_weights(f);
        let (next, new) = ((k + 1) % 3, self.faces.len() as u32);
        let between = std::array::from_fn(|x| (1.0 - share) * weights[k][x] + share * weights[next][x]);
        let (mut face, mut halves) = (self.faces[f], [weights; 2]);
        halves[0][next] = between;
        halves[1][k] = between;
        face[k] = v;
        self.faces[f][next] = v;
        self.faces.push(face);
        self.origin.push(self.origin[f]);
        self.turned.push(false);
        self.turned[f] = false;
        self.weights[f] = Some(Box::new(halves[0]));
        self.weights.push(Some(Box::new(halves[1])));
        new
    }

    /// The corners of a face in the input's face.
    fn corner_weights(&self, f: usize) -> CornerWeights {
        let unit = |k: usize| std::array::from_fn(|x| f64::from(u8::from(x == k)));
        let order = if self.turned[f] { [0, 2, 1] } else { [0, 1, 2] };
        self.weights[f].as_ref().map_or_else(|| order.map(unit), |weights| **weights)
    }

    /// Mends faces without area by collapses and flips, where that keeps the surface a manifold.
    pub(super) fn mend_zero_area(&mut self, positions: &[Point]) {
        let mut thin = ThinFaces::new(self, positions);
        let faces = 0..thin.work.faces.len() as u32;
        faces.for_each(|f| thin.push(f));
        let mut left = MOST_STEPS * thin.open.len();
        while let Some((_, Reverse(f))) = thin.open.pop() {
            if left == 0 {
                break;
            }
            if thin.is_thin(f) {
                thin.mend(f);
                left -= 1;
            }
        }
        let keep: Vec<bool> = thin.is_left;
        self.retain(&keep);
    }

    /// Puts faces in the order of the input's, where a face was divided.
    pub(super) fn sort_faces(&mut self) {
        if self.origin.is_sorted() {
            return;
        }
        let mut order: Vec<usize> = (0..self.faces.len()).collect();
        order.sort_by_key(|&f| self.origin[f]);
        self.faces = order.iter().map(|&f| self.faces[f]).collect();
        self.turned = order.iter().map(|&f| self.turned[f]).collect();
        self.weights = order.iter().map(|&f| self.weights[f].take()).collect();
        self.origin.sort_unstable();
    }
}

/// The faces without area that are still to be mended.
struct ThinFaces<'a> {
    work: &'a mut RepairState,
    positions: &'a [Point],
    /// The faces at each vertex, in no order, with some that have left it.
    around: Vec<Vec<u32>>,
    is_left: Vec<bool>,
    /// Faces by the bits of their longest edge, which is positive: the longest comes first.
    open: BinaryHeap<(u64, Reverse<u32>)>,
}

impl<'a> ThinFaces<'a> {
    fn new(work: &'a mut RepairState, positions: &'a [Point]) -> Self {
        let mut around = vec![Vec::new(); work.vertex_origin.len()];
        for (f, face) in (0u32..).zip(&work.faces) {
            face.iter().for_each(|&v| around[v as usize].push(f));
        }
        ThinFaces { is_left: vec![true; work.faces.len()], work, positions, around, open: BinaryHeap::new() }
    }

    fn at(&self, v: u32) -> Point {
        self.positions[self.work.vertex_origin[v as usize] as usize]
    }

    fn places(&self, f: u32) -> [Point; 3] {
        self.work.faces[f as usize].map(|v| self.at(v))
    }

    fn is_thin(&self, f: u32) -> bool {
        self.is_left[f as usize] && has_zero_area(self.places(f))
    }

    /// The lengths of the sides from each corner.
    fn lengths(&self, f: u32) -> [f64; 3] {
        let p = self.places(f);
        [0, 1, 2].map(|k| vector::distance(p[k], p[(k + 1) % 3]))
    }

    fn push(&mut self, f: u32) {
        if self.is_thin(f) {
            let longest = self.lengths(f).into_iter().fold(0.0, f64::max);
            self.open.push((longest.to_bits(), Reverse(f)));
        }
    }

    /// The faces at a vertex.
    fn star(&self, v: u32) -> Vec<u32> {
        let has = |f: &&u32| self.is_left[**f as usize] && self.work.faces[**f as usize].contains(&v);
        self.around[v as usize].iter().filter(has).copied().collect()
    }

    fn mend(&mut self, f: u32) {
        let lengths = self.lengths(f);
        let pick = |better: fn(f64, f64) -> bool| {
            [1, 2].into_iter().fold(0, |best, k| if better(lengths[k], lengths[best]) { k } else { best })
        };
        let (shortest, longest) = (pick(|a, b| a < b), pick(|a, b| a > b));
        let corners = self.work.faces[f as usize];
        let corner = |k: usize| corners[k % 3];
        if lengths[shortest] <= NEEDLE * lengths[longest] {
            let (a, b) = (corner(shortest), corner(shortest + 1));
            let _ = self.collapse([a.min(b), a.max(b)]) || self.collapse([a.max(b), a.min(b)]);
        } else {
            self.flip(f, [corner(longest), corner(longest + 1)], corner(longest + 2));
        }
    }

    /// Moves the second vertex into the first, unless that pinches the surface or turns a face over.
    fn collapse(&mut self, [a, b]: [u32; 2]) -> bool {
        let (star_a, star_b) = (self.star(a), self.star(b));
        let gone: Vec<u32> =
            star_b.iter().copied().filter(|&f| self.work.faces[f as usize].contains(&a)).collect();
        let others = |star: &[u32]| -> Vec<u32> {
            let mut all: Vec<u32> = star
                .iter()
                .flat_map(|&f| self.work.faces[f as usize])
                .filter(|&v| v != a && v != b)
                .collect();
            all.sort_unstable();
            all.dedup();
            all
        };
        // Common neighbours are the third corners of the faces at the edge and no others.
        let (around_a, around_b) = (others(&star_a), others(&star_b));
        let common = around_b.iter().filter(|v| around_a.binary_search(v).is_ok()).count();
        let is_closed = |star: &[u32], around: &[u32]| star.len() == around.len() + 1;
        let both_open = !is_closed(&star_a, &around_a) && !is_closed(&star_b, &around_b);
        let pinches = common != gone.len() || gone.len() > 2 || gone.len() == 2 && both_open;
        let moved: Vec<(u32, [u32; 3])> = star_b
            .iter()
            .filter(|f| !gone.contains(f))
            .map(|&f| (f, self.work.faces[f as usize].map(|v| if v == b { a } else { v })))
            .collect();
        let repeats = |face: &[u32; 3]| {
            star_a.iter().any(|&f| face.iter().all(|v| self.work.faces[f as usize].contains(v)))
        };
        let turns = |(f, face): &(u32, [u32; 3])| {
            let [before, after] = [self.places(*f), face.map(|v| self.at(v))].map(vector::triangle_normal);
            vector::dot(before, after) < 0.0 && !self.is_thin(*f)
        };
        if pinches
            || moved.is_empty() && star_a.len() == gone.len()
            || moved.iter().any(|(_, face)| repeats(face))
            || moved.iter().any(turns)
        {
            return false;
        }
        gone.iter().for_each(|&f| self.is_left[f as usize] = false);
        for (f, face) in moved {
            self.work.faces[f as usize] = face;
            self.around[a as usize].push(f);
        }
        self.around[b as usize].clear();
        self.work.steps.collapsed_edges += 1;
        self.star(a).into_iter().for_each(|f| self.push(f));
        true
    }

    /// Drops face f, whose corner c lies on its edge, and divides the face beyond the edge at c.
    fn flip(&mut self, f: u32, edge: [u32; 2], c: u32) {
        let [a, b] = edge;
        let at_edge: Vec<u32> = self
            .star(a)
            .into_iter()
            .filter(|&g| g != f && self.work.faces[g as usize].contains(&b))
            .collect();
        let side = match at_edge[..] {
            [] => None,
            [g] => match self.work.corner_before(g, [b, a]) {
                Some(k) => Some((g, k)),
                None => return,
            },
            _ => return,
        };
        if let Some((g, k)) = side {
            let d = self.work.faces[g as usize][(k + 2) % 3];
            let is_joined = self.star(c).iter().any(|&h| self.work.faces[h as usize].contains(&d));
            if d == c || is_joined {
                return;
            }
            let [p, q, r] = [b, a, c].map(|v| self.at(v));
            let share = vector::distance(p, r) / (vector::distance(p, r) + vector::distance(r, q));
            let new = self.work.split_side(g, k, c, share);
            self.is_left.push(true);
            self.around[c as usize].extend([g, new]);
            [a, b, d].into_iter().for_each(|v| self.around[v as usize].push(new));
            self.work.steps.flipped_edges += 1;
            self.is_left[f as usize] = false;
            self.push(g);
            self.push(new);
        } else {
            self.work.steps.opened_faces += 1;
            self.is_left[f as usize] = false;
        }
    }
}
