//! The places of the vertices of a quad mesh on the metric's triangulation. Those on nodes and walls are known; the others are reached from
//! them along the sides of squares, straight across triangles.

use super::grid_charts::{GridCharts, VertexHold};
use super::grid_map::{GridMap, PlaneVector, cross, turned};
use super::grid_surface::GridSurface;
use super::grid_vector::GridMotion;
use super::t_mesh::{HalfArc, TMesh};
use super::t_mesh_node::NodeKey;
use crate::error::{Error, Result};
use crate::mesh::{FaceId, HalfedgeId};
use std::collections::VecDeque;

/// A point of the metric's triangulation: a triangle and barycentric coordinates in it.
pub(super) type MetricPlace = (FaceId, [f64; 3]);

/// Most triangles that a side of a square crosses, times the number of triangles.
const MOST_CROSSED: usize = 4;

/// A triangle near a vertex, and the motion from the vertex's own coordinates to those of the triangle.
#[derive(Debug, Clone, Copy)]
struct VertexChart {
    face: FaceId,
    motion: GridMotion,
}

/// The places of the vertices of an embedded grid map.
///
/// # Errors
/// [`Error::Layout`] for a vertex that is not reached.
pub(super) fn vertex_places(
    surface: &GridSurface,
    t_mesh: &TMesh,
    charts: &GridCharts<'_>,
    map: &GridMap,
    places: &[PlaneVector],
) -> Result<Vec<MetricPlace>> {
    let own: Vec<PlaneVector> = places.iter().map(|p| p.map(|x| x / map.unit)).collect();
    let mut search = PlaceSearch {
        surface,
        t_mesh,
        charts,
        own,
        corners_at: corners_at(map, places.len()),
        found: vec![None; places.len()],
        places: vec![None; places.len()],
    };
    search.place_held()?;
    search.place_beside_nodes(map)?;
    search.reach_others()?;
    search.place_beside_groups()?;
    search.reach_others()?;
    let place = |(v, place): (usize, Option<MetricPlace>)| {
        place.ok_or_else(|| Error::Layout(format!("vertex {v} of the quad mesh has no place")))
    };
    search.places.into_iter().enumerate().map(place).collect()
}

/// Per vertex the corners of squares that are at it.
fn corners_at(map: &GridMap, n: usize) -> Vec<Vec<(u32, u8)>> {
    let mut at = vec![Vec::new(); n];
    for (k, corners) in map.squares.iter().enumerate() {
        for (i, corner) in corners.iter().enumerate() {
            at[corner.vertex].push((k as u32, i as u8));
        }
    }
    at
}

struct PlaceSearch<'a> {
    surface: &'a GridSurface,
    t_mesh: &'a TMesh,
    charts: &'a GridCharts<'a>,
    /// Per vertex its place in its own coordinates, in units of the grid.
    own: Vec<PlaneVector>,
    corners_at: Vec<Vec<(u32, u8)>>,
    /// Per vertex that is on no node a triangle near it.
    found: Vec<Option<VertexChart>>,
    places: Vec<Option<MetricPlace>>,
}

