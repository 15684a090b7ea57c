//! The holes around the singular vertices of a domain, and the triangles that each of them meets.

use super::domain::{SAME, SurfaceDomain, nearest_on_side};
use super::similarity::PlaneSimilarity;
use crate::error::{Error, Result};
use crate::geometry::complex::{add, conj, distance, mul, norm, scale, sub, unit};
use crate::mesh::{FaceId, HalfedgeId, VertexId};
use crate::spline::{Hole, Sector, SplineSpace};
use std::collections::HashMap;
use std::f64::consts::TAU;

/// Most triangles of a disk that may meet itself, over those of the surface.
const MOST_COPIES: usize = 16;
/// Radius of a hole over the distance of its vertex from the sides opposite it.
const HOLE: f64 = 0.9;
/// Largest deviation of the total angle of a hole's vertex from a multiple of 2π, in turns.
const WHOLE: f64 = 1e-6;
/// Distance between two developments of a vertex, over that from the middle of the disk, from which on they are different.
const APART: f64 = 1e-6;
/// Largest share of |w| up to which a filling alone is the surface: beyond it the spline is needed for the transition.
const MOST_INNER: f64 = 0.92;

impl SurfaceDomain {
    /// The empty hole around a singular vertex whose total angle is a multiple of 2π, inside the triangles at the vertex.
    ///
    /// # Errors
    /// [`Error::Argument`] for another vertex.
    pub fn hole(&self, v: VertexId) -> Result<Hole> {
        let radius = HOLE * self.clearance(v);
        Hole::new(self.chart(v), self.around(v, radius, 2.0).sectors, self.turns(v)?, radius)
    }

    /// The hole of this radius, or the widest that meets neither itself nor another singular vertex nor the boundary; at least as wide as
    /// [`SurfaceDomain::hole`].
    ///
    /// # Errors
    /// Those of [`SurfaceDomain::hole`].
    pub fn wide_hole(&self, v: VertexId, radius: f64) -> Result<Hole> {
        let turns = self.turns(v)?;
        // The hole meets itself beyond half of the way from the vertex to itself.
        let free = self.around(v, 2.0 * radius, 2.0).free;
        let radius = radius.min(HOLE * free).max(HOLE * self.clearance(v));
        Hole::new(self.chart(v), self.around(v, radius, 2.0).sectors, turns, radius)
    }

    /// The chart number of a singular vertex's hole.
    fn chart(&self, v: VertexId) -> u32 {
        let before = self.coarse.mesh.vertices().take(v.index()).filter(|&u| self.is_cone(u)).count();
        (self.coarse.mesh.n_faces() + before) as u32
    }

    /// The total angle of a singular vertex in turns.
    fn turns(&self, v: VertexId) -> Result<f64> {
        let turns = self.total_angle(v) / TAU;
        match whole_turns(turns) {
            Some(whole) if !self.coarse.mesh.is_boundary_vertex(v) => Ok(whole),
            _ => {
                let need = "a multiple of one turn, at a vertex inside the surface";
                Err(Error::argument("total angle in turns", turns, need))
            }
        }
    }

    /// The empty hole of a given radius around a singular vertex of any total angle. All knots of such a vertex lie at it, and the splines of
    /// `space` are less smooth along the edges there, so that the filling alone is the surface as far as these edges, and the knots of their
    /// ends, reach.
    ///
    /// # Errors
    /// Those of [`Hole::new`].
    pub(super) fn bare_hole(&self, v: VertexId, radius: f64, space: &SplineSpace) -> Result<Hole> {
        let turns = self.total_angle(v) / TAU;
        let hole = Hole::new(self.chart(v), self.around(v, radius, 2.0).sectors, turns, radius)?;
        let mesh = &self.coarse.mesh;
        let far = |h: HalfedgeId| {
            let (f, k) = mesh.corner(h)?;
            let knots = &space.patches()[f.index()].knots;
            let others = [1, 2].iter().flat_map(|j| &knots[(k + j) % 3]);
            Some(self.unit[f] * others.map(|&p| distance(p, self.corners[f][k])).fold(0.0, f64::max))
        };
        let reach = mesh.fan(v).into_iter().filter_map(far).fold(0.0, f64::max);
        let inner = (reach / radius).powf(1.0 / turns).min(MOST_INNER).max(hole.inner);
        Ok(Hole { inner, ..hole })
    }

    /// The vertices in a disk around a vertex, each with its distance and its direction, an angle from the first half-edge of the vertex; the
    /// nearest first. Beside them, a radius up to which the disk meets neither itself nor another singular vertex nor the boundary.
    pub(super) fn disk(&self, v: VertexId, radius: f64) -> VertexDisk {
        let HoleSurroundings { sectors, mut free } = self.around(v, radius, 1.0);
        let whole = self.total_angle(v);
        let mut nearest: HashMap<VertexId, [f64; 2]> = HashMap::new();
        for sector in &sectors {
            let f = FaceId(sector.patch);
            for (u, corner) in self.coarse.mesh.face_vertices(f).into_iter().zip(self.corners[f]) {
                let z = sector.local(corner);
                if u == v && norm(z) < SAME * self.unit[f] {
                    continue;
                }
                let there = [norm(z), sector.angle + z[1].atan2(z[0])];
                let known = nearest.entry(u).or_insert(there);
                let turn = (there[1] - known[1]) / whole;
                let aside = (turn - turn.round()).abs() * whole * there[0];
                if (there[0] - known[0]).abs().max(aside) > APART * there[0] {
                    // The disk meets itself.
                    free = free.min(there[0].max(known[0]));
                }
                if there[0] < known[0] {
                    *known = there;
                }
            }
        }
        let mut places: Vec<(VertexId, [f64; 2])> = nearest.into_iter().filter(|&(u, _)| u != v).collect();
        places.sort_by(|(u, p), (v, q)| p[0].total_cmp(&q[0]).then(u.cmp(v)));
        VertexDisk { places, free }
    }

