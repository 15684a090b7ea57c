//! Convex polygons about the origin of the plane or of the hyperbolic plane, cut out by bisectors and boundary lines of a deck group.

use super::boundary_lift::BoundaryLift;
use super::deck::DeckGroup;
use super::domain::DirichletDomain;
use super::element::DeckElement;
use crate::control::Control;
use crate::error::Result;
use crate::geometry::bounding_line::BoundingLine;
use crate::geometry::{DoubleDouble, Motion, Space, triangle};

/// Most rounds in which products of side elements are tried. Each round at least doubles the length of the words that are reached; two or
/// three rounds are usual.
const ROUNDS: usize = 12;

fn product(deck: &DeckGroup, g: &DeckElement, h: &DeckElement, motion: Motion<DoubleDouble>) -> DeckElement {
    DeckElement { word: deck.group.reduce(&g.word.times(&h.word)), motion }
}

/// Most products that are added to factors whose bisectors do not bound the polygon. Finding them takes the square of this number of
/// compositions, less than a second.
const MOST_FACTORS: usize = 600;

/// The elements that move the origin least among the given ones and the products of two of them, without the identity: twice as many as
/// were given. `same`: displacement up to which two elements are one.
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

/// The limits at which the search for a polygon gives up.
pub(super) struct SearchLimits {
    /// Radius below which no polygon has room for the surface.
    pub least_radius: f64,
    /// Number of products of elements that may still be formed, for all polygons together.
    pub products_left: usize,
}

/// A deck group about the origin, with generators and with the boundary lifts that bound the universal cover.
pub(super) struct BoundedGroup<'a> {
    pub deck: &'a DeckGroup,
    /// Elements that generate the group.
    pub factors: Vec<DeckElement>,
    /// At least one lift of each boundary loop.
    pub borders: Vec<BoundaryLift>,
    /// The largest distance of these lifts' points from the origin.
    pub farthest_border: f64,
}

/// The line on which a side of the polygon lies.
#[derive(Clone)]
enum PolygonSide {
    /// A side of the square from which the polygon starts.
    Start,
    /// The bisector of the origin and its image under this element.
    Bisector(DeckElement),
    /// The boundary lift of this number, moved by this element.
    Boundary(usize, DeckElement),
}

/// A convex polygon about the origin in the plane or in the Klein disk. Its corners are vectors `[x, y, w]` with w = 1, in double-double
/// precision, since at distance d from the origin the border of the Klein disk is only e^{−2d} away.
pub(super) struct BisectorPolygon {
    space: Space,
    corners: Vec<[DoubleDouble; 3]>,
    sides: Vec<PolygonSide>,
    /// The largest distance of a corner from the origin.
    pub radius: f64,
    /// The length by which a line must cut into the polygon to count.
    tolerance: f64,
    /// The displacement up to which an element is the identity, a length.
    same: f64,
}

impl BisectorPolygon {
    /// A square around the whole Klein disk; in the plane, around the disk of radius `reach`.
    pub fn around(space: Space, reach: f64, [tolerance, same]: [f64; 2]) -> BisectorPolygon {
        let far = if space == Space::H2 { 2.0 } else { 2.0 * reach };
        let corners = [[far, far], [-far, far], [-far, -far], [far, -far]];
        let corners = corners.map(|[x, y]| [x, y, 1.0].map(DoubleDouble::from)).to_vec();
        let sides = corners.iter().map(|_| PolygonSide::Start).collect();
        BisectorPolygon { space, corners, sides, radius: f64::INFINITY, tolerance, same }
    }

    /// Cuts by the bisectors of the factors and of their inverses, then of products of the elements of its sides, and by the images of the
    /// boundary lifts under these, until none cuts anything off. If the factors move the centre so far that their bisectors do not bound
    /// the polygon, short products are added to them. The search ends early at the `limits`, which only wrong elements reach.
    pub fn close(
        &mut self,
        all: &BoundedGroup<'_>,
        limits: &mut SearchLimits,
        control: &Control,
    ) -> Result<()> {
        // These generate the group, so they stay among the factors.
        let generators: Vec<_> = all.factors.iter().flat_map(|g| [g.clone(), g.inverse()]).collect();
        let (deck, mut factors) = (all.deck, generators.clone());
        for _ in 0..ROUNDS {
            factors.iter().for_each(|g| {
                self.cut_by_both(g);
            });
            let mut changed = self.cut_by_borders(all, &factors);
            let sides: Vec<DeckElement> = self.elements().cloned().collect();
            for g in sides.iter().chain(&factors) {
                control.check()?;
                if self.radius < limits.least_radius || limits.products_left == 0 {
                    return Ok(());
                }
                limits.products_left = limits.products_left.saturating_sub(sides.len());
                for h in &sides {
                    let motion = g.motion.compose(&h.motion);
                    if self.is_cut_by(&motion) || self.is_cut_by(&motion.inverse()) {
                        changed |= self.cut_by_both(&product(deck, g, h, motion));
                    }
                }
            }
            let (is_bounded, may_add) = (self.is_bounded(), factors.len() <= MOST_FACTORS);
            if !changed && (is_bounded || !may_add) {
                break;
            }
            if !is_bounded {
                limits.products_left = limits.products_left.saturating_sub(factors.len() * factors.len());
                factors = shortest_products(deck, &factors, self.same, control)?;
                factors.extend_from_slice(&generators);
            }
        }
        Ok(())
    }

