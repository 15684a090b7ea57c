//! The squares of an integer-grid map with the coordinates of their corners in the rectangles of a T-mesh. Each vertex of the quad mesh has
//! coordinates of its own, and each corner of a square a motion from them to its rectangle's, both in whole units of the quad mesh and in
//! units of the grid of the seamless map.

use super::grid_vector::{GridMotion, GridPoint, turned};
use super::separation::Separation;
use super::t_mesh::{HalfArc, TMesh};
use std::collections::VecDeque;

/// A motion from one rectangle's coordinates to another's, in both units.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct ChartMotion {
    pub whole: GridMotion,
    pub real: GridMotion,
}

impl ChartMotion {
    pub const IDENTITY: ChartMotion = ChartMotion { whole: GridMotion::IDENTITY, real: GridMotion::IDENTITY };

    /// The translation by a place in both units.
    fn to(place: ChartPlace) -> ChartMotion {
        let by = |shift| GridMotion { turns: 0, shift };
        ChartMotion { whole: by(place.whole), real: by(place.real) }
    }

    /// This motion after another.
    fn after(&self, first: &ChartMotion) -> ChartMotion {
        ChartMotion { whole: self.whole.after(&first.whole), real: self.real.after(&first.real) }
    }
}

/// A place in the coordinates of a rectangle, in both units.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct ChartPlace {
    pub whole: GridPoint,
    pub real: GridPoint,
}

/// The side of a rectangle on which a half-arc lies.
#[derive(Debug, Clone, Copy)]
pub(super) struct HalfArcSide {
    pub rectangle: usize,
    /// The side, 0 to 3 counterclockwise.
    pub side: usize,
    /// The half-arcs before and after it around the rectangle.
    around: [HalfArc; 2],
    /// The place of its beginning.
    pub begin: ChartPlace,
    /// The squares before it on its side.
    squares_before: usize,
}

/// A vertex of the quad mesh as a corner of a square.
#[derive(Debug, Clone, Copy)]
pub(super) struct GridCorner {
    pub vertex: u32,
    /// From the vertex's own coordinates to those of the square's rectangle.
    pub motion: ChartMotion,
}

/// A square as a part of a larger one.
#[derive(Debug, Clone, Copy)]
pub(super) struct SquarePart {
    /// The larger square.
    pub square: usize,
    /// The column and the row of the part in it.
    pub at: [usize; 2],
}

/// Squares as parts of larger ones.
pub(super) struct SquareParts {
    /// Per square the part that it is.
    pub part_of: Vec<SquarePart>,
    /// The number of parts along a side of a larger square.
    pub parts: usize,
}

/// What holds a vertex.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum VertexHold {
    /// It stands on a node and is the origin of its own coordinates.
    Node(usize),
    /// It moves along a wall: its own coordinates are those of the rectangle to the left of this half-arc.
    Wall(HalfArc),
    /// It moves freely.
    Free,
}

/// The squares and their corners.
pub(super) struct GridCharts<'a> {
    t_mesh: &'a TMesh,
    /// Per arc the number of squares along it.
    numbers: Vec<i64>,
    /// Per half-arc its side; none outside of the boundary.
    pub sides: Vec<Option<HalfArcSide>>,
    /// Per half-arc its first point.
    first: Vec<usize>,
    /// The points along the half-arcs.
    points: Vec<GridCorner>,
    /// Per vertex what holds it.
    pub holds: Vec<VertexHold>,
    /// Per vertex its place in its own coordinates in whole units.
    pub whole_places: Vec<GridPoint>,
    /// Per square its corners, counterclockwise from that nearest to its rectangle's first.
    pub squares: Vec<[GridCorner; 4]>,
    /// Per square its rectangle.
    pub rectangle: Vec<u32>,
}

const NO_VERTEX: u32 = u32::MAX;

