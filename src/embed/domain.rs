//! Dirichlet domains as data.

use super::element::DeckElement;
use super::line::Line;
use crate::geometry::motion::precise_point;
use crate::geometry::{DoubleDouble, Motion, Space};

/// The Dirichlet domain of a base point: a convex polygon with geodesic sides, each on the bisector of the base point and its image
/// under the side's element, which carries the domain onto its neighbour across that side, or on the straight boundary of the surface.
#[derive(Debug, Clone)]
pub struct DirichletDomain {
    /// The base point, in ambient coordinates.
    pub centre: [f64; 3],
    /// Corners counterclockwise, in ambient coordinates; side k runs from corner k to the next one.
    pub corners: Vec<[f64; 3]>,
    /// The element of each side; of one on the boundary, that which moves the boundary along itself by its loop once, a conjugate of some
    /// c_j.
    pub sides: Vec<DeckElement>,
    /// Per side, the one with the inverse element; none on the boundary.
    pub partner: Vec<Option<usize>>,
    /// Area of the polygon, from the lengths of its sides and of the rays to its corners.
    pub area: f64,
    /// Largest distance of a corner from the base point.
    pub radius: f64,
}

/// The lines of a domain's sides, the centre carried to the origin.
pub(super) struct Lines(Vec<Line>);

impl DirichletDomain {
    /// The elements of the sides that have a neighbour across them: all but those on the boundary.
    pub fn neighbours(&self) -> impl Iterator<Item = &DeckElement> + Clone {
        self.sides.iter().zip(&self.partner).filter(|(_, partner)| partner.is_some()).map(|(side, _)| side)
    }

    pub(super) fn lines(&self) -> Lines {
        let line = |side: &DeckElement| {
            let home = Motion::to_origin(side.motion.space, precise_point(side.motion.space, self.centre));
            Line::bisector(&side.motion.conjugated_by(&home))
        };
        Lines(self.neighbours().map(line).collect())
    }
}

impl Lines {
    /// Whether a point is surely farther than `radius` from the domain: it lies farther beyond the line of a side.
    pub fn keep_off(&self, space: Space, p: [DoubleDouble; 3], radius: f64) -> bool {
        let most = if space == Space::H2 { radius.sinh() } else { radius };
        self.0.iter().any(|line| line.value(&p).high > most * line.norm)
    }
}
