//! Both commands from beginning to end.

use super::args::{CanonicalArgs, CoverArgs, Shown, TilesChoice, UniformizeArgs};
use super::needs::Task;
use super::quotient::Uniformized;
use super::request::{CoverWish, Wish};
use super::shape::Shape;
use super::sphere::{Round, flowed, punctured};
use super::summary;
use crate::delivery::Delivery;
use crate::failure::Failure;
use crate::input::{self, Input};
use crate::progress::Progress;
use crate::report::{Done, timed};
use ricci::Control;
use ricci::canonical::{self, QuotientOptions, Uniformization};
use ricci::mesh::VertexId;
use std::time::Instant;

/// Run `ricci uniformize` and say what came out.
pub fn uniformize(args: &UniformizeArgs, control: &Control) -> Result<u8, Failure> {
    let done = execute_uniformize(args, control)?;
    if !args.canonical.to.common.quiet {
        summary::say(&done, false)?;
    }
    Ok(done.exit_code)
}

/// Run `ricci cover` and say what came out.
pub fn cover(args: &CoverArgs, control: &Control) -> Result<u8, Failure> {
    let done = execute_cover(args, control)?;
    if !args.canonical.to.common.quiet {
        summary::say(&done, true)?;
    }
    Ok(done.exit_code)
}

pub fn execute_uniformize(args: &UniformizeArgs, control: &Control) -> Result<Done<Shape>, Failure> {
    let shown = args.show.map(Shown::Uniform);
    execute(
        &Wish { args: &args.canonical, command: "uniformize", shown, model: args.model, cover: None },
        control,
    )
}

pub fn execute_cover(args: &CoverArgs, control: &Control) -> Result<Done<Shape>, Failure> {
    let cover = Some(CoverWish::new(args));
    let shown = Some(Shown::Cover(args.show.unwrap_or(TilesChoice::Tiles)));
    execute(&Wish { args: &args.canonical, command: "cover", shown, model: args.model, cover }, control)
}

/// The base vertex that was asked for, if it is one.
fn base(input: &Input, args: &CanonicalArgs) -> Result<Option<VertexId>, Failure> {
    let n = input.mesh().n_vertices();
    match args.base {
        Some(v) if v as usize >= n => {
            Err(Failure::Usage(format!("--base {v}: there is no such vertex, they are 0 to {}", n - 1)))
        }
        base => Ok(base.map(VertexId)),
    }
}

/// The surface uniformized by the library.
fn shape(task: &Task<'_>) -> Result<Shape, Failure> {
    let Task { input, args, control, .. } = *task;
    let (base, mut taken) = (base(input, args)?, 0.0);
    let options = QuotientOptions {
        scheme: args.to.solve.scheme.into(),
        base,
        boundary: args.boundary.to_library(),
        flow: args.to.options(),
    };
    Ok(match timed(&mut taken, || canonical::uniformize(&input.surface, &options, control))? {
        Uniformization::Sphere(sphere) => {
            Shape::Sphere(Box::new(Round::new(task, punctured(*sphere), taken)?))
        }
        Uniformization::FlowedSphere(sphere) => {
            Shape::Sphere(Box::new(Round::new(task, flowed(*sphere), taken)?))
        }
        Uniformization::Quotient(quotient) => {
            Shape::Quotient(Box::new(Uniformized::new(task, *quotient, taken)?))
        }
    })
}

/// The exit code is 1 if a check fails or a file that was asked for has nothing to hold.
fn execute(wish: &Wish<'_>, control: &Control) -> Result<Done<Shape>, Failure> {
    let (start, to) = (Instant::now(), &wish.args.to);
    wish.check_request()?;
    let progress = Progress::watch(control, to.common.quiet);
    let input = input::surface(&to.surface, control)?;
    let shown = wish.check_surface(&input)?;
    let task = Task { input: &input, args: wish.args, needs: wish.needs(&input, shown), control };
    let mut shape = shape(&task)?;
    if let (Shape::Quotient(u), Some(cover)) = (&mut shape, &wish.cover) {
        cover.find(u, control)?;
    }
    let written = wish.write(&task, &mut shape, shown, Delivery::new(control, start)?)?;
    drop(progress);
    let checks = shape.checks();
    let exit_code = if shape.solved().failed.0.is_empty() { checks.exit_code() } else { 1 };
    let (files, figures) = written;
    let seconds = start.elapsed().as_secs_f64();
    Ok(Done { input, result: shape, figures, checks, files, seconds, exit_code })
}
