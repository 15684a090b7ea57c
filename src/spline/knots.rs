//! The knots of a triangulated domain in the plane.

use super::index::MAX_DEGREE;
use crate::error::{Error, Result};
use crate::geometry::clip::clip;
use crate::geometry::complex::{cross, distance, dot, doubled_area, sub};
use std::collections::{HashMap, HashSet};
use std::f64::consts::TAU;
use std::ops::RangeInclusive;

/// Knots lie no farther from their vertex than this share of the smallest distance at which Ω of a triangle at the vertex could vanish:
/// the radius of its inscribed circle. Far knots make a spline smoother to look at, near ones make more points need one patch alone.
pub const SPREAD: f64 = 0.5;
/// Boundary edges whose directions differ by less than this, in radians, are one straight side: rounding of their coordinates.
const STRAIGHT: f64 = 1e-9;
/// Part of the smallest side over which three knots of a patch must be apart from a line, so that barycentric coordinates in them keep
/// ten digits.
const LEAST_HEIGHT: f64 = 1e-5;
/// Sizes that patches may have in their charts: products of doubled areas stay in the range of doubles.
const SIZES: RangeInclusive<f64> = 1e-60..=1e60;
/// Turn from one knot of a vertex to the next, in turns: the golden section, whose multiples are as far apart as can be.
const GOLDEN: f64 = 0.381_966_011_250_105_1;
/// How many directions of a vertex's first knot are compared.
const FIRST_TURNS: usize = 64;

/// A triangulated domain in the plane: what a planar spline is made on.
#[derive(Debug, Clone, PartialEq)]
pub struct Domain {
    /// Places of the vertices.
    pub vertices: Vec<[f64; 2]>,
    /// Corners of the triangles, counterclockwise.
    pub triangles: Vec<[u32; 3]>,
}

/// How knots are placed.
#[derive(Debug, Clone, PartialEq)]
pub struct KnotOptions {
    /// Distance of the knots of a vertex from it over the radius of the smallest circle inscribed in a triangle there; between 0 and 1,
    /// neither included. On a straight boundary some are nearer. Default [`SPREAD`].
    pub spread: f64,
    /// Vertices whose knots coincide, as at a corner of the boundary: basis functions end there as Bézier triangles do.
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

impl Domain {
    /// Whether the arrays make a domain: corners that exist, counterclockwise triangles, no edge of more than two.
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

    /// Knots t_{i,0} = i, t_{i,1}, …, t_{i,n} per vertex: around vertices inside in general position; on straight sides of the boundary
    /// along these; at corners of the boundary all at the vertex.
    ///
    /// # Errors
    /// Those of [`Domain::check`]; [`Error::Argument`] for a degree that is not 1 to 5, or a spread outside its range; [`Error::Spline`]
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
        let mut around = vec![Around { radius: f64::INFINITY, edges: Vec::new(), lines: Vec::new() }; n];
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

/// What the knots of a vertex have to keep clear of, and to keep to.
#[derive(Debug, Clone)]
pub(crate) struct Around {
    /// Of the smallest circle inscribed in a triangle at the vertex; infinite without triangles.
    pub radius: f64,
    /// Directions of its edges.
    pub edges: Vec<[f64; 2]>,
    /// Directions of the lines on which its knots have to lie.
    pub lines: Vec<[f64; 2]>,
}

impl Around {
    /// The knots of a vertex at `center`: that itself, and others `spread` times the radius away, on lines less.
    pub fn knots(&self, center: [f64; 2], degree: usize, spread: f64) -> Vec<[f64; 2]> {
        let reach = if self.radius.is_finite() { spread * self.radius } else { 0.0 };
        let first = self.first_turn(degree);
        // Far from each other: where two knots are near, the spline bends sharply between them.
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
            [center[0] + reach * x, center[1] + reach * y]
        };
        (0..=degree).map(knot).collect()
    }

    /// The direction of the first knot, in turns, for which knots and edges are farthest from having the same line: the spline bends
    /// sharply where a knot lies near the line of an edge.
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

/// The direction of knot j where that of knot 0 would be a turn of `first`.
fn knot_direction(first: f64, j: usize) -> [f64; 2] {
    let angle = TAU * (first + j as f64 * GOLDEN);
    [angle.cos(), angle.sin()]
}

/// Whether the knots of a patch, t_{k,j}, give it basis functions: all triangles (t_{0,a}, t_{1,b}, t_{2,c}) are counterclockwise, and the
/// region Ω that is inside all of them is not empty.
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

/// Whether all triangles (t_{0,a}, t_{1,b}, t_{2,c}) of knots are counterclockwise.
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

/// The convex polygon Ω: what the lines from knots of one vertex to knots of the next leave of the patch. Empty where nothing is left.
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

/// The area of Ω over that of the patch; 0 where it is empty, or three knots are clockwise.
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
    // Rounding of a corner that lies on the line.
    let zero = f64::EPSILON * 8.0 * dot(along, along);
    let height = |p: &[f64; 2]| Some(cross(along, sub(*p, a))).filter(|h| h.abs() > zero).unwrap_or(0.0);
    let left = clip(polygon, height);
    if doubled_area_of(&left) > zero { left } else { Vec::new() }
}

/// Whether two directions are the same or opposite.
fn is_parallel(a: [f64; 2], b: [f64; 2]) -> bool {
    cross(a, b).abs() < STRAIGHT
}

/// Whether two directions are the same.
pub(super) fn is_straight(a: [f64; 2], b: [f64; 2]) -> bool {
    is_parallel(a, b) && dot(a, b) > 0.0
}

/// Whether a degree is one that splines have.
pub(super) fn check_degree(degree: usize) -> Result<()> {
    if (1..=MAX_DEGREE).contains(&degree) {
        return Ok(());
    }
    Err(Error::argument("degree", degree, "1 to 5"))
}
