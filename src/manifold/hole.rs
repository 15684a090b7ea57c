//! The surface around a singular vertex.
//!
//! Around a vertex with a total angle of 2πm a spline over the flat metric is continuous and no more. There the surface is a polynomial of the
//! coordinate w = z^{1/m}, in which the vertex is a point as any other, and goes over into the spline by a weight that is 1 for
//! |w| ≤ ρ/2, 0 for |w| ≥ ρ, and has two continuous derivatives:
//!
//! ```text
//!     F̃ = F + φ(|w|/ρ) (G(w) − F),        φ = 1 for t ≤ ½,  1 − (10 s³ − 15 s⁴ + 6 s⁵), s = 2t − 1, for ½ ≤ t ≤ 1.
//! ```
//!
//! So F̃ has as many continuous derivatives as F, up to two, on all of the hole.

use super::domain::SurfaceDomain;
use super::jet::Jet;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::complex::{Complex, mul, norm, norm2, scale};
use crate::geometry::vector::Vector;
use crate::linalg::dense::solve_definite;
use crate::mesh::VertexId;
use crate::spline::{Parameter, Spline, SurfacePoint};
use std::f64::consts::TAU;

/// Radius of the hole over the distance of the vertex from the sides opposite it.
const REACH: f64 = 0.9;
/// How far the total angle may be from a multiple of 2π, in turns.
const WHOLE: f64 = 1e-6;
/// Degree of the polynomial.
const DEGREE: usize = 6;
/// Circles around the vertex, and places on each, at which the polynomial is fitted to the spline: where the weight goes from 1 to 0.
const RINGS: [usize; 2] = [6, 48];
/// Weight of the size of the polynomial's coefficients beside the squares of its distances: decides where there are few points.
const SMALL: f64 = 1e-10;

/// The hole around a singular vertex, and what fills it.
#[derive(Debug, Clone, PartialEq)]
pub struct Hole {
    /// The vertex of the coarse triangulation.
    pub vertex: VertexId,
    /// m: the total angle in turns.
    pub turns: i32,
    /// Radius of the hole in the unit of the flat metric.
    pub radius: f64,
    /// Coefficients of p^i q^j for i + j = 0, 1, …, 6, each with falling i, where p + iq = w/ρ.
    pub coefficients: Vec<Vector>,
}

impl Hole {
    /// Fill the surroundings of a vertex from the spline around them and the points that lie in them.
    ///
    /// # Errors
    /// [`Error::Argument`] for a vertex whose total angle is no multiple of 2π, or on the boundary; those of [`Spline::evaluate`].
    pub fn fill(
        domain: &SurfaceDomain,
        spline: &Spline,
        vertex: VertexId,
        (places, points): (&[Parameter], &[Vector]),
        control: &Control,
    ) -> Result<Hole> {
        let turns = domain.total_angle(vertex) / TAU;
        let is_whole = (turns - turns.round()).abs() < WHOLE && turns > 0.5;
        if domain.coarse().mesh.is_boundary_vertex(vertex) || !is_whole {
            let need = "a vertex inside the surface whose total angle is a multiple of 2π";
            return Err(Error::argument("total angle in turns", turns, need));
        }
        let radius = REACH * domain.clearance(vertex);
        let mut hole = Hole { vertex, turns: turns.round() as i32, radius, coefficients: Vec::new() };
        let rings: Vec<Parameter> = hole.rings(domain);
        let found = spline.evaluate(&rings, 0, 1, control)?;
        let on_rings = rings.iter().copied().zip(found.iter().map(|at| at.point));
        let inside = places.iter().copied().zip(points.iter().copied());
        let n = (DEGREE + 1) * (DEGREE + 2) / 2;
        let (mut matrix, mut right) = (vec![vec![0.0; n]; n], vec![vec![0.0; 3]; n]);
        for (place, point) in on_rings.chain(inside) {
            let Some(w) = hole.coordinate(domain, place).map(|w| w[0]).filter(|w| norm(*w) <= 1.0) else {
                continue;
            };
            let row: Vec<f64> =
                powers([Jet::constant(w[0]), Jet::constant(w[1])]).map(|jet| jet.0[0]).collect();
            for (i, a) in row.iter().enumerate() {
                row.iter().enumerate().for_each(|(j, b)| matrix[i][j] += a * b);
                (0..3).for_each(|x| right[i][x] += a * point[x]);
            }
        }
        let trace: f64 = (0..n).map(|i| matrix[i][i]).sum();
        (0..n).for_each(|i| matrix[i][i] += SMALL * trace);
        hole.coefficients = solve_definite(&matrix, &right)?.iter().map(|c| [c[0], c[1], c[2]]).collect();
        Ok(hole)
    }

