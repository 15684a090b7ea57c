//! Dirichlet domains: the points that are nearer to a base point than to its images under a group.
//!
//! ```
//! use ricci::embed::dirichlet_domain;
//! use ricci::canonical::{QuotientOptions, uniformize_quotient};
//! use ricci::{Control, Surface, mesh::shapes};
//! # fn main() -> ricci::Result<()> {
//! let torus = Surface::from_soup(&shapes::torus(2.0, 1.0, 8, 8)?)?;
//! let flat = uniformize_quotient(&torus, &QuotientOptions::default(), &Control::new())?;
//! let domain = dirichlet_domain(&flat.deck, [0.0, 0.0, 1.0], flat.layout.area, &Control::new())?;
//! // By the symmetry of this torus the domain is a rectangle.
//! assert_eq!(domain.sides.len(), 4);
//! # Ok(())
//! # }
//! ```

use super::deck::{DeckElement, DeckGroup};
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::motion::precise_point;
use crate::geometry::{Motion, Space, Twofold, triangle};
use crate::topology::word::Letter;
use std::f64::consts::PI;

/// Lengths by which a bisector must move the border of the polygon to count; the first for which all sides can be paired is taken. Elements
/// have errors of 1e-30, or 1e-14 in some schemes, times e^distance, and so have corners where more than three bisectors meet.
const TOLERANCES: [f64; 4] = [1e-12, 1e-10, 1e-8, 1e-6];
/// Rounds of products of side elements, at most. Each round at least doubles the word length that is reached; two or three rounds are usual.
const ROUNDS: usize = 12;
/// Products that one search forms at most, which takes some seconds: wrong elements would make ever new products.
const MOST_PRODUCTS: usize = 5_000_000;
/// Displacement of the centre, in H² a length and in E² in units of the longest factor, below which an element is the identity. It is far above the
/// errors of elements and far below the shortest loop of a surface that can be resolved.
const SAME: f64 = 1e-6;
/// Relative difference of the polygon's area and the surface's up to which the polygon is the domain. A missing or wrong side changes the area by
/// more.
const AREA: f64 = 1e-6;

/// The Dirichlet domain of a base point: a convex polygon with geodesic sides, each on the bisector of the base point and its image
/// under the side's element, which carries the domain onto its neighbour across that side.
#[derive(Debug, Clone)]
pub struct DirichletDomain {
    /// The base point, in ambient coordinates.
    pub centre: [f64; 3],
    /// Corners counterclockwise, in ambient coordinates; side k runs from corner k to the next one.
    pub corners: Vec<[f64; 3]>,
    /// The element of each side.
    pub sides: Vec<DeckElement>,
    /// Per side, the one with the inverse element.
    pub partner: Vec<usize>,
    /// Area of the polygon, from the lengths of its sides and of the rays to its corners.
    pub area: f64,
    /// Largest distance of a corner from the base point.
    pub radius: f64,
}

/// Largest [`DeckGroup::side_residual`] with which a polygon is looked for: pairings farther from their words have lost half of their digits, and
/// bound no polygon.
const PAIRED: f64 = 1e-8;

fn none(why: &str) -> Error {
    let advice = "the surface reaches farther in its metric than its isometries have digits; take another base vertex or a finer mesh";
    Error::Layout(format!("no Dirichlet domain: {why} ({advice})"))
}

