//! The smoothest field of four directions on a closed surface \[KCPS13\], and its cones.

use crate::control::{Control, Stage};
use crate::error::{Error, Result};
use crate::geometry::complex::{Complex, conj, mul};
use crate::geometry::random::SplitMix64;
use crate::geometry::triangle::{area_from, half_differences, plane_angles_with_weights};
use crate::linalg::{Cholesky, Pattern, Symmetric};
use crate::mesh::{FaceId, HalfedgeId, Mesh, PerHalfedge, PerVertex, VertexId};
use crate::metric::Surface;
use crate::metric::delaunay::{IntrinsicOptions, Triangulated, intrinsic_delaunay};
use crate::metric::lengths::face_lengths;
use std::collections::BTreeSet;
use std::f64::consts::{PI, TAU};

/// Steps of inverse iteration towards the field of least energy.
const STEPS: usize = 30;
/// Quarter turns of the most curved cone: around one with two quads both would share two edges.
const MOST_CURVED_OF_FIELD: i32 = 1;
/// Shift of the energy, relative to its mean diagonal: the energy of a parallel field is 0.
const SHIFT: f64 = 1e-9;

/// The curvature of the cones of the smoothest field of four directions, in quarter turns per vertex (V entries, total 4χ). A cone that lies
/// inside a triangle goes to the corner whose own curvature is nearest to what it has then, or near it, so that all have three quads or more.
///
/// # Errors
/// Those of [`intrinsic_delaunay`]; [`Error::Factorisation`]; [`Error::Cancelled`].
pub fn field_cones(surface: &Surface, control: &Control) -> Result<PerVertex<i32>> {
    let (mesh, lengths) = (Mesh::clone(surface.mesh()), surface.lengths().as_ref().clone());
    let mut flat = Triangulated { mesh, lengths, geometry: surface.geometry() };
    intrinsic_delaunay(&mut flat, IntrinsicOptions::default(), &mut |_, _| {}, control)?;
    let frames = VertexFrames::new(&flat);
    let field = frames.smoothest_field(control)?;
    Ok(frames.cones(&field))
}

/// Tangent directions at vertices, whose angles are scaled so that a turn around a vertex is 2π.
struct VertexFrames<'a> {
    mesh: &'a Mesh,
    /// Per half-edge, its direction at its origin, radians.
    direction: PerHalfedge<f64>,
    /// Per half-edge, the scaled angle at its origin, in its face.
    angle: PerHalfedge<f64>,
    /// Per half-edge, half the cotangent of the angle opposite to it in its face.
    half_cotangent: PerHalfedge<f64>,
    curvature: PerVertex<f64>,
    mass: PerVertex<f64>,
}

