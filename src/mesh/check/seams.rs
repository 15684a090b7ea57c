//! Search for seams of the boundary that are open because vertices nearly coincide or lie on edges.

use super::hint::{Hint, OpenSeam, TJunction};
use crate::geometry::bounds::Bounds;
use crate::geometry::boxes::{BoundsNode, BoundsTree};
use crate::geometry::vector;
use crate::mesh::Point;
use crate::mesh::incidence::{Incidence, components, distinct, ends};
use crate::mesh::join::{join, repeats};
use crate::mesh::weld::coincident;
use std::collections::HashMap;

/// Largest gap of a seam as a share of the diagonal of the bounding box: ten roundings to single precision.
const NEAR: f64 = 1e-6;
/// Largest gap as a share of the shortest edge at either vertex, so that welding makes no face collapse.
const SHARE_OF_EDGE: f64 = 0.1;
/// Largest gap in steps of the lattice of coarse coordinates: one step in each of three coordinates.
const LATTICE_STEPS: f64 = 1.8;
/// Largest distance of a vertex from an edge, as a share of its length, where both ends of the edge have a near vertex: two meshes of one
/// curved seam with different steps are that far apart.
const BESIDE_EDGE: f64 = 0.05;
/// Smallest share of the edge between a T-junction and its ends; a nearer vertex belongs to the end.
const FROM_END: f64 = 0.01;
/// Most rounds of welding in a trial: each joins vertices that the last one brought near.
const ROUNDS: usize = 4;

/// The open seams and T-junctions of a list whose coordinates lie on a lattice of this step (0: none).
pub(super) fn seam_hints(
    positions: &[Point],
    faces: &[[u32; 3]],
    incidence: &Incidence,
    step: f64,
) -> Vec<Hint> {
    let Some(boundary) = BoundaryPoints::new(positions, faces, incidence, step) else { return Vec::new() };
    let near = boundary.near();
    let seam = if near.is_empty() { None } else { open_seam(&boundary, &near, incidence) };
    let junctions = boundary.t_junctions(&near);
    let seam = seam.map(Hint::OpenSeam).into_iter();
    seam.chain((!junctions.is_empty()).then_some(Hint::TJunctions(junctions))).collect()
}

/// The T-junctions of a list.
pub(in crate::mesh) fn t_junctions(positions: &[Point], faces: &[[u32; 3]]) -> Vec<TJunction> {
    let incidence = Incidence::new(positions.len(), faces);
    let step = super::lattice::lattice(positions, faces).map_or(0.0, |found| found.step);
    let boundary = BoundaryPoints::new(positions, faces, &incidence, step);
    boundary.map_or_else(Vec::new, |boundary| boundary.t_junctions(&boundary.near()))
}

/// A vertex of the boundary and the next one.
struct NearPair {
    vertices: [u32; 2],
    gap: f64,
}

/// The vertices and edges of the boundary, with finite positions.
struct BoundaryPoints<'a> {
    positions: &'a [Point],
    faces: &'a [[u32; 3]],
    diagonal: f64,
    /// Largest gap.
    limit: f64,
    vertices: Vec<u32>,
    /// The sides of the edges with one face.
    sides: Vec<u32>,
    /// For each vertex of the list its shortest edge.
    shortest: Vec<f64>,
}

impl<'a> BoundaryPoints<'a> {
    /// `None` without a boundary, and for positions all in one place.
    fn new(positions: &'a [Point], faces: &'a [[u32; 3]], incidence: &Incidence, step: f64) -> Option<Self> {
        let finite = |v: u32| positions[v as usize].iter().all(|x| x.is_finite());
        let is_finite = |side: u32| ends(faces, side).into_iter().all(finite);
        let sides = incidence.edges().filter(|sides| sides.len() == 1).map(|sides| sides[0]);
        let sides: Vec<u32> = sides.filter(|&side| is_finite(side)).collect();
        let mut vertices: Vec<u32> = sides.iter().flat_map(|&side| ends(faces, side)).collect();
        vertices.sort_unstable();
        vertices.dedup();
        let mut shortest = vec![f64::INFINITY; positions.len()];
        let mut all = Bounds::of([]);
        for side in incidence.edges().map(|sides| sides[0]).filter(|&side| is_finite(side)) {
            let [a, b] = ends(faces, side).map(|v| v as usize);
            let length = vector::distance(positions[a], positions[b]);
            shortest[a] = shortest[a].min(length);
            shortest[b] = shortest[b].min(length);
            all = all.union(Bounds::of([positions[a], positions[b]]));
        }
        let diagonal = vector::distance(all.low, all.high);
        let is_space = !vertices.is_empty() && diagonal > 0.0 && diagonal.is_finite();
        let limit = (NEAR * diagonal).max(LATTICE_STEPS * step);
        is_space.then_some(BoundaryPoints { positions, faces, diagonal, limit, vertices, sides, shortest })
    }

