//! The result of a uniformization: a surface on the unit sphere, or a quotient of the plane or the hyperbolic plane.

use super::args::CanonicalPictureChoice;
use super::quotient::Uniformized;
use super::sphere::SphereSurface;
use crate::input::Input;
use crate::report::Checks;
use crate::solved::SolvedMetric;

/// A surface in its canonical shape.
pub enum CanonicalShape {
    Sphere(Box<SphereSurface>),
    Quotient(Box<Uniformized>),
}

pub struct CanonicalOutcome {
    pub input: Input,
    pub shape: CanonicalShape,
    /// The contents of the picture.
    pub shown: CanonicalPictureChoice,
    /// True if a cover was asked for.
    pub has_copies: bool,
}

impl CanonicalShape {
    pub fn checks(&self) -> Checks {
        match self {
            CanonicalShape::Sphere(s) => s.checks(),
            CanonicalShape::Quotient(u) => u.checks(),
        }
    }

    pub fn solved(&self) -> &SolvedMetric {
        match self {
            CanonicalShape::Sphere(s) => &s.solved,
            CanonicalShape::Quotient(u) => &u.solved,
        }
    }
}
