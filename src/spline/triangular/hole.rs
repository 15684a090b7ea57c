//! The hole around a singular vertex: where the filling replaces the spline.
//!
//! Over a flat metric with a vertex of total angle 2πm, m whole, the basis functions of a spline do not add up to 1 in the core of the hole, the
//! disk that contains the knots of the vertex. There the surface is a function G of the coordinate w = z^{1/m}, in which the vertex is a
//! regular point. It is blended into the spline F by a weight φ that is 1 for |w| ≤ τρ, 0 for |w| ≥ ρ, and has two continuous derivatives:
//!
//! ```text
//!     F̃ = F + φ(|w|/ρ) (G(w) − F),        φ = 1 for t ≤ τ,  1 − (10 s³ − 15 s⁴ + 6 s⁵), s = (t − τ)/(1 − τ), for τ ≤ t ≤ 1.
//! ```
//!
//! τ is 0.8, or if the core is wider in w, its rim. G is a bicubic B-spline, [`Fill`]. So F̃ has as many continuous derivatives as F, up to
//! two, on all of the hole.
//!
//! The total angle can be any positive number. Where m is not whole, all knots of the vertex lie at it, and the spline is less smooth along the
//! edges there. Then the triangles at the vertex are small, and lie where the filling alone is the surface.
//!
//! A sphere is a plane with a vertex at infinity, where the same holds for w = 1/z, with m = −1; the hole is the outside of a disk of
//! radius ρ. Patches cover the plane until the filling alone is the surface. The rest, and the vertex itself, have places only in the chart
//! of the hole, whose coordinates are those of w over its value at the rim.

use super::fill::Fill;
use super::jet::Jet;
use super::patch::Parameter;
use super::point::SurfacePoint;
use super::space::SplineSpace;
use crate::error::{Error, Result};
use crate::geometry::complex::{Complex, add, conj, distance, doubled_area, mul, norm, norm2, scale, sub};
use crate::geometry::vector::Vector;
use std::f64::consts::{PI, TAU};

/// Radius of the core over that of the smallest hole, which lies inside the triangles at the vertex: large enough that the spline does not
/// bend sharply along the sides at the vertex, small enough that the core is a small part of the triangles there.
const CORE: f64 = 0.05;
/// Radius of the disk in which the spline has no weight, over that of the core.
const CLEAR: f64 = 1.1;
/// Least τ.
const LEAST_INNER: f64 = 0.8;
/// Number of circles around the vertex, and of places on each per turn, at which filling and spline are fitted to each other: they are
/// where the weight goes from 1 to 0.
const RINGS: [usize; 2] = [6, 48];
/// Distance from the vertex, in the unit of the metric, below which a place is the vertex: derivatives by the chart's coordinates would
/// overflow.
const VERTEX: f64 = 1e-50;
/// Most turns of a hole; surfaces of any genus that can be triangulated here have fewer.
const MOST_TURNS: f64 = 65536.0;
/// Fewest turns of a hole: of a narrower cone, places in the middle of its hole are no numbers.
const LEAST_TURNS: f64 = 1.0 / 64.0;
/// Number of turns of a vertex at infinity: its total angle is 2π − 4π.
pub(crate) const INFINITE: f64 = -1.0;
/// Longest step of a place, in w/ρ.
const LONGEST_STEP: f64 = 0.1;
/// Distance from the vertex, as a share of that between two places, below which a place is the vertex: rounding.
const AT_VERTEX: f64 = 1e-6;
/// Share of a triangle's area by which a place may lie outside it: rounding.
const OUTSIDE: f64 = 1e-9;

/// A patch that lies around a singular vertex, with its position there.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "json", derive(serde::Serialize, serde::Deserialize))]
pub struct Sector {
    /// The patch.
    pub patch: u32,
    /// The direction of its middle: an angle around the vertex from a fixed direction, counterclockwise.
    pub angle: f64,
    /// The map from its chart to the plane in which the vertex is 0, the patch's middle lies on the positive x axis, and the unit is that
    /// of the flat metric: a similarity with the rows `[a, −b, x]`, `[b, a, y]`.
    pub to: [[f64; 3]; 2],
}

