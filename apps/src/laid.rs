//! The layout of a flow's metric with what is said about it.

use crate::failure::Failure;
use crate::in_space::{InSpace, consistency_limit, is_carried_back, seams};
use crate::input::Input;
use crate::report::{Seconds, timed};
use ricci::Control;
use ricci::control::Stage;
use ricci::embed::{
    Charts, Layout, Quality, RefinedSpaceLayout, SpaceLayout, layout_in_space, layout_of, layout_refined,
    quality, refine_space_layout, refined_cut, unroll_refined_in_space,
};
use ricci::flow::Solution;
use ricci::geometry::modulus::modulus;
use ricci::geometry::{Space, worse};
use ricci::mesh::{FaceId, HalfedgeId, Mesh, PerVertex, Point, VertexId};
use ricci::metric::curvature::area;
use ricci::metric::{Curvature, Refinement};
use ricci::topology::{central_vertex, cut_graph};

/// Where a surface lies.
pub enum Placed {
    /// In the plane, opened along a cut through the cones of its metric.
    Plane(Layout),
    /// In the model space of its metric, around a vertex.
    Space(Box<InSpace>),
}

/// The charts of a layout, packed.
pub struct Packed {
    pub charts: Charts,
    /// Faces that overlap another one in the unit square, looked for anew in what is written; those that are degenerate there are
    /// left out.
    pub overlapping: usize,
}

/// A layout; in E² it is scaled to the area of the input.
pub struct Laid {
    /// What is laid out: the given triangulation, or its common refinement with the final one.
    pub mesh: Mesh,
    /// The way back, where edges were flipped.
    pub refinement: Option<Refinement>,
    /// Homogeneous weight of each vertex of `mesh`: (q x, q y, q) is linear on its faces, (x, y) the layout \[SSP08, §3.4\].
    pub weight: PerVertex<f64>,
    /// Positions of the vertices of `mesh`.
    pub positions: Option<Vec<Point>>,
    pub placed: Placed,
    /// The layout in charts, where that was asked for.
    pub packed: Option<Packed>,
    pub quality: Quality,
    /// Pieces of the refinement whose image has no area to speak of, faces without area in the input or the layout; in charts also
    /// what is too small for the coordinates of the unit square.
    pub degenerate: Vec<FaceId>,
    /// Lengths in the layout over lengths in the metric.
    pub scale: f64,
    /// τ of a flat torus.
    pub modulus: Option<[f64; 2]>,
    /// What the curvature errors and rounding allow the development to be off: relative to the layout's diameter in E², a distance in
    /// H².
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
    let (mesh, metric) = (flow.mesh(), flow.metric());
    if metric.space == Space::S2 {
        return Ok(Err("ricci uniformize lays spheres out".into()));
    }
    if !curvature.broken.is_empty() {
        let n = curvature.broken.len();
        return Ok(Err(format!(
            "{n} triangles break the triangle inequality (the first is face {})",
            curvature.broken[0]
        )));
    }
    if !is_carried_back(flow, needed) {
        let why = "edge flips led far away, and no output needs the way back to the given triangulation";
        return Ok(Err(why.into()));
    }
    control.step(Stage::Layout, 0.0)?;
    let given = input.mesh();
    let cones = flow.cones().to_vec();
    let sum = |wanted: PerVertex<f64>| -> f64 {
        curvature.at.iter().zip(wanted.iter()).map(|(k, t)| (k - t).abs()).sum()
    };
    let errors = flow.final_target()?.map_or(0.0, sum);
    let limit = consistency_limit(Space::E2, 0.0, errors, mesh.n_faces());
    let result = (|| {
        if metric.space == Space::H2 && flow.double().is_some() {
            return half_in_space(input, flow, &cones, errors, seconds, control);
        }
        if metric.space == Space::H2 {
            let lengths = metric.lengths(mesh)?;
            let cut = if cones.is_empty() { None } else { Some(cut_graph(mesh, &lengths, &cones, control)?) };
            let whole = timed(&mut seconds.layout, || {
                let root = central_vertex(mesh, &lengths, control)?;
                layout_in_space(mesh, metric, root, cut.as_ref(), control)
            })?;
            return in_space(input, flow, &whole, errors, seconds, control);
        }
        let area = area(given, input.surface.geometry(), input.surface.lengths())?;
        let refinement = match flow.is_unflipped() {
            true => None,
            false => Some(timed(&mut seconds.refine, || flow.refinement(control))?),
        };
        timed(&mut seconds.layout, || match refinement {
            None => plain(input, flow, &cones, area, limit, control),
            Some(refinement) => refined(input, flow, refinement, &cones, area, limit, control),
        })
    })();
    match result {
        Ok(laid) => Ok(Ok(laid)),
        Err(ricci::Error::Cancelled) => Err(Failure::Cancelled),
        Err(error) => Ok(Err(error.to_string())),
    }
}

