//! A flat cone metric in Penner coordinates on its Delaunay triangulation, with the angles around its vertices and along its loops, and how
//! they change with the lengths.

use super::dual_loops::DualLoops;
use crate::control::Control;
use crate::error::Result;
use crate::geometry::DoubleDouble;
use crate::geometry::triangle::plane_angles_with_weights;
use crate::mesh::{
    EdgeId, FaceId, FixedEdges, Flip, Mesh, NormalCoordinates, PerFace, PerHalfedge, PerVertex, VertexId,
};
use crate::metric::Metric;
use crate::metric::delaunay::{ClassFlips, FlipQueue};
use crate::parallel;
use std::sync::Arc;

/// The curvature asked for at each vertex and the turning asked for along each loop, radians.
#[derive(Debug, Clone)]
pub(super) struct HolonomyTarget {
    pub curvature: PerVertex<f64>,
    pub turning: Vec<f64>,
}

/// A metric in E² that is Delaunay on its triangulation, with loops on it and the triangulations that are followed through flips. Its
/// Penner coordinates are `λ = 2 ln ℓ`, of which any change is a metric once edges are flipped by Ptolemy's relation.
#[derive(Debug, Clone)]
pub(super) struct HolonomyState {
    pub mesh: Mesh,
    pub metric: Metric,
    pub followed: Vec<NormalCoordinates>,
    pub loops: DualLoops,
    pub flips: usize,
    /// Per face and corner, the angle and half its cotangent.
    pub angles: PerFace<[f64; 3]>,
    pub half_cotangents: PerFace<[f64; 3]>,
}

/// The equations of one linear step: the derivatives of curvature at all vertices but the last and of the loops' turning by the λ of each
/// edge, one row each, as (edge, derivative) in the order of the edges.
pub(super) type DerivativeRows = Vec<Vec<(u32, f64)>>;

impl HolonomyState {
    /// # Errors
    /// Those of [`Metric::measured`].
    pub fn new(
        mesh: Mesh,
        metric: Metric,
        followed: Vec<NormalCoordinates>,
        loops: DualLoops,
    ) -> Result<HolonomyState> {
        let angles = PerFace::filled(mesh.n_faces(), [0.0; 3]);
        let half_cotangents = angles.clone();
        let mut state = HolonomyState { mesh, metric, followed, loops, flips: 0, angles, half_cotangents };
        state.measure()?;
        Ok(state)
    }

    fn measure(&mut self) -> Result<()> {
        let measured = self.metric.measured(&self.mesh)?;
        let mut all = vec![([0.0; 3], [0.0; 3]); self.mesh.n_faces()];
        parallel::fill(&mut all, |f| {
            let (angles, weights) = plane_angles_with_weights(measured.differences_of(f.into()));
            (angles.at, weights)
        });
        self.angles = all.iter().map(|x| x.0).collect::<Vec<_>>().into();
        self.half_cotangents = all.iter().map(|x| x.1).collect::<Vec<_>>().into();
        Ok(())
    }

    /// The state after λ of each edge has changed by `factor · step`, on the Delaunay triangulation of that metric.
    ///
    /// # Errors
    /// Those of [`ClassFlips::restore_delaunay`] and [`Metric::measured`].
    pub fn moved(&self, step: &[f64], factor: f64, control: &Control) -> Result<HolonomyState> {
        let mut next = self.clone();
        let HolonomyState { mesh, metric, followed, loops, flips, .. } = &mut next;
        // Without circles ℓ² = 2 η e^(u_i + u_j), so that λ grows as ln η.
        let eta = Arc::make_mut(&mut metric.eta);
        for (e, change) in (0..).map(EdgeId).zip(step) {
            eta[e] = eta[e] * DoubleDouble::from((factor * change).exp());
        }
        let (vertices, mut queue) = (metric.vertices(), FlipQueue::all(mesh, &FixedEdges::none()));
        let mut record = |mesh: &Mesh, flip: Flip<DoubleDouble>| {
            followed.iter_mut().for_each(|normal| normal.record(mesh, flip.edge));
            loops.before_flip(mesh, flip.edge);
        };
        *flips += ClassFlips { mesh, metric, record: &mut record }
            .restore_delaunay(&vertices, &mut queue, control)?;
        next.measure()?;
        Ok(next)
    }

