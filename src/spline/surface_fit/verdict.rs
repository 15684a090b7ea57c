//! What a fit misses: by how much, where, and the vertex where it is worst.

use super::areas::{area_share, vertex_areas};
use super::fit::SurfaceFit;
use super::setting::RMS;
use crate::mesh::VertexId;
use crate::metric::Surface;

/// A condition on a fit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FitCondition {
    /// The root mean square distance is at most a tenth of the tolerance.
    RootMeanSquare,
    /// The largest distance is at most the tolerance.
    Largest,
    /// No patch folds.
    Folds,
}

/// A condition that a fit does not meet.
#[derive(Debug, Clone, PartialEq)]
pub struct FitFailure {
    /// The condition.
    pub condition: FitCondition,
    /// The value: a distance over the diagonal, or the number of patches that fold.
    pub value: f64,
    /// The largest value at which the condition holds.
    pub limit: f64,
    /// The share of the surface's area that belongs to the vertices where it fails: those farther away than the limit, or in patches that
    /// fold.
    pub share: f64,
    /// The patches with such vertices, ascending; of folds, all that fold.
    pub patches: Vec<usize>,
    /// The vertex that is farthest away among them; none in patches without vertices.
    pub vertex: Option<VertexId>,
}

impl SurfaceFit {
    /// The conditions that the fit does not meet, for a tolerance over the diagonal as in
    /// [`super::SurfaceFitOptions::tolerance`]. `surface`: that which was fitted.
    pub fn failures(&self, surface: &Surface, tolerance: f64) -> Vec<FitFailure> {
        let areas = vertex_areas(surface.mesh(), surface.lengths());
        let limits = [
            (FitCondition::RootMeanSquare, self.rms, RMS * tolerance),
            (FitCondition::Largest, self.max, tolerance),
        ];
        let failure = |condition, value, limit, is_there: &dyn Fn(usize) -> bool| {
            let vertices: Vec<usize> = (0..self.places.len()).filter(|&v| is_there(v)).collect();
            let mut patches: Vec<usize> = vertices.iter().map(|&v| self.places[v].patch as usize).collect();
            patches.sort_unstable();
            patches.dedup();
            let worst = vertices.iter().max_by(|&&u, &&v| self.distances[u].total_cmp(&self.distances[v]));
            let vertex = worst.map(|&v| VertexId(v as u32));
            FitFailure { condition, value, limit, share: area_share(&areas, is_there), patches, vertex }
        };
        let mut found: Vec<FitFailure> = limits
            .into_iter()
            .filter(|(_, value, limit)| value > limit)
            .map(|(condition, value, limit)| failure(condition, value, limit, &|v| self.distances[v] > limit))
            .collect();
        if !self.folds.is_empty() {
            let folds = failure(FitCondition::Folds, self.folds.len() as f64, 0.0, &|v| self.is_folded(v));
            found.push(FitFailure { patches: self.folds.clone(), ..folds });
        }
        found
    }
}
