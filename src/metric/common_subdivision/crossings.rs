//! The crossings of the input's edges with the final edges, each with its weights on both.

use super::data::Crossing;
use super::intrinsic::CrossingPlacement;
use super::lines::StraightLines;
use super::triangulations::Triangulations;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::mesh::Curves;

/// The crossings with their places, and the weights of all vertices of a common subdivision.
pub(super) struct PlacedCrossings {
    /// In the order of the curves.
    pub crossings: Vec<Crossing>,
    /// Homogeneous weights of the input's vertices, then of the crossings.
    pub weight: Vec<f64>,
    /// Per crossing, true if it lies off the straight line of the class; empty where the flow started from the input's triangulation.
    pub moved: Vec<bool>,
}

impl PlacedCrossings {
    /// Draw the edges of the input on the final triangulation, on which they are `curves`: straight in the class, or straight on the
    /// surface where the start was another triangulation of it.
    ///
    /// # Errors
    /// Those of [`super::CommonSubdivision::new`].
    pub fn new(
        all: &Triangulations,
        lines: &StraightLines,
        curves: &Curves,
        control: &Control,
    ) -> Result<PlacedCrossings> {
        let (input, result) = (all.input.mesh, all.result);
        let mut placed = lines.crossings(input, curves)?;
        control.check()?;
        let mut moved = Vec::new();
        let placement =
            all.intrinsic.map(|intrinsic| CrossingPlacement::new(intrinsic, lines, control)).transpose()?;
        if let Some(placement) = &placement {
            for e in input.edges() {
                let strip = curves.crossings(e);
                let is_moved = placement.place(e, strip, &mut placed[curves.numbers(e)])?;
                moved.resize(moved.len() + strip.len(), is_moved);
            }
        }
        let mut weight = lines.vertex_weights();
        for (crossing, q) in &placed {
            if !(*q > 0.0 && *q < f64::INFINITY) {
                let vertex = crossing[0].ends[0];
                let need = "nearer to the start: a homogeneous weight on an edge there is out of floating-point range";
                return Err(Error::Domain { vertex: vertex.index(), u: result.metric.u[vertex], need });
            }
            weight.push(*q);
        }
        let mut crossings: Vec<Crossing> = placed.into_iter().map(|(crossing, _)| crossing).collect();
        if placement.is_some() {
            CrossingPlacement::settle(result.mesh, curves, &mut crossings, &mut moved);
        }
        Ok(PlacedCrossings { crossings, weight, moved })
    }
}
