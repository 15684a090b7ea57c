//! Holes that a domain is made with: that around a vertex at infinity, with the vertices of the surface in it, and planned ones.

use crate::geometry::complex::Complex;
use crate::mesh::VertexId;
use crate::spline::{Hole, Parameter};
use std::collections::HashMap;

/// The hole around infinity, and the vertices of the surface beyond the triangles.
#[derive(Debug, Clone)]
pub(super) struct InfinityHole {
    pub hole: Hole,
    /// The coordinates of these vertices in the chart of the hole.
    pub beyond: HashMap<VertexId, Complex>,
}

impl InfinityHole {
    /// The place of a vertex beyond the triangles; none for others.
    pub fn place(&self, v: VertexId) -> Option<Parameter> {
        let &[x, y] = self.beyond.get(&v)?;
        Some(Parameter { patch: self.hole.chart, x, y })
    }
}

/// A hole around a singular vertex, as it is planned.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct BareHole {
    /// Its radius in the unit of the flat metric.
    pub radius: f64,
    /// The number of vertices of the surface in it.
    pub inside: usize,
}
