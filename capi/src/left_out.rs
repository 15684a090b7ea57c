//! Types in place of those of parts of the library that a build leaves out.
#![allow(dead_code)]

/// In place of handles that nobody can have.
pub enum SeamlessLeftOut {}
pub enum QuadsLeftOut {}
pub enum QuadLayoutLeftOut {}
pub enum QuadSplineLeftOut {}
pub enum SplineLeftOut {}

/// In place of the library's `Wrap`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WrapLeftOut {
    Repeat,
    Mirror,
    Clamp,
}

/// In place of the library's `LengthUnit`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum UnitLeftOut {
    Millimetre,
    Metre,
}

/// In place of the library's `StepOptions`.
#[derive(Debug, Clone)]
pub struct StepLeftOut {
    pub name: String,
    pub unit: UnitLeftOut,
    pub colours: bool,
}
