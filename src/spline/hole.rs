//! The surface around a singular vertex.
//!
//! Around a vertex with a total angle of 2πm the sum of the basis functions of a spline over the flat metric is not 1: in the core of the hole, the disk
//! of its knots. There the surface is a polynomial of the coordinate w = z^{1/m}, in which the vertex is a point as any other, and goes over
//! into the spline by a weight that is 1 for |w| ≤ τρ, 0 for |w| ≥ ρ, and has two continuous derivatives:
//!
//! ```text
//!     F̃ = F + φ(|w|/ρ) (G(w) − F),        φ = 1 for t ≤ τ,  1 − (10 s³ − 15 s⁴ + 6 s⁵), s = (t − τ)/(1 − τ), for τ ≤ t ≤ 1.
//! ```
//!
//! τ is ½, or where the core is wider in w, its rim.
//!
//! So F̃ has as many continuous derivatives as F, up to two, on all of the hole.

use super::jet::Jet;
use super::patch::Parameter;
use super::point::SurfacePoint;
use super::space::SplineSpace;
use crate::error::{Error, Result, check_size};
use crate::geometry::complex::{
    Complex, add, conj, cross, distance, dot, mul, norm, norm2, scale, sub, unit,
};
use crate::geometry::vector::Vector;
use crate::linalg::dense::solve_definite;
use std::f64::consts::TAU;

/// Degree of the polynomial.
const DEGREE: usize = 6;
/// Number of its coefficients.
const COEFFICIENTS: usize = (DEGREE + 1) * (DEGREE + 2) / 2;
/// Radius of the core over that of the hole: large enough that the spline does not bend sharply along the sides at the vertex, small enough that the core is a
/// small part of the triangles there.
const CORE: f64 = 0.05;
/// How much wider than the core the disk is in which the spline has no weight.
const CLEAR: f64 = 1.1;
/// Least τ.
const LEAST_INNER: f64 = 0.5;
/// Circles around the vertex, and places on each, at which the polynomial is fitted to the spline: where the weight goes from 1 to 0.
const RINGS: [usize; 2] = [6, 48];
/// Weight of the size of the polynomial's coefficients beside the squares of its distances: decides where there are few points.
const SMALL: f64 = 1e-10;
/// Nearer to the vertex, in the unit of the chart, a place is the vertex: derivatives by the chart's coordinates would overflow.
const VERTEX: f64 = 1e-50;
/// Most turns of a hole: surfaces of any genus that can be triangulated here have fewer.
const MOST_TURNS: u32 = 1 << 16;

/// A patch at a singular vertex.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sector {
    /// The patch.
    pub patch: u32,
    /// Which of its corners is the vertex: 0, 1 or 2.
    pub corner: usize,
    /// The angle around the vertex at which the patch begins, with its side from that corner to the next.
    pub angle: f64,
    /// The length that is 1 in the patch's chart.
    pub unit: f64,
}

/// The hole around a singular vertex, and what fills it.
#[derive(Debug, Clone, PartialEq)]
pub struct Hole {
    /// The patches around the vertex, counterclockwise.
    pub sectors: Vec<Sector>,
    /// m: the total angle in turns.
    pub turns: u32,
    /// Radius of the hole in the unit of the flat metric; the patches around the vertex contain it.
    pub radius: f64,
    /// Coefficients of p^i q^j for i + j = 0, 1, …, 6, each with falling i, where p + iq = w/ρ.
    pub coefficients: Vec<Vector>,
}

impl Hole {
    /// A hole that nothing fills yet.
    ///
    /// # Errors
    /// [`Error::Argument`] for no sectors, no turns, or a radius that is not positive.
    pub fn new(sectors: Vec<Sector>, turns: u32, radius: f64) -> Result<Hole> {
        if sectors.is_empty() || !(1..=MOST_TURNS).contains(&turns) {
            return Err(Error::argument(
                "turns of a hole",
                turns,
                "1 to 65536, with patches around the vertex",
            ));
        }
        if !(radius > 0.0 && radius.is_finite()) {
            return Err(Error::argument("radius of a hole", radius, "positive"));
        }
        Ok(Hole { sectors, turns, radius, coefficients: vec![[0.0; 3]; COEFFICIENTS] })
    }

    /// Radius of the core, in the unit of the metric: knots of the vertex lie in it.
    pub fn core(&self) -> f64 {
        CORE * self.radius
    }

    /// τ: the share of |w| up to which the surface is the polynomial alone.
    pub(super) fn inner(&self) -> f64 {
        (CLEAR * CORE).powf(1.0 / f64::from(self.turns)).max(LEAST_INNER)
    }

