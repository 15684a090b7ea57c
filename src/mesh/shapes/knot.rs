//! Knotted tori, tubes around torus knots.

use super::{THIN, check_count, check_size, torus_grid};
use crate::error::{Error, Result};
use crate::geometry::vector::{Vector, add, cross, distance, dot, norm, normalised, scale, sub};
use crate::mesh::Point;
use crate::mesh::io::Soup;
use std::f64::consts::{PI, TAU};

/// Points of the core curve, per turn around the axis or the tube, at which the room for a tube is measured: neighbours are less than 3°
/// of a turn apart.
const SAMPLES_PER_ROUND: usize = 128;

/// Largest angle, in radians, by which the curve turns from one cross-section to the next.
const MOST_TURN: f64 = 0.25 * PI;

/// The core of a knotted torus: the curve on the torus of revolution with radii `big` and `small` that goes `p`
/// times around the axis while it goes `q` times around the tube.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TorusKnot {
    /// Times around the axis; with q coprime.
    pub p: u32,
    /// Times around the tube of the torus that carries the knot.
    pub q: u32,
    /// Radius of the centre circle of that torus.
    pub big: f64,
    /// Radius of the tube of that torus.
    pub small: f64,
}

impl TorusKnot {
    /// The point at `t` ∈ [0, 1).
    fn at(&self, t: f64) -> Point {
        let (sin_u, cos_u) = (TAU * f64::from(self.p) * t).sin_cos();
        let (sin_v, cos_v) = (TAU * f64::from(self.q) * t).sin_cos();
        let radius = self.big + self.small * cos_v;
        [radius * cos_u, radius * sin_u, self.small * sin_v]
    }

    /// Derivative by t.
    fn velocity(&self, t: f64) -> Vector {
        let (p, q) = (TAU * f64::from(self.p), TAU * f64::from(self.q));
        let ((sin_u, cos_u), (sin_v, cos_v)) = ((p * t).sin_cos(), (q * t).sin_cos());
        let (radius, change) = (self.big + self.small * cos_v, -self.small * q * sin_v);
        [change * cos_u - radius * p * sin_u, change * sin_u + radius * p * cos_u, self.small * q * cos_v]
    }

    /// The largest radius of a tube that does not meet itself, according to samples: the smaller of the least radius of curvature and
    /// half the least distance of points that are farther apart along the curve than the tube's half turn.
    fn room(&self) -> f64 {
        let n = SAMPLES_PER_ROUND * (self.p + self.q) as usize;
        let points: Vec<Point> = (0..n).map(|i| self.at(i as f64 / n as f64)).collect();
        let step = |i: usize| distance(points[i % n], points[(i + 1) % n]);
        // The radius of the circle through three successive points.
        let radius = |i: usize| {
            let [a, b, c] = [points[i], points[(i + 1) % n], points[(i + 2) % n]];
            let twice_area = norm(cross(sub(b, a), sub(c, a)));
            distance(a, b) * distance(b, c) * distance(c, a) / (2.0 * twice_area)
        };
        let mut room = (0..n).map(radius).fold(f64::INFINITY, f64::min);
        let length: f64 = (0..n).map(step).sum();
        for i in 0..n {
            let mut along = 0.0;
            for j in i + 1..n {
                along += step(j - 1);
                let half = 0.5 * distance(points[i], points[j]);
                if along.min(length - along) > PI * half {
                    room = room.min(half);
                }
            }
        }
        room
    }

