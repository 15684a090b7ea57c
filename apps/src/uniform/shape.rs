//! A surface in its canonical shape.

use super::quotient::Uniformized;
use super::sphere::Round;
use crate::report::{Attempts, Checks};

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

    pub fn failed(&self) -> &Attempts {
        match self {
            Shape::Sphere(s) => &s.failed,
            Shape::Quotient(u) => &u.failed,
        }
    }
}
