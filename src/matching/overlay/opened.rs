//! Opens a placed surface: puts its faces side by side in one frame, for pictures.

use super::super::cover::PlacedMesh;
use crate::geometry::{DoubleDouble, Motion};
use crate::mesh::{FaceId, HalfedgeId};
use crate::topology::spanning::Key;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// The motion of each face into the opened surface, and the half-edges across which a neighbour was placed beside its face.
pub(super) struct OpenedFaces {
    pub homes: Vec<Motion<DoubleDouble>>,
    pub crossed: Vec<HalfedgeId>,
}

/// The surface opened from the face of a half-edge: first the faces that share its frame are placed, then, beside those that are placed
/// already, the part whose frame is moved least. A surface that is opened along a cut stays as it is; one whose faces have a frame each
/// grows about the first.
pub(super) fn opened(placed: &PlacedMesh, from: HalfedgeId) -> OpenedFaces {
    let (mesh, cover) = (&placed.cover.mesh, &placed.cover);
    let mut homes: Vec<Option<Motion<DoubleDouble>>> = vec![None; mesh.n_faces()];
    let mut crossed = Vec::new();
    let mut beside = BinaryHeap::new();
    let mut moved: Vec<(Motion<DoubleDouble>, HalfedgeId)> = Vec::new();
    let identity = Motion::identity(cover.space);
    let mut next = mesh.face(from).map(|f| (f, identity));
    while let Some((first, home)) = next.take() {
        let mut waiting: Vec<FaceId> = vec![first];
        homes[first.index()] = Some(home);
        while let Some(f) = waiting.pop() {
            for h in mesh.face_halfedges(f) {
                let Some(g) = mesh.face(h.twin()).filter(|g| homes[g.index()].is_none()) else { continue };
                match cover.across(h) {
                    None => {
                        homes[g.index()] = Some(home);
                        crossed.push(h);
                        waiting.push(g);
                    }
                    Some(across) => {
                        let there = home.compose(across).normalised();
                        beside.push(Reverse((Key(there.displacement()), moved.len())));
                        moved.push((there, h));
                    }
                }
            }
        }
        while let Some(Reverse((_, k))) = beside.pop() {
            let (there, h) = moved[k];
            if let Some(g) = mesh.face(h.twin()).filter(|g| homes[g.index()].is_none()) {
                crossed.push(h);
                next = Some((g, there));
                break;
            }
        }
    }
    OpenedFaces { homes: homes.into_iter().map(|home| home.unwrap_or(identity)).collect(), crossed }
}
