//! The circle pattern of a layout in the plane: vertex circles, and per face the circle orthogonal to its three.
//!
//! ```
//! use ricci::embed::{CirclePattern, Layout, LayoutOptions};
//! use ricci::flow::{Options, flow};
//! use ricci::{Class, Control, Surface, Target, geometry::Space, mesh::shapes};
//! let disk = Surface::from_soup(&shapes::disk(4)?)?;
//! let (class, control) = (Class::inversive(Space::E2), Control::new());
//! let flat = flow(disk, class, &Target::Boundary, &Options::default(), &control)?;
//! let layout = Layout::of_solution(&flat, &LayoutOptions::default(), &control)?;
//! let pattern = CirclePattern::new(&layout, flat.mesh(), flat.metric())?;
//! assert_eq!(pattern.vertex_circles.len(), flat.given().n_vertices());
//! # Ok::<(), ricci::Error>(())
//! ```

use super::layout::Layout;
use crate::error::{Error, Result};
use crate::geometry::Space;
use crate::geometry::circle::{PowerCircle, power_circle};
use crate::mesh::{FaceId, Mesh, VertexId};
use crate::metric::Metric;
use std::collections::BTreeMap;

/// The circle of a vertex in a layout.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VertexCircle {
    /// The index of its centre in [`Layout::coordinates`]. A vertex on a seam has a circle for each of its places.
    pub point: usize,
    /// The vertex.
    pub vertex: VertexId,
    /// The type of the circle: 1 for a real one, 0 for a point, −1 for one of imaginary radius.
    pub epsilon: i8,
    /// The centre.
    pub centre: [f64; 2],
    /// The modulus of the radius γ; a point has a γ too, which its circle is not drawn with.
    pub radius: f64,
}

/// All circles of a layout, in its coordinates.
#[derive(Debug, Clone, PartialEq)]
pub struct CirclePattern {
    /// Per point of the layout that is a vertex of the given surface, its circle.
    pub vertex_circles: Vec<VertexCircle>,
    /// Per face of the metric's triangulation, the circle orthogonal to the circles of its vertices. A face whose image has no area
    /// has none.
    pub dual_circles: Vec<(FaceId, PowerCircle)>,
}

impl CirclePattern {
    /// The circles of a metric in its layout in the plane. `mesh`: the triangulation of the metric.
    ///
    /// # Errors
    /// [`Error::Layout`] for a layout in another space than E²; those of [`Metric::radii`].
    pub fn new(layout: &Layout, mesh: &Mesh, metric: &Metric) -> Result<CirclePattern> {
        if layout.space != Space::E2 {
            return Err(Error::Layout(format!("the circles of a layout lie in e2, not in {}", layout.space)));
        }
        let (gamma, scale) = (metric.radii()?, layout.scale);
        let n_given = layout.common_subdivision().map_or(mesh.n_vertices(), |r| r.n_vertices[0]);
        let laid = layout.mesh();
        let mut vertex_of = vec![None; layout.coordinates.len()];
        for h in laid.halfedges().filter(|&h| laid.origin(h).index() < n_given) {
            vertex_of[layout.corner_index[h] as usize] = Some(laid.origin(h));
        }
        let vertex_circle = |(point, v): (usize, Option<VertexId>)| {
            let vertex = v?;
            let (epsilon, radius) = (metric.epsilon[vertex], scale * gamma[vertex]);
            Some(VertexCircle { point, vertex, epsilon, centre: layout.coordinates[point], radius })
        };
        let dual_circle = |(f, uv): (FaceId, [[f64; 2]; 3])| {
            let corners = mesh.face_vertices(f);
            let epsilon = corners.map(|v| metric.epsilon[v]);
            Some((f, power_circle(uv, epsilon, corners.map(|v| scale * gamma[v]))?))
        };
        Ok(CirclePattern {
            vertex_circles: vertex_of.into_iter().enumerate().filter_map(vertex_circle).collect(),
            dual_circles: final_faces(layout).into_iter().filter_map(dual_circle).collect(),
        })
    }
}

/// The faces of the metric's triangulation where they lie in the layout. A face that is laid out in pieces of a subdivision is found from
/// its largest piece.
fn final_faces(layout: &Layout) -> Vec<(FaceId, [[f64; 2]; 3])> {
    let mesh = layout.mesh();
    let Some(subdivision) = layout.common_subdivision() else {
        return mesh.faces().map(|f| (f, layout.face_uv(f))).collect();
    };
    let mut largest: BTreeMap<FaceId, (f64, FaceId)> = BTreeMap::new();
    for piece in mesh.faces() {
        let share = determinant(subdivision.barycentric(1, piece)).abs();
        let best = largest.entry(subdivision.faces[1][piece]).or_insert((0.0, piece));
        if share > best.0 {
            *best = (share, piece);
        }
    }
    let corners = |(f, (share, piece)): (FaceId, (f64, FaceId))| {
        let (weights, uv) = (subdivision.barycentric(1, piece), layout.face_uv(piece));
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
