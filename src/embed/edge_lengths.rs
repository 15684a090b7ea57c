//! The lengths of edges in a metric, of the triangles that are laid out and of the input, for searches of shortest paths and cuts.

use super::faces::{Faces, combination};
use super::frame::HalfedgeFrame;
use super::layout::distance;
use super::pieces::{LayoutPieces, PlaceInFace};
use crate::mesh::{FaceId, HalfedgeId, Mesh, PerEdge};
use crate::parallel;
use std::cell::OnceCell;

/// Least length of an edge, relative to the longest one, that a search for a cut assumes: paths through regions that the metric has shrunk
/// to a point then do not cost nothing.
const LEAST_LENGTH: f64 = 1e-12;

/// The lengths of the pieces' edges in the metric.
pub(super) fn lengths_of_pieces<F: HalfedgeFrame>(pieces: &LayoutPieces, faces: &Faces<F>) -> PerEdge<f64> {
    let mesh = pieces.mesh();
    if pieces.common_subdivision().is_none() {
        return faces.lengths();
    }
    // Of the two half-edges of an interior edge, the one with the even number is measured.
    let is_measured = |h: HalfedgeId| h.0 & 1 == 0 || mesh.is_outside(h.twin());
    let mut measured = vec![[0.0; 3]; mesh.n_faces()];
    parallel::fill(&mut measured, |f| {
        let f = FaceId::from(f);
        let (face, sides) = (pieces.final_face(f), mesh.face_halfedges(f));
        let places = [0, 1, 2].map(|k| pieces.final_place((f, k), sides[k]));
        let corners = OnceCell::new();
        let point = |k: usize| {
            let corners = *corners.get_or_init(|| faces.local(face));
            combination(faces.space, corners, places[k].weights())
        };
        [0, 1, 2].map(|k| match [places[k], places[(k + 1) % 3]].map(PlaceInFace::rounded_corner) {
            _ if !is_measured(sides[k]) => 0.0,
            // The edge is a whole side of the final face.
            [Some(from), Some(to)] if from != to => faces.length(face, 3 - from - to),
            _ => distance(faces.space, point(k), point((k + 1) % 3)),
        })
    });
    let mut lengths = PerEdge::filled(mesh.n_edges(), 0.0);
    for f in mesh.faces() {
        let sides = mesh.face_halfedges(f).into_iter().zip(measured[f.index()]);
        sides.filter(|(h, _)| is_measured(*h)).for_each(|(h, length)| lengths[h.edge()] = length);
    }
    lengths
}

/// The lengths of the input's edges, each measured along itself: the sums of the lengths of the pieces' edges that it consists of.
pub(super) fn lengths_of_input(pieces: &LayoutPieces, of_pieces: PerEdge<f64>, input: &Mesh) -> PerEdge<f64> {
    if pieces.common_subdivision().is_none() {
        return with_least_length(of_pieces);
    }
    let mut lengths = PerEdge::filled(input.n_edges(), 0.0);
    for part in pieces.mesh().edges() {
        if let Some(e) = pieces.input_edge(part) {
            lengths[e] += of_pieces[part];
        }
    }
    with_least_length(lengths)
}

/// The same lengths, with [`LEAST_LENGTH`] in place of smaller ones.
pub(super) fn with_least_length(mut lengths: PerEdge<f64>) -> PerEdge<f64> {
    let least = LEAST_LENGTH * lengths.iter().copied().fold(0.0, f64::max);
    lengths.iter_mut().for_each(|l| *l = l.max(least));
    lengths
}