impl PlaceSearch<'_> {
    /// Places the vertices on nodes and on walls.
    fn place_held(&mut self) -> Result<()> {
        for v in 0..self.own.len() {
            match self.charts.holds[v] {
                VertexHold::Node(node) => self.places[v] = self.t_mesh.nodes[node].place(self.surface),
                VertexHold::Wall(h) => self.place_on_wall(v, h)?,
                VertexHold::Free => {}
            }
        }
        Ok(())
    }

    /// The triangle to the left of a half-arc at its beginning, the motion from the coordinates of the rectangle there to those of the
    /// triangle, and that to coordinates with the half-arc along +x from the origin.
    fn beside(&self, h: HalfArc) -> Result<(FaceId, GridMotion, GridMotion)> {
        let (node, slot) = self.t_mesh.arcs[h / 2].ends[h % 2];
        let frame = self.t_mesh.nodes[node].frame(self.surface, slot);
        let (Some((face, to_frame)), Some(side)) = (frame, self.charts.sides[h]) else {
            let node = self.t_mesh.nodes[node];
            return Err(Error::Layout(format!("no triangle lies beside the line from {node:?}")));
        };
        let along = GridMotion::to_origin(side.begin.real, side.side as u8);
        Ok((face, to_frame.inverse().after(&along), along))
    }

    /// Places a vertex on the wall along a half-arc, or on the straight walls before or behind it.
    fn place_on_wall(&mut self, v: usize, h: HalfArc) -> Result<()> {
        let (face, mut motion, along) = self.beside(h)?;
        let [x, _] = applied(&along, self.own[v]);
        // A half-edge in the coordinates in which the half-arc is along +x.
        let (surface, mesh) = (self.surface, &*self.surface.mesh);
        let ends = |e: HalfedgeId, motion: &GridMotion| {
            let back = along.after(&motion.inverse());
            [surface.origin(e), surface.tip(e)].map(|p| back.apply(p))
        };
        let is_along = |e: HalfedgeId, motion: &GridMotion| {
            let [a, b] = ends(e, motion);
            a[1] == 0 && b[1] == 0 && b[0] > a[0]
        };
        let first = mesh.face_halfedges(face).into_iter().find(|&e| is_along(e, &motion));
        let mut e = first.ok_or_else(|| Error::Layout(format!("a wall leaves face {face}")))?;
        let mut steps = 0;
        loop {
            let [a, b] = ends(e, &motion).map(|p| p[0] as f64);
            steps += 1;
            let next = if steps > mesh.n_halfedges() {
                None
            } else if x > b {
                in_line(surface, e, motion, |h| mesh.next(h), is_along)
            } else if x < a {
                in_line(surface, e, motion, |h| mesh.prev(h), is_along)
            } else {
                None
            };
            let Some((next, next_motion)) = next else {
                let t = ((x - a) / (b - a)).clamp(0.0, 1.0);
                let (face, k) = mesh.corner(e).ok_or_else(|| Error::Layout(format!("no face beside {e}")))?;
                let mut weights = [0.0; 3];
                weights[k] = 1.0 - t;
                weights[(k + 1) % 3] = t;
                self.places[v] = Some((face, weights));
                self.found[v] = Some(VertexChart { face, motion });
                return Ok(());
            };
            (e, motion) = (next, next_motion);
        }
    }

    /// Places the vertices next to nodes.
    fn place_beside_nodes(&mut self, map: &GridMap) -> Result<()> {
        for h in (0..self.charts.sides.len()).filter(|&h| self.charts.sides[h].is_some()) {
            let at = self.charts.point(h, 0).vertex as usize;
            let is_at_node = match self.charts.holds[at] {
                VertexHold::Node(node) => node == self.t_mesh.origin(h),
                _ => map.anchors.contains(&h),
            };
            if !is_at_node || !self.charts.has_squares(h) {
                continue;
            }
            let (face, motion, _) = self.beside(h)?;
            if map.anchors.contains(&h) {
                let own = motion.after(&self.charts.point(h, 0).motion.real);
                let chart = VertexChart { face, motion: own };
                self.place(at, self.walk(chart, self.own[at], self.own[at])?);
                continue;
            }
            let next = self.charts.point(h, 1);
            let (w, begin) = (next.vertex as usize, self.charts.node_place(h));
            let (true, Some(begin)) = (self.places[w].is_none(), begin) else { continue };
            let to = applied(&next.motion.real, self.own[w]);
            let from = begin.real.map(|x| x as f64);
            let there = self.walk(VertexChart { face, motion }, from, to)?;
            self.place(w, VertexChart { face: there.face, motion: there.motion.after(&next.motion.real) });
        }
        Ok(())
    }

    /// Places vertices that no side of a square joins to one that is placed, but by a corner that arcs of length 0 join to a cone or corner of the
    /// surface: from the node at that corner, if the side from there ends at the cone.
    fn place_beside_groups(&mut self) -> Result<()> {
        for h in (0..self.charts.sides.len()).filter(|&h| self.charts.has_squares(h)) {
            let [at, next] = [0, 1].map(|step| self.charts.point(h, step));
            let (w, begin) = (next.vertex as usize, self.charts.node_place(h));
            let VertexHold::Node(node) = self.charts.holds[at.vertex as usize] else { continue };
            let (NodeKey::Vertex(cone), true, Some(begin)) =
                (self.t_mesh.nodes[node], self.places[w].is_none(), begin)
            else {
                continue;
            };
            let (face, motion, _) = self.beside(h)?;
            let [from, to] = [begin.real.map(|x| x as f64), applied(&next.motion.real, self.own[w])];
            let there = self.walk(VertexChart { face, motion }, from, to)?;
            let back = self.walk(there, to, applied(&at.motion.real, [0.0, 0.0]))?;
            if self.surface.mesh.face_vertices(back.face).contains(&cone) {
                let motion = there.motion.after(&next.motion.real);
                self.place(w, VertexChart { face: there.face, motion });
            }
        }
        Ok(())
    }

    /// Places all other vertices along the sides of squares.
    fn reach_others(&mut self) -> Result<()> {
        let mut waiting: VecDeque<usize> = (0..self.own.len()).filter(|&v| self.found[v].is_some()).collect();
        while let Some(v) = waiting.pop_front() {
            let Some(chart) = self.found[v] else { continue };
            for (square, i) in self.corners_at[v].clone() {
                let corners = self.charts.squares[square as usize];
                let here = corners[usize::from(i)].motion.real;
                let in_square = VertexChart { face: chart.face, motion: chart.motion.after(&here.inverse()) };
                for k in [usize::from(i + 1) % 4, usize::from(i + 3) % 4] {
                    let (w, there) = (corners[k].vertex as usize, corners[k].motion.real);
                    if self.places[w].is_some() {
                        continue;
                    }
                    let ends = [applied(&here, self.own[v]), applied(&there, self.own[w])];
                    let found = self.walk(in_square, ends[0], ends[1])?;
                    self.place(w, VertexChart { face: found.face, motion: found.motion.after(&there) });
                    waiting.push_back(w);
                }
            }
        }
        Ok(())
    }

    fn place(&mut self, v: usize, chart: VertexChart) {
        let corners = self.surface.corners(chart.face).map(|p| p.map(|x| x as f64));
        self.places[v] = Some((chart.face, inside(weights(corners, applied(&chart.motion, self.own[v])))));
        self.found[v] = Some(chart);
    }

    /// The triangle at the end of a straight line that begins in a triangle, and the motion to its coordinates. The ends are in the
    /// coordinates that the motion carries to those of the triangle. On the boundary the line ends.
    fn walk(&self, begin: VertexChart, from: PlaneVector, to: PlaneVector) -> Result<VertexChart> {
        let (surface, mesh) = (self.surface, &*self.surface.mesh);
        let VertexChart { mut face, mut motion } = begin;
        let mut entry: Option<HalfedgeId> = None;
        for _ in 0..MOST_CROSSED * mesh.n_faces() {
            let [a, b] = [from, to].map(|p| applied(&motion, p));
            let heading = [b[0] - a[0], b[1] - a[1]];
            let side = |h: HalfedgeId, p: PlaneVector| {
                let [origin, tip] = [surface.origin(h), surface.tip(h)].map(|p| p.map(|x| x as f64));
                cross([tip[0] - origin[0], tip[1] - origin[1]], [p[0] - origin[0], p[1] - origin[1]])
            };
            let beyond = |h: &HalfedgeId| Some(*h) != entry && side(*h, b) < 0.0;
            let outside: Vec<HalfedgeId> = mesh.face_halfedges(face).into_iter().filter(beyond).collect();
            let right_of_line = |p: [i64; 2]| {
                let p = p.map(|x| x as f64);
                cross(heading, [p[0] - a[0], p[1] - a[1]])
            };
            let crosses = |h: &&HalfedgeId| {
                right_of_line(surface.origin(**h)) <= 0.0 && right_of_line(surface.tip(**h)) >= 0.0
            };
            let Some(&exit) = outside.iter().find(crosses).or(outside.first()) else {
                return Ok(VertexChart { face, motion });
            };
            let Some(next) = mesh.face(exit.twin()) else { return Ok(VertexChart { face, motion }) };
            motion = surface.across(exit).after(&motion);
            (face, entry) = (next, Some(exit.twin()));
        }
        Err(Error::Layout(format!("a side of a square that begins in face {} has no end", begin.face)))
    }
}

