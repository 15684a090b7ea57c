//! The layout of a flow's metric on the surface as it was given, with its quality.

use crate::input::Input;
use crate::report::{Checks, PhaseSeconds, timed};
use ricci::Control;
use ricci::control::Stage;
use ricci::embed::{Charts, Layout, LayoutOptions, OnInput, Quality, RepairedInput};
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

/// The layout on the input's own faces, where that is what is written.
pub struct OwnFaces {
    /// The same with edges split, where that was asked for.
    pub repaired: Option<RepairedInput>,
    pub quality: Quality,
}

impl OwnFaces {
    /// Those of a layout; none where its cut does not run along edges of the input.
    pub fn new(
        layout: &Layout,
        input: &Input,
        repair: bool,
        control: &Control,
    ) -> ricci::Result<Option<OwnFaces>> {
        let lengths = input.surface.lengths();
        if !repair {
            return Ok(layout.quality_on_input(lengths)?.map(|quality| OwnFaces { repaired: None, quality }));
        }
        let Some(repaired) = layout.repaired_input(control)? else { return Ok(None) };
        let quality = layout.quality_of_repaired(&repaired, lengths)?;
        Ok(Some(OwnFaces { repaired: Some(repaired), quality }))
    }
}

/// The faces that are written, with what is to be told of them.
pub struct WrittenFaces<'a> {
    /// Their name, to be followed by figures.
    pub name: &'static str,
    /// Triangles that are not counterclockwise.
    pub flipped: &'a [FaceId],
    /// Triangles without area.
    pub degenerate: &'a [FaceId],
    pub quality: &'a Quality,
}

/// Least share of a layout's area on other parts of it that is told as an overlap: rounding of two sides of a cut that lie on each other
/// stays far below.
const LEAST_OVERLAP: f64 = 1e-9;

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
    /// What is known of the input's own faces, where they are written.
    pub own_faces: Option<OwnFaces>,
    /// The layout cut into charts, where that was asked for.
    pub packed: Option<PackedCharts>,
    pub quality: Quality,
    /// Faces of a layout in H² that are upright there, but turned over where a viewer draws straight sides for arcs.
    pub turned_by_straight_sides: Vec<FaceId>,
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
    let options = LayoutOptions { subdivision, straight_sides: true, ..LayoutOptions::default() };
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
        let turned_by_straight_sides = layout.turned_by_straight_sides(&layout.coordinates);
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
            own_faces: None,
            packed: None,
            degenerate,
            modulus: layout.modulus(),
            quality,
            turned_by_straight_sides,
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

    /// The number of edges of the subdivision that were split so that straight sides turn no piece over.
    pub fn n_straightened(&self) -> usize {
        let beside =
            |r: &CommonSubdivision| r.mesh.n_vertices().saturating_sub(r.n_vertices[0] + r.crossings.len());
        self.common_subdivision().map_or(0, beside)
    }

    /// The number of written pieces of the subdivision that straight sides turn over all the same.
    pub fn n_turned_by_straight_sides(&self) -> usize {
        if self.own_faces.is_none() { self.turned_by_straight_sides.len() } else { 0 }
    }

    /// The homogeneous weights of the coordinates.
    pub fn weights(&self) -> Vec<f64> {
        let mut weights = vec![1.0; self.coordinates().len()];
        for h in self.mesh().halfedges() {
            weights[self.corner_index()[h] as usize] = self.weight[self.mesh().origin(h)];
        }
        weights
    }

    /// The faces that are written: those of the subdivision, or the input's own.
    pub fn written(&self) -> WrittenFaces<'_> {
        match (&self.own_faces, &self.on_input) {
            (Some(OwnFaces { repaired, quality }), Some(on_input)) => WrittenFaces {
                name: "on the input's faces: ",
                flipped: repaired.as_ref().map_or(&on_input.flipped, |repaired| &repaired.flipped),
                degenerate: &quality.degenerate,
                quality,
            },
            _ => WrittenFaces {
                name: "",
                flipped: &self.layout.flipped,
                degenerate: &self.degenerate,
                quality: &self.quality,
            },
        }
    }

    /// The input's faces with the fewest edges split, where these are written.
    pub fn repaired(&self) -> Option<&RepairedInput> {
        self.own_faces.as_ref()?.repaired.as_ref()
    }

    /// The number of the input's own faces that fold where the map is made linear on each.
    pub fn folded_input_faces(&self) -> usize {
        self.on_input.as_ref().map_or(0, |on_input| on_input.flipped.len())
    }

    /// The share of the layout's area that lies on other parts of it, where there is any; charts have none.
    pub fn overlap(&self) -> Option<f64> {
        let share = if self.packed.is_none() { self.layout.overlap() } else { None };
        share.filter(|&share| share > LEAST_OVERLAP)
    }

    /// Triangles that are written and not counterclockwise.
    pub fn flipped(&self) -> &[FaceId] {
        self.written().flipped
    }

    /// Adds the check that no triangle is turned over that is written.
    pub fn check_flipped(&self, checks: &mut Checks) {
        let remedy = match &self.own_faces {
            Some(own) if own.repaired.is_some() => {
                Some("leave --on input out: the map is exact on the common subdivision")
            }
            Some(_) => Some(
                "add --repair, which splits the fewest of the input's edges, or leave --on input out: the map is exact on the common \
                 subdivision",
            ),
            None => None,
        };
        checks.add_none("flipped_triangles", ["face", "faces"], self.flipped(), remedy);
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