/// The layout of the given triangulation.
fn plain(
    input: &Input,
    flow: &Solution,
    cones: &[VertexId],
    area: f64,
    consistency_limit: f64,
    control: &Control,
) -> ricci::Result<Laid> {
    let (mesh, metric) = (flow.mesh(), flow.metric());
    let cut = cut_graph(mesh, &metric.lengths(mesh)?, cones, control)?;
    control.step(Stage::Layout, 0.3)?;
    let mut layout = layout_of(mesh, metric, &cut, control)?;
    let scale = layout.scale_to_area(mesh, area)?;
    control.step(Stage::Layout, 0.8)?;
    let quality = quality(mesh, input.surface.lengths(), &layout)?;
    Ok(Laid {
        mesh: Mesh::clone(mesh),
        weight: PerVertex::from_fn(mesh.n_vertices(), |v| (flow.initial().input_u[v] - metric.u[v]).exp()),
        refinement: None,
        positions: input.positions().map(<[Point]>::to_vec),
        packed: None,
        degenerate: quality.degenerate.clone(),
        modulus: modulus_of(input, &layout, cones),
        placed: Placed::Plane(layout),
        quality,
        scale,
        consistency_limit,
    })
}

/// The layout of the common refinement.
fn refined(
    input: &Input,
    flow: &Solution,
    refinement: Refinement,
    cones: &[VertexId],
    area: f64,
    consistency_limit: f64,
    control: &Control,
) -> ricci::Result<Laid> {
    let (mesh, metric) = (flow.mesh(), flow.metric());
    let cut = refined_cut(&refinement, mesh, metric, cones, control)?;
    control.step(Stage::Layout, 0.3)?;
    let mut refined = layout_refined(&refinement, mesh, metric, &cut, control)?;
    let scale = refined.scale_to_area(&refinement, area)?;
    control.step(Stage::Layout, 0.8)?;
    let quality = refined.quality(&refinement, input.mesh(), input.surface.lengths())?;
    let positions = match input.positions() {
        Some(positions) => Some(refinement.from_input_vertices(positions)?),
        None => None,
    };
    Ok(Laid {
        mesh: refinement.mesh.clone(),
        weight: refinement.weight.clone(),
        refinement: Some(refinement),
        positions,
        packed: None,
        degenerate: refined.degenerate,
        modulus: modulus_of(input, &refined.layout, cones),
        placed: Placed::Plane(refined.layout),
        quality,
        scale,
        consistency_limit,
    })
}

/// Carry the layout of a metric's triangulation back to the given one. `errors`: the sum of |K − K̄| over the vertices.
pub fn in_space(
    input: &Input,
    metric: &Solution,
    whole: &SpaceLayout,
    errors: f64,
    seconds: &mut Seconds,
    control: &Control,
) -> ricci::Result<Laid> {
    let refinement = timed(&mut seconds.refine, || metric.refinement(control))?;
    let lay = || refine_space_layout(whole, &refinement, metric.mesh(), control);
    let refined = timed(&mut seconds.layout, lay)?;
    let seams = seams(whole, &refinement);
    laid(input, metric, refinement, (refined, seams), errors)
}

