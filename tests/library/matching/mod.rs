//! Maps between two surfaces, by theorem.

mod boundary;
mod class;
mod corpus;
mod errors;
mod known;
mod landmarks;
mod overlay;
mod round;
mod samples;
