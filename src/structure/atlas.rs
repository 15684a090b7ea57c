//! Atlases.

use super::cocycle::{Cocycles, cocycles};
use super::draft::Draft;
use super::element::Element;
use super::holonomy::Holonomy;
use super::kind::Structure;
use super::overlaps::{Lift, Lifts, Transition};
use crate::error::{Error, Result};
use crate::flow::Solution;
use crate::geometry::complex::distance;
use crate::geometry::{Space, worse};
use crate::harmonic::Zero;
use crate::mesh::{FaceId, Mesh, VertexId};
use crate::metric::Refinement;
use std::sync::Arc;

/// A chart: lifts of faces, beside each other in the chart's coordinates.
#[derive(Debug, Clone, PartialEq)]
pub struct Chart {
    /// The faces. One that a vertex's star meets twice is there twice.
    pub faces: Vec<FaceId>,
    /// The first so many of them are the chart's core; the others are there for its overlaps. All of them in a star.
    pub n_core: usize,
    /// Per face its corners, as numbers in `vertices`.
    pub corners: Vec<[u32; 3]>,
    /// The vertices; one that the chart reaches by different ways is there more than once.
    pub vertices: Vec<VertexId>,
    /// Their coordinates.
    pub coordinates: Vec<[f64; 2]>,
}

/// A point in a chart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChartPoint {
    /// The chart, and the number of the face in it.
    pub lift: Lift,
    /// Coordinates in the chart.
    pub coordinates: [f64; 2],
}

/// A geometric structure of a surface by charts and transitions.
///
/// Charts cover the surface without the singular vertices and the faces that are excluded; none has a singular vertex inside. The triangles
/// of charts are those of [`Atlas::mesh`]: geodesics of the structure's metric, between whose corners points are by weights of their
/// ambient coordinates (linear in the plane and in the Klein disk up to a factor).
#[derive(Debug, Clone)]
pub struct Atlas {
    /// The kind.
    pub structure: Structure,
    /// The space that the charts are pieces of.
    pub space: Space,
    /// The triangulation that the charts are made of. Its first vertices are those of the surface; of a surface with boundary
    /// that was solved on its double it is the common refinement, and has more.
    pub mesh: Arc<Mesh>,
    /// The metric that the triangulation belongs to, with the way back to the given surface: that of the structure, or for an atlas from a
    /// form the given one on its Delaunay triangulation.
    pub metric: Arc<Solution>,
    /// The common refinement, where the triangulation is that.
    pub refinement: Option<Arc<Refinement>>,
    /// The charts.
    pub charts: Vec<Chart>,
    /// One transition per connected overlap, from the chart of the lower number to the other.
    pub transitions: Vec<Transition>,
    /// Vertices that no chart has inside, ascending: cone points of the flat metric, vertices of the boundary whose angle there is a full
    /// turn or more, or the vertices at the zeros of the form.
    pub singular_vertices: Vec<VertexId>,
    /// Faces of no chart: those at the vertex at infinity of a sphere in the plane, or those that a form does not draw counterclockwise,
    /// each of which holds one of its zeros.
    pub excluded: Vec<FaceId>,
    /// The zeros of the holomorphic 1-form, with multiplicity 2g − 2, if the atlas is made from one.
    pub zeros: Vec<Zero>,
    /// Largest |K| at a vertex that is not singular, radians: what the charts are off the structure's curvature.
    pub curvature_error: f64,
    /// Whether the flow came to its target.
    pub converged: bool,
    /// The holonomy.
    pub holonomy: Holonomy,
    /// How well transitions compose.
    pub cocycles: Cocycles,
    /// Charts whose faces do not lie counterclockwise beside each other.
    pub folded: Vec<u32>,
    lifts: Lifts,
}

/// What an atlas is put together from.
pub(super) struct Parts {
    pub structure: Structure,
    pub space: Space,
    pub mesh: Arc<Mesh>,
    pub drafts: Vec<Draft>,
    pub transitions: Vec<Transition>,
    pub lifts: Lifts,
    pub folded: Vec<u32>,
    pub holonomy: Holonomy,
    pub metric: Arc<Solution>,
    pub refinement: Option<Arc<Refinement>>,
}

impl Atlas {
    pub(super) fn new(parts: Parts) -> Atlas {
        let Parts { structure, space, mesh, drafts, transitions, lifts, folded, holonomy, .. } = parts;
        let chart = |draft: Draft| Chart {
            coordinates: draft.points.iter().map(|&p| structure.coordinates(space, p)).collect(),
            n_core: if draft.n_core == 0 { draft.faces.len() } else { draft.n_core },
            faces: draft.faces,
            corners: draft.corners,
            vertices: draft.vertices,
        };
        let cocycles = cocycles(&lifts, &transitions, mesh.n_faces());
        Atlas {
            structure,
            space,
            charts: drafts.into_iter().map(chart).collect(),
            transitions,
            singular_vertices: Vec::new(),
            excluded: Vec::new(),
            zeros: Vec::new(),
            curvature_error: 0.0,
            converged: true,
            holonomy,
            cocycles,
            folded,
            lifts,
            mesh,
            metric: parts.metric,
            refinement: parts.refinement,
        }
    }

