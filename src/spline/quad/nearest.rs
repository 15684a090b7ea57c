//! The places of patches that are nearest to the vertices of a target: parts of it that no place of a patch has as its foot, as the tip of
//! a limb, are seen from there only.

use super::layout::PatchCorner;
use super::spline::QuadSpline;
use super::target::{SplineTarget, TargetVertex};
use crate::geometry::triangle_tree::TriangleTree;
use crate::geometry::vector::{Vector, distance, dot, sub};
use crate::parallel;
use crate::spline::triangular::SurfacePoint;
use std::collections::BTreeMap;

/// Parts of a side of a patch between which triangles are laid to find nearest places.
const PARTS: usize = 16;
/// Steps towards the nearest place of a patch.
const STEPS: usize = 4;
/// Parameters by which a nearer place has to be beyond a side to be counted there.
const BEYOND: f64 = 1e-9;
/// Squared sine of the angle between parameter lines below which they have no common tangent plane.
const PARALLEL: f64 = 1e-12;

/// A vertex of a target with the place of a patch that is nearest to it.
#[derive(Debug, Clone, Copy)]
pub(super) struct NearestToVertex {
    pub vertex: TargetVertex,
    /// The unit normal of the target there.
    pub normal: Vector,
    pub parameters: [f64; 2],
}

/// A place found for a vertex of a piece.
struct FoundPlace {
    distance: f64,
    patch: usize,
    at: NearestToVertex,
}

/// Per patch the vertices of the target that are nearer to it than to the other patches of their pieces. `pieces`: that of each patch; `at`: the
/// patches.
pub(super) fn vertex_places(
    target: &SplineTarget,
    pieces: &[usize],
    at: &(dyn Fn(usize, [f64; 2]) -> Vector + Sync),
) -> Vec<Vec<NearestToVertex>> {
    let mut patches: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    pieces.iter().enumerate().for_each(|(patch, &piece)| patches.entry(piece).or_default().push(patch));
    let groups: Vec<(usize, Vec<usize>)> = patches.into_iter().collect();
    let found = parallel::map(groups.len(), |k| places_of_piece(target, groups[k].0, &groups[k].1, at));
    let mut best: BTreeMap<u32, FoundPlace> = BTreeMap::new();
    for place in found.into_iter().flatten() {
        let number = place.at.vertex.number;
        let is_nearer = |before: &FoundPlace| (place.distance, place.patch) < (before.distance, before.patch);
        if best.get(&number).is_none_or(is_nearer) {
            best.insert(number, place);
        }
    }
    let mut of_patch = vec![Vec::new(); pieces.len()];
    best.into_values().for_each(|place| of_patch[place.patch].push(place.at));
    of_patch
}

/// The places of these patches that are nearest to the vertices of their piece.
fn places_of_piece(
    target: &SplineTarget,
    piece: usize,
    patches: &[usize],
    at: &(dyn Fn(usize, [f64; 2]) -> Vector + Sync),
) -> Vec<FoundPlace> {
    let mut corners = Vec::with_capacity(2 * PARTS * PARTS * patches.len());
    for &patch in patches {
        let along = |k: usize| k as f64 / PARTS as f64;
        let row =
            |i: usize| -> Vec<Vector> { (0..=PARTS).map(|j| at(patch, [along(i), along(j)])).collect() };
        let grid = parallel::map(PARTS + 1, row);
        for [i, j] in square_cells() {
            let halves = halves([i, j]).map(|cell| cell.map(|[k, l]| grid[k][l]));
            corners.extend(halves);
        }
    }
    let tree = TriangleTree::new(corners);
    let vertices = target.vertices_of(piece);
    parallel::map(vertices.len(), |k| {
        let (vertex, normal) = vertices[k];
        let nearest = tree.nearest(vertex.point);
        let (patch, within) =
            (nearest.triangle / (2 * PARTS * PARTS), nearest.triangle % (2 * PARTS * PARTS));
        let cell = halves([within / 2 / PARTS, within / 2 % PARTS])[within % 2];
        let parameters = [0, 1]
            .map(|x| (0..3).map(|c| nearest.weights[c] * cell[c][x] as f64).sum::<f64>() / PARTS as f64);
        let parameters = parameters.map(|x| x.clamp(0.0, 1.0));
        let at = NearestToVertex { vertex, normal, parameters };
        FoundPlace { distance: nearest.distance, patch: patches[patch], at }
    })
}

/// The cells into which a patch is divided.
fn square_cells() -> impl Iterator<Item = [usize; 2]> {
    (0..PARTS).flat_map(|i| (0..PARTS).map(move |j| [i, j]))
}

/// The corners of both halves of a cell, in parts of the sides.
fn halves([i, j]: [usize; 2]) -> [[[usize; 2]; 3]; 2] {
    let [a, b, c, d] = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]];
    [[a, b, c], [a, c, d]]
}

impl NearestToVertex {
    /// True if a nearer place is beyond a side of the patch, in a patch that continues the surface smoothly: seen from the side alone, the vertex
    /// is farther off than it is.
    pub fn is_beyond(&self, spline: &QuadSpline, patch: usize) -> bool {
        let Some(whole) = self.whole_step(&spline.at(patch, self.parameters)) else { return false };
        let beyond = [-whole[1], whole[0] - 1.0, whole[1] - 1.0, -whole[0]];
        let layout = spline.space().layout();
        (0..4).any(|corner| {
            beyond[corner] > BEYOND && layout.smooth_neighbour(PatchCorner { patch, corner }).is_some()
        })
    }

    /// The parameters after a step of Gauss and Newton from this point of the place, in the patch or not; none without a tangent plane.
    fn whole_step(&self, at: &SurfacePoint) -> Option<[f64; 2]> {
        let to = sub(self.vertex.point, at.point);
        let [by_u, by_v] = at.first;
        let [a, b, c] = [dot(by_u, by_u), dot(by_u, by_v), dot(by_v, by_v)];
        let [p, q] = [dot(by_u, to), dot(by_v, to)];
        let determinant = a * c - b * b;
        let [u, v] = self.parameters;
        let whole = || [u + (c * p - b * q) / determinant, v + (a * q - b * p) / determinant];
        (determinant > PARALLEL * a * c).then(whole)
    }

    /// The place moved to the nearest one of its patch, by steps of Gauss and Newton as long as they come nearer.
    pub fn nearer(self, spline: &QuadSpline, patch: usize) -> NearestToVertex {
        let mut best = self;
        let mut at = spline.at(patch, best.parameters);
        for _ in 0..STEPS {
            let Some(whole) = best.whole_step(&at) else { break };
            let to = sub(self.vertex.point, at.point);
            let [by_u, by_v] = at.first;
            let [a, b, c] = [dot(by_u, by_u), dot(by_u, by_v), dot(by_v, by_v)];
            let [p, q] = [dot(by_u, to), dot(by_v, to)];
            let [u, v] = best.parameters;
            let mut moved = whole.map(|x| x.clamp(0.0, 1.0));
            // On a side of the patch the other parameter goes to the nearest place of that side.
            if moved[0] != whole[0] && moved[1] == whole[1] {
                moved[1] = (v + (q - b * (moved[0] - u)) / c).clamp(0.0, 1.0);
            } else if moved[1] != whole[1] && moved[0] == whole[0] {
                moved[0] = (u + (p - b * (moved[1] - v)) / a).clamp(0.0, 1.0);
            }
            let next = spline.at(patch, moved);
            if distance(next.point, self.vertex.point) >= distance(at.point, self.vertex.point) {
                break;
            }
            (best.parameters, at) = (moved, next);
        }
        best
    }
}
