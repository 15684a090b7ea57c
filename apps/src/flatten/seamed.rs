//! Surfaces with handles or cones laid flat: cut open along seams that stay rotations by multiples of 90°.

use super::args::{EnergyChoice, FlattenArgs};
use crate::failure::Failure;
use crate::input::Input;
use crate::progress::doing;
use crate::runner::CommandRun;
use crate::seamless::{ConesChoice, chosen_cones};
use ricci::control::Stage;
use ricci::flatten::{FlattenOptions, SeamlessFlattening, flatten_seamless};
use ricci::mesh::Mesh;
use ricci::seamless::{ConeValence, SeamlessOptions, seamless};
use serde_json::{Value, json};

/// The part of the progress that the seamless metric fills.
const OF_METRIC: f64 = 0.4;

/// A surface that is laid flat with seams.
pub struct SeamedMap {
    pub map: SeamlessFlattening,
    pub cones: Vec<ConeValence>,
    pub quarter_turns: Vec<i32>,
    /// The numbers of vertices that split edges have added.
    pub n_added: usize,
}

impl FlattenArgs {
    /// Refuses what is for maps without seams alone.
    pub fn check_seamed(&self) -> Result<(), Failure> {
        let refused = [
            ("--label", self.label.is_some()),
            ("--injective", self.injective),
            ("--pin", self.pin.is_some()),
            ("--straight", self.straight.is_some()),
            ("--strain", self.strain.is_some()),
            ("--shear", self.shear.is_some()),
            ("--patch", self.patch.is_some()),
            ("--areal", self.areal.is_some()),
            ("--shape", self.shape.is_some()),
            ("--energy distance", self.energy == EnergyChoice::Distance),
        ];
        match refused.into_iter().find(|(_, is_given)| *is_given) {
            Some((option, _)) => {
                let why = "is for maps without seams; this surface is cut open along some, as it has handles or --cones are given";
                Err(Failure::Usage(format!("{option} {why}")))
            }
            None => Ok(()),
        }
    }

    /// True if the surface is cut open along seams.
    pub fn has_seams(&self, mesh: &Mesh) -> bool {
        mesh.genus() > 0 || self.cones.is_some()
    }

    /// The map of a surface with seams.
    pub fn seamed_map(
        &self,
        input: &Input,
        options: &FlattenOptions,
        run: &CommandRun<'_>,
    ) -> Result<SeamedMap, Failure> {
        let choice = self.cones.as_ref().unwrap_or(&ConesChoice::Field);
        let metric = SeamlessOptions {
            cones: chosen_cones(choice, input)?,
            threads: self.common.threads,
            ..SeamlessOptions::default()
        };
        run.control.step(Stage::Flow, 0.0)?;
        let find = || seamless(&input.surface, &metric, &run.control.part(0.0, OF_METRIC));
        let found = doing("solving", find)?;
        if !found.converged() {
            let path = input.path.display();
            return Err(Failure::Failed(format!(
                "{path}: no seamless metric with these cones was found, angles are off by {:.1e}; ask for others (--cones), which `ricci seamless` tries alone",
                found.error
            )));
        }
        let lay_flat = || flatten_seamless(&found, options, &run.control.part(OF_METRIC, 1.0));
        let map = doing("flattening", lay_flat)?;
        let n_added = map.surface.mesh().n_vertices() - input.mesh().n_vertices();
        Ok(SeamedMap { map, cones: found.cones, quarter_turns: found.quarter_turns, n_added })
    }
}

impl SeamedMap {
    /// The largest distance by which a corner was moved to make the seams exact, over the diameter of the map.
    pub fn moved(&self) -> f64 {
        self.map.moved / self.map.layout.diameter
    }

    pub fn figures(&self) -> Value {
        let cones: Vec<_> =
            self.cones.iter().map(|cone| json!({"vertex": cone.vertex.0, "valence": cone.valence})).collect();
        json!({
            "cones": cones,
            "holonomy": self.quarter_turns,
            "added_vertices": self.n_added,
            "moved_corners": self.moved(),
        })
    }

    pub fn summary(&self) -> String {
        let added = match self.n_added {
            0 => String::new(),
            n => format!("; {n} vertices added on edges"),
        };
        format!("seams    exact rotations by multiples of 90° between {} cones{added}\n", self.cones.len())
    }
}