    fn at(&self, v: u32) -> Point {
        self.positions[v as usize]
    }

    /// The boundary vertices that have another one near, each with the next one.
    fn near(&self) -> Vec<NearPair> {
        let boxes: Vec<Bounds> = self.vertices.iter().map(|&v| Bounds::of([self.at(v)])).collect();
        let tree = BoundsTree::new(&boxes);
        let pair = |&v: &u32| {
            let mut next = NearPair { vertices: [v, v], gap: self.limit };
            let (p, widest) = (self.at(v), SHARE_OF_EDGE * self.shortest[v as usize]);
            visit(&tree, p, |found| match found {
                Visit::Node(distance) => distance <= next.gap && next.gap > 0.0,
                Visit::Box(k) => {
                    let w = self.vertices[k];
                    let gap = vector::distance(p, self.at(w));
                    let is_near = gap < widest && gap < SHARE_OF_EDGE * self.shortest[w as usize];
                    let is_next =
                        gap < next.gap || gap == next.gap && (next.vertices[1] == v || w < next.vertices[1]);
                    if w != v && is_near && is_next {
                        next = NearPair { vertices: [v, w], gap };
                    }
                    true
                }
            });
            (next.vertices[1] != v).then_some(next)
        };
        self.vertices.iter().filter_map(pair).collect()
    }

    /// The vertices that lie on an edge of another face which no edge there meets from end to end.
    fn t_junctions(&self, near: &[NearPair]) -> Vec<TJunction> {
        let places: Vec<Point> = self.vertices.iter().map(|&v| self.at(v)).collect();
        let gap = near.iter().map(|pair| pair.gap).fold(0.0, f64::max);
        // Vertices that nearly coincide have the number of the first of them.
        let mut first: Vec<u32> = (0..self.positions.len() as u32).collect();
        for (&v, k) in self.vertices.iter().zip(coincident(&places, gap)) {
            first[v as usize] = self.vertices[k as usize];
        }
        let mut has_near = vec![false; self.positions.len()];
        near.iter().for_each(|pair| has_near[pair.vertices[0] as usize] = true);
        let key = |side: u32| {
            let [a, b] = ends(self.faces, side).map(|v| first[v as usize]);
            [a.min(b), a.max(b)]
        };
        let mut meeting: HashMap<[u32; 2], u32> = HashMap::with_capacity(self.sides.len());
        self.sides.iter().for_each(|&side| *meeting.entry(key(side)).or_insert(0) += 1);
        let alone: Vec<u32> = self.sides.iter().copied().filter(|&side| meeting[&key(side)] == 1).collect();
        // How far from the edge a vertex may lie.
        let reach = |side: u32| {
            let [a, b] = ends(self.faces, side);
            let between = has_near[a as usize] && has_near[b as usize];
            let curved = BESIDE_EDGE * vector::distance(self.at(a), self.at(b));
            if between { curved.max(self.limit) } else { self.limit }
        };
        let boxes = alone
            .iter()
            .map(|&side| Bounds::of(ends(self.faces, side).map(|v| self.at(v))).widened(reach(side)));
        let boxes: Vec<Bounds> = boxes.collect();
        let mut found = Vec::new();
        if boxes.is_empty() {
            return found;
        }
        let tree = BoundsTree::new(&boxes);
        for &v in &self.vertices {
            let mut best: Option<TJunction> = None;
            visit(&tree, self.at(v), |at| match at {
                Visit::Node(distance) => distance <= 0.0,
                Visit::Box(k) => {
                    let reach = if has_near[v as usize] { self.limit } else { reach(alone[k]) };
                    let junction = self.junction(v, alone[k]).filter(|t| t.distance <= reach);
                    if let Some(t) =
                        junction.filter(|t| best.is_none_or(|b| (t.distance, t.face) < (b.distance, b.face)))
                    {
                        best = Some(t);
                    }
                    true
                }
            });
            found.extend(best);
        }
        found
    }

    /// A vertex beside the inner part of an edge that it does not belong to.
    fn junction(&self, v: u32, side: u32) -> Option<TJunction> {
        let (edge, face) = (ends(self.faces, side), side / 3);
        let [a, b] = edge.map(|w| self.at(w));
        let along = vector::sub(b, a);
        let length2 = vector::dot(along, along);
        let share = vector::dot(vector::sub(self.at(v), a), along) / length2;
        let inside = (FROM_END..=1.0 - FROM_END).contains(&share);
        if self.faces[face as usize].contains(&v) || !inside {
            return None;
        }
        let distance = vector::distance(self.at(v), vector::lerp(a, b, share));
        // Nearer to an end than to the edge is no place on the edge.
        let is_on = distance < SHARE_OF_EDGE * share.min(1.0 - share) * length2.sqrt();
        is_on.then_some(TJunction { vertex: v, edge, face, share, distance })
    }
}

