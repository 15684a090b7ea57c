//! Micchelli's recurrence for the simplex splines of one patch, shared by its basis functions [Mic80].

use super::index::multi_indices;
use super::simplex::{KnotTriple, is_left, widest};
use crate::geometry::complex::{cross, doubled_area, sub};
use std::collections::HashMap;

/// The slot of a simplex spline that vanishes, because its knots lie on a line or the point is inside Ω.
const ZERO: u16 = 0;

/// The knots of a patch, and the pairs of knots whose cross products the recurrence needs.
#[derive(Debug, Clone)]
pub(super) struct KnotSets {
    /// The knot t_{k,j} at index k (n + 1) + j.
    pub knots: Vec<[f64; 2]>,
    per_vertex: usize,
    /// Pairs of knots of different vertices, from vertex 0 to 1, 1 to 2, or 2 to 0; then pairs of one vertex.
    pairs: Vec<[usize; 2]>,
    n_crossing: usize,
}

impl KnotSets {
    pub fn new(knots: &[Vec<[f64; 2]>; 3]) -> KnotSets {
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
        KnotSets { knots: knots.concat(), per_vertex, pairs, n_crossing }
    }

    /// The pairs of knots of different vertices, counterclockwise around the patch.
    pub fn crossing(&self) -> &[[usize; 2]] {
        &self.pairs[..self.n_crossing]
    }

    /// The factor |d| of β: twice the area of the triangle of the last knots.
    pub fn weight(&self, beta: [usize; 3]) -> f64 {
        let [a, b, c] = [0, 1, 2].map(|k| self.knots[k * self.per_vertex + beta[k]]);
        doubled_area([a, b, c]).abs()
    }

    /// Computes the cross products of pairs of knots relative to u. Returns true if u lies in Ω; pairs of one vertex are then left out.
    pub fn cross_products(&self, u: [f64; 2], crosses: &mut Vec<f64>) -> bool {
        let mut from = [[0.0; 2]; 3 * (super::MAX_DEGREE + 1)];
        from.iter_mut().zip(&self.knots).for_each(|(d, &knot)| *d = sub(knot, u));
        crosses.clear();
        crosses.extend(self.crossing().iter().map(|&[a, b]| cross(from[a], from[b])));
        if crosses.iter().all(|&c| c > 0.0) {
            return true;
        }
        crosses.extend(self.pairs[self.n_crossing..].iter().map(|&[a, b]| cross(from[a], from[b])));
        false
    }
}

/// The value and derivatives of a basis function: value, x, y, xx, xy, yy.
pub(super) type BasisJet = [f64; 6];

/// A simplex spline of degree 0: constant on its triangle.
#[derive(Debug, Clone)]
struct RecurrenceLeaf {
    /// The sides, counterclockwise, as numbers of pairs; the sign is −1 if the pair runs the other way.
    sides: [(u16, f64); 3],
    /// For each side, true if points on it belong to the triangle.
    has_side: [bool; 3],
    value: f64,
}

/// A simplex spline of degree 1 or more, M = Σ λ_k M_k with barycentric coordinates λ_k in three split knots.
#[derive(Debug, Clone)]
struct RecurrenceNode {
    /// The slots of the splines M_k, each without one of the split knots.
    parts: [u16; 3],
    /// For each k the pair of the other two split knots; λ_k is a multiple of its cross product.
    pairs: [u16; 3],
    /// The factors of these cross products in λ_k.
    factors: [f64; 3],
    /// The gradients of the λ_k.
    slopes: [[f64; 2]; 3],
}

/// The simplex splines of some sets of knots, by ascending degree. Slot 0 holds the value 0; the leaves follow, then the nodes.
#[derive(Debug, Clone)]
pub(super) struct Recurrence {
    leaves: Vec<RecurrenceLeaf>,
    nodes: Vec<RecurrenceNode>,
    /// The index at which the nodes of each degree, from 1, begin; the last degree is that of the basis functions.
    begins: Vec<usize>,
}

/// Memory of evaluations, reused from point to point.
#[derive(Debug, Default, Clone)]
pub(super) struct Scratch {
    pub crosses: Vec<f64>,
    values: Vec<f64>,
    slopes: Vec<[f64; 2]>,
    pub jets: Vec<BasisJet>,
}

impl Recurrence {
    /// The recurrence for the basis functions of all β; with `inside`, only for points in Ω, where sets that lack a vertex vanish.
    pub fn new(sets: &KnotSets, inside: bool) -> Recurrence {
        let degree = sets.per_vertex - 1;
        let pairs = sets.pairs.iter().zip(0u16..);
        let pair_of = pairs.flat_map(|(&[a, b], at)| [((a, b), (at, 1.0)), ((b, a), (at, -1.0))]).collect();
        let mut making = RecurrenceBuilder {
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
            // Parts of degree 0 are leaves, whose numbers are slots already.
            let below = begins.last().map_or(0, |begin| making.leaves.len() + begin) as u16;
            begins.push(nodes.len());
            nodes.extend(level.into_iter().map(|mut node: RecurrenceNode| {
                node.parts.iter_mut().filter(|part| **part != ZERO).for_each(|part| *part += below);
                node
            }));
        }
        Recurrence { leaves: making.leaves, nodes, begins }
    }

