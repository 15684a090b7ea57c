//! `ricci uniformize` and `ricci cover` as jobs: the metric of constant curvature is computed here.

use super::lifts::lifts;
use super::quotient::Uniformized;
use super::request::CanonicalJob;
use super::shape::{CanonicalOutcome, UniformShape};
use super::sphere::{SphereSurface, flowed, punctured};
use super::task::CanonicalTask;
use crate::failure::Failure;
use crate::input;
use crate::report::timed;
use crate::runner::{CommandRun, Job, JobHeader};
use ricci::canonical::{self, QuotientOptions, Uniformization};
use ricci::mesh::VertexId;
use serde::Serialize;

impl Job for CanonicalJob<'_> {
    type Outcome = CanonicalOutcome;

    fn header(&self) -> JobHeader<'_> {
        let mesh = Some(&*self.args.to.surface.file.mesh);
        JobHeader { name: self.command, common: &self.args.to.common, mesh }
    }

    fn check(&self) -> Result<(), Failure> {
        self.check_request()
    }

    fn compute(&self, run: &mut CommandRun<'_>) -> Result<CanonicalOutcome, Failure> {
        let input = input::surface(&self.args.to.surface, &mut run.seconds, run.control)?;
        let shown = self.check_surface(&input)?;
        let needs = self.needs(&input, shown);
        let task = CanonicalTask { input: &input, args: self.args, needs, control: run.control };
        let mut shape = shape(&task, run)?;
        if let (UniformShape::Quotient(u), Some(cover)) = (&mut shape, &self.cover) {
            cover.find(u, run)?;
            u.lifts = lifts(u, cover, &input)?;
        }
        if let (UniformShape::Quotient(u), Some(modulus)) = (&mut shape, self.modulus)
            && u.extremal_distance.is_some()
        {
            let corners: Vec<VertexId> = u.corners.iter().map(|corner| corner.0).collect();
            u.modulus = Some(modulus.find(&input, &corners, run)?);
        }
        Ok(CanonicalOutcome { input, shape, shown, has_copies: self.cover.is_some() })
    }

    fn write(&self, outcome: &CanonicalOutcome, run: &mut CommandRun<'_>) -> Result<(), Failure> {
        if let (Some(modulus), UniformShape::Quotient(u)) = (self.modulus, &outcome.shape) {
            modulus.write(u.modulus.as_ref(), run)?;
        }
        self.write_files(outcome, run)
    }

    fn settings<'a>(&'a self, outcome: &'a CanonicalOutcome) -> impl Serialize + 'a {
        let base = match &outcome.shape {
            UniformShape::Quotient(u) => Some(u.basis.base.0),
            UniformShape::Sphere(_) => self.args.base,
        };
        self.settings_of(&outcome.input, base, outcome.shown)
    }
}

/// The surface uniformized by the library.
fn shape(task: &CanonicalTask<'_>, run: &mut CommandRun<'_>) -> Result<UniformShape, Failure> {
    let CanonicalTask { input, args, control, .. } = *task;
    input.check_vertex("--base", args.base)?;
    let (base, mut taken) = (args.base.map(VertexId), 0.0);
    let options = QuotientOptions {
        scheme: args.to.solve.scheme.into(),
        base,
        boundary: args.boundary.to_library(),
        flow: args.to.options(),
    };
    let sphere = |found, taken, run: &mut CommandRun<'_>| -> Result<UniformShape, Failure> {
        Ok(UniformShape::Sphere(Box::new(SphereSurface::new(task, found, taken, run)?)))
    };
    match timed(&mut taken, || canonical::uniformize(&input.surface, &options, control))? {
        Uniformization::Sphere(found) => sphere(punctured(*found), taken, run),
        Uniformization::FlowedSphere(found) => sphere(flowed(*found), taken, run),
        Uniformization::Quotient(quotient) => {
            Ok(UniformShape::Quotient(Box::new(Uniformized::new(task, *quotient, taken, run)?)))
        }
    }
}
