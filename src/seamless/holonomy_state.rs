//! A flat cone metric in Penner coordinates on its Delaunay triangulation, with the angles around its vertices and along its loops, and how
//! they change with the lengths.

use super::dual_loops::DualLoops;
use super::sectors::Sectors;
use crate::control::Control;
use crate::error::Result;
use crate::geometry::DoubleDouble;
use crate::geometry::triangle::plane_angles_with_weights;
use crate::mesh::{
    EdgeId, FaceId, FixedEdges, Flip, Mesh, NormalCoordinates, PerEdge, PerFace, PerHalfedge, VertexId,
};
use crate::metric::Metric;
use crate::metric::delaunay::{ClassFlips, FlipQueue};
use crate::parallel;
use std::sync::Arc;

/// The angle asked for in each sector and the turning asked for along each path, radians.
#[derive(Debug, Clone)]
pub(super) struct HolonomyTarget {
    pub angles: Vec<f64>,
    pub turning: Vec<f64>,
}

/// A metric in E² that is Delaunay on its triangulation but for the features, with paths on it and the triangulations that are followed
/// through flips. Its Penner coordinates are `λ = 2 ln ℓ`, of which any change is a metric once edges are flipped by Ptolemy's relation;
/// triangles at features, which are not flipped, may break.
#[derive(Debug, Clone)]
pub(super) struct HolonomyState {
    pub mesh: Mesh,
    pub metric: Metric,
    pub followed: Vec<NormalCoordinates>,
    pub loops: DualLoops,
    pub sectors: Arc<Sectors>,
    pub fixed: FixedEdges,
    /// Per edge, λ of the metric that the result is to be near, on the same triangulation.
    pub wanted: PerEdge<f64>,
    pub flips: usize,
    /// Per face and corner, the angle and half its cotangent.
    pub angles: PerFace<[f64; 3]>,
    pub half_cotangents: PerFace<[f64; 3]>,
    /// True if some triangle has no positive area.
    pub is_broken: bool,
}

/// The equations of one linear step: the derivatives of the angles of sectors, of each piece all but the last, and of the paths' turning by the
/// λ of each edge, one row each, as (edge, derivative) in the order of the edges.
pub(super) type DerivativeRows = Vec<Vec<(u32, f64)>>;

impl HolonomyState {
    /// The state of a metric, with the paths from vertex 0.
    ///
    /// # Errors
    /// Those of [`Metric::measured`].
    pub fn new(
        mesh: Mesh,
        metric: Metric,
        followed: Vec<NormalCoordinates>,
        sectors: Sectors,
    ) -> Result<HolonomyState> {
        let loops = DualLoops::between(&mesh, &sectors, VertexId(0));
        let angles = PerFace::filled(mesh.n_faces(), [0.0; 3]);
        let mut state = HolonomyState {
            half_cotangents: angles.clone(),
            fixed: sectors.fixed(&mesh)?,
            wanted: PerEdge::filled(mesh.n_edges(), 0.0),
            sectors: Arc::new(sectors),
            flips: 0,
            is_broken: false,
            mesh,
            metric,
            followed,
            loops,
            angles,
        };
        state.measure()?;
        state.wanted = state.penner_coordinates()?;
        Ok(state)
    }

    fn measure(&mut self) -> Result<()> {
        let measured = self.metric.measured(&self.mesh)?;
        let mut all = vec![([0.0; 3], [0.0; 3], false); self.mesh.n_faces()];
        parallel::fill(&mut all, |f| {
            let differences = measured.differences_of(f.into());
            let (angles, weights) = plane_angles_with_weights(differences);
            (angles.at, weights, differences.iter().any(|r| *r <= 0.0))
        });
        self.angles = all.iter().map(|x| x.0).collect::<Vec<_>>().into();
        self.half_cotangents = all.iter().map(|x| x.1).collect::<Vec<_>>().into();
        self.is_broken = all.iter().any(|x| x.2);
        Ok(())
    }

    /// Per edge, λ = 2 ln ℓ.
    ///
    /// # Errors
    /// Those of [`Metric::lengths`].
    pub fn penner_coordinates(&self) -> Result<PerEdge<f64>> {
        let lengths = self.metric.lengths(&self.mesh)?;
        Ok(PerEdge::from_fn(self.mesh.n_edges(), |e| 2.0 * lengths[e].ln()))
    }

    /// Root mean square over the edges of the difference of λ from the one wanted, less its mean.
    ///
    /// # Errors
    /// Those of [`Metric::lengths`].
    pub fn length_change(&self) -> Result<f64> {
        let penner = self.penner_coordinates()?;
        let change: Vec<f64> =
            penner.iter().zip(self.wanted.iter()).map(|(is, wanted)| is - wanted).collect();
        let n = change.len().max(1) as f64;
        let mean = change.iter().sum::<f64>() / n;
        Ok((change.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / n).sqrt())
    }

