//! The layout of a flow's metric with what is said about it.

use crate::failure::Failure;
use crate::input::Input;
use crate::report::{Seconds, timed};
use ricci::Control;
use ricci::control::Stage;
use ricci::embed::{Charts, Layout, OnInput, Quality, UnrollOptions, unroll};
use ricci::flow::Solution;
use ricci::geometry::Space;
use ricci::mesh::{FaceId, HalfedgeId, Mesh, PerVertex, Point, VertexId};
use ricci::metric::{Curvature, Refinement};
use std::sync::Arc;

/// Crossings per edge up to which the common refinement is formed for the summary alone: it then costs no more than the flow.
const FEW_CROSSINGS: usize = 16;

/// Whether to carry a layout back to the given triangulation: where an output needs that, or where it costs little.
pub fn is_carried_back(metric: &Solution, needed: bool) -> bool {
    needed || metric.crossings().is_ok_and(|n| n <= FEW_CROSSINGS * metric.mesh().n_edges())
}

/// The charts of a layout, packed.
pub struct Packed {
    pub charts: Charts,
    /// Faces that overlap another one in the unit square, looked for anew in what is written; those that are degenerate there are
    /// left out.
    pub overlapping: usize,
}

/// A layout on the surface as it was given; in E² it is scaled to the area of the input.
pub struct Laid {
    pub layout: Layout,
    /// Homogeneous weight of each vertex of the layout's mesh: (q x, q y, q) is linear on its faces, (x, y) the layout in E²
    /// \[SSP08, §3.4\].
    pub weight: PerVertex<f64>,
    /// Positions of the vertices of the layout's mesh.
    pub positions: Option<Vec<Point>>,
    /// The layout on the input's own faces, where its cut runs along their edges.
    pub on_input: Option<OnInput>,
    /// The layout in charts, where that was asked for.
    pub packed: Option<Packed>,
    pub quality: Quality,
    /// Pieces of the refinement whose image has no area to speak of, faces without area in the input or the layout; in charts also
    /// what is too small for the coordinates of the unit square.
    pub degenerate: Vec<FaceId>,
    /// τ of a flat torus.
    pub modulus: Option<[f64; 2]>,
    /// What [`Layout::consistency`] may be.
    pub consistency_limit: f64,
}

/// Lay the metric of a flow out on the given surface, or say why it has no layout. `needed`: by an output.
pub fn lay_out(
    input: &Input,
    flow: &Solution,
    curvature: &Curvature,
    needed: bool,
    seconds: &mut Seconds,
    control: &Control,
) -> Result<Result<Laid, String>, Failure> {
    if flow.metric().space == Space::S2 {
        return Ok(Err("ricci uniformize lays spheres out".into()));
    }
    if let Some(first) = curvature.broken.first() {
        let n = curvature.broken.len();
        return Ok(Err(format!("{n} triangles break the triangle inequality (the first is face {first})")));
    }
    if !is_carried_back(flow, needed) {
        let why = "edge flips led far away, and no output needs the way back to the given triangulation";
        return Ok(Err(why.into()));
    }
    control.step(Stage::Layout, 0.0)?;
    let sum = |wanted: PerVertex<f64>| -> f64 {
        curvature.at.iter().zip(wanted.iter()).map(|(k, t)| (k - t).abs()).sum()
    };
    let errors = flow.final_target()?.map_or(0.0, sum);
    let mut unrolled = || -> ricci::Result<Laid> {
        let refinement = match flow.is_unflipped() {
            true => None,
            false => Some(Arc::new(timed(&mut seconds.refine, || flow.refinement(control))?)),
        };
        timed(&mut seconds.layout, || {
            let options = UnrollOptions { refinement, ..UnrollOptions::default() };
            Laid::new(input, flow, unroll(flow, &options, control)?, errors)
        })
    };
    match unrolled() {
        Ok(laid) => Ok(Ok(laid)),
        Err(ricci::Error::Cancelled) => Err(Failure::Cancelled),
        Err(error) => Ok(Err(error.to_string())),
    }
}

impl Laid {
    /// A layout of a metric of the input. `errors`: the sum of |K − K̄| over the vertices.
    pub fn new(input: &Input, result: &Solution, layout: Layout, errors: f64) -> ricci::Result<Laid> {
        let quality = layout.quality(input.mesh(), input.surface.lengths())?;
        let given = input.positions();
        let (weight, positions, degenerate) = match layout.refinement() {
            Some(r) => {
                let positions = given.map(|p| r.from_input_vertices(p)).transpose()?;
                (r.weight.clone(), positions, layout.degenerate.clone())
            }
            None => {
                let (before, after) = (&result.initial().input_u, &result.metric().u);
                let weight = PerVertex::from_fn(after.len(), |v: VertexId| (before[v] - after[v]).exp());
                (weight, given.map(<[Point]>::to_vec), quality.degenerate.clone())
            }
        };
        Ok(Laid {
            weight,
            positions,
            on_input: layout.on_input(),
            packed: None,
            degenerate,
            modulus: layout.modulus(),
            consistency_limit: layout.consistency_limit(errors),
            quality,
            layout,
        })
    }

    /// What is laid out: the given triangulation, or its common refinement with the final one.
    pub fn mesh(&self) -> &Mesh {
        self.layout.mesh()
    }

    /// The way back, where edges were flipped.
    pub fn refinement(&self) -> Option<&Refinement> {
        self.layout.refinement().map(|r| &**r)
    }

    /// Homogeneous weights of the coordinates.
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

    /// Half-edges on the left side of the cut, with the number of their seam.
    pub fn seams(&self) -> Vec<(HalfedgeId, usize)> {
        let segments = self.layout.cut.segments.iter().enumerate();
        segments.flat_map(|(k, segment)| segment.iter().map(move |&h| (h, k))).collect()
    }

    /// Largest disagreement between the layout and the metric or between the two sides of a seam: relative to the layout's diameter in E²,
    /// a distance in H².
    pub fn consistency(&self) -> f64 {
        self.layout.consistency()
    }
}