/// The Dirichlet domain of the base point `centre` (ambient coordinates) of a closed surface with this area, in E² or H².
///
/// Bisectors of the side pairings of the layout cut a first polygon; then those of products of the elements of its sides are tried, until
/// none cuts anything off, every side has its partner, and the area is the surface's.
///
/// # Errors
/// [`Error::Layout`] for a group without elements or in S², and where no such polygon is found; [`Error::Cancelled`].
pub fn dirichlet_domain(
    deck: &DeckGroup,
    centre: [f64; 3],
    area: f64,
    control: &Control,
) -> Result<DirichletDomain> {
    if deck.sides.is_empty() || deck.space == Space::S2 {
        return Err(Error::Layout("a simply connected surface has no Dirichlet domain".into()));
    }
    if deck.side_residual > PAIRED {
        let off = deck.side_residual;
        return Err(none(&format!(
            "the isometries of the sides are {off:.1e} away from those of their words"
        )));
    }
    // The base point is carried to the origin, and everything with it.
    let home = Motion::to_origin(deck.space, precise_point(deck.space, centre));
    let sides = deck.sides.iter().map(|g| g.conjugated_by(&home));
    // The images of the centre under the side pairings lie within the sum of their distances: no point that is nearest to the centre is
    // farther out.
    let reach = sides.clone().map(|g| g.motion.displacement()).sum();
    // The generators are factors too: on a surface of few vertices they are shorter than the sides.
    let generator = |k| Ok(deck.element(Letter::generator(k))?.conjugated_by(&home));
    let generators = (0..deck.generators.len()).map(generator);
    let factors = sides.map(Ok).chain(generators).collect::<Result<Vec<_>>>()?;
    // Lengths of the plane are in units of the longest factor, those of H² as they are.
    let longest = || factors.iter().map(|g| g.motion.displacement()).fold(0.0, f64::max);
    // The radius of a disk of this area: a polygon of that area reaches farther.
    let (unit, least) = match deck.space {
        Space::H2 => (1.0, 2.0 * (area / (4.0 * PI)).sqrt().asinh()),
        _ => (longest(), (area / PI).sqrt()),
    };
    let (mut nearest, mut limits) = (None, Limits { least, left: MOST_PRODUCTS });
    for tolerance in TOLERANCES {
        let mut polygon = Polygon::around(deck.space, reach, [tolerance * unit, SAME * unit]);
        polygon.close(deck, &factors, &mut limits, control)?;
        if !polygon.is_bounded() {
            break;
        }
        if polygon.radius < least {
            continue;
        }
        match polygon.finish(centre, &home.inverse()) {
            Some(domain) if (domain.area - area).abs() <= AREA * area => return Ok(domain),
            found => nearest = found.or(nearest),
        }
    }
    let message = match nearest {
        Some(domain) => format!("the polygon found has area {:.6e}, the surface {area:.6e}", domain.area),
        None => "no polygon with paired sides and room for the surface was found".into(),
    };
    Err(none(&message))
}

fn product(deck: &DeckGroup, g: &DeckElement, h: &DeckElement, motion: Motion<Twofold>) -> DeckElement {
    DeckElement { word: deck.group.reduce(&g.word.times(&h.word)), motion }
}

/// Largest number of products that are added to factors whose bisectors do not bound the polygon. Finding them takes the square of this number
/// of compositions, below a second.
const MOST_FACTORS: usize = 600;