    /// Cuts by the bisectors of an element and of its inverse, whose sides are partners; true if one of them cut something off.
    fn cut_by_both(&mut self, g: &DeckElement) -> bool {
        let mut cut = |g: &DeckElement| {
            self.is_cut_by(&g.motion)
                && self.cut(&BoundingLine::bisector(&g.motion), PolygonSide::Bisector(g.clone()))
        };
        let first = cut(g);
        cut(&g.inverse()) || first
    }

    /// Cuts by the boundary lifts, by those on which sides of the polygon lie, and by the images of all these under the factors and the
    /// elements of the sides; true if one of them cut something off.
    fn cut_by_borders(&mut self, all: &BoundedGroup<'_>, factors: &[DeckElement]) -> bool {
        let identity = DeckElement::identity(self.space);
        let mut known: Vec<(usize, DeckElement)> =
            (0..all.borders.len()).map(|k| (k, identity.clone())).collect();
        known.extend(self.sides.iter().filter_map(|side| match side {
            PolygonSide::Boundary(k, g) => Some((*k, g.clone())),
            _ => None,
        }));
        let mut elements: Vec<DeckElement> =
            std::iter::once(&identity).chain(self.elements()).chain(factors).cloned().collect();
        // The shortest come first: once the polygon is bounded, elements that move the boundary lifts too far to touch it need not be
        // tried. Those are known to few digits.
        elements.sort_by(|g, h| g.motion.displacement().total_cmp(&h.motion.displacement()));
        let mut changed = false;
        for h in &elements {
            for (k, g) in &known {
                // For the image of an image, the elements are multiplied first, which loses fewer digits.
                let motion = h.motion.compose(&g.motion);
                if motion.displacement() > self.radius + all.farthest_border {
                    continue;
                }
                let line = all.borders[*k].conjugated_by(&motion).line();
                if self.is_beyond(&line) && !self.has(&line) {
                    changed |= self.cut(&line, PolygonSide::Boundary(*k, product(all.deck, h, g, motion)));
                }
            }
        }
        changed
    }

    /// True if one of its sides on the boundary lies on a line, up to rounding.
    fn has(&self, line: &BoundingLine) -> bool {
        let (n, near) = (self.corners.len(), |p| line.beyond(self.space, p).abs() <= self.same);
        let is_on = |k: &usize| near(&self.corners[*k]) && near(&self.corners[(k + 1) % n]);
        (0..n).filter(|&k| matches!(self.sides[k], PolygonSide::Boundary(..))).any(|k| is_on(&k))
    }

    /// The elements of its sides.
    fn elements(&self) -> impl Iterator<Item = &DeckElement> {
        self.sides.iter().filter_map(|side| match side {
            PolygonSide::Bisector(g) => Some(g),
            _ => None,
        })
    }

    /// True if the polygon lies inside the Klein disk and no side of the square is left from which it started.
    pub fn is_bounded(&self) -> bool {
        self.radius < f64::INFINITY && !self.sides.iter().any(|side| matches!(side, PolygonSide::Start))
    }

    /// True if the bisector of `g` cuts a corner off.
    fn is_cut_by(&self, g: &Motion<DoubleDouble>) -> bool {
        let moved = g.displacement();
        if moved <= self.same || moved > 2.0 * self.radius + self.tolerance {
            return false;
        }
        self.is_beyond(&BoundingLine::bisector(g))
    }

    /// True if a corner lies beyond a line.
    fn is_beyond(&self, line: &BoundingLine) -> bool {
        self.corners.iter().any(|p| line.beyond(self.space, p) > self.tolerance)
    }

