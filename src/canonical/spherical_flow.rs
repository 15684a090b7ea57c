//! Closed surfaces of genus 0 on the unit sphere by the flow in S² itself, which sends no vertex to infinity.
//!
//! ```
//! use ricci::canonical::flow_to_sphere;
//! use ricci::flow::{Method, Options};
//! use ricci::{Control, Surface, mesh::shapes, metric::Scheme};
//! let surface = Surface::from_soup(&shapes::icosphere(3)?)?;
//! let options = Options { method: Method::Gradient, ..Options::default() };
//! let sphere = flow_to_sphere(&surface, Scheme::Yamabe, None, &options, &Control::new())?;
//! assert!(sphere.report.converged());
//! assert!(sphere.positions.iter().all(|[x, y, z]| (x * x + y * y + z * z - 1.0).abs() < 1e-14));
//! # Ok::<(), ricci::Error>(())
//! ```

use crate::archive::stored;
use crate::control::Control;
use crate::embed::{Layout, LayoutOpening, LayoutOptions};
use crate::error::{Error, Result};
use crate::flow::{Options, Report, Solution, flow};
use crate::geometry::Space;
use crate::mesh::{PerVertex, Point, VertexId};
use crate::metric::{Class, Scheme, Surface, Target};

/// A surface that has flowed to the unit sphere. Unlike a [`super::Sphere`] it is not moved so that its centre of mass is the sphere's
/// centre, and it need not be convex.
#[derive(Debug, Clone)]
pub struct FlowedSphere {
    /// The spherical metric, on the given triangulation.
    pub metric: Solution,
    /// How the flow ended.
    pub report: Report,
    /// The vertex that the layout starts at.
    pub root: VertexId,
    /// The spherical triangles, laid out from the root.
    pub layout: Layout,
    /// Unit vectors (V entries).
    pub positions: PerVertex<Point>,
}
stored!(sections FlowedSphere { metric, report, root, layout, positions });

/// The flow in S² to K = 0, and its metric laid out on the unit sphere from `root` (default: vertex 0).
///
/// # Errors
/// [`Error::Argument`] for a surface that is not closed of genus 0, or a root that is no vertex; those of [`flow()`] and [`Layout::of_solution`].
pub fn flow_to_sphere(
    surface: &Surface,
    scheme: Scheme,
    root: Option<VertexId>,
    options: &Options,
    control: &Control,
) -> Result<FlowedSphere> {
    let given = surface.mesh();
    if !given.is_closed() || given.euler() != 2 {
        let value = format!("of Euler characteristic {}", given.euler());
        return Err(Error::argument("surface", value, "one closed surface of genus 0"));
    }
    let class = Class::new(scheme, Space::S2);
    let metric = flow(surface.clone(), class, &Target::Uniform, options, control)?;
    let report =
        metric.report().cloned().ok_or_else(|| Error::Layout("the flow has left no report".into()))?;
    let mesh = metric.mesh();
    let root = root.unwrap_or(VertexId(0));
    let (opening, threads) = (LayoutOpening::MetricEdges, options.threads);
    let layout_options = LayoutOptions { opening, root: Some(root), threads, ..LayoutOptions::default() };
    let layout = Layout::of_solution(&metric, &layout_options, control)?;
    let mut positions = PerVertex::filled(mesh.n_vertices(), [0.0, 0.0, 1.0]);
    for h in mesh.halfedges().filter(|&h| !mesh.is_outside(h)) {
        positions[mesh.origin(h)] = layout.corner(h);
    }
    Ok(FlowedSphere { metric, report, root, layout, positions })
}
