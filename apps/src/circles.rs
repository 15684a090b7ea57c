//! The circle pattern of a layout: vertex circles, and per face the circle orthogonal to its three.
//!
//! A vertex circle has its vertex as centre and radius γ; where ε = −1 the radius is imaginary, and γ its modulus. The dual circle of
//! a face is centred at the power centre of the face's vertex circles; `power` is its squared radius, and `radius` is null where that
//! is negative.

use crate::laid::Laid;
use crate::solved::Solved;
use ricci::embed::Layout;
use ricci::geometry::Space;
use ricci::geometry::circle::power_circle;
use ricci::mesh::FaceId;
use serde::Serialize;
use std::collections::BTreeMap;

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

/// The circles of a Euclidean metric laid out in the plane.
pub fn circles(solved: &Solved, laid: &Laid) -> Option<Circles> {
    let (mesh, metric, layout) = (solved.solution.mesh(), solved.solution.metric(), &laid.layout);
    if layout.space != Space::E2 {
        return None;
    }
    let (gamma, scale) = (metric.radii().ok()?, layout.scale);
    let n_given = laid.refinement().map_or(mesh.n_vertices(), |r| r.n_input_vertices);
    let mut vertex_of = vec![None; layout.coordinates.len()];
    for h in laid.mesh().halfedges().filter(|&h| laid.mesh().origin(h).index() < n_given) {
        vertex_of[layout.corner_index[h] as usize] = Some(laid.mesh().origin(h));
    }
    let vertex_circle = |(uv, v): (usize, Option<_>)| {
        let v: ricci::mesh::VertexId = v?;
        let (epsilon, center, radius) = (metric.epsilon[v], layout.coordinates[uv], scale * gamma[v]);
        Some(VertexCircle { uv, vertex: v.0, epsilon, center, radius })
    };
    let dual_circle = |(f, uv): (FaceId, [[f64; 2]; 3])| {
        let corners = mesh.face_vertices(f);
        let circle = power_circle(uv, corners.map(|v| metric.epsilon[v]), corners.map(|v| scale * gamma[v]))?;
        let radius = (circle.power >= 0.0).then(|| circle.power.sqrt());
        Some(DualCircle { face: f.index(), center: circle.center, power: circle.power, radius })
    };
    Some(Circles {
        space: metric.space.name(),
        scheme: solved.scheme.name(),
        vertex_circles: vertex_of.into_iter().enumerate().filter_map(vertex_circle).collect(),
        dual_circles: final_faces(laid, layout).into_iter().filter_map(dual_circle).collect(),
    })
}

/// The faces of the metric's triangulation where they lie in the layout: those of a refinement are found from their largest piece.
fn final_faces(laid: &Laid, layout: &Layout) -> Vec<(FaceId, [[f64; 2]; 3])> {
    let mesh = laid.mesh();
    let Some(refinement) = laid.refinement() else {
        return mesh.faces().map(|f| (f, layout.face_uv(f))).collect();
    };
    let mut largest: BTreeMap<FaceId, (f64, FaceId)> = BTreeMap::new();
    for piece in mesh.faces() {
        let share = determinant(refinement.final_barycentric(piece)).abs();
        let best = largest.entry(refinement.final_face[piece]).or_insert((0.0, piece));
        if share > best.0 {
            *best = (share, piece);
        }
    }
    let corners = |(f, (share, piece)): (FaceId, (f64, FaceId))| {
        let (weights, uv) = (refinement.final_barycentric(piece), layout.face_uv(piece));
        (share > 0.0)
            .then(|| (f, [0, 1, 2].map(|c| [0, 1].map(|axis| solve(weights, uv.map(|p| p[axis]), c)))))
    };
    largest.into_iter().filter_map(corners).collect()
}

fn determinant([a, b, c]: [[f64; 3]; 3]) -> f64 {
    a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
}

/// Component `c` of the solution of `a x = b`, by Cramer's rule.
fn solve(a: [[f64; 3]; 3], b: [f64; 3], c: usize) -> f64 {
    let mut replaced = a;
    (0..3).for_each(|row| replaced[row][c] = b[row]);
    determinant(replaced) / determinant(a)
}
