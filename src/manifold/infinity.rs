//! What is around a vertex at infinity.

use crate::geometry::complex::Complex;
use crate::mesh::VertexId;
use crate::spline::{Hole, Parameter};
use std::collections::HashMap;

/// The hole around infinity, and the vertices of the surface that lie beyond the triangles.
#[derive(Debug, Clone)]
pub(super) struct Infinity {
    pub hole: Hole,
    /// Their places in the chart of the hole.
    pub beyond: HashMap<VertexId, Complex>,
}

impl Infinity {
    /// The place of a vertex beyond the triangles.
    pub fn place(&self, v: VertexId) -> Option<Parameter> {
        let &[x, y] = self.beyond.get(&v)?;
        Some(Parameter { patch: self.hole.chart, x, y })
    }
}