/// A step of [`visit`].
enum Visit {
    /// The distance of a node; true to look into it.
    Node(f64),
    /// The number of a box in it.
    Box(usize),
}

/// Walks through the nodes of a tree that `look` wants to see, the nearer half first.
fn visit(tree: &BoundsTree, point: Point, mut look: impl FnMut(Visit) -> bool) {
    let mut open = vec![(tree.distance(0, point), 0)];
    while let Some((distance, node)) = open.pop() {
        if !look(Visit::Node(distance)) {
            continue;
        }
        match tree.node(node) {
            BoundsNode::Leaf(boxes) => {
                for &k in boxes {
                    look(Visit::Box(k as usize));
                }
            }
            BoundsNode::Inner(halves) => {
                let mut halves = halves.map(|half| (tree.distance(half, point), half));
                halves.sort_by(|a, b| b.0.total_cmp(&a.0));
                open.extend(halves);
            }
        }
    }
}

/// What welding of the near pairs does; `None` if it closes nothing.
fn open_seam(boundary: &BoundaryPoints<'_>, near: &[NearPair], incidence: &Incidence) -> Option<OpenSeam> {
    let (positions, faces) = (boundary.positions, boundary.faces);
    let widest = near.iter().max_by(|a, b| a.gap.total_cmp(&b.gap).then(b.vertices.cmp(&a.vertices)))?;
    let mut weld = rounded_up(widest.gap);
    let mut welded = weld_faces(positions, faces, weld);
    for _ in 0..ROUNDS {
        let after = Incidence::new(positions.len(), &welded);
        let Some(again) = BoundaryPoints::new(positions, &welded, &after, 0.0) else { break };
        let again = BoundaryPoints { limit: boundary.limit, ..again }.near();
        let Some(gap) = again.iter().map(|pair| pair.gap).filter(|gap| *gap > weld).reduce(f64::max) else {
            break;
        };
        weld = rounded_up(gap);
        welded = weld_faces(positions, faces, weld);
    }
    let n = positions.len();
    let after = Incidence::new(n, &welded);
    let open = |incidence: &Incidence| incidence.edges().filter(|sides| sides.len() == 1).count();
    let pieces = |incidence: &Incidence, faces: &[[u32; 3]]| components(n, incidence.triangles(faces)).len();
    let boundary_edges = [open(incidence), open(&after)];
    let seam = OpenSeam {
        vertices: near.len(),
        pair: widest.vertices,
        gap: widest.gap,
        share: widest.gap / boundary.diagonal,
        weld,
        boundary_edges,
        components: [pieces(incidence, faces), pieces(&after, &welded)],
        lost_faces: incidence.triangles(faces).count() - welded.len(),
    };
    (boundary_edges[1] < boundary_edges[0]).then_some(seam)
}

/// The faces that are left when vertices within a distance are one.
fn weld_faces(positions: &[Point], faces: &[[u32; 3]], weld: f64) -> Vec<[u32; 3]> {
    let sound = faces.iter().filter(|f| distinct(f) && f.iter().all(|&v| (v as usize) < positions.len()));
    let sound: Vec<[u32; 3]> = sound.copied().collect();
    let first = coincident(positions, weld);
    let joined: Vec<[u32; 3]> = match weld {
        0.0 => join(&sound, &first).0,
        _ => sound.iter().map(|f| f.map(|v| first[v as usize])).collect(),
    };
    let whole: Vec<[u32; 3]> = joined.into_iter().filter(distinct).collect();
    let again = repeats(&whole);
    whole.into_iter().zip(again).filter(|(_, again)| !again).map(|(face, _)| face).collect()
}

/// The least number of two digits that is not below a distance.
fn rounded_up(distance: f64) -> f64 {
    if distance <= 0.0 {
        return 0.0;
    }
    let exponent = distance.log10().floor() as i32;
    let tenths = (10.0 * distance / 10f64.powi(exponent)).floor().max(1.0) as u32;
    let mut numbers =
        (tenths.saturating_sub(1)..tenths + 3).filter_map(|k| format!("{k}e{}", exponent - 1).parse().ok());
    numbers.find(|&number: &f64| number >= distance).unwrap_or(2.0 * distance)
}

#[cfg(test)]
mod tests {
    use super::rounded_up;

    #[test]
    fn distances_are_rounded_up_to_two_digits() {
        for (distance, rounded) in
            [(2.449e-16, 2.5e-16), (1e-7, 1e-7), (9.99e-3, 1e-2), (0.0, 0.0), (3.0, 3.0), (1.01, 1.1)]
        {
            assert_eq!(rounded_up(distance), rounded);
        }
    }
}
