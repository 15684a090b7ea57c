//! Micchelli's recurrence over the sets of knots of one patch [Mic80].

use super::index::multi_indices;
use super::simplex::is_left;
use crate::geometry::complex::{cross, doubled_area, sub};
use std::collections::HashMap;

/// The slot of a simplex spline that vanishes, because its knots lie on a line or because the point is inside Ω.
const ZERO: u16 = 0;

/// The knots of a patch, and the pairs of them that a point sees.
#[derive(Debug, Clone)]
pub(super) struct Sets {
    /// t_{k,j} at k (n + 1) + j.
    pub knots: Vec<[f64; 2]>,
    per_vertex: usize,
    /// Pairs of knots of different vertices, from vertex 0 to 1, 1 to 2, or 2 to 0; then those of one vertex.
    pairs: Vec<[usize; 2]>,
    n_crossing: usize,
}

impl Sets {
    pub fn new(knots: &[Vec<[f64; 2]>; 3]) -> Sets {
        let per_vertex = knots[0].len();
        let each = |k: usize| k * per_vertex..(k + 1) * per_vertex;
        let mut pairs = Vec::new();
        for k in 0..3 {
            pairs.extend(each(k).flat_map(|a| each((k + 1) % 3).map(move |b| [a, b])));
        }
        let n_crossing = pairs.len();
        for k in 0..3 {
            pairs.extend(each(k).flat_map(|a| (a + 1..each(k).end).map(move |b| [a, b])));
        }
        Sets { knots: knots.concat(), per_vertex, pairs, n_crossing }
    }

    /// Pairs of knots of different vertices, counterclockwise around the patch.
    pub fn crossing(&self) -> &[[usize; 2]] {
        &self.pairs[..self.n_crossing]
    }

    /// |d| of β: twice the area of the triangle of the last knots.
    pub fn weight(&self, beta: [usize; 3]) -> f64 {
        let [a, b, c] = [0, 1, 2].map(|k| self.knots[k * self.per_vertex + beta[k]]);
        doubled_area([a, b, c]).abs()
    }

    /// The cross products of pairs of knots seen from u; returns whether u lies in Ω, and then leaves out pairs of one vertex.
    pub fn see(&self, u: [f64; 2], seen: &mut Vec<f64>) -> bool {
        let mut from = [[0.0; 2]; 3 * (super::MAX_DEGREE + 1)];
        from.iter_mut().zip(&self.knots).for_each(|(d, &knot)| *d = sub(knot, u));
        seen.clear();
        seen.extend(self.crossing().iter().map(|&[a, b]| cross(from[a], from[b])));
        if seen.iter().all(|&c| c > 0.0) {
            return true;
        }
        seen.extend(self.pairs[self.n_crossing..].iter().map(|&[a, b]| cross(from[a], from[b])));
        false
    }
}

/// A basis function and its derivatives: value, x, y, xx, xy, yy.
pub(super) type Jet = [f64; 6];

/// One simplex spline of degree 0: constant on its triangle.
#[derive(Debug, Clone)]
struct Leaf {
    /// The sides, counterclockwise, as pairs of knots: with sign −1 where the pair runs the other way.
    sides: [(u16, f64); 3],
    /// Whether points on a side belong to the triangle.
    has_side: [bool; 3],
    value: f64,
}

/// One simplex spline of degree 1 or more: M = Σ λ_k M_k.
#[derive(Debug, Clone)]
struct Node {
    /// Slots of the splines without one of the split knots.
    parts: [u16; 3],
    /// The pairs of the other two split knots, of which λ_k is a multiple.
    pairs: [u16; 3],
    /// λ_k over the cross product of its pair.
    factors: [f64; 3],
    /// Gradients of the λ_k.
    slopes: [[f64; 2]; 3],
}

/// The splines of some sets, by ascending degree. Values are kept in slots: 0 for nothing, then the leaves, then the nodes.
#[derive(Debug, Clone)]
pub(super) struct Recurrence {
    leaves: Vec<Leaf>,
    nodes: Vec<Node>,
    /// Where the nodes of a degree, from 1, begin; the last degree is that of the basis functions.
    begins: Vec<usize>,
}

