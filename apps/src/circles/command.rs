//! `ricci circles` as a job: what it refuses, computes, writes and reports.

use super::args::{CirclesArgs, FrameChoice};
use super::outcome::CirclesOutcome;
use super::picture;
use crate::failure::{Failure, NO_POSITIONS};
use crate::flat::FlatLayout;
use crate::input::{self, Input};
use crate::metric_file::MetricFile;
use crate::options::OnChoice;
use crate::output::{Outputs, check_extension, check_outputs};
use crate::picture::TextureChoice;
use crate::report::timed;
use crate::runner::{CommandRun, Job, JobHeader};
use crate::uv::{self, UvOptions};
use ricci::canonical::{CircleDomainOptions, DomainFrame, Normalisation, circle_domain};
use ricci::flow::Options;
use ricci::mesh::{PerVertex, VertexId};
use serde::Serialize;
use std::path::Path;

impl Job for CirclesArgs {
    type Outcome = CirclesOutcome;

    fn header(&self) -> JobHeader<'_> {
        JobHeader { name: "circles", common: &self.common, mesh: Some(&self.surface.file.mesh) }
    }

    fn check(&self) -> Result<(), Failure> {
        let picture = self.picture.picture.as_deref();
        check_extension("--uv", self.uv.as_deref(), &["obj", "glb"])?;
        check_extension("--picture", picture, &["png", "svg"])?;
        if self.frame == FrameChoice::Strip && (self.centre.is_some() || self.three.is_some()) {
            let why = "--center, --three: places in the unit disk; leave them or --frame strip out";
            return Err(Failure::Usage(why.into()));
        }
        self.flat.check()?;
        if self.picture.is_svg() && self.picture.is_turned() {
            let why = "--view, --up: an SVG shows the layout alone; use .png, or leave them out";
            return Err(Failure::Usage(why.into()));
        }
        let flat = &self.flat.flat;
        let bounds = &self.modulus.bounds;
        let files =
            [&self.metric, &self.uv, &self.xref, flat, bounds, &self.picture.picture, &self.common.report];
        check_outputs(&[Some(&self.surface.file.mesh)], &files.map(|file| file.as_deref()))
    }

    fn compute(&self, run: &mut CommandRun<'_>) -> Result<CirclesOutcome, Failure> {
        let input = input::surface(&self.surface, &mut run.seconds, run.control)?;
        check_surface(self, &input)?;
        let mut taken = 0.0;
        let domain = timed(&mut taken, || circle_domain(&input.surface, &options(self), run.control))?;
        let bounds = match domain.modulus {
            Some(_) => Some(self.modulus.find(&input, &[], run)?),
            None => None,
        };
        let mut outcome = CirclesOutcome::new(input, domain, self.tolerance, taken, &mut run.seconds)?;
        outcome.modulus = bounds;
        Ok(outcome)
    }

    fn write(&self, outcome: &CirclesOutcome, run: &mut CommandRun<'_>) -> Result<(), Failure> {
        let CirclesOutcome { halved, laid, .. } = outcome;
        run.file("metric", self.metric.as_deref(), |outputs, path| write_metric(outputs, path, outcome))?;
        run.file("uv", self.uv.as_deref(), |outputs, path| {
            uv::write(outputs, path, halved, laid, UvOptions::default()).map(drop)
        })?;
        run.file("xref", self.xref.as_deref(), |outputs, path| {
            outputs.add(path, |out| uv::write_origins(out, halved, laid, OnChoice::Refined))
        })?;
        run.file("flat", self.flat.flat.as_deref(), |outputs, path| {
            FlatLayout::new(halved, laid, OnChoice::Refined)?.write(outputs, path, &self.flat)
        })?;
        self.modulus.write(outcome.modulus.as_ref(), run)?;
        let style = self.picture.style(self.texture.unwrap_or(TextureChoice::Circles), self.common.threads);
        let draw = || picture::draw(outcome, &style, self.picture.is_svg());
        run.picture("picture", self.picture.picture.as_deref(), draw)
    }

    fn settings<'a>(&'a self, outcome: &'a CirclesOutcome) -> impl Serialize + 'a {
        let drawn = self.picture.picture.is_some();
        CirclesSettings {
            input_geometry: outcome.input.surface.geometry().name(),
            outer: outcome.domain.outer,
            texture: self.texture.or(drawn.then_some(TextureChoice::Circles)),
            args: self,
        }
    }
}