    /// The lifts of a face of [`Atlas::mesh`] to charts, ascending; empty for an excluded one.
    ///
    /// # Errors
    /// [`Error::Argument`] for a face that does not exist.
    pub fn lifts(&self, f: FaceId) -> Result<&[Lift]> {
        self.check_face(f)?;
        Ok(self.lifts.of(f))
    }

    /// All charts that contain a point, given by its face and the weights of the face's corners, with the point's coordinates there.
    ///
    /// # Errors
    /// [`Error::Argument`] for a face that does not exist, or weights that are negative or without a positive sum.
    pub fn places(&self, f: FaceId, weights: [f64; 3]) -> Result<Vec<ChartPoint>> {
        self.check_face(f)?;
        let sum: f64 = weights.iter().sum();
        if !(sum > 0.0 && sum.is_finite() && weights.iter().all(|&w| w >= 0.0)) {
            let need = "three numbers, none negative, that have a positive sum";
            return Err(Error::argument("weights", format!("{weights:?}"), need));
        }
        let place =
            |&lift: &Lift| ChartPoint { lift, coordinates: self.point(lift, weights.map(|w| w / sum)) };
        Ok(self.lifts.of(f).iter().map(place).collect())
    }

    /// The coordinates of a point of a lift of a face, by weights of its corners.
    fn point(&self, lift: Lift, weights: [f64; 3]) -> [f64; 2] {
        let chart = &self.charts[lift.chart as usize];
        let corners = chart.corners[lift.face as usize].map(|v| chart.coordinates[v as usize]);
        if let Some(k) = weights.iter().position(|&w| w == 1.0) {
            return corners[k];
        }
        let ambient = corners.map(|p| self.structure.ambient(self.space, p));
        let [x, y, w] = [0, 1, 2].map(|i| (0..3).map(|k| weights[k] * ambient[k][i]).sum::<f64>());
        let norm = match self.space {
            Space::E2 => w,
            Space::S2 => (x * x + y * y + w * w).sqrt(),
            Space::H2 => (w * w - x * x - y * y).sqrt(),
        };
        self.structure.coordinates(self.space, [x / norm, y / norm, w / norm])
    }

    /// The transition between two lifts of one face: from the coordinates of the first one's chart to those of the second one's.
    ///
    /// # Errors
    /// [`Error::Argument`] for what are no two lifts of one face.
    pub fn between(&self, from: Lift, to: Lift) -> Result<Element> {
        let face = |lift: Lift| {
            let chart = self.charts.get(lift.chart as usize);
            chart.and_then(|chart| chart.faces.get(lift.face as usize)).copied()
        };
        let other = || Error::argument("lifts", format!("{from:?} and {to:?}"), "two lifts of one face");
        let f = face(from).filter(|&f| face(to) == Some(f)).ok_or_else(other)?;
        if from == to {
            return Ok(Element::identity(self.structure));
        }
        let at = |lift| self.lifts.of(f).binary_search(&lift).map_err(|_| other());
        let (i, j) = (at(from)?, at(to)?);
        let element = self.transitions[self.lifts.transition(f, i.min(j), i.max(j)) as usize].element;
        match i < j {
            true => Ok(element),
            false => element.inverse().ok_or_else(other),
        }
    }

    /// Moves coordinates from the chart of one lift of a face to that of another.
    ///
    /// # Errors
    /// Those of [`Atlas::between`].
    pub fn carry(&self, from: Lift, to: Lift, coordinates: [f64; 2]) -> Result<[f64; 2]> {
        Ok(self.between(from, to)?.apply(coordinates))
    }

    /// The value of a function of charts at a point, in every chart that contains it.
    ///
    /// # Errors
    /// Those of [`Atlas::places`].
    pub fn evaluate<T>(
        &self,
        f: FaceId,
        weights: [f64; 3],
        function: impl Fn(ChartPoint) -> T,
    ) -> Result<Vec<T>> {
        Ok(self.places(f, weights)?.into_iter().map(function).collect())
    }

    /// The largest distance between the image of a shared vertex and its place, over the size of the chart where that is.
    pub fn transition_residual(&self) -> f64 {
        let size = |chart: &Chart| {
            let range = |i: usize| {
                let all = chart.coordinates.iter().map(|p| p[i]);
                all.clone().fold(f64::MIN, f64::max) - all.fold(f64::MAX, f64::min)
            };
            range(0).max(range(1))
        };
        let sizes: Vec<f64> = self.charts.iter().map(size).collect();
        let miss = |t: &Transition| {
            let [from, to] = [t.from, t.to].map(|chart| &self.charts[chart as usize]);
            let off = t.pairs.iter().map(|&[i, j]| {
                let image = t.element.apply(from.coordinates[i as usize]);
                distance(image, to.coordinates[j as usize])
            });
            off.fold(0.0, worse) / sizes[t.to as usize]
        };
        self.transitions.iter().map(miss).fold(0.0, worse)
    }

    fn check_face(&self, f: FaceId) -> Result<()> {
        if f.index() < self.mesh.n_faces() {
            return Ok(());
        }
        Err(Error::argument("face", f, "one of the triangulation of the atlas"))
    }
}