/// Lay out the given half of the double that a metric lives on. `cones`: vertices inside that the cut has to pass.
pub fn half_in_space(
    input: &Input,
    metric: &Solution,
    cones: &[VertexId],
    errors: f64,
    seconds: &mut Seconds,
    control: &Control,
) -> ricci::Result<Laid> {
    let refinement = timed(&mut seconds.refine, || metric.refinement(control))?;
    let lay = || unroll_refined_in_space(&refinement, metric.mesh(), metric.metric(), cones, control);
    let (refined, cut) = timed(&mut seconds.layout, lay)?;
    let numbered =
        |(k, segment): (usize, &Vec<HalfedgeId>)| -> Vec<_> { segment.iter().map(|&h| (h, k)).collect() };
    let seams = cut.segments.iter().enumerate().flat_map(numbered).collect();
    laid(input, metric, refinement, (refined, seams), errors)
}

fn laid(
    input: &Input,
    metric: &Solution,
    refinement: Refinement,
    (refined, seams): (RefinedSpaceLayout, Vec<(HalfedgeId, usize)>),
    errors: f64,
) -> ricci::Result<Laid> {
    let quality = refined.quality(&refinement, input.mesh(), input.surface.lengths())?;
    let positions = match input.positions() {
        Some(positions) => Some(refinement.from_input_vertices(positions)?),
        None => None,
    };
    let consistency_limit = consistency_limit(refined.space, refined.radius, errors, metric.mesh().n_faces());
    let place = InSpace { coordinates: refined.coordinates(), seams, refined };
    Ok(Laid {
        mesh: refinement.mesh.clone(),
        weight: refinement.weight.clone(),
        refinement: Some(refinement),
        positions,
        packed: None,
        degenerate: place.refined.degenerate.clone(),
        modulus: None,
        placed: Placed::Space(Box::new(place)),
        quality,
        scale: 1.0,
        consistency_limit,
    })
}

fn modulus_of(input: &Input, layout: &Layout, cones: &[VertexId]) -> Option<[f64; 2]> {
    let flat_torus = input.mesh().is_closed() && input.mesh().euler() == 0 && cones.is_empty();
    match layout.seams.as_slice() {
        // Any two of the two or three side pairings of the cut torus generate its lattice.
        [a, b, ..] if flat_torus => modulus([a.translation, b.translation]),
        _ => None,
    }
}

impl Laid {
    /// Homogeneous weights of the coordinates.
    pub fn weights(&self) -> Vec<f64> {
        let mut weights = vec![1.0; self.coordinates().len()];
        for h in self.mesh.halfedges() {
            weights[self.corner_index()[h] as usize] = self.weight[self.mesh.origin(h)];
        }
        weights
    }

    /// The layout of a cone metric in the plane, if this is one.
    pub fn plane(&self) -> Option<&Layout> {
        match &self.placed {
            Placed::Plane(layout) => Some(layout),
            Placed::Space(_) => None,
        }
    }

    /// The layout in the model space of the metric, if this is one.
    pub fn space(&self) -> Option<&InSpace> {
        match &self.placed {
            Placed::Plane(_) => None,
            Placed::Space(place) => Some(place),
        }
    }

    /// Triangles that are not counterclockwise.
    pub fn flipped(&self) -> &[FaceId] {
        match &self.placed {
            Placed::Plane(layout) => &layout.flipped,
            Placed::Space(place) => &place.refined.flipped,
        }
    }

    /// Half-edges on the left side of the cut, with the number of their seam.
    pub fn seams(&self) -> Vec<(HalfedgeId, usize)> {
        match &self.placed {
            Placed::Plane(layout) => {
                let seams = layout.seams.iter().enumerate();
                seams.flat_map(|(k, seam)| seam.halfedges.iter().map(move |&h| (h, k))).collect()
            }
            Placed::Space(place) => place.seams.clone(),
        }
    }

    /// The extent of the coordinates.
    pub fn diameter(&self) -> f64 {
        match &self.placed {
            Placed::Plane(layout) => layout.diameter,
            Placed::Space(place) => place.extent(),
        }
    }

    /// Largest disagreement between the layout and the metric or between the two sides of a seam: relative to the layout's diameter in E²,
    /// a distance in H².
    pub fn consistency(&self) -> f64 {
        match &self.placed {
            Placed::Plane(layout) => layout.seams.iter().map(|s| s.residual).fold(layout.consistency, worse),
            Placed::Space(place) => place.consistency(),
        }
    }
}