/// The hole around a singular vertex, with its filling.
#[derive(Debug, Clone, PartialEq)]
pub struct Hole {
    /// The number of its own chart, used as the patch of a [`Parameter`]: the count of patches for the first hole, and so on. Coordinates
    /// x + iy of places there are w over its size at the rim, |x + iy| ≤ τ.
    pub chart: u32,
    /// The patches that the hole meets, in the order of their numbers; one that meets it in several ways is there as often.
    pub sectors: Vec<Sector>,
    /// The total angle m in turns, any positive number; −1 for a vertex at infinity of a plane.
    pub turns: f64,
    /// Radius of the hole in the unit of the flat metric; around infinity, the radius of the disk outside of which the hole lies.
    pub radius: f64,
    /// The ratio τ: the share of |w| up to which the filling alone is the surface.
    pub inner: f64,
    /// The filling G as a function of p + iq = w/ρ; none before the hole is filled.
    pub fill: Option<Fill>,
}

impl Hole {
    /// A hole without a filling.
    ///
    /// # Errors
    /// [`Error::Argument`] for no sectors, another number of turns, or a radius that is not positive.
    pub fn new(chart: u32, mut sectors: Vec<Sector>, turns: f64, radius: f64) -> Result<Hole> {
        if sectors.is_empty() || !(turns == INFINITE || (LEAST_TURNS..=MOST_TURNS).contains(&turns)) {
            let need = "1/64 to 65536, or -1 at infinity, with patches around the vertex";
            return Err(Error::argument("turns of a hole", turns, need));
        }
        if !(radius > 0.0 && radius.is_finite()) {
            return Err(Error::argument("radius of a hole", radius, "positive"));
        }
        sectors.sort_by_key(|sector| sector.patch);
        let core = if turns == INFINITE { 0.0 } else { (CLEAR * CORE).powf(1.0 / turns) };
        Ok(Hole { chart, sectors, turns, radius, inner: core.max(LEAST_INNER), fill: None })
    }

    /// The same hole with a filling of zeros, of at most this number of coefficients, which a fit replaces.
    pub fn blank(self, coefficients: usize) -> Hole {
        Hole { fill: Some(Fill::blank(coefficients)), ..self }
    }

    /// Radius of the core if this is the smallest hole, in the unit of the metric; the knots of the vertex lie in the core.
    pub fn core(&self) -> f64 {
        CORE * self.radius
    }

    /// True if its vertex is the one at infinity of a plane.
    pub fn is_at_infinity(&self) -> bool {
        self.turns == INFINITE
    }

    /// True if a place is in the hole.
    pub fn contains(&self, at: Parameter) -> bool {
        self.coordinate(at).is_some_and(|[w, ..]| norm(w) < 1.0)
    }

    /// True if the spline has no weight at a place, where its basis functions need not add up to 1.
    pub(crate) fn is_core(&self, at: Parameter) -> bool {
        self.coordinate(at).is_some_and(|[w, ..]| norm(w) <= self.inner)
    }

    /// The same hole with a filling, around a vertex of the domain of `space`.
    ///
    /// # Errors
    /// [`Error::Spline`] for a sector that is no patch.
    pub fn filled_by(self, space: &SplineSpace, fill: Fill) -> Result<Hole> {
        let patches = space.patches().len();
        if (self.chart as usize) < patches {
            return Err(Error::argument("chart of a hole", self.chart, "the count of patches, or more"));
        }
        if !(self.inner > 0.0 && self.inner < 1.0) {
            return Err(Error::argument("inner part of a hole", self.inner, "above 0 and below 1"));
        }
        let is_sound = |s: &Sector| {
            let [[a, b, x], [c, d, y]] = s.to;
            let is_finite = [s.angle, a, b, x, y].iter().all(|x| x.is_finite());
            (s.patch as usize) < patches && is_finite && a * a + b * b > 0.0 && a == d && b == -c
        };
        if let Some(at) = self.sectors.iter().position(|sector| !is_sound(sector)) {
            let message = "it is no patch with an angle and a map that turns and scales".into();
            return Err(Error::Spline { what: "sector of a hole", index: at, message });
        }
        Ok(Hole { fill: Some(fill), ..self })
    }

