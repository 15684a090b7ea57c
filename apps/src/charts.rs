//! Cones placed by the library, and layouts cut into charts.

use crate::failure::Failure;
use crate::input::Input;
use crate::job::Outcome;
use crate::laid::Packed;
use crate::report::timed;
use ricci::Control;
use ricci::embed::ChartOptions;
use ricci::embed::overlap::{Triangle, overlapping};
use ricci::flow::auto_cones;
use ricci::geometry::Space;
use ricci::mesh::FaceId;
use ricci::metric::Target;

/// The target `auto:N`.
pub fn auto_target(n: usize, input: &Input, space: Space, control: &Control) -> Result<Target, Failure> {
    if space != Space::E2 || input.surface.geometry() != Space::E2 {
        return Err(Failure::Usage("--target auto: cones are placed in e2 only".into()));
    }
    let placed = auto_cones(input.mesh(), input.surface.lengths(), n, control)?.target;
    let curved = input.mesh().vertices().filter(|&v| placed[v] != 0.0);
    Ok(Target::Cones(curved.map(|v| (v, placed[v])).collect()))
}

/// Cut the layout of an outcome into charts, if it has one.
pub fn cut(outcome: &mut Outcome, margin: f64, control: &Control) -> Result<(), Failure> {
    let Ok(laid) = &mut outcome.layout else { return Ok(()) };
    let packed = timed(&mut outcome.solved.seconds.layout, || -> ricci::Result<Packed> {
        let mesh = laid.mesh();
        let charts = ricci::embed::charts(mesh, |h| laid.corner_uv(h), &ChartOptions { margin }, control)?;
        let counts = |f: &FaceId| charts.degenerate.binary_search(f).is_err();
        let triangles: Vec<Triangle> = mesh.faces().filter(counts).map(|f| charts.face_uv(mesh, f)).collect();
        Ok(Packed { overlapping: overlapping(&triangles, control)?.len(), charts })
    })?;
    laid.degenerate.extend(&packed.charts.degenerate);
    laid.degenerate.sort_unstable();
    laid.degenerate.dedup();
    laid.packed = Some(packed);
    Ok(())
}
