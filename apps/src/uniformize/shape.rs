//! The result of a uniformization: a surface on the unit sphere, or a quotient of the plane or the hyperbolic plane.

use super::args::CanonicalPictureChoice;
use super::quotient::Uniformized;
use super::sphere::SphereSurface;
use crate::input::Input;
use crate::report::Checks;
use crate::solved::SolvedMetric;

/// A surface in its canonical shape.
pub enum UniformShape {
    Sphere(Box<SphereSurface>),
    Quotient(Box<Uniformized>),
}

pub struct CanonicalOutcome {
    pub input: Input,
    pub shape: UniformShape,
    /// The contents of the picture.
    pub shown: CanonicalPictureChoice,
    /// True if a cover was asked for.
    pub has_copies: bool,
}

impl UniformShape {
    pub fn checks(&self) -> Checks {
        match self {
            UniformShape::Sphere(s) => s.checks(),
            UniformShape::Quotient(u) => u.checks(),
        }
    }

    pub fn solved(&self) -> &SolvedMetric {
        match self {
            UniformShape::Sphere(s) => &s.solved,
            UniformShape::Quotient(u) => &u.solved,
        }
    }
}
