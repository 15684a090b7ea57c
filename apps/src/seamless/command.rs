//! `ricci seamless` as a job: what it refuses, computes, writes and reports.

use super::args::{ConesChoice, SeamlessArgs};
use super::figures::{SeamlessOutcome, WrittenMap};
use super::picture::{draw, draw_field};
use crate::csv;
use crate::failure::{Failure, NO_POSITIONS};
use crate::input::{self, Input};
use crate::options::OnChoice;
use crate::output::{check_extension, check_outputs, extension};
use crate::progress::doing;
use crate::report::timed;
use crate::runner::{CommandRun, Job, JobHeader};
use crate::solved::SolvedMetric;
use crate::surface_layout::SurfaceLayout;
use crate::uv::{self, UvOptions};
use ricci::control::Stage;
use ricci::mesh::PerVertex;
use ricci::seamless::{
    ConeValence, CrossField, Seamless, SeamlessCones, SeamlessMap, SeamlessOptions, curvature_guides,
    seamless, sharp_edges, stroke_guides,
};
use std::io::Write;

impl Job for SeamlessArgs {
    type Outcome = SeamlessOutcome;

    fn header(&self) -> JobHeader<'_> {
        JobHeader { name: "seamless", common: &self.common, mesh: Some(&self.surface.file.mesh) }
    }

    fn check(&self) -> Result<(), Failure> {
        check_extension("--uv", self.uv.as_deref(), &["obj", "glb"])?;
        check_extension("--field", self.field.as_deref(), &["csv", "png"])?;
        check_extension("--picture", self.picture.picture.as_deref(), &["png", "svg"])?;
        let table = match &self.cones {
            ConesChoice::Table(path) => Some(path.as_path()),
            _ => None,
        };
        let inputs = [Some(&*self.surface.file.mesh), table, self.strokes.as_deref(), self.sizes.as_deref()];
        let files =
            [&self.uv, &self.xref, &self.field, &self.metric, &self.picture.picture, &self.common.report];
        check_outputs(&inputs, &files.map(|file| file.as_deref()))
    }

    fn compute(&self, run: &mut CommandRun<'_>) -> Result<SeamlessOutcome, Failure> {
        let input = input::surface(&self.surface, &mut run.seconds, run.control)?;
        for (option, is_asked) in [("--uv", self.uv.is_some()), ("--field", self.field.is_some())] {
            if is_asked && input.positions().is_none() {
                return Err(Failure::Usage(format!("{option}: {NO_POSITIONS}")));
            }
        }
        let options = options(self, &input)?;
        let field = match &self.field {
            Some(_) => {
                let make =
                    || CrossField::new(&input.surface, &options.features, &options.guides, run.control);
                Some(timed(&mut run.seconds.solve, make)?)
            }
            None => None,
        };
        let solve = || doing("solving", || seamless(&input.surface, &options, run.control));
        let found = timed(&mut run.seconds.solve, solve)?;
        let map = map(&input, &found, run)?;
        let metric = SolvedMetric::new(found.solution.clone(), Some(found.target()))?;
        let mut energy_before = map.as_ref().ok().map(|map| map.laid.quality.symmetric_dirichlet);
        if options.isometric_steps > 0 && map.is_ok() {
            let plain = SeamlessOptions { isometric_steps: 0, ..options };
            let solve = || doing("solving", || seamless(&input.surface, &plain, run.control));
            let before = timed(&mut run.seconds.solve, solve)?;
            energy_before =
                self::map(&input, &before, run)?.ok().map(|map| map.laid.quality.symmetric_dirichlet);
        }
        Ok(SeamlessOutcome { input, found, map, metric, energy_before, field })
    }

    fn write(&self, outcome: &SeamlessOutcome, run: &mut CommandRun<'_>) -> Result<(), Failure> {
        let SeamlessOutcome { input, map, metric, .. } = outcome;
        let picture = self.picture.picture.as_deref();
        match map {
            Ok(map) => {
                if let Some(path) = &self.uv {
                    let written = uv::write(&mut run.outputs, path, input, &map.laid, UvOptions::default());
                    if let Some(added) = run.failed.attempt("uv", written)? {
                        run.added = added;
                    }
                }
                run.file("xref", self.xref.as_deref(), |outputs, path| {
                    outputs.add(path, |out| uv::write_origins(out, input, &map.laid, OnChoice::Refined))
                })?;
                run.picture("picture", picture, || draw(outcome, map, self))?;
            }
            Err(why) => {
                let asked = [
                    ("uv", self.uv.is_some()),
                    ("xref", self.xref.is_some()),
                    ("picture", picture.is_some()),
                ];
                run.failed.refuse(why, &asked);
            }
        }
        if let Some(field) = &outcome.field {
            let path = self.field.as_deref();
            if path.is_some_and(|path| extension(path) == "png") {
                run.picture("field", path, || draw_field(outcome, field, self))?;
            } else {
                run.file("field", path, |outputs, path| {
                    outputs.add(path, |out| write_field(out, input, field))
                })?;
            }
        }
        run.file("metric", self.metric.as_deref(), |outputs, path| metric.write_metric(outputs, path))
    }
}

