//! Points per second at which splines over the plane and over surfaces are evaluated on one core, compared with the bare recurrence.
//!
//! `cargo bench --bench spline`; its table is in `docs/results/bench-spline.md`. The yardstick evaluates each basis function by itself, by
//! the recurrence of its definition ([`ricci::spline::simplex_spline`]), for the patches in whose knots' hull the point lies; both evaluate
//! the same points in the same round, and the medians of five rounds are given. *Nearest points* are those to vertices of the mesh.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use ricci::mesh::io::Soup;
use ricci::mesh::shapes::{self, SplitMix64};
use ricci::spline::{
    FlatMetric, FlatMetricOptions, KnotOptions, Parameter, PlaneDomain, Spline, SplineSpace,
    SurfaceFitOptions, fit_surface, multi_indices, simplex_spline,
};
use ricci::{Control, Surface};
use std::sync::Arc;
use std::time::Instant;

const ROUNDS: usize = 5;
/// Points of the shared evaluation; the yardstick takes every [`BARE`]th.
const POINTS: usize = 400_000;
const BARE: usize = 400;

/// A square of n × n cells, cut in two.
fn square(n: usize) -> PlaneDomain {
    let at = |i: usize, j: usize| (j * (n + 1) + i) as u32;
    let vertices = (0..(n + 1) * (n + 1)).map(|v| [(v % (n + 1)) as f64, (v / (n + 1)) as f64]).collect();
    let triangles = (0..n * n).flat_map(|c| {
        let (i, j) = (c % n, c / n);
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        if (i + j) % 2 == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
    });
    PlaneDomain { vertices, triangles: triangles.collect() }
}

fn places(space: &SplineSpace, random: &mut SplitMix64) -> Vec<Parameter> {
    let n = space.patches().len();
    let place = |i: usize| {
        let patch = (i * n / POINTS) as u32;
        let (mut s, mut t) = (random.unit(), random.unit());
        if s + t > 1.0 {
            (s, t) = (1.0 - s, 1.0 - t);
        }
        let c = [0, 1, 2].map(|k| space.patches()[patch as usize].knots[k][0]);
        let [x, y] = [0, 1].map(|x| c[0][x] * (1.0 - s - t) + c[1][x] * s + c[2][x] * t);
        Parameter { patch, x, y }
    };
    (0..POINTS).map(place).collect()
}

fn bare(surface: &Spline, at: Parameter) -> [f64; 3] {
    let space = surface.space();
    let mut sum = [0.0; 3];
    for support in &space.supports()[at.patch as usize] {
        let patch = &space.patches()[support.patch as usize];
        for (beta, &control) in multi_indices(space.degree()).zip(&patch.control) {
            let set: Vec<[f64; 2]> = (0..3).flat_map(|k| patch.knots[k][..=beta[k]].to_vec()).collect();
            let [a, b, c] = [0, 1, 2].map(|k| patch.knots[k][beta[k]]);
            let d = ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs();
            let weight = d * simplex_spline(&set, [at.x, at.y]);
            (0..3).for_each(|x| sum[x] += weight * surface.control_points()[control as usize][x]);
        }
    }
    sum
}

/// A spline over a closed surface, each patch in a chart of its own.
fn surface(soup: &Soup, degree: usize) -> Spline {
    let (control, surface) = (Control::new(), Surface::from_soup(soup).unwrap());
    let flat = FlatMetric::new(&surface, &FlatMetricOptions::default(), &control).unwrap();
    let options = SurfaceFitOptions { degree, rounds: 2, ..SurfaceFitOptions::default() };
    fit_surface(&surface, &flat, &options, &control).unwrap().spline
}

/// Rows of splines over surfaces: the median of the rounds per order of derivatives.
fn surfaces() {
    println!(
        "\n| surface | degree | patches | points | with first derivatives | with second | nearest points |"
    );
    println!("|---|---|---|---|---|---|---|");
    let torus = shapes::torus(2.0, 0.8, 96, 48).unwrap();
    let pretzel = shapes::genus(2, 12).unwrap();
    for (name, soup) in [("torus", &torus), ("genus 2", &pretzel)] {
        for degree in [3, 4] {
            let spline = surface(soup, degree);
            let places = places(spline.space(), &mut SplitMix64::new(1));
            let finder = spline.closest_points(1, &Control::new()).unwrap();
            let near = &soup.positions[..2000];
            let mut rounds: [Vec<f64>; 4] = Default::default();
            for _ in 0..ROUNDS {
                for order in 0..3 {
                    let start = Instant::now();
                    spline.evaluate(&places, order, 1, &Control::new()).unwrap();
                    rounds[order].push(POINTS as f64 / start.elapsed().as_secs_f64());
                }
                let start = Instant::now();
                finder.find(near, 1, &Control::new()).unwrap();
                rounds[3].push(near.len() as f64 / start.elapsed().as_secs_f64());
            }
            let [value, first, second, nearest] = rounds.map(|mut all| {
                all.sort_by(f64::total_cmp);
                all[ROUNDS / 2]
            });
            println!(
                "| {name} | {degree} | {} | {value:.0} | {first:.0} | {second:.0} | {nearest:.0} |",
                spline.space().patches().len()
            );
        }
    }
}

fn main() {
    planar();
    surfaces();
}

fn planar() {
    println!("| degree | spread | points | with first derivatives | with second | bare recurrence | ratio |");
    println!("|---|---|---|---|---|---|---|");
    for (degree, spread) in [(1, 0.5), (2, 0.5), (3, 0.25), (3, 0.5), (3, 0.75), (4, 0.5), (5, 0.5)] {
        let domain = square(12);
        let knots = domain.knots(degree, &KnotOptions { spread, ..KnotOptions::default() }).unwrap();
        let space = Arc::new(SplineSpace::planar(&domain, &knots).unwrap());
        let mut random = SplitMix64::new(1);
        let points =
            (0..space.n_control_points()).map(|_| [random.unit(), random.unit(), random.unit()]).collect();
        let surface = Spline::new(space.clone(), points).unwrap();
        let places = places(&space, &mut random);
        let mut rounds = Vec::new();
        for _ in 0..ROUNDS {
            let mut round = [0.0; 4];
            for order in 0..3 {
                let start = Instant::now();
                surface.evaluate(&places, order, 1, &Control::new()).unwrap();
                round[order] = POINTS as f64 / start.elapsed().as_secs_f64();
            }
            let start = Instant::now();
            let sum: f64 = places.iter().step_by(BARE).map(|&at| bare(&surface, at)[0]).sum();
            assert!(sum.is_finite());
            round[3] = (POINTS / BARE) as f64 / start.elapsed().as_secs_f64();
            rounds.push(round);
        }
        let [value, first, second, bare] = [0, 1, 2, 3].map(|k| {
            let mut all: Vec<f64> = rounds.iter().map(|round| round[k]).collect();
            all.sort_by(f64::total_cmp);
            all[ROUNDS / 2]
        });
        println!(
            "| {degree} | {spread} | {value:.0} | {first:.0} | {second:.0} | {bare:.0} | {:.0} |",
            value / bare
        );
    }
}