    /// Places on circles around the vertex.
    fn rings(&self, domain: &SurfaceDomain) -> Vec<Parameter> {
        let [circles, each] = RINGS;
        let each = each * self.turns as usize;
        let ring = |k: usize| 0.5 + 0.5 * (k as f64 + 0.5) / circles as f64;
        let place = |k: usize, j: usize| {
            let angle = TAU * self.turns as f64 * (j as f64 + 0.5) / each as f64;
            domain.around(self.vertex, self.radius * ring(k).powi(self.turns), angle)
        };
        (0..circles).flat_map(|k| (0..each).filter_map(move |j| place(k, j))).collect()
    }

    /// w/ρ of a place in the chart of its triangle, with first and second derivative there; none in triangles that do not have the vertex.
    fn coordinate(&self, domain: &SurfaceDomain, at: Parameter) -> Option<[Complex; 3]> {
        let (z, [r, angle]) = domain.polar(self.vertex, at)?;
        let share = 1.0 / self.turns as f64;
        let size = (r / self.radius).powf(share);
        let w = [size * (share * angle).cos(), size * (share * angle).sin()];
        if r == 0.0 {
            return Some([w, [0.0; 2], [0.0; 2]]);
        }
        let over = |a: Complex| scale(1.0 / norm2(z), mul(a, [z[0], -z[1]]));
        let first = scale(share, over(w));
        Some([w, first, scale(share - 1.0, over(first))])
    }

    /// The surface at a place where the spline has this point; none outside the hole.
    pub fn surface(
        &self,
        domain: &SurfaceDomain,
        at: Parameter,
        spline: &SurfacePoint,
    ) -> Option<SurfacePoint> {
        let w = self.coordinate(domain, at).filter(|w| norm(w[0]) < 1.0)?;
        let w = Jet::of_holomorphic(w);
        let radius = w[0].times(w[0]).plus(w[1].times(w[1]));
        let weight = radius.through(fade(radius.0[0]));
        let rest = Jet::constant(1.0).plus(weight.times(Jet::constant(-1.0)));
        let mut found = SurfacePoint::default();
        for x in 0..3 {
            let [a, b] = spline.first.map(|d| d[x]);
            let [aa, ab, bb] = spline.second.map(|d| d[x]);
            let outside = Jet([spline.point[x], a, b, aa, ab, bb]);
            let terms = powers(w).zip(&self.coefficients).map(|(p, c)| p.times(Jet::constant(c[x])));
            let inside = terms.fold(Jet::constant(0.0), Jet::plus);
            let Jet(all) = weight.times(inside).plus(rest.times(outside));
            found.point[x] = all[0];
            (0..2).for_each(|k| found.first[k][x] = all[1 + k]);
            (0..3).for_each(|k| found.second[k][x] = all[3 + k]);
        }
        Some(found)
    }
}

/// p^i q^j for i + j = 0, 1, …, each with falling i.
fn powers([p, q]: [Jet; 2]) -> impl Iterator<Item = Jet> {
    let power = |x: Jet, n: usize| (0..n).fold(Jet::constant(1.0), |y, _| y.times(x));
    (0..=DEGREE).flat_map(move |n| (0..=n).map(move |j| power(p, n - j).times(power(q, j))))
}

/// φ(√x) with its first and second derivative by x.
fn fade(x: f64) -> [f64; 3] {
    let t = x.sqrt();
    if t <= 0.5 {
        return [1.0, 0.0, 0.0];
    }
    let s = (2.0 * t - 1.0).min(1.0);
    let value = 1.0 - s * s * s * (10.0 + s * (6.0 * s - 15.0));
    // By t: ds/dt = 2; by x: dt/dx = 1/(2t).
    let first = -2.0 * 30.0 * s * s * (1.0 - s) * (1.0 - s);
    let second = -4.0 * 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s);
    [value, first / (2.0 * t), (second - first / t) / (4.0 * t * t)]
}