/// Memory of evaluations, which is kept from point to point.
#[derive(Debug, Default, Clone)]
pub(super) struct Scratch {
    pub seen: Vec<f64>,
    values: Vec<f64>,
    slopes: Vec<[f64; 2]>,
    pub jets: Vec<Jet>,
}

impl Recurrence {
    /// For the basis functions of all β; `inside` Ω alone, where sets that lack a vertex vanish.
    pub fn new(sets: &Sets, inside: bool) -> Recurrence {
        let degree = sets.per_vertex - 1;
        let pairs = sets.pairs.iter().zip(0u16..);
        let pair_of = pairs.flat_map(|(&[a, b], at)| [((a, b), (at, 1.0)), ((b, a), (at, -1.0))]).collect();
        let mut making = Making {
            sets,
            inside,
            pair_of,
            found: HashMap::new(),
            leaves: Vec::new(),
            levels: vec![Vec::new(); degree],
        };
        for beta in multi_indices(degree) {
            let first = |k: usize| ((1u32 << (beta[k] + 1)) - 1) << (k * sets.per_vertex);
            making.spline(first(0) | first(1) | first(2));
        }
        let (mut nodes, mut begins) = (Vec::new(), Vec::new());
        for level in making.levels {
            // Parts of degree 0 are leaves, whose numbers are slots.
            let below = begins.last().map_or(0, |begin| making.leaves.len() + begin) as u16;
            begins.push(nodes.len());
            nodes.extend(level.into_iter().map(|mut node: Node| {
                node.parts.iter_mut().filter(|part| **part != ZERO).for_each(|part| *part += below);
                node
            }));
        }
        Recurrence { leaves: making.leaves, nodes, begins }
    }

    /// Evaluate the basis functions without their factors |d|, from the cross products that the point sees.
    pub fn run(&self, degree: usize, order: usize, scratch: &mut Scratch) {
        let Scratch { seen, values, slopes, jets } = scratch;
        values.clear();
        values.push(0.0);
        values.extend(self.leaves.iter().map(|leaf| leaf.at(seen)));
        let tops = self.begins[degree - 1];
        for node in &self.nodes[..tops] {
            let value = node.value(seen, values);
            values.push(value);
        }
        if order > 1 {
            // Gradients of degree n − 1, in the slots of their splines.
            slopes.clear();
            slopes.resize(values.len(), [0.0; 2]);
            let first = if degree > 1 { self.begins[degree - 2] } else { tops };
            for (node, at) in self.nodes[first..tops].iter().zip(1 + self.leaves.len() + first..) {
                slopes[at] = node.slope((degree - 1) as f64, values);
            }
        }
        jets.clear();
        jets.extend(self.nodes[tops..].iter().map(|node| {
            let n = degree as f64;
            let mut jet = [node.value(seen, values), 0.0, 0.0, 0.0, 0.0, 0.0];
            if order > 0 {
                [jet[1], jet[2]] = node.slope(n, values);
            }
            if order > 1 {
                [jet[3], jet[4], jet[5]] = node.second(n, slopes);
            }
            jet
        }));
    }
}

impl Leaf {
    fn at(&self, seen: &[f64]) -> f64 {
        let is_left = |k: usize| {
            let (pair, sign) = self.sides[k];
            let c = sign * seen[pair as usize];
            c > 0.0 || (c == 0.0 && self.has_side[k])
        };
        if is_left(0) && is_left(1) && is_left(2) { self.value } else { 0.0 }
    }
}

impl Node {
    fn value(&self, seen: &[f64], values: &[f64]) -> f64 {
        let part = |k: usize| self.factors[k] * seen[self.pairs[k] as usize] * values[self.parts[k] as usize];
        part(0) + part(1) + part(2)
    }

    /// The gradient: n Σ ∇λ_k M_k.
    fn slope(&self, n: f64, values: &[f64]) -> [f64; 2] {
        [0, 1].map(|x| n * (0..3).map(|k| self.slopes[k][x] * values[self.parts[k] as usize]).sum::<f64>())
    }