/// Of some elements and their products by twos, other than the identity, those that move the origin least: twice as many as were given.
fn shortest_products(
    deck: &DeckGroup,
    all: &[DeckElement],
    same: f64,
    control: &Control,
) -> Result<Vec<DeckElement>> {
    let identity = DeckElement::identity(deck.space);
    let mut pairs = Vec::with_capacity(all.len() * (all.len() + 1));
    for (i, g) in all.iter().enumerate() {
        control.check()?;
        for (j, h) in std::iter::once(&identity).chain(all).enumerate() {
            let motion = g.motion.compose(&h.motion);
            pairs.push((motion.displacement(), i, j, motion));
        }
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let most = (2 * all.len()).min(MOST_FACTORS).max(all.len());
    let mut found: Vec<DeckElement> = Vec::new();
    for (moved, i, j, motion) in pairs.into_iter().filter(|pair| pair.0 > same) {
        let back = motion.inverse();
        let is_known = |g: &&DeckElement| back.compose(&g.motion).displacement() <= same;
        let near = found.iter().rev().take_while(|g| g.motion.displacement() > moved - same);
        if near.into_iter().any(|g| is_known(&g)) {
            continue;
        }
        let h = if j == 0 { &identity } else { &all[j - 1] };
        found.push(product(deck, &all[i], h, motion));
        if found.len() == most {
            break;
        }
    }
    Ok(found)
}

/// Where the search for a polygon gives up.
struct Limits {
    /// Radius below which no polygon has room for the surface.
    least: f64,
    /// Products of elements that may still be formed, for all polygons together.
    left: usize,
}

/// A convex polygon about the origin in the plane or in the Klein disk. Corners are vectors `[x, y, w]` of height 1, with twice the digits:
/// at distance d the Klein disk's border is e^{−2d} away. Each side has the element whose bisector it lies on; none on the square
/// that the polygon starts from.
struct Polygon {
    space: Space,
    corners: Vec<[Twofold; 3]>,
    sides: Vec<Option<DeckElement>>,
    /// Largest distance of a corner from the origin.
    radius: f64,
    /// One of [`TOLERANCES`], and [`SAME`], as lengths.
    tolerance: f64,
    same: f64,
}

/// The bisector of the origin and its image `[x, y, w]`, as the linear form `x X + y Y − h W` that is positive beyond it.
struct Bisector {
    form: [Twofold; 3],
    /// The form's norm: form over norm is distance (H²: its hyperbolic sine).
    norm: f64,
}

/// Value of a form, as a distance, below which it is evaluated again with twice the digits; doubles give the sign of larger ones.
const CLOSE: f64 = 1e-4;

impl Bisector {
    fn new(g: &Motion<Twofold>) -> Bisector {
        let [x, y, w] = g.origin();
        let moved = g.displacement();
        let (height, norm) = match g.space {
            Space::H2 => (w - 1.0.into(), 2.0 * (0.5 * moved).sinh()),
            _ => ((x * x + y * y) * 0.5.into(), moved),
        };
        Bisector { form: [x, y, -height], norm }
    }

    /// How far a corner lies beyond the bisector: the distance, in H² its hyperbolic sine; for a corner outside the disk some number of the same
    /// sign.
    fn beyond(&self, space: Space, p: &[Twofold; 3]) -> f64 {
        let size = match space {
            Space::H2 => {
                let rest = Twofold::from(1.0) - p[0] * p[0] - p[1] * p[1];
                if rest.high > 0.0 { rest.high.sqrt() } else { 1.0 }
            }
            _ => 1.0,
        };
        let unit = 1.0 / (self.norm * size);
        let rough: f64 = (0..3).map(|i| self.form[i].high * p[i].high).sum();
        if (rough * unit).abs() > CLOSE && size > CLOSE {
            return rough * unit;
        }
        self.value(p).high * unit
    }

    fn value(&self, p: &[Twofold; 3]) -> Twofold {
        self.form[0] * p[0] + self.form[1] * p[1] + self.form[2] * p[2]
    }
}

impl Polygon {
    /// A square about the whole Klein disk; in the plane, one about the disk of radius `reach`.
    fn around(space: Space, reach: f64, [tolerance, same]: [f64; 2]) -> Polygon {
        let far = if space == Space::H2 { 2.0 } else { 2.0 * reach };
        let corners = [[far, far], [-far, far], [-far, -far], [far, -far]];
        let corners = corners.map(|[x, y]| [x, y, 1.0].map(Twofold::from)).to_vec();
        Polygon { space, corners, sides: vec![None; 4], radius: f64::INFINITY, tolerance, same }
    }

    /// Cuts by the bisectors of `factors` and of their inverses, then of products of the elements of its sides, until none cuts anything off.
    /// Where the factors move the centre so far that their bisectors do not bound the polygon, short products are added to them. It ends early
    /// at the `limits`, which wrong elements bring about.
    fn close(
        &mut self,
        deck: &DeckGroup,
        factors: &[DeckElement],
        limits: &mut Limits,
        control: &Control,
    ) -> Result<()> {
        // These generate the group, so that they stay among the factors.
        let given: Vec<_> = factors.iter().flat_map(|g| [g.clone(), g.inverse()]).collect();
        let mut factors = given.clone();
        for _ in 0..ROUNDS {
            factors.iter().for_each(|g| {
                self.cut_by_both(g);
            });
            let sides = self.elements();
            let mut changed = false;
            for g in sides.iter().chain(&factors) {
                control.check()?;
                if self.radius < limits.least || limits.left == 0 {
                    return Ok(());
                }
                limits.left = limits.left.saturating_sub(sides.len());
                for h in &sides {
                    let motion = g.motion.compose(&h.motion);
                    if self.is_cut_by(&motion) || self.is_cut_by(&motion.inverse()) {
                        changed |= self.cut_by_both(&product(deck, g, h, motion));
                    }
                }
            }
            match self.is_bounded() {
                true if !changed => break,
                true => {}
                // This round has cut nothing off, and no more products may be added.
                false if !changed && factors.len() > MOST_FACTORS => break,
                false => {
                    limits.left = limits.left.saturating_sub(factors.len() * factors.len());
                    factors = shortest_products(deck, &factors, self.same, control)?;
                    factors.extend_from_slice(&given);
                }
            }
        }
        Ok(())
    }

    /// Cuts by the bisectors of an element and of its inverse, since each is the other's partner.
    fn cut_by_both(&mut self, g: &DeckElement) -> bool {
        let first = self.cut(g);
        self.cut(&g.inverse()) || first
    }

    fn elements(&self) -> Vec<DeckElement> {
        self.sides.iter().flatten().cloned().collect()
    }

    /// Whether it lies inside the Klein disk and all its sides are on bisectors.
    fn is_bounded(&self) -> bool {
        self.radius < f64::INFINITY && self.sides.iter().all(Option::is_some)
    }

    /// Whether the bisector of `g` cuts a corner off.
    fn is_cut_by(&self, g: &Motion<Twofold>) -> bool {
        let moved = g.displacement();
        if moved <= self.same || moved > 2.0 * self.radius + self.tolerance {
            return false;
        }
        let bisector = Bisector::new(g);
        self.corners.iter().any(|p| bisector.beyond(self.space, p) > self.tolerance)
    }

    /// Cuts off the part beyond the bisector of `g`; false if there is none.
    fn cut(&mut self, g: &DeckElement) -> bool {
        if !self.is_cut_by(&g.motion) {
            return false;
        }
        let bisector = Bisector::new(&g.motion);
        let n = self.corners.len();
        let beyond: Vec<f64> = self.corners.iter().map(|p| bisector.beyond(self.space, p)).collect();
        // The corners that are cut off lie in a row around the farthest one, between two that stay.
        let farthest = (0..n).fold(0, |far, k| if beyond[k] > beyond[far] { k } else { far });
        let stays = |k: &usize| beyond[*k] <= 0.0;
        let Some(last) = (1..n).map(|step| (farthest + n - step) % n).find(stays) else { return false };
        let Some(first) = (1..n).map(|step| (farthest + step) % n).find(stays) else { return false };
        let before_first = (first + n - 1) % n;
        // A corner nearer than the tolerance takes the place of the crossing beside it.
        let (mut corners, mut sides) = (Vec::with_capacity(n + 1), Vec::with_capacity(n + 1));
        if beyond[last] < -self.tolerance {
            corners.push(meeting(&bisector, &self.corners[last], &self.corners[(last + 1) % n]));
        } else {
            corners.push(self.corners[last]);
        }
        sides.push(Some(g.clone()));
        if beyond[first] < -self.tolerance {
            corners.push(meeting(&bisector, &self.corners[before_first], &self.corners[first]));
            sides.push(self.sides[before_first].clone());
        }
        let mut k = first;
        while k != last {
            corners.push(self.corners[k]);
            sides.push(self.sides[k].clone());
            k = (k + 1) % n;
        }
        if beyond[last] < -self.tolerance {
            corners.push(self.corners[last]);
            sides.push(self.sides[last].clone());
        }
        (self.corners, self.sides) = (corners, sides);
        self.radius = self.corners.iter().map(|p| self.distance(p)).fold(0.0, f64::max);
        true
    }

    /// Distance of a corner from the origin; infinite outside the Klein disk.
    fn distance(&self, [x, y, _]: &[Twofold; 3]) -> f64 {
        let square = *x * *x + *y * *y;
        match self.space {
            Space::H2 => {
                let rest = f64::from(Twofold::from(1.0) - square);
                // sinh² d = r²/(1 − r²)
                if rest > 0.0 { (square.high / rest).sqrt().asinh() } else { f64::INFINITY }
            }
            _ => square.high.sqrt(),
        }
    }

    /// The domain, with every side's partner; none if a side has no element or no partner.
    fn finish(self, centre: [f64; 3], back: &Motion<Twofold>) -> Option<DirichletDomain> {
        if !self.is_bounded() {
            return None;
        }
        let (space, radius, same) = (self.space, self.radius, self.same);
        let elements = self.elements();
        let is_inverse =
            |g: &DeckElement, h: &DeckElement| g.motion.compose(&h.motion).displacement() <= same;
        let partner: Option<Vec<usize>> =
            elements.iter().map(|g| elements.iter().position(|h| is_inverse(g, h))).collect();
        let points: Vec<[Twofold; 3]> = self.corners.iter().map(|&p| on_hyperboloid(space, p)).collect();
        let n = points.len();
        let ray = |k: usize| self.distance(&self.corners[k]);
        let side = |k: usize| {
            let to_corner = Motion::to_origin(space, points[k]);
            let [x, y, w] = to_corner.apply(points[(k + 1) % n]).map(f64::from);
            super::layout::distance_from_origin(space, [x, y, w])
        };
        let sector = |k: usize| match space {
            Space::H2 => triangle::area(space, [side(k), ray((k + 1) % n), ray(k)]),
            _ => {
                let (p, q) = (points[k], points[(k + 1) % n]);
                f64::from((p[0] * q[1] - p[1] * q[0]) * 0.5.into())
            }
        };
        let area = (0..n).map(sector).sum();
        Some(DirichletDomain {
            centre,
            corners: points.iter().map(|&p| back.apply(p).map(f64::from)).collect(),
            sides: elements.iter().map(|g| g.conjugated_by(back)).collect(),
            partner: partner?,
            area,
            radius,
        })
    }
}

/// The lines of a domain's sides, the centre carried to the origin.
pub(super) struct Lines(Vec<Bisector>);

impl DirichletDomain {
    pub(super) fn lines(&self) -> Lines {
        let line = |side: &DeckElement| {
            let home = Motion::to_origin(side.motion.space, precise_point(side.motion.space, self.centre));
            Bisector::new(&side.motion.conjugated_by(&home))
        };
        Lines(self.sides.iter().map(line).collect())
    }
}

impl Lines {
    /// Whether a point is surely farther than `radius` from the domain: it lies farther beyond the line of a side.
    pub fn keep_off(&self, space: Space, p: [Twofold; 3], radius: f64) -> bool {
        let most = if space == Space::H2 { radius.sinh() } else { radius };
        self.0.iter().any(|line| line.value(&p).high > most * line.norm)
    }
}

/// Where the side between two corners crosses a bisector, at height 1.
fn meeting(bisector: &Bisector, p: &[Twofold; 3], q: &[Twofold; 3]) -> [Twofold; 3] {
    let (a, b) = (bisector.value(p), bisector.value(q));
    let sum = [0, 1, 2].map(|i| b * p[i] - a * q[i]);
    sum.map(|x| x / sum[2])
}

/// The point of the hyperboloid (the plane) over a vector of height 1.
fn on_hyperboloid(space: Space, [x, y, w]: [Twofold; 3]) -> [Twofold; 3] {
    if space != Space::H2 {
        return [x, y, w];
    }
    let scale = Twofold::from(1.0) / (Twofold::from(1.0) - x * x - y * y).sqrt();
    [x * scale, y * scale, scale]
}
