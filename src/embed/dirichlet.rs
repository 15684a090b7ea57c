//! Dirichlet domains: the points that are nearer to a base point than to its images under a deck group.
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

use super::bisector_polygon::{BisectorPolygon, BoundedGroup, SearchLimits};
use super::boundary_lift::BoundaryLift;
use super::deck::DeckGroup;
use super::domain::DirichletDomain;
use super::frame::ORIGIN;
use super::layout::distance_from_origin;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::motion::precise_point;
use crate::geometry::{Motion, Space};
use crate::topology::word::Letter;
use std::f64::consts::PI;

/// Lengths by which a bisector must cut into the polygon to count, in H² lengths, in E² multiples of the longest factor; the first is taken
/// with which all sides pair and the area fits. Elements have errors of 1e-30, or 1e-14 in some schemes, times e^distance. By so much a
/// bisector that only touches the polygon at a corner, where the bisectors of two sides meet, may seem to cut into it.
const TOLERANCES: [f64; 4] = [1e-12, 1e-10, 1e-8, 1e-6];
/// Most products formed over all four tolerances (some seconds): wrong elements would make ever new products.
const MOST_PRODUCTS: usize = 5_000_000;
/// Displacement of the centre, in H² a length and in E² in units of the longest factor, below which an element is the identity. The bound
/// is far above the errors of elements and far below the shortest loop of a surface that can be resolved.
const IDENTITY_DISPLACEMENT: f64 = 1e-6;
/// Largest relative difference between the areas of the domain and the surface: a missing or wrong side changes the area by more.
const AREA_TOLERANCE: f64 = 1e-6;

/// Largest rotation, in radians, of a deck transformation of a flat surface. Beyond this a loop turns: the surface has cones, and this search
/// covers translations only.
const MAX_ROTATION: f64 = 1e-6;

/// Largest [`DeckGroup::side_residual`] with which a polygon is searched: pairings farther from their words have lost half of their digits,
/// so that no polygon closes.
const MAX_SIDE_RESIDUAL: f64 = 1e-8;

fn no_domain(why: &str) -> Error {
    let advice = "the surface is so wide in its metric that its isometries have lost their digits; take another base vertex or a finer mesh (`ricci refine`)";
    Error::Layout(format!("no Dirichlet domain: {why} ({advice})"))
}

/// Checks that a group is one whose domain this search can find.
fn check_group(deck: &DeckGroup) -> Result<()> {
    if deck.sides.is_empty() || deck.space == Space::S2 {
        return Err(Error::Layout("a simply connected surface has no Dirichlet domain".into()));
    }
    if deck.side_residual > MAX_SIDE_RESIDUAL {
        let off = deck.side_residual;
        return Err(no_domain(&format!(
            "the isometries of the sides are {off:.1e} away from those of their words"
        )));
    }
    let turning = deck.generators.iter().map(Motion::rotation_angle).fold(0.0, f64::max);
    if deck.space == Space::E2 && turning > MAX_ROTATION {
        return Err(Error::Layout(format!(
            "no Dirichlet domain: loops of this flat surface turn by up to {turning} radians: it has cones, and the search covers translations only"
        )));
    }
    Ok(())
}

/// The Dirichlet domain of the base point `centre` (ambient coordinates) of a surface with this area, in E² or H². The surface is closed,
/// or has a straight boundary, whose lines bound the domain too.
///
/// The bisectors of the layout's side pairings cut out a first polygon; then the bisectors of products of its sides' elements are tried,
/// until none cuts anything off. If then a side has no partner or the area is not the surface's, the search starts again with the next
/// tolerance.
///
/// # Errors
/// [`Error::Layout`] for a group without elements, in S², or in E² with rotations, and if no such polygon is found;
/// [`Error::Cancelled`].
pub fn dirichlet_domain(
    deck: &DeckGroup,
    centre: [f64; 3],
    area: f64,
    control: &Control,
) -> Result<DirichletDomain> {
    check_group(deck)?;
    // The base point is moved to the origin; side elements, generators and borders are moved with it, `deck` is not.
    let home = Motion::to_origin(deck.space, precise_point(deck.space, centre));
    let sides = deck.sides.iter().map(|g| g.conjugated_by(&home));
    // In E² no point of the domain is farther from the centre than the sum of these distances: those of the images of the centre under the
    // side pairings, and those of the boundary lines. On a torus every point of the plane is within (|a| + |b|)/2 of an image, where a and b
    // are two independent translations among the pairings; in the strip of an annulus within |a|/2 and the distance of the farther line. In
    // H² the search starts from the whole Klein disk.
    let borders: Vec<BoundaryLift> = deck.borders.iter().map(|border| border.conjugated_by(&home)).collect();
    let centre_of_all = precise_point(deck.space, ORIGIN);
    let to_border = |border: &BoundaryLift| border.line().distance(deck.space, &centre_of_all).abs();
    let radius_bound = sides.clone().map(|g| g.motion.displacement()).sum::<f64>()
        + borders.iter().map(to_border).sum::<f64>();
    // The generators are factors too, since on a surface of few vertices they are shorter than the sides.
    let generator = |k| Ok(deck.element(Letter::generator(k))?.conjugated_by(&home));
    let generators = (0..deck.generators.len()).map(generator);
    let factors = sides.map(Ok).chain(generators).collect::<Result<Vec<_>>>()?;
    // Tolerances in E² are in units of the longest factor.
    let longest = || factors.iter().map(|g| g.motion.displacement()).fold(0.0, f64::max);
    // `least_radius` is the radius of a disk of this area: a polygon of the same area reaches farther.
    let (unit, least_radius) = match deck.space {
        Space::H2 => (1.0, 2.0 * (area / (4.0 * PI)).sqrt().asinh()),
        _ => (longest(), (area / PI).sqrt()),
    };
    let distance_of = |border: &BoundaryLift| distance_from_origin(deck.space, border.point);
    let group = BoundedGroup {
        deck,
        factors,
        farthest_border: borders.iter().map(distance_of).fold(0.0, f64::max),
        borders,
    };
    let (mut last_found, mut limits) = (None, SearchLimits { least_radius, products_left: MOST_PRODUCTS });
    for tolerance in TOLERANCES {
        let mut polygon = BisectorPolygon::around(
            deck.space,
            radius_bound,
            [tolerance * unit, IDENTITY_DISPLACEMENT * unit],
        );
        polygon.close(&group, &mut limits, control)?;
        if !polygon.is_bounded() {
            // A larger tolerance makes fewer cuts, so that the next polygons would not be bounded either.
            break;
        }
        if polygon.radius < least_radius {
            // Wrong cuts have left too little room for the surface; a larger tolerance may leave these cuts out.
            continue;
        }
        match polygon.finish(&group, centre, &home.inverse()) {
            Some(domain) if (domain.area - area).abs() <= AREA_TOLERANCE * area => return Ok(domain),
            found => last_found = found.or(last_found),
        }
    }
    let message = match last_found {
        Some(domain) => format!("the polygon found has area {:.6e}, the surface {area:.6e}", domain.area),
        None => "no polygon with paired sides and room for the surface was found".into(),
    };
    Err(no_domain(&message))
}