impl<'a> GridCharts<'a> {
    pub fn new(t_mesh: &'a TMesh, numbers: Vec<i64>, separation: &Separation<'_>) -> GridCharts<'a> {
        let sides = arc_sides(t_mesh, &numbers);
        let mut first = Vec::with_capacity(2 * numbers.len());
        let mut n_points = 0;
        for h in 0..2 * numbers.len() {
            first.push(n_points);
            n_points += numbers[h / 2] as usize + 1;
        }
        let none = GridCorner { vertex: NO_VERTEX, motion: ChartMotion::IDENTITY };
        let mut charts = GridCharts {
            t_mesh,
            numbers,
            sides,
            first,
            points: vec![none; n_points],
            holds: Vec::new(),
            whole_places: Vec::new(),
            squares: Vec::new(),
            rectangle: Vec::new(),
        };
        charts.hold_nodes(separation);
        charts.join_points();
        charts.add_squares();
        charts
    }

    /// The number of squares along a half-arc.
    pub fn number(&self, h: HalfArc) -> usize {
        self.numbers[h / 2] as usize
    }

    /// The point at this distance along a half-arc.
    pub fn point(&self, h: HalfArc, step: usize) -> GridCorner {
        self.points[self.first[h] + step]
    }

    /// The vertices along an arc, from its first end.
    pub fn vertices_on_arc(&self, arc: usize) -> Vec<u32> {
        let h = if self.sides[2 * arc].is_some() { 2 * arc } else { 2 * arc + 1 };
        let mut vertices: Vec<u32> = (0..=self.number(h)).map(|step| self.point(h, step).vertex).collect();
        if h % 2 == 1 {
            vertices.reverse();
        }
        vertices
    }

    /// The place of a node in the rectangle to the left of a half-arc that leaves it.
    pub fn node_place(&self, h: HalfArc) -> Option<ChartPlace> {
        self.sides[h].map(|side| side.begin)
    }

    /// Per square the one of other charts that it is a part of, whose sides are `parts` sides of these, and its column and row there.
    pub fn parts_of(&self, undivided: &GridCharts<'_>, parts: usize) -> SquareParts {
        let mut part_of = Vec::with_capacity(self.squares.len());
        let mut first = 0;
        for r in 0..self.t_mesh.rectangles.len() {
            let [m, n] = undivided.size(r);
            for j in 0..n * parts {
                part_of.extend((0..m * parts).map(|i| SquarePart {
                    square: first + (j / parts) * m + i / parts,
                    at: [i % parts, j % parts],
                }));
            }
            first += m * n;
        }
        SquareParts { part_of, parts }
    }

    /// Per vertex of other charts, whose squares have sides of `parts` sides of these, the vertex here.
    pub fn vertices_of(&self, undivided: &GridCharts<'_>, parts: usize) -> Vec<u32> {
        let mut vertices = vec![NO_VERTEX; undivided.holds.len()];
        let last = parts - 1;
        let corners = [[0, 0], [last, 0], [last, last], [0, last]];
        for (square, part) in self.squares.iter().zip(self.parts_of(undivided, parts).part_of) {
            for c in (0..4).filter(|&c| corners[c] == part.at) {
                vertices[undivided.squares[part.square][c].vertex as usize] = square[c].vertex;
            }
        }
        vertices
    }

    /// True for an arc with a rectangle on one side only.
    pub fn is_border(&self, arc: usize) -> bool {
        self.sides[2 * arc].is_none() || self.sides[2 * arc + 1].is_none()
    }

    /// True if a square lies to the left of a half-arc.
    pub fn has_squares(&self, h: HalfArc) -> bool {
        self.sides[h].is_some_and(|side| self.number(h) > 0 && self.length(side.rectangle, side.side + 1) > 0)
    }

    /// The squares along the first and the second side of a rectangle.
    pub fn size(&self, rectangle: usize) -> [usize; 2] {
        [0, 1].map(|side| self.length(rectangle, side))
    }

    /// The squares along a side of a rectangle.
    fn length(&self, rectangle: usize, side: usize) -> usize {
        self.t_mesh.rectangles[rectangle].sides[side % 4].iter().map(|&h| self.number(h)).sum()
    }

    /// The vertices that stand on special nodes.
    fn hold_nodes(&mut self, separation: &Separation<'_>) {
        let mut leaving: Vec<Vec<HalfArc>> = vec![Vec::new(); self.t_mesh.nodes.len()];
        for h in (0..self.sides.len()).filter(|&h| self.sides[h].is_some()) {
            leaving[self.t_mesh.origin(h)].push(h);
        }
        for (node, leaving) in leaving.iter().enumerate().filter(|(k, _)| separation.is_special(*k)) {
            let vertex = self.holds.len() as u32;
            let mut seeds = Vec::new();
            for &h in leaving {
                let Some(side) = self.sides[h] else { continue };
                self.points[self.first[h]] = GridCorner { vertex, motion: ChartMotion::to(side.begin) };
                seeds.push((h, 0));
            }
            if !seeds.is_empty() {
                self.holds.push(VertexHold::Node(node));
                self.whole_places.push([0, 0]);
                self.spread(seeds);
            }
        }
    }

    /// The vertices of the other points along half-arcs, those on walls first.
    fn join_points(&mut self) {
        let is_wall = |h: &HalfArc| self.t_mesh.arcs[h / 2].is_wall;
        let (walls, others): (Vec<HalfArc>, Vec<HalfArc>) = (0..self.sides.len()).partition(is_wall);
        let n_walls = walls.len();
        for (k, h) in walls.into_iter().chain(others).enumerate() {
            let Some(side) = self.sides[h] else { continue };
            for step in 0..=self.number(h) {
                if self.point(h, step).vertex != NO_VERTEX {
                    continue;
                }
                let vertex = self.holds.len() as u32;
                self.points[self.first[h] + step] = GridCorner { vertex, motion: ChartMotion::IDENTITY };
                self.holds.push(if k < n_walls { VertexHold::Wall(h) } else { VertexHold::Free });
                self.whole_places.push(along(side.begin.whole, side.side, step as i64));
                self.spread(vec![(h, step)]);
            }
        }
    }

    /// Gives the vertex of these points to all points that are the same.
    fn spread(&mut self, seeds: Vec<(HalfArc, usize)>) {
        let mut waiting = VecDeque::from(seeds);
        while let Some((h, step)) = waiting.pop_front() {
            let GridCorner { vertex, motion } = self.point(h, step);
            for (next, step, across) in self.same_points(h, step) {
                let place = self.first[next] + step;
                if self.points[place].vertex == NO_VERTEX {
                    self.points[place] = GridCorner { vertex, motion: across.after(&motion) };
                    waiting.push_back((next, step));
                }
            }
        }
    }

    /// The points that are the same as one, with the motion to their rectangles: across the arc, on the half-arcs before and after it around
    /// the rectangle, and on the opposite side of a rectangle without width.
    fn same_points(&self, h: HalfArc, step: usize) -> Vec<(HalfArc, usize, ChartMotion)> {
        let Some(side) = self.sides[h] else { return Vec::new() };
        let n = self.number(h);
        let mut same = Vec::new();
        if self.sides[h ^ 1].is_some() {
            same.push((h ^ 1, n - step, self.across(h)));
        }
        if step == 0 {
            same.push((side.around[0], self.number(side.around[0]), ChartMotion::IDENTITY));
        }
        if step == n {
            same.push((side.around[1], 0, ChartMotion::IDENTITY));
        }
        let rectangle = &self.t_mesh.rectangles[side.rectangle];
        if self.length(side.rectangle, side.side + 1) == 0 {
            let wanted = self.length(side.rectangle, side.side) - (side.squares_before + step);
            for &h in &rectangle.sides[(side.side + 2) % 4] {
                let before = self.sides[h].map_or(0, |side| side.squares_before);
                if (before..=before + self.number(h)).contains(&wanted) {
                    same.push((h, wanted - before, ChartMotion::IDENTITY));
                }
            }
        }
        same
    }

    /// The motion from the rectangle to the left of a half-arc to that to its right.
    fn across(&self, h: HalfArc) -> ChartMotion {
        let (Some(here), Some(there)) = (self.sides[h], self.sides[h ^ 1]) else {
            return ChartMotion::IDENTITY;
        };
        // The half-arc runs along direction `side` here, and against direction `side` there.
        let turns = ((there.side + 6 - here.side) % 4) as u8;
        let length = self.t_mesh.arcs[h / 2].length as i64;
        let motion = |from: GridPoint, there_begin: GridPoint, length: i64| {
            let to = along(there_begin, there.side, length);
            let [x, y] = turned(from, turns);
            GridMotion { turns, shift: [to[0] - x, to[1] - y] }
        };
        ChartMotion {
            whole: motion(here.begin.whole, there.begin.whole, self.numbers[h / 2]),
            real: motion(here.begin.real, there.begin.real, length),
        }
    }

    /// The points along a side of a rectangle, in its direction.
    fn side_points(&self, r: usize, side: usize) -> Vec<GridCorner> {
        let mut points = Vec::new();
        for &h in &self.t_mesh.rectangles[r].sides[side] {
            let from = usize::from(!points.is_empty());
            points.extend((from..=self.number(h)).map(|step| self.point(h, step)));
        }
        points
    }

    fn add_squares(&mut self) {
        for r in 0..self.t_mesh.rectangles.len() {
            let [bottom, right, top, left] = [0, 1, 2, 3].map(|k| self.side_points(r, k));
            let (m, n) = (bottom.len() - 1, right.len() - 1);
            let first_inner = self.holds.len();
            for j in 1..n {
                for i in 1..m {
                    self.holds.push(VertexHold::Free);
                    self.whole_places.push([i as i64, j as i64]);
                }
            }
            let corner = |i: usize, j: usize| match (i, j) {
                (_, 0) => bottom[i],
                (_, j) if j == n => top[m - i],
                (0, _) => left[n - j],
                (i, _) if i == m => right[j],
                _ => GridCorner {
                    vertex: (first_inner + (j - 1) * (m - 1) + i - 1) as u32,
                    motion: ChartMotion::IDENTITY,
                },
            };
            for j in 0..n {
                for i in 0..m {
                    let corners = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]];
                    self.squares.push(corners.map(|[i, j]| corner(i, j)));
                    self.rectangle.push(r as u32);
                }
            }
        }
    }
}