    /// The weights of spline and filling in the surface at a place, and its w/ρ; none outside the hole.
    pub(super) fn parts(&self, at: Parameter) -> Option<([f64; 2], Complex)> {
        let [w, ..] = self.coordinate(at).filter(|w| norm(w[0]) < 1.0)?;
        let [part, ..] = fade(norm2(w), self.inner);
        Some(([1.0 - part, part], w))
    }

    /// Places on circles around the vertex, where the weight goes from 1 to 0.
    pub(super) fn rings(&self, space: &SplineSpace) -> Vec<Parameter> {
        let [circles, each] = RINGS;
        let each = (each as f64 * self.turns.abs().max(1.0)).round() as usize;
        let inner = self.inner;
        let ring = |k: usize| inner + (1.0 - inner) * (k as f64 + 0.5) / circles as f64;
        let angle = |j: usize| TAU * self.turns * (j as f64 + 0.5) / each as f64;
        let place = |k: usize, j: usize| self.place(space, self.radius * ring(k).powf(self.turns), angle(j));
        (0..circles).flat_map(|k| (0..each).filter_map(move |j| place(k, j))).collect()
    }

    /// The place at a distance from the vertex, in the unit of the metric, and in a direction, an angle as those of the sectors. None
    /// beyond the patches.
    pub fn place(&self, space: &SplineSpace, far: f64, angle: f64) -> Option<Parameter> {
        let whole = TAU * self.turns.abs();
        let inside = |sector: &Sector| {
            let turn = angle - sector.angle;
            let turn = turn - whole * (turn / whole).round();
            let at = sector.chart(scale(far, [turn.cos(), turn.sin()]));
            let [a, b, c] = [0, 1, 2].map(|k| space.patches()[sector.patch as usize].knots[k][0]);
            let sides = [doubled_area([at, a, b]), doubled_area([at, b, c]), doubled_area([at, c, a])];
            let least = sides.into_iter().fold(f64::INFINITY, f64::min) / doubled_area([a, b, c]);
            let found = Parameter { patch: sector.patch, x: at[0], y: at[1] };
            (turn.abs() < PI && least > -OUTSIDE).then_some((least, found))
        };
        let all = self.sectors.iter().filter(|s| (s.patch as usize) < space.patches().len());
        all.filter_map(inside).max_by(|(a, _), (b, _)| a.total_cmp(b)).map(|(_, found)| found)
    }

    /// The w/ρ of the place `at` in a patch, if the place `vertex` of the patch is the vertex of the hole. None for an empty hole and for
    /// patches that it does not meet.
    pub(crate) fn spoke(&self, vertex: Parameter, at: Parameter) -> Option<Complex> {
        self.fill.as_ref()?;
        let here = self.sectors.iter().filter(|sector| sector.patch == at.patch);
        let [vertex, at] = [vertex, at].map(|p| [p.x, p.y]);
        let sector = here.into_iter().find(|sector| sector.starts_at(vertex, at))?;
        Some(self.of_sector(sector, sector.local(at)))
    }

    /// The patches at the vertex of the hole, each with the number of its corner there.
    pub(crate) fn corners(&self, space: &SplineSpace) -> Vec<(usize, usize)> {
        let mut found = Vec::new();
        for sector in &self.sectors {
            let knots = &space.patches()[sector.patch as usize].knots;
            let is_here = |k: &usize| sector.starts_at(knots[*k][0], knots[(k + 1) % 3][0]);
            found.extend((0..3).find(is_here).map(|k| (sector.patch as usize, k)));
        }
        found
    }

