//! Measurement of how well a spline keeps the identities of triangular B-splines.

use super::hole::Hole;
use super::patch::{Parameter, Patch, Support};
use super::point::SurfacePoint;
use super::space::SplineSpace;
use super::surface::Spline;
use crate::control::Control;
use crate::error::Result;
use crate::geometry::complex::{distance, doubled_area};
use std::sync::Arc;

/// The places in a patch at which identities are measured, in barycentric coordinates: near corners, near sides and inside.
const PLACES: [[f64; 3]; 7] = [
    [0.96, 0.03, 0.01],
    [0.01, 0.96, 0.03],
    [0.03, 0.01, 0.96],
    [0.52, 0.46, 0.02],
    [0.02, 0.52, 0.46],
    [0.46, 0.02, 0.52],
    [0.34, 0.35, 0.31],
];
/// Height of a knot over the line of a side, over the patch's height, below which the knot counts as on the line: rounding.
const ON_LINE: f64 = 1e-9;

/// Distance, as a share of a side, below which two places are the same: rounding of the maps between charts.
const SAME_PLACE: f64 = 1e-9;
/// Least derivative of order k to which jumps are compared, as a share of the surface's extent over h^k, where h is the height of the
/// thinnest patch: even in a plane, rounding leaves jumps of up to 2e-12 of that.
const FLAT: f64 = 1e-3;

/// Largest deviations from identities that hold in exact arithmetic.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Identities {
    /// Partition of unity: |Σ B − 1|.
    pub partition_of_unity: f64,
    /// Error of the reproduced polynomial (x + y)^n, in coordinates from −1 to 1, relative to its largest value; none if patches lie in
    /// several charts, which have no polynomials in common.
    pub polynomial_reproduction: Option<f64>,
    /// Jump of the derivatives of order min(n − 1, 2) across sides of patches, for the spline without fillings, over the largest such
    /// derivative. Only sides with at most two knots of their ends on their line count.
    pub continuity: f64,
    /// Number of sides between patches with more knots on their line, across which the spline is less smooth; those in cores of holes are not
    /// counted.
    pub rough_sides: usize,
}

/// Seven places of each patch outside the cores of holes.
pub(crate) fn open_places(space: &SplineSpace, holes: &[Hole]) -> Vec<Parameter> {
    (0..space.patches().len())
        .flat_map(|patch| PLACES.map(|weights| place(space, patch, weights)))
        .filter(|&at| !holes.iter().any(|hole| hole.is_core(at)))
        .collect()
}

/// The largest deviation |Σ B − 1| of the sum of all basis functions at these places, and the patch where it is.
///
/// # Errors
/// Those of [`Spline::evaluate`].
pub(crate) fn partition_of_unity(
    space: &Arc<SplineSpace>,
    places: &[Parameter],
    threads: usize,
    control: &Control,
) -> Result<(usize, f64)> {
    let ones = Spline::new(space.clone(), vec![[1.0, 0.0, 0.0]; space.n_control_points()])?;
    let sums = ones.evaluate(places, 0, threads, control)?;
    let errors = places.iter().zip(&sums).map(|(at, sum)| (at.patch as usize, (sum.point[0] - 1.0).abs()));
    Ok(errors.fold((0, 0.0), |worst, next| if next.1 > worst.1 { next } else { worst }))
}

impl Spline {
    /// Measures the identities at seven places of each patch outside the cores of holes, and at the middle of each side between two
    /// patches.
    ///
    /// # Errors
    /// Those of [`Spline::evaluate`].
    pub fn identities(&self, threads: usize, control: &Control) -> Result<Identities> {
        let space = self.space();
        let places = open_places(space, self.holes());
        let partition_of_unity = partition_of_unity(space, &places, threads, control)?.1;
        let one_chart = space.check_one_chart().is_ok();
        let polynomial_reproduction =
            one_chart.then(|| reproduction(space, &places, threads, control)).transpose()?;
        let InnerSides { smooth, rough } = InnerSides::of(space);
        let is_open = |side: &InnerSide| !self.holes().iter().any(|hole| hole.is_core(side.places[0]));
        let smooth: Vec<InnerSide> = smooth.into_iter().filter(is_open).collect();
        let continuity = self.jump(&smooth, threads, control)?;
        let rough_sides = rough.iter().filter(|side| is_open(side)).count();
        Ok(Identities { partition_of_unity, polynomial_reproduction, continuity, rough_sides })
    }

