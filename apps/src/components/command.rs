//! The flows of all components of a file as one job.

use super::outcome::{ComponentFlow, ComponentsOutcome};
use super::uv;
use crate::failure::Failure;
use crate::flow;
use crate::flow_args::{FlowArgs, PinChoice, TargetChoice};
use crate::input::{self, FileContent, Input};
use crate::options::OnChoice;
use crate::output::{check_extension, check_outputs};
use crate::report::InputSummary;
use crate::runner::{CommandRun, Job, JobHeader};
use crate::timing::timed;
use ricci::control::Stage;
use ricci::geometry::Space;
use ricci::mesh::check::diagnose;
use ricci::mesh::components::{Component, components};
use ricci::mesh::io::Soup;
use serde::{Serialize, Serializer};

/// `ricci flow` on each component of its file.
pub struct ComponentsJob<'a>(pub &'a FlowArgs);

impl Serialize for ComponentsJob<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.serialize(serializer)
    }
}

impl Job for ComponentsJob<'_> {
    type Outcome = ComponentsOutcome;

    fn header(&self) -> JobHeader<'_> {
        self.0.header()
    }

    fn check(&self) -> Result<(), Failure> {
        let args = self.0;
        check_options(args)?;
        check_extension("--uv", args.to.uv.as_deref(), &["obj", "glb"])?;
        let files = [&args.to.uv, &args.to.common.report];
        check_outputs(&[Some(args.to.surface.file.mesh.as_path())], &files.map(|file| file.as_deref()))
    }

    fn compute(&self, run: &mut CommandRun<'_>) -> Result<ComponentsOutcome, Failure> {
        let args = self.0;
        let path = &args.to.surface.file.mesh;
        run.control.step(Stage::Read, 0.0)?;
        let soup = match timed(&mut run.seconds.read, || input::content(&args.to.surface.file))? {
            FileContent::Triangles(soup) => *soup,
            FileContent::Lengths(_) => {
                return Err(Failure::Usage(
                    "--components: a file of lengths is one surface; leave --components out".into(),
                ));
            }
        };
        if let Some(why) = input::out_of_range(&soup) {
            return Err(Failure::Input(format!("{}: {why}", path.display())));
        }
        let pieces = timed(&mut run.seconds.build, || components(&soup, &run.control.still()))?;
        let summary = InputSummary::new(path, &diagnose(&soup.positions, &soup.faces));
        let mut flows = Vec::with_capacity(pieces.len());
        for piece in pieces {
            flows.push(flow_of(args, piece, run)?);
        }
        Ok(ComponentsOutcome { soup: Soup { attributes: Default::default(), ..soup }, summary, flows })
    }

    fn write(&self, outcome: &ComponentsOutcome, run: &mut CommandRun<'_>) -> Result<(), Failure> {
        let Some(path) = &self.0.to.uv else { return Ok(()) };
        let written = uv::write(&mut run.outputs, path, outcome, self.0.to.on);
        if let Some(added) = run.failed.attempt("uv", written)? {
            run.added = added;
        }
        Ok(())
    }
}

/// The flow of one component.
fn flow_of(args: &FlowArgs, piece: Component, run: &mut CommandRun<'_>) -> Result<ComponentFlow, Failure> {
    let Component { soup, vertices, faces } = piece;
    let geometry = args.to.surface.input_geometry.map(Space::from);
    let (surface, attributes) = timed(&mut run.seconds.build, || input::in_space(soup, geometry))?;
    let input = Input { path: args.to.surface.file.mesh.clone(), surface, attributes, split: None };
    let outcome = flow::flow_of(args, input, run)?;
    Ok(ComponentFlow { outcome, vertices, faces })
}

/// Refuse options that name elements of one surface, and files that hold one.
fn check_options(args: &FlowArgs) -> Result<(), Failure> {
    let by_vertex =
        matches!(args.target, Some(TargetChoice::Single(_) | TargetChoice::Cones(_) | TargetChoice::File(_)));
    let refused = [
        ("--target single, cones and file", by_vertex),
        ("--pin V,V", matches!(args.pin, Some(PinChoice::Vertices(_)))),
        ("--keep-edges", args.keep_edges.is_some()),
        ("--outer", args.outer.is_some()),
        ("--metric", args.to.metric.is_some()),
        ("--circles", args.circles.is_some()),
        ("--trace", args.trace.is_some()),
        ("--xref", args.to.xref.is_some()),
        ("--flat", args.to.flat.flat.is_some()),
        ("--repair", args.to.repair),
        ("--charts", args.charts),
        ("--homogeneous", args.homogeneous),
        ("--picture", args.picture.base.picture.is_some()),
    ];
    if let Some((option, _)) = refused.into_iter().find(|(_, given)| *given) {
        return Err(Failure::Usage(format!(
            "{option}: belongs to one surface; take one component (ricci repair --component K), or leave \
             --components out"
        )));
    }
    if args.to.on == OnChoice::Input && args.to.uv.is_none() {
        return Err(Failure::Usage("--on input says which faces --uv has; add --uv".into()));
    }
    flow::check_options(args)
}