    /// The second derivatives xx, xy, yy: n Σ ∇λ_k ∇M_k.
    fn second(&self, n: f64, slopes: &[[f64; 2]]) -> [f64; 3] {
        [[0, 0], [0, 1], [1, 1]].map(|[x, y]| {
            n * (0..3).map(|k| self.slopes[k][x] * slopes[self.parts[k] as usize][y]).sum::<f64>()
        })
    }
}

/// A recurrence that is being made.
struct Making<'a> {
    sets: &'a Sets,
    inside: bool,
    /// The pair of two knots, and −1 if it runs the other way.
    pair_of: HashMap<(usize, usize), (u16, f64)>,
    /// Per set, a bit per knot: 1 + its number among those of its degree, or [`ZERO`].
    found: HashMap<u32, u16>,
    leaves: Vec<Leaf>,
    levels: Vec<Vec<Node>>,
}

impl Making<'_> {
    /// The number of the spline of a set, counted from 1 within its degree.
    fn spline(&mut self, set: u32) -> u16 {
        if let Some(&at) = self.found.get(&set) {
            return at;
        }
        let at = self.split(set).map_or(ZERO, |(split, twice_area)| match set.count_ones() {
            3 => self.leaf(split, twice_area),
            size => self.node(set, (split, twice_area), size as usize - 3),
        });
        self.found.insert(set, at);
        at
    }

    fn leaf(&mut self, corners: [usize; 3], twice_area: f64) -> u16 {
        let [a, b, c] = corners;
        let [a, b, c] = if twice_area > 0.0 { [a, b, c] } else { [a, c, b] };
        let (sides, knots) = ([[a, b], [b, c], [c, a]], &self.sets.knots);
        let value = 1.0 / twice_area.abs();
        let has_side = sides.map(|[a, b]| is_left(0.0, knots[a], knots[b]));
        self.leaves.push(Leaf { sides: sides.map(|[a, b]| self.pair_of[&(a, b)]), has_side, value });
        self.leaves.len() as u16
    }

    fn node(&mut self, set: u32, (split, twice_area): ([usize; 3], f64), degree: usize) -> u16 {
        let parts = split.map(|knot| self.spline(set & !(1 << knot)));
        let others = [0, 1, 2].map(|k| (split[(k + 1) % 3], split[(k + 2) % 3]));
        let pairs = others.map(|pair| self.pair_of[&pair]);
        let slopes = others.map(|(a, b)| {
            let [x, y] = sub(self.sets.knots[b], self.sets.knots[a]);
            [-y / twice_area, x / twice_area]
        });
        let (pairs, factors) = (pairs.map(|pair| pair.0), pairs.map(|pair| pair.1 / twice_area));
        let level = &mut self.levels[degree - 1];
        level.push(Node { parts, pairs, factors, slopes });
        level.len() as u16
    }

    /// The knots at which a set is split: the last of each vertex, or where a vertex has none, those with the largest triangle. None for a
    /// set that vanishes.
    fn split(&self, set: u32) -> Option<([usize; 3], f64)> {
        let n = self.sets.per_vertex;
        let of = |k: usize| (k * n..(k + 1) * n).filter(move |knot| set >> knot & 1 == 1);
        let lasts: Vec<usize> = (0..3).filter_map(|k| of(k).next_back()).collect();
        let all: Vec<usize> = (0..3).flat_map(of).collect();
        match lasts.len() {
            3 => self.widest(&lasts),
            _ if self.inside => None,
            _ => self.widest(&all),
        }
    }

    fn widest(&self, among: &[usize]) -> Option<([usize; 3], f64)> {
        let knots = &self.sets.knots;
        let mut best = ([0; 3], 0.0f64);
        for (i, &a) in among.iter().enumerate() {
            for (j, &b) in among.iter().enumerate().skip(i + 1) {
                for &c in &among[j + 1..] {
                    let twice_area = doubled_area([knots[a], knots[b], knots[c]]);
                    if twice_area.abs() > best.1.abs() {
                        best = ([a, b, c], twice_area);
                    }
                }
            }
        }
        (best.1 != 0.0).then_some(best)
    }
}
