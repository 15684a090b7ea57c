//! The sizes of the triangles of a domain, and their adaption to the errors of a fit.

use super::areas::{smooth, vertex_areas};
use super::bare::{PlannedHole, fine_domain, plan_hole};
use super::coarse::CoarseTriangulation;
use super::domain::SurfaceDomain;
use super::flat::{FLAT, FlatMetric};
use super::holes::whole_turns;
use super::plane::{PuncturedPlane, RING, TURNS};
use super::sample::VertexSampling;
use crate::control::Control;
use crate::error::Result;
use crate::mesh::{Mesh, PerEdge, PerVertex, VertexId};
use crate::metric::Surface;
use crate::topology::shortest_paths;
use std::f64::consts::TAU;

/// Least and largest factor by which a size changes from round to round.
const CHANGE: [f64; 2] = [0.6, 1.4];
/// Least and largest size of a triangle, over that of an even distribution.
const SIZES: [f64; 2] = [0.1, 3.0];
/// Least number of vertices of the surface in a triangle: with fewer, a cubic polynomial that fits can fold.
const LEAST_POINTS: f64 = 8.0;
/// Part of a hole's radius, in the coordinate in which its vertex is a regular point, in which the domain has no other vertex: there the
/// filling is the surface.
const BARE: f64 = 0.6;
/// Growth of the allowed growth of sizes per length from round to round: fat triangles around a vertex of many turns, or on thin limbs, can
/// be too many.
const MORE_GROWTH: f64 = 1.15;

/// The wanted sizes of triangles at the vertices of a surface, relative to an even distribution, and the choice of vertices by them.
pub(super) struct TriangleSizes<'a> {
    flat: &'a FlatMetric,
    /// The flat lengths, or for a sphere in the plane those of its chords.
    lengths: PerEdge<f64>,
    sizes: PerVertex<f64>,
    least: PerVertex<f64>,
    /// For each vertex the ratio of flat lengths to lengths on the surface.
    stretch: PerVertex<f64>,
    growth: f64,
    /// The number of the round, from 1. Each round has its own order of vertices, since whether a spline folds depends on where they lie.
    round: u64,
    /// The vertices that are not flat, which are always taken.
    always: Vec<VertexId>,
    /// For each vertex, true unless it lies in the middle of a hole.
    allowed: PerVertex<bool>,
    /// The number of vertices in the hole of each singular vertex inside the surface, except for planned holes.
    inside: Vec<usize>,
    /// The holes around singular vertices whose total angle is no multiple of 2π.
    planned: Vec<PlannedHole>,
    /// The plane, if the surface is a sphere.
    plane: Option<PuncturedPlane<'a>>,
}

/// The triangle of a vertex and its error there; none where the filling of a hole is the surface.
pub(super) type VertexError = Option<(usize, f64)>;

