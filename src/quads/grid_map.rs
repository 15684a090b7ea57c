//! The map of a quad mesh to the surface. Corners of squares have coordinates in the rectangles of a T-mesh, whose sides have whole lengths
//! at time 0, where every square is a unit square, and at time 1 the lengths of the seamless map. Cones and corners go with their nodes,
//! vertices on walls stay on them, and all others are where the squares are least distorted.

use super::grid_charts::{ChartPlace, GridCharts, GridCorner, SquareParts, VertexHold};
use super::grid_vector::GridPoint;
use super::t_mesh::HalfArc;
use crate::error::{Error, Result};
use crate::linalg::{Cholesky, Pattern, Symmetric};
use crate::mesh::union_find::UnionFind;
use std::f64::consts::FRAC_PI_2;

/// Largest deviation of the sum of the angles around a vertex of a map without folds, radians.
const ANGLE_ERROR: f64 = 1e-6;

/// A plane vector in units of the quad mesh.
pub(super) type PlaneVector = [f64; 2];

/// Places of the vertices, in their own coordinates, at some time.
#[derive(Debug, Clone)]
pub(super) struct TimedPlaces {
    pub time: f64,
    pub places: Vec<PlaneVector>,
}

/// A corner of a square: a vertex, and the motion from its own coordinates to those of the square's rectangle.
#[derive(Debug, Clone, Copy)]
pub(super) struct MapCorner {
    pub vertex: usize,
    turns: u8,
    /// The translations at the times 0 and 1; in between they are between them.
    shift: [PlaneVector; 2],
}

impl MapCorner {
    /// The place in the coordinates of the rectangle.
    pub fn place(&self, places: &[PlaneVector], time: f64) -> PlaneVector {
        let [x, y] = turned(places[self.vertex], self.turns);
        let [a, b] = self.shift;
        [x + a[0] + time * (b[0] - a[0]), y + a[1] + time * (b[1] - a[1])]
    }

    /// The own coordinates of the vertex at a place in the coordinates of the rectangle.
    pub fn own_place(&self, [x, y]: PlaneVector, time: f64) -> PlaneVector {
        let [a, b] = self.shift;
        self.back([x - a[0] - time * (b[0] - a[0]), y - a[1] - time * (b[1] - a[1])])
    }

    /// A vector of the rectangle's coordinates in those of the vertex.
    pub fn back(&self, v: PlaneVector) -> PlaneVector {
        turned(v, (4 - self.turns) % 4)
    }

    /// The coordinate of the vertex, and its sign, that a coordinate of the rectangle follows.
    fn follows(&self, coordinate: usize) -> (usize, f64) {
        let own = turned([1.0, 2.0], self.turns)[coordinate];
        (usize::from(own.abs() > 1.5), own.signum())
    }
}

/// A vector turned counterclockwise by quarter turns.
pub(super) fn turned([x, y]: PlaneVector, turns: u8) -> PlaneVector {
    match turns % 4 {
        0 => [x, y],
        1 => [-y, x],
        2 => [-x, -y],
        _ => [y, -x],
    }
}

/// A coordinate of a vertex.
#[derive(Debug, Clone, Copy)]
enum Coordinate {
    /// Held at the value between these, at the times 0 and 1.
    Held([f64; 2]),
    /// The unknown of this number.
    Unknown(u32),
}

/// The squares, the coordinates of their vertices, and the matrix of their uniform Laplacian.
pub(super) struct GridMap {
    pub squares: Vec<[MapCorner; 4]>,
    coordinates: Vec<[Coordinate; 2]>,
    n_unknowns: usize,
    laplacian: Cholesky,
    /// The places at time 0.
    pub whole_places: Vec<PlaneVector>,
    /// The units of these coordinates in one of the grid at time 1.
    pub unit: f64,
    /// Half-arcs from the nodes at which pieces without cones and corners are held.
    pub anchors: Vec<HalfArc>,
}

