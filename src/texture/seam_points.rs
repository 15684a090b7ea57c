//! The vertices that seams have to lead to, so that a conformal map changes lengths by little.

use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::vector::{distance, dot, normalised, triangle_normal};
use crate::harmonic::{Domain, Laplace};
use crate::mesh::{EdgeId, HalfedgeId, Mesh, PerEdge, Point, VertexId};
use crate::metric::Surface;
use crate::topology::cut::{CutGraph, cut_graph};
use std::f64::consts::{FRAC_PI_2, PI};

/// The share of its length that an edge between faces at a right angle counts in seams: they hide in creases.
const OF_CREASE: f64 = 0.35;
/// The most vertices that are added before |u| is computed again.
const PER_ROUND: usize = 4;
/// Vertices that are added together are at least this far apart, in roots of the area: what one changes does not reach another.
const APART: f64 = 0.2;
/// A vertex is added beside the one with the largest |u| only where it has this share of it.
const BESIDE_LARGEST: f64 = 0.6;
/// The most rounds. Each lowers the largest |u|; a surface that needs more is cut apart instead.
const MOST_ROUNDS: usize = 40;

/// What is known of a sheet before it has seams.
pub(super) struct SeamSearch<'a> {
    surface: &'a Surface,
    positions: &'a [Point],
    domain: Domain,
    /// Per vertex inside its angle defect.
    curvature: Vec<f64>,
    /// Per edge its length as seams count it.
    pub weights: PerEdge<f64>,
    area: f64,
}

impl<'a> SeamSearch<'a> {
    pub fn new(surface: &'a Surface, positions: &'a [Point], control: &Control) -> Result<SeamSearch<'a>> {
        let domain = Domain::new(surface, control)?;
        let mesh = domain.mesh();
        let mut curvature: Vec<f64> =
            mesh.vertices().map(|v| if mesh.is_boundary_vertex(v) { 0.0 } else { 2.0 * PI }).collect();
        for f in mesh.faces() {
            for (v, cotangent) in mesh.face_vertices(f).into_iter().zip(domain.cotangents()[f]) {
                if !mesh.is_boundary_vertex(v) {
                    curvature[v.index()] -= FRAC_PI_2 - cotangent.atan();
                }
            }
        }
        let area = domain.face_areas().iter().sum();
        let weights = seam_weights(surface.mesh(), surface.lengths(), positions);
        Ok(SeamSearch { surface, positions, domain, curvature, weights, area })
    }

    /// Seams that open the surface into a disk and leave |u| below a bound but for a share of the area, the second number. `points`: vertices that seams lead to
    /// already; those that are found are added.
    ///
    /// # Errors
    /// Those of [`cut_graph`] and [`Laplace::new`]; [`Error::Layout`] where the bound is not reached.
    pub fn seams(&self, bound: [f64; 2], points: &mut Vec<VertexId>, control: &Control) -> Result<CutGraph> {
        let mesh = self.surface.mesh();
        if mesh.is_closed() && mesh.genus() == 0 && points.len() < 2 {
            self.start_on_sphere(points, control)?;
        }
        for _ in 0..MOST_ROUNDS {
            let cut = cut_graph(mesh, &self.weights, points, control)?;
            let mut is_held: Vec<bool> = mesh.vertices().map(|v| mesh.is_boundary_vertex(v)).collect();
            for e in mesh.edges().filter(|&e| cut.is_cut[e]) {
                mesh.ends(e).iter().for_each(|v| is_held[v.index()] = true);
            }
            let peaks = self.peaks(&self.factor(|v| is_held[v.index()], control)?, bound);
            if peaks.is_empty() {
                return Ok(cut);
            }
            points.extend(peaks);
        }
        Err(Error::Layout("seams through many vertices leave lengths that change too much".into()))
    }

    /// The logarithm of the conformal factor of the flat metric with u = 0 at held vertices.
    fn factor(&self, is_held: impl Fn(VertexId) -> bool, control: &Control) -> Result<Vec<f64>> {
        let laplace = Laplace::new(&self.domain, &is_held, control)?;
        let mut u: Vec<f64> = self.curvature.iter().map(|k| -k).collect();
        laplace.solve(&mut u)?;
        Ok(u)
    }

    /// Two vertices where a sphere is opened first: those that bend most for each other.
    fn start_on_sphere(&self, points: &mut Vec<VertexId>, control: &Control) -> Result<()> {
        while points.len() < 2 {
            let held = points.first().copied().unwrap_or(VertexId(0));
            let u = self.factor(|v| v == held, control)?;
            let inside = self.surface.mesh().vertices().filter(|&v| v != held);
            let farthest = inside.reduce(|a, b| if u[b.index()].abs() > u[a.index()].abs() { b } else { a });
            points.extend(farthest);
        }
        Ok(())
    }

    /// The vertices with the largest |u|, far from each other; none if |u| is below the bound but for a share of the area.
    fn peaks(&self, u: &[f64], [bound, may_exceed]: [f64; 2]) -> Vec<VertexId> {
        let exceeds = |v: &VertexId| u[v.index()].abs() > bound;
        let areas = self.domain.vertex_areas();
        let mut above: Vec<VertexId> = self.domain.mesh().vertices().filter(exceeds).collect();
        if above.iter().map(|&v| areas[v]).sum::<f64>() <= may_exceed * self.area {
            return Vec::new();
        }
        above.sort_by(|v, w| u[w.index()].abs().total_cmp(&u[v.index()].abs()).then(v.cmp(w)));
        let largest = u[above[0].index()].abs();
        let (mut chosen, apart) = (Vec::<VertexId>::new(), APART * self.area.sqrt());
        for v in above.into_iter().take_while(|v| u[v.index()].abs() >= BESIDE_LARGEST * largest) {
            let at = |v: VertexId| self.positions[v.index()];
            if chosen.iter().all(|&w| distance(at(v), at(w)) > apart) {
                chosen.push(v);
                if chosen.len() == PER_ROUND {
                    break;
                }
            }
        }
        chosen
    }
}

/// Per edge its length times a factor that is less in creases.
pub(super) fn seam_weights(mesh: &Mesh, lengths: &PerEdge<f64>, positions: &[Point]) -> PerEdge<f64> {
    let normal = |h: HalfedgeId| {
        let face = mesh.face(h)?;
        Some(normalised(triangle_normal(mesh.face_vertices(face).map(|v| positions[v.index()]))))
    };
    PerEdge::from_fn(mesh.n_edges(), |e| {
        let h = EdgeId::halfedge(e);
        let crease = match (normal(h), normal(h.twin())) {
            (Some(m), Some(n)) => (1.0 - dot(m, n)).clamp(0.0, 1.0),
            _ => 0.0,
        };
        lengths[e] * (1.0 - (1.0 - OF_CREASE) * crease)
    })
}
