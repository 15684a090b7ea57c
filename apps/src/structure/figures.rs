//! The checks, the figures and the summary of `ricci structure`.

use crate::input::Input;
use crate::report::{Checks, Done, Figures, InputSummary};
use crate::runner::{CommandRun, JobOutcome};
use crate::say;
use ricci::structure::Atlas;
use serde_json::json;

/// Largest error of a transition at a shared vertex, relative to the size of the chart.
const TRANSITION: f64 = 1e-9;
/// Largest difference of transitions at an overlap of three charts.
const COCYCLE: f64 = 1e-9;
/// Largest residual of the relation of the holonomy.
const RELATION: f64 = 1e-8;
/// Largest curvature at a regular vertex, radians.
const CURVATURE: f64 = 1e-10;

pub struct StructureOutcome {
    pub input: Input,
    pub atlas: Atlas,
}

impl JobOutcome for StructureOutcome {
    type Figures = Figures;

    fn checks(&self) -> Checks {
        let atlas = &self.atlas;
        let mut checks = Checks::default();
        checks.add("transition_residual", atlas.transition_residual(), TRANSITION);
        checks.add("cocycle_residual", atlas.cocycles.residual, COCYCLE);
        checks.add("relation_residual", atlas.holonomy.relation_residual, RELATION);
        checks.add("max_curvature_error", atlas.curvature_error, CURVATURE);
        checks.add("folded_charts", atlas.folded.len() as f64, 0.0);
        checks.add("not_converged", f64::from(u8::from(!atlas.converged)), 0.0);
        checks
    }

    fn input(&self) -> Option<InputSummary> {
        Some(InputSummary::of(&self.input))
    }

    fn figures(&self, _: &CommandRun<'_>) -> Figures {
        let atlas = &self.atlas;
        let zeros: Vec<_> = atlas
            .zeros
            .iter()
            .map(|zero| json!({"vertex": zero.vertex.0, "multiplicity": zero.multiplicity}))
            .collect();
        let group = &atlas.holonomy.group;
        let holonomy: serde_json::Map<_, _> = (0..group.n_generators())
            .filter_map(|k| Some((group.name(k), json!(atlas.holonomy.element(atlas.structure, k)?.rows()))))
            .collect();
        Figures::default()
            .with("kind", atlas.structure.name())
            .with("space", atlas.space.name())
            .with("converged", atlas.converged)
            .with("charts", atlas.charts.len())
            .with("transitions", atlas.transitions.len())
            .with("triples", atlas.cocycles.triples)
            .with("transition_residual", atlas.transition_residual())
            .with("cocycle_residual", atlas.cocycles.residual)
            .with("relation_residual", atlas.holonomy.relation_residual)
            .with("holonomy", holonomy)
            .with("max_curvature_error", atlas.curvature_error)
            .with("singular_vertices", atlas.singular_vertices.iter().map(|v| v.0).collect::<Vec<_>>())
            .with("excluded_faces", atlas.excluded.len())
            .with("zeros", zeros)
            .with("folded_charts", atlas.folded.clone())
    }

    fn summary(&self, done: &Done) -> String {
        let StructureOutcome { input, atlas } = self;
        let singular = match atlas.singular_vertices.as_slice() {
            [] => "no singular vertex".into(),
            [v] => format!("one singular vertex, {v}"),
            all => say::count(all.len(), "singular vertex", "singular vertices"),
        };
        let text = format!(
            "{}atlas    {} in {}, {}, {}; {singular}\nerrors   transitions {:.1e}, cocycles {:.1e}, holonomy {:.1e}\n",
            say::surface(input),
            atlas.structure,
            atlas.space,
            say::count(atlas.charts.len(), "chart", "charts"),
            say::count(atlas.transitions.len(), "transition", "transitions"),
            atlas.transition_residual(),
            atlas.cocycles.residual,
            atlas.holonomy.relation_residual,
        );
        text + &say::finish(done)
    }
}
