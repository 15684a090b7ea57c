//! The atlas of a surface: its charts, their transitions, and the places of points in charts.

use super::cocycle::CocycleCheck;
use super::draft::ChartDraft;
use super::element::GroupElement;
use super::holonomy::Holonomy;
use super::kind::Structure;
use super::overlaps::{FaceLift, FaceLifts, Transition};
use crate::archive::{in_range, stored};
use crate::error::{Error, Result, check_size};
use crate::flow::Solution;
use crate::geometry::complex::distance;
use crate::geometry::{Space, worse};
use crate::harmonic::Zero;
use crate::mesh::{FaceId, Mesh, Place, VertexId};
use crate::metric::CommonSubdivision;
use std::sync::Arc;

/// A chart: lifts of faces that lie beside each other in the chart's coordinates.
#[derive(Debug, Clone, PartialEq)]
pub struct Chart {
    /// The faces; one that a vertex's star meets twice is there twice.
    pub faces: Vec<FaceId>,
    /// The number of faces in the chart's core, which come first; the others are there for overlaps. A star is all core.
    pub n_core: usize,
    /// The corners of each face, as numbers in `vertices`.
    pub corners: Vec<[u32; 3]>,
    /// The vertices; one that the chart reaches in different ways is there more than once.
    pub vertices: Vec<VertexId>,
    /// The coordinates of these vertices.
    pub coordinates: Vec<[f64; 2]>,
}
stored!(sections Chart { faces, n_core, corners, vertices, coordinates });

/// A point in a chart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChartPoint {
    /// The chart, and the number of the face in it.
    pub lift: FaceLift,
    /// The coordinates in the chart.
    pub coordinates: [f64; 2],
}

/// A geometric structure of a surface, as charts and transitions.
///
/// Charts cover the surface except singular vertices and excluded faces; none has a singular vertex inside. Triangles of charts are those
/// of [`Atlas::mesh`], geodesics of the structure's metric. A point of a triangle is given by weights of the ambient coordinates of its
/// corners, so it is linear in the plane, and in the Klein disk up to a factor.
#[derive(Debug, Clone)]
pub struct Atlas {
    /// The kind of structure.
    pub structure: Structure,
    /// The space in which charts lie.
    pub space: Space,
    /// The triangulation of the charts. Its first vertices are those of the surface, but for an integer structure, whose triangles are halves of
    /// quads; for a surface with boundary that was solved on its
    /// double it is the common subdivision, and has more.
    pub mesh: Arc<Mesh>,
    /// The metric of the triangulation, with the way back to the given surface: that of the structure, or for an atlas from a form the
    /// given one on its Delaunay triangulation.
    pub metric: Arc<Solution>,
    /// The common subdivision, if the triangulation is one.
    pub subdivision: Option<Arc<CommonSubdivision>>,
    /// The places of the vertices on the given surface, for an integer structure: its quad q is faces 2q and 2q + 1.
    pub on_given: Option<Vec<Place>>,
    /// The charts.
    pub charts: Vec<Chart>,
    /// One transition for each connected overlap, from the chart of the lower number to the other.
    pub transitions: Vec<Transition>,
    /// The vertices that no chart has inside, ascending: cone points of the flat metric, boundary vertices with an angle of a full turn or
    /// more, or vertices at the zeros of the form.
    pub singular_vertices: Vec<VertexId>,
    /// The faces of no chart: those at the vertex at infinity of a sphere in the plane, or those that a form maps clockwise or to no area,
    /// each with one of its zeros.
    pub excluded: Vec<FaceId>,
    /// The zeros of the holomorphic 1-form if the atlas is made from one; their multiplicities add up to 2g − 2.
    pub zeros: Vec<Zero>,
    /// Largest |K| at a regular vertex, in radians: the error of the charts' curvature.
    pub curvature_error: f64,
    /// True if the flow converged.
    pub converged: bool,
    /// The holonomy of the structure.
    pub holonomy: Holonomy,
    /// The measured deviation of transitions from the cocycle condition.
    pub cocycles: CocycleCheck,
    /// The charts whose faces are not counterclockwise or overlap.
    pub folded: Vec<u32>,
    pub(super) lifts: FaceLifts,
}
stored!(sections Atlas { structure, space, mesh, metric, subdivision, on_given, charts, transitions,
    singular_vertices, excluded, zeros, curvature_error, converged, holonomy, cocycles, folded, lifts } check Atlas::check_parts);

