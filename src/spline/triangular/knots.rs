//! Triangulated domains in the plane, and their knots.

use super::index::MAX_DEGREE;
use crate::error::{Error, Result};
use crate::geometry::clip::clip;
use crate::geometry::complex::{cross, distance, dot, doubled_area, sub};
use std::collections::{HashMap, HashSet};
use std::f64::consts::TAU;
use std::ops::RangeInclusive;

/// Default distance of knots from their vertex, over the smallest radius of a circle inscribed in a triangle there, which is the distance
/// at which Ω of a triangle could vanish. Far knots make a spline look smoother; with near ones more points lie in one patch alone.
pub const SPREAD: f64 = 0.5;
/// Angle, in radians, below which two directions are parallel: rounding of coordinates.
const STRAIGHT: f64 = 1e-9;
/// Least height of a triangle of three knots over its longest side, so that barycentric coordinates in it keep ten digits.
const LEAST_HEIGHT: f64 = 1e-5;
/// Sizes that patches may have in their charts, so that products of doubled areas stay in the range of f64.
const SIZES: RangeInclusive<f64> = 1e-60..=1e60;
/// Angle from one knot of a vertex to the next, in turns: the golden section, whose multiples are as far apart as possible.
const GOLDEN: f64 = 0.381_966_011_250_105_1;
/// Number of directions of a vertex's first knot that are compared.
const FIRST_TURNS: usize = 64;

/// A triangulated domain of splines in the plane.
#[derive(Debug, Clone, PartialEq)]
pub struct PlaneDomain {
    /// The positions of the vertices.
    pub vertices: Vec<[f64; 2]>,
    /// The corners of the triangles, counterclockwise.
    pub triangles: Vec<[u32; 3]>,
}

/// Options for the placement of knots.
#[derive(Debug, Clone, PartialEq)]
pub struct KnotOptions {
    /// Distance of the knots of a vertex from it, over the smallest radius of a circle inscribed in a triangle there; between 0 and 1, both
    /// excluded. On a straight boundary some are nearer. Default [`SPREAD`].
    pub spread: f64,
    /// Vertices whose knots coincide, as at a corner of the boundary; basis functions end there as those of Bézier triangles.
    pub coincident: Vec<u32>,
    /// Edges, as pairs of vertices, across which the spline may have a crease: the knots of their vertices lie on the line of the crease,
    /// and coincide where it bends.
    pub creases: Vec<[u32; 2]>,
}

impl Default for KnotOptions {
    fn default() -> Self {
        KnotOptions { spread: SPREAD, coincident: Vec::new(), creases: Vec::new() }
    }
}

impl PlaneDomain {
    /// Checks that corners exist, triangles are counterclockwise, and no edge belongs to more than two.
    ///
    /// # Errors
    /// [`Error::Spline`] names the triangle or the edge.
    pub fn check(&self) -> Result<()> {
        let n = self.vertices.len();
        let refuse = |triangle: usize, message: String| {
            Err(Error::Spline { what: "triangle", index: triangle, message })
        };
        if let Some(v) = self.vertices.iter().position(|[x, y]| !(x.is_finite() && y.is_finite())) {
            return Err(Error::Spline {
                what: "vertex",
                index: v,
                message: "a coordinate is no number".into(),
            });
        }
        let mut sides = HashMap::new();
        for (t, corners) in self.triangles.iter().enumerate() {
            if let Some(v) = corners.iter().find(|v| **v as usize >= n) {
                return refuse(
                    t,
                    format!("vertex {v} does not exist, there are vertices 0 to {}", n.saturating_sub(1)),
                );
            }
            let [a, b, c] = corners.map(|v| self.vertices[v as usize]);
            if doubled_area([a, b, c]) <= 0.0 {
                return refuse(t, "its corners are not counterclockwise (turn it, or remove it)".into());
            }
            for k in 0..3 {
                if let Some(other) = sides.insert((corners[k], corners[(k + 1) % 3]), t) {
                    let [i, j] = [corners[k], corners[(k + 1) % 3]];
                    return refuse(t, format!("it overlaps triangle {other} at their edge from {i} to {j}"));
                }
            }
        }
        Ok(())
    }

