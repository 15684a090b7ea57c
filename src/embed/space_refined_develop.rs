//! Developing a common refinement into a model space: pieces lie where their final faces do.

use super::corner::number_corners;
use super::dirichlet::to_origin;
use super::layout::check_cut;
use super::space_develop::Faces;
use super::space_layout::distance_from_origin;
use super::space_refined::{RefinedSpaceLayout, combination, in_face};
use crate::control::{Control, Stage};
use crate::error::{Error, Result};
use crate::geometry::motion::precise_point;
use crate::geometry::{Motion, Twofold, worse};
use crate::mesh::{HalfedgeId, Mesh, PerEdge, PerFace, VertexId};
use crate::metric::{Metric, Refinement};
use crate::topology::spanning::Key;
use crate::topology::{CutGraph, central_vertex, check_vertex, cut_graph};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// "No patch yet".
const NONE: u32 = u32::MAX;
/// Patches between two looks at the control.
const PATCHES_PER_STEP: usize = 1024;

/// Lengths of the refinement's edges in the final metric on the final triangulation `mesh`, for cuts and centres.
///
/// Errors: those of [`Metric::lengths`].
pub fn refined_lengths(r: &Refinement, mesh: &Mesh, metric: &Metric) -> Result<PerEdge<f64>> {
    let faces = Faces::new(mesh, metric)?;
    let mut lengths = PerEdge::filled(r.mesh.n_edges(), 0.0);
    for f in r.mesh.faces() {
        let corners = faces.corners(r.final_face[f], &Motion::identity(metric.space));
        let points = r.final_barycentric(f).map(|weights| combination(metric.space, corners, weights));
        for (k, h) in r.mesh.face_halfedges(f).into_iter().enumerate() {
            let there = to_origin(metric.space, points[k]);
            let next = there.apply(precise_point(metric.space, points[(k + 1) % 3])).map(f64::from);
            lengths[h.edge()] = distance_from_origin(metric.space, next);
        }
    }
    // Crossings may coincide; no edge of a cut has no length.
    let least = 1e-12 * lengths.iter().copied().fold(0.0, f64::max);
    lengths.iter_mut().for_each(|l| *l = l.max(least));
    Ok(lengths)
}

/// Lay a refinement out about its centre, opened through the vertices `cones` of it: [`layout_refined_in_space`] with a cut and a root
/// found for it. Without cones the cut is found by the layout.
///
/// Errors: those of [`refined_lengths`], [`cut_graph`] and [`layout_refined_in_space`].
pub fn unroll_refined_in_space(
    r: &Refinement,
    mesh: &Mesh,
    metric: &Metric,
    cones: &[VertexId],
    control: &Control,
) -> Result<(RefinedSpaceLayout, CutGraph)> {
    let lengths = refined_lengths(r, mesh, metric)?;
    let cut = if cones.is_empty() { None } else { Some(cut_graph(&r.mesh, &lengths, cones, control)?) };
    let root = central_vertex(&r.mesh, &lengths, control)?;
    layout_refined_in_space(r, mesh, metric, root, cut.as_ref(), control)
}

/// Lay a refinement out by itself, outwards from a vertex of it: where it is a part of what the metric lives on (the first half of a double).
///
/// `cut` opens the refinement into a disk with the cones on its border ([`crate::topology::cut_graph`] with [`refined_lengths`]); `None`
/// for a metric without cones, as in [`super::layout_in_space`]. Returns the layout and its cut.
///
/// Errors: [`Error::Argument`] for a root that is no vertex; [`Error::Layout`] for another cut, for several components, for lengths beyond
/// doubles; those of [`Metric::lengths`]; [`Error::Cancelled`].
pub fn layout_refined_in_space(
    r: &Refinement,
    mesh: &Mesh,
    metric: &Metric,
    root: VertexId,
    cut: Option<&CutGraph>,
    control: &Control,
) -> Result<(RefinedSpaceLayout, CutGraph)> {
    check_vertex(&r.mesh, root)?;
    cut.map_or(Ok(()), |cut| check_cut(&r.mesh, cut))?;
    let faces = Faces::new(mesh, metric)?;
    let Grown { frames, patch, crossed } = grow(r, &faces, root, cut, control)?;
    let cut = match cut {
        Some(cut) => cut.clone(),
        None => CutGraph::around(&r.mesh, PerEdge::from_fn(r.mesh.n_edges(), |e| !crossed[e])),
    };
    let (corner_index, n_corners) = number_corners(&r.mesh, &cut.is_cut);
    let mut layout =
        RefinedSpaceLayout::empty(metric.space, corner_index, n_corners, cut.is_cut.clone(), frames, patch);
    layout.place(r, |f, frame| faces.corners(r.final_face[f], frame));
    layout.measure(r);
    layout.disagreement = disagreement(r, &faces, &layout, &cut);
    control.check()?;
    Ok((layout, cut))
}

struct Grown {
    frames: Vec<Motion<Twofold>>,
    /// Per triangle, the frame of its final face.
    patch: PerFace<u32>,
    crossed: PerEdge<bool>,
}

