//! The data of a Dirichlet domain: corners, sides, their elements and partners.

use super::element::DeckElement;
use crate::geometry::bounding_line::BoundingLine;
use crate::geometry::motion::precise_point;
use crate::geometry::{DoubleDouble, Motion, Space};

/// The Dirichlet domain of a base point: a convex polygon with geodesic sides. A side lies on the straight boundary of the surface, or on
/// the bisector of the base point and its image under the side's element, which carries the domain onto its neighbour across that side.
#[derive(Debug, Clone)]
pub struct DirichletDomain {
    /// The base point, in ambient coordinates.
    pub centre: [f64; 3],
    /// Corners counterclockwise, in ambient coordinates; side k runs from corner k to the next one.
    pub corners: Vec<[f64; 3]>,
    /// Per side, its element; for a side on the boundary, the element that moves the boundary along itself by its loop once, a conjugate of
    /// some c_j.
    pub sides: Vec<DeckElement>,
    /// Per side, the side with the inverse element; `None` on the boundary.
    pub partner: Vec<Option<usize>>,
    /// The area of the polygon, from the lengths of its sides and of the rays to its corners.
    pub area: f64,
    /// The largest distance of a corner from the base point.
    pub radius: f64,
}

/// The lines of a domain's sides, after the centre has been moved to the origin.
pub(super) struct DomainLines(Vec<BoundingLine>);

impl DirichletDomain {
    /// The elements of the sides that have a neighbour across them: all but those on the boundary.
    pub fn neighbours(&self) -> impl Iterator<Item = &DeckElement> + Clone {
        self.sides.iter().zip(&self.partner).filter(|(_, partner)| partner.is_some()).map(|(side, _)| side)
    }

    pub(super) fn lines(&self) -> DomainLines {
        let line = |side: &DeckElement| {
            let to_origin =
                Motion::to_origin(side.motion.space, precise_point(side.motion.space, self.centre));
            BoundingLine::bisector(&side.motion.conjugated_by(&to_origin))
        };
        DomainLines(self.neighbours().map(line).collect())
    }
}

impl DomainLines {
    /// True if a point lies farther than `radius` beyond the line of a side, and so farther than that from the domain.
    pub fn keep_off(&self, space: Space, p: [DoubleDouble; 3], radius: f64) -> bool {
        let most = if space == Space::H2 { radius.sinh() } else { radius };
        self.0.iter().any(|line| line.value(&p).high > most * line.norm)
    }
}
