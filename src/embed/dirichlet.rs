//! Dirichlet domains: the points that are nearer to a base point than to its images under a group.

use super::deck::{DeckElement, DeckGroup};
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::model::distance;
use crate::geometry::{Motion, Space, Twofold, triangle};
use crate::topology::word::Word;

/// A side counts, and a corner is cut off, where that moves the border by more than this: deck transformations are known to about
/// 1e-11, corners where several bisectors meet to a few times that.
const SIDE: f64 = 1e-8;
/// Rounds of products of side elements. Each at least doubles the word length that is looked at; two or three are usual.
const ROUNDS: usize = 12;
/// The polygon's area against the surface's, relative.
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

/// The Dirichlet domain of the base point `centre` (ambient coordinates) of a closed surface with this area, in E² or H².
///
/// Bisectors of the side pairings of the layout cut a first polygon; then those of products of the elements of its sides are tried, until
/// none cuts anything off, every side has its partner, and the area is the surface's.
///
/// Errors: [`Error::Layout`] for a group without elements or in S², and where no such polygon is found; [`Error::Cancelled`].
pub fn dirichlet_domain(
    deck: &DeckGroup,
    centre: [f64; 3],
    area: f64,
    control: &Control,
) -> Result<DirichletDomain> {
    if deck.sides.is_empty() || deck.space == Space::S2 {
        return Err(Error::Layout("a simply connected surface has no Dirichlet domain".into()));
    }
    // Everything about the origin: the base point is carried there.
    let home = to_origin(deck.space, centre);
    let about = |g: &DeckElement| DeckElement {
        word: g.word.clone(),
        motion: home.compose(&g.motion).compose(&home.inverse()),
    };
    let mut polygon = Polygon::around(deck.space);
    for g in deck.sides.iter().map(about) {
        polygon.cut(&g);
        polygon.cut(&inverse(&g));
    }
    let mut pool: Vec<_> = deck.sides.iter().map(about).collect();
    for _ in 0..ROUNDS {
        control.check()?;
        let sides = polygon.elements();
        pool.retain(|_| !polygon.is_bounded());
        let factors: Vec<_> = sides.iter().chain(&pool).cloned().collect();
        let mut changed = false;
        for (i, g) in factors.iter().enumerate() {
            if i % 16 == 0 {
                control.check()?;
            }
            for h in &sides {
                let motion = g.motion.compose(&h.motion);
                if polygon.is_cut_by(&motion) {
                    let word = deck.group.reduce(&g.word.times(&h.word));
                    changed |= polygon.cut(&DeckElement { word, motion });
                }
            }
        }
        if !changed && polygon.is_bounded() {
            break;
        }
    }
    let found = polygon.finish(centre, &home.inverse());
    match found {
        Some(domain) if (domain.area - area).abs() <= AREA * area => Ok(domain),
        Some(domain) => Err(Error::Layout(format!(
            "no Dirichlet domain: the polygon found has area {}, the surface {area}",
            domain.area
        ))),
        None => {
            Err(Error::Layout("no Dirichlet domain: the sides of the polygon found are not paired".into()))
        }
    }
}

fn inverse(g: &DeckElement) -> DeckElement {
    DeckElement { word: g.word.inverse(), motion: g.motion.inverse() }
}

/// An isometry that carries a point to the origin.
pub(super) fn to_origin(space: Space, p: [f64; 3]) -> Motion<Twofold> {
    let (r, length) = (p[0].hypot(p[1]), super::space_layout::distance_from_origin(space, p));
    if r == 0.0 {
        return Motion::identity(space);
    }
    let angle = 0.5 * p[1].atan2(p[0]);
    let turn = Motion::rotation([angle.cos(), angle.sin()], space);
    let out = turn.compose(&Motion::translation(length, space)).compose(&turn.inverse());
    out.inverse().precise()
}

/// A convex polygon about the origin in the plane or in the Klein disk, its corners as vectors `[x, y, w]` (of any length), each side with
/// the element whose bisector it lies on; none on the square that it starts from.
struct Polygon {
    space: Space,
    corners: Vec<[f64; 3]>,
    sides: Vec<Option<DeckElement>>,
}

impl Polygon {
    /// A square about the whole Klein disk; in the plane, one that no surface's lengths reach.
    fn around(space: Space) -> Polygon {
        let far = if space == Space::H2 { 2.0 } else { 1e100 };
        let corners = vec![[far, far, 1.0], [-far, far, 1.0], [-far, -far, 1.0], [far, -far, 1.0]];
        Polygon { space, corners, sides: vec![None; 4] }
    }

    fn elements(&self) -> Vec<DeckElement> {
        self.sides.iter().flatten().cloned().collect()
    }

    /// Whether bisectors alone bound it.
    fn is_bounded(&self) -> bool {
        self.sides.iter().all(Option::is_some)
    }

    /// The bisector of the origin and its image under `g`, as the linear form that is positive beyond it; in units of distance where the
    /// corner is a point.
    fn beyond(&self, g: &Motion<Twofold>) -> impl Fn([f64; 3]) -> f64 + use<> {
        let [x, y, w] = g.origin().map(f64::from);
        let space = self.space;
        let moved = g.displacement();
        move |p| {
            let plane = x * p[0] + y * p[1];
            match space {
                // (p·x − |x|²/2)/|x|
                Space::H2 => {
                    let form = (plane - (w - 1.0) * p[2]) / (2.0 * (0.5 * moved).sinh());
                    form / (p[2] * p[2] - p[0] * p[0] - p[1] * p[1]).max(f64::MIN_POSITIVE).sqrt()
                }
                _ => (plane / p[2] - 0.5 * (x * x + y * y)) / moved,
            }
        }
    }

