//! Harmonic 1-forms, holomorphic forms and harmonic maps, by theorem.

mod factor;
mod forms;
mod known;
mod maps;
mod open;
mod operators;
mod samples;
mod trajectories;
mod zeros;
