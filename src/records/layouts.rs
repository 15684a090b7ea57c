//! The records of layouts and of their charts.

use super::flows::MetricRecord;
use crate::archive::{Kept, stored};
use crate::embed::{Charts, Layout};
use crate::error::{Result, check_size};
use crate::geometry::Model;
use crate::mesh::Point;
use std::sync::Arc;

/// A layout with its metric.
#[derive(Debug, Clone)]
pub struct LayoutRecord {
    /// The metric that was laid out.
    pub metric: MetricRecord,
    /// The layout.
    pub layout: Layout,
    /// The model of the hyperbolic plane in which its points are asked for.
    pub model: Model,
}
stored!(sections LayoutRecord { metric, layout, model });

impl Kept for LayoutRecord {
    const KIND: &'static str = "layout";
}

/// A layout that was cut into charts, which were packed.
#[derive(Debug, Clone)]
pub struct ChartsRecord {
    /// The metric that was laid out.
    pub metric: MetricRecord,
    /// The layout.
    pub layout: Layout,
    /// The positions of its vertices; none of an intrinsic surface.
    pub positions: Option<Arc<Vec<Point>>>,
    /// The charts.
    pub charts: Charts,
}
stored!(sections ChartsRecord { metric, layout, positions, charts } check ChartsRecord::check_parts);

impl Kept for ChartsRecord {
    const KIND: &'static str = "charts";
}

impl ChartsRecord {
    /// Checks that the arrays fit the mesh of the layout.
    fn check_parts(&self) -> Result<()> {
        let mesh = self.layout.mesh();
        check_size("charts of faces", self.charts.chart.len(), mesh.n_faces())?;
        check_size("corners", self.charts.corner_index.len(), mesh.n_halfedges())?;
        check_size("seams", self.charts.is_seam.len(), mesh.n_edges())?;
        let positions = self.positions.as_ref();
        positions.map_or(Ok(()), |all| check_size("positions", all.len(), mesh.n_vertices()))
    }
}