    /// The triangles that a disk around a vertex meets, developed from the vertex. Those beyond a multiple of the free radius are left out:
    /// around another singular vertex there would be many developments of one.
    fn around(&self, v: VertexId, radius: f64, share: f64) -> HoleSurroundings {
        let mesh = &self.coarse.mesh;
        let whole = self.total_angle(v);
        let mut found: Vec<Sector> = Vec::new();
        let mut known: HashMap<u32, Vec<Sector>> = HashMap::new();
        let mut free = f64::INFINITY;
        // The distance of the nearest singular vertex of a triangle; half of it, if that is the vertex itself.
        let room = |sector: &Sector| {
            let f = FaceId(sector.patch);
            let far = |(k, &u): (usize, &VertexId)| {
                let far = norm(sector.local(self.corners[f][k]));
                let counts = !self.is_flat[u] && far > SAME * self.unit[f];
                counts.then_some(if u == v { 0.5 * far } else { far })
            };
            mesh.face_vertices(f).iter().enumerate().filter_map(far).fold(f64::INFINITY, f64::min)
        };
        for h in mesh.fan(v) {
            let Some((f, k)) = mesh.corner(h) else { continue };
            let [a, b] = [k, (k + 1) % 3].map(|k| self.corners[f][k]);
            let turn = scale(self.unit[f], conj(unit(sub(b, a))));
            let to = PlaneSimilarity { turn, shift: sub([0.0; 2], mul(turn, a)) };
            let sector = self.sector(f, to, self.angle[h]);
            free = free.min(room(&sector));
            known.entry(f.0).or_default().push(sector);
            found.push(sector);
        }
        let mut next = 0;
        while let Some(&Sector { patch, angle, to }) = found.get(next) {
            next += 1;
            let (f, to) = (FaceId(patch), PlaneSimilarity::of_rows(to));
            for h in mesh.face_halfedges(f) {
                let Some((_, k)) = mesh.corner(h) else { continue };
                let ends = [k, (k + 1) % 3].map(|k| to.of(self.corners[f][k]));
                // Sides that end at the vertex lead to triangles that are already known.
                if ends.iter().any(|&p| norm(p) < SAME * self.unit[f]) {
                    continue;
                }
                let far = distance([0.0; 2], nearest_on_side([0.0; 2], ends[0], ends[1]));
                if far >= radius.min(share * free) {
                    continue;
                }
                // A disk with so many more triangles than the surface has met itself long before.
                let has_room = found.len() < MOST_COPIES * mesh.n_faces();
                let Some((g, across)) = self.across(h).filter(|_| has_room) else {
                    free = free.min(far);
                    continue;
                };
                let there = self.sector(g, to.after(&across), angle);
                free = free.min(room(&there));
                let is_there = |other: &Sector| {
                    let apart = (other.angle - there.angle) / whole;
                    let places = self.corners[g].map(|p| distance(other.local(p), there.local(p)));
                    (apart - apart.round()).abs() * whole < SAME
                        && places.iter().all(|&d| d < SAME * self.unit[g])
                };
                let of_patch = known.entry(g.0).or_default();
                if !of_patch.iter().any(is_there) {
                    of_patch.push(there);
                    found.push(there);
                }
            }
        }
        HoleSurroundings { sectors: found, free }
    }

    /// A triangle that is developed around a vertex, turned so that its middle lies on the x axis; the map is given up to a rotation by
    /// `angle`.
    pub(super) fn sector(&self, f: FaceId, to: PlaneSimilarity, angle: f64) -> Sector {
        let middle = self.corners[f].iter().fold([0.0; 2], |sum, &p| add(sum, scale(1.0 / 3.0, p)));
        let at = to.of(middle);
        let back = PlaneSimilarity { turn: conj(unit(at)), shift: [0.0; 2] };
        Sector { patch: f.0, angle: angle + at[1].atan2(at[0]), to: back.after(&to).rows() }
    }
}

/// The number of turns if an angle, given in turns, is a multiple of one.
pub(super) fn whole_turns(turns: f64) -> Option<f64> {
    ((turns - turns.round()).abs() < WHOLE && turns > 0.5).then(|| turns.round())
}

/// The vertices in a disk around a vertex.
pub(super) struct VertexDisk {
    /// The vertices, the nearest first, with distance and direction.
    pub places: Vec<(VertexId, [f64; 2])>,
    /// A radius of disks around the vertex that meet no other singular vertex, no boundary and not themselves.
    pub free: f64,
}

/// The triangles that a disk around a vertex meets.
struct HoleSurroundings {
    sectors: Vec<Sector>,
    /// A radius of disks around the vertex that, by these triangles, meet no other singular vertex, no boundary and not themselves.
    free: f64,
}