/// Refuse what can be refused once the surface is known.
fn check_surface(args: &CirclesArgs, input: &Input) -> Result<(), Failure> {
    let mesh = input.mesh();
    if mesh.is_closed() {
        let path = input.path.display();
        return Err(Failure::Input(format!(
            "{path}: the surface is closed, it has no loops to make round; use ricci uniformize"
        )));
    }
    let (usage, n) = (|why: String| Err(Failure::Usage(why)), mesh.boundary_loops().len());
    if mesh.genus() > 0 {
        let of_disk = [
            ("--outer", args.outer.is_some()),
            ("--center", args.centre.is_some()),
            ("--three", args.three.is_some()),
            ("--frame", args.frame != FrameChoice::Auto),
        ];
        if let Some((option, _)) = of_disk.iter().find(|(_, asked)| *asked) {
            let genus = mesh.genus();
            return usage(format!(
                "{option}: a surface of genus {genus} does not lie in the unit disk; leave it out"
            ));
        }
    }
    if args.frame == FrameChoice::Strip && n != 2 {
        return usage(format!(
            "--frame strip: a surface with two loops lies in a strip, this one has {n}; leave it out"
        ));
    }
    if let Some(k) = args.outer.filter(|&k| k >= n) {
        return usage(format!("--outer {k}: there is no such loop, they are 0 to {}", n - 1));
    }
    if args.uv.is_some() && input.positions().is_none() {
        return usage(format!("--uv: {NO_POSITIONS}; --flat OUT.obj writes the layout as a flat mesh"));
    }
    if args.flat.flat.is_some() && mesh.genus() > 1 {
        return usage(
            "--flat: the layout lies in the hyperbolic plane, which is not flat; --uv has its Poincaré disk"
                .into(),
        );
    }
    args.flat.check_surface(input)
}

fn options(args: &CirclesArgs) -> CircleDomainOptions {
    let normalisation = match (&args.three, args.centre) {
        (Some(three), _) => {
            Normalisation::Three(three.vertices.map(VertexId), three.degrees.map(f64::to_radians))
        }
        (None, Some(v)) => Normalisation::Vertex(VertexId(v)),
        (None, None) => Normalisation::Centred,
    };
    let flow = Options {
        tolerance: args.tolerance,
        max_iterations: args.max_iterations as usize,
        threads: args.common.threads,
        ..Options::default()
    };
    CircleDomainOptions {
        outer: args.outer,
        normalisation,
        frame: args.frame.into(),
        least_loop: args.least_loop,
        flow,
    }
}

/// Write the metric of the surface with its disks; in the unit disk without the hub of the outer loop, whose disk lies outside.
fn write_metric(outputs: &mut Outputs, path: &Path, outcome: &CirclesOutcome) -> Result<(), Failure> {
    let domain = &outcome.domain;
    let target = PerVertex::filled(domain.metric.mesh().n_vertices(), 0.0);
    let file = MetricFile::new(&domain.metric, &target)?;
    let Some(outer) = domain.outer.filter(|_| domain.frame == DomainFrame::Disk) else {
        return outputs.add(path, |out| file.write(out));
    };
    let file = file.without(domain.filled.hub(outer).index());
    let curvature = file.curvature();
    let file = file.free_on_boundary(&curvature);
    outputs.add(path, |out| file.write(out))
}

/// The options of a run as its report has them.
#[derive(Serialize)]
struct CirclesSettings<'a> {
    input_geometry: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    outer: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    texture: Option<TextureChoice>,
    #[serde(flatten)]
    args: &'a CirclesArgs,
}
