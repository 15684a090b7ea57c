//! The isometries between neighbouring triangles of a metric, without a layout of the whole surface.

use super::faces::{Faces, combination};
use super::pieces::LayoutPieces;
use crate::error::Result;
use crate::flow::Solution;
use crate::geometry::{DoubleDouble, Motion, Space};
use crate::mesh::{FaceId, HalfedgeId, Mesh, PerFace, PerHalfedge};
use crate::metric::CommonSubdivision;
use crate::parallel;
use std::sync::Arc;

/// The triangles of a metric, each at a place of its own, and the isometries between neighbours.
#[derive(Debug, Clone)]
pub struct FaceTransitions {
    /// The triangles: those of the metric's triangulation, or pieces of them.
    pub mesh: Arc<Mesh>,
    /// The space of the metric.
    pub space: Space,
    /// Per face, the ambient coordinates of its corners at its own place, in corner order. A triangle of the metric has its first corner at
    /// the origin and its first side along the x axis; its pieces share that place.
    pub corners: PerFace<[[f64; 3]; 3]>,
    /// Per half-edge of a face, the isometry that carries the face beyond it from its own place to the place beside this face; the identity
    /// on the boundary and outside.
    pub across: PerHalfedge<Motion<DoubleDouble>>,
    /// The sum of the faces' areas.
    pub area: f64,
}

impl FaceTransitions {
    /// The transitions of a metric: on its triangulation, or on the pieces of a common subdivision ([`Solution::common_subdivision`]).
    ///
    /// # Errors
    /// Those of [`crate::metric::Metric::lengths`]; [`crate::Error::Layout`] for a subdivision of another triangulation.
    pub fn new(metric: &Solution, subdivision: Option<&Arc<CommonSubdivision>>) -> Result<FaceTransitions> {
        let faces = Faces::precise(metric.mesh(), metric.metric())?;
        let pieces = subdivision.map_or_else(
            || LayoutPieces::Mesh(metric.mesh().clone()),
            |r| LayoutPieces::Subdivision(r.clone()),
        );
        let mesh = match &pieces {
            LayoutPieces::Mesh(mesh) => mesh.clone(),
            LayoutPieces::Subdivision(r) => Arc::new(r.mesh.clone()),
        };
        let mut corners = vec![[[0.0; 3]; 3]; mesh.n_faces()];
        parallel::fill(&mut corners, |f| {
            let f = FaceId::from(f);
            let local = faces.local(pieces.final_face(f));
            pieces.final_barycentric(f).map(|weights| combination(faces.space, local, weights))
        });
        let identity = Motion::identity(faces.space);
        let mut across: Vec<Result<Motion<DoubleDouble>>> =
            (0..mesh.n_halfedges()).map(|_| Ok(identity)).collect();
        parallel::fill(&mut across, |h| {
            let h = HalfedgeId::from(h);
            let inside = !mesh.is_boundary_edge(h.edge());
            match pieces.final_halfedge(h).filter(|_| inside) {
                Some(along) => Ok(faces.across_side(identity, along)?.1.normalised()),
                None => Ok(identity),
            }
        });
        Ok(FaceTransitions {
            space: faces.space,
            corners: corners.into(),
            across: across.into_iter().collect::<Result<Vec<_>>>()?.into(),
            area: faces.area_of(&pieces),
            mesh,
        })
    }
}
