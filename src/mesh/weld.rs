//! Sets of points that coincide, exactly or within a distance.

use super::Point;
use super::union_find::UnionFind;
use crate::error::{Error, Result};
use std::collections::HashMap;

/// Checks that a distance is finite and not negative.
pub(super) fn check_tolerance(weld: f64) -> Result<()> {
    if weld >= 0.0 && weld.is_finite() {
        return Ok(());
    }
    Err(Error::argument("weld", weld, "a distance that is not negative"))
}

/// For each point the first point that it coincides with: at exactly the same position for `tolerance` 0, else within that distance by a
/// chain of such points. Points that are not finite coincide with none.
///
/// O(n) for tolerance 0. Otherwise a tree of boxes is compared with itself; pairs of boxes that are too far apart, near enough as a
/// whole, or joined already are not divided. O(n log n) for points of a surface, for any tolerance.
pub(super) fn coincident(positions: &[Point], tolerance: f64) -> Vec<u32> {
    if tolerance == 0.0 {
        return same_place(positions);
    }
    let mut tree = PointTree::new(positions, tolerance);
    if !tree.order.is_empty() {
        tree.build(0, tree.order.len());
        tree.join_within(0);
    }
    (0..positions.len() as u32).map(|v| tree.sets.root(v)).collect()
}

/// A position as a key, with −0 as 0.
pub(super) fn place_key(p: Point) -> [u64; 3] {
    p.map(|x| if x == 0.0 { 0 } else { x.to_bits() })
}

fn same_place(positions: &[Point]) -> Vec<u32> {
    let mut known: HashMap<[u64; 3], u32> = HashMap::with_capacity(positions.len());
    let first = |(v, p): (u32, &Point)| {
        if !p.iter().all(|x| x.is_finite()) {
            return v;
        }
        *known.entry(place_key(*p)).or_insert(v)
    };
    (0u32..).zip(positions).map(first).collect()
}

/// Most points of a leaf: comparing the pairs of so few takes no longer than dividing further.
const LEAF: usize = 8;

/// A tree of boxes, each halved at the median of its longest side.
struct PointTree<'a> {
    positions: &'a [Point],
    tolerance: f64,
    /// The finite points, those of a node next to each other.
    order: Vec<u32>,
    nodes: Vec<PointNode>,
    sets: UnionFind,
    #[cfg(test)]
    visits: usize,
}

struct PointNode {
    low: Point,
    high: Point,
    start: usize,
    end: usize,
    /// The node of the second half; the first half is the next node. 0 in a leaf.
    second: usize,
    /// True if all its points are in one set.
    one: bool,
}

fn length(d: Point) -> f64 {
    d[0].hypot(d[1]).hypot(d[2])
}

