//! The lifts of boundary loops to the universal cover.

use super::cover_walk::CoverWalks;
use super::element::DeckElement;
use super::layout::Layout;
use crate::archive::stored;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::bounding_line::BoundingLine;
use crate::geometry::motion::precise_point;
use crate::geometry::{DoubleDouble, Motion};
use crate::mesh::HalfedgeId;
use crate::topology::word::Word;
use crate::topology::{HomotopyBasis, SurfaceGroup};

/// A lift of a boundary loop. If the loop is straight, the lift is a line, and the universal cover lies on its left.
#[derive(Debug, Clone)]
pub struct BoundaryLift {
    /// The number of the loop's generator c_j among the generators of the group, counted from 0.
    pub generator: usize,
    /// The element that moves the lift along itself by the loop once, the surface on its left: a conjugate of c_j.
    pub element: DeckElement,
    /// A point of the lift in ambient coordinates.
    pub point: [f64; 3],
}
stored!(sections BoundaryLift { generator, element, point });

impl BoundaryLift {
    /// The lift of a boundary loop in the layout, from the half-edge `start` on the boundary. `copy`: the word of the element that carries
    /// the base lift of the origin of `start` to its place in the layout.
    pub(super) fn new(
        walks: &CoverWalks<'_>,
        basis: &HomotopyBasis,
        copy: &Word,
        start: HalfedgeId,
        control: &Control,
    ) -> Result<BoundaryLift> {
        let layout: &Layout = walks.layout();
        let path = layout.mesh().boundary_from(start);
        let around = basis.path_word(layout.mesh(), &path)?;
        let word = basis.group.reduce(&copy.times(&around).times(&copy.inverse()));
        let j = basis.rims.iter().position(|rim| path.contains(rim));
        let torn = || Error::Layout("a boundary loop of the layout has no generator".into());
        Ok(BoundaryLift {
            generator: 2 * basis.group.genus + j.ok_or_else(torn)?,
            element: DeckElement { word, motion: walks.element(start, &path, control)? },
            point: layout.corner(start),
        })
    }

    /// The image of the lift under `to`, with the same word.
    pub(super) fn conjugated_by(&self, to: &Motion<DoubleDouble>) -> BoundaryLift {
        let point = to.apply(precise_point(to.space, self.point)).map(f64::from);
        BoundaryLift { point, element: self.element.conjugated_by(to), generator: self.generator }
    }

    /// The image of the lift under an element of the group: another lift of the same loop.
    pub(super) fn moved_by(&self, g: &DeckElement, group: &SurfaceGroup) -> BoundaryLift {
        let word = group.reduce(&g.word.times(&self.element.word).times(&g.word.inverse()));
        let BoundaryLift { element: DeckElement { motion, .. }, point, generator } =
            self.conjugated_by(&g.motion);
        BoundaryLift { element: DeckElement { word, motion }, point, generator }
    }

    /// The line on which a straight lift lies; the universal cover is not beyond it.
    pub(super) fn line(&self) -> BoundingLine {
        let motion = &self.element.motion;
        BoundingLine::along(motion, precise_point(motion.space, self.point))
    }
}
