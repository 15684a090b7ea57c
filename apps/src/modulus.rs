//! The options and the outputs of proven bounds of moduli, of `ricci uniformize` and `ricci circles`.

use crate::failure::Failure;
use crate::forms::{BoundsFile, width};
use crate::input::Input;
use crate::options::FileName;
use crate::progress::doing;
use crate::report::{Figures, timed};
use crate::runner::CommandRun;
use clap::Args;
use ricci::mesh::VertexId;
use ricci::moduli::{BoundsOptions, ModulusBounds, modulus_bounds};
use serde::Serialize;

#[derive(Args, Serialize, Debug, Clone)]
pub struct ModulusArgs {
    /// Largest relative width of the bounds of the modulus of an annulus or of a disk with four corners
    #[arg(long, value_name = "W", default_value_t = 1e-3, value_parser = width)]
    pub width: f64,
    /// Write the forms that prove these bounds, as `ricci forms --bounds` does, on the torus of mirror images
    #[arg(long, value_name = "B.json")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bounds: Option<FileName>,
}

impl ModulusArgs {
    /// The bounds of the surface's modulus.
    pub fn find(
        &self,
        input: &Input,
        corners: &[VertexId],
        run: &mut CommandRun<'_>,
    ) -> Result<ModulusBounds, Failure> {
        let options = BoundsOptions { width: self.width, ..BoundsOptions::default() };
        let control = run.control;
        let find = || doing("bounds", || modulus_bounds(&input.surface, corners, &options, control));
        Ok(timed(&mut run.seconds.bounds, find)?)
    }

    /// Writes the file that is asked for, or says that the surface has no modulus.
    pub fn write(&self, found: Option<&ModulusBounds>, run: &mut CommandRun<'_>) -> Result<(), Failure> {
        run.file("bounds", self.bounds.as_deref(), |outputs, path| {
            let none =
                || Failure::Failed("only an annulus or a disk with four right angles has a modulus".into());
            let torus = &found.ok_or_else(none)?.torus;
            outputs.add_json(path, &BoundsFile::new(torus, vec!["a1".into(), "b1".into()]))
        })
    }
}

/// The figures of the bounds.
pub fn add_figures(figures: Figures, found: Option<&ModulusBounds>) -> Figures {
    figures
        .if_some("modulus_bounds", found.map(|m| m.interval))
        .if_some("modulus_gap", found.map(|m| m.torus.gap))
        .if_some("modulus_reached", found.map(|m| m.torus.is_reached))
}

/// The bounds for the summary.
pub fn line(found: Option<&ModulusBounds>) -> String {
    found.map_or_else(String::new, |m| {
        let [low, high] = m.interval;
        let short = if m.torus.is_reached { "" } else { " (wider than asked for)" };
        format!("modulus  between {low:.12} and {high:.12}, of the polyhedral surface{short}\n")
    })
}
