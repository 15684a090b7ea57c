//! Straight lines that bound convex regions of the plane and of the hyperbolic plane.

use super::{DoubleDouble, Motion, Space};

/// Largest distance from a line for which the line's form is evaluated in double-double precision: of points that are farther away, f64
/// shows on which side they lie.
const CLOSE: f64 = 1e-4;

/// A straight line that bounds a region: a linear form of vectors `[x, y, w]` that is positive *beyond* the line, outside the region.
#[derive(Debug, Clone)]
pub(crate) struct BoundingLine {
    form: [DoubleDouble; 3],
    /// The norm of the form: the form over its norm is the distance from the line, in H² the hyperbolic sine of the distance.
    pub norm: f64,
}

impl BoundingLine {
    /// The bisector of the origin and its image `[x, y, w]`: `x X + y Y − h W`, positive nearer to the image.
    pub fn bisector(g: &Motion<DoubleDouble>) -> BoundingLine {
        let [x, y, w] = g.origin();
        let moved = g.displacement();
        let (height, norm) = match g.space {
            Space::H2 => (w - 1.0.into(), 2.0 * (0.5 * moved).sinh()),
            _ => ((x * x + y * y) * 0.5.into(), moved),
        };
        BoundingLine { form: [x, y, -height], norm }
    }

    /// The line along which an isometry translates; what lies to the right of the translation lies beyond it. In the plane a translation
    /// has many such lines, and the one through `point` is taken.
    pub fn along(g: &Motion<DoubleDouble>, point: [DoubleDouble; 3]) -> BoundingLine {
        match g.space {
            // The translation by L along the x axis has a real and b = sinh(L/2), so this form is its axis; conjugating the translation
            // moves the form with the axis.
            Space::H2 => {
                let Motion { a, b, .. } = g.positive();
                BoundingLine { form: [b[1], -b[0], a[1]], norm: (0.5 * g.translation_length()).sinh() }
            }
            _ => {
                let [x, y, _] = g.origin();
                let height = y * point[0] - x * point[1];
                BoundingLine { form: [y, -x, -height], norm: g.displacement() }
            }
        }
    }

    /// The distance by which a point `[x, y, 1]` lies beyond the line, in H² (the Klein disk) its hyperbolic sine; for a point outside the
    /// disk some number of the same sign.
    pub fn beyond(&self, space: Space, p: &[DoubleDouble; 3]) -> f64 {
        let size = match space {
            Space::H2 => {
                let rest = DoubleDouble::from(1.0) - p[0] * p[0] - p[1] * p[1];
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

    /// The value of the form at a vector.
    pub fn value(&self, p: &[DoubleDouble; 3]) -> DoubleDouble {
        self.form[0] * p[0] + self.form[1] * p[1] + self.form[2] * p[2]
    }

    /// The distance by which a point in ambient coordinates lies beyond the line.
    pub fn distance(&self, space: Space, p: &[DoubleDouble; 3]) -> f64 {
        let far = self.value(p).high / self.norm;
        if space == Space::H2 { far.asinh() } else { far }
    }
}
