//! Progress of long calls never goes back and does not end early, and each check of a control can end the call.

use crate::common::Random;
use ricci::canonical::{CircleDomainOptions, QuotientOptions, circle_domain, uniformize};
use ricci::control::EndQuestion;
use ricci::flow::Options;
use ricci::geometry::Space;
use ricci::mesh::io::Soup;
use ricci::mesh::{Mesh, shapes};
#[cfg(feature = "splines")]
use ricci::spline::{FlatMetric, FlatMetricOptions, SurfaceFitOptions, fit_surface_over};
use ricci::structure::{AtlasOptions, atlas};
use ricci::{Class, Control, Error, Flow, Result, Surface, Target};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

fn surface(mut soup: Soup, noise: f64) -> Surface {
    let mut random = Random::new(7);
    soup.positions.as_flattened_mut().iter_mut().for_each(|x| *x += noise * random.symmetric());
    Surface::in_space(Mesh::from_soup(&soup).unwrap(), soup.positions).unwrap()
}

/// The fractions at the checks of a call, one after the other.
fn fractions(work: &dyn Fn(&Control) -> Result<()>) -> Vec<f64> {
    let seen = Arc::new(Mutex::new(Vec::new()));
    let of_question = seen.clone();
    let question: Arc<dyn EndQuestion> = Arc::new(move |(_, fraction)| {
        of_question.lock().unwrap().push(fraction);
        false
    });
    work(&Control::new().asking(question)).unwrap();
    Arc::try_unwrap(seen).map_or_else(|seen| seen.lock().unwrap().clone(), |seen| seen.into_inner().unwrap())
}

/// The number of checks beyond the one that ends the call.
fn checks_after_end(work: &dyn Fn(&Control) -> Result<()>, end: usize) -> usize {
    let count = Arc::new(AtomicUsize::new(0));
    let of_question = count.clone();
    let question: Arc<dyn EndQuestion> =
        Arc::new(move |_| of_question.fetch_add(1, Ordering::Relaxed) + 1 >= end);
    assert_eq!(work(&Control::new().asking(question)), Err(Error::Cancelled), "ended at check {end}");
    count.load(Ordering::Relaxed) - end
}

/// Steps of each call at which it is ended.
const ENDS: usize = 6;
/// Checks beyond the one that ends the call: loops in parallel make one for each element that is left, such as the charts of an atlas.
const MOST_BEYOND: usize = 1024;

fn judge(what: &str, work: &dyn Fn(&Control) -> Result<()>) {
    let seen = fractions(work);
    assert!(seen.is_sorted(), "{what}: progress goes back in {seen:?}");
    let mut different = seen.clone();
    different.dedup();
    println!(
        "{what}: {} checks, {} fractions, {:.2} at the last",
        seen.len(),
        different.len(),
        seen[seen.len() - 1]
    );
    // Fits that hold at the first attempt leave the part of further ones out.
    assert!(different.len() >= 3 && seen[seen.len() - 1] >= 0.35, "{what}: {different:?}");
    let whole = seen.iter().position(|&fraction| fraction == 1.0).unwrap_or(seen.len());
    assert!(10 * whole >= 5 * seen.len(), "{what}: 1 at check {whole} of {}", seen.len());
    for k in 0..ENDS {
        let beyond = checks_after_end(work, 1 + k * (seen.len() - 1) / ENDS);
        assert!(beyond <= MOST_BEYOND, "{what}: {beyond} checks after the end");
    }
}

#[test]
fn of_flows() {
    let torus = surface(shapes::torus(2.0, 0.8, 60, 30).unwrap(), 0.02);
    judge("flow to placed cones", &|control| {
        let class = Class::yamabe(Space::E2);
        Flow::new(torus.clone(), class, &Options::default(), control)?.solve(&Target::Auto(4), control)?;
        Ok(())
    });
}

#[test]
fn of_canonical_shapes() {
    let torus = surface(shapes::torus(2.0, 0.8, 40, 24).unwrap(), 0.01);
    judge("uniformize", &|control| uniformize(&torus, &QuotientOptions::default(), control).map(drop));
    let annulus = surface(shapes::annulus(0.4, 1.0, 8, 40).unwrap(), 0.0);
    judge("circle domain", &|control| {
        circle_domain(&annulus, &CircleDomainOptions::default(), control).map(drop)
    });
    judge("atlas", &|control| atlas(&torus, &AtlasOptions::default(), control).map(drop));
}

#[test]
#[cfg(feature = "splines")]
fn of_fits_of_splines() {
    let torus = surface(shapes::torus(2.0, 0.8, 24, 16).unwrap(), 0.0);
    judge("spline fit", &|control| {
        let options = FlatMetricOptions::default();
        let metrics = FlatMetric::candidates(&torus, &options, &control.part(0.0, 0.2))?;
        let options = SurfaceFitOptions { rounds: 2, corrections: 6, ..SurfaceFitOptions::default() };
        fit_surface_over(&torus, &metrics, &options, &control.part(0.2, 1.0)).map(drop)
    });
}
