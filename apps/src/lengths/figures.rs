//! The checks, the figures and the summary of `ricci lengths`.

use super::curves::{GeodesicLines, SAME_LENGTH};
use crate::failure::{Failure, required};
use crate::input::Input;
use crate::report::{Checks, Done, Figures, InputSummary};
use crate::runner::{CommandRun, JobOutcome};
use crate::say;
use ricci::canonical::Quotient;
use ricci::moduli::{GeodesicClass, LengthSpectrum, PantsCurve};
use serde_json::json;

pub struct LengthsOutcome {
    pub input: Input,
    pub quotient: Quotient,
    pub spectrum: LengthSpectrum,
    /// The words that were asked for, with the lengths of their geodesics.
    pub words: Vec<(String, f64)>,
    /// The curves of a decomposition into pairs of pants, where they are asked for.
    pub pants: Vec<PantsCurve>,
    /// Lines on the surface, where an output needs them, or the reason why there are none.
    pub curves: Option<Result<GeodesicLines, String>>,
}

/// Largest residual of the group's relation and of the layout's side pairings, relative to the largest matrix on the way: half of the
/// digits of a floating-point number.
const RELATION: f64 = 1e-8;
/// Number of lengths in the summary.
const SHOWN: usize = 12;

impl LengthsOutcome {
    /// The word of a geodesic, its letters with points between them.
    pub fn name(&self, class: &GeodesicClass) -> String {
        self.quotient.deck.group.text(&class.element.word).replace(' ', ".")
    }

    /// The words of all geodesics.
    pub fn names(&self) -> Vec<String> {
        self.spectrum.classes.iter().map(|class| self.name(class)).collect()
    }

    /// Number of geodesics of the least length.
    pub fn shortest(&self) -> usize {
        self.spectrum.multiplicities(SAME_LENGTH).first().map_or(0, |&(_, n)| n)
    }

    pub fn curves(&self) -> Result<&GeodesicLines, Failure> {
        required(&self.curves)
    }
}

/// A curve with its Fenchel-Nielsen coordinates.
fn coordinates(curve: &PantsCurve) -> serde_json::Value {
    json!({"curve": curve.name, "length": curve.length, "twist": curve.twist})
}

impl JobOutcome for LengthsOutcome {
    type Figures = Figures;

    fn checks(&self) -> Checks {
        let mut checks = Checks::default();
        let Quotient { report, deck, .. } = &self.quotient;
        checks.add("relation_residual", deck.relation_residual, RELATION);
        checks.add("side_residual", deck.side_residual, RELATION);
        checks.add("max_curvature_error", self.quotient.angle_defect, report.allowed_error());
        checks.add("unconverged", f64::from(u8::from(!report.converged())), 0.0);
        checks
    }

    fn input(&self) -> Option<InputSummary> {
        Some(InputSummary::of(&self.input))
    }

    fn figures(&self, run: &CommandRun<'_>) -> Figures {
        let all = self.spectrum.multiplicities(SAME_LENGTH);
        let words: serde_json::Map<String, serde_json::Value> =
            self.words.iter().map(|(word, length)| (word.clone(), json!(length))).collect();
        Figures::default()
            .with("left_out", run.outputs.left_out())
            .with("space", self.quotient.deck.space.name())
            .with("basis", self.quotient.deck.group.names())
            .with("systole", self.spectrum.classes.first().map(|class| class.length))
            .with("closed_geodesics", self.spectrum.classes.len())
            .with("lengths", json!(all))
            .if_some("words", (!words.is_empty()).then_some(words))
            .if_some(
                "fenchel_nielsen",
                (!self.pants.is_empty())
                    .then(|| json!(self.pants.iter().map(coordinates).collect::<Vec<_>>())),
            )
            .with("reach", self.spectrum.reach)
            .with("deck_transformations", self.spectrum.n_elements)
            .with("relation_error", self.quotient.deck.relation_error)
            .failed(&run.failed)
    }

    fn summary(&self, done: &Done) -> String {
        let mut text = say::surface(&self.input);
        let all = self.spectrum.multiplicities(SAME_LENGTH);
        text += &format!(
            "lengths  {} up to {}, among {} that move the base by at most {:.2}\n",
            say::count(self.spectrum.classes.len(), "closed geodesic", "closed geodesics"),
            self.spectrum.longest,
            say::count(self.spectrum.n_elements, "deck transformation", "deck transformations"),
            self.spectrum.reach
        );
        for (length, n) in all.iter().take(SHOWN) {
            text += &format!("         {length:.12} × {n}\n");
        }
        if all.len() > SHOWN {
            text += &format!("         and {} longer\n", say::count(all.len() - SHOWN, "length", "lengths"));
        }
        for (word, length) in &self.words {
            text += &format!("word     {word}: {length:.12}\n");
        }
        for curve in &self.pants {
            text +=
                &format!("pants    {}: length {:.12}, twist {:.12}\n", curve.name, curve.length, curve.twist);
        }
        text + &say::finish(done)
    }
}