/// The half-edge in line with one at its tip, where `around` is the next half-edge of a triangle, or at its origin, where it is the previous one;
/// with the triangle to its left, and the motion to that triangle's coordinates.
fn in_line(
    surface: &GridSurface,
    e: HalfedgeId,
    mut motion: GridMotion,
    around: impl Fn(HalfedgeId) -> HalfedgeId,
    is_along: impl Fn(HalfedgeId, &GridMotion) -> bool,
) -> Option<(HalfedgeId, GridMotion)> {
    let mesh = &*surface.mesh;
    let mut at = around(e);
    for _ in 0..mesh.n_halfedges() {
        if is_along(at, &motion) {
            return Some((at, motion));
        }
        mesh.face(at.twin())?;
        motion = surface.across(at).after(&motion);
        at = around(at.twin());
    }
    None
}

/// The image of a point under a motion.
fn applied(motion: &GridMotion, p: PlaneVector) -> PlaneVector {
    let [x, y] = turned(p, motion.turns);
    [x + motion.shift[0] as f64, y + motion.shift[1] as f64]
}

/// Barycentric coordinates of a point in a triangle.
fn weights([a, b, c]: [PlaneVector; 3], p: PlaneVector) -> [f64; 3] {
    let area = |a: PlaneVector, b: PlaneVector, c: PlaneVector| {
        cross([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]])
    };
    let total = area(a, b, c);
    [area(p, b, c), area(p, c, a), area(p, a, b)].map(|x| x / total)
}

/// Weights that are not negative and have the sum 1.
fn inside(weights: [f64; 3]) -> [f64; 3] {
    let positive = weights.map(|x| x.max(0.0));
    let total: f64 = positive.iter().sum();
    positive.map(|x| x / total)
}
