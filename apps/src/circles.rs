//! The circle pattern of a layout: vertex circles, and per face the circle orthogonal to its three.
//!
//! A vertex circle has its vertex as centre and radius γ (of a circle of imaginary radius, ε = −1, its modulus). The dual
//! circle of a face is centred at the power centre of the vertex circles; `power` is its squared radius, and `radius` is
//! null where that is negative.

use ricci::embed::Layout;
use ricci::geometry::circle::power_circle;
use ricci::mesh::Mesh;
use ricci::metric::Metric;
use serde::Serialize;

#[derive(Serialize)]
pub struct VertexCircle {
    /// Vertex of the layout: the index of its texture coordinate, from 0.
    pub uv: usize,
    /// Vertex of the surface.
    pub vertex: u32,
    pub epsilon: i8,
    pub center: [f64; 2],
    pub radius: f64,
}

#[derive(Serialize)]
pub struct DualCircle {
    pub face: usize,
    pub center: [f64; 2],
    pub power: f64,
    pub radius: Option<f64>,
}

/// All circles, in the coordinates of the layout.
#[derive(Serialize)]
pub struct Circles {
    pub space: &'static str,
    pub scheme: &'static str,
    pub vertex_circles: Vec<VertexCircle>,
    /// A face whose image has no area has no dual circle.
    pub dual_circles: Vec<DualCircle>,
}

/// The circles of a Euclidean metric laid out; `scale` is the layout's length over the metric's.
pub fn circles(mesh: &Mesh, metric: &Metric, scheme: &'static str, layout: &Layout, scale: f64) -> Circles {
    let gamma = metric.radii();
    let mut vertex_of = vec![None; layout.coordinates.len()];
    for h in mesh.halfedges() {
        vertex_of[layout.corner_index[h] as usize] = Some(mesh.origin(h));
    }
    let vertex_circle = |(uv, v): (usize, Option<_>)| {
        let v: ricci::mesh::VertexId = v?;
        let (epsilon, center, radius) = (metric.epsilon[v], layout.coordinates[uv], scale * gamma[v]);
        Some(VertexCircle { uv, vertex: v.0, epsilon, center, radius })
    };
    let dual_circle = |f| {
        let corners = mesh.face_vertices(f);
        let circle = power_circle(
            layout.face_uv(mesh, f),
            corners.map(|v| metric.epsilon[v]),
            corners.map(|v| scale * gamma[v]),
        )?;
        let radius = (circle.power >= 0.0).then(|| circle.power.sqrt());
        Some(DualCircle { face: f.index(), center: circle.center, power: circle.power, radius })
    };
    Circles {
        space: metric.space.name(),
        scheme,
        vertex_circles: vertex_of.into_iter().enumerate().filter_map(vertex_circle).collect(),
        dual_circles: mesh.faces().filter_map(dual_circle).collect(),
    }
}