impl Chart {
    pub(super) fn new(draft: ChartDraft, structure: Structure, space: Space) -> Chart {
        Chart {
            coordinates: draft
                .points
                .iter()
                .map(|&p| structure.coordinates(space, p).map(|x| structure.exact(x)))
                .collect(),
            n_core: if draft.n_core == 0 { draft.faces.len() } else { draft.n_core },
            faces: draft.faces,
            corners: draft.corners,
            vertices: draft.vertices,
        }
    }
}

impl Atlas {
    /// Checks that the parts of an archive fit each other.
    fn check_parts(&self) -> Result<()> {
        let (n, m) = (self.mesh.n_vertices(), self.mesh.n_faces());
        if let Some(places) = &self.on_given {
            check_size("places on the given surface", places.len(), n)?;
        }
        for chart in &self.charts {
            check_size("corners of a chart", chart.corners.len(), chart.faces.len())?;
            check_size("coordinates of a chart", chart.coordinates.len(), chart.vertices.len())?;
            let corners = chart.corners.as_flattened().iter().map(|&k| k as usize);
            in_range("vertex of a chart", corners, chart.vertices.len())?;
            in_range("face", chart.faces.iter().map(|f| f.index()), m)?;
            in_range("vertex", chart.vertices.iter().map(|v| v.index()), n)?;
        }
        for Transition { from, to, pairs, .. } in &self.transitions {
            in_range("chart", [*from, *to].into_iter().map(|k| k as usize), self.charts.len())?;
            for (k, chart) in [*from, *to].into_iter().enumerate() {
                let vertices = pairs.iter().map(|pair| pair[k] as usize);
                in_range("vertex of a chart", vertices, self.charts[chart as usize].vertices.len())?;
            }
        }
        let sizes: Vec<usize> = self.charts.iter().map(|chart| chart.faces.len()).collect();
        self.lifts.check_parts(m, &sizes, self.transitions.len())
    }

    /// The lifts of a face of [`Atlas::mesh`] to charts, ascending; empty for an excluded face.
    ///
    /// # Errors
    /// [`Error::Argument`] for a face that does not exist.
    pub fn lifts(&self, f: FaceId) -> Result<&[FaceLift]> {
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
            |&lift: &FaceLift| ChartPoint { lift, coordinates: self.point(lift, weights.map(|w| w / sum)) };
        Ok(self.lifts.of(f).iter().map(place).collect())
    }

    /// The coordinates of a point in a lift of a face, by weights of the face's corners.
    fn point(&self, lift: FaceLift, weights: [f64; 3]) -> [f64; 2] {
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

    /// The transition between two lifts of one face: it maps coordinates of the first one's chart to those of the second one's.
    ///
    /// # Errors
    /// [`Error::Argument`] if they are not two lifts of one face.
    pub fn between(&self, from: FaceLift, to: FaceLift) -> Result<GroupElement> {
        let face = |lift: FaceLift| {
            let chart = self.charts.get(lift.chart as usize);
            chart.and_then(|chart| chart.faces.get(lift.face as usize)).copied()
        };
        let other = || Error::argument("lifts", format!("{from:?} and {to:?}"), "two lifts of one face");
        let f = face(from).filter(|&f| face(to) == Some(f)).ok_or_else(other)?;
        if from == to {
            return Ok(GroupElement::identity(self.structure));
        }
        let at = |lift| self.lifts.of(f).binary_search(&lift).map_err(|_| other());
        let (i, j) = (at(from)?, at(to)?);
        let element = self.transitions[self.lifts.transition(f, i.min(j), i.max(j)) as usize].element;
        if i < j { Ok(element) } else { element.inverse().ok_or_else(other) }
    }

    /// The coordinates in the chart of lift `to`, from those in the chart of another lift of the same face.
    ///
    /// # Errors
    /// Those of [`Atlas::between`].
    pub fn carry(&self, from: FaceLift, to: FaceLift, coordinates: [f64; 2]) -> Result<[f64; 2]> {
        Ok(self.between(from, to)?.apply(coordinates))
    }

    /// The values of a function of chart points at one point, in every chart that contains it.
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

    /// The largest distance of the image of a shared vertex from the vertex, over the size of the chart in which they are.
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