impl<'a> TriangleSizes<'a> {
    /// The sizes for a number of triangles. `inside` gives the number of vertices in the hole of a singular vertex with
    /// some number of turns.
    pub fn new(
        surface: &Surface,
        flat: &'a FlatMetric,
        triangles: usize,
        inside: impl Fn(f64) -> usize,
        control: &Control,
    ) -> Result<TriangleSizes<'a>> {
        let mesh = surface.mesh();
        let n = mesh.n_vertices();
        let lengths = flat.finite_lengths();
        let areas = [vertex_areas(mesh, surface.lengths()), vertex_areas(&flat.mesh, &lengths)];
        let even = 4.0 / 3f64.sqrt() * surface.area()? / triangles.max(1) as f64;
        let least = |v: VertexId| (LEAST_POINTS * 4.0 / 3f64.sqrt() * areas[0][v] / even).sqrt();
        let mut least = PerVertex::from_fn(n, least);
        smooth(mesh, &mut least);
        let stretch = PerVertex::from_fn(n, |v: VertexId| (areas[1][v] / areas[0][v]).sqrt());
        let plane = PuncturedPlane::new(flat, inside(TURNS));
        let VertexChoice { always, allowed, inside, planned } = match &plane {
            Some(plane) => {
                let allowed = PerVertex::from_fn(n, |v| plane.is_free(v));
                VertexChoice { always: Vec::new(), allowed, inside: vec![inside(TURNS)], planned: Vec::new() }
            }
            None => VertexChoice::around_cones(mesh, flat, inside, control)?,
        };
        let sizes = PerVertex::from_fn(n, |v| least[v].max(1.0));
        Ok(TriangleSizes {
            flat,
            lengths,
            sizes,
            least,
            stretch,
            growth: 1.0,
            round: 1,
            always,
            allowed,
            inside,
            planned,
            plane,
        })
    }

    /// The number of vertices in each planned hole.
    pub fn bare(&self) -> impl Iterator<Item = usize> + '_ {
        self.planned.iter().map(|planned| planned.hole.inside)
    }

    /// The number of vertices in the hole of each singular vertex inside the surface, except for planned holes.
    pub fn inside(&self) -> impl Iterator<Item = usize> + '_ {
        self.inside.iter().copied()
    }

    /// The number of vertices that a domain has beside those that are chosen.
    pub fn added(&self) -> usize {
        if self.plane.is_some() { RING } else { 0 }
    }

    /// The domain on up to `count` vertices at distances according to the sizes; those that are not flat are among them.
    ///
    /// # Errors
    /// Those of [`CoarseTriangulation::new`] and [`SurfaceDomain::new`]; [`crate::Error::Layout`] for a plane that cannot be triangulated.
    pub fn domain(&self, count: usize, control: &Control) -> Result<SurfaceDomain> {
        let keep = self.choose(count, control)?;
        match &self.plane {
            Some(plane) => plane.domain(&keep),
            None => {
                let mut domain = SurfaceDomain::new(CoarseTriangulation::new(self.flat, &keep, control)?)?;
                let coarse = domain.coarse().vertices.iter().enumerate();
                let planned =
                    |v: VertexId| self.planned.iter().find(|hole| hole.vertex == v).map(|hole| hole.hole);
                let bare = coarse.filter_map(|(k, &v)| Some((VertexId(k as u32), planned(v)?)));
                domain.bare = bare.collect();
                Ok(domain)
            }
        }
    }

    fn choose(&self, count: usize, control: &Control) -> Result<PerVertex<bool>> {
        let size = |v: VertexId| match self.sizes.get(v.index()) {
            Some(size) if self.stretch[v] > 0.0 => size * self.stretch[v],
            _ => f64::INFINITY,
        };
        let mesh = &self.flat.mesh;
        let sampling = VertexSampling {
            mesh,
            seed: self.round,
            lengths: &self.lengths,
            sizes: PerVertex::from_fn(mesh.n_vertices(), size),
            growth: self.growth,
            always: &self.always,
            allowed: self.allowed.clone(),
        };
        sampling.spread(count, control)
    }

    /// Chooses other vertices of the same sizes for the next domain.
    pub fn reorder(&mut self) {
        self.round += 1;
    }

    /// Adapts the sizes so that all triangles would have like errors: a polynomial of degree n misses by the power n + 1 of the size.
    /// `misses` has the triangle and the error of each vertex.
    pub fn adapt(&mut self, mesh: &Mesh, misses: &[VertexError], triangles: usize, degree: usize) {
        let mut worst = vec![0.0f64; triangles];
        for &(triangle, miss) in misses.iter().flatten() {
            worst[triangle] = worst[triangle].max(miss);
        }
        let mut sorted: Vec<f64> = worst.iter().copied().filter(|&miss| miss > 0.0).collect();
        sorted.sort_by(f64::total_cmp);
        let middle = sorted.get(sorted.len() / 2).copied().unwrap_or(1.0);
        for (v, miss) in mesh.vertices().zip(misses) {
            let Some((triangle, _)) = *miss else { continue };
            let error = worst[triangle].max(f64::MIN_POSITIVE);
            let change = (middle / error).powf(1.0 / (degree + 1) as f64).clamp(CHANGE[0], CHANGE[1]);
            self.sizes[v] *= change;
        }
        self.growth *= MORE_GROWTH;
        self.round += 1;
        smooth(mesh, &mut self.sizes);
        for v in mesh.vertices() {
            self.sizes[v] = self.sizes[v].max(self.least[v]).clamp(SIZES[0], SIZES[1]);
        }
    }
}

/// The choice of vertices: those that are always taken, those that may be taken, and the holes of the singular ones.
struct VertexChoice {
    always: Vec<VertexId>,
    allowed: PerVertex<bool>,
    inside: Vec<usize>,
    planned: Vec<PlannedHole>,
}

impl VertexChoice {
    /// All vertices except those in the middle of the holes around cones.
    fn around_cones(
        mesh: &Mesh,
        flat: &FlatMetric,
        inside: impl Fn(f64) -> usize,
        control: &Control,
    ) -> Result<VertexChoice> {
        let (n, curvature) = (mesh.n_vertices(), flat.curvature()?);
        let mut always: Vec<VertexId> = mesh.vertices().filter(|&v| curvature[v].abs() > FLAT).collect();
        let mut allowed = PerVertex::from_fn(flat.mesh.n_vertices(), |v: VertexId| v.index() < n);
        let (mut all_inside, mut planned) = (Vec::new(), Vec::new());
        let cones: Vec<VertexId> = always.iter().copied().filter(|&v| !mesh.is_boundary_vertex(v)).collect();
        let mut fine = None;
        for &v in &cones {
            let total = 1.0 - curvature[v] / TAU;
            let Some(turns) = whole_turns(total) else {
                let fine = match &fine {
                    Some(fine) => fine,
                    None => fine.insert(fine_domain(flat)?),
                };
                planned.push(plan_hole(fine, v, inside(total), [n, cones.len()]));
                continue;
            };
            all_inside.push(inside(turns));
            let far = shortest_paths(&flat.mesh, &flat.lengths, [v], control)?.distance;
            let mut sorted: Vec<f64> = far.iter().copied().take(n).collect();
            sorted.sort_by(f64::total_cmp);
            // The hole ends before the boundary and before other singular vertices.
            let others = always.iter().filter(|&&u| u != v).map(|&u| far[u]);
            let boundary = mesh.vertices().filter(|&u| mesh.is_boundary_vertex(u)).map(|u| far[u]);
            let free = others.chain(boundary).fold(f64::INFINITY, f64::min);
            let radius = sorted[inside(turns).min(n - 1)].min(free);
            let bare = BARE.powf(turns) * radius;
            mesh.vertices().filter(|&u| far[u] < bare).for_each(|u| allowed[u] = false);
        }
        for hole in &planned {
            hole.bare.iter().for_each(|&u| allowed[u] = false);
        }
        for &u in planned.iter().flat_map(|hole| &hole.ring) {
            allowed[u] = true;
            always.push(u);
        }
        Ok(VertexChoice { always, allowed, inside: all_inside, planned })
    }
}