    /// The place in the chart of the hole at a share of |w| of the way from its vertex, the first of two places of a patch, to the second.
    /// None if the filling alone is not the surface there, or the first place is not the vertex.
    pub(crate) fn near_vertex(&self, [vertex, end]: [Parameter; 2], share: f64) -> Option<Parameter> {
        let w = scale(share, self.spoke(vertex, end)?);
        (norm(w) <= self.inner).then_some(Parameter { patch: self.chart, x: w[0], y: w[1] })
    }

    /// The w/ρ of a place given by a sector and the coordinate z there.
    fn of_sector(&self, sector: &Sector, z: Complex) -> Complex {
        let share = 1.0 / self.turns;
        let angle = share * (sector.angle + z[1].atan2(z[0]));
        scale((norm(z) / self.radius).powf(share), [angle.cos(), angle.sin()])
    }

    /// The w/ρ of a place, with first and second derivative by the chart of its patch; at the vertex, where w has none, the derivatives of
    /// w/ρ by itself. None for patches that the hole does not meet, and for charts of other holes.
    fn coordinate(&self, at: Parameter) -> Option<[Complex; 3]> {
        if at.patch == self.chart {
            return Some([[at.x, at.y], [1.0, 0.0], [0.0; 2]]);
        }
        let first = self.sectors.partition_point(|sector| sector.patch < at.patch);
        // A patch can lie around the vertex in several ways; the one nearest to the vertex counts.
        let here = self.sectors[first..].iter().take_while(|sector| sector.patch == at.patch);
        let places = here.map(|sector| (sector, sector.local([at.x, at.y])));
        let (sector, z) = places.min_by(|(_, a), (_, b)| norm2(*a).total_cmp(&norm2(*b)))?;
        let share = 1.0 / self.turns;
        let w = self.of_sector(sector, z);
        if norm(z) <= VERTEX && !self.is_at_infinity() {
            return Some([[0.0; 2], [1.0, 0.0], [0.0; 2]]);
        }
        // w = c z^(1/m) and dz = turn dp for places p in the chart, so w' = turn w/(m z) and w'' = (1/m − 1) w' turn/z.
        let over_z = scale(1.0 / norm2(z), mul(sector.turn(), conj(z)));
        let first = scale(share, mul(w, over_z));
        Some([w, first, scale(share - 1.0, mul(first, over_z))])
    }

    /// The surface at a place at which the spline has a given point; none outside the hole. At the vertex, where the chart of a patch is no
    /// coordinate of the surface, derivatives are by real and imaginary part of w/ρ; normal and curvatures do not depend on that.
    pub fn surface(&self, at: Parameter, spline: &SurfacePoint) -> Option<SurfacePoint> {
        let w = self.coordinate(at).filter(|w| norm(w[0]) < 1.0)?;
        let w = Jet::of_holomorphic(w);
        let square = w[0].times(w[0]).plus(w[1].times(w[1]));
        let weight = square.through(fade(square.0[0], self.inner));
        let rest = Jet::constant(1.0).plus(weight.times(Jet::constant(-1.0)));
        let inside = self.fill.as_ref()?.at(w);
        let blended = |x: usize| {
            let [a, b] = spline.first.map(|d| d[x]);
            let [aa, ab, bb] = spline.second.map(|d| d[x]);
            let outside = Jet([spline.point[x], a, b, aa, ab, bb]);
            weight.times(inside[x]).plus(rest.times(outside))
        };
        Some(surface_point([blended(0), blended(1), blended(2)]))
    }