    /// Evaluates the basis functions, without their factors |d|, from the cross products in `scratch`.
    pub fn run(&self, degree: usize, order: usize, scratch: &mut Scratch) {
        let Scratch { crosses, values, slopes, jets } = scratch;
        values.clear();
        values.push(0.0);
        values.extend(self.leaves.iter().map(|leaf| leaf.at(crosses)));
        let tops = self.begins[degree - 1];
        for node in &self.nodes[..tops] {
            let value = node.value(crosses, values);
            values.push(value);
        }
        if order > 1 {
            // The gradients of degree n − 1, in the slots of their splines.
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
            let mut jet = [node.value(crosses, values), 0.0, 0.0, 0.0, 0.0, 0.0];
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

impl RecurrenceLeaf {
    fn at(&self, crosses: &[f64]) -> f64 {
        let is_left = |k: usize| {
            let (pair, sign) = self.sides[k];
            let c = sign * crosses[pair as usize];
            c > 0.0 || (c == 0.0 && self.has_side[k])
        };
        if is_left(0) && is_left(1) && is_left(2) { self.value } else { 0.0 }
    }
}

impl RecurrenceNode {
    fn value(&self, crosses: &[f64], values: &[f64]) -> f64 {
        let part =
            |k: usize| self.factors[k] * crosses[self.pairs[k] as usize] * values[self.parts[k] as usize];
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

/// The construction of a recurrence.
struct RecurrenceBuilder<'a> {
    sets: &'a KnotSets,
    inside: bool,
    /// The number of the pair of two knots, and −1 if it runs the other way.
    pair_of: HashMap<(usize, usize), (u16, f64)>,
    /// For each set of knots, by a bit for each knot: 1 + its number among those of its degree, or [`ZERO`].
    found: HashMap<u32, u16>,
    leaves: Vec<RecurrenceLeaf>,
    levels: Vec<Vec<RecurrenceNode>>,
}

impl RecurrenceBuilder<'_> {
    /// The number of the spline of a set, counted from 1 within its degree.
    fn spline(&mut self, set: u32) -> u16 {
        if let Some(&at) = self.found.get(&set) {
            return at;
        }
        let at = self.split(set).map_or(ZERO, |split| match set.count_ones() {
            3 => self.leaf(split),
            size => self.node(set, split, size as usize - 3),
        });
        self.found.insert(set, at);
        at
    }

    fn leaf(&mut self, KnotTriple { knots: [a, b, c], doubled_area }: KnotTriple) -> u16 {
        let [a, b, c] = if doubled_area > 0.0 { [a, b, c] } else { [a, c, b] };
        let (sides, knots) = ([[a, b], [b, c], [c, a]], &self.sets.knots);
        let value = 1.0 / doubled_area.abs();
        let has_side = sides.map(|[a, b]| is_left(0.0, knots[a], knots[b]));
        self.leaves.push(RecurrenceLeaf {
            sides: sides.map(|[a, b]| self.pair_of[&(a, b)]),
            has_side,
            value,
        });
        self.leaves.len() as u16
    }

    fn node(&mut self, set: u32, split: KnotTriple, degree: usize) -> u16 {
        let KnotTriple { knots: split, doubled_area } = split;
        let parts = split.map(|knot| self.spline(set & !(1 << knot)));
        let others = [0, 1, 2].map(|k| (split[(k + 1) % 3], split[(k + 2) % 3]));
        let pairs = others.map(|pair| self.pair_of[&pair]);
        let slopes = others.map(|(a, b)| {
            let [x, y] = sub(self.sets.knots[b], self.sets.knots[a]);
            [-y / doubled_area, x / doubled_area]
        });
        let (pairs, factors) = (pairs.map(|pair| pair.0), pairs.map(|pair| pair.1 / doubled_area));
        let level = &mut self.levels[degree - 1];
        level.push(RecurrenceNode { parts, pairs, factors, slopes });
        level.len() as u16
    }

    /// The knots at which a set is split: the last one of each vertex, or if a vertex has none, those with the largest triangle. None for a
    /// set that vanishes.
    fn split(&self, set: u32) -> Option<KnotTriple> {
        let n = self.sets.per_vertex;
        let of = |k: usize| (k * n..(k + 1) * n).filter(move |knot| set >> knot & 1 == 1);
        let lasts: Vec<usize> = (0..3).filter_map(|k| of(k).next_back()).collect();
        match lasts.len() {
            3 => widest(&self.sets.knots, lasts.into_iter()),
            _ if self.inside => None,
            _ => widest(&self.sets.knots, (0..3).flat_map(of)),
        }
    }
}
