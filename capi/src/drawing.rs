//! A surface drawn in the plane, in whatever space its metric lives.

use crate::failure::{Failure, Outcome};
use crate::status::ricci_status;
use ricci::embed::Layout;
use ricci::geometry::model::{Model, distance};
use ricci::mesh::{FaceId, HalfedgeId, PerHalfedge};

/// What the functions on layouts read, of a flat layout or of one in the hyperbolic plane.
pub(crate) struct Drawing {
    /// Per half-edge, the index into `points` of the corner at its origin.
    pub corner_index: PerHalfedge<u32>,
    pub points: Vec<[f64; 2]>,
    pub hyperbolic: Option<Hyperbolic>,
    /// Half-edges of every seam, in order.
    pub seams: Vec<Vec<HalfedgeId>>,
    /// Rotation, translation, residual of every seam in the Euclidean plane.
    pub motions: Option<Vec<[f64; 4]>>,
    pub flipped: Vec<FaceId>,
    pub consistency: f64,
    pub diameter: f64,
    pub area: f64,
}

/// Points of the hyperbolic plane, and the model in which they are drawn.
pub(crate) struct Hyperbolic {
    pub points: Vec<[f64; 3]>,
    pub model: Model,
}

impl From<Layout> for Drawing {
    fn from(layout: Layout) -> Drawing {
        let motion = |seam: &ricci::embed::Seam| {
            let [x, y] = seam.translation;
            [seam.rotation, x, y, seam.residual]
        };
        Drawing {
            motions: Some(layout.seams.iter().map(motion).collect()),
            seams: layout.seams.into_iter().map(|seam| seam.halfedges).collect(),
            corner_index: layout.corner_index,
            points: layout.coordinates,
            hyperbolic: None,
            flipped: layout.flipped,
            consistency: layout.consistency,
            diameter: layout.diameter,
            area: layout.area,
        }
    }
}

pub(crate) fn not_projective() -> Failure {
    let message =
        "the map is not projective in these coordinates: take RICCI_MODEL_KLEIN in the hyperbolic plane";
    Failure::new(ricci_status::RICCI_LAYOUT, message)
}

impl Drawing {
    /// Coordinates of the corner at the origin of `h`.
    pub fn corner(&self, h: HalfedgeId) -> [f64; 2] {
        self.points[self.corner_index[h] as usize]
    }

    /// Distance of two corners in the space of the metric.
    pub fn distance(&self, g: HalfedgeId, h: HalfedgeId) -> f64 {
        let [i, j] = [g, h].map(|h| self.corner_index[h] as usize);
        match &self.hyperbolic {
            Some(Hyperbolic { points, .. }) => distance(points[i], points[j]),
            None => {
                let (p, q) = (self.points[i], self.points[j]);
                (q[0] - p[0]).hypot(q[1] - p[1])
            }
        }
    }

    /// It lies in the Euclidean plane.
    pub fn check_plane(&self) -> Outcome {
        if self.hyperbolic.is_none() { Ok(()) } else { Err(not_projective()) }
    }

    /// What homogeneous weights of vertices are multiplied with at every point; nothing in the Euclidean plane.
    pub fn heights(&self) -> Outcome<Vec<f64>> {
        match &self.hyperbolic {
            None => Ok(Vec::new()),
            Some(Hyperbolic { points, model: Model::Klein }) => Ok(points.iter().map(|p| p[2]).collect()),
            Some(_) => Err(not_projective()),
        }
    }
}
