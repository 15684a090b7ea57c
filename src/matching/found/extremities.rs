//! The extremities of a surface: vertices that are farther from the rest of it than those around them.

use super::sampled::SampledSurface;
use crate::control::Control;
use crate::error::Result;
use crate::mesh::{PerVertex, VertexId};

/// Distance within which an extremity is the most remote vertex, on a surface of area 1: legs are about that far apart at their ends.
const APART: f64 = 0.2;

/// A vertex that is more remote than all around it.
pub(super) struct Extremity {
    pub vertex: VertexId,
    /// Distances to the vertices.
    pub distance: PerVertex<f64>,
    pub descriptor: Vec<f64>,
}

/// At most so many extremities, the most remote first.
///
/// # Errors
/// [`crate::Error::Cancelled`].
pub(super) fn extremities(
    sampled: &SampledSurface<'_>,
    most: usize,
    control: &Control,
) -> Result<Vec<Extremity>> {
    let even = &sampled.even;
    let samples = &even.samples;
    let remote = |i: usize| even.remoteness[samples[i]];
    let is_peak =
        |&i: &usize| (0..samples.len()).all(|j| even.distances[i][j] >= APART || remote(j) <= remote(i));
    let mut peaks: Vec<usize> = (0..samples.len()).filter(is_peak).collect();
    peaks.sort_by(|&i, &j| remote(j).total_cmp(&remote(i)));
    peaks.truncate(most);
    let mesh = even.surface.mesh();
    let extremity = |i: usize| {
        let own = mesh.vertices().filter(|&v| even.nearest[v] as usize == i);
        let higher = |top: VertexId, v| if even.remoteness[v] > even.remoteness[top] { v } else { top };
        let vertex = own.fold(samples[i], higher);
        let distance = even.distances_from(vertex, control)?;
        Ok(Extremity { vertex, distance, descriptor: sampled.descriptor(vertex) })
    };
    peaks.into_iter().map(extremity).collect()
}
