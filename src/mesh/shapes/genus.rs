//! Closed surfaces of any genus: a smooth plate with g holes in a row.
//!
//! ```text
//!      ____________________     The plate lies between its rim and its holes. Half-way between them runs
//!     /  ____   |    ____  \    the medial graph: a loop around each hole; neighbours share a bridge.
//!    |  /    \  |   /    \  |   Rim and holes each have a ring of quads reaching from the graph on the upper
//!    |  \____/  |   \____/  |   sheet around the tube to the graph on the lower one: 2n layers. Vertices are
//!     \_________|__________/    regular but for the two ends of each bridge, above and below.
//! ```

use super::check_count;
use crate::error::Result;
use crate::mesh::Point;
use crate::mesh::io::Soup;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Radius of the holes.
pub(super) const HOLE: f64 = 1.0;
/// Radius of the tube around a hole.
const TUBE: f64 = 0.35;
/// Radius of the rim around a hole on its own.
pub(super) const RIM: f64 = HOLE + 2.0 * TUBE;
/// Half the distance of neighbouring holes.
pub(super) const HALF_STEP: f64 = HOLE + TUBE;
/// Temperature of the smooth union of the rim's disks, in squared lengths: the larger, the more the waists between the holes are filled.
const BLEND: f64 = 2.0;
/// Number of disks on each side of the nearest one that are summed. The weight of all others is below rounding: at most `exp(−((2·REACH +
/// 1)² − 1) HALF_STEP² / BLEND)` ≈ 1e−19 of the nearest one's.
const REACH: usize = 3;

type Point2 = [f64; 2];

/// A smooth closed surface of genus `genus` ≥ 1: handles in a row along the x axis. (Genus 0:
/// [`super::icosphere`].)
///
/// With the holes' centres `c_k = (1.35 (2k + 1 − g), 0)`, the surface is `z² = f(x, y)` where
///
/// ```text
///     f = 0.7 / (1/p + Σ_k 1/p_k)
///     p_k = (|x − c_k|² − 1) / 2                               about the distance from hole k (radius 1)
///     p = (1.7² + 2 log Σ_k exp(−|x − c_k|²/2)) / 3.4          about the distance from the rim
/// ```
///
/// The rim is a smooth union of disks of radius 1.7, and `f` the harmonic mean that makes a tube of radius
/// about 0.35 between two parallel walls. Every vertex lies on the surface to rounding.
///
/// `n` ≥ 1 is the number of layers over a quarter of the tube: `8(5g + 1)n² + 2 − 2g` vertices, no angle below 27°. Vertex order: the
/// medial graph above, the same below, then ring by ring (hole 0, …, hole g − 1, rim), layer by layer downwards. For g ≥ 2 vertex 0 is
/// the lower end of the first bridge between two holes, where ten triangles meet, which leaves room for a cone of negative curvature.
///
/// Each height is a sum over all holes, so the time grows with n² g².
///
/// # Errors
///
/// [`crate::Error::Argument`] for a count that is too small, or too large to number the vertices.
pub fn genus(genus: usize, n: usize) -> Result<Soup> {
    let vertices = 8.0 * (5.0 * genus as f64 + 1.0) * (n as f64).powi(2);
    check_count("genus", genus, 1, vertices)?;
    check_count("layers", n, 1, vertices)?;
    let plate = Plate { genus };
    let Skeleton { points, holes, rim } = plate.skeleton(n);
    let mut sheets = Sheets { plate, layers: n, points: &points, positions: Vec::new(), faces: Vec::new() };
    let heights: Vec<f64> = points.iter().map(|&p| plate.height(p)).collect();
    for side in [1.0, -1.0] {
        sheets.positions.extend(points.iter().zip(&heights).map(|(p, z)| [p[0], p[1], side * z]));
    }
    for (k, ring) in holes.iter().enumerate() {
        sheets.ring(ring, |p| plate.foot_on_hole(k, p), PlateBorder::Hole);
    }
    sheets.ring(&rim, |p| plate.foot_on_rim(p), PlateBorder::Rim);
    Ok(Soup::new(sheets.positions, sheets.faces))
}

/// The plate, given by its number of holes: rim, holes and height over the plane.
#[derive(Clone, Copy)]
struct Plate {
    genus: usize,
}

/// The medial graph: points, and the loops around the holes and along the rim, all counter-clockwise.
struct Skeleton {
    points: Vec<Point2>,
    holes: Vec<Vec<usize>>,
    rim: Vec<usize>,
}