    /// The state after λ of each edge has changed by `factor · step`, on the Delaunay triangulation of that metric.
    ///
    /// # Errors
    /// Those of [`ClassFlips::restore_delaunay`] and [`Metric::measured`].
    pub fn moved(&self, step: &[f64], factor: f64, control: &Control) -> Result<HolonomyState> {
        let mut next = self.clone();
        let HolonomyState { mesh, metric, followed, loops, wanted, fixed, flips, .. } = &mut next;
        // Without circles ℓ² = 2 η e^(u_i + u_j), so that λ grows as ln η.
        let eta = Arc::make_mut(&mut metric.eta);
        for (e, change) in (0..).map(EdgeId).zip(step) {
            eta[e] = eta[e] * DoubleDouble::from((factor * change).exp());
        }
        let (vertices, mut queue) = (metric.vertices(), FlipQueue::all(mesh, fixed));
        let mut record = |mesh: &Mesh, flip: Flip<DoubleDouble>| {
            followed.iter_mut().for_each(|normal| normal.record(mesh, flip.edge));
            loops.before_flip(mesh, flip.edge);
            wanted[flip.edge] = other_diagonal(mesh, wanted, flip.edge);
        };
        *flips += ClassFlips { mesh, metric, record: &mut record }
            .restore_delaunay(&vertices, &mut queue, control)?;
        next.measure()?;
        Ok(next)
    }

    /// The turning of each path, radians.
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

    /// The angle of each sector, radians.
    pub fn sector_angles(&self) -> Vec<f64> {
        let corners = self.sectors.of_corners(&self.mesh);
        let mut sum = vec![0.0; self.sectors.len()];
        for f in self.mesh.faces() {
            let sides = self.mesh.face_halfedges(f);
            sides.iter().zip(self.angles[f]).for_each(|(&h, angle)| sum[corners[h] as usize] += angle);
        }
        sum
    }

    /// Per sector the number of its equation: the angles of the last sector of each piece follow from those of the others.
    pub fn equations(&self) -> Vec<Option<usize>> {
        let mut equation: Vec<Option<usize>> = vec![Some(0); self.sectors.len()];
        let mut has_last = vec![false; self.sectors.n_pieces];
        for (sector, &piece) in self.sectors.piece.iter().enumerate().rev() {
            if !std::mem::replace(&mut has_last[piece as usize], true) {
                equation[sector] = None;
            }
        }
        for (number, slot) in equation.iter_mut().filter(|slot| slot.is_some()).enumerate() {
            *slot = Some(number);
        }
        equation
    }

    /// What is missing to the target: of the angles of sectors, then of turning.
    pub fn residual(&self, target: &HolonomyTarget) -> Vec<f64> {
        let angles = self.sector_angles();
        let has_equation = self.equations();
        let sectors = (0..angles.len()).filter(|&s| has_equation[s].is_some());
        let missing = sectors.map(|s| target.angles[s] - angles[s]);
        missing.chain(target.turning.iter().zip(self.turning()).map(|(wanted, is)| wanted - is)).collect()
    }

    /// The derivatives of the angles and turnings of [`HolonomyState::residual`].
    pub fn derivatives(&self) -> DerivativeRows {
        let (equations, corners) = (self.equations(), self.sectors.of_corners(&self.mesh));
        let n = equations.iter().flatten().count();
        let mut rows: DerivativeRows = vec![Vec::new(); n + self.loops.len()];
        for f in self.mesh.faces() {
            for (k, h) in self.mesh.face_halfedges(f).into_iter().enumerate() {
                if let Some(row) = equations[corners[h] as usize] {
                    rows[row].extend(self.angle_derivative(f, k, 1.0));
                }
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
    pub fn angle_derivative(&self, f: FaceId, i: usize, factor: f64) -> [(u32, f64); 3] {
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

/// λ of the other diagonal of an edge's quadrilateral by Ptolemy's relation, `e f = a c + b d` between lengths.
fn other_diagonal(mesh: &Mesh, penner: &PerEdge<f64>, edge: EdgeId) -> f64 {
    let [jk, ki, il, lj] = mesh.quadrilateral(edge.halfedge()).map(|h| penner[h.edge()]);
    let (p, q) = (0.5 * (jk + il), 0.5 * (ki + lj));
    let (large, small) = (p.max(q), p.min(q));
    2.0 * (large + (small - large).exp().ln_1p()) - penner[edge]
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

/// The largest absolute value.
pub(super) fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |top: f64, x| top.max(x.abs()))
}
