//! Lengths of shortest paths between vertices that few edges separate, exact on the flat triangles of the surface.
//!
//! A shortest path is straight but at vertices with an angle of more than 2π and on the boundary [MMP87, Section 3]. So the straight paths
//! from a vertex are followed through the triangles that they cross, laid out in the plane, and Dijkstra's method joins them at such vertices.

use crate::control::Control;
use crate::error::Result;
use crate::geometry::complex::{cross, dot, norm, sub};
use crate::geometry::plane_triangle::PlaneTriangle;
use crate::mesh::{HalfedgeId, Mesh, VertexId};
use crate::metric::Surface;
use crate::parallel;
use std::f64::consts::TAU;

/// The sine of an angle by which a vertex may seem to be outside a beam to which it belongs: on two beams' common side rounding could hide it
/// from both.
const ASIDE: f64 = 1e-12;
/// Vertices between two questions whether the work is cancelled.
const BLOCK: usize = 4096;

/// Two vertices and the length of the shortest path between them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PathLength {
    pub ends: [u32; 2],
    pub length: f64,
}

/// The pairs of different vertices that at most so many edges separate, each once, with the lengths of shortest paths.
///
/// # Errors
/// [`crate::Error::Cancelled`].
pub(super) fn ring_distances(surface: &Surface, rings: usize, control: &Control) -> Result<Vec<PathLength>> {
    let paths = Paths::new(surface);
    let n = surface.mesh().n_vertices();
    let mut all = Vec::new();
    for begin in (0..n).step_by(BLOCK) {
        control.check()?;
        let mut found = vec![Vec::new(); BLOCK.min(n - begin)];
        parallel::fill(&mut found, |k| paths.around(VertexId((begin + k) as u32), rings));
        all.extend(found.into_iter().flatten());
    }
    Ok(all)
}

/// What is asked for the paths of all vertices.
struct Paths<'a> {
    mesh: &'a Mesh,
    surface: &'a Surface,
    /// True for vertices at which a shortest path can turn.
    turns: Vec<bool>,
}

/// The directions from a vertex that leave the triangles laid out so far through a half-edge: its ends as laid out, its origin on the right.
#[derive(Clone, Copy)]
struct Beam {
    side: HalfedgeId,
    ends: [[f64; 2]; 2],
    from: [f64; 2],
    to: [f64; 2],
}

/// Distances that are known so far, of few vertices.
#[derive(Default)]
struct KnownLengths(Vec<(u32, f64)>);

impl KnownLengths {
    fn lower(&mut self, v: VertexId, length: f64) {
        match self.0.iter_mut().find(|(w, _)| *w == v.0) {
            Some((_, known)) => *known = known.min(length),
            None => self.0.push((v.0, length)),
        }
    }
}