    /// The tube of radius `tube` around the curve: a torus, knotted unless p or q is 1.
    ///
    /// A grid of `n` cross-sections, which are circles of `m` ≥ 3 vertices, each cell halved by a diagonal. `n` must be so large that the
    /// curve turns by at most π/4 from one section to the next, and that its chords are nearer to it than the room around the tube (about
    /// 40 for a trefoil); fewer sections would not make this knot. Vertex (i, j) is `i + n j`. From one section to the next the circle
    /// moves with as little rotation as possible, and the angle that is missing after one round is distributed evenly.
    ///
    /// # Errors
    ///
    /// [`Error::Argument`] for p, q that are 0 or not coprime, radii out of range, a tube that would meet
    /// itself, and counts out of range; the error for too few sections names the least number.
    pub fn torus(&self, tube: f64, n: usize, m: usize) -> Result<Soup> {
        let TorusKnot { p, q, big, small } = *self;
        if p.min(q) == 0 || p.max(q) > 1000 || gcd(p, q) != 1 {
            let need = "coprime and between 1 and 1000: the curve has gcd(p, q) pieces otherwise";
            return Err(Error::argument("p and q", format!("{p} and {q}"), need));
        }
        check_size("radius of the centre circle", big)?;
        check_size("radius of the knot's torus", small)?;
        check_size("radius of the tube", tube)?;
        let vertices = n as f64 * m as f64;
        check_count("cross-sections", n, 3, vertices)?;
        check_count("steps around the tube", m, 3, vertices)?;
        if !(THIN * big..=(1.0 - THIN) * big).contains(&small) {
            let need = "below that of the centre circle, by more than rounding";
            return Err(Error::argument("radius of the knot's torus", small, need));
        }
        let room = self.room();
        if !(THIN * big..room).contains(&tube) {
            let need = "thinner than the room between the strands, and not lost in rounding";
            return Err(Error::argument("radius of the tube", tube, need));
        }
        let least = self.least_sections(room - tube);
        if n < least {
            let value = format!("{n}, of at least {least} for this curve and tube");
            return Err(Error::argument("cross-sections", value, "enough for the tube to follow the curve"));
        }
        Ok(self.sweep(tube, n, m))
    }

    /// The least number of equal steps in t between which the tangent turns by at most [`MOST_TURN`], and whose chords are within `slack`
    /// of the curve: an arc of length s that turns by θ leaves its chord by s θ/8 at most.
    fn least_sections(&self, slack: f64) -> usize {
        let n = SAMPLES_PER_ROUND * (self.p + self.q) as usize;
        let velocity = |i: usize| self.velocity(i as f64 / n as f64);
        let (mut turn, mut speed) = (0.0f64, 0.0f64);
        for i in 0..n {
            let (a, b) = (velocity(i), velocity(i + 1));
            turn = turn.max(norm(cross(a, b)).atan2(dot(a, b)) * n as f64);
            speed = speed.max(norm(a));
        }
        (turn / MOST_TURN).max((0.125 * speed * turn / slack).sqrt()).ceil().max(3.0) as usize
    }

    fn sweep(&self, tube: f64, n: usize, m: usize) -> Soup {
        let tangent = |i: usize| normalised(self.velocity(i as f64 / n as f64));
        // The first direction across the tube points away from the axis, made normal to the curve.
        let mut across = Vec::with_capacity(n + 1);
        across.push(normalised(reject(self.at(0.0), tangent(0))));
        for i in 0..n {
            let carried = transport(across[i], tangent(i), tangent((i + 1) % n));
            across.push(normalised(reject(carried, tangent((i + 1) % n))));
        }
        let lag = signed_angle(across[n], across[0], tangent(0));
        torus_grid(n, m, |i, j| {
            let (a, along) = (across[i], tangent(i));
            // Clockwise around the curve, so that faces look outwards.
            let angle = lag * i as f64 / n as f64 - TAU * j as f64 / m as f64;
            let (sin, cos) = angle.sin_cos();
            let out = add(scale(cos, a), scale(sin, cross(along, a)));
            add(self.at(i as f64 / n as f64), scale(tube, out))
        })
    }
}

fn gcd(a: u32, b: u32) -> u32 {
    if b == 0 { a } else { gcd(b, a % b) }
}

/// The part of `a` that is normal to the unit vector `t`.
fn reject(a: Vector, t: Vector) -> Vector {
    sub(a, scale(dot(a, t), t))
}

/// `a` under the rotation of least angle that maps the unit vector `s` to `t`, as two reflections.
fn transport(a: Vector, s: Vector, t: Vector) -> Vector {
    // The first reflection maps s to −t, the second −t to t.
    reflect(reflect(a, add(s, t)), t)
}

/// The reflection in the plane across `n`.
fn reflect(a: Vector, n: Vector) -> Vector {
    sub(a, scale(2.0 * dot(a, n) / dot(n, n), n))
}

/// The angle from `a` to `b`, both normal to the unit vector `t`, counterclockwise seen from its tip.
fn signed_angle(a: Vector, b: Vector, t: Vector) -> f64 {
    dot(cross(a, b), t).atan2(dot(a, b))
}
