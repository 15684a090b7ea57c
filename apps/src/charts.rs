//! Layouts cut into charts: `ricci flow --charts`.

use crate::failure::Failure;
use crate::job::FlowOutcome;
use crate::report::{PhaseSeconds, timed};
use crate::surface_layout::PackedCharts;
use ricci::Control;
use ricci::embed::ChartOptions;
use ricci::geometry::triangle_overlap::{TriangleCorners, overlapping};
use ricci::mesh::FaceId;

/// Cut the layout of an outcome into charts, if it has one.
pub fn cut(
    outcome: &mut FlowOutcome,
    margin: f64,
    seconds: &mut PhaseSeconds,
    control: &Control,
) -> Result<(), Failure> {
    let Ok(laid) = &mut outcome.layout else { return Ok(()) };
    let packed = timed(&mut seconds.layout, || -> ricci::Result<PackedCharts> {
        let mesh = laid.mesh();
        let charts = ricci::embed::charts(mesh, |h| laid.corner_uv(h), &ChartOptions { margin }, control)?;
        let counts = |f: &FaceId| charts.degenerate.binary_search(f).is_err();
        let triangles: Vec<TriangleCorners> =
            mesh.faces().filter(counts).map(|f| charts.face_uv(mesh, f)).collect();
        Ok(PackedCharts { overlapping: overlapping(&triangles, control)?.len(), charts })
    })?;
    laid.degenerate.extend(&packed.charts.degenerate);
    laid.degenerate.sort_unstable();
    laid.degenerate.dedup();
    laid.packed = Some(packed);
    Ok(())
}