impl Paths<'_> {
    fn new(surface: &Surface) -> Paths<'_> {
        let mesh = surface.mesh();
        let mut angles = vec![0.0; mesh.n_vertices()];
        for h in mesh.halfedges().filter(|&h| !mesh.is_outside(h)) {
            let sides = [mesh.next(h), mesh.prev(h), h].map(|h| surface.lengths()[h.edge()]);
            let ([cos, sin], _) = PlaneTriangle::direction_at(sides, 0);
            angles[mesh.origin(h).index()] += sin.atan2(cos);
        }
        let turns = mesh.vertices().map(|v| mesh.is_boundary_vertex(v) || angles[v.index()] > TAU).collect();
        Paths { mesh, surface, turns }
    }

    fn length(&self, h: HalfedgeId) -> f64 {
        self.surface.lengths()[h.edge()]
    }

    /// The paths from a vertex to those of greater number in its rings.
    fn around(&self, from: VertexId, rings: usize) -> Vec<PathLength> {
        let inside = self.rings(from, rings);
        let radius = inside.iter().map(|(_, length)| *length).fold(0.0, f64::max);
        let mut reached = KnownLengths(vec![(from.0, 0.0)]);
        let mut settled: Vec<u32> = Vec::new();
        loop {
            let open = reached.0.iter().filter(|(v, length)| *length <= radius && !settled.contains(v));
            let Some(&(v, length)) = open.min_by(|p, q| p.1.total_cmp(&q.1).then(p.0.cmp(&q.0))) else {
                break;
            };
            settled.push(v);
            if v == from.0 || self.turns[v as usize] {
                self.shine(VertexId(v), length, radius, &mut reached);
            }
        }
        let greater = inside.into_iter().filter(|(v, _)| *v > from.0);
        greater
            .map(|(v, along_edges)| {
                let found =
                    reached.0.iter().find(|(w, _)| *w == v).map_or(along_edges, |(_, length)| *length);
                PathLength { ends: [from.0, v], length: found }
            })
            .collect()
    }

    /// The vertices that at most so many edges separate from one, with lengths of such paths along edges.
    fn rings(&self, from: VertexId, rings: usize) -> Vec<(u32, f64)> {
        let mut reached = KnownLengths(vec![(from.0, 0.0)]);
        let mut front = vec![(from, 0.0)];
        for _ in 0..rings {
            let mut next = Vec::new();
            for (v, before) in std::mem::take(&mut front) {
                for h in self.mesh.outgoing(v) {
                    let (w, length) = (self.mesh.tip(h), before + self.length(h));
                    let known = reached.0.iter().find(|(u, _)| *u == w.0).map_or(f64::INFINITY, |(_, l)| *l);
                    if length < known {
                        reached.lower(w, length);
                        next.push((w, length));
                    }
                }
            }
            front = next;
        }
        reached.0.retain(|(v, _)| *v != from.0);
        reached.0
    }

    /// Follows the straight paths from a vertex that are no longer than a radius, less what leads to it.
    fn shine(&self, from: VertexId, before: f64, radius: f64, reached: &mut KnownLengths) {
        let mut beams = Vec::new();
        for h in self.mesh.outgoing(from) {
            reached.lower(self.mesh.tip(h), before + self.length(h));
            if !self.mesh.is_outside(h) {
                let side = self.mesh.next(h);
                let sides = [side, self.mesh.prev(h), h].map(|h| self.length(h));
                let ([cos, sin], _) = PlaneTriangle::direction_at(sides, 0);
                let ends = [[sides[2], 0.0], [sides[1] * cos, sides[1] * sin]];
                beams.push(Beam { side, ends, from: ends[0], to: ends[1] });
            }
        }
        while let Some(beam) = beams.pop() {
            if before + distance_to_origin(beam.ends) > radius || self.mesh.is_outside(beam.side.twin()) {
                continue;
            }
            let (apex, at) = self.beyond(&beam);
            let [right, left] = [cross(beam.from, at), cross(at, beam.to)];
            let aside = ASIDE * norm(at);
            if right >= -aside * norm(beam.from) && left >= -aside * norm(beam.to) {
                reached.lower(apex, before + norm(at));
            }
            let twin = beam.side.twin();
            if right > 0.0 {
                let (side, ends) = (self.mesh.next(twin), [beam.ends[0], at]);
                beams.push(Beam { side, ends, to: if left > 0.0 { at } else { beam.to }, ..beam });
            }
            if left > 0.0 {
                let (side, ends) = (self.mesh.prev(twin), [at, beam.ends[1]]);
                beams.push(Beam { side, ends, from: if right > 0.0 { at } else { beam.from }, ..beam });
            }
        }
    }

    /// The corner of the triangle beyond a side that is opposite it, and its place.
    fn beyond(&self, beam: &Beam) -> (VertexId, [f64; 2]) {
        let twin = beam.side.twin();
        let (near, far) = (self.mesh.next(twin), self.mesh.prev(twin));
        let sides = [far, beam.side, near].map(|h| self.length(h));
        let ([cos, sin], _) = PlaneTriangle::direction_at(sides, 0);
        let [a, b] = beam.ends;
        let [x, y] = sub(b, a).map(|x| x * sides[2] / sides[1]);
        // The origin is on the left of the side, so that the corner is on its right.
        (self.mesh.tip(near), [a[0] + cos * x + sin * y, a[1] + cos * y - sin * x])
    }
}

