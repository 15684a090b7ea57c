//! What a layout unrolls, and the maps between it, the mesh that the metric was made from and the metric's
//! triangulation.

use crate::arrays::{check_buffer, copy_out};
use crate::failure::{Failure, Outcome};
use crate::guard;
use crate::layout::{corners_of, ricci_layout};
use crate::mesh::{Shape, ricci_mesh};
use crate::status::ricci_status;
use ricci::Control;
use ricci::embed::OnInput;
use ricci::embed::layout::distance;
use ricci::flow::Solution;
use ricci::mesh::{EdgeId, FaceId, PerEdge, PerVertex};
use ricci::metric::Refinement;
use ricci::metric::refinement::Crossing;
use std::sync::Arc;

/// Which of the two triangulations a function asks about.
#[derive(Clone, Copy)]
enum Side {
    Input,
    Final,
}

/// What a layout unrolls as a mesh: the mesh that the metric was made from, or the common refinement.
///
/// The given vertices come first, where they were bit for bit; crossings lie on the edges of the given mesh.
/// Of an intrinsic surface the mesh has the lengths of the layout. Crossings may be so near to others that
/// they coincide: ricci_mesh_lengths then refuses.
/// @return RICCI_OK, RICCI_NULL_POINTER.
///
/// @param layout  the layout.
/// @param mesh    out: the new handle, to be released by ricci_mesh_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_layout_mesh(
    layout: *const ricci_layout,
    mesh: *mut *mut ricci_mesh,
) -> ricci_status {
    guard::make("mesh", mesh, |door| {
        let layout = door.shared(layout)?;
        let mesh = Arc::new(layout.layout.mesh().clone());
        let shape = match &layout.positions {
            Some(positions) => Shape::Positions(positions.clone()),
            None => {
                let space = layout.layout.space;
                let length = |e: EdgeId| {
                    let [h, twin] = [e.halfedge(), e.halfedge().twin()];
                    let h = if mesh.is_outside(h) { twin } else { h };
                    distance(space, layout.layout.corner(h), layout.layout.corner(mesh.next(h)))
                };
                Shape::Lengths(Arc::new(PerEdge::from_fn(mesh.n_edges(), length)), space)
            }
        };
        Ok(ricci_mesh::new(mesh, shape))
    })
}

/// The face of the given mesh that every face of the layout is part of.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param layout    the layout.
/// @param faces     out: n_faces face indices of the mesh that the metric was made from.
/// @param capacity  entries of `faces`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_layout_input_faces(
    layout: *const ricci_layout,
    faces: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::with(layout, |layout| copy_out("faces", &layout.faces_of(Side::Input), faces, capacity))
}

/// The face of the metric's triangulation that every face of the layout is part of.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param layout    the layout.
/// @param faces     out: n_faces face indices of ricci_metric_mesh.
/// @param capacity  entries of `faces`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_layout_final_faces(
    layout: *const ricci_layout,
    faces: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::with(layout, |layout| copy_out("faces", &layout.faces_of(Side::Final), faces, capacity))
}

/// Where the corners of every face of the layout lie in its face of the given mesh: values at the corners of
/// that face, added up with these weights, are the values there. Carries attributes of vertices and corners
/// to the layout.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param layout    the layout.
/// @param weights   out: n_faces x 3 x 3 barycentric coordinates [face, corner, corner of the other face].
/// @param capacity  entries of `weights`, at least 9 n_faces.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_layout_input_barycentric(
    layout: *const ricci_layout,
    weights: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::call(|door| {
        let rows = door.shared(layout)?.barycentric(Side::Input);
        copy_out("weights", &rows, weights, capacity)
    })
}

/// Where the corners of every face of the layout lie in its face of the metric's triangulation, with its
/// lengths.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param layout    the layout.
/// @param weights   out: n_faces x 3 x 3 barycentric coordinates [face, corner, corner of the other face].
/// @param capacity  entries of `weights`, at least 9 n_faces.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_layout_final_barycentric(
    layout: *const ricci_layout,
    weights: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::call(|door| {
        let rows = door.shared(layout)?.barycentric(Side::Final);
        copy_out("weights", &rows, weights, capacity)
    })
}

/// The piece that every face of the layout is part of, from 0. Faces of a piece have consecutive numbers and
/// one projective map.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param layout    the layout.
/// @param pieces    out: n_faces piece numbers, below n_pieces.
/// @param capacity  entries of `pieces`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_layout_pieces(
    layout: *const ricci_layout,
    pieces: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::with(layout, |layout| match layout.layout.refinement() {
        Some(refinement) => copy_out("pieces", &refinement.piece, pieces, capacity),
        None => copy_out("pieces", &layout.faces_of(Side::Input), pieces, capacity),
    })
}

