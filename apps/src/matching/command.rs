//! `ricci match` as a job: what it refuses, computes, writes and reports.

use super::args::{LandmarkChoice, MatchArgs, MatchPictureChoice};
use super::files::{write_carried, write_map, write_moved, write_overlay, write_places};
use super::marks;
use super::outcome::{MatchOutcome, MatchedSurfaces};
use super::pictures::draw;
use crate::csv;
use crate::failure::Failure;
use crate::input::{self, Input};
use crate::options::{FileName, MeshArgs};
use crate::output::{check_extension, check_outputs};
use crate::progress::doing;
use crate::report::timed;
use crate::runner::{CommandRun, Job, JobHeader};
use ricci::Control;
use ricci::flow;
use ricci::matching::{
    LandmarkSearch, MatchOptions, dilatation_bracket, judge, match_by_shape, match_surfaces,
};
use ricci::moduli::BoundsOptions;
use ricci::parallel::within;
use std::path::Path;

impl Job for MatchArgs {
    type Outcome = MatchOutcome;

    fn header(&self) -> JobHeader<'_> {
        JobHeader { name: "match", common: &self.common, mesh: Some(&self.source.mesh) }
    }

    fn check(&self) -> Result<(), Failure> {
        check_extension("--output", self.output.as_deref(), &["obj", "glb"])?;
        check_extension("--carried", self.carried.as_deref(), &["obj", "glb"])?;
        check_extension("--overlay", self.overlay.as_deref(), &["obj", "glb"])?;
        check_extension("--domains", self.domains.as_deref(), &["png"])?;
        check_extension("--heat", self.heat.as_deref(), &["png"])?;
        check_extension("--picture", self.picture.picture.as_deref(), &["png"])?;
        let files = [
            &self.map,
            &self.back,
            &self.output,
            &self.carried,
            &self.overlay,
            &self.overlay_places,
            &self.domains,
            &self.heat,
            &self.picture.picture,
            &self.common.report,
        ];
        let tables = [&self.points, &self.soft, &self.curves, &self.basis];
        let landmarks = match self.landmark_choice() {
            LandmarkChoice::File(path) => Some(path),
            _ => None,
        };
        let inputs = [Some(self.source.mesh.as_path()), Some(self.target.as_path()), landmarks];
        let inputs: Vec<_> = inputs.into_iter().chain(tables.map(|file| file.as_deref())).collect();
        check_outputs(&inputs, &files.map(|file| file.as_deref()))
    }

    fn compute(&self, run: &mut CommandRun<'_>) -> Result<MatchOutcome, Failure> {
        let (seconds, control) = (&mut run.seconds, run.control);
        let input = input::read(&self.source, None, seconds, control)?;
        let target = MeshArgs { mesh: self.target.clone(), weld: self.source.weld };
        let target = input::read(&target, None, seconds, control)?;
        check_surfaces(self, [&input, &target])?;
        let options = options(self, [&input, &target])?;
        let found = timed(&mut seconds.solve, || {
            doing("matching", || find(self, [&input, &target], options, &control.part(0.1, 0.8)))
        })?;
        let mut outcome = MatchOutcome::new([input, target], found, self.same_numbering)?;
        if self.overlay.is_some() || self.overlay_places.is_some() || self.distance {
            let overlay = timed(&mut seconds.solve, || {
                let threads = self.common.threads;
                doing("overlay", || {
                    outcome.matching.domain.overlay(threads, &control.part(0.8, 1.0)).map_err(Failure::from)
                })
            });
            if let Some(overlay) = run.failed.attempt("overlay", overlay)? {
                outcome.lay_over(overlay)?;
            }
            if let (true, Some(overlay)) = (self.distance, &outcome.overlay) {
                let surfaces = [&outcome.source.surface, &outcome.target.surface];
                let options = BoundsOptions { width: self.width, ..BoundsOptions::default() };
                let find = || dilatation_bracket(surfaces, overlay, &outcome.landmarks, &options, control);
                let found = timed(&mut seconds.bounds, || doing("distance", find))?;
                outcome.distance = Some(found);
            }
        }
        Ok(outcome)
    }

    fn write(&self, outcome: &MatchOutcome, run: &mut CommandRun<'_>) -> Result<(), Failure> {
        let matching = &outcome.matching;
        run.file("map", self.map.as_deref(), |outputs, path| write_map(outputs, path, &matching.forward))?;
        run.file("back", self.back.as_deref(), |outputs, path| write_map(outputs, path, &matching.backward))?;
        run.file("output", self.output.as_deref(), |outputs, path| write_moved(outputs, path, outcome))?;
        run.file("carried", self.carried.as_deref(), |outputs, path| write_carried(outputs, path, outcome))?;
        if let Some(overlay) = &outcome.overlay {
            let write = |outputs: &mut _, path: &_| write_overlay(outputs, path, outcome, overlay);
            run.file("overlay", self.overlay.as_deref(), write)?;
            let write = |outputs: &mut _, path: &_| write_places(outputs, path, overlay);
            run.file("overlay_places", self.overlay_places.as_deref(), write)?;
        }
        let pictures = [
            ("picture", &self.picture.picture, self.show.unwrap_or(MatchPictureChoice::Carried)),
            ("domains", &self.domains, MatchPictureChoice::Domains),
            ("heat", &self.heat, MatchPictureChoice::Heat),
        ];
        for (option, path, show) in pictures {
            run.picture(option, path.as_deref(), || draw(show, outcome, self))?;
        }
        Ok(())
    }
}