impl Plate {
    /// The x coordinate of the centre of hole k.
    fn centre(self, k: usize) -> f64 {
        HALF_STEP * (2.0 * k as f64 + 1.0 - self.genus as f64)
    }

    /// `|x − c_k|²`.
    fn square(self, k: usize, [x, y]: Point2) -> f64 {
        (x - self.centre(k)).powi(2) + y * y
    }

    /// `p_k`, which is 0 on hole k and has slope 1 there.
    fn hole_distance(self, k: usize, p: Point2) -> f64 {
        (self.square(k, p) - HOLE * HOLE) / (2.0 * HOLE)
    }

    /// `p`, which is 0 on the rim.
    fn rim_distance(self, p: Point2) -> f64 {
        let nearest = ((p[0] - self.centre(0)) / (2.0 * HALF_STEP))
            .round()
            .clamp(0.0, self.genus as f64 - 1.0) as usize;
        let least = self.square(nearest, p);
        let disks = nearest.saturating_sub(REACH)..self.genus.min(nearest + REACH + 1);
        let sum: f64 = disks.map(|k| ((least - self.square(k, p)) / BLEND).exp()).sum();
        (RIM * RIM - least + BLEND * sum.ln()) / (2.0 * RIM)
    }

    /// Height `√f` of the upper sheet; 0 on the rim and the holes.
    fn height(self, p: Point2) -> f64 {
        let holes: f64 = (0..self.genus).map(|k| self.hole_distance(k, p).recip()).sum();
        (2.0 * TUBE / (self.rim_distance(p).recip() + holes)).max(0.0).sqrt()
    }

    /// The point of hole k nearest to `p`.
    fn foot_on_hole(self, k: usize, p: Point2) -> Point2 {
        let (dx, r) = (p[0] - self.centre(k), self.square(k, p).sqrt());
        [self.centre(k) + HOLE * dx / r, HOLE * p[1] / r]
    }

    /// The point of the rim outside of `p`: in the direction from the centre of the first or last hole in the caps, along y between them.
    fn foot_on_rim(self, p: Point2) -> Point2 {
        let x = p[0].clamp(self.centre(0), self.centre(self.genus - 1));
        let r = (p[0] - x).hypot(p[1]);
        let along = |t: f64| [x + t * (p[0] - x) / r, t * p[1] / r];
        along(root(0.0, 2.0 * RIM, |t| self.rim_distance(along(t))))
    }

    /// The point half-way between hole k and the rim, in direction `angle` from the hole's centre.
    fn medial(self, k: usize, angle: f64) -> Point2 {
        let (sin, cos) = angle.sin_cos();
        let along = |t: f64| [self.centre(k) + t * cos, t * sin];
        along(root(HOLE, 2.0 * RIM, |t| self.rim_distance(along(t)) - self.hole_distance(k, along(t))))
    }

    /// The medial graph, with 2n steps on a bridge, 4n between the bridges of a hole, 10n around an end, 12n around a single hole.
    fn skeleton(self, n: usize) -> Skeleton {
        let mut points = Vec::new();
        let last = self.genus - 1;
        if last == 0 {
            let ring: Vec<usize> = (0..12 * n).collect();
            points.extend(ring.iter().map(|&i| self.medial(0, TAU * i as f64 / ring.len() as f64)));
            return Skeleton { points, holes: vec![ring.clone()], rim: ring };
        }
        // Bridge k, between the holes k and k + 1, ends in the directions ±tilt[k] from hole k.
        let mut tilt = Vec::with_capacity(last);
        for k in 0..last {
            let x = self.centre(k) + HALF_STEP;
            let end = root(0.0, 2.0 * RIM, |y| self.rim_distance([x, y]) - self.hole_distance(k, [x, y]));
            tilt.push(end.atan2(HALF_STEP));
            let steps = (0..=2 * n).map(|i| i as f64 / n as f64 - 1.0);
            points.extend(steps.map(|t| [x, HALF_STEP * (t * tilt[k]).tan()]));
        }
        let bottom = |k: usize| k * (2 * n + 1);
        let top = |k: usize| bottom(k) + 2 * n;
        // Half-open paths: each ends at the start of the next.
        let up = |k: usize| bottom(k)..top(k);
        let down = |k: usize| (bottom(k) + 1..=top(k)).rev();
        let mut arc = |k: usize, start: usize, from: f64, to: f64, steps: usize| {
            let new = points.len()..points.len() + steps - 1;
            let angles = (1..steps).map(|i| from + (to - from) * i as f64 / steps as f64);
            points.extend(angles.map(|angle| self.medial(k, angle)));
            std::iter::once(start).chain(new).collect::<Vec<usize>>()
        };
        let west = arc(0, top(0), tilt[0], TAU - tilt[0], 10 * n);
        let east = arc(last, bottom(last - 1), tilt[last - 1] - PI, PI - tilt[last - 1], 10 * n);
        let mut holes = vec![up(0).chain(west.iter().copied()).collect::<Vec<usize>>()];
        let (mut north, mut south) = (Vec::new(), Vec::new());
        for k in 1..last {
            let upper = arc(k, top(k), tilt[k], PI - tilt[k - 1], 4 * n);
            let lower = arc(k, bottom(k - 1), PI + tilt[k - 1], TAU - tilt[k], 4 * n);
            holes.push(
                up(k).chain(upper.iter().copied()).chain(down(k - 1)).chain(lower.iter().copied()).collect(),
            );
            north.push(upper);
            south.push(lower);
        }
        holes.push(east.iter().copied().chain(down(last - 1)).collect());
        north.reverse();
        let rim = [vec![east], north, vec![west], south].concat().concat();
        Skeleton { points, holes, rim }
    }
}

