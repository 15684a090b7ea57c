//! How the neighbouring triangles of a metric lie to each other, without a layout.

use super::faces::{Faces, combination, corner_of};
use super::frame::Walk;
use super::pieces::Pieces;
use crate::error::Result;
use crate::flow::Solution;
use crate::geometry::{DoubleDouble, Motion, Space};
use crate::mesh::{FaceId, HalfedgeId, Mesh, PerFace, PerHalfedge};
use crate::metric::Refinement;
use crate::parallel;
use std::sync::Arc;

/// The triangles of a metric, each in a place of its own, and the isometries between neighbours.
#[derive(Debug, Clone)]
pub struct Steps {
    /// The triangles: the metric's triangulation, or pieces of it.
    pub mesh: Arc<Mesh>,
    /// The space of the metric.
    pub space: Space,
    /// Ambient coordinates of the corners of each face in the place of its own, in corner order. The pieces of one triangle of the metric
    /// share that triangle's place: its first corner at the origin, its first side along the x axis.
    pub corners: PerFace<[[f64; 3]; 3]>,
    /// Per half-edge of a face, the isometry that brings the face beyond it from its own place to where it lies beside this one; the
    /// identity on the boundary and outside.
    pub across: PerHalfedge<Motion<DoubleDouble>>,
    /// The sum of the faces' areas.
    pub area: f64,
}

/// The steps of a metric: on its triangulation, or on the pieces of a common refinement ([`Solution::refinement`]).
///
/// # Errors
/// Those of [`crate::metric::Metric::lengths`]; [`crate::Error::Layout`] for a refinement of another triangulation.
pub fn steps(metric: &Solution, refinement: Option<&Arc<Refinement>>) -> Result<Steps> {
    let faces = Faces::precise(metric.mesh(), metric.metric())?;
    let pieces =
        refinement.map_or_else(|| Pieces::Mesh(metric.mesh().clone()), |r| Pieces::Refinement(r.clone()));
    let mesh = match &pieces {
        Pieces::Mesh(mesh) => mesh.clone(),
        Pieces::Refinement(r) => Arc::new(r.mesh.clone()),
    };
    let mut corners = vec![[[0.0; 3]; 3]; mesh.n_faces()];
    parallel::fill(&mut corners, |f| {
        let f = FaceId::from(f);
        let local = faces.local(pieces.final_face(f));
        pieces.final_barycentric(f).map(|weights| combination(faces.space, local, weights))
    });
    let still = Motion::identity(faces.space);
    let mut across: Vec<Result<Motion<DoubleDouble>>> = (0..mesh.n_halfedges()).map(|_| Ok(still)).collect();
    parallel::fill(&mut across, |h| {
        let h = HalfedgeId::from(h);
        let inside = !mesh.is_boundary_edge(h.edge());
        match pieces.final_halfedge(h).filter(|_| inside) {
            Some(along) => step(&faces, along),
            None => Ok(still),
        }
    });
    let whole = if faces.mesh.is_closed() && !mesh.is_closed() { 0.5 } else { 1.0 };
    Ok(Steps {
        space: faces.space,
        corners: corners.into(),
        across: across.into_iter().collect::<Result<Vec<_>>>()?.into(),
        area: whole * faces.area(),
        mesh,
    })
}

/// The isometry from the place of the face beyond a half-edge to that of the face on its left.
fn step(faces: &Faces<Motion<DoubleDouble>>, along: HalfedgeId) -> Result<Motion<DoubleDouble>> {
    let (face, side) = corner_of(faces.mesh, along)?;
    let (next, k) = corner_of(faces.mesh, along.twin())?;
    let identity: Motion<DoubleDouble> = Walk::identity(faces.space);
    let frame = faces.side(face, side, identity);
    Ok(faces.around(next, k, faces.across(frame, along))[0].normalised())
}