/// The map, with its judgement and the landmarks that were given or found.
fn find(
    args: &MatchArgs,
    surfaces: [&Input; 2],
    options: MatchOptions,
    control: &Control,
) -> ricci::Result<MatchedSurfaces> {
    let [source, target] = surfaces.map(|input| &input.surface);
    if let LandmarkChoice::Auto = args.landmark_choice() {
        let matched = match_by_shape([source, target], &options, &LandmarkSearch::default(), control)?;
        let (matching, landmarks, judgement) = (matched.matching, matched.landmarks, matched.judgement);
        return Ok(MatchedSurfaces { matching, landmarks, judgement, found: Some(matched.found) });
    }
    let matching = match_surfaces(source, target, &options, &control.part(0.0, 0.9))?;
    let judged = || judge([source, target], &matching, &control.part(0.9, 1.0));
    let judgement = within(options.flow.threads, judged)?;
    Ok(MatchedSurfaces { matching, landmarks: options.landmarks, judgement, found: None })
}

/// The library's options, with the tables that the arguments name.
fn options(args: &MatchArgs, surfaces: [&Input; 2]) -> Result<MatchOptions, Failure> {
    let meshes = surfaces.map(Input::mesh);
    Ok(MatchOptions {
        landmarks: match args.landmark_choice() {
            LandmarkChoice::File(path) => csv::read_landmarks(path, meshes.map(|m| m.n_vertices()))?,
            _ => Vec::new(),
        },
        points: table(&args.points, |path| marks::read_points(path, meshes))?,
        soft: table(&args.soft, |path| marks::read_soft(path, meshes))?,
        curves: table(&args.curves, |path| marks::read_curves(path, meshes))?,
        basis: table(&args.basis, |path| marks::read_basis(path, meshes))?,
        loops: (!args.loops.is_empty()).then(|| args.loops.clone()),
        boundary: args.boundary.into(),
        loop_shape: args.loop_shape.into(),
        flow: flow::Options { threads: args.common.threads, ..flow::Options::default() },
    })
}

/// The rows of a table; none without a file.
fn table<T>(
    path: &Option<FileName>,
    read: impl FnOnce(&Path) -> Result<Vec<T>, Failure>,
) -> Result<Vec<T>, Failure> {
    path.as_deref().map_or(Ok(Vec::new()), read)
}

/// Refuse what can be refused once the surfaces are known.
fn check_surfaces(args: &MatchArgs, surfaces: [&Input; 2]) -> Result<(), Failure> {
    if let Some(input) = surfaces.iter().find(|input| input.positions().is_none()) {
        let path = input.path.display();
        return Err(Failure::Input(format!(
            "{path}: an intrinsic metric has no positions to measure the map by"
        )));
    }
    let [n, m] = surfaces.map(|input| input.mesh().n_vertices());
    if args.same_numbering && n != m {
        return Err(Failure::Usage(format!("--same-numbering: the source has {n} vertices, the target {m}")));
    }
    Ok(())
}