    /// Whether a place is in the core.
    pub(super) fn is_core(&self, space: &SplineSpace, at: Parameter) -> bool {
        self.coordinate(space, at).is_some_and(|[w, ..]| norm(w) <= self.inner())
    }

    /// A hole filled by a polynomial with these coefficients.
    ///
    /// # Errors
    /// [`Error::Size`]; [`Error::Spline`] for a sector that is no corner of a patch.
    pub fn filled_by(self, space: &SplineSpace, coefficients: Vec<Vector>) -> Result<Hole> {
        check_size("coefficients of a hole", coefficients.len(), COEFFICIENTS)?;
        let is_sound = |s: &Sector| {
            s.side(space).is_some()
                && s.corner < 3
                && s.angle.is_finite()
                && s.unit > 0.0
                && s.unit.is_finite()
        };
        if let Some(at) = self.sectors.iter().position(|sector| !is_sound(sector)) {
            let message = "it is no corner of a patch with an angle and a unit".into();
            return Err(Error::Spline { what: "sector of a hole", index: at, message });
        }
        if let Some(at) = coefficients.iter().position(|c| !c.iter().all(|x| x.is_finite())) {
            let message = "it is no finite number".into();
            return Err(Error::Spline { what: "coefficient of a hole", index: at, message });
        }
        Ok(Hole { coefficients, ..self })
    }

