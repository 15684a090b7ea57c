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

use super::border::Border;
use super::deck::DeckGroup;
use super::domain::DirichletDomain;
use super::frame::ORIGIN;
use super::layout::distance_from_origin;
use super::polygon::{Given, Limits, Polygon};
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::motion::precise_point;
use crate::geometry::{Motion, Space};
use crate::topology::word::Letter;
use std::f64::consts::PI;

/// Lengths by which a bisector must move the border of the polygon to count; the first for which all sides can be paired is taken. Elements
/// have errors of 1e-30, or 1e-14 in some schemes, times e^distance, and so have corners where more than three bisectors meet.
const TOLERANCES: [f64; 4] = [1e-12, 1e-10, 1e-8, 1e-6];
/// Products that one search forms at most, which takes some seconds: wrong elements would make ever new products.
const MOST_PRODUCTS: usize = 5_000_000;
/// Displacement of the centre, in H² a length and in E² in units of the longest factor, below which an element is the identity. It is far
/// above the errors of elements and far below the shortest loop of a surface that can be resolved.
const SAME: f64 = 1e-6;
/// Relative difference of the polygon's area and the surface's up to which the polygon is the domain. A missing or wrong side changes the
/// area by more.
const AREA: f64 = 1e-6;

/// Largest rotation of a deck transformation of a flat surface, radians, with which a polygon is looked for: translations alone have copies
/// that tile a part of the plane.
const TURNING: f64 = 1e-6;

/// Largest [`DeckGroup::side_residual`] with which a polygon is looked for: pairings farther from their words have lost half of their
/// digits, and bound no polygon.
const PAIRED: f64 = 1e-8;

fn none(why: &str) -> Error {
    let advice = "the surface reaches farther in its metric than its isometries have digits; take another base vertex or a finer mesh";
    Error::Layout(format!("no Dirichlet domain: {why} ({advice})"))
}

/// The Dirichlet domain of the base point `centre` (ambient coordinates) of a surface with this area, in E² or H²: a closed one, or one
/// with straight boundary, whose lines bound the domain too.
///
/// Bisectors of the side pairings of the layout cut a first polygon; then those of products of the elements of its sides are tried, until
/// none cuts anything off, every side has its partner, and the area is the surface's.
///
/// # Errors
/// [`Error::Layout`] for a group without elements, in S², or in E² with rotations, and where no such polygon is found;
/// [`Error::Cancelled`].
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
    let turning = deck.generators.iter().map(Motion::rotation_angle).fold(0.0, f64::max);
    if deck.space == Space::E2 && turning > TURNING {
        return Err(Error::Layout(format!(
            "no Dirichlet domain: loops of this flat surface turn by up to {turning} radians, and its copies do not tile the plane"
        )));
    }
    // The base point is carried to the origin, and everything with it.
    let home = Motion::to_origin(deck.space, precise_point(deck.space, centre));
    let sides = deck.sides.iter().map(|g| g.conjugated_by(&home));
    // The images of the centre under the side pairings lie within the sum of their distances: no point that is nearest to the centre, and
    // on this side of the borders, is farther out.
    let borders: Vec<Border> = deck.borders.iter().map(|border| border.conjugated_by(&home)).collect();
    let centre_of_all = precise_point(deck.space, ORIGIN);
    let to_border = |border: &Border| border.line().distance(deck.space, &centre_of_all).abs();
    let reach = sides.clone().map(|g| g.motion.displacement()).sum::<f64>()
        + borders.iter().map(to_border).sum::<f64>();
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
    let point = |border: &Border| distance_from_origin(deck.space, border.point);
    let given = Given { deck, factors, reach: borders.iter().map(point).fold(0.0, f64::max), borders };
    let (mut nearest, mut limits) = (None, Limits { least, left: MOST_PRODUCTS });
    for tolerance in TOLERANCES {
        let mut polygon = Polygon::around(deck.space, reach, [tolerance * unit, SAME * unit]);
        polygon.close(&given, &mut limits, control)?;
        if !polygon.is_bounded() {
            break;
        }
        if polygon.radius < least {
            continue;
        }
        match polygon.finish(&given, centre, &home.inverse()) {
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