/// The homogeneous weight q of every vertex of a layout in the Euclidean plane. In a piece the map from the given mesh to the
/// plane is projective, and with (x, y) the point of a corner it is (q x, q y, q) that is linear: as texture
/// coordinates of three components.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_DOMAIN, RICCI_LAYOUT (in the hyperbolic plane, where points of
/// one vertex differ: ricci_layout_write_obj_homogeneous).
///
/// @param layout    the layout.
/// @param weights   out: n_vertices weights, positive; only their quotients in a piece mean anything.
/// @param capacity  entries of `weights`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_layout_weights(
    layout: *const ricci_layout,
    weights: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(layout, |layout| {
        check_buffer("weights", layout.layout.mesh().n_vertices(), weights, capacity)?;
        layout.check_plane()?;
        let values = self::weights(&layout.surface, layout.layout.refinement())?;
        copy_out("weights", &values, weights, capacity)
    })
}

/// The crossings on the edges of the given mesh: vertex n_given_vertices + k lies at end 0 (1 - t) + end 1 t
/// of its edge.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param layout     the layout.
/// @param edges      out: n_crossings rows of ricci_mesh_edges of the mesh that the metric was made from.
/// @param fractions  out: n_crossings numbers t, from 0 to 1.
/// @param capacity   entries of `edges` and of `fractions`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_layout_input_crossings(
    layout: *const ricci_layout,
    edges: *mut u32,
    fractions: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(layout, |layout| layout.crossings(Side::Input, edges, fractions, capacity))
}

/// The crossings on the edges of the metric's triangulation, with its lengths.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param layout     the layout.
/// @param edges      out: n_crossings rows of ricci_mesh_edges of ricci_metric_mesh.
/// @param fractions  out: n_crossings numbers t, from 0 to 1.
/// @param capacity   entries of `edges` and of `fractions`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_layout_final_crossings(
    layout: *const ricci_layout,
    edges: *mut u32,
    fractions: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(layout, |layout| layout.crossings(Side::Final, edges, fractions, capacity))
}

/// The coordinates of every corner of every face of the mesh that the metric was made from. The map is made linear on each face; where that
/// folds faces, the summary's n_flipped_given counts them.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_LAYOUT (ricci_quotient_layout, which is cut along edges of the metric's
/// triangulation).
///
/// @param layout    the layout.
/// @param uv        out: n_given_faces x 3 x 2, in the order of ricci_mesh_faces.
/// @param capacity  entries of `uv`, at least 6 n_given_faces.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_layout_input_uv(
    layout: *const ricci_layout,
    uv: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(layout, |layout| {
        let points = layout.input_points()?;
        let corners: Vec<[[f64; 2]; 3]> =
            layout.input_corners()?.into_iter().map(|f| f.map(|k| points[k as usize])).collect();
        copy_out("uv", &corners, uv, capacity)
    })
}

/// Homogeneous weight of every vertex of what a layout unrolls.
pub(crate) fn weights(surface: &Solution, refinement: Option<&Arc<Refinement>>) -> Outcome<PerVertex<f64>> {
    Ok(match refinement {
        Some(refinement) => refinement.weight.clone(),
        None => surface.refinement(&Control::new())?.weight,
    })
}

impl ricci_layout {
    fn cut_on_input(&self) -> Outcome<&OnInput> {
        self.on_input.as_ref().ok_or_else(|| {
            let message = "this layout is cut along edges of the metric's triangulation, not of the mesh: take ricci_layout_new or \
                           ricci_layout_hyperbolic";
            Failure::new(ricci_status::RICCI_LAYOUT, message)
        })
    }

    /// The point of every corner of every face of the given mesh.
    pub(crate) fn input_corners(&self) -> Outcome<Vec<[u32; 3]>> {
        Ok(corners_of(self.surface.given(), &self.cut_on_input()?.corner_index))
    }

    /// The points of the corners of the given mesh.
    pub(crate) fn input_points(&self) -> Outcome<Vec<[f64; 2]>> {
        Ok(self.cut_on_input()?.points.iter().map(|&k| self.points[k as usize]).collect())
    }

    fn faces_of(&self, side: Side) -> Vec<u32> {
        let of = |f: FaceId| match (self.layout.refinement(), side) {
            (Some(refinement), Side::Input) => refinement.input_face[f].0,
            (Some(refinement), Side::Final) => refinement.final_face[f].0,
            (None, _) => f.0,
        };
        self.layout.mesh().faces().map(of).collect()
    }

    fn barycentric(&self, side: Side) -> Vec<[[f64; 3]; 3]> {
        let of = |f: FaceId| match (self.layout.refinement(), side) {
            (Some(refinement), Side::Input) => refinement.input_barycentric(f),
            (Some(refinement), Side::Final) => refinement.final_barycentric(f),
            (None, _) => [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        };
        self.layout.mesh().faces().map(of).collect()
    }

    fn crossings(&self, side: Side, edges: *mut u32, fractions: *mut f64, capacity: usize) -> Outcome {
        let crossings = self.layout.refinement().map_or(&[][..], |refinement| &refinement.crossings);
        let of = |c: &Crossing| match side {
            Side::Input => (c.input_edge.0, c.input_weights[1]),
            Side::Final => (c.final_edge.0, c.final_weights[1]),
        };
        let (names, values): (Vec<u32>, Vec<f64>) = crossings.iter().map(of).unzip();
        check_buffer("fractions", values.len(), fractions, capacity)?;
        copy_out("edges", &names, edges, capacity)?;
        copy_out("fractions", &values, fractions, capacity)
    }
}