impl GridMap {
    /// # Errors
    /// [`Error::Layout`] where the Laplacian has no factors.
    pub fn new(charts: &GridCharts<'_>, unit: f64) -> Result<GridMap> {
        let scaled = |p: GridPoint| p.map(|x| x as f64 * unit);
        let corner = |corner: &GridCorner| MapCorner {
            vertex: corner.vertex as usize,
            turns: corner.motion.whole.turns,
            shift: [corner.motion.whole.shift.map(|x| x as f64), scaled(corner.motion.real.shift)],
        };
        let squares: Vec<[MapCorner; 4]> =
            charts.squares.iter().map(|square| [0, 1, 2, 3].map(|k| corner(&square[k]))).collect();
        let mut held: Vec<[Option<[f64; 2]>; 2]> = vec![[None; 2]; charts.holds.len()];
        for (v, hold) in charts.holds.iter().enumerate() {
            match *hold {
                VertexHold::Node(_) => held[v] = [Some([0.0; 2]); 2],
                VertexHold::Wall(h) => {
                    if let Some(side) = charts.sides[h] {
                        let across = 1 - side.side % 2;
                        let values = [side.begin.whole[across] as f64, scaled(side.begin.real)[across]];
                        held[v][across] = Some(values);
                    }
                }
                VertexHold::Free => {}
            }
        }
        let anchors = anchors(charts, &squares, &held);
        for &h in &anchors {
            let corner = charts.point(h, 0);
            let Some(ChartPlace { whole, real }) = charts.node_place(h) else { continue };
            let whole = corner.motion.whole.inverse().apply(whole);
            let real = scaled(corner.motion.real.inverse().apply(real));
            held[corner.vertex as usize] = [0, 1].map(|c| Some([whole[c] as f64, real[c]]));
        }
        let mut n_unknowns = 0;
        let mut coordinate = |held: Option<[f64; 2]>| match held {
            Some(values) => Coordinate::Held(values),
            None => {
                n_unknowns += 1;
                Coordinate::Unknown(n_unknowns - 1)
            }
        };
        let coordinates: Vec<[Coordinate; 2]> =
            held.into_iter().map(|held| held.map(&mut coordinate)).collect();
        let laplacian = laplacian(&squares, &coordinates, n_unknowns as usize)?;
        let whole_places = charts.whole_places.iter().map(|p| p.map(|x| x as f64)).collect();
        let n_unknowns = n_unknowns as usize;
        Ok(GridMap { squares, coordinates, n_unknowns, laplacian, whole_places, unit, anchors })
    }

    /// The corners of a square in the coordinates of its rectangle.
    pub fn corners(&self, square: usize, places: &[PlaneVector], time: f64) -> [PlaneVector; 4] {
        self.squares[square].map(|corner| corner.place(places, time))
    }

    /// The places at time 1 with the least sum of squared lengths of the sides of all squares.
    pub fn harmonic(&mut self) -> Vec<PlaneVector> {
        let mut places = self.whole_places.clone();
        self.hold(&mut places, 1.0);
        let mut gradient = vec![[0.0; 2]; places.len()];
        for corners in &self.squares {
            let at = corners.map(|corner| corner.place(&places, 1.0));
            for k in 0..4 {
                let [a, b] = [k, (k + 1) % 4];
                let side = [at[b][0] - at[a][0], at[b][1] - at[a][1]];
                add(&mut gradient[corners[b].vertex], corners[b].back(side));
                add(&mut gradient[corners[a].vertex], corners[a].back(side.map(|x| -x)));
            }
        }
        let step = self.preconditioned(&gradient);
        for (place, step) in places.iter_mut().zip(step) {
            *place = [place[0] - step[0], place[1] - step[1]];
        }
        places
    }

    /// Sets coordinates that are held to their values.
    fn hold(&self, places: &mut [PlaneVector], time: f64) {
        for (place, coordinates) in places.iter_mut().zip(&self.coordinates) {
            for c in 0..2 {
                if let Coordinate::Held([first, last]) = coordinates[c] {
                    place[c] = first + time * (last - first);
                }
            }
        }
    }

    /// The places for which squares of an undivided map are divided bilinearly: convex squares are divided in
    /// convex ones.
    pub fn subdivided(&self, undivided: &GridMap, from: &TimedPlaces, division: &SquareParts) -> TimedPlaces {
        let mut divided = vec![[0.0; 2]; self.coordinates.len()];
        for (square, part) in self.squares.iter().zip(&division.part_of) {
            let [a, b, c, d] = undivided.corners(part.square, &from.places, from.time);
            for (corner, [i, j]) in square.iter().zip([[0, 0], [1, 0], [1, 1], [0, 1]]) {
                let [s, t] = [part.at[0] + i, part.at[1] + j].map(|x| x as f64 / division.parts as f64);
                let at =
                    |k: usize| (1.0 - t) * ((1.0 - s) * a[k] + s * b[k]) + t * ((1.0 - s) * d[k] + s * c[k]);
                let place = [0, 1].map(|k| division.parts as f64 * at(k));
                divided[corner.vertex] = corner.own_place(place, from.time);
            }
        }
        self.hold(&mut divided, from.time);
        TimedPlaces { time: from.time, places: divided }
    }

    /// The Laplacian's solution for a gradient, 0 where coordinates are held.
    pub fn preconditioned(&mut self, gradient: &[PlaneVector]) -> Vec<PlaneVector> {
        let mut b = vec![0.0; self.n_unknowns];
        for (coordinates, gradient) in self.coordinates.iter().zip(gradient) {
            for c in 0..2 {
                if let Coordinate::Unknown(k) = coordinates[c] {
                    b[k as usize] = gradient[c];
                }
            }
        }
        self.laplacian.solve(&mut b);
        let value = |c: Coordinate| match c {
            Coordinate::Unknown(k) => b[k as usize],
            Coordinate::Held(_) => 0.0,
        };
        self.coordinates.iter().map(|coordinates| coordinates.map(value)).collect()
    }

