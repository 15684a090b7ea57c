//! The layout of a flat metric with what is said about it.

use crate::charts::Packed;
use crate::failure::Failure;
use crate::input::Input;
use ricci::Control;
use ricci::control::Stage;
use ricci::embed::{Layout, Quality, layout_of, quality};
use ricci::geometry::Space;
use ricci::geometry::modulus::modulus;
use ricci::mesh::{Mesh, PerVertex, VertexId};
use ricci::metric::curvature::area;
use ricci::metric::{Curvature, Metric};
use ricci::topology::cut_graph;

/// An interior vertex with more target curvature than this is a cone, and the cut passes it. Left inside, the vertex opens
/// the layout by an angle of that size, which is below what the flow's tolerance leaves open anyway.
const CONE: f64 = 1e-12;
/// Rounding of one step of the development: a unit direction and a point are rotated and added, a few ulp each.
const STEP_ROUNDING: f64 = 4.0 * f64::EPSILON;

/// A layout scaled to the area of the input.
pub struct Laid {
    pub layout: Layout,
    /// The layout in charts, where that was asked for.
    pub packed: Option<Packed>,
    pub quality: Quality,
    /// Lengths in the layout over lengths in the metric.
    pub scale: f64,
    /// τ of a flat torus.
    pub modulus: Option<[f64; 2]>,
    /// What the curvature errors and rounding allow the development to be off, relative to the layout's diameter.
    pub consistency_limit: f64,
}

/// Lay a metric out, or say why it has no layout.
pub fn lay_out(
    input: &Input,
    mesh: &Mesh,
    metric: &Metric,
    curvature: &Curvature,
    target: &PerVertex<f64>,
    control: &Control,
) -> Result<Result<Laid, String>, Failure> {
    if metric.space != Space::E2 {
        return Ok(Err(format!("layouts in {} are not in this version", metric.space)));
    }
    if !curvature.broken.is_empty() {
        let n = curvature.broken.len();
        return Ok(Err(format!(
            "{n} triangles break the triangle inequality (the first is face {})",
            curvature.broken[0]
        )));
    }
    control.step(Stage::Layout, 0.0)?;
    let cones: Vec<VertexId> =
        mesh.vertices().filter(|&v| !mesh.is_boundary_vertex(v) && target[v].abs() > CONE).collect();
    let result = (|| {
        let cut = cut_graph(mesh, &metric.lengths(mesh)?, &cones)?;
        control.step(Stage::Layout, 0.3)?;
        let mut layout = layout_of(mesh, metric, &cut, control)?;
        let scale = layout.scale_to_area(mesh, area(&input.mesh, input.geometry, &input.lengths)?)?;
        control.step(Stage::Layout, 0.8)?;
        let quality = quality(mesh, &input.lengths, &layout)?;
        Ok((layout, scale, quality))
    })();
    let (layout, scale, quality) = match result {
        Ok(parts) => parts,
        Err(ricci::Error::Cancelled) => return Err(Failure::Cancelled),
        Err(error) => return Ok(Err(error.to_string())),
    };
    // A vertex with curvature error δ turns what lies beyond it by δ, which moves that by at most δ · diameter.
    let errors: f64 = curvature.at.iter().zip(target).map(|(k, t)| (k - t).abs()).sum();
    let consistency_limit = errors + STEP_ROUNDING * mesh.n_faces() as f64;
    let flat_torus = mesh.is_closed() && mesh.euler() == 0 && cones.is_empty();
    let modulus = match layout.seams.as_slice() {
        // Any two of the two or three side pairings of the cut torus generate its lattice.
        [a, b, ..] if flat_torus => modulus([a.translation, b.translation]),
        _ => None,
    };
    Ok(Ok(Laid { layout, packed: None, quality, scale, modulus, consistency_limit }))
}

impl Laid {
    /// Largest disagreement between the layout and the metric or between the two sides of a seam, relative to the layout's
    /// diameter.
    pub fn consistency(&self) -> f64 {
        self.layout.seams.iter().map(|s| s.residual).fold(self.layout.consistency, f64::max)
    }
}
