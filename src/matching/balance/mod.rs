//! Harmonic maps of triangulations into flat and hyperbolic surfaces: every vertex at the weighted mean of its neighbours.
//!
//! First the energy with symmetric weights is brought near its minimum ([`relax`]), which Newton's method reaches from anywhere. From there
//! Newton's method reaches the balance by mean value weights, which are not symmetric and belong to no energy ([`settle`]).

mod folds;
mod matrices;
mod solve;
mod springs;
mod system;
mod untangle;
mod weights;

pub(super) use folds::{around, unfold};
pub(super) use solve::{balance, relax, relax_both, settle_both};
pub use springs::BalanceReport;
pub(super) use springs::{EnergyMinimum, Springs, VertexFreedom};
pub(super) use untangle::untangle;
pub(super) use weights::mean_value_weights;
