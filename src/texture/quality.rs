//! How much an atlas stretches its model, and how long its seams are.

use super::flat_chart::FlatChart;
use crate::geometry::complex::doubled_area;
use crate::geometry::vector::{dot, norm, sub, triangle_normal};
use crate::mesh::Point;

/// The share of the area that the bound of the stretch leaves out.
const LEFT_OUT: f64 = 0.01;
/// A face whose area is a smaller multiple of its longest side² has no directions to stretch.
const THINNEST: f64 = 1e-9;

/// The figures of an atlas. Stretches are singular values of the maps of faces to the page, relative to the scale that keeps the total area;
/// means and shares are by area on the model.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct TextureQuality {
    /// The root of the mean of (σ⁻² + τ⁻²)/2: by how much texels are larger on the model than evenly spread ones, 1 at best \[SSGH01\].
    pub stretch_l2: f64,
    /// The largest σ or 1/τ of a face, σ ≥ τ.
    pub stretch_max: f64,
    /// The value that max(σ, 1/τ) exceeds on a hundredth of the area.
    pub stretch_99: f64,
    /// The mean of the largest change of an angle between two directions of a face: 2 atan((σ − τ)/(σ + τ)), in degrees.
    pub angle_mean: f64,
    /// The value that this angle exceeds on a hundredth of the area, in degrees.
    pub angle_99: f64,
    /// The standard deviation of the logarithm of σ τ.
    pub log_area_deviation: f64,
    /// The length of the seams on the model, each once, over the root of its area.
    pub seam_length: f64,
    /// The share of the page that faces fill.
    pub fill: f64,
    /// Texels per unit of length on the model.
    pub texel_density: f64,
}

/// The map of a face.
#[derive(Clone, Copy)]
pub(super) struct FaceMap {
    /// The area on the model.
    pub area: f64,
    /// σ ≥ τ.
    pub singular: [f64; 2],
}

/// The map of a triangle; none for one without area.
pub(super) fn face_map([a, b, c]: [Point; 3], [p, q, r]: [[f64; 2]; 3]) -> Option<FaceMap> {
    let (u, v) = (sub(b, a), sub(c, a));
    let (length, doubled) = (norm(u), norm(triangle_normal([a, b, c])));
    let longest = dot(u, u).max(dot(v, v)).max(dot(sub(c, b), sub(c, b)));
    // Also of coordinates whose products are no numbers.
    let has_area = 0.5 * doubled > THINNEST * longest;
    if !has_area {
        return None;
    }
    let (x, y) = (dot(u, v) / length, doubled / length);
    let along = [0, 1].map(|k| (q[k] - p[k]) / length);
    let across = [0, 1].map(|k| (r[k] - p[k] - along[k] * x) / y);
    let square = |d: [f64; 2]| d[0] * d[0] + d[1] * d[1];
    let (e, g) = (square(along), square(across));
    let mixed = along[0] * across[0] + along[1] * across[1];
    // From the area in the plane, which has no rounding on the grid of an atlas.
    let det = doubled_area([p, q, r]).abs() / doubled;
    let sigma = (0.5 * (e + g) + (0.5 * (e - g)).hypot(mixed)).sqrt();
    (sigma > 0.0 && sigma.is_finite())
        .then(|| FaceMap { area: 0.5 * doubled, singular: [sigma, det / sigma] })
}

/// The stretch that a hundredth of a chart's area exceeds, at the scale that keeps its area.
pub(super) fn largest_stretch(chart: &FlatChart) -> f64 {
    let maps: Vec<FaceMap> = (0..chart.part.faces.len())
        .filter_map(|f| {
            face_map(chart.part.triangle(f), chart.part.corners[f].map(|v| chart.points[v as usize]))
        })
        .collect();
    let scale = scale(&maps);
    exceeded(&maps, |[sigma, tau]| (sigma / scale).max(scale / tau))
}

/// The scale that keeps the total area.
fn scale(maps: &[FaceMap]) -> f64 {
    let (flat, given) = maps
        .iter()
        .fold((0.0, 0.0), |(flat, given), m| (flat + m.area * m.singular[0] * m.singular[1], given + m.area));
    (flat / given).sqrt()
}

/// The value that is exceeded on a hundredth of the area; 1 without faces.
fn exceeded(maps: &[FaceMap], of: impl Fn([f64; 2]) -> f64) -> f64 {
    let mut values: Vec<(f64, f64)> = maps.iter().map(|m| (of(m.singular), m.area)).collect();
    values.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut left = LEFT_OUT * maps.iter().map(|m| m.area).sum::<f64>();
    for (value, area) in &values {
        left -= area;
        if left < 0.0 {
            return *value;
        }
    }
    values.last().map_or(1.0, |last| last.0)
}

impl TextureQuality {
    /// The length of a texel on the model.
    pub(super) fn texel_length(&self) -> f64 {
        if self.texel_density > 0.0 { 1.0 / self.texel_density } else { 0.0 }
    }

    /// Of the maps of faces to the unit square, with seams of a total length.
    pub(super) fn new(maps: &[FaceMap], seam_length: f64, page: u32) -> TextureQuality {
        let area: f64 = maps.iter().map(|m| m.area).sum();
        if area <= 0.0 {
            return TextureQuality::default();
        }
        let scale = scale(maps);
        let mean = |of: &dyn Fn(f64, f64) -> f64| {
            maps.iter().map(|m| m.area * of(m.singular[0] / scale, m.singular[1] / scale)).sum::<f64>() / area
        };
        let angle = |[sigma, tau]: [f64; 2]| 2.0 * ((sigma - tau) / (sigma + tau)).atan().to_degrees();
        let middle = mean(&|s, t| (s * t).ln());
        let stretch = |[s, t]: [f64; 2]| (s / scale).max(scale / t);
        TextureQuality {
            stretch_l2: mean(&|s, t| 0.5 * (1.0 / (s * s) + 1.0 / (t * t))).sqrt(),
            stretch_max: maps.iter().map(|m| stretch(m.singular)).fold(1.0, f64::max),
            stretch_99: exceeded(maps, stretch),
            angle_mean: mean(&|s, t| angle([s, t])),
            angle_99: exceeded(maps, angle),
            log_area_deviation: mean(&|s, t| ((s * t).ln() - middle).powi(2)).sqrt(),
            seam_length: seam_length / area.sqrt(),
            fill: area * scale * scale,
            texel_density: scale * f64::from(page),
        }
    }
}
