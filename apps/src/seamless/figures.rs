//! The checks, the figures and the summary of `ricci seamless`.

use crate::input::Input;
use crate::report::{Checks, Done, Figures, InputSummary};
use crate::runner::{CommandRun, JobOutcome};
use crate::say;
use crate::solved::SolvedMetric;
use crate::surface_layout::SurfaceLayout;
use ricci::seamless::{CrossField, Seamless};
use serde_json::json;
use std::collections::BTreeMap;

/// Largest distance, over the diameter of the map, by which a corner was moved to make the seams exact.
const MOVED: f64 = 1e-9;

/// Largest angle, radians, between an axis and a feature: angles off by up to 1e-10 each add up over the corners from one feature to another.
const STRAIGHT: f64 = 1e-7;

pub struct SeamlessOutcome {
    pub input: Input,
    pub found: Seamless,
    /// The map; why there is none, where it could not be made.
    pub map: Result<WrittenMap, String>,
    pub metric: SolvedMetric,
    /// The symmetric Dirichlet energy of the map without isometric steps.
    pub energy_before: Option<f64>,
    /// The field of four directions, if it is to be written.
    pub field: Option<CrossField>,
}

/// The layout of a seamless metric, with exact seams.
pub struct WrittenMap {
    pub laid: SurfaceLayout,
    /// The largest distance by which a corner was moved to make the seams exact.
    pub moved: f64,
    /// Largest angle, radians, between an axis and an edge of the boundary or a feature, once the map is turned to it; 0 without any.
    pub bend: f64,
}

impl JobOutcome for SeamlessOutcome {
    type Figures = Figures;

    fn checks(&self) -> Checks {
        let SeamlessOutcome { found, map, metric, .. } = self;
        let mut checks = metric.checks(found.tolerance);
        checks.add("holonomy_error", found.error, found.tolerance);
        if let Some(check) = checks.0.get_mut("holonomy_error").filter(|check| !check.holds) {
            check.remedy = Some(
                "other cones or another --turning may be reached; whether a metric with this signature exists is not known".into(),
            );
        }
        if let Ok(map) = map {
            map.laid.check_flipped(&mut checks);
            if !found.features.is_empty() {
                checks.add("straightness", map.bend, STRAIGHT);
            }
            checks.add("moved_corners", map.moved / map.laid.layout.diameter, MOVED);
        }
        checks
    }

    fn input(&self) -> Option<InputSummary> {
        Some(InputSummary::of(&self.input))
    }

    fn figures(&self, run: &CommandRun<'_>) -> Figures {
        let SeamlessOutcome { found, map, metric, .. } = self;
        let cones: Vec<_> = found
            .cones
            .iter()
            .map(|cone| json!({"vertex": cone.vertex.0, "valence": cone.valence}))
            .collect();
        let energy = map.as_ref().ok().map(|map| map.laid.quality.symmetric_dirichlet);
        Figures::of_metric(metric)
            .with("converged", found.converged())
            .with("cones", cones)
            .with("holonomy", found.quarter_turns.clone())
            .with("holonomy_error", found.error)
            .with("length_changes", found.length_changes)
            .with("symmetric_dirichlet", [self.energy_before, energy])
            .with("straight_edges", found.features.len())
            .with("features_left_out", found.left_out.len())
            .with("straightness", map.as_ref().ok().map(|map| map.bend))
            .with("iterations", found.iterations[0] + found.iterations[1])
            .with("newton_iterations", found.iterations[1])
            .with("flips", found.solution.flips())
            .with("max_curvature_error", metric.curvature_error())
            .with("flipped_triangles", map.as_ref().ok().map(|map| map.laid.flipped().len()))
            .distortion(map.as_ref().ok().map(|map| &map.laid))
            .missing(run)
    }

    fn summary(&self, done: &Done) -> String {
        let SeamlessOutcome { input, found, map, .. } = self;
        let mut valences = BTreeMap::new();
        found.cones.iter().for_each(|cone| *valences.entry(cone.valence).or_insert(0) += 1);
        let valences: Vec<_> =
            valences.iter().map(|(valence, n)| format!("{n} of valence {valence}")).collect();
        let [flow, newton] = found.iterations;
        let mut text = format!(
            "{}cones    {}{}\nmetric   {} in {flow} + {newton} iterations, angles off by {:.1e}\n",
            say::surface(input),
            say::count(found.cones.len(), "cone", "cones"),
            if valences.is_empty() { String::new() } else { format!(": {}", valences.join(", ")) },
            if found.converged() { "converged" } else { "NOT converged" },
            found.error,
        );
        if !found.features.is_empty() {
            let left_out = match found.left_out.len() {
                0 => String::new(),
                n => format!("; {n} sharp edges left out"),
            };
            text += &format!(
                "lines    {}{left_out}\n",
                say::count(found.features.len(), "straight edge", "straight edges")
            );
        }
        if let Ok(map) = map {
            let quality = &map.laid.quality;
            text += &format!(
                "map      dilatation mean {:.4} max {:.4}; area ratios {:.3e} to {:.3e}; {}; {}\n",
                quality.qc_mean,
                quality.qc_max,
                quality.area_ratio_min,
                quality.area_ratio_max,
                say::count(map.laid.flipped().len(), "triangle flipped", "triangles flipped"),
                say::count(map.laid.degenerate.len(), "degenerate piece", "degenerate pieces"),
            );
        }
        text + &say::ending(input, done, true)
    }
}
