//! `ricci harmonic` as a job: what it refuses, computes, writes and reports.

use super::args::{HarmonicArgs, HarmonicMethodChoice, MapTarget};
use super::files::{draw_sphere, write_sphere};
use super::outcome::{HarmonicOutcome, MappedSurface};
use crate::failure::Failure;
use crate::input::{self, Input};
use crate::output::{check_extension, check_outputs};
use crate::runner::{CommandRun, Job, JobHeader};
use crate::say::count;
use ricci::mesh::Mesh;
use serde::Serialize;
use std::io::Write;

impl Job for HarmonicArgs {
    type Outcome = HarmonicOutcome;

    fn header(&self) -> JobHeader<'_> {
        JobHeader { name: "harmonic", common: &self.common, mesh: Some(&self.surface.file.mesh) }
    }

    fn check(&self) -> Result<(), Failure> {
        check_extension("--uv", self.uv.as_deref(), &["obj", "glb"])?;
        check_extension("--sphere", self.sphere.as_deref(), &["obj", "glb"])?;
        check_extension("--picture", self.picture.picture.as_deref(), &["png", "svg"])?;
        self.flat.check()?;
        check_corners(self)?;
        check_method(self)?;
        let values = match &self.to {
            Some(MapTarget::File(path)) => Some(&**path),
            _ => None,
        };
        let files = [
            &self.uv,
            &self.flat.flat,
            &self.sphere,
            &self.trace,
            &self.picture.picture,
            &self.common.report,
        ];
        check_outputs(&[Some(&self.surface.file.mesh), values], &files.map(|file| file.as_deref()))
    }

    fn compute(&self, run: &mut CommandRun<'_>) -> Result<HarmonicOutcome, Failure> {
        let input = input::surface(&self.surface, &mut run.seconds, run.control)?;
        let usual = if input.mesh().is_closed() { MapTarget::Sphere } else { MapTarget::Disk };
        let to = self.to.clone().unwrap_or(usual);
        check_surface(self, &input, &to)?;
        HarmonicOutcome::new(input, self, to, run)
    }

    fn write(&self, outcome: &HarmonicOutcome, run: &mut CommandRun<'_>) -> Result<(), Failure> {
        let picture = self.picture.picture.as_deref();
        run.file("trace", self.trace.as_deref(), |outputs, path| {
            outputs.add(path, |out| write_energies(out, outcome.energies()))
        })?;
        match &outcome.map {
            MappedSurface::Plane(plane) => {
                let input = outcome.mapped_input();
                run.file("uv", self.uv.as_deref(), |outputs, path| plane.write(outputs, path, input))?;
                run.file("flat", self.flat.flat.as_deref(), |outputs, path| {
                    plane.write_flat(outputs, path, input, &self.flat)
                })?;
                run.picture("picture", picture, || plane.draw(input, self))
            }
            MappedSurface::Sphere(map) => {
                let write = |outputs: &mut _, path: &_| write_sphere(outputs, path, outcome, map);
                run.file("sphere", self.sphere.as_deref(), write)?;
                run.picture("picture", picture, || draw_sphere(outcome, map, self))
            }
        }
    }

    fn settings<'a>(&'a self, outcome: &'a HarmonicOutcome) -> impl Serialize + 'a {
        let input_geometry = outcome.input.surface.geometry().name();
        HarmonicSettings { input_geometry, args: self, to: &outcome.to }
    }
}

/// The energy of a heat flow at its start and after each step.
fn write_energies(out: &mut impl Write, energies: &[f64]) -> std::io::Result<()> {
    writeln!(out, "step,energy")?;
    energies.iter().enumerate().try_for_each(|(step, energy)| writeln!(out, "{step},{energy:?}"))
}

/// Refuse options that do not go with the method.
fn check_method(args: &HarmonicArgs) -> Result<(), Failure> {
    let is_heat = args.method == HarmonicMethodChoice::Heat;
    let refused = [
        (args.trace.is_some() && !is_heat, "--trace records the heat flow; add --method heat"),
        (args.step.is_some() && !is_heat, "--step is one of the heat flow; add --method heat"),
        (args.max_iterations.is_some() && !is_heat, "--max-iterations: of the heat flow; add --method heat"),
        (
            is_heat && args.to == Some(MapTarget::Rectangle),
            "--method heat: the rectangle's modulus comes from two linear solves; take --to polygon:4 or --method solve",
        ),
        (
            args.step.is_some() && args.to == Some(MapTarget::Sphere),
            "--step: steps to the sphere choose their own length",
        ),
    ];
    match refused.into_iter().find(|(refused, _)| *refused) {
        Some((_, why)) => Err(Failure::Usage(why.into())),
        None => Ok(()),
    }
}

