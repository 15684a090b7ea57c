//! Straight lines of the plane and of the hyperbolic plane, with one side *beyond* each.

use crate::geometry::{DoubleDouble, Motion, Space};

/// Value of a form, as a distance, below which it is evaluated again with twice the digits; doubles give the sign of larger ones.
const CLOSE: f64 = 1e-4;

/// A straight line, as a linear form of vectors `[x, y, w]` that is positive beyond it.
#[derive(Debug, Clone)]
pub(super) struct Line {
    form: [DoubleDouble; 3],
    /// The form's norm: form over norm is distance (H²: its hyperbolic sine).
    pub norm: f64,
}

impl Line {
    /// The bisector of the origin and its image `[x, y, w]`: `x X + y Y − h W`, positive nearer to the image.
    pub fn bisector(g: &Motion<DoubleDouble>) -> Line {
        let [x, y, w] = g.origin();
        let moved = g.displacement();
        let (height, norm) = match g.space {
            Space::H2 => (w - 1.0.into(), 2.0 * (0.5 * moved).sinh()),
            _ => ((x * x + y * y) * 0.5.into(), moved),
        };
        Line { form: [x, y, -height], norm }
    }

    /// The line along which an isometry translates, the right of its direction beyond it. In the plane translations have no line of their
    /// own, and it is that through `point`.
    pub fn along(g: &Motion<DoubleDouble>, point: [DoubleDouble; 3]) -> Line {
        match g.space {
            // Of the translation along the x axis, a real and b = sinh(L/2): conjugates have the axis that the form says.
            Space::H2 => {
                let Motion { a, b, .. } = g.positive();
                Line { form: [b[1], -b[0], a[1]], norm: (0.5 * g.translation_length()).sinh() }
            }
            _ => {
                let [x, y, _] = g.origin();
                let height = y * point[0] - x * point[1];
                Line { form: [y, -x, -height], norm: g.displacement() }
            }
        }
    }

    /// How far a point `[x, y, 1]` lies beyond the line: the distance, in H² (the Klein disk) its hyperbolic sine; for a point outside the
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

    /// The form.
    pub fn value(&self, p: &[DoubleDouble; 3]) -> DoubleDouble {
        self.form[0] * p[0] + self.form[1] * p[1] + self.form[2] * p[2]
    }

    /// How far beyond the line a point in ambient coordinates lies: a distance.
    pub fn distance(&self, space: Space, p: &[DoubleDouble; 3]) -> f64 {
        let far = self.value(p).high / self.norm;
        if space == Space::H2 { far.asinh() } else { far }
    }
}
