//! Surfaces that charts are developed from: triangles with the isometries between neighbours.

use super::kind::straight;
use crate::embed::FaceTransitions;
use crate::error::{Error, Result};
use crate::geometry::motion::precise_point;
use crate::geometry::triangle_overlap::TriangleCorners;
use crate::geometry::{DoubleDouble, Motion, Space};
use crate::harmonic::ComplexForm;
use crate::mesh::{FaceId, HalfedgeId, Mesh, PerFace, PerHalfedge, PerVertex};
use std::sync::Arc;

/// A developable surface: faces in a space, isometries across their sides, excluded faces and singular vertices.
pub(super) struct DevelopableSurface {
    pub faces: FaceTransitions,
    /// Faces that no chart may contain.
    pub excluded: PerFace<bool>,
    /// Vertices that no chart may contain inside.
    pub singular: PerVertex<bool>,
    /// Charts begin at the first corner of a face and not at its middle.
    pub begins_at_corners: bool,
    /// The holonomy around a singular vertex is a rotation.
    pub turns: bool,
}

impl DevelopableSurface {
    /// The surface of given faces, with no excluded faces or singular vertices.
    pub fn new(faces: FaceTransitions) -> DevelopableSurface {
        let excluded = PerFace::filled(faces.mesh.n_faces(), false);
        let singular = PerVertex::filled(faces.mesh.n_vertices(), false);
        DevelopableSurface { faces, excluded, singular, begins_at_corners: false, turns: false }
    }

    /// The surface with given points of a space as vertices; faces with a point that is not finite are excluded.
    pub fn of_points(
        mesh: &Arc<Mesh>,
        space: Space,
        point: impl Fn(usize) -> [f64; 3],
    ) -> DevelopableSurface {
        let corners =
            PerFace::from_fn(mesh.n_faces(), |f: FaceId| mesh.face_vertices(f).map(|v| point(v.index())));
        let across = PerHalfedge::filled(mesh.n_halfedges(), Motion::identity(space));
        let mut surface = DevelopableSurface::new(FaceTransitions {
            mesh: mesh.clone(),
            space,
            corners,
            across,
            area: f64::NAN,
        });
        for f in mesh.faces() {
            surface.excluded[f] = !surface.faces.corners[f].as_flattened().iter().all(|x| x.is_finite());
        }
        surface
    }

    /// The surface developed to the plane by the integrals of a closed form; faces that are not counterclockwise there are excluded.
    pub fn of_form(mesh: &Arc<Mesh>, form: &ComplexForm) -> Result<DevelopableSurface> {
        let corners = PerFace::from_fn(mesh.n_faces(), |f: FaceId| {
            let [first, second, _] = mesh.face_halfedges(f).map(|h| form.along(h));
            [[0.0, 0.0, 1.0], [first[0], first[1], 1.0], [first[0] + second[0], first[1] + second[1], 1.0]]
        });
        let place = |h: HalfedgeId| -> Result<[f64; 2]> {
            let none = || Error::Layout(format!("half-edge {h} belongs to no face"));
            let (f, k) = mesh.corner(h).ok_or_else(none)?;
            let [x, y, _] = corners[f][k];
            Ok([x, y])
        };
        let still = Motion::identity(Space::E2);
        let step = |h: HalfedgeId| -> Result<Motion<DoubleDouble>> {
            if mesh.is_boundary_edge(h.edge()) {
                return Ok(still);
            }
            // The origin of h in the coordinates of its face, and in those of the face beyond.
            let (here, beyond) = (place(h)?, place(mesh.next(h.twin()))?);
            let by = [0, 1].map(|i| DoubleDouble::from(here[i]) - DoubleDouble::from(beyond[i]));
            Ok(Motion::in_plane([1.0, 0.0].map(DoubleDouble::from), by))
        };
        let across = mesh.halfedges().map(step).collect::<Result<Vec<_>>>()?.into();
        let clockwise = |f: FaceId| {
            let [_, p, q] = corners[f];
            p[0] * q[1] - p[1] * q[0] <= 0.0
        };
        let excluded = PerFace::from_fn(mesh.n_faces(), clockwise);
        let faces = FaceTransitions { mesh: mesh.clone(), space: Space::E2, corners, across, area: f64::NAN };
        Ok(DevelopableSurface { excluded, ..DevelopableSurface::new(faces) })
    }

    /// The same plane surface with all lengths multiplied by a factor.
    pub fn scaled(mut self, factor: f64) -> DevelopableSurface {
        let faces = &mut self.faces;
        for corner in faces.corners.iter_mut().flatten() {
            *corner = [factor * corner[0], factor * corner[1], corner[2]];
        }
        for step in faces.across.iter_mut() {
            step.b = step.b.map(|x| x * factor.into());
        }
        faces.area *= factor * factor;
        self
    }

    pub fn mesh(&self) -> &Mesh {
        &self.faces.mesh
    }

    /// The ambient coordinates of the corners of a face after the motion `place`.
    pub fn corners(&self, f: FaceId, place: &Motion<DoubleDouble>) -> [[f64; 3]; 3] {
        let space = self.faces.space;
        self.faces.corners[f].map(|p| place.apply(precise_point(space, p)).map(f64::from))
    }

    /// The motion that takes corner `k` of a face to the origin; if there is no `k` the face's middle, or its first corner.
    pub fn place_about(&self, f: FaceId, k: Option<usize>) -> Motion<DoubleDouble> {
        let (space, corners) = (self.faces.space, self.faces.corners[f]);
        let at = match k.or(self.begins_at_corners.then_some(0)) {
            Some(k) => precise_point(space, corners[k]),
            None => middle(space, corners),
        };
        if space == Space::S2 && f64::from(at[2]) < 0.0 {
            // From the lower half of the sphere it goes by way of the half turn about the x axis, since the antipode has no shortest way.
            let [zero, one] = [0.0, 1.0].map(DoubleDouble::from);
            let over = Motion { space, a: [zero; 2], b: [zero, one] };
            return Motion::to_origin(space, over.apply(at)).compose(&over);
        }
        Motion::to_origin(space, at)
    }

    /// A length of the size of the whole surface: in E² the root of its area, elsewhere 1.
    pub fn size(&self) -> f64 {
        if self.faces.space != Space::E2 {
            return 1.0;
        }
        let area = |[a, b, c]: &[[f64; 3]; 3]| {
            let doubled = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
            if doubled.is_finite() { 0.5 * doubled.abs() } else { 0.0 }
        };
        self.faces.corners.iter().map(area).sum::<f64>().sqrt()
    }
}

/// The point of a space in the direction of the sum of three points.
fn middle(space: Space, corners: [[f64; 3]; 3]) -> [DoubleDouble; 3] {
    let [x, y, w] = [0, 1, 2].map(|i| corners[0][i] + corners[1][i] + corners[2][i]);
    let norm = match space {
        Space::E2 => w,
        Space::H2 => (w * w - x * x - y * y).max(1.0).sqrt(),
        Space::S2 => (x * x + y * y + w * w).sqrt(),
    };
    precise_point(space, [x / norm, y / norm, w / norm])
}

/// The corners of a triangle in coordinates in which geodesics are straight; none if a corner has no such coordinates.
pub(super) fn straight_triangle(space: Space, corners: [[f64; 3]; 3]) -> Option<TriangleCorners> {
    let [p, q, r] = corners.map(|p| straight(space, p));
    Some([p?, q?, r?])
}