    /// The largest jump between the two patches at each side, whose derivatives are limits from their insides.
    fn jump(&self, smooth: &[InnerSide], threads: usize, control: &Control) -> Result<f64> {
        let order = (self.space().degree() - 1).min(2);
        let bare = Spline::new(self.space().clone(), self.control_points().to_vec())?;
        let places: Vec<Parameter> = smooth.iter().flat_map(|side| side.places).collect();
        let found = bare.evaluate(&places, order, threads, control)?;
        let (mut jump, mut largest) = (0.0f64, 0.0f64);
        for (side, pair) in smooth.iter().zip(found.chunks_exact(2)) {
            let [a, b] = [side.pulled_back(&pair[0]), pair[1]].map(|at| match order {
                0 => at.point.to_vec(),
                1 => at.first.concat(),
                _ => at.second.concat(),
            });
            jump = a.iter().zip(&b).map(|(x, y)| (x - y).abs()).fold(jump, f64::max);
            largest = b.iter().map(|x| x.abs()).fold(largest, f64::max);
        }
        let flat = FLAT * self.extent() / self.space().least_height().powi(order as i32);
        let largest = largest.max(flat);
        Ok(if largest > 0.0 { jump / largest } else { 0.0 })
    }

    /// The largest extent of the control points along an axis.
    fn extent(&self) -> f64 {
        let range = |x: usize| {
            let all = || self.control_points().iter().map(|p| p[x]);
            all().fold(f64::NEG_INFINITY, f64::max) - all().fold(f64::INFINITY, f64::min)
        };
        (0..3).map(range).fold(0.0, f64::max)
    }
}

impl SplineSpace {
    /// The least ratio of the doubled area of a patch to its longest side.
    fn least_height(&self) -> f64 {
        let height = |patch: &Patch| {
            let [a, b, c] = [0, 1, 2].map(|k| patch.knots[k][0]);
            let longest = distance(a, b).max(distance(b, c)).max(distance(c, a));
            doubled_area([a, b, c]) / longest
        };
        self.patches().iter().map(height).fold(f64::INFINITY, f64::min)
    }
}

fn place(space: &SplineSpace, patch: usize, weights: [f64; 3]) -> Parameter {
    let corners = [0, 1, 2].map(|k| space.patches()[patch].knots[k][0]);
    let [x, y] = [0, 1].map(|x| (0..3).map(|k| weights[k] * corners[k][x]).sum());
    Parameter { patch: patch as u32, x, y }
}

/// The largest error of (x + y)^n at given places, relative to its largest value there.
fn reproduction(
    space: &Arc<SplineSpace>,
    places: &[Parameter],
    threads: usize,
    control: &Control,
) -> Result<f64> {
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for p in places {
        (low, high) = ([low[0].min(p.x), low[1].min(p.y)], [high[0].max(p.x), high[1].max(p.y)]);
    }
    let half = 0.5 * (high[0] - low[0]).max(high[1] - low[1]);
    let middle = [0, 1].map(|x| 0.5 * (low[x] + high[x]));
    let linear = |[x, y]: [f64; 2]| ((x - middle[0]) + (y - middle[1])) / half;
    // The polar form of a power of a linear function is the product of the function's values.
    let mut points = vec![[0.0; 3]; space.n_control_points()];
    space.for_each_argument(|control, arguments| {
        points[control][0] = arguments.iter().map(|&p| linear(p)).product();
    });
    let power = Spline::new(space.clone(), points)?;
    let found = power.evaluate(places, 0, threads, control)?;
    let exact = |p: &Parameter| linear([p.x, p.y]).powi(space.degree() as i32);
    let largest = places.iter().map(|p| exact(p).abs()).fold(f64::MIN_POSITIVE, f64::max);
    let worst = found.iter().zip(places).map(|(at, p)| (at.point[0] - exact(p)).abs()).fold(0.0, f64::max);
    Ok(worst / largest)
}