/// The part of the plate's border that a ring of quads leads around.
#[derive(Clone, Copy, PartialEq)]
enum PlateBorder {
    Hole,
    Rim,
}

/// The mesh under construction.
struct Sheets<'a> {
    plate: Plate,
    /// The points of the medial graph.
    points: &'a [Point2],
    layers: usize,
    positions: Vec<Point>,
    faces: Vec<[u32; 3]>,
}

impl Sheets<'_> {
    /// Adds the quads from the medial loop above, around the tube through `foot`, to the medial loop below.
    fn ring(&mut self, ring: &[usize], foot: impl Fn(Point2) -> Point2, side: PlateBorder) {
        let points = self.points;
        let feet: Vec<Point2> = ring.iter().map(|&v| foot(points[v])).collect();
        let mut above = ring.to_vec();
        for layer in 1..=2 * self.layers {
            let below: Vec<usize> = if layer == 2 * self.layers {
                ring.iter().map(|v| v + points.len()).collect()
            } else {
                (self.positions.len()..self.positions.len() + ring.len()).collect()
            };
            if layer < 2 * self.layers {
                // A round tube in cross-section: the sine of the angle from its crest, towards the foot.
                let t = (FRAC_PI_2 * layer as f64 / self.layers as f64).sin();
                for (&v, foot) in ring.iter().zip(&feet) {
                    let p = [0, 1].map(|d| (1.0 - t) * points[v][d] + t * foot[d]);
                    self.positions.push(match layer.cmp(&self.layers) {
                        std::cmp::Ordering::Less => [p[0], p[1], self.plate.height(p)],
                        std::cmp::Ordering::Equal => [foot[0], foot[1], 0.0],
                        std::cmp::Ordering::Greater => [p[0], p[1], -self.plate.height(p)],
                    });
                }
            }
            for j in 0..ring.len() {
                let next = (j + 1) % ring.len();
                let quad = [above[j], above[next], below[next], below[j]];
                self.split(quad, side);
            }
            above = below;
        }
    }

    /// Splits a quad (counter-clockwise from outside around a hole, clockwise around the rim) along its shorter diagonal; quads between
    /// vertex 0 and a hole are split along the diagonal through vertex 0.
    fn split(&mut self, mut quad: [usize; 4], side: PlateBorder) {
        if side == PlateBorder::Rim {
            quad.reverse();
        }
        let square = |i: usize, j: usize| {
            let (p, q) = (self.positions[quad[i]], self.positions[quad[j]]);
            (0..3).map(|d| (p[d] - q[d]).powi(2)).sum::<f64>()
        };
        let swap = match quad.iter().position(|&v| v == 0) {
            Some(corner) if side == PlateBorder::Hole => corner % 2 == 1,
            _ => square(1, 3) < square(0, 2),
        };
        let [a, b, c, d] = quad.map(|v| v as u32);
        self.faces.extend(if swap { [[a, b, d], [b, c, d]] } else { [[a, b, c], [a, c, d]] });
    }
}

/// The point between `low` and `high` where `f` falls through zero, by bisection to rounding.
fn root(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return middle;
        }
        if f(middle) > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
}
