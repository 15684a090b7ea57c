//! How large the triangles of a domain are to be.

use super::areas::{smooth, vertex_areas};
use super::coarse::Coarse;
use super::domain::SurfaceDomain;
use super::flat::{FLAT, Flat};
use super::plane::{Plane, RING, TURNS};
use super::sample::Sampling;
use crate::control::Control;
use crate::error::Result;
use crate::mesh::{Mesh, PerEdge, PerVertex, VertexId};
use crate::metric::Surface;
use crate::topology::shortest_paths;
use std::f64::consts::TAU;

/// Sizes change by at most these factors from round to round.
const CHANGE: [f64; 2] = [0.6, 1.4];
/// Least and largest size of a triangle over the one of an even distribution.
const SIZES: [f64; 2] = [0.1, 3.0];
/// Vertices of the surface that a triangle has at least: fewer do not tell a cubic polynomial from one that folds.
const LEAST_POINTS: f64 = 8.0;
/// The part of a hole's radius, in the coordinate in which its vertex is a point as any other, where no other vertex lies: there the hole
/// is filled.
const BARE: f64 = 0.6;
/// In each round sizes may grow by so much more per length: fat triangles around a vertex of many turns, or on thin limbs, may be too many.
const MORE_GROWTH: f64 = 1.15;

/// Sizes of triangles, on the surface and relative to an even distribution.
pub(super) struct Grade<'a> {
    flat: &'a Flat,
    /// Its lengths, or of a sphere those of its chords.
    lengths: PerEdge<f64>,
    sizes: PerVertex<f64>,
    least: PerVertex<f64>,
    /// How much longer the flat metric is than the surface's.
    stretch: PerVertex<f64>,
    growth: f64,
    /// Counts from 1: each has its own order of vertices, since whether a spline folds depends on where they happen to lie.
    round: u64,
    /// The vertices that are not flat.
    always: Vec<VertexId>,
    /// Vertices of the surface but those in the middle of holes.
    allowed: PerVertex<bool>,
    /// Of the singular vertices inside the numbers of turns that say how large their holes are.
    turns: Vec<u32>,
    /// Of a sphere.
    plane: Option<Plane<'a>>,
}

/// The error of a vertex that is to be spread evenly; none where a hole is filled by something else than the triangles.
pub(super) type Miss = Option<(usize, f64)>;

impl<'a> Grade<'a> {
    /// Sizes for so many triangles. `inside`: vertices in the hole of a singular vertex with this number of turns.
    pub fn new(
        surface: &Surface,
        flat: &'a Flat,
        triangles: usize,
        inside: impl Fn(u32) -> usize,
        control: &Control,
    ) -> Result<Grade<'a>> {
        let mesh = surface.mesh();
        let n = mesh.n_vertices();
        let lengths = flat.finite_lengths();
        let areas = [vertex_areas(mesh, surface.lengths()), vertex_areas(&flat.mesh, &lengths)];
        let even = 4.0 / 3f64.sqrt() * surface.area()? / triangles.max(1) as f64;
        let least = |v: VertexId| (LEAST_POINTS * 4.0 / 3f64.sqrt() * areas[0][v] / even).sqrt();
        let mut least = PerVertex::from_fn(n, least);
        smooth(mesh, &mut least);
        let stretch = PerVertex::from_fn(n, |v: VertexId| (areas[1][v] / areas[0][v]).sqrt());
        let curvature = flat.curvature()?;
        let mut around = Around {
            always: mesh.vertices().filter(|&v| curvature[v].abs() > FLAT).collect(),
            allowed: PerVertex::from_fn(flat.mesh.n_vertices(), |v: VertexId| v.index() < n),
            turns: Vec::new(),
        };
        let plane = Plane::new(flat, inside(TURNS));
        match &plane {
            Some(plane) => {
                let allowed = PerVertex::from_fn(n, |v| plane.is_free(v));
                around = Around { always: Vec::new(), allowed, turns: vec![TURNS] };
            }
            None => around.keep_clear(mesh, flat, (&curvature, &inside), control)?,
        }
        let Around { always, allowed, turns } = around;
        let sizes = PerVertex::from_fn(n, |v| least[v].max(1.0));
        Ok(Grade {
            flat,
            lengths,
            sizes,
            least,
            stretch,
            growth: 1.0,
            round: 1,
            always,
            allowed,
            turns,
            plane,
        })
    }

    /// Of the singular vertices inside the surface, their total angles in turns.
    pub fn turns(&self) -> impl Iterator<Item = u32> + '_ {
        self.turns.iter().copied()
    }

    /// How many vertices a domain has beside those that are chosen.
    pub fn added(&self) -> usize {
        if self.plane.is_some() { RING } else { 0 }
    }

    /// The domain on up to `count` vertices at these distances, those that are not flat among them.
    ///
    /// # Errors
    /// Those of [`Coarse::new`] and [`SurfaceDomain::new`]; [`crate::Error::Layout`] for a plane that cannot be triangulated.
    pub fn domain(&self, count: usize, control: &Control) -> Result<SurfaceDomain> {
        let keep = self.choose(count, control)?;
        match &self.plane {
            Some(plane) => plane.domain(&keep),
            None => SurfaceDomain::new(Coarse::new(self.flat, &keep, control)?),
        }
    }

    fn choose(&self, count: usize, control: &Control) -> Result<PerVertex<bool>> {
        let size = |v: VertexId| match self.sizes.get(v.index()) {
            Some(size) if self.stretch[v] > 0.0 => size * self.stretch[v],
            _ => f64::INFINITY,
        };
        let mesh = &self.flat.mesh;
        let sampling = Sampling {
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

    /// Sizes for triangles whose errors would be alike: a polynomial of degree n misses by the power n + 1 of the size. `misses`: per
    /// vertex its triangle and its error.
    pub fn adapt(&mut self, mesh: &Mesh, misses: &[Miss], (triangles, degree): (usize, usize)) {
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

/// Which vertices of a surface are taken.
struct Around {
    always: Vec<VertexId>,
    allowed: PerVertex<bool>,
    turns: Vec<u32>,
}

impl Around {
    /// Allow no vertices in the middle of the holes around cones.
    fn keep_clear(
        &mut self,
        mesh: &Mesh,
        flat: &Flat,
        (curvature, inside): (&PerVertex<f64>, &impl Fn(u32) -> usize),
        control: &Control,
    ) -> Result<()> {
        let n = mesh.n_vertices();
        for &v in self.always.iter().filter(|&&v| !mesh.is_boundary_vertex(v)) {
            let turns = (1.0 - curvature[v] / TAU).round().max(1.0) as u32;
            self.turns.push(turns);
            let far = shortest_paths(&flat.mesh, &flat.lengths, [v], control)?.distance;
            let mut sorted: Vec<f64> = far.iter().copied().take(n).collect();
            sorted.sort_by(f64::total_cmp);
            // The hole ends before the boundary and before other singular vertices.
            let others = self.always.iter().filter(|&&u| u != v).map(|&u| far[u]);
            let boundary = mesh.vertices().filter(|&u| mesh.is_boundary_vertex(u)).map(|u| far[u]);
            let free = others.chain(boundary).fold(f64::INFINITY, f64::min);
            let radius = sorted[inside(turns).min(n - 1)].min(free);
            let bare = BARE.powi(turns as i32) * radius;
            mesh.vertices().filter(|&u| far[u] < bare).for_each(|u| self.allowed[u] = false);
        }
        Ok(())
    }
}
