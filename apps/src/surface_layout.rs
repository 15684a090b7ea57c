//! The layout of a flow's metric on the surface as it was given, with its quality.

use crate::input::Input;
use crate::report::{PhaseSeconds, timed};
use ricci::Control;
use ricci::control::Stage;
use ricci::embed::{Charts, Layout, LayoutOptions, OnInput, Quality};
use ricci::flow::Solution;
use ricci::mesh::{FaceId, HalfedgeId, Mesh, PerHalfedge, PerVertex, Point, VertexId};
use ricci::metric::CommonSubdivision;
use ricci::parallel::{fill, within};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Most crossings per edge with which the common subdivision is formed even where only the summary shows it: it then takes no more time
/// than the flow.
const FEW_CROSSINGS: usize = 16;

/// True if a layout is to be carried back to the given triangulation: if an output needs that, or if it costs little.
pub fn is_carried_back(metric: &Solution, needed: bool) -> bool {
    needed || metric.crossings().is_ok_and(|n| n <= FEW_CROSSINGS * metric.mesh().n_edges())
}

/// The charts of a layout, packed.
pub struct PackedCharts {
    pub charts: Charts,
    /// The number of faces that overlap another one in the unit square, found from the written coordinates; degenerate faces are not
    /// counted.
    pub overlapping: usize,
}

/// A layout on the surface as it was given; in E² it is scaled to the area of the input.
pub struct SurfaceLayout {
    pub layout: Layout,
    /// The homogeneous weight q of each vertex of the layout's mesh: (q x, q y, q) is linear on its faces, with (x, y) the layout in E²
    /// \[SSP08, §3.4\].
    pub weight: PerVertex<f64>,
    /// The positions of the vertices of the layout's mesh.
    pub positions: Option<Vec<Point>>,
    /// The layout on the input's own faces, where its cut runs along their edges.
    pub on_input: Option<OnInput>,
    /// The layout cut into charts, where that was asked for.
    pub packed: Option<PackedCharts>,
    pub quality: Quality,
    /// The pieces of the subdivision whose image has almost no area, or the faces without area in the input or the layout; in charts also
    /// those that are smaller than the coordinates of the unit square resolve.
    pub degenerate: Vec<FaceId>,
    /// The modulus τ of a flat torus.
    pub modulus: Option<[f64; 2]>,
}

/// Unfold the metric of a flow and carry the layout back to the given surface.
pub fn lay_out(
    input: &Input,
    solution: &Solution,
    seconds: &mut PhaseSeconds,
    control: &Control,
) -> ricci::Result<SurfaceLayout> {
    control.step(Stage::Layout, 0.0)?;
    let mut subdivision = None;
    if !solution.is_unflipped() {
        subdivision = Some(Arc::new(timed(&mut seconds.refine, || solution.common_subdivision(control))?));
    }
    let options = LayoutOptions { subdivision, ..LayoutOptions::default() };
    timed(&mut seconds.layout, || {
        let layout = Layout::of_solution(solution, &options, control)?;
        within(solution.threads(), || SurfaceLayout::new(input, solution, layout))
    })
}

impl SurfaceLayout {
    /// A layout of a metric of the input.
    pub fn new(input: &Input, solution: &Solution, layout: Layout) -> ricci::Result<SurfaceLayout> {
        let quality = layout.quality(input.mesh(), input.surface.lengths())?;
        let on_input = layout.on_input();
        let given = input.positions();
        let (weight, positions, degenerate) = match layout.common_subdivision() {
            Some(r) => {
                let positions = given.map(|p| r.from_vertices(0, p)).transpose()?;
                (r.weight.clone(), positions, layout.degenerate.clone())
            }
            None => {
                let (before, after) = (&solution.initial().input_u, &solution.metric().u);
                let mut weight = vec![0.0; after.len()];
                fill(&mut weight, |v| (before[VertexId::from(v)] - after[VertexId::from(v)]).exp());
                (weight.into(), given.map(<[Point]>::to_vec), quality.degenerate.clone())
            }
        };
        Ok(SurfaceLayout {
            weight,
            positions,
            on_input,
            packed: None,
            degenerate,
            modulus: layout.modulus(),
            quality,
            layout,
        })
    }

    /// The mesh of the layout: the given triangulation, or its common subdivision with the final one.
    pub fn mesh(&self) -> &Mesh {
        self.layout.mesh()
    }

    /// The common subdivision, where edges were flipped.
    pub fn common_subdivision(&self) -> Option<&CommonSubdivision> {
        self.layout.common_subdivision().map(|r| &**r)
    }

    /// The homogeneous weights of the coordinates.
    pub fn weights(&self) -> Vec<f64> {
        let mut weights = vec![1.0; self.coordinates().len()];
        for h in self.mesh().halfedges() {
            weights[self.corner_index()[h] as usize] = self.weight[self.mesh().origin(h)];
        }
        weights
    }

    /// Triangles that are not counterclockwise.
    pub fn flipped(&self) -> &[FaceId] {
        &self.layout.flipped
    }

    /// The points of the layout as it is written and drawn: in charts where it was cut into them.
    pub fn coordinates(&self) -> &[[f64; 2]] {
        self.packed.as_ref().map_or(&self.layout.coordinates, |packed| &packed.charts.coordinates)
    }

    /// The point of the corner at each half-edge's origin.
    pub fn corner_index(&self) -> &PerHalfedge<u32> {
        self.packed.as_ref().map_or(&self.layout.corner_index, |packed| &packed.charts.corner_index)
    }

    pub fn corner_uv(&self, h: HalfedgeId) -> [f64; 2] {
        self.coordinates()[self.corner_index()[h] as usize]
    }

    pub fn face_uv(&self, f: FaceId) -> [[f64; 2]; 3] {
        self.mesh().face_halfedges(f).map(|h| self.corner_uv(h))
    }

    /// The half-edges on the left side of the cut with the numbers of their seams, and those between charts, with a further number for each
    /// pair of charts.
    pub fn seams(&self) -> Vec<(HalfedgeId, usize)> {
        let (mesh, segments) = (self.mesh(), &self.layout.cut.segments);
        let of_segment =
            |(k, segment): (usize, &Vec<HalfedgeId>)| -> Vec<_> { segment.iter().map(|&h| (h, k)).collect() };
        let mut numbered: Vec<_> = segments.iter().enumerate().flat_map(of_segment).collect();
        let Some(packed) = &self.packed else { return numbered };
        let mut between = packed.charts.is_seam.clone();
        numbered.iter().for_each(|(h, _)| between[h.edge()] = false);
        let mut pairs = BTreeMap::new();
        for h in mesh.edges().filter(|&e| between[e]).map(|e| e.halfedge()) {
            let [a, b] = [h, h.twin()].map(|h| mesh.face(h).map(|f| packed.charts.chart[f]));
            let next = segments.len() + pairs.len();
            numbered.push((h, *pairs.entry([a.min(b), a.max(b)]).or_insert(next)));
        }
        numbered
    }
}