    /// The surface at a place in the hole's own chart, where the filling alone is the surface.
    ///
    /// # Errors
    /// [`Error::Spline`] for a place beyond the middle of the hole, or a hole without filling.
    pub(super) fn in_chart(&self, at: Parameter) -> Result<SurfacePoint> {
        let refuse = |message: String| Error::Spline { what: "patch", index: at.patch as usize, message };
        let (size, most) = (norm([at.x, at.y]), self.inner);
        if size.is_nan() || size > most * (1.0 + OUTSIDE) {
            return Err(refuse(format!(
                "({}, {}) is outside it: it is the chart of a hole, whose places are at most {most} from its vertex",
                at.x, at.y
            )));
        }
        self.filling([at.x, at.y])
            .ok_or_else(|| refuse("it is the chart of a hole that nothing fills".into()))
    }

    /// The filling G with its derivatives by p and q, p + iq = w/ρ; for |w| ≤ τρ it is the surface. None before the hole is filled.
    pub(super) fn filling(&self, w: Complex) -> Option<SurfacePoint> {
        let w = Jet::of_holomorphic([w, [1.0, 0.0], [0.0; 2]]);
        Some(surface_point(self.fill.as_ref()?.at(w)))
    }

    /// The place in the hole at which G is nearer to a point, by one Gauss–Newton step from another place; none outside the disk in which
    /// the surface is G.
    pub(crate) fn nearer(&self, space: &SplineSpace, from: Parameter, point: Vector) -> Option<Parameter> {
        let w = self.coordinate(from)?[0];
        if norm(w) > self.inner {
            return None;
        }
        let step = self.filling(w)?.step_towards(point)?;
        let shorter = f64::min(1.0, LONGEST_STEP / norm(step).max(f64::MIN_POSITIVE));
        self.place_of(space, add(w, scale(shorter, step)))
    }

    /// The place with a given w/ρ, or for |w/ρ| > 1 the place on the rim in its direction; at infinity, in the hole's own chart if that has
    /// such a place. None beyond the patches.
    pub(super) fn place_of(&self, space: &SplineSpace, w: Complex) -> Option<Parameter> {
        if self.is_at_infinity() && norm(w) <= self.inner {
            return Some(Parameter { patch: self.chart, x: w[0], y: w[1] });
        }
        let angle = self.turns * w[1].atan2(w[0]);
        self.place(space, self.radius * norm(w).min(1.0).powf(self.turns), angle)
    }
}

/// The surface point whose three coordinates have these jets.
fn surface_point(coordinates: [Jet; 3]) -> SurfacePoint {
    let at = |k: usize| coordinates.map(|Jet(all)| all[k]);
    SurfacePoint { point: at(0), first: [at(1), at(2)], second: [at(3), at(4), at(5)] }
}

impl Sector {
    /// The position of a point of the chart relative to the vertex, in directions that all sectors have in common.
    pub(super) fn in_common(&self, at: Complex) -> Complex {
        mul([self.angle.cos(), self.angle.sin()], self.local(at))
    }

    /// The linear factor of its map.
    fn turn(&self) -> Complex {
        [self.to[0][0], self.to[1][0]]
    }

    /// The position of a point of the chart relative to the vertex.
    pub fn local(&self, at: Complex) -> Complex {
        let [[.., x], [.., y]] = self.to;
        add(mul(self.turn(), at), [x, y])
    }

    /// True if the first of two points of the chart is the vertex.
    pub fn starts_at(&self, vertex: Complex, other: Complex) -> bool {
        let [vertex, other] = [vertex, other].map(|p| self.local(p));
        norm(vertex) < AT_VERTEX * distance(vertex, other)
    }

    /// The point of the chart at a position relative to the vertex.
    pub fn chart(&self, z: Complex) -> Complex {
        let ([[.., x], [.., y]], turn) = (self.to, self.turn());
        scale(1.0 / norm2(turn), mul(conj(turn), sub(z, [x, y])))
    }
}

/// The weight φ(√x) with its first and second derivative by x.
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
