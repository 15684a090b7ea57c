//! Scaling and moving of layouts, and the points of a layout in double-double precision.

use super::layout::{Layout, bounding_diagonal, flat, radius};
use crate::error::{Error, Result};
use crate::geometry::motion::precise_point;
use crate::geometry::{DoubleDouble, Motion, Space};

impl Layout {
    /// [`Layout::points`] number k in double-double precision, as far as the layout knows it: in H² rounding to f64 moves a point by
    /// e^distance ulp.
    pub(crate) fn precise_point(&self, k: usize) -> [DoubleDouble; 3] {
        let [x, y] = self.remainders.get(k).copied().unwrap_or([0.0; 2]);
        let point = precise_point(self.space, self.points[k]);
        if [x, y] == [0.0; 2] || self.space == Space::S2 {
            return point;
        }
        let [x, y] = [point[0].plus(x), point[1].plus(y)];
        let one = DoubleDouble::from(1.0);
        [x, y, if self.space == Space::H2 { (one + x * x + y * y).sqrt() } else { one }]
    }

    /// Scales a layout in E² so that its area is `area` (finite, positive); the result is the factor on lengths.
    ///
    /// # Errors
    /// [`Error::Argument`] for an area that is not finite and positive; [`Error::Layout`] in another space, whose curvature fixes the
    /// scale.
    pub fn scale_to_area(&mut self, area: f64) -> Result<f64> {
        if self.space != Space::E2 {
            return Err(Error::Layout(format!("a layout in {} has the scale of its space", self.space)));
        }
        let factor = (area / self.area).sqrt();
        if !(factor.is_finite() && factor > 0.0) {
            let need = "the layout's area and the one asked for must be finite and positive";
            return Err(Error::Argument { what: "area", value: area.to_string(), need });
        }
        self.scale_by(factor);
        self.area = area;
        self.find_flat();
        Ok(factor)
    }

    /// Moves a layout in E² by an isometry.
    ///
    /// # Errors
    /// [`Error::Layout`] in another space.
    pub fn move_by(&mut self, motion: &Motion<DoubleDouble>) -> Result<()> {
        if self.space != Space::E2 || motion.space != Space::E2 {
            return Err(Error::Layout(format!("a layout in {} stays about its base", self.space)));
        }
        let moved = |k| motion.apply(self.precise_point(k));
        let moved: Vec<[DoubleDouble; 3]> = (0..self.points.len()).map(moved).collect();
        let place = |p: &[f64; 3]| motion.apply(precise_point(Space::E2, *p)).map(f64::from);
        self.points = self.points.iter().map(place).collect();
        self.set_remainders(&moved);
        self.coordinates = self.points.iter().map(|&p| flat(Space::E2, p)).collect();
        self.seams.iter_mut().for_each(|seam| seam.pairing = seam.pairing.conjugated_by(motion));
        self.frames.iter_mut().for_each(|frame| *frame = motion.compose(frame));
        // Reported disagreements are relative to the diameter, which depends on the axes.
        let diameter = bounding_diagonal(&self.coordinates);
        self.seams.iter_mut().for_each(|seam| seam.residual *= self.diameter / diameter);
        self.diameter = diameter;
        self.radius = radius(Space::E2, &self.points);
        self.find_flat();
        Ok(())
    }

    pub(super) fn scale_by(&mut self, factor: f64) {
        if factor == 1.0 {
            return;
        }
        self.coordinates.as_flattened_mut().iter_mut().for_each(|x| *x *= factor);
        self.remainders.resize(self.points.len(), [0.0; 2]);
        for (p, rest) in self.points.iter_mut().zip(&mut self.remainders) {
            for k in 0..2 {
                let precise = DoubleDouble::from(p[k]).plus(rest[k]) * factor.into();
                p[k] *= factor;
                rest[k] = precise.plus(-p[k]).high;
            }
        }
        let pairings = self.seams.iter_mut().map(|seam| &mut seam.pairing);
        pairings.chain(&mut self.frames).for_each(|m| m.b = m.b.map(|x| x * factor.into()));
        self.disagreement *= factor;
        self.radius *= factor;
        self.diameter *= factor;
        self.scale *= factor;
        self.area *= factor * factor;
    }

    /// Sets the low parts of the points in double-double precision.
    fn set_remainders(&mut self, precise: &[[DoubleDouble; 3]]) {
        let rest = |(p, q): (&[DoubleDouble; 3], &[f64; 3])| [0, 1].map(|k| p[k].plus(-q[k]).high);
        self.remainders = precise.iter().zip(&self.points).map(rest).collect();
    }
}