/// Add final faces in the order of their far corners; the pieces of one that hang together lie in it.
fn grow(
    r: &Refinement,
    faces: &Faces,
    root: VertexId,
    cut: Option<&CutGraph>,
    control: &Control,
) -> Result<Grown> {
    let mesh = &r.mesh;
    let Some(first) = mesh.outgoing(root).find(|&h| !mesh.is_outside(h)) else {
        return Err(Error::Layout(format!("vertex {root} has no face")));
    };
    let mut grown = Grown {
        frames: Vec::new(),
        patch: PerFace::filled(mesh.n_faces(), NONE),
        crossed: PerEdge::filled(mesh.n_edges(), false),
    };
    let mut queue = BinaryHeap::from([Reverse((Key(0.0), first))]);
    let (mut stack, mut done) = (Vec::new(), 0);
    while let Some(Reverse((_, entry))) = queue.pop() {
        let Some(f) = mesh.face(entry).filter(|&f| grown.patch[f] == NONE) else { continue };
        if grown.frames.len().is_multiple_of(PATCHES_PER_STEP) {
            control.step(Stage::Layout, done as f64 / mesh.n_faces() as f64)?;
        }
        let from = mesh.face(entry.twin()).and_then(|g| grown.frames.get(grown.patch[g] as usize));
        let frame = match (from, r.final_halfedge(entry)) {
            (Some(from), Some(side)) => {
                grown.crossed[entry.edge()] = true;
                let across = faces.across(&faces.frame_in(from, side.twin()), side);
                faces.turned_to_first(&across, side)
            }
            _ => {
                let k = mesh.face_halfedges(f).iter().position(|&h| h == entry).unwrap_or(0);
                let corners = faces.corners(r.final_face[f], &Motion::identity(faces.space));
                to_origin(faces.space, combination(faces.space, corners, r.final_barycentric(f)[k]))
            }
        };
        let number = grown.frames.len() as u32;
        grown.patch[f] = number;
        grown.frames.push(frame);
        stack.push(f);
        while let Some(f) = stack.pop() {
            done += 1;
            for h in mesh.face_halfedges(f) {
                let open = cut.is_none_or(|cut| !cut.is_cut[h.edge()]);
                let Some(g) = mesh.face(h.twin()).filter(|_| open) else { continue };
                match r.final_halfedge(h) {
                    None if grown.patch[g] == NONE => {
                        grown.patch[g] = number;
                        stack.push(g);
                        grown.crossed[h.edge()] = true;
                    }
                    // Two pieces side by side in one copy of their face.
                    None => grown.crossed[h.edge()] |= grown.patch[g] == number,
                    Some(side) if grown.patch[g] == NONE => {
                        let rough = faces.frame_in(&frame, side).rounded();
                        let [x, y] = faces.apex(&faces.across(&rough, side.twin()), side.twin()).b;
                        if !(x.is_finite() && y.is_finite()) {
                            let message = format!("edge {} lies beyond the range of doubles", side.edge());
                            return Err(Error::Layout(message));
                        }
                        queue.push(Reverse((Key(x.hypot(y)), h.twin())));
                    }
                    Some(_) => {}
                }
            }
        }
    }
    if done < mesh.n_faces() {
        return Err(Error::Layout("the surface has several components: lay out each alone".into()));
    }
    Ok(grown)
}

/// Largest distance between where a piece has its corner and where it lies, across the cut by the isometry of the
/// segment's edge that is nearest to the origin.
fn disagreement(r: &Refinement, faces: &Faces, layout: &RefinedSpaceLayout, cut: &CutGraph) -> f64 {
    let frame = |h: HalfedgeId| match r.mesh.face(h) {
        Some(f) => layout.frames[layout.patch[f] as usize],
        None => Motion::identity(faces.space),
    };
    // The neighbour across h lies where its face continues this one's: over a final edge, or within a final face.
    let neighbour = |h: HalfedgeId| {
        let (here, there) = (frame(h), frame(h.twin()));
        match r.final_halfedge(h) {
            Some(side) => {
                let across = faces.across(&faces.frame_in(&here, side), side.twin());
                faces.turned_to_first(&across, side.twin()).compose(&there.inverse())
            }
            None => here.compose(&there.inverse()),
        }
    };
    let space = faces.space;
    let distance = |home: &Motion<Twofold>, p: [Twofold; 3], q: [Twofold; 3]| {
        let [p, q] = [p, q].map(|p| home.apply(p).map(f64::from));
        (p[0] - q[0]).hypot(p[1] - q[1])
    };
    let mut worst = 0.0f64;
    for f in r.mesh.faces() {
        let frame = layout.frames[layout.patch[f] as usize];
        let (home, corners) = (frame.inverse(), faces.corners(r.final_face[f], &frame));
        for (p, weights) in layout.face_points(r, f).into_iter().zip(r.final_barycentric(f)) {
            let own = in_face(space, &frame, corners, weights);
            worst = worse(worst, distance(&home, precise_point(space, p), own));
        }
    }
    for segment in &cut.segments {
        let far = |h: HalfedgeId| frame(h).displacement().max(frame(h.twin()).displacement());
        let Some(&nearest) = segment.iter().min_by(|&&g, &&h| far(g).total_cmp(&far(h))) else { continue };
        let pairing = neighbour(nearest);
        // Frames of final faces, by isometries: products of vectors would lose e^{2r}, those of isometries e^r.
        for &h in segment {
            let off =
                frame(h).inverse().compose(&pairing).compose(&neighbour(h).inverse()).compose(&frame(h));
            worst = worse(worst, off.displacement());
        }
    }
    worst
}
