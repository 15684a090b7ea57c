//! Edge paths between the landmarks and boundary loops of one surface, no two of which meet.

use super::marked_surface::Marks;
use crate::error::{Error, Result};
use crate::mesh::{HalfedgeId, Mesh, PerEdge, PerVertex, VertexId};
use crate::topology::spanning::Key;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Finds paths one after the other, each beside those before it.
pub(crate) struct PathRouter<'a> {
    mesh: &'a Mesh,
    lengths: &'a PerEdge<f64>,
    marks: &'a Marks,
    /// Per mark the half-edges that leave it, in cyclic order: counterclockwise around a landmark, along a loop with the surface on the
    /// left.
    exits: Vec<Vec<HalfedgeId>>,
    /// Per vertex of a mark: the mark.
    mark_of: PerVertex<Option<u32>>,
    /// True for vertices that no other path may pass or, on loops, end at.
    is_taken: PerVertex<bool>,
    /// Per mark the exits in use: the place among its exits and the number of the path.
    ends: Vec<Vec<(usize, usize)>>,
    /// The paths, each from its first to its second mark.
    pub paths: Vec<Vec<HalfedgeId>>,
}

impl<'a> PathRouter<'a> {
    pub fn new(mesh: &'a Mesh, lengths: &'a PerEdge<f64>, marks: &'a Marks) -> PathRouter<'a> {
        let n = mesh.n_vertices();
        let mut mark_of = PerVertex::filled(n, None);
        for k in 0..marks.n() {
            marks.vertices(mesh, k).into_iter().for_each(|v| mark_of[v] = Some(k as u32));
        }
        let leaves = |k: usize| marks.vertices(mesh, k).into_iter().flat_map(|v| mesh.fan(v));
        let exits = (0..marks.n()).map(|k| leaves(k).filter(|h| !mesh.is_boundary_edge(h.edge())).collect());
        let exits: Vec<Vec<HalfedgeId>> = exits.collect();
        let mut is_taken = PerVertex::filled(n, false);
        // A corner has a place in the order around its loop like the end of a path, and no path ends there.
        let mut ends = vec![Vec::new(); marks.n()];
        for (number, &v) in marks.corners.iter().enumerate() {
            is_taken[v] = true;
            let Some(mark) = mark_of[v].map(|k| k as usize) else { continue };
            let around = marks.vertices(mesh, mark);
            let before = around.iter().take_while(|&&u| u != v).flat_map(|&u| mesh.fan(u));
            let place = before.filter(|h| !mesh.is_boundary_edge(h.edge())).count();
            ends[mark].push((place, usize::MAX - number));
        }
        PathRouter { mesh, lengths, marks, exits, mark_of, is_taken, ends, paths: Vec::new() }
    }

    /// The numbers of the paths that end at a mark, in cyclic order.
    pub fn order(&self, mark: usize) -> Vec<usize> {
        let mut ends = self.ends[mark].clone();
        ends.sort_unstable();
        ends.into_iter().map(|end| end.1).collect()
    }

    /// Finds the next path, the shortest from mark to mark that meets no other. `orders`: for each of the two marks the cyclic order in
    /// which all paths have to end there at last, by their numbers; without them any order is permitted.
    ///
    /// # Errors
    /// [`Error::Matching`] if there is no such path, naming the marks.
    pub fn join(&mut self, [a, b]: [usize; 2], orders: Option<[&[usize]; 2]>) -> Result<()> {
        let number = self.paths.len();
        let allowed = |k: usize, mark: usize| match orders {
            Some(orders) => self.sector(mark, number, orders[k]),
            None => self.sector(mark, number, &[]),
        };
        let (starts, ends) = (allowed(0, a), allowed(1, b));
        let Some(path) = self.shortest(a, &starts, b, &ends) else {
            return Err(Error::Matching(format!(
                "no edge path is left between {} and {} beside those between other marks: refine the surface (`ricci refine --edge L`), or leave one of them out",
                self.marks.name(a),
                self.marks.name(b)
            )));
        };
        for &h in &path {
            let v = self.mesh.origin(h);
            self.is_taken[v] =
                self.is_taken[v] || self.mesh.is_boundary_vertex(v) || self.mark_of[v].is_none();
        }
        if let (Some(&first), Some(&last)) = (path.first(), path.last()) {
            let tip = self.mesh.tip(last);
            self.is_taken[tip] = self.is_taken[tip] || self.mesh.is_boundary_vertex(tip);
            for (mark, h) in [(a, first), (b, last.twin())] {
                let place = self.exits[mark].iter().position(|&exit| exit == h);
                self.ends[mark].push((place.unwrap_or(0), number));
            }
        }
        self.paths.push(path);
        Ok(())
    }

    /// The length of the shortest path from mark to mark beside those that were found; `None` if there is none.
    pub fn length(&self, [a, b]: [usize; 2]) -> Option<f64> {
        let all = [a, b].map(|mark| vec![true; self.exits[mark].len()]);
        let path = self.shortest(a, &all[0], b, &all[1])?;
        Some(path.iter().map(|h| self.lengths[h.edge()]).sum())
    }

    /// The numbers of the other marks and of the paths that enclose a mark.
    pub fn around(&self, mark: usize) -> (Vec<usize>, Vec<usize>) {
        let mut reached = PerVertex::filled(self.mesh.n_vertices(), false);
        let mut waiting = self.marks.vertices(self.mesh, mark);
        let (mut marks, mut taken) = (Vec::new(), PerVertex::filled(self.mesh.n_vertices(), false));
        while let Some(v) = waiting.pop() {
            for h in self.mesh.outgoing(v) {
                let tip = self.mesh.tip(h);
                if std::mem::replace(&mut reached[tip], true) {
                    continue;
                }
                match self.mark_of[tip] {
                    Some(other) => marks.push(other as usize),
                    None if self.is_taken[tip] => taken[tip] = true,
                    None => waiting.push(tip),
                }
            }
        }
        marks.retain(|&other| other != mark);
        marks.sort_unstable();
        marks.dedup();
        let meets = |path: &Vec<HalfedgeId>| path.iter().any(|&h| taken[self.mesh.origin(h)]);
        (marks, (0..self.paths.len()).filter(|&k| meets(&self.paths[k])).collect())
    }

    /// Per exit of a mark, true if the path of this number may use it so that the exits in use are in this order.
    fn sector(&self, mark: usize, number: usize, order: &[usize]) -> Vec<bool> {
        let n = self.exits[mark].len();
        let mut used = self.ends[mark].clone();
        used.sort_unstable();
        let mut allowed = vec![true; n];
        used.iter().filter(|end| end.0 < n).for_each(|&(place, _)| allowed[place] = false);
        let Some(at) = order.iter().position(|&k| k == number).filter(|_| used.len() > 1) else {
            return allowed;
        };
        // The exits between the path in use that comes before this one in the order and the next one in use are permitted.
        let m = order.len();
        let before =
            (1..m).map(|k| order[(at + m - k) % m]).find_map(|k| used.iter().position(|end| end.1 == k));
        let Some(before) = before else { return allowed };
        let (from, to) = (used[before].0, used[(before + 1) % used.len()].0);
        if n == 0 || from == to {
            return allowed;
        }
        let is_between = |place: usize| (place + n - from) % n < (to + n - from) % n;
        (0..n).for_each(|place| allowed[place] &= is_between(place));
        allowed
    }

    /// The shortest path from one of the permitted exits of mark a to one of mark b.
    fn shortest(&self, a: usize, starts: &[bool], b: usize, ends: &[bool]) -> Option<Vec<HalfedgeId>> {
        let (mesh, n) = (self.mesh, self.mesh.n_vertices());
        let mut distance = PerVertex::filled(n, f64::INFINITY);
        let mut parent: PerVertex<Option<HalfedgeId>> = PerVertex::filled(n, None);
        let mut is_end = std::collections::HashSet::new();
        for (h, _) in self.exits[b].iter().zip(ends).filter(|(_, allowed)| **allowed) {
            is_end.insert(h.twin());
        }
        let mut best: (f64, Option<HalfedgeId>) = (f64::INFINITY, None);
        let mut heap = BinaryHeap::new();
        let is_open = |v: VertexId| self.mark_of[v].is_none() && !self.is_taken[v];
        let is_free_end = |v: VertexId| !self.is_taken[v];
        for (&h, _) in self.exits[a].iter().zip(starts).filter(|(_, allowed)| **allowed) {
            let (tip, length) = (mesh.tip(h), self.lengths[h.edge()]);
            if !is_free_end(mesh.origin(h)) {
                continue;
            }
            if is_end.contains(&h) && is_free_end(tip) && length < best.0 {
                best = (length, Some(h));
            } else if is_open(tip) && length < distance[tip] {
                (distance[tip], parent[tip]) = (length, Some(h));
                heap.push(Reverse((Key(length), tip)));
            }
        }
        while let Some(Reverse((Key(far), v))) = heap.pop() {
            if far > distance[v] {
                continue;
            }
            if far >= best.0 {
                break;
            }
            for h in mesh.outgoing(v) {
                let (tip, length) = (mesh.tip(h), far + self.lengths[h.edge()]);
                if is_end.contains(&h) && is_free_end(tip) {
                    if length < best.0 {
                        best = (length, Some(h));
                    }
                } else if is_open(tip) && length < distance[tip] {
                    (distance[tip], parent[tip]) = (length, Some(h));
                    heap.push(Reverse((Key(length), tip)));
                }
            }
        }
        let last = best.1?;
        let back = |h: &HalfedgeId| {
            let v = mesh.origin(*h);
            // A path starts at its mark: vertices of marks have no parents.
            parent[v]
        };
        let mut path: Vec<HalfedgeId> = std::iter::successors(Some(last), back).collect();
        path.reverse();
        Some(path)
    }
}