impl VertexFrames<'_> {
    fn new(flat: &Triangulated) -> VertexFrames<'_> {
        let mesh = &flat.mesh;
        let mut angle = PerHalfedge::filled(mesh.n_halfedges(), 0.0);
        let mut half_cotangent = angle.clone();
        let mut mass = PerVertex::filled(mesh.n_vertices(), 0.0);
        let mut total = mass.clone();
        for f in mesh.faces() {
            let r = half_differences(face_lengths(mesh, &flat.lengths, f));
            let (angles, weights) = plane_angles_with_weights(r);
            let area = area_from(flat.geometry, r);
            let sides = mesh.face_halfedges(f);
            for k in 0..3 {
                angle[sides[k]] = angles.at[k];
                half_cotangent[sides[(k + 1) % 3]] = weights[k];
                total[mesh.origin(sides[k])] += angles.at[k];
                mass[mesh.origin(sides[k])] += area / 3.0;
            }
        }
        let curvature = PerVertex::from_fn(mesh.n_vertices(), |v| TAU - total[v]);
        let mut direction = PerHalfedge::filled(mesh.n_halfedges(), 0.0);
        for v in mesh.vertices() {
            let mut sum = 0.0;
            // Counterclockwise: the half-edge after h is the twin of the one before it in its face.
            let mut h = mesh.out(v);
            loop {
                angle[h] *= TAU / total[v];
                direction[h] = sum;
                sum += angle[h];
                h = mesh.prev(h).twin();
                if h == mesh.out(v) {
                    break;
                }
            }
        }
        VertexFrames { mesh, direction, angle, half_cotangent, curvature, mass }
    }

    /// The angle by which parallel transport along a half-edge turns directions from the frame of its origin to that of its tip.
    fn transport(&self, h: HalfedgeId) -> f64 {
        self.direction[h.twin()] + PI - self.direction[h]
    }

    /// Four times that angle as a rotation.
    fn fourfold_transport(&self, h: HalfedgeId) -> Complex {
        let (sin, cos) = (4.0 * self.transport(h)).sin_cos();
        [cos, sin]
    }

    /// The field z = e^{4iθ} of least energy `Σ w |z_j − r z_i|²` for its mass.
    fn smoothest_field(&self, control: &Control) -> Result<Vec<Complex>> {
        let n = self.mesh.n_vertices();
        let (pattern, mut values) = self.energy()?;
        let mean = (0..2 * n).map(|i| values[pattern.diagonal(i)]).sum::<f64>() / (2 * n) as f64;
        let total: f64 = self.mass.iter().sum();
        for v in 0..n {
            let shift = SHIFT * mean * self.mass[VertexId::from(v)] * n as f64 / total + f64::EPSILON * mean;
            (2 * v..2 * v + 2).for_each(|i| values[pattern.diagonal(i)] += shift);
        }
        let mut cholesky = Cholesky::analyse(&pattern)?;
        control.check()?;
        let failed = |_| Error::Factorisation {
            size: 2 * n,
            message: "the energy of fields of directions is not positive definite".into(),
        };
        cholesky.factor(Symmetric { pattern: &pattern, values: &values }).map_err(failed)?;
        control.check()?;
        let mut random = SplitMix64::new(1);
        let mut field: Vec<f64> = (0..2 * n).map(|_| random.unit() - 0.5).collect();
        for k in 0..STEPS {
            control.step(Stage::Flow, k as f64 / STEPS as f64)?;
            field.iter_mut().enumerate().for_each(|(i, x)| *x *= self.mass[VertexId::from(i / 2)]);
            cholesky.solve(&mut field);
            let norm = field.iter().map(|x| x * x).sum::<f64>().sqrt();
            field.iter_mut().for_each(|x| *x /= norm);
        }
        Ok(field.chunks_exact(2).map(|z| [z[0], z[1]]).collect())
    }

    fn energy(&self) -> Result<(Pattern, Vec<f64>)> {
        let mesh = self.mesh;
        let ends = |h: HalfedgeId| [mesh.origin(h), mesh.tip(h)].map(|v| 2 * v.index());
        let block = |[i, j]: [usize; 2]| [(i, j), (i, j + 1), (i + 1, j), (i + 1, j + 1)];
        let pairs = mesh.edges().flat_map(|e| block(ends(e.halfedge())));
        let pairs: Vec<_> = pairs.map(|(i, j)| (i as u32, j as u32)).collect();
        let pattern = Pattern::new(2 * mesh.n_vertices(), &pairs)?;
        let mut values = vec![0.0; pattern.entries()];
        for e in mesh.edges() {
            let h = e.halfedge();
            let weight = self.half_cotangent[h] + self.half_cotangent[h.twin()];
            let [i, j] = ends(h);
            let [a, b] = self.fourfold_transport(h);
            for k in [i, i + 1, j, j + 1] {
                values[pattern.diagonal(k)] += weight;
            }
            // Re conj(z_j) r z_i, twice.
            for (row, column, x) in [(j, i, a), (j, i + 1, -b), (j + 1, i, b), (j + 1, i + 1, a)] {
                let entry = pattern.position(row, column);
                let twice = if i == j { 2.0 } else { 1.0 };
                match entry {
                    Some(at) if i != j || row == column => values[at] -= twice * weight * x,
                    _ => {}
                }
            }
        }
        Ok((pattern, values))
    }

    /// The curvature of cones in quarter turns.
    fn cones(&self, field: &[Complex]) -> PerVertex<i32> {
        let mut cones = PerVertex::filled(self.mesh.n_vertices(), 0);
        for f in self.mesh.faces() {
            let index = self.index(f, field);
            let sign = index.signum();
            for _ in 0..index.abs() {
                let off = |v: VertexId| (f64::from(cones[v] + sign) - self.curvature[v] / (TAU / 4.0)).abs();
                let is_blunt = |v: &VertexId| cones[*v] + sign <= MOST_CURVED_OF_FIELD;
                let corners = self.mesh.face_vertices(f).into_iter().filter(is_blunt);
                let best = corners.min_by(|&a, &b| off(a).total_cmp(&off(b)));
                if let Some(v) = best.or_else(|| self.nearest(f, is_blunt)) {
                    cones[v] += sign;
                }
            }
        }
        cones
    }

    /// The first of these vertices in the order of breadth from a triangle.
    fn nearest(&self, f: FaceId, is_asked: impl Fn(&VertexId) -> bool) -> Option<VertexId> {
        let mut found = self.mesh.face_vertices(f).to_vec();
        let mut seen: BTreeSet<VertexId> = found.iter().copied().collect();
        let mut next = 0;
        while next < found.len() {
            let v = found[next];
            if is_asked(&v) {
                return Some(v);
            }
            let around = self.mesh.outgoing(v).map(|h| self.mesh.tip(h));
            found.extend(around.filter(|&w| seen.insert(w)));
            next += 1;
        }
        None
    }

    /// The index of the field in a triangle, quarter turns: `(4Ω + Σ ω)/2π`, Ω being the scaled angles' excess over π and ω the turn of the
    /// field along each side.
    fn index(&self, f: FaceId, field: &[Complex]) -> i32 {
        let sides = self.mesh.face_halfedges(f);
        let excess = sides.iter().map(|&h| self.angle[h]).sum::<f64>() - PI;
        let turn = |&h: &HalfedgeId| {
            let [from, to] = [self.mesh.origin(h), self.mesh.tip(h)].map(|v| field[v.index()]);
            let [x, y] = mul(to, conj(mul(self.fourfold_transport(h), from)));
            y.atan2(x)
        };
        // Both halves of an edge turn by opposite angles, at exactly π by the same.
        let along = |h: &HalfedgeId| if h.0 & 1 == 0 { turn(h) } else { -turn(&h.twin()) };
        let sum: f64 = sides.iter().map(along).sum();
        ((4.0 * excess + sum) / TAU).round() as i32
    }
}
