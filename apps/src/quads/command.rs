//! `ricci quads` as a job: what it refuses, computes, writes and reports.

use super::args::{QuadSourceArgs, QuadsArgs};
use super::figures::QuadsOutcome;
use super::files::{EXTENSIONS, QuadFile};
use super::picture::ShownQuads;
use super::texture::{PatchPoint, PatchQuads, patch_coordinates};
use crate::failure::{Failure, NO_POSITIONS};
use crate::input::{self, Input};
use crate::options::SurfaceArgs;
use crate::output::{check_extension, check_outputs};
use crate::progress::doing;
use crate::report::timed;
use crate::runner::{CommandRun, Job, JobHeader};
use crate::seamless::{ConesChoice, chosen_cones};
use ricci::quads::{QuadMesh, QuadOptions, quad_mesh};
use ricci::seamless::{Seamless, SeamlessOptions, seamless, sharp_edges};
use std::io::Write;
use std::path::Path;

impl Job for QuadsArgs {
    type Outcome = QuadsOutcome;

    fn header(&self) -> JobHeader<'_> {
        JobHeader { name: "quads", common: &self.common, mesh: Some(&self.source.surface.file.mesh) }
    }

    fn check(&self) -> Result<(), Failure> {
        check_extension("-o", Some(&self.out), &EXTENSIONS)?;
        if self.texture {
            check_extension("-o with --texture", Some(&self.out), &["obj"])?;
        }
        check_extension("--picture", self.picture.picture.as_deref(), &["png"])?;
        let files =
            [Some(&self.out), self.map.as_ref(), self.picture.picture.as_ref(), self.common.report.as_ref()];
        check_outputs(&self.source.files(), &files.map(|file| file.map(|f| &**f)))
    }

    fn compute(&self, run: &mut CommandRun<'_>) -> Result<QuadsOutcome, Failure> {
        let (input, found) = solved(&self.source, self.common.threads, run)?;
        let options = QuadOptions { size: self.size.size(), threads: self.common.threads };
        let divide = || doing("dividing", || quad_mesh(&found, &options, run.control));
        let mesh = timed(&mut run.seconds.layout, divide)?;
        let positions = mesh.positions(&found.solution).ok_or_else(Failure::no_positions)?;
        let distance = mesh.distance(&found.solution).ok_or_else(Failure::no_positions)?;
        Ok(QuadsOutcome { input, found, mesh, positions, distance })
    }

    fn write(&self, outcome: &QuadsOutcome, run: &mut CommandRun<'_>) -> Result<(), Failure> {
        let QuadsOutcome { mesh, positions, .. } = outcome;
        let texture = self.texture.then(|| rectangle_coordinates(mesh));
        let file = QuadFile { positions, quads: &mesh.quads, patches: Vec::new(), texture };
        run.file("out", Some(&self.out), |outputs, path| file.write(outputs, path))?;
        run.file("map", self.map.as_deref(), |outputs, path| {
            outputs.add(path, |out| write_places(out, mesh))
        })?;
        let shown = ShownQuads { mesh, positions, layout: None };
        run.picture("picture", self.picture.picture.as_deref(), || {
            shown.draw(&self.picture, self.common.threads)
        })
    }
}

impl QuadSourceArgs {
    /// The files that are read.
    pub fn files(&self) -> [Option<&Path>; 2] {
        let table = match &self.cones {
            ConesChoice::Table(path) => Some(path.as_path()),
            _ => None,
        };
        [Some(&*self.surface.file.mesh), table]
    }
}

/// A surface in space, of which something is to be written.
pub fn with_positions(args: &SurfaceArgs, run: &mut CommandRun<'_>) -> Result<Input, Failure> {
    let input = input::surface(args, &mut run.seconds, run.control)?;
    if input.positions().is_none() {
        return Err(Failure::Usage(format!("-o: {NO_POSITIONS}")));
    }
    Ok(input)
}

/// The surface and its seamless metric.
pub fn solved(
    args: &QuadSourceArgs,
    threads: usize,
    run: &mut CommandRun<'_>,
) -> Result<(Input, Seamless), Failure> {
    let input = with_positions(&args.surface, run)?;
    let features =
        args.features.map(|degrees| sharp_edges(&input.surface, degrees.to_radians())).transpose()?;
    let options = SeamlessOptions {
        cones: chosen_cones(&args.cones, &input)?,
        features: features.unwrap_or_default(),
        tolerance: args.tolerance,
        threads,
        ..SeamlessOptions::default()
    };
    let solve = || doing("solving", || seamless(&input.surface, &options, run.control));
    let found = timed(&mut run.seconds.solve, solve)?;
    Ok((input, found))
}

/// The coordinates of the corners of quads in the rectangles of the T-mesh.
fn rectangle_coordinates(mesh: &QuadMesh) -> Vec<[PatchPoint; 4]> {
    let mut rectangles = vec![Vec::new(); mesh.t_mesh_size[0]];
    (0..).zip(&mesh.rectangle).for_each(|(q, &r)| rectangles[r as usize].push(q));
    let patches: Vec<PatchQuads<'_>> =
        rectangles.iter().map(|quads| PatchQuads { quads, first: None }).collect();
    patch_coordinates(&mesh.quads, &patches)
}

/// The places of the vertices on the input.
fn write_places(out: &mut dyn Write, mesh: &QuadMesh) -> std::io::Result<()> {
    writeln!(out, "quad_vertex,source_face,b0,b1,b2")?;
    for (v, (f, [b0, b1, b2])) in mesh.places.iter().enumerate() {
        writeln!(out, "{v},{f},{b0},{b1},{b2}")?;
    }
    Ok(())
}