    /// The edges on the boundary, with the domain on their left.
    pub(super) fn boundary(&self) -> Vec<[u32; 2]> {
        let sides = |t: &[u32; 3]| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]];
        let all: HashSet<[u32; 2]> = self.triangles.iter().flat_map(sides).collect();
        let inner = |[a, b]: &[u32; 2]| all.contains(&[*b, *a]);
        self.triangles.iter().flat_map(sides).filter(|side| !inner(side)).collect()
    }

    /// The knots t_{i,0}, …, t_{i,n} of each vertex i, the first of them the vertex itself: in general position around inner vertices,
    /// along straight sides of the boundary, and all at the vertex at corners of the boundary.
    ///
    /// # Errors
    /// Those of [`PlaneDomain::check`]; [`Error::Argument`] for a degree that is not 1 to 5, or a spread outside its range; [`Error::Spline`]
    /// for a vertex of the options that does not exist.
    pub fn knots(&self, degree: usize, options: &KnotOptions) -> Result<Vec<Vec<[f64; 2]>>> {
        check_degree(degree)?;
        self.check()?;
        if !(options.spread > 0.0 && options.spread < 1.0) {
            return Err(Error::argument("spread", options.spread, "above 0 and below 1"));
        }
        let n = self.vertices.len();
        let named = options.coincident.iter().chain(options.creases.iter().flatten());
        if let Some(&v) = named.into_iter().find(|v| **v as usize >= n) {
            return Err(Error::Spline {
                what: "vertex",
                index: v as usize,
                message: "it does not exist".into(),
            });
        }
        let unit = |a: u32, b: u32| {
            let [p, q] = [a, b].map(|v| self.vertices[v as usize]);
            sub(q, p).map(|x| x / distance(p, q))
        };
        let mut around =
            vec![KnotDirections { radius: f64::INFINITY, edges: Vec::new(), lines: Vec::new() }; n];
        for &[a, b, c] in &self.triangles {
            let [p, q, r] = [a, b, c].map(|v| self.vertices[v as usize]);
            let inscribed = doubled_area([p, q, r]) / (distance(p, q) + distance(q, r) + distance(r, p));
            for (v, to) in [(a, b), (b, c), (c, a)] {
                let around = &mut around[v as usize];
                around.radius = around.radius.min(inscribed);
                around.edges.push(unit(v, to));
            }
        }
        for [a, b] in self.boundary().into_iter().chain(options.creases.iter().copied()) {
            [a, b].into_iter().for_each(|v| around[v as usize].lines.push(unit(a, b)));
        }
        let place = |v: usize| {
            let is_coincident = options.coincident.contains(&(v as u32));
            around[v].knots(self.vertices[v], degree, if is_coincident { 0.0 } else { options.spread })
        };
        Ok((0..n).map(place).collect())
    }
}

/// The directions around a vertex that its knots avoid, and the lines that they keep to.
#[derive(Debug, Clone)]
pub(crate) struct KnotDirections {
    /// Radius of the smallest circle inscribed in a triangle at the vertex; infinite without triangles.
    pub radius: f64,
    /// Directions of the edges at the vertex, whose lines the knots avoid.
    pub edges: Vec<[f64; 2]>,
    /// Directions of the lines on which the knots must lie.
    pub lines: Vec<[f64; 2]>,
}

impl KnotDirections {
    /// The knots of a vertex at `centre`: the vertex, and others at `spread` times the radius, or less on a line.
    pub fn knots(&self, centre: [f64; 2], degree: usize, spread: f64) -> Vec<[f64; 2]> {
        let reach = if self.radius.is_finite() { spread * self.radius } else { 0.0 };
        let first = self.first_turn(degree);
        // Knots of a vertex are far from each other, since a spline bends sharply between near ones.
        let offset = |j: usize| match self.lines.split_first() {
            _ if j == 0 => [0.0; 2],
            None => knot_direction(first, j),
            Some((along, others)) if others.iter().all(|other| is_parallel(*along, *other)) => {
                let side = degree.div_ceil(2);
                let far = if j <= side {
                    j as f64 / side as f64
                } else {
                    -((j - side) as f64) / (degree - side) as f64
                };
                along.map(|x| far * x)
            }
            Some(_) => [0.0; 2],
        };
        let knot = |j: usize| {
            let [x, y] = offset(j);
            [centre[0] + reach * x, centre[1] + reach * y]
        };
        (0..=degree).map(knot).collect()
    }

    /// The direction, in turns, of the first knot for which all knots are farthest from the lines of edges: a spline bends sharply where a
    /// knot lies near the line of an edge.
    fn first_turn(&self, degree: usize) -> f64 {
        let clearance = |turn: f64| {
            let directions = (1..=degree).map(|j| knot_direction(turn, j));
            let lines = directions.flat_map(|d| self.edges.iter().map(move |&edge| cross(d, edge).abs()));
            lines.fold(f64::INFINITY, f64::min)
        };
        let turns = (0..FIRST_TURNS).map(|k| k as f64 / FIRST_TURNS as f64);
        let best = turns
            .map(|turn| (clearance(turn), turn))
            .fold((0.0, 0.0), |best, next| if next.0 >= best.0 { next } else { best });
        best.1
    }
}

/// The direction of knot j if that of knot 0 is at `first` turns.
fn knot_direction(first: f64, j: usize) -> [f64; 2] {
    let angle = TAU * (first + j as f64 * GOLDEN);
    [angle.cos(), angle.sin()]
}