impl<'a> PointTree<'a> {
    fn new(positions: &'a [Point], tolerance: f64) -> PointTree<'a> {
        let finite = |v: &u32| positions[*v as usize].iter().all(|x| x.is_finite());
        PointTree {
            positions,
            tolerance,
            order: (0..positions.len() as u32).filter(finite).collect(),
            nodes: Vec::new(),
            sets: UnionFind::new(positions.len()),
            #[cfg(test)]
            visits: 0,
        }
    }

    /// Builds the node of these points. The recursion is as deep as the logarithm of their number.
    fn build(&mut self, start: usize, end: usize) -> usize {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for &v in &self.order[start..end] {
            let p = self.positions[v as usize];
            low = [0, 1, 2].map(|k| low[k].min(p[k]));
            high = [0, 1, 2].map(|k| high[k].max(p[k]));
        }
        let node = self.nodes.len();
        self.nodes.push(PointNode { low, high, start, end, second: 0, one: false });
        if end - start > LEAF {
            let side = |k: &usize| high[*k] - low[*k];
            let axis = [1, 2].into_iter().fold(0, |best, k| if side(&k) > side(&best) { k } else { best });
            let (middle, at) = ((end - start) / 2, |v: &u32| self.positions[*v as usize][axis]);
            self.order[start..end].select_nth_unstable_by(middle, |v, w| at(v).total_cmp(&at(w)));
            self.build(start, start + middle);
            self.nodes[node].second = self.build(start + middle, end);
        }
        node
    }

    /// The largest distance that points of two nodes can have.
    fn widest(&self, a: usize, b: usize) -> f64 {
        let (a, b) = (&self.nodes[a], &self.nodes[b]);
        length([0, 1, 2].map(|k| a.high[k].max(b.high[k]) - a.low[k].min(b.low[k])))
    }

    /// The least distance that points of two nodes can have.
    fn gap(&self, a: usize, b: usize) -> f64 {
        let (a, b) = (&self.nodes[a], &self.nodes[b]);
        length([0, 1, 2].map(|k| (a.low[k] - b.high[k]).max(b.low[k] - a.high[k]).max(0.0)))
    }

    fn root_of(&mut self, node: usize) -> u32 {
        self.sets.root(self.order[self.nodes[node].start])
    }

    fn join_all(&mut self, node: usize) {
        let PointNode { start, end, .. } = self.nodes[node];
        for i in start + 1..end {
            self.sets.join(self.order[start], self.order[i]);
        }
    }

    /// Joins the points of a node that are near enough.
    fn join_within(&mut self, node: usize) {
        let PointNode { start, end, second, .. } = self.nodes[node];
        if self.widest(node, node) <= self.tolerance {
            self.join_all(node);
            self.nodes[node].one = true;
        } else if second == 0 {
            self.join_pairs(start..end, start..end);
        } else {
            self.join_within(node + 1);
            self.join_within(second);
            self.join_between([node + 1, second], [false; 2]);
            let one = self.nodes[node + 1].one && self.nodes[second].one;
            self.nodes[node].one = one && self.root_of(node + 1) == self.root_of(second);
        }
    }

    /// Joins the points of two nodes that are near enough; `known` is true for a node of one set.
    fn join_between(&mut self, pair: [usize; 2], known: [bool; 2]) {
        #[cfg(test)]
        {
            self.visits += 1;
        }
        let one = [0, 1].map(|k| known[k] || self.nodes[pair[k]].one);
        let [a, b] = pair;
        if self.gap(a, b) > self.tolerance || one == [true; 2] && self.root_of(a) == self.root_of(b) {
            return;
        }
        if self.widest(a, b) <= self.tolerance {
            // Each node alone is near enough, so it is one set.
            self.sets.join(self.order[self.nodes[a].start], self.order[self.nodes[b].start]);
            return;
        }
        let [large, small] = match (self.nodes[a].second, self.nodes[b].second) {
            (0, 0) => {
                let [a, b] = pair.map(|node| self.nodes[node].start..self.nodes[node].end);
                return self.join_pairs(a, b);
            }
            (0, _) => [1, 0],
            (_, 0) => [0, 1],
            _ if self.widest(a, a) >= self.widest(b, b) => [0, 1],
            _ => [1, 0],
        };
        // The nearer half comes first: if it joins everything, the other one need not be searched.
        let (first, second) = (pair[large] + 1, self.nodes[pair[large]].second);
        let nearer = self.gap(first, pair[small]) <= self.gap(second, pair[small]);
        for half in if nearer { [first, second] } else { [second, first] } {
            self.join_between([half, pair[small]], [one[large], one[small]]);
        }
    }

    fn join_pairs(&mut self, a: std::ops::Range<usize>, b: std::ops::Range<usize>) {
        for i in a {
            for j in b.clone() {
                let (v, w) = (self.order[i], self.order[j]);
                let (p, q) = (self.positions[v as usize], self.positions[w as usize]);
                if length([0, 1, 2].map(|k| p[k] - q[k])) <= self.tolerance {
                    self.sets.join(v, w);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::shapes;

    /// The number of pairs of boxes compared, per point, and the number of sets.
    fn effort(points: &[Point], tolerance: f64) -> (f64, usize) {
        let mut tree = PointTree::new(points, tolerance);
        tree.build(0, points.len());
        tree.join_within(0);
        let sets = (0..points.len() as u32).filter(|&v| tree.sets.root(v) == v).count();
        (tree.visits as f64 / points.len() as f64, sets)
    }

    #[test]
    fn no_tolerance_takes_more_than_a_few_boxes_per_point() {
        // Dense surfaces in several pieces, curved and flat, at some distance from each other.
        let shell = |radius: f64, n| {
            shapes::icosphere(n).unwrap().positions.into_iter().map(move |p| p.map(|x| radius * x))
        };
        let spheres: Vec<Point> = shell(1.0, 60).chain(shell(1.1, 60)).collect();
        let mut sheets = shapes::disk(100).unwrap().positions;
        sheets.extend(sheets.clone().iter().map(|p| [p[0], p[1], 0.1]));
        for points in [spheres, sheets, vec![[0.25; 3]; 40_000]] {
            let (mut most, mut last) = (0.0f64, usize::MAX);
            let tolerances =
                [f64::MIN_POSITIVE, 1e-20, 1e-6, 3e-3, 0.01, 0.03, 0.0999, 0.1001, 0.3, 1.0, 4.0, 1e300];
            for tolerance in tolerances {
                let (visits, sets) = effort(&points, tolerance);
                assert!(sets <= last, "a larger tolerance joins more");
                (most, last) = (most.max(visits), sets);
            }
            assert!(most < 60.0, "{most}");
            assert_eq!(last, 1);
        }
    }

    #[test]
    fn sheets_join_at_their_distance() {
        let mut sheets = shapes::disk(40).unwrap().positions;
        let n = sheets.len();
        sheets.extend(sheets.clone().iter().map(|p| [p[0], p[1], 0.015625]));
        for (tolerance, sets) in [(0.0156, 2 * n), (0.015625, n), (0.03, 1)] {
            assert_eq!(effort(&sheets, tolerance).1, sets);
        }
        assert_eq!(coincident(&[[f64::NAN; 3], [0.0; 3], [f64::INFINITY; 3], [0.0; 3]], 1.0), [0, 1, 2, 1]);
    }
}
