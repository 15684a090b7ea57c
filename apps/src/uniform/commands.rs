//! Both commands from beginning to end.

use super::args::{CanonicalArgs, CoverArgs, Shown, TilesChoice, UniformizeArgs};
use super::needs::Needs;
use super::quotient::Uniformized;
use super::request::{CoverWish, Wish};
use super::shape::Shape;
use super::sphere::{Round, flowed, punctured};
use super::summary;
use crate::failure::Failure;
use crate::input::{self, Input};
use crate::options::MethodChoice;
use crate::progress::Progress;
use crate::report::{Done, timed};
use ricci::Control;
use ricci::canonical::{self, QuotientOptions, Uniformization};
use ricci::mesh::VertexId;
use std::time::Instant;

/// Run `ricci uniformize` and say what came out.
pub fn uniformize(args: &UniformizeArgs, control: &Control) -> Result<u8, Failure> {
    let done = execute_uniformize(args, control)?;
    if !args.canonical.common.quiet {
        summary::say(&done, false);
    }
    Ok(done.exit_code)
}

/// Run `ricci cover` and say what came out.
pub fn cover(args: &CoverArgs, control: &Control) -> Result<u8, Failure> {
    let done = execute_cover(args, control)?;
    if !args.canonical.common.quiet {
        summary::say(&done, true);
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
    let cover = CoverWish {
        depth: args.depth.map_or(2, usize::from),
        radius: args.radius,
        limit: args.limit as usize,
        cover: args.cover.as_deref(),
        domain: args.domain.as_deref(),
    };
    let shown = Some(Shown::Cover(args.show.unwrap_or(TilesChoice::Copies)));
    execute(
        &Wish { args: &args.canonical, command: "cover", shown, model: args.model, cover: Some(cover) },
        control,
    )
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

/// Uniformize a closed surface: by the library's one call, but for the paper's flow of spheres.
fn shape(input: &Input, args: &CanonicalArgs, needs: Needs, control: &Control) -> Result<Shape, Failure> {
    let (base, mut taken) = (base(input, args)?, 0.0);
    if input.mesh().euler() > 0 && args.solve.method == MethodChoice::Gradient {
        let found = timed(&mut taken, || flowed(input, args, base, control))?;
        return Ok(Shape::Sphere(Box::new(Round::new(input, args, found, taken, needs, control)?)));
    }
    let flow = args.solve.options(args.common.threads());
    let options = QuotientOptions { scheme: args.solve.scheme.into(), base, flow };
    Ok(match timed(&mut taken, || canonical::uniformize(&input.surface, &options, control))? {
        Uniformization::Sphere(sphere) => {
            let found = punctured(*sphere);
            Shape::Sphere(Box::new(Round::new(input, args, found, taken, needs, control)?))
        }
        Uniformization::Quotient(quotient) => {
            Shape::Quotient(Box::new(Uniformized::new(input, *quotient, taken, needs, control)?))
        }
    })
}

/// The exit code is 1 if a check fails or a file that was asked for has nothing to hold.
fn execute(wish: &Wish<'_>, control: &Control) -> Result<Done<Shape>, Failure> {
    let (start, args) = (Instant::now(), wish.args);
    wish.check_request()?;
    let progress = Progress::watch(control, args.common.quiet);
    let input = input::read(&args.surface, control)?;
    let shown = wish.check_surface(&input)?;
    let needs = wish.needs(shown);
    let mut shape = shape(&input, args, needs, control)?;
    if let (Shape::Quotient(u), Some(cover)) = (&mut shape, &wish.cover) {
        cover.find(u, control)?;
    }
    let checks = shape.checks();
    let files = wish.write(&input, &mut shape, &checks, shown, control, start)?;
    drop(progress);
    let exit_code = if shape.failed().0.is_empty() { checks.exit_code() } else { 1 };
    Ok(Done { input, result: shape, checks, files, seconds: start.elapsed().as_secs_f64(), exit_code })
}
