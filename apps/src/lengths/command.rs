//! `ricci lengths` as a job: what it refuses, computes, writes and reports.

use super::args::LengthsArgs;
use super::curves::{GeodesicLines, draw};
use super::figures::LengthsOutcome;
use crate::csv::read_edge_loops;
use crate::failure::{Failure, NO_POSITIONS, or_reason};
use crate::input::{self, Input};
use crate::output::{check_extension, check_outputs};
use crate::progress::doing;
use crate::report::timed;
use crate::runner::{CommandRun, Job, JobHeader};
use ricci::canonical::{Quotient, QuotientOptions, uniformize_quotient};
use ricci::geometry::Space;
use ricci::mesh::VertexId;
use ricci::moduli::{
    PantsCurve, SpectrumOptions, fenchel_nielsen, fenchel_nielsen_of_loops, geodesic_length, length_spectrum,
    pants_of_words,
};
use ricci::topology::Word;
use ricci::{Control, flow};
use serde::Serialize;
use std::io::Write;

impl Job for LengthsArgs {
    type Outcome = LengthsOutcome;

    fn header(&self) -> JobHeader<'_> {
        JobHeader { name: "lengths", common: &self.common, mesh: Some(&self.surface.file.mesh) }
    }

    fn check(&self) -> Result<(), Failure> {
        check_extension("--spectrum", self.spectrum.as_deref(), &["csv"])?;
        check_extension("--systole", self.systole.as_deref(), &["obj"])?;
        check_extension("--curves", self.curves.as_deref(), &["obj"])?;
        check_extension("--picture", self.picture.picture.as_deref(), &["png"])?;
        let files = [&self.spectrum, &self.systole, &self.curves, &self.picture.picture, &self.common.report];
        check_outputs(
            &[Some(&self.surface.file.mesh), self.loops.as_deref()],
            &files.map(|file| file.as_deref()),
        )
    }

    fn compute(&self, run: &mut CommandRun<'_>) -> Result<LengthsOutcome, Failure> {
        let input = input::surface(&self.surface, &mut run.seconds, run.control)?;
        check_surface(self, &input)?;
        let options = QuotientOptions {
            base: self.base.map(VertexId),
            flow: flow::Options { threads: self.common.threads, ..flow::Options::default() },
            ..QuotientOptions::default()
        };
        let control = run.control;
        let uniformize = || doing("metric", || uniformize_quotient(&input.surface, &options, control));
        let quotient = timed(&mut run.seconds.solve, uniformize)?;
        let words = self.words.iter().map(|text| word(&quotient, text)).collect::<Result<_, _>>()?;
        let spectrum_options = SpectrumOptions { longest: self.below, limit: self.limit as usize };
        let search = || doing("geodesics", || length_spectrum(&quotient, &spectrum_options, control));
        let spectrum = timed(&mut run.seconds.layout, search)?;
        let pants = pants(self, &input, &quotient, control)?;
        let is_drawn = self.systole.is_some() || self.curves.is_some() || self.picture.picture.is_some();
        let curves = if is_drawn {
            let all = self.curves.is_some();
            let make = || doing("curves", || GeodesicLines::new(&input, &quotient, &spectrum, all, control));
            Some(or_reason(timed(&mut run.seconds.refine, make))?)
        } else {
            None
        };
        Ok(LengthsOutcome { input, quotient, spectrum, words, pants, curves })
    }

    fn write(&self, outcome: &LengthsOutcome, run: &mut CommandRun<'_>) -> Result<(), Failure> {
        run.file("spectrum", self.spectrum.as_deref(), |outputs, path| {
            outputs.add(path, |out| {
                writeln!(out, "length,power,word")?;
                for class in &outcome.spectrum.classes {
                    writeln!(out, "{:?},{},{}", class.length, class.power, outcome.name(class))?;
                }
                Ok(())
            })
        })?;
        let shortest = outcome.shortest();
        run.file("systole", self.systole.as_deref(), |outputs, path| {
            let curves = outcome.curves()?;
            outputs.add(path, |out| curves.write(out, &outcome.names(), shortest))
        })?;
        run.file("curves", self.curves.as_deref(), |outputs, path| {
            let curves = outcome.curves()?;
            outputs.add(path, |out| curves.write(out, &outcome.names(), usize::MAX))
        })?;
        let draw = || draw(&outcome.input, outcome.curves()?, self, shortest);
        run.picture("picture", self.picture.picture.as_deref(), draw)
    }

    fn settings<'a>(&'a self, outcome: &'a LengthsOutcome) -> impl Serialize + 'a {
        LengthsSettings {
            input_geometry: outcome.input.surface.geometry().name(),
            base: outcome.quotient.basis.base.0,
            args: self,
        }
    }
}

/// The curves of the decomposition into pairs of pants that is asked for, if one is.
fn pants(
    args: &LengthsArgs,
    input: &Input,
    quotient: &Quotient,
    control: &Control,
) -> Result<Vec<PantsCurve>, Failure> {
    if let Some(path) = &args.loops {
        let loops = read_edge_loops(path, input.mesh())?;
        return Ok(fenchel_nielsen_of_loops(quotient, &loops, control)?);
    }
    if !args.curves_named.is_empty() {
        let parse = |text: &String| parse(quotient, "--curve", text);
        let words: Vec<Word> = args.curves_named.iter().map(parse).collect::<Result<_, _>>()?;
        return Ok(pants_of_words(quotient, &words, args.limit as usize, control)?);
    }
    Ok(if args.pants { fenchel_nielsen(&quotient.deck)? } else { Vec::new() })
}

fn parse(quotient: &Quotient, option: &str, text: &str) -> Result<Word, Failure> {
    let word = quotient.deck.group.parse(&text.replace('.', " "));
    word.map_err(|e| Failure::Usage(format!("{option} {text}: {e}")))
}

/// The word of an option, with the length of its geodesic.
fn word(quotient: &Quotient, text: &str) -> Result<(String, f64), Failure> {
    let word = parse(quotient, "--word", text)?;
    Ok((text.to_string(), geodesic_length(&quotient.deck, &word)?))
}

/// Refuse what can be refused once the surface is known.
fn check_surface(args: &LengthsArgs, input: &Input) -> Result<(), Failure> {
    input.check_vertex("--base", args.base)?;
    let lines = [
        ("--systole", args.systole.is_some()),
        ("--curves", args.curves.is_some()),
        ("--picture", args.picture.picture.is_some()),
    ];
    let Some((option, _)) = lines.into_iter().find(|(_, wanted)| *wanted) else { return Ok(()) };
    if input.positions().is_none() {
        return Err(Failure::Usage(format!("{option}: {NO_POSITIONS}")));
    }
    let mesh = input.mesh();
    let is_flat = mesh.euler() == 0;
    if is_flat {
        let space = Space::E2.name();
        return Err(Failure::Usage(format!(
            "{option}: this surface is flat ({space}), where closed geodesics come in families; lines are drawn of hyperbolic ones"
        )));
    }
    Ok(())
}

/// The options of a run as its report has them.
#[derive(Serialize)]
struct LengthsSettings<'a> {
    input_geometry: &'static str,
    base: u32,
    #[serde(flatten)]
    args: &'a LengthsArgs,
}
