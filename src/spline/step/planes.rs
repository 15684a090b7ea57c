//! Flat patches of a STEP file: those that lie in one plane and meet become one face of it.

use super::geometry::StepPlane;
use super::patches::{Side, StepPatch, StepPatches};
use crate::geometry::vector::{Vector, cross, dot, norm, scale, sub};
use std::collections::{BTreeMap, BTreeSet};

/// A face on a plane.
pub(super) struct FlatFace {
    pub plane: StepPlane,
    /// Its patches, ascending.
    pub patches: Vec<usize>,
    /// The sides along the way around: first the outer loop, then those of holes.
    pub loops: Vec<Vec<Side>>,
}

impl StepPlane {
    /// The plane of a patch, whose normal is that of the surface, if all its control points are within a distance of it.
    fn of_patch(patch: &StepPatch, within: f64) -> Option<StepPlane> {
        let net = &patch.surface.control_points;
        let [first, last] = [net.first()?, net.last()?];
        let [a, b, c, d] = [*first.first()?, *last.first()?, *last.last()?, *first.last()?];
        let across = cross(sub(c, a), sub(d, b));
        let size = norm(across);
        if size.is_nan() || size <= within * (norm(sub(c, a)) + norm(sub(d, b))) {
            return None;
        }
        let plane = StepPlane { origin: a, normal: scale(1.0 / size, across) };
        plane.holds(patch, within).then_some(plane)
    }

    /// True if all control points of a patch are within a distance of the plane.
    fn holds(&self, patch: &StepPatch, within: f64) -> bool {
        let is_near = |p: &Vector| dot(sub(*p, self.origin), self.normal).abs() <= within;
        patch.surface.control_points.iter().flatten().all(is_near)
    }
}

/// The faces on planes of patches whose control points are within a distance of one; those that meet and lie in the same plane are one face, unless
/// that would not be bounded by one loop around it and loops of holes.
pub(super) fn flat_faces(all: &StepPatches<'_>, within: f64) -> Vec<FlatFace> {
    let planes: Vec<Option<StepPlane>> =
        all.patches.iter().map(|patch| StepPlane::of_patch(patch, within)).collect();
    let beside = all.beside();
    let mut is_taken = vec![false; planes.len()];
    let mut faces = Vec::new();
    for seed in 0..planes.len() {
        let Some(plane) = planes[seed].filter(|_| !is_taken[seed]) else { continue };
        let mut patches = BTreeSet::from([seed]);
        let mut last = vec![seed];
        while let Some(at) = last.pop() {
            for (curve, _) in all.patches[at].sides {
                for &(other, _) in &beside[curve] {
                    let is_same = planes[other].is_some_and(|found| dot(found.normal, plane.normal) > 0.0)
                        && plane.holds(&all.patches[other], within);
                    if is_same && !is_taken[other] && patches.insert(other) {
                        last.push(other);
                    }
                }
            }
        }
        let whole = face_of(all, plane, &patches);
        let parts = match whole {
            Some(face) => vec![face],
            None => patches.iter().filter_map(|&p| face_of(all, planes[p]?, &BTreeSet::from([p]))).collect(),
        };
        patches.iter().for_each(|&p| is_taken[p] = true);
        faces.extend(parts);
    }
    faces
}

/// The face of these patches, if it is bounded by one loop around it and loops of holes.
fn face_of(all: &StepPatches<'_>, plane: StepPlane, patches: &BTreeSet<usize>) -> Option<FlatFace> {
    let sides: Vec<Side> = patches.iter().flat_map(|&p| all.patches[p].sides).collect();
    let mut count: BTreeMap<usize, usize> = BTreeMap::new();
    sides.iter().for_each(|(curve, _)| *count.entry(*curve).or_default() += 1);
    let ends = |(curve, reversed): Side| {
        let [a, b] = all.curves[curve].ends;
        if reversed { [b, a] } else { [a, b] }
    };
    // Where two sides of the boundary begin, the face touches itself.
    let mut from: BTreeMap<u32, Side> = BTreeMap::new();
    for side in sides.into_iter().filter(|(curve, _)| count[curve] == 1) {
        if from.insert(ends(side)[0], side).is_some() {
            return None;
        }
    }
    let mut loops = Vec::new();
    while let Some((start, first)) = from.pop_first() {
        let mut around = vec![first];
        let mut at = ends(first)[1];
        while at != start {
            let side = from.remove(&at)?;
            around.push(side);
            at = ends(side)[1];
        }
        loops.push(around);
    }
    let areas: Vec<f64> = loops.iter().map(|around| area(all, plane, around)).collect();
    let outer = areas.iter().position(|&area| area > 0.0)?;
    let is_plain = areas.iter().filter(|&&area| area > 0.0).count() == 1;
    let is_largest = areas.iter().all(|area| area.abs() <= areas[outer]);
    if !(is_plain && is_largest) {
        return None;
    }
    loops.swap(0, outer);
    Some(FlatFace { plane, patches: patches.iter().copied().collect(), loops })
}

/// Twice the area inside the control points along a loop, counterclockwise around the normal.
fn area(all: &StepPatches<'_>, plane: StepPlane, around: &[Side]) -> f64 {
    let mut points: Vec<Vector> = Vec::new();
    for &(curve, reversed) in around {
        let mut along = all.curves[curve].curve.control_points.clone();
        if reversed {
            along.reverse();
        }
        points.extend(along);
    }
    let next = points.iter().cycle().skip(1);
    let about = |p: &Vector| sub(*p, plane.origin);
    points.iter().zip(next).map(|(p, q)| dot(cross(about(p), about(q)), plane.normal)).sum()
}
