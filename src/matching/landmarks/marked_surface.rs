//! A surface with its marks: the landmarks inside it, its boundary loops, and the corners of its boundary.

use crate::mesh::{HalfedgeId, Mesh, VertexId};
use crate::metric::Surface;

/// The landmarks inside a surface and its boundary loops, numbered: first the landmarks, then the loops; and the corners of the boundary.
#[derive(Debug, Clone)]
pub(crate) struct Marks {
    pub landmarks: Vec<VertexId>,
    /// The loops as half-edges of faces, the surface on the left.
    pub loops: Vec<Vec<HalfedgeId>>,
    /// Vertices of loops at which the boundary gets an angle: landmarks on it, and the corners of a disk.
    pub corners: Vec<VertexId>,
}

/// A surface with its marks.
#[derive(Clone, Copy)]
pub(crate) struct MarkedSurface<'a> {
    pub surface: &'a Surface,
    pub marks: &'a Marks,
}

impl Marks {
    /// The number of landmarks and loops.
    pub fn n(&self) -> usize {
        self.landmarks.len() + self.loops.len()
    }

    /// The vertices of a mark: one, or those of a loop.
    pub fn vertices(&self, mesh: &Mesh, k: usize) -> Vec<VertexId> {
        match self.landmarks.get(k) {
            Some(&v) => vec![v],
            None => self.loops[k - self.landmarks.len()].iter().map(|&h| mesh.origin(h)).collect(),
        }
    }

    /// The name of a mark in messages.
    pub fn name(&self, k: usize) -> String {
        match self.landmarks.get(k) {
            Some(v) => format!("landmark {k} (vertex {v})"),
            None => format!("boundary loop {}", k - self.landmarks.len()),
        }
    }
}