/// The options of the library.
fn options(args: &SeamlessArgs, input: &Input) -> Result<SeamlessOptions, Failure> {
    let n = input.mesh().n_vertices();
    let surface = &input.surface;
    let features = args.features.map(|degrees| sharp_edges(surface, degrees.to_radians())).transpose()?;
    let mut guides = Vec::new();
    if let Some(strength) = args.curvature {
        guides.extend(curvature_guides(surface, strength)?);
    }
    if let Some(path) = &args.strokes {
        guides.extend(stroke_guides(surface, &csv::read_directions(path, n)?)?);
    }
    let sizes = match &args.sizes {
        Some(path) => {
            let mut sizes = PerVertex::filled(n, 1.0);
            csv::read_factors(path, n)?.into_iter().for_each(|(v, size)| sizes[v] = size);
            Some(sizes)
        }
        None => None,
    };
    Ok(SeamlessOptions {
        cones: chosen_cones(&args.cones, input)?,
        quarter_turns: args.turning.clone(),
        features: features.unwrap_or_default(),
        guides,
        isometric_steps: args.isometric.max(usize::from(sizes.is_some())),
        sizes,
        tolerance: args.tolerance,
        threads: args.common.threads,
        ..SeamlessOptions::default()
    })
}

/// A direction of the field in each face, in space.
fn write_field(out: &mut dyn Write, input: &Input, field: &CrossField) -> std::io::Result<()> {
    writeln!(out, "face,x,y,z")?;
    let Some(directions) = field.in_space(&input.surface) else { return Ok(()) };
    for (f, [x, y, z]) in directions.iter().enumerate() {
        writeln!(out, "{f},{x},{y},{z}")?;
    }
    Ok(())
}

/// The cones of an option.
pub fn chosen_cones(choice: &ConesChoice, input: &Input) -> Result<SeamlessCones, Failure> {
    Ok(match choice {
        ConesChoice::Field => SeamlessCones::Field,
        ConesChoice::Auto(n) => SeamlessCones::Auto(*n),
        ConesChoice::Table(path) => {
            let rows = csv::read_valences(path, input.mesh().n_vertices())?;
            let cone = |(vertex, valence)| ConeValence { vertex, valence };
            SeamlessCones::Valences(rows.into_iter().map(cone).collect())
        }
    })
}

/// The map; why there is none, where it failed.
fn map(
    input: &Input,
    found: &Seamless,
    run: &mut CommandRun<'_>,
) -> Result<Result<WrittenMap, String>, Failure> {
    let control = run.control;
    control.step(Stage::Layout, 0.0)?;
    let lay_out = || -> ricci::Result<WrittenMap> {
        let SeamlessMap { layout, moved, bend } = found.map(control)?;
        Ok(WrittenMap { laid: SurfaceLayout::new(input, &found.solution, layout)?, moved, bend })
    };
    match timed(&mut run.seconds.layout, lay_out) {
        Ok(map) => Ok(Ok(map)),
        Err(ricci::Error::Cancelled) => Err(ricci::Error::Cancelled.into()),
        Err(error) => Ok(Err(error.to_string())),
    }
}
