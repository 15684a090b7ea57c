//! The file of `ricci flow --circles`: the circle pattern of a layout.
//!
//! A vertex circle has its vertex as centre and radius γ; where ε = −1 the radius is imaginary, and γ its modulus. The dual circle of
//! a face is centred at the power centre of the face's vertex circles; `power` is its squared radius, and `radius` is null where that
//! is negative.

use crate::solved::SolvedMetric;
use crate::surface_layout::SurfaceLayout;
use ricci::embed::CirclePattern;
use serde::Serialize;

#[derive(Serialize)]
struct VertexCircleRow {
    /// Vertex of the layout: the index of its texture coordinate, from 0.
    uv: usize,
    /// Vertex of the surface.
    vertex: u32,
    epsilon: i8,
    #[serde(rename = "center")]
    centre: [f64; 2],
    radius: f64,
}

#[derive(Serialize)]
struct DualCircleRow {
    face: usize,
    #[serde(rename = "center")]
    centre: [f64; 2],
    power: f64,
    radius: Option<f64>,
}

/// All circles, in the coordinates of the layout.
#[derive(Serialize)]
pub struct CircleFile {
    space: &'static str,
    scheme: &'static str,
    vertex_circles: Vec<VertexCircleRow>,
    dual_circles: Vec<DualCircleRow>,
}

impl CircleFile {
    /// The circles of a Euclidean metric laid out in the plane; none where its radii are beyond numbers.
    pub fn new(solved: &SolvedMetric, laid: &SurfaceLayout) -> Option<CircleFile> {
        let (mesh, metric) = (solved.solution.mesh(), solved.solution.metric());
        let pattern = CirclePattern::new(&laid.layout, mesh, metric).ok()?;
        let vertex_circle = |c: &ricci::embed::VertexCircle| VertexCircleRow {
            uv: c.point,
            vertex: c.vertex.0,
            epsilon: c.epsilon,
            centre: c.centre,
            radius: c.radius,
        };
        let dual_circle =
            |(f, c): &(ricci::mesh::FaceId, ricci::geometry::circle::PowerCircle)| DualCircleRow {
                face: f.index(),
                centre: c.centre,
                power: c.power,
                radius: (c.power >= 0.0).then(|| c.power.sqrt()),
            };
        Some(CircleFile {
            space: metric.space.name(),
            scheme: solved.scheme.name(),
            vertex_circles: pattern.vertex_circles.iter().map(vertex_circle).collect(),
            dual_circles: pattern.dual_circles.iter().map(dual_circle).collect(),
        })
    }
}
