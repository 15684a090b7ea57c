//! The layout of a planar domain, from places of its vertices in the plane.

use super::layout::bounding_diagonal;
use super::layout::{Layout, distance, distance_from_origin, flat};
use super::pieces::LayoutPieces;
use crate::error::{Error, Result, check_size};
use crate::geometry::{Space, triangle};
use crate::mesh::{Mesh, PerFace, PerHalfedge, PerVertex};
use crate::metric::CommonSubdivision;
use crate::parallel;
use crate::topology::CutGraph;
use std::sync::Arc;

/// The places of a subdivision's vertices in the plane, and how well they fit the metric.
pub(crate) struct PlanarPlaces {
    /// Per vertex of the subdivision.
    pub plane: PerVertex<[f64; 2]>,
    /// [`Layout::disagreement`].
    pub disagreement: f64,
    /// [`Layout::local_consistency`].
    pub local_consistency: f64,
}

impl Layout {
    /// The layout of a planar domain in E², without a cut, from places of the vertices of a subdivision. `given`: the surface as it came,
    /// which the subdivision refines.
    ///
    /// # Errors
    /// [`Error::Size`]; [`Error::Layout`] for a place that is not finite.
    pub(crate) fn of_planar_domain(
        given: &Arc<Mesh>,
        subdivision: Arc<CommonSubdivision>,
        places: PlanarPlaces,
    ) -> Result<Layout> {
        let PlanarPlaces { plane, disagreement, local_consistency } = places;
        let mesh = &subdivision.mesh;
        check_size("places", plane.len(), mesh.n_vertices())?;
        if let Some(v) = mesh.vertices().find(|&v| plane[v].iter().any(|x| !x.is_finite())) {
            return Err(Error::Layout(format!("vertex {v} of the subdivision has no place in the plane")));
        }
        let points: Vec<[f64; 3]> = plane.iter().map(|&[x, y]| [x, y, 1.0]).collect();
        let coordinates = plane.into_vec();
        let mut layout = Layout {
            space: Space::E2,
            cut: CutGraph::empty(mesh),
            corner_index: PerHalfedge::from_fn(mesh.n_halfedges(), |h| mesh.origin(h).0),
            seams: Vec::new(),
            flipped: Vec::new(),
            degenerate: Vec::new(),
            broken: Vec::new(),
            disagreement,
            local_consistency,
            radius: points.iter().map(|&p| distance_from_origin(Space::E2, p)).fold(0.0, f64::max),
            diameter: bounding_diagonal(&coordinates),
            area: 0.0,
            scale: 1.0,
            input: Some((given.clone(), CutGraph::empty(given))),
            side: PerHalfedge::filled(mesh.n_halfedges(), 0),
            n_steps: mesh.n_faces(),
            frames: Vec::new(),
            patch: PerFace::from(Vec::new()),
            points,
            remainders: Vec::new(),
            coordinates,
            pieces: LayoutPieces::Subdivision(subdivision),
        };
        layout.measure_area();
        layout.find_flat();
        Ok(layout)
    }

    /// Sets the area to the sum over the triangles that are laid out, which differs from that of the whole surface if disks are left out.
    pub(crate) fn measure_area(&mut self) {
        let mut areas = vec![0.0; self.mesh().n_faces()];
        parallel::fill(&mut areas, |f| {
            let points = self.face_points(f.into());
            triangle::area(
                self.space,
                [1, 2, 0].map(|k| distance(self.space, points[k], points[(k + 1) % 3])),
            )
        });
        self.area = areas.iter().sum();
    }

    /// The plane coordinates of a point in ambient coordinates: in E² its own, in H² those of the Poincaré disk, in S² the stereographic
    /// projection.
    pub fn flat(&self, point: [f64; 3]) -> [f64; 2] {
        flat(self.space, point)
    }
}
