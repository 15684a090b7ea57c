//! A surface in its canonical shape.

use super::quotient::Uniformized;
use super::sphere::Round;
use crate::report::Checks;
use crate::solved::Solved;

/// A surface in its canonical shape.
pub enum Shape {
    Sphere(Box<Round>),
    Quotient(Box<Uniformized>),
}

impl Shape {
    pub fn checks(&self) -> Checks {
        match self {
            Shape::Sphere(s) => s.checks(),
            Shape::Quotient(u) => u.checks(),
        }
    }

    pub fn solved(&self) -> &Solved {
        match self {
            Shape::Sphere(s) => &s.solved,
            Shape::Quotient(u) => &u.solved,
        }
    }

    pub fn solved_mut(&mut self) -> &mut Solved {
        match self {
            Shape::Sphere(s) => &mut s.solved,
            Shape::Quotient(u) => &mut u.solved,
        }
    }
}
