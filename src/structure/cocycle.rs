//! How far transitions of charts that overlap in threes are from `T_jk T_ij = T_ik`.

use super::overlaps::{FaceLifts, Transition};
use crate::archive::stored;
use crate::geometry::worse;
use crate::mesh::FaceId;
use std::collections::BTreeSet;

/// The deviation of transitions from `T_jk T_ij = T_ik` where three charts overlap.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CocycleCheck {
    /// Number of different triples of transitions that were compared.
    pub triples: usize,
    /// The largest difference, see [`super::GroupElement::difference`]; infinite if two transitions cannot be composed.
    pub residual: f64,
}
stored!(sections CocycleCheck { triples, residual });

/// For every face and every three charts that contain it; each triple of transitions is compared once.
pub(super) fn check_cocycle_condition(
    lifts: &FaceLifts,
    transitions: &[Transition],
    n_faces: usize,
) -> CocycleCheck {
    let (mut seen, mut residual) = (BTreeSet::new(), 0.0);
    for f in (0..n_faces).map(FaceId::from) {
        let n = lifts.of(f).len();
        for i in 0..n {
            for j in i + 1..n {
                for k in j + 1..n {
                    let triple = [(i, j), (j, k), (i, k)].map(|(a, b)| lifts.transition(f, a, b));
                    if seen.insert(triple) {
                        let [first, second, whole] = triple.map(|t| &transitions[t as usize].element);
                        let off = second.after(first).map_or(f64::INFINITY, |both| both.difference(whole));
                        residual = worse(residual, off);
                    }
                }
            }
        }
    }
    CocycleCheck { triples: seen.len(), residual }
}
