//! Lines that are straight in the class of the final metric, and their crossings with the final edges.

use super::data::{Crossing, EdgePoint};
use super::strip::{RawCrossing, Strips};
use super::triangulations::{FinalTriangulation, InputTriangulation};
use crate::error::{Error, Result};
use crate::geometry::Space;
use crate::geometry::conformal::Vertex;
use crate::mesh::{Curves, EdgeId, HalfedgeId, Mesh, PerVertex, VertexId};

/// Lines that are straight in the class of the final metric.
pub(super) struct StraightLines<'a> {
    /// Geometry of the input.
    pub geometry: Space,
    pub result: &'a FinalTriangulation<'a>,
    strips: Strips<'a>,
    scales: Scales,
}

impl<'a> StraightLines<'a> {
    /// # Errors
    /// [`Error::Domain`] at a vertex outside the domain of either metric.
    pub fn new(input: InputTriangulation, result: &'a FinalTriangulation<'a>) -> Result<StraightLines<'a>> {
        let scales = Scales::new(input, *result)?;
        Ok(StraightLines { geometry: input.geometry, result, strips: Strips::new(result), scales })
    }

    /// Homogeneous weights of the input's vertices.
    pub fn vertex_weights(&self) -> Vec<f64> {
        self.scales.vertices()
    }

    /// The crossings of the edges of a triangulation, which are `curves` on the final one, drawn straight in the class; each with its
    /// homogeneous weight.
    ///
    /// # Errors
    /// [`Error::EdgeWeight`] where imaginary circles leave no straight line.
    pub fn crossings(&self, mesh: &Mesh, curves: &Curves) -> Result<Vec<(Crossing, f64)>> {
        let ends: Vec<_> = mesh.edges().map(|e| mesh.ends(e)).collect();
        let raw = self.strips.crossings(&ends, curves)?;
        let mut all = Vec::with_capacity(raw.len());
        for e in mesh.edges() {
            for (raw, at) in raw[curves.numbers(e)].iter().zip(curves.crossings(e)) {
                all.push(self.scales.crossing(raw, (e, ends[e.index()]), at.halfedge, self.result.mesh));
            }
        }
        Ok(all)
    }
}

/// `log s` per vertex, in the input and in the final metric, where the vector s v stands for the position of the vertex of vector v.
struct Scales {
    input: Vec<f64>,
    result: Vec<f64>,
}

impl Scales {
    fn new(input: InputTriangulation, result: FinalTriangulation) -> Result<Scales> {
        let metric = result.metric;
        let log = |space: Space, u: &PerVertex<f64>| -> Result<Vec<f64>> {
            let scale = |v: usize| {
                let v = VertexId::from(v);
                let d = || Vertex::new(space, metric.epsilon[v], u[v]).d;
                let s = if space == Space::E2 { u[v] } else { std::f64::consts::LN_2 + u[v] - d().ln() };
                let need = "inside the metric's domain";
                if s.is_finite() { Ok(s) } else { Err(Error::Domain { vertex: v.index(), u: u[v], need }) }
            };
            (0..u.len()).map(scale).collect()
        };
        Ok(Scales { input: log(input.geometry, input.u)?, result: log(metric.space, &metric.u)? })
    }

    /// Homogeneous weights of the input's vertices.
    fn vertices(&self) -> Vec<f64> {
        self.input.iter().zip(&self.result).map(|(a, b)| (a - b).exp()).collect()
    }

    /// A crossing of the edge `e` with the final half-edge `at`, and its homogeneous weight.
    fn crossing(
        &self,
        raw: &RawCrossing,
        (e, ends): (EdgeId, [VertexId; 2]),
        at: HalfedgeId,
        mesh: &Mesh,
    ) -> (Crossing, f64) {
        // From weights of vectors those of positions, divided by their sum, and the logarithm of that sum.
        let positions = |w: [f64; 2], exponent: [i32; 2], ends: [VertexId; 2], scale: &[f64]| {
            let log = [0, 1].map(|k| {
                w[k].ln() + f64::from(exponent[k]) * std::f64::consts::LN_2 - scale[ends[k].index()]
            });
            let top = log[0].max(log[1]);
            let x = log.map(|x| (x - top).exp());
            (x.map(|w| w / (x[0] + x[1])), (x[0] + x[1]).ln() + top)
        };
        let along = [mesh.origin(at), mesh.tip(at)];
        let (input_weights, below) = positions(raw.meeting.diagonal, raw.exponent, ends, &self.input);
        let (final_weights, above) = positions(raw.meeting.edge, [0; 2], along, &self.result);
        let swap = at.0 & 1 == 1;
        let turned = |x: [f64; 2]| if swap { [x[1], x[0]] } else { x };
        let on_input = EdgePoint { edge: e, ends, weights: input_weights };
        let weights = turned(final_weights);
        let on_final = EdgePoint { edge: at.edge(), ends: mesh.ends(at.edge()), weights };
        ([on_input, on_final], (above - below).exp())
    }
}