    /// Cuts off the part beyond a line; false if that is the whole polygon.
    fn cut(&mut self, line: &BoundingLine, side: PolygonSide) -> bool {
        let n = self.corners.len();
        let beyond: Vec<f64> = self.corners.iter().map(|p| line.beyond(self.space, p)).collect();
        // The corners that are cut off lie in a row around the farthest one, between two that stay.
        let farthest = (0..n).fold(0, |far, k| if beyond[k] > beyond[far] { k } else { far });
        let stays = |k: &usize| beyond[*k] <= 0.0;
        let Some(last) = (1..n).map(|step| (farthest + n - step) % n).find(stays) else { return false };
        let Some(first) = (1..n).map(|step| (farthest + step) % n).find(stays) else { return false };
        let before_first = (first + n - 1) % n;
        // A corner nearer than the tolerance takes the place of the crossing beside it.
        let (mut corners, mut sides) = (Vec::with_capacity(n + 1), Vec::with_capacity(n + 1));
        if beyond[last] < -self.tolerance {
            corners.push(meeting(line, &self.corners[last], &self.corners[(last + 1) % n]));
        } else {
            corners.push(self.corners[last]);
        }
        sides.push(side);
        if beyond[first] < -self.tolerance {
            corners.push(meeting(line, &self.corners[before_first], &self.corners[first]));
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

    /// The distance of a corner from the origin; infinite outside the Klein disk.
    fn distance(&self, [x, y, _]: &[DoubleDouble; 3]) -> f64 {
        let square = *x * *x + *y * *y;
        match self.space {
            Space::H2 => {
                let rest = f64::from(DoubleDouble::from(1.0) - square);
                // sinh² d = r²/(1 − r²)
                if rest > 0.0 { (square.high / rest).sqrt().asinh() } else { f64::INFINITY }
            }
            _ => square.high.sqrt(),
        }
    }

    /// The side with the inverse element, `Some(None)` for a side on the boundary, which has none; `None` if the partner is missing.
    fn partner(&self, k: usize) -> Option<Option<usize>> {
        let PolygonSide::Bisector(g) = &self.sides[k] else { return Some(None) };
        let is_inverse = |side: &PolygonSide| match side {
            PolygonSide::Bisector(h) => g.motion.compose(&h.motion).displacement() <= self.same,
            _ => false,
        };
        self.sides.iter().position(is_inverse).map(Some)
    }

    /// The Dirichlet domain that the polygon is, with every side's partner, moved by `back`; `None` if a side has no element or no partner.
    pub fn finish(
        self,
        all: &BoundedGroup<'_>,
        centre: [f64; 3],
        back: &Motion<DoubleDouble>,
    ) -> Option<DirichletDomain> {
        if !self.is_bounded() {
            return None;
        }
        let (space, radius) = (self.space, self.radius);
        let partner = (0..self.sides.len()).map(|k| self.partner(k)).collect::<Option<Vec<_>>>()?;
        let points: Vec<[DoubleDouble; 3]> = self.corners.iter().map(|&p| on_hyperboloid(space, p)).collect();
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
            sides: self
                .sides
                .iter()
                .filter_map(|side| Some(all.element(side)?.conjugated_by(back)))
                .collect(),
            partner,
            area,
            radius,
        })
    }
}

impl BoundedGroup<'_> {
    /// The element of a side; for a side on the boundary, the element that moves it along itself.
    fn element(&self, side: &PolygonSide) -> Option<DeckElement> {
        match side {
            PolygonSide::Start => None,
            PolygonSide::Bisector(g) => Some(g.clone()),
            PolygonSide::Boundary(k, g) => Some(self.borders[*k].moved_by(g, &self.deck.group).element),
        }
    }
}

/// The point with w = 1 at which the side between two corners crosses a line.
fn meeting(line: &BoundingLine, p: &[DoubleDouble; 3], q: &[DoubleDouble; 3]) -> [DoubleDouble; 3] {
    let (a, b) = (line.value(p), line.value(q));
    let sum = [0, 1, 2].map(|i| b * p[i] - a * q[i]);
    sum.map(|x| x / sum[2])
}

/// The point of the hyperboloid, in E² of the plane, in the direction of a vector with w = 1.
fn on_hyperboloid(space: Space, [x, y, w]: [DoubleDouble; 3]) -> [DoubleDouble; 3] {
    if space != Space::H2 {
        return [x, y, w];
    }
    let scale = DoubleDouble::from(1.0) / (DoubleDouble::from(1.0) - x * x - y * y).sqrt();
    [x * scale, y * scale, scale]
}