/// Checks that the knots t_{k,j} give a patch basis functions: all triangles (t_{0,a}, t_{1,b}, t_{2,c}) are counterclockwise, and the
/// region Ω inside all of them is not empty.
///
/// # Errors
/// [`Error::Spline`] names the patch and the knots.
pub(super) fn check_knots(patch: usize, knots: &[Vec<[f64; 2]>; 3]) -> Result<()> {
    check_triangles(patch, knots)?;
    if omega(knots).is_empty() {
        let message = "no point is inside all triangles of its knots; move knots nearer to their vertices";
        return Err(Error::Spline { what: "patch", index: patch, message: message.into() });
    }
    Ok(())
}

/// Checks that all triangles (t_{0,a}, t_{1,b}, t_{2,c}) of knots are counterclockwise.
fn check_triangles(patch: usize, knots: &[Vec<[f64; 2]>; 3]) -> Result<()> {
    let refuse = |message: String| Err(Error::Spline { what: "patch", index: patch, message });
    let n = knots[0].len();
    if let Some(k) = (0..3).find(|&k| knots[k].len() != n) {
        return refuse(format!("corner {k} has {} knots, corner 0 has {n}", knots[k].len()));
    }
    if knots.iter().flatten().flatten().any(|x| !x.is_finite()) {
        return refuse("a coordinate of a knot is no number".into());
    }
    for (a, &p) in knots[0].iter().enumerate() {
        for (b, &q) in knots[1].iter().enumerate() {
            for (c, &r) in knots[2].iter().enumerate() {
                let longest = distance(p, q).max(distance(q, r)).max(distance(r, p));
                let twice_area = doubled_area([p, q, r]);
                if !(twice_area >= LEAST_HEIGHT * longest * longest && SIZES.contains(&longest)) {
                    return refuse(format!(
                        "its knots t[0][{a}], t[1][{b}], t[2][{c}] are clockwise or on a line, or not between 1e-60 and 1e60 apart; move \
                         knots nearer to their vertices, or scale the chart"
                    ));
                }
            }
        }
    }
    Ok(())
}

/// The corners of the convex polygon Ω: the patch clipped by all lines from a knot of one vertex to a knot of the next. Empty if Ω is.
pub(super) fn omega(knots: &[Vec<[f64; 2]>; 3]) -> Vec<[f64; 2]> {
    let mut polygon: Vec<[f64; 2]> = knots.iter().map(|of| of[0]).collect();
    for k in 0..3 {
        for &a in &knots[k] {
            for &b in &knots[(k + 1) % 3] {
                polygon = clipped(&polygon, a, b);
            }
        }
    }
    polygon
}

/// The area of Ω over that of the patch; 0 if Ω is empty or three knots are clockwise.
pub(crate) fn share_of_omega(knots: &[Vec<[f64; 2]>; 3]) -> f64 {
    if check_triangles(0, knots).is_err() {
        return 0.0;
    }
    let [a, b, c] = [&knots[0], &knots[1], &knots[2]].map(|of| of[0]);
    doubled_area_of(&omega(knots)) / doubled_area([a, b, c])
}

/// Twice the area of a convex polygon; 0 without corners.
fn doubled_area_of(polygon: &[[f64; 2]]) -> f64 {
    (1..polygon.len().max(2) - 1).map(|i| doubled_area([polygon[0], polygon[i], polygon[i + 1]])).sum()
}

/// The part of a convex polygon to the left of the line from a to b.
fn clipped(polygon: &[[f64; 2]], a: [f64; 2], b: [f64; 2]) -> Vec<[f64; 2]> {
    let along = sub(b, a);
    // Rounding of the height of a corner that lies on the line.
    let zero = f64::EPSILON * 8.0 * dot(along, along);
    let height = |p: &[f64; 2]| Some(cross(along, sub(*p, a))).filter(|h| h.abs() > zero).unwrap_or(0.0);
    let left = clip(polygon, height);
    if doubled_area_of(&left) > zero { left } else { Vec::new() }
}

/// True if two directions are the same or opposite.
fn is_parallel(a: [f64; 2], b: [f64; 2]) -> bool {
    cross(a, b).abs() < STRAIGHT
}

/// True if two directions are the same.
pub(super) fn is_straight(a: [f64; 2], b: [f64; 2]) -> bool {
    is_parallel(a, b) && dot(a, b) > 0.0
}

/// Checks that a degree is from 1 to 5.
pub(super) fn check_degree(degree: usize) -> Result<()> {
    if (1..=MAX_DEGREE).contains(&degree) {
        return Ok(());
    }
    Err(Error::argument("degree", degree, "1 to 5"))
}
