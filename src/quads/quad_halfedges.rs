//! Half-edges of a quad mesh: 4q + i leaves corner i of quad q, with the quad to its left.

use crate::error::{Error, Result};
use std::collections::BTreeMap;

/// The half-edges of quads that use no edge twice in the same direction.
pub(super) struct QuadHalfedges<'a> {
    quads: &'a [[u32; 4]],
    /// Per half-edge the one of the quad across; none on the boundary.
    twin: Vec<Option<usize>>,
}

impl<'a> QuadHalfedges<'a> {
    /// # Errors
    /// [`Error::Layout`] for quads that use an edge twice in the same direction.
    pub fn new(quads: &'a [[u32; 4]]) -> Result<QuadHalfedges<'a>> {
        let mut found: BTreeMap<[u32; 2], usize> = BTreeMap::new();
        for (q, quad) in quads.iter().enumerate() {
            for i in 0..4 {
                let side = [quad[i], quad[(i + 1) % 4]];
                if found.insert(side, 4 * q + i).is_some() {
                    return Err(Error::Layout(format!("quads use the edge {}–{} twice", side[0], side[1])));
                }
            }
        }
        let mut twin = vec![None; 4 * quads.len()];
        for (&[a, b], &h) in &found {
            twin[h] = found.get(&[b, a]).copied();
        }
        Ok(QuadHalfedges { quads, twin })
    }

    pub fn len(&self) -> usize {
        self.twin.len()
    }

    pub fn twin(&self, h: usize) -> Option<usize> {
        self.twin[h]
    }

    pub fn next(&self, h: usize) -> usize {
        h - h % 4 + (h + 1) % 4
    }

    pub fn origin(&self, h: usize) -> u32 {
        self.quads[h / 4][h % 4]
    }

    pub fn tip(&self, h: usize) -> u32 {
        self.origin(self.next(h))
    }

    /// The half-edge that goes straight on at a vertex of four quads, or along the boundary at one of two.
    pub fn straight(&self, h: usize) -> Option<usize> {
        let left = self.next(h);
        self.twin[left].map(|across| self.next(across))
    }
}