    /// Fill the hole: the polynomial that is nearest, in the sense of least squares, to points at places, of which those outside the hole do not count.
    ///
    /// # Errors
    /// [`Error::Factorisation`] without points.
    pub fn fill(&mut self, space: &SplineSpace, places: &[Parameter], points: &[Vector]) -> Result<()> {
        let n = COEFFICIENTS;
        let (mut matrix, mut right) = (vec![vec![0.0; n]; n], vec![vec![0.0; 3]; n]);
        for (place, point) in places.iter().zip(points) {
            let Some([w, ..]) = self.coordinate(space, *place).filter(|w| norm(w[0]) <= 1.0) else {
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
        self.coefficients = solve_definite(&matrix, &right)?.iter().map(|c| [c[0], c[1], c[2]]).collect();
        Ok(())
    }

    /// Places on circles around the vertex, where the weight goes from 1 to 0.
    pub fn rings(&self, space: &SplineSpace) -> Vec<Parameter> {
        let [circles, each] = RINGS;
        let each = each * self.turns as usize;
        let inner = self.inner();
        let ring = |k: usize| inner + (1.0 - inner) * (k as f64 + 0.5) / circles as f64;
        let angle = |j: usize| TAU * f64::from(self.turns) * (j as f64 + 0.5) / each as f64;
        let place =
            |k: usize, j: usize| self.place(space, self.radius * ring(k).powi(self.turns as i32), angle(j));
        (0..circles).flat_map(|k| (0..each).filter_map(move |j| place(k, j))).collect()
    }

    /// The place at a distance from the vertex, in the unit of the metric, in a direction: an angle from the first sector, counterclockwise.
    pub fn place(&self, space: &SplineSpace, far: f64, angle: f64) -> Option<Parameter> {
        let sector = self.sectors.iter().rev().find(|sector| sector.angle <= angle)?;
        let [corner, next] = sector.side(space)?;
        let turn = angle - sector.angle;
        let along = mul(unit(sub(next, corner)), [turn.cos(), turn.sin()]);
        let [x, y] = add(corner, scale(far / sector.unit, along));
        Some(Parameter { patch: sector.patch, x, y })
    }

    /// w/ρ of a place in the chart of its patch, with first and second derivative there; at the vertex, where w has none, those of w/ρ itself. None
    /// in patches that do not have the vertex.
    fn coordinate(&self, space: &SplineSpace, at: Parameter) -> Option<[Complex; 3]> {
        // A patch may have the vertex at several corners: the nearest one counts.
        let here = self.sectors.iter().filter(|sector| sector.patch == at.patch);
        let sides = here.filter_map(|sector| Some((sector, sector.side(space)?)));
        let far = |side: &[Complex; 2]| distance(side[0], [at.x, at.y]);
        let (sector, [corner, next]) = sides.min_by(|(_, a), (_, b)| far(a).total_cmp(&far(b)))?;
        let (z, side) = (sub([at.x, at.y], corner), sub(next, corner));
        let angle = sector.angle + cross(side, z).atan2(dot(side, z));
        let share = 1.0 / f64::from(self.turns);
        let size = (sector.unit * norm(z) / self.radius).powf(share);
        let w = [size * (share * angle).cos(), size * (share * angle).sin()];
        if norm(z) <= VERTEX {
            return Some([[0.0; 2], [1.0, 0.0], [0.0; 2]]);
        }
        // w = c z^(1/m): w' = w/(m z), w'' = (1/m − 1) w'/z.
        let over_z = |a: Complex| scale(1.0 / norm2(z), mul(a, conj(z)));
        let first = scale(share, over_z(w));
        Some([w, first, scale(share - 1.0, over_z(first))])
    }

    /// Whether a place is in the hole.
    pub fn contains(&self, space: &SplineSpace, at: Parameter) -> bool {
        self.coordinate(space, at).is_some_and(|[w, ..]| norm(w) < 1.0)
    }

    /// G without the spline around it, with derivatives by p and q where p + iq = w/ρ. For |w| ≤ τρ that is the surface.
    pub(super) fn filling(&self, w: Complex) -> SurfacePoint {
        let w = Jet::of_holomorphic([w, [1.0, 0.0], [0.0; 2]]);
        let mut sums = [Jet::constant(0.0); 3];
        for (power, c) in powers(w).zip(&self.coefficients) {
            (0..3).for_each(|x| sums[x] = sums[x].plus(power.times(Jet::constant(c[x]))));
        }
        let at = |k: usize| sums.map(|Jet(all)| all[k]);
        SurfacePoint { point: at(0), first: [at(1), at(2)], second: [at(3), at(4), at(5)] }
    }

    /// The place whose w/ρ is a number, or where that is larger than 1, the one on the rim in its direction.
    pub(super) fn place_of(&self, space: &SplineSpace, w: Complex) -> Option<Parameter> {
        let angle = f64::from(self.turns) * w[1].atan2(w[0]).rem_euclid(TAU);
        self.place(space, self.radius * norm(w).min(1.0).powi(self.turns as i32), angle)
    }

    /// The surface at a place where the spline has this point; none outside the hole. At the vertex itself, where the chart is none of the
    /// surface, the derivatives are those by real and imaginary part of w/ρ: normal and curvatures do not depend on coordinates.
    pub fn surface(&self, space: &SplineSpace, at: Parameter, spline: &SurfacePoint) -> Option<SurfacePoint> {
        let w = self.coordinate(space, at).filter(|w| norm(w[0]) < 1.0)?;
        let w = Jet::of_holomorphic(w);
        let square = w[0].times(w[0]).plus(w[1].times(w[1]));
        let weight = square.through(fade(square.0[0], self.inner()));
        let rest = Jet::constant(1.0).plus(weight.times(Jet::constant(-1.0)));
        let powers: Vec<Jet> = powers(w).collect();
        let mut found = SurfacePoint::default();
        for x in 0..3 {
            let [a, b] = spline.first.map(|d| d[x]);
            let [aa, ab, bb] = spline.second.map(|d| d[x]);
            let outside = Jet([spline.point[x], a, b, aa, ab, bb]);
            let terms = powers.iter().zip(&self.coefficients).map(|(p, c)| p.times(Jet::constant(c[x])));
            let inside = terms.fold(Jet::constant(0.0), Jet::plus);
            let Jet(all) = weight.times(inside).plus(rest.times(outside));
            found.point[x] = all[0];
            (0..2).for_each(|k| found.first[k][x] = all[1 + k]);
            (0..3).for_each(|k| found.second[k][x] = all[3 + k]);
        }
        Some(found)
    }
}

impl Sector {
    /// The vertex and the next corner of the patch, in its chart.
    fn side(&self, space: &SplineSpace) -> Option<[Complex; 2]> {
        let knots = &space.patches().get(self.patch as usize)?.knots;
        Some([knots[self.corner % 3][0], knots[(self.corner + 1) % 3][0]])
    }
}

/// p^i q^j for i + j = 0, 1, …, each with falling i.
fn powers([p, q]: [Jet; 2]) -> impl Iterator<Item = Jet> {
    let power = |x: Jet, n: usize| (0..n).fold(Jet::constant(1.0), |y, _| y.times(x));
    (0..=DEGREE).flat_map(move |n| (0..=n).map(move |j| power(p, n - j).times(power(q, j))))
}

/// φ(√x) with its first and second derivative by x, for this τ.
fn fade(x: f64, inner: f64) -> [f64; 3] {
    let t = x.sqrt();
    if t <= inner {
        return [1.0, 0.0, 0.0];
    }
    let scale = 1.0 / (1.0 - inner);
    let s = (scale * (t - inner)).min(1.0);
    let value = 1.0 - s * s * s * (10.0 + s * (6.0 * s - 15.0));
    // By t: ds/dt = 1/(1 − τ); by x: dt/dx = 1/(2t).
    let first = -scale * 30.0 * s * s * (1.0 - s) * (1.0 - s);
    let second = -scale * scale * 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s);
    [value, first / (2.0 * t), (second - first / t) / (4.0 * t * t)]
}