/// Refuse corners that do not go with the target.
fn check_corners(args: &HarmonicArgs) -> Result<(), Failure> {
    let corners = args.corners.len();
    let refused = match &args.to {
        Some(MapTarget::Polygon(None)) if corners < 3 => Some(
            "--to polygon: say how many corners it has, --to polygon:N, or which they are, --corners V,V,V,…"
                .into(),
        ),
        Some(MapTarget::Polygon(Some(n))) if corners > 0 && corners != *n as usize => {
            Some(format!("--corners: {corners} boundary vertices for a polygon with {n} corners"))
        }
        Some(MapTarget::Polygon(_)) => None,
        Some(MapTarget::Rectangle) if corners == 0 || corners == 4 => None,
        Some(MapTarget::Rectangle) => Some("--corners: four boundary vertices for --to rectangle".into()),
        _ if corners > 0 => Some("--corners: for --to polygon or --to rectangle".into()),
        _ => None,
    };
    refused.map_or(Ok(()), |why| Err(Failure::Usage(why)))
}

/// Refuse what can be refused once the surface is known.
fn check_surface(args: &HarmonicArgs, input: &Input, to: &MapTarget) -> Result<(), Failure> {
    let is_sphere = *to == MapTarget::Sphere;
    let n = input.mesh().n_vertices();
    if let Some(v) = args.corners.iter().find(|v| **v as usize >= n) {
        return Err(Failure::Usage(format!("--corners: there is no vertex {v}, they are 0 to {}", n - 1)));
    }
    let mesh = input.mesh();
    let (loops, genus) = (mesh.boundary_loops().len(), mesh.genus());
    let needed = match to {
        MapTarget::Sphere if loops > 0 || genus > 0 => Some("a closed surface of genus 0"),
        MapTarget::Disk | MapTarget::Polygon(_) | MapTarget::Rectangle if loops != 1 || genus > 0 => {
            Some("a disk, of genus 0 with one boundary loop")
        }
        _ => None,
    };
    if let Some(needed) = needed {
        let path = input.path.display();
        let loops = count(loops, "boundary loop", "boundary loops");
        let why = format!("the surface has genus {genus} and {loops}; {needed} is needed");
        return Err(Failure::Input(format!("{path}: {why}; {}", way_out(mesh))));
    }
    let in_space = input.positions().is_some();
    let drawn = args.picture.picture.is_some();
    let refused = [
        (is_sphere && args.flat.flat.is_some(), "--flat: a sphere lies in no plane; use --sphere S.obj"),
        (is_sphere && args.uv.is_some(), "--uv: a sphere lies in no plane; use --sphere S.obj"),
        (!is_sphere && args.sphere.is_some(), "--sphere: the map is to the plane; use --uv, or --to sphere"),
        (is_sphere && args.picture.is_svg(), "--picture: an SVG shows no surface in space; use .png"),
        (args.uv.is_some() && !in_space, "--uv: an intrinsic metric has no positions in space; use --flat"),
        (
            drawn && !in_space && !args.picture.is_svg() && !is_sphere,
            "--picture: an intrinsic metric has no positions in space; use .svg",
        ),
    ];
    match refused.into_iter().find(|(refused, _)| *refused) {
        Some((_, why)) => Err(Failure::Usage(why.into())),
        None => args.flat.check_surface(input),
    }
}

/// The command for a surface that is no disk and no sphere, or not the one that was asked for.
fn way_out(mesh: &Mesh) -> &'static str {
    match (mesh.genus(), mesh.boundary_loops().len()) {
        (0, 0) => "--to sphere maps this one",
        (_, 0) => "`ricci uniformize` maps this one to the plane or the hyperbolic plane, cut open",
        (0, 1) => "--to disk maps this one",
        (0, 2) => {
            "`ricci circles` maps this one to the unit disk with a round hole, `ricci uniformize` to a flat cylinder"
        }
        _ => {
            "`ricci circles` maps this one to a domain whose holes are round, `ricci uniformize` to the hyperbolic plane with geodesic \
             boundary, or with --boundary straight to the plane"
        }
    }
}

/// The options of a run as its report has them.
#[derive(Serialize)]
struct HarmonicSettings<'a> {
    input_geometry: &'static str,
    #[serde(flatten)]
    args: &'a HarmonicArgs,
    to: &'a MapTarget,
}
