//! The crossings of the input's edges with the final edges, each with its weights on both.

use super::intrinsic::Placement;
use super::lines::Lines;
use super::parts::Crossing;
use super::triangulations::Triangulations;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::mesh::Curves;

/// The vertices of a refinement.
pub(super) struct Drawn {
    /// In the order of the curves.
    pub crossings: Vec<Crossing>,
    /// Homogeneous weights of the input's vertices, then of the crossings.
    pub weight: Vec<f64>,
    /// Per crossing, whether it lies off the straight line of the class; empty where the flow started from the input's triangulation.
    pub moved: Vec<bool>,
}

impl Drawn {
    /// Draw the edges of the input on the final triangulation, on which they are `curves`: straight in the class, or straight on the
    /// surface where the start was another triangulation of it.
    ///
    /// # Errors
    /// Those of [`super::Refinement::new`].
    pub fn new(all: &Triangulations, lines: &Lines, curves: &Curves, control: &Control) -> Result<Drawn> {
        let (input, result) = (all.input.mesh, all.result);
        let mut placed = lines.crossings(input, curves)?;
        control.check()?;
        let mut moved = Vec::new();
        let placement =
            all.intrinsic.map(|intrinsic| Placement::new(intrinsic, lines, control)).transpose()?;
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
                let vertex = crossing.input_ends[0];
                let need = "nearer to the start: a homogeneous weight on an edge there is beyond doubles";
                return Err(Error::Domain { vertex: vertex.index(), u: result.metric.u[vertex], need });
            }
            weight.push(*q);
        }
        let mut crossings: Vec<Crossing> = placed.into_iter().map(|(crossing, _)| crossing).collect();
        if placement.is_some() {
            Placement::settle(result.mesh, curves, &mut crossings, &mut moved);
        }
        Ok(Drawn { crossings, weight, moved })
    }
}
