//! The boundary of a surface in its universal cover.

use super::element::DeckElement;
use super::layout::Layout;
use super::line::Line;
use super::walk::Walks;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::motion::precise_point;
use crate::geometry::{DoubleDouble, Motion};
use crate::mesh::HalfedgeId;
use crate::topology::word::Word;
use crate::topology::{HomotopyBasis, SurfaceGroup};

/// A lift of a boundary loop. Where the loop is straight the lift is a line, and the universal cover lies on its left.
#[derive(Debug, Clone)]
pub struct Border {
    /// The number of the loop's generator c_j among those of the group, counted from 0.
    pub generator: usize,
    /// The element that moves the lift along itself by the loop once, the surface on its left: a conjugate of c_j.
    pub element: DeckElement,
    /// A point of the lift in ambient coordinates.
    pub point: [f64; 3],
}

impl Border {
    /// The lift of a boundary loop that the layout has at a half-edge on the boundary, whose origin is the lift by the element `copy`
    /// there.
    pub(super) fn new(
        walks: &Walks<'_>,
        basis: &HomotopyBasis,
        (copy, start): (&Word, HalfedgeId),
        control: &Control,
    ) -> Result<Border> {
        let layout: &Layout = walks.layout();
        let path = layout.mesh().boundary_from(start);
        let around = basis.path_word(layout.mesh(), &path)?;
        let word = basis.group.reduce(&copy.times(&around).times(&copy.inverse()));
        let j = basis.rims.iter().position(|rim| path.contains(rim));
        let torn = || Error::Layout("a boundary loop of the layout has no generator".into());
        Ok(Border {
            generator: 2 * basis.group.genus + j.ok_or_else(torn)?,
            element: DeckElement { word, motion: walks.element(start, &path, control)? },
            point: layout.corner(start),
        })
    }

    /// Its conjugate: the image of the lift under `to`, under the same word.
    pub(super) fn conjugated_by(&self, to: &Motion<DoubleDouble>) -> Border {
        let point = to.apply(precise_point(to.space, self.point)).map(f64::from);
        Border { point, element: self.element.conjugated_by(to), generator: self.generator }
    }

    /// Another lift of the same loop: the image under an element of the group.
    pub(super) fn moved_by(&self, g: &DeckElement, group: &SurfaceGroup) -> Border {
        let word = group.reduce(&g.word.times(&self.element.word).times(&g.word.inverse()));
        let Border { element: DeckElement { motion, .. }, point, generator } = self.conjugated_by(&g.motion);
        Border { element: DeckElement { word, motion }, point, generator }
    }

    /// The line that it is, what is no surface beyond it.
    pub(super) fn line(&self) -> Line {
        let motion = &self.element.motion;
        Line::along(motion, precise_point(motion.space, self.point))
    }
}
