//! Cones placed by the library, and layouts cut into charts.

use crate::failure::Failure;
use crate::input::Input;
use crate::job::Outcome;
use crate::laid::{Laid, Packed};
use crate::report::timed;
use ricci::Control;
use ricci::embed::ChartOptions;
use ricci::embed::overlap::{Triangle, overlapping};
use ricci::flow::auto_cones;
use ricci::geometry::Space;
use ricci::mesh::{FaceId, HalfedgeId, Mesh, PerHalfedge, VertexId};
use ricci::metric::Target;
use std::collections::BTreeMap;

/// The target `auto:N`.
pub fn auto_target(n: usize, input: &Input, space: Space, control: &Control) -> Result<Target, Failure> {
    if space != Space::E2 || input.surface.geometry() != Space::E2 {
        return Err(Failure::Usage("--target auto: cones are placed in e2 only".into()));
    }
    let placed = auto_cones(input.mesh(), input.surface.lengths(), n, control)?.target;
    let curved = input.mesh().vertices().filter(|&v| placed[v] != 0.0);
    Ok(Target::Cones(curved.map(|v| (v, placed[v])).collect()))
}

/// Interior vertices that a list of cones names.
pub fn interior_cones(input: &Input, outcome: &Outcome) -> Option<Vec<(VertexId, f64)>> {
    let Target::Cones(cones) = &outcome.rule else { return None };
    Some(cones.iter().filter(|c| !input.mesh().is_boundary_vertex(c.0)).copied().collect())
}

/// Cut the layout of an outcome into charts, if it has one.
pub fn cut(outcome: &mut Outcome, margin: f64, control: &Control) -> Result<(), Failure> {
    let Ok(laid) = &mut outcome.layout else { return Ok(()) };
    let packed = timed(&mut outcome.seconds.layout, || -> ricci::Result<Packed> {
        let mesh = laid.mesh();
        let options = ChartOptions { margin };
        let charts = ricci::embed::charts(mesh, |h| laid.corner_uv(h), &options, control)?;
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

/// The layout as it is written and drawn: in charts where it was cut into them.
impl Laid {
    pub fn coordinates(&self) -> &[[f64; 2]] {
        self.packed.as_ref().map_or(&self.layout.coordinates, |packed| &packed.charts.coordinates)
    }

    pub fn corner_index(&self) -> &PerHalfedge<u32> {
        self.packed.as_ref().map_or(&self.layout.corner_index, |packed| &packed.charts.corner_index)
    }

    pub fn corner_uv(&self, h: HalfedgeId) -> [f64; 2] {
        self.coordinates()[self.corner_index()[h] as usize]
    }

    /// Half-edges of the cut with a number: that of their seam, beyond those one for each pair of charts.
    pub fn numbered_seams(&self, mesh: &Mesh) -> Vec<(HalfedgeId, usize)> {
        let mut numbered = self.seams();
        let n_seams = numbered.iter().map(|(_, k)| k + 1).max().unwrap_or(0);
        let Some(packed) = &self.packed else { return numbered };
        let mut own = packed.charts.is_seam.clone();
        numbered.iter().for_each(|(h, _)| own[h.edge()] = false);
        let mut pairs = BTreeMap::new();
        for h in mesh.edges().filter(|&e| own[e]).map(|e| e.halfedge()) {
            let sides = [h, h.twin()].map(|h| mesh.face(h).map(|f| packed.charts.chart[f]));
            let next = n_seams + pairs.len();
            numbered
                .push((h, *pairs.entry([sides[0].min(sides[1]), sides[0].max(sides[1])]).or_insert(next)));
        }
        numbered
    }
}