    /// The turning of each loop, radians.
    pub fn turning(&self) -> Vec<f64> {
        self.loops.turning(&self.mesh, &self.halfedge_angles())
    }

    /// The angle at the origin of each half-edge, in its face.
    pub fn halfedge_angles(&self) -> PerHalfedge<f64> {
        let mut angles = PerHalfedge::filled(self.mesh.n_halfedges(), 0.0);
        for f in self.mesh.faces() {
            self.mesh.face_halfedges(f).iter().zip(self.angles[f]).for_each(|(&h, angle)| angles[h] = angle);
        }
        angles
    }

    /// The curvature of each vertex, radians.
    pub fn curvature(&self) -> PerVertex<f64> {
        let mut curvature = PerVertex::filled(self.mesh.n_vertices(), std::f64::consts::TAU);
        for f in self.mesh.faces() {
            self.mesh
                .face_vertices(f)
                .iter()
                .zip(self.angles[f])
                .for_each(|(&v, angle)| curvature[v] -= angle);
        }
        curvature
    }

    /// What is missing to the target, as changes of angle sums and of turning: of all vertices but the last, then of the loops.
    pub fn residual(&self, target: &HolonomyTarget) -> Vec<f64> {
        let curvature = self.curvature();
        let n = curvature.len().saturating_sub(1);
        let vertices = (0..n).map(VertexId::from).map(|v| curvature[v] - target.curvature[v]);
        vertices.chain(target.turning.iter().zip(self.turning()).map(|(wanted, is)| wanted - is)).collect()
    }

    /// The derivatives of the angle sums and turnings of [`HolonomyState::residual`], with the signs of what is missing.
    pub fn derivatives(&self) -> DerivativeRows {
        let n = self.mesh.n_vertices() - 1;
        let mut rows: DerivativeRows = vec![Vec::new(); n + self.loops.len()];
        for f in self.mesh.faces() {
            for (k, v) in self.mesh.face_vertices(f).into_iter().enumerate().filter(|(_, v)| v.index() < n) {
                rows[v.index()].extend(self.angle_derivative(f, k, 1.0));
            }
        }
        for k in 0..self.loops.len() {
            for passage in self.loops.passages(k) {
                let (corner, sign) = passage.pivot(&self.mesh);
                let Some((f, i)) = self.mesh.corner(corner) else { continue };
                rows[n + k].extend(self.angle_derivative(f, i, sign));
            }
        }
        rows.iter_mut().for_each(sum_equal);
        rows
    }

    /// The derivatives of the angle at a corner by the λ of its triangle's edges, times a factor:
    /// `∂α_i/∂λ_jk = ½ (cot α_j + cot α_k)`, `∂α_i/∂λ_ij = −½ cot α_j`.
    fn angle_derivative(&self, f: FaceId, i: usize, factor: f64) -> [(u32, f64); 3] {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let opposite = self.mesh.opposite_edges(f);
        let w = self.half_cotangents[f];
        [
            (opposite[i].0, factor * (w[j] + w[k])),
            (opposite[k].0, -factor * w[j]),
            (opposite[j].0, -factor * w[k]),
        ]
    }
}

/// Adds up entries of a row that belong to the same edge, and sorts them.
fn sum_equal(row: &mut Vec<(u32, f64)>) {
    row.sort_by_key(|entry| entry.0);
    row.dedup_by(|later, first| {
        let is_same = later.0 == first.0;
        if is_same {
            first.1 += later.1;
        }
        is_same
    });
}
