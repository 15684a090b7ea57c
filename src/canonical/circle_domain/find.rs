//! Finds the circle domain of a surface; refines loops whose circles overlap.

use super::domain::CircleDomain;
use super::options::{CircleDomainOptions, DomainFrame, Normalisation};
use super::prepare::{PreparedSurface, halve_loops, refine};
use super::{closed, planar, strip};
use crate::control::Control;
use crate::error::{Error, Result};
use crate::metric::{Split, Surface};
use crate::parallel::Pool;

/// Modulus above which an annulus is not tried in the unit disk at all: the disk has held one of 6.2, and not one of 12. The modulus is only
/// known up to a factor of about 2.
const MOST_IN_DISK: f64 = 24.0;
/// How many times the edges of loops whose circles overlap are halved.
const ROUNDS: usize = 4;

/// A surface with boundary as a circle domain: of genus 0 in the unit disk, whose circle is one of the loops; of genus 1 in a flat torus;
/// of more in a hyperbolic surface.
///
/// If circles overlap, because loops with few edges lie close together, the edges of these loops are halved and the flow starts again.
/// The result is the same for any number of threads.
///
/// # Errors
/// [`Error::Argument`] for a closed surface, a loop or vertex that does not exist, a normalisation that does not fit the surface;
/// [`Error::Layout`] where no plane was found, and where circles overlap however fine the loops are, which it names; those of
/// [`crate::flow::Flow::new`]; [`Error::Cancelled`].
pub fn circle_domain(
    surface: &Surface,
    options: &CircleDomainOptions,
    control: &Control,
) -> Result<CircleDomain> {
    control.check()?;
    options.check(surface)?;
    Pool::new(options.flow.threads)?.run(|| {
        let mut split = Split::new(surface);
        refine(&mut split, options)?;
        for round in 1.. {
            let domain = solve(PreparedSurface::new(split, options, control)?, options, control)?;
            let overlapping = domain.overlapping();
            if overlapping.is_empty() {
                return Ok(domain);
            }
            if round > ROUNDS {
                return Err(crowded(&overlapping));
            }
            log::debug!("circles of loops {overlapping:?} overlap: their edges are halved");
            split = domain.split;
            halve_loops(&mut split, &overlapping)?;
        }
        Err(crowded(&[]))
    })
}

/// The error of loops whose circles overlap.
fn crowded(loops: &[usize]) -> Error {
    Error::Layout(format!(
        "the circles of boundary loops {loops:?} overlap, also with their edges halved {ROUNDS} times: refine the surface between these loops (`ricci refine --edge L`)"
    ))
}

fn solve(
    prepared: PreparedSurface,
    options: &CircleDomainOptions,
    control: &Control,
) -> Result<CircleDomain> {
    if prepared.surface.mesh().genus() > 0 {
        return closed::solve(prepared, options, control);
    }
    let may_open = options.frame == DomainFrame::Auto
        && prepared.filled.loops.len() == 2
        && options.normalisation == Normalisation::Centred;
    match options.frame {
        DomainFrame::Strip => strip::solve(prepared, options, control),
        _ if may_open && strip::modulus_estimate(&prepared.surface, control)? > MOST_IN_DISK => {
            strip::solve(prepared, options, control)
        }
        _ if may_open => match planar::solve(prepared.clone(), options, control) {
            Ok(domain) if domain.is_exact() => Ok(domain),
            Err(Error::Cancelled) => Err(Error::Cancelled),
            disk => {
                log::debug!(
                    "the inner circle of an annulus is not held in the unit disk: it is laid out in a strip"
                );
                match (disk, strip::solve(prepared, options, control)) {
                    (_, Err(Error::Cancelled)) => Err(Error::Cancelled),
                    (_, Ok(strip)) if strip.is_exact() => Ok(strip),
                    (disk, _) => disk,
                }
            }
        },
        _ => planar::solve(prepared, options, control),
    }
}
