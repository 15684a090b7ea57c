//! Layouts in the hyperbolic plane, deck groups and covers, against a yardstick that is linear up to a logarithm: shortest paths along the
//! edges of the same triangulation, in the same round.
//!
//! `cargo bench --bench cover [-- VERTICES…] > docs/results/bench-cover.md` (default: 10000 50000 200000 800000). The surface has
//! genus 3; a round is one of each job, one after the other, so that what else the machine does hits all alike; medians of five rounds.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::print_stderr)]

use ricci::canonical::{QuotientOptions, uniformize_quotient};
use ricci::embed::cover::{elements_to_depth, moved};
use ricci::embed::{DeckGroup, layout_in_space, refine_space_layout};
use ricci::mesh::{Mesh, shapes};
use ricci::parallel::Pool;
use ricci::topology::{homotopy_basis, shortest_paths};
use ricci::{Control, Surface};
use std::time::Instant;

const ROUNDS: usize = 5;
/// Copies that are placed.
const COPIES: usize = 13;

/// Jobs of a round, the yardstick first.
const JOBS: [&str; 6] =
    ["shortest paths", "layout", "refined layout", "homotopy basis", "deck group", "13 copies"];

/// Seconds of each job.
fn round(mesh: &Mesh, given: &ricci::canonical::Quotient) -> [f64; 6] {
    let control = Control::new();
    let metric = &given.metric;
    let lengths = metric.metric().lengths(mesh).unwrap();
    let base = given.basis.base;
    let refinement = metric.refinement(&control).unwrap();
    let mut seconds = [0.0; 6];
    let mut job = 0;
    let mut lap = Instant::now();
    let mut done = |lap: &mut Instant| {
        seconds[job] = lap.elapsed().as_secs_f64();
        job += 1;
        *lap = Instant::now();
    };
    shortest_paths(mesh, &lengths, [base]).unwrap();
    done(&mut lap);
    let layout = layout_in_space(mesh, metric.metric(), base, None, &control).unwrap();
    done(&mut lap);
    let refined = refine_space_layout(&layout, &refinement, mesh, &control).unwrap();
    done(&mut lap);
    let basis = homotopy_basis(mesh, &lengths, Some(base), &control).unwrap();
    done(&mut lap);
    let deck = DeckGroup::new(mesh, metric.metric(), &layout, &basis, &control).unwrap();
    done(&mut lap);
    let copies = elements_to_depth(&deck, 1, 1000, &control).unwrap();
    assert_eq!(copies.len(), COPIES);
    let sum: f64 = copies.iter().map(|g| moved(&refined.points, &g.motion)[0][2]).sum();
    assert!(sum.is_finite());
    done(&mut lap);
    seconds
}

fn median(mut x: Vec<f64>) -> f64 {
    x.sort_by(f64::total_cmp);
    x[x.len() / 2]
}

fn main() {
    let asked: Vec<usize> = std::env::args().filter_map(|a| a.parse().ok()).collect();
    let sizes = if asked.is_empty() { vec![10_000, 50_000, 200_000, 800_000] } else { asked };
    println!("# Bench of layouts in H², deck groups and covers\n");
    println!(
        "Made by `cargo bench --bench cover > docs/results/bench-cover.md`. A smooth surface of genus 3 in its hyperbolic metric, {ROUNDS} rounds: median"
    );
    println!(
        "seconds, and in brackets the median ratio to shortest paths (Dijkstra, along the edges of the same triangulation) in the same round. All"
    );
    println!(
        "jobs are linear in the size but for a logarithm, like that yardstick: the ratios do not grow.\n"
    );
    println!("| vertices | {} |", JOBS.join(" | "));
    println!("|---|{}", "---|".repeat(JOBS.len()));
    for vertices in sizes {
        let n = ((vertices as f64 / 128.0).sqrt().round() as usize).max(1);
        let surface = Surface::from_soup(&shapes::genus(3, n).unwrap()).unwrap();
        let given = uniformize_quotient(&surface, &QuotientOptions::default(), &Control::new()).unwrap();
        let final_mesh = given.metric.mesh().clone();
        let pool = Pool::new(0).unwrap();
        let rounds: Vec<[f64; 6]> = (0..ROUNDS).map(|_| pool.run(|| round(&final_mesh, &given))).collect();
        let cell = |job: usize| {
            let seconds = median(rounds.iter().map(|r| r[job]).collect());
            let ratio = median(rounds.iter().map(|r| r[job] / r[0]).collect());
            if job == 0 { format!("{seconds:.4}") } else { format!("{seconds:.4} ({ratio:.1})") }
        };
        let cells: Vec<String> = (0..JOBS.len()).map(cell).collect();
        println!("| {} | {} |", surface.mesh().n_vertices(), cells.join(" | "));
    }
}