/// The distance of the origin from a segment.
fn distance_to_origin([a, b]: [[f64; 2]; 2]) -> f64 {
    let way = sub(b, a);
    let share = (-dot(a, way) / dot(way, way)).clamp(0.0, 1.0);
    norm([a[0] + share * way[0], a[1] + share * way[1]])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::io::Soup;
    use crate::mesh::{Point, shapes};
    use std::f64::consts::PI;

    fn all(soup: &Soup, rings: usize) -> Vec<PathLength> {
        ring_distances(&Surface::from_soup(soup).unwrap(), rings, &Control::new()).unwrap()
    }

    fn apart(p: Point, q: Point) -> f64 {
        (0..3).map(|k| (p[k] - q[k]).powi(2)).sum::<f64>().sqrt()
    }

    #[test]
    fn in_a_convex_part_of_the_plane_paths_are_straight() {
        let soup = shapes::disk(6).unwrap();
        let pairs = all(&soup, 3);
        assert!(pairs.len() > 9 * soup.positions.len());
        for PathLength { ends, length } in pairs {
            let [p, q] = ends.map(|v| soup.positions[v as usize]);
            // Sides of the border are chords, so that the disk of triangles is convex.
            assert!((length - apart(p, q)).abs() < 1e-13, "{ends:?}");
        }
    }

    #[test]
    fn on_a_box_paths_cross_its_edges_unfolded() {
        // A sheet bent by a right angle along its middle, and unbent.
        let n = 7_usize;
        let at = |bent: bool| {
            move |k: usize| {
                let (x, y) = ((k % n) as f64 - 3.0, (k / n) as f64);
                if bent && x > 0.0 { [0.0, y, x] } else { [x, y, 0.0] }
            }
        };
        let squares = (0..n - 1).flat_map(|j| (0..n - 1).map(move |i| (n * j + i) as u32));
        let w = n as u32;
        let faces: Vec<_> = squares.flat_map(|a| [[a, a + 1, a + w + 1], [a, a + w + 1, a + w]]).collect();
        let bent = Soup::new((0..n * n).map(at(true)).collect(), faces);
        for PathLength { ends, length } in all(&bent, 4) {
            let [p, q] = ends.map(|v| at(false)(v as usize));
            assert!((length - apart(p, q)).abs() < 1e-13, "{ends:?}");
        }
    }

    #[test]
    fn around_a_hole_and_around_a_saddle_paths_turn_at_vertices() {
        // Three quarters of a square: the inner corner is vertex 0, and the way between the two others leads through it.
        let places = [[0., 0.], [2., 0.], [2., 2.], [0., 2.], [-2., 2.], [-2., 0.], [-2., -2.], [0., -2.]];
        let positions = places.map(|[x, y]| [x, y, 0.0]).to_vec();
        let faces = (1..7).map(|k| [0, k, k + 1]).collect();
        let found = all(&Soup::new(positions, faces), 2);
        let between = |a: u32, b: u32| found.iter().find(|p| p.ends == [a, b]).unwrap().length;
        assert!((between(1, 7) - 4.0).abs() < 1e-14);
        assert!((between(2, 7) - (8.0_f64.sqrt() + 2.0)).abs() < 1e-14);
        assert!((between(1, 3) - 8.0_f64.sqrt()).abs() < 1e-14);
        // A cone of angle 3π: the first and the fourth of six neighbours are 3π/2 apart.
        let rim = |k: u32| {
            let angle = PI * f64::from(k) / 3.0;
            [angle.cos(), angle.sin(), if k.is_multiple_of(2) { 1.0 } else { -1.0 }]
        };
        let positions = std::iter::once([0.0; 3]).chain((0..6).map(rim)).collect();
        let faces = (0..6).map(|k| [0, 1 + k, 1 + (k + 1) % 6]).collect();
        let found = all(&Soup::new(positions, faces), 2);
        let across = found.iter().find(|p| p.ends == [1, 4]).unwrap().length;
        assert!((across - 2.0 * 2.0_f64.sqrt()).abs() < 1e-14);
    }
}
