//! The cocycle condition of an atlas, measured.

use super::overlaps::{FaceLifts, Transition};
use crate::geometry::worse;
use crate::mesh::FaceId;
use std::collections::BTreeSet;

/// The deviation of transitions from `T_jk T_ij = T_ik` where three charts overlap.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Cocycles {
    /// Number of different triples of transitions that were compared.
    pub triples: usize,
    /// The largest difference, see [`super::GroupElement::difference`].
    pub residual: f64,
}

/// Compares the transitions of every three lifts of a face, each triple of transitions once.
pub(super) fn cocycles(lifts: &FaceLifts, transitions: &[Transition], n_faces: usize) -> Cocycles {
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
    Cocycles { triples: seen.len(), residual }
}
