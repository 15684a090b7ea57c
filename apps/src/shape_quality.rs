//! Figures of the shapes of a surface's triangles in a report.

use ricci::metric::ShapeQuality;
use serde::Serialize;

/// The figures of [`ShapeQuality`], with angles in degrees.
#[derive(Serialize, Debug, Clone, PartialEq)]
pub struct QualityFigures {
    pub area: f64,
    pub min_angle_degrees: Option<f64>,
    pub obtuse_fraction: Option<f64>,
    pub edge_ratio: Option<f64>,
    pub non_delaunay_fraction: Option<f64>,
}

impl From<ShapeQuality> for QualityFigures {
    fn from(quality: ShapeQuality) -> Self {
        QualityFigures {
            area: quality.area,
            min_angle_degrees: quality.min_angle.map(f64::to_degrees),
            obtuse_fraction: quality.obtuse_fraction,
            edge_ratio: quality.edge_ratio,
            non_delaunay_fraction: quality.non_delaunay_fraction,
        }
    }
}
