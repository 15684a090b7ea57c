//! The conditions of a harmonic map, and the outcome of the search for it.

use crate::archive::stored;
use crate::matching::options::BoundaryMatching;
use crate::mesh::{Mesh, PerHalfedge, PerVertex, VertexId};

/// The directions in which a vertex may move.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum VertexFreedom {
    /// All directions.
    Free,
    /// Along the x axis of its frame, on both sides of which the surface continues as its mirror image.
    Slides,
    /// None.
    Held,
}

impl VertexFreedom {
    /// The freedom of the vertices of a surface without marks.
    pub fn of(mesh: &Mesh, boundary: BoundaryMatching) -> PerVertex<VertexFreedom> {
        PerVertex::from_fn(mesh.n_vertices(), |v: VertexId| match (mesh.is_boundary_vertex(v), boundary) {
            (false, _) => VertexFreedom::Free,
            (true, BoundaryMatching::Slides) => VertexFreedom::Slides,
            (true, BoundaryMatching::ArcLength) => VertexFreedom::Held,
        })
    }
}

/// The conditions of a harmonic map: positive weights of the neighbours at each vertex, and the directions in which vertices may move.
#[derive(Clone, Copy)]
pub(crate) struct Springs<'a> {
    pub weights: &'a PerHalfedge<f64>,
    pub freedom: &'a PerVertex<VertexFreedom>,
}

/// The least energy of a map, and the Newton steps to it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct EnergyMinimum {
    pub steps: usize,
    pub energy: f64,
}

/// Steps and residual of the search for a balance.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct BalanceReport {
    /// Newton steps that lowered the energy with symmetric weights.
    pub energy_steps: usize,
    /// That energy, `½ Σ w r²`, at its minimum.
    pub energy: f64,
    /// Newton steps to the balance by mean value weights.
    pub balance_steps: usize,
    /// Largest distance of a vertex from the mean of its neighbours, as a share of their mean distance.
    pub residual: f64,
}
stored!(sections BalanceReport { energy_steps, energy, balance_steps, residual });
