//! The checks, the figures and the summary of `ricci brain`.

use super::outcome::{BrainOutcome, Hemisphere, Made};
use crate::flatten::distortion;
use crate::report::{Checks, Done, Figures, path_text};
use crate::runner::{CommandRun, JobOutcome};
use crate::say;
use serde_json::{Value, json};

impl BrainOutcome {
    fn new_ones(&self) -> impl Iterator<Item = &Hemisphere> {
        self.made.iter().filter_map(|made| match made {
            Made::New(hemisphere) => Some(&**hemisphere),
            Made::Kept { .. } => None,
        })
    }

    fn turned(&self) -> Vec<[usize; 2]> {
        self.written_turned.lock().map(|turned| turned.clone()).unwrap_or_default()
    }
}

impl JobOutcome for BrainOutcome {
    type Figures = Figures;

    fn checks(&self) -> Checks {
        let mut checks = Checks::default();
        let ended = self.new_ones().flat_map(Hemisphere::reports);
        let not_converged = ended.filter(|(_, report)| !report.converged()).count();
        checks.add("not_converged", not_converged as f64, 0.0);
        let turned = self.turned();
        for (k, name) in ["turned_on_sphere_in_file", "turned_in_patch_in_file"].into_iter().enumerate() {
            checks.add(name, turned.iter().map(|pair| pair[k]).sum::<usize>() as f64, 0.0);
        }
        checks
    }

    fn figures(&self, run: &CommandRun<'_>) -> Figures {
        let mut turned = self.turned().into_iter();
        let rows: Vec<Value> = self
            .made
            .iter()
            .map(|made| match made {
                Made::New(of) => {
                    let [on_sphere, in_patch] = turned.next().unwrap_or_default();
                    let mut row = json!({
                        "hemisphere": of.side.short(),
                        "path": path_text(&of.path),
                        "vertices": of.surface.mesh().n_vertices(),
                        "cortex_vertices": of.cortex.origins.len(),
                        "turned_on_sphere_in_file": on_sphere,
                        "turned_in_patch_in_file": in_patch,
                    });
                    for (name, report) in of.reports() {
                        row[name] = json!({
                            "start": report.start.name(),
                            "stop_reason": report.stop.name(),
                            "iterations": report.iterations(),
                            "newton_decrement": report.decrement,
                            "before": distortion(&report.before),
                            "after": distortion(&report.after),
                            "overlap": report.overlap,
                            "one_to_one": report.one_to_one,
                            "seconds": report.seconds,
                        });
                    }
                    row
                }
                Made::Kept { side, path } => {
                    json!({"hemisphere": side.short(), "path": path_text(path), "kept": true})
                }
            })
            .collect();
        Figures::default()
            .with("radius", self.radius)
            .with("hemispheres", rows)
            .failed(&run.failed)
            .with("left_out", run.outputs.left_out())
    }

    fn summary(&self, done: &Done) -> String {
        let mut text = String::new();
        for made in &self.made {
            match made {
                Made::Kept { side, path } => {
                    text += &format!("{}       {}: its files are there\n", side.short(), path.display());
                }
                Made::New(of) => {
                    let n = of.surface.mesh().n_vertices();
                    text += &format!(
                        "{}       {}: {}, {} of them cortex\n",
                        of.side.short(),
                        of.path.display(),
                        say::count(n, "vertex", "vertices"),
                        of.cortex.origins.len()
                    );
                    for (name, report) in of.reports() {
                        let after = &report.after;
                        text += &format!(
                            "{name:8} {} after {} steps: energy {:.4}, lengths off by {:.1} % in the mean, areas by {:.1} %, dilatation {:.3}\n",
                            report.stop.name(),
                            report.iterations(),
                            after.energy,
                            100.0 * after.mean_length_error,
                            100.0 * after.mean_area_error,
                            after.mean_dilatation
                        );
                    }
                }
            }
        }
        text + &say::finish(done)
    }
}