/// The place at a distance along a side of a rectangle.
fn along(place: GridPoint, side: usize, by: i64) -> GridPoint {
    let [x, y] = turned([by, 0], side as u8);
    [place[0] + x, place[1] + y]
}

/// The side of each half-arc.
fn arc_sides(t_mesh: &TMesh, numbers: &[i64]) -> Vec<Option<HalfArcSide>> {
    let mut sides = vec![None; 2 * numbers.len()];
    for (r, rectangle) in t_mesh.rectangles.iter().enumerate() {
        let around: Vec<(usize, HalfArc)> =
            (0..4).flat_map(|k| rectangle.sides[k].iter().map(move |&h| (k, h))).collect();
        let mut begin = ChartPlace { whole: [0, 0], real: [0, 0] };
        let mut squares_before = 0;
        for (k, &(side, h)) in around.iter().enumerate() {
            let n = around.len();
            let (before, after) = (around[(k + n - 1) % n], around[(k + 1) % n]);
            if before.0 != side {
                squares_before = 0;
            }
            sides[h] =
                Some(HalfArcSide { rectangle: r, side, around: [before.1, after.1], begin, squares_before });
            let number = numbers[h / 2];
            begin = ChartPlace {
                whole: along(begin.whole, side, number),
                real: along(begin.real, side, t_mesh.arcs[h / 2].length as i64),
            };
            squares_before += number as usize;
        }
    }
    sides
}