/// A side between two patches.
struct InnerSide {
    /// The middle of the side, as a place of each patch.
    places: [Parameter; 2],
    /// The linear part of the map from the second patch's chart to that of the first.
    linear: [[f64; 2]; 2],
}

impl InnerSide {
    /// Derivatives by the coordinates of the second patch's chart, from those by the first one's.
    fn pulled_back(&self, at: &SurfacePoint) -> SurfacePoint {
        let [[a, b], [c, d]] = self.linear;
        let [x, y] = at.first;
        let [xx, xy, yy] = at.second;
        let sum = |terms: &[(f64, [f64; 3])]| {
            std::array::from_fn(|k| terms.iter().map(|(factor, v)| factor * v[k]).sum())
        };
        SurfacePoint {
            point: at.point,
            first: [sum(&[(a, x), (c, y)]), sum(&[(b, x), (d, y)])],
            second: [
                sum(&[(a * a, xx), (2.0 * a * c, xy), (c * c, yy)]),
                sum(&[(a * b, xx), (a * d + b * c, xy), (c * d, yy)]),
                sum(&[(b * b, xx), (2.0 * b * d, xy), (d * d, yy)]),
            ],
        }
    }
}

/// All sides between two patches.
struct InnerSides {
    /// The sides across which the spline is as smooth as its degree allows.
    smooth: Vec<InnerSide>,
    /// The other sides.
    rough: Vec<InnerSide>,
}

impl InnerSides {
    fn of(space: &SplineSpace) -> InnerSides {
        let mut sides = InnerSides { smooth: Vec::new(), rough: Vec::new() };
        for (at, patch) in space.patches().iter().enumerate() {
            let corners = [0, 1, 2].map(|k| patch.knots[k][0]);
            for support in &space.supports()[at] {
                let Support { patch: beyond, to: [[a, b, x], [c, d, y]] } = *support;
                let over = |[u, v]: [f64; 2]| [a * u + b * v + x, c * u + d * v + y];
                let there = [0, 1, 2].map(|k| over(space.patches()[beyond as usize].knots[k][0]));
                for (k, j) in (0..9).map(|i| (i / 3, i % 3)) {
                    let ends = [corners[k], corners[(k + 1) % 3]];
                    let near = SAME_PLACE * distance(ends[0], ends[1]);
                    let is_same = |p: [f64; 2], q: [f64; 2]| distance(p, q) < near;
                    // Each side is taken once: from the patch with the lower number, or from the lower side of one patch.
                    let is_first = (at, k) < (beyond as usize, j);
                    if is_first && is_same(there[j], ends[1]) && is_same(there[(j + 1) % 3], ends[0]) {
                        let middles = [place(space, at, middle(k)), place(space, beyond as usize, middle(j))];
                        sides.add(space, k, InnerSide { places: middles, linear: [[a, b], [c, d]] });
                    }
                }
            }
        }
        sides
    }

    /// Counts side k of the first patch as smooth or rough.
    fn add(&mut self, space: &SplineSpace, k: usize, side: InnerSide) {
        let knots = &space.patches()[side.places[0].patch as usize].knots;
        let [a, b, c] = [k, (k + 1) % 3, (k + 2) % 3].map(|k| knots[k][0]);
        let on_line = |&&p: &&[f64; 2]| doubled_area([p, a, b]).abs() < ON_LINE * doubled_area([a, b, c]);
        if knots[k].iter().chain(&knots[(k + 1) % 3]).filter(on_line).count() > 2 {
            self.rough.push(side);
        } else {
            self.smooth.push(side);
        }
    }
}

/// The middle of side k in barycentric coordinates.
fn middle(k: usize) -> [f64; 3] {
    let mut weights = [0.5; 3];
    weights[(k + 2) % 3] = 0.0;
    weights
}
