//! The checks, the figures and the summary of the flows of several components.

use crate::figures::of_flow;
use crate::flow_summary::layout;
use crate::job::FlowOutcome;
use crate::report::{Check, Checks, Done, Figures, InputSummary};
use crate::runner::{CommandRun, JobOutcome};
use crate::say::{count, finish};
use ricci::mesh::io::Soup;
use serde_json::Value;

/// The flow of one component, with the numbers of its elements in the file.
pub struct ComponentFlow {
    pub outcome: FlowOutcome,
    pub vertices: Vec<u32>,
    pub faces: Vec<u32>,
}

/// The flows of all components of a file, those with the most faces first.
pub struct ComponentsOutcome {
    /// The positions and faces of the file.
    pub soup: Soup,
    pub summary: InputSummary,
    pub flows: Vec<ComponentFlow>,
}

impl JobOutcome for ComponentsOutcome {
    type Figures = Figures;

    /// Each check of a component where its value is largest beside its limit.
    fn checks(&self) -> Checks {
        let mut worst = Checks::default();
        let is_worse = |a: &Check, b: &Check| {
            (!a.holds && b.holds) || (a.holds == b.holds && a.value * b.limit > b.value * a.limit)
        };
        for flow in &self.flows {
            for (name, check) in flow.outcome.checks().0 {
                if worst.0.get(name).is_none_or(|known| is_worse(&check, known)) {
                    worst.0.insert(name, check);
                }
            }
        }
        worst
    }

    fn input(&self) -> Option<InputSummary> {
        Some(self.summary.clone())
    }

    fn figures(&self, run: &CommandRun<'_>) -> Figures {
        let row = |(k, flow): (usize, &ComponentFlow)| {
            let mesh = flow.outcome.input.mesh();
            let row = Figures::default()
                .with("component", k)
                .with("vertices", mesh.n_vertices())
                .with("faces", mesh.n_faces())
                .with("euler", mesh.euler())
                .with("boundary_loops", mesh.boundary_loops().len())
                .with("first_vertex", flow.vertices.first().copied())
                .with("first_face", flow.faces.first().copied())
                .and(&of_flow(&flow.outcome, run));
            serde_json::to_value(row).unwrap_or(Value::Null)
        };
        let flipped =
            |flow: &ComponentFlow| flow.outcome.layout.as_ref().map_or(0, |laid| laid.flipped().len());
        Figures::default()
            .with("converged", self.flows.iter().all(|flow| flow.outcome.report.converged()))
            .with("flipped_triangles", self.flows.iter().map(flipped).sum::<usize>())
            .with("components", self.flows.iter().enumerate().map(row).collect::<Vec<_>>())
            .missing(run)
    }

    fn summary(&self, done: &Done) -> String {
        let counts = &self.summary.counts;
        let mut text = format!(
            "surfaces {}: {}, {}, {}\n",
            self.summary.path,
            count(counts.components, "component", "components"),
            count(counts.vertices, "vertex", "vertices"),
            count(counts.faces, "face", "faces")
        );
        for (k, ComponentFlow { outcome, .. }) in self.flows.iter().enumerate() {
            let report = &outcome.report;
            text += &format!(
                "{k:<8} {}, target {}: {} after {}, max |K − K̄| = {:.1e}\n",
                count(outcome.input.mesh().n_faces(), "face", "faces"),
                outcome.rule.name(),
                report.stop_reason,
                count(report.iterations, "step", "steps"),
                report.max_curvature_error
            );
            text += &match &outcome.layout {
                Ok(laid) => format!("layout   {}\n", layout(laid)),
                Err(why) => format!("layout   none: {why}\n"),
            };
        }
        text + &finish(done)
    }
}