    /// Whether the bisector of `g` cuts a corner off.
    fn is_cut_by(&self, g: &Motion<Twofold>) -> bool {
        let moved = g.displacement();
        if moved <= SIDE || moved > 2.0 * self.radius() + SIDE {
            return false;
        }
        let beyond = self.beyond(g);
        self.corners.iter().any(|&p| beyond(p) > SIDE)
    }

    /// Largest distance of a corner from the origin.
    fn radius(&self) -> f64 {
        let far = |&[x, y, w]: &[f64; 3]| {
            let r = x.hypot(y) / w;
            match self.space {
                Space::H2 if r >= 1.0 => f64::INFINITY,
                Space::H2 => r.atanh(),
                _ => r,
            }
        };
        self.corners.iter().map(far).fold(0.0, f64::max)
    }

    /// Cut off what lies beyond the bisector of `g`; false if that is nothing.
    fn cut(&mut self, g: &DeckElement) -> bool {
        if !self.is_cut_by(&g.motion) {
            return false;
        }
        let beyond = self.beyond(&g.motion);
        let n = self.corners.len();
        let form: Vec<f64> = self.corners.iter().map(|&p| beyond(p)).collect();
        let (mut corners, mut sides) = (Vec::with_capacity(n + 1), Vec::with_capacity(n + 1));
        for k in 0..n {
            let next = (k + 1) % n;
            let inside = |k: usize| form[k] <= SIDE;
            let crossing = || meeting(self.space, self.corners[k], self.corners[next], form[k], form[next]);
            match (inside(k), inside(next)) {
                (true, true) => {
                    corners.push(self.corners[k]);
                    sides.push(self.sides[k].clone());
                }
                (true, false) => {
                    corners.push(self.corners[k]);
                    // A side that ends on the bisector has no part beyond this corner.
                    if form[k] < -SIDE {
                        sides.push(self.sides[k].clone());
                        corners.push(crossing());
                    }
                    sides.push(Some(g.clone()));
                }
                (false, true) if form[next] < -SIDE => {
                    corners.push(crossing());
                    sides.push(self.sides[k].clone());
                }
                _ => {}
            }
        }
        (self.corners, self.sides) = (corners, sides);
        true
    }

    /// The domain, with every side's partner; none if a side has no element or no partner.
    fn finish(self, centre: [f64; 3], back: &Motion<Twofold>) -> Option<DirichletDomain> {
        if !self.is_bounded() || self.radius() == f64::INFINITY {
            return None;
        }
        let (space, radius) = (self.space, self.radius());
        let elements = self.elements();
        let is_inverse = |g: &DeckElement, h: &DeckElement| {
            let both = g.motion.compose(&h.motion);
            both.displacement() <= SIDE
        };
        let partner: Option<Vec<usize>> =
            elements.iter().map(|g| elements.iter().position(|h| is_inverse(g, h))).collect();
        let points: Vec<[f64; 3]> = self.corners.iter().map(|&p| normalised(space, p)).collect();
        let origin = [0.0, 0.0, 1.0];
        let length = |p: [f64; 3], q: [f64; 3]| match space {
            Space::H2 => distance(p, q),
            _ => (p[0] - q[0]).hypot(p[1] - q[1]),
        };
        let n = points.len();
        let sector = |k: usize| {
            let (p, q) = (points[k], points[(k + 1) % n]);
            triangle::area(space, [length(p, q), length(q, origin), length(origin, p)])
        };
        let area = (0..n).map(sector).sum();
        let place = |g: DeckElement| DeckElement {
            motion: back.compose(&g.motion).compose(&back.inverse()),
            word: g.word,
        };
        Some(DirichletDomain {
            centre,
            corners: points.iter().map(|p| back.apply(p.map(Twofold::from)).map(f64::from)).collect(),
            sides: elements.into_iter().map(place).collect(),
            partner: partner?,
            area,
            radius,
        })
    }
}

/// Where a side crosses a bisector, from the bisector's form at its ends.
fn meeting(space: Space, p: [f64; 3], q: [f64; 3], at_p: f64, at_q: f64) -> [f64; 3] {
    // The forms were in units of distance: back to linear ones.
    let unit = |p: [f64; 3]| match space {
        Space::H2 => (p[2] * p[2] - p[0] * p[0] - p[1] * p[1]).max(f64::MIN_POSITIVE).sqrt(),
        _ => p[2],
    };
    let (a, b) = (at_p * unit(p), at_q * unit(q));
    let sum = [0, 1, 2].map(|i| b * p[i] - a * q[i]);
    // In units of its height: corners stay of one size.
    sum.map(|x| x / sum[2])
}

fn normalised(space: Space, p: [f64; 3]) -> [f64; 3] {
    match space {
        Space::H2 => {
            let r = p[0].hypot(p[1]) / p[2];
            let w = 1.0 / ((1.0 - r) * (1.0 + r)).sqrt();
            [w * p[0] / p[2], w * p[1] / p[2], w]
        }
        _ => [p[0] / p[2], p[1] / p[2], 1.0],
    }
}

/// The identity as an element.
pub(super) fn identity(space: Space) -> DeckElement {
    DeckElement { word: Word::identity(), motion: Motion::identity(space) }
}