    /// Sets the gradient to 0 where coordinates are held.
    pub fn project(&self, gradient: &mut [PlaneVector]) {
        for (coordinates, gradient) in self.coordinates.iter().zip(gradient) {
            for c in 0..2 {
                if let Coordinate::Held(_) = coordinates[c] {
                    gradient[c] = 0.0;
                }
            }
        }
    }

    /// True if every square is convex and the squares lie around each vertex once.
    pub fn is_embedded(&self, places: &[PlaneVector], time: f64) -> bool {
        let mut excess = vec![0.0; places.len()];
        for (k, corners) in self.squares.iter().enumerate() {
            let at = self.corners(k, places, time);
            for i in 0..4 {
                let [u, v] = corner_sides(&at, i);
                let area = cross(u, v);
                if area.is_nan() || area <= 0.0 {
                    return false;
                }
                excess[corners[i].vertex] += area.atan2(u[0] * v[0] + u[1] * v[1]) - FRAC_PI_2;
            }
        }
        excess.into_iter().all(|x| x.abs() < ANGLE_ERROR)
    }
}

/// The sides of a square at a corner: to the next one and to the one before.
pub(super) fn corner_sides(at: &[PlaneVector; 4], i: usize) -> [PlaneVector; 2] {
    [(i + 1) % 4, (i + 3) % 4].map(|k| [at[k][0] - at[i][0], at[k][1] - at[i][1]])
}

pub(super) fn cross(u: PlaneVector, v: PlaneVector) -> f64 {
    u[0] * v[1] - u[1] * v[0]
}

pub(super) fn add(sum: &mut PlaneVector, v: PlaneVector) {
    sum[0] += v[0];
    sum[1] += v[1];
}

/// For each connected piece in which no vertex is held in both coordinates, a half-arc with a square to its left, from the node at which it is to be.
fn anchors(
    charts: &GridCharts<'_>,
    squares: &[[MapCorner; 4]],
    held: &[[Option<[f64; 2]>; 2]],
) -> Vec<HalfArc> {
    let mut pieces = UnionFind::new(held.len());
    for [a, b, c, d] in squares {
        [b, c, d].into_iter().for_each(|other| {
            pieces.join(a.vertex as u32, other.vertex as u32);
        });
    }
    let mut is_held = vec![false; held.len()];
    for v in (0..held.len()).filter(|&v| held[v].iter().all(Option::is_some)) {
        is_held[pieces.root(v as u32) as usize] = true;
    }
    let mut anchors = Vec::new();
    for h in (0..charts.sides.len()).filter(|&h| charts.has_squares(h)) {
        let piece = pieces.root(charts.point(h, 0).vertex) as usize;
        if !std::mem::replace(&mut is_held[piece], true) {
            anchors.push(h);
        }
    }
    anchors
}

/// The matrix of the sum of squared lengths of the sides of all squares.
fn laplacian(squares: &[[MapCorner; 4]], coordinates: &[[Coordinate; 2]], n: usize) -> Result<Cholesky> {
    // Each coordinate of a side is the difference of two coordinates of vertices.
    let mut differences: Vec<[Option<(usize, f64)>; 2]> = Vec::with_capacity(8 * squares.len());
    let term = |corner: &MapCorner, c: usize, sign: f64| {
        let (own, own_sign) = corner.follows(c);
        match coordinates[corner.vertex][own] {
            Coordinate::Unknown(k) => Some((k as usize, sign * own_sign)),
            Coordinate::Held(_) => None,
        }
    };
    for corners in squares {
        for k in 0..4 {
            let [a, b] = [&corners[k], &corners[(k + 1) % 4]];
            differences.extend([0, 1].map(|c| [term(b, c, 1.0), term(a, c, -1.0)]));
        }
    }
    let pair = |terms: &[Option<(usize, f64)>; 2]| match terms {
        [Some((i, _)), Some((j, _))] if i != j => Some((*i as u32, *j as u32)),
        _ => None,
    };
    let pairs: Vec<(u32, u32)> = differences.iter().filter_map(pair).collect();
    let pattern = Pattern::new(n, &pairs)?;
    let mut values = vec![0.0; pattern.entries()];
    for terms in &differences {
        let [a, b] = terms;
        for (i, sign) in [a, b].into_iter().flatten() {
            values[pattern.diagonal(*i)] += sign * sign;
        }
        if let (Some((i, s)), Some((j, t))) = (a, b) {
            match pattern.position(*i, *j) {
                Some(position) if i != j => values[position] += s * t,
                _ => values[pattern.diagonal(*i)] += 2.0 * s * t,
            }
        }
    }
    let mut cholesky = Cholesky::analyse(&pattern)?;
    let factored = cholesky.factor(Symmetric { pattern: &pattern, values: &values });
    factored.map_err(|_| Error::Layout("the squares of a quad mesh do not hold together".into()))?;
    Ok(cholesky)
}
