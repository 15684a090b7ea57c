//! Times of layouts, deck groups and covers, compared with a job that is linear up to a logarithm: shortest paths along the
//! edges of the same triangulation, in the same round.
//!
//! `cargo bench --bench cover [-- VERTICES…] > docs/results/bench-cover.md` (default: 10000 50000 200000 800000). The surface has genus 3,
//! in H² and, with one cone, in E²; a round does each job once, one after the other, so that other load of the machine affects all alike;
//! medians of five rounds.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::print_stderr)]

use ricci::canonical::{Quotient, QuotientOptions, uniformize_quotient};
use ricci::embed::cover::{elements_to_depth, moved};
use ricci::embed::{DeckGroup, Layout, LayoutOpening, LayoutOptions, LayoutScale};
use ricci::flow::{Options, Solution, flow};
use ricci::geometry::Space;
use ricci::mesh::{Mesh, VertexId, shapes};
use ricci::parallel::Pool;
use ricci::topology::{homotopy_basis, shortest_paths};
use ricci::{Class, Control, Surface, Target};
use std::sync::Arc;
use std::time::Instant;

const ROUNDS: usize = 5;
/// Number of copies that are placed.
const COPIES: usize = 13;
/// The cone of the flat metric.
const CONE: VertexId = VertexId(0);

/// Jobs of a round, the yardstick first.
const JOBS: [&str; 7] = [
    "shortest paths",
    "layout",
    "refined layout",
    "homotopy basis",
    "deck group",
    "13 copies",
    "layout in E²",
];

/// Seconds of each job.
fn round(mesh: &Arc<Mesh>, given: &Quotient, flat: &Solution) -> [f64; 7] {
    let control = Control::new();
    let metric = &given.metric;
    let lengths = metric.metric().lengths(mesh).unwrap();
    let base = given.basis.base;
    let subdivision = Arc::new(metric.common_subdivision(&control).unwrap());
    let flat_subdivision =
        (!flat.is_unflipped()).then(|| Arc::new(flat.common_subdivision(&control).unwrap()));
    let mut seconds = [0.0; 7];
    let mut job = 0;
    let mut lap = Instant::now();
    let mut done = |lap: &mut Instant| {
        seconds[job] = lap.elapsed().as_secs_f64();
        job += 1;
        *lap = Instant::now();
    };
    shortest_paths(mesh, &lengths, [base], &control).unwrap();
    done(&mut lap);
    let (opening, scale, root) = (LayoutOpening::MetricEdges, LayoutScale::AsSolved, Some(base));
    let options = LayoutOptions { opening, scale, root, ..LayoutOptions::default() };
    let layout = Layout::of_solution(metric, &options, &control).unwrap();
    done(&mut lap);
    let refined = layout.on_subdivision(&subdivision, metric.metric(), &control).unwrap();
    done(&mut lap);
    let basis = homotopy_basis(mesh, &lengths, Some(base), &control).unwrap();
    done(&mut lap);
    let deck = DeckGroup::new(metric, &layout, &basis, &control).unwrap();
    done(&mut lap);
    let copies = elements_to_depth(&deck, 1, 1000, &control).unwrap();
    assert_eq!(copies.len(), COPIES);
    let sum: f64 = copies.iter().map(|g| moved(&refined.points, &g.motion)[0][2]).sum();
    assert!(sum.is_finite());
    done(&mut lap);
    let options = LayoutOptions { subdivision: flat_subdivision, ..LayoutOptions::default() };
    assert!(Layout::of_solution(flat, &options, &control).unwrap().broken.is_empty());
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
        let (class, target) = (Class::yamabe(Space::E2), Target::Single(CONE));
        let flat = flow(surface.clone(), class, &target, &Options::default(), &Control::new()).unwrap();
        let n_flat = flat.common_subdivision(&Control::new()).unwrap().mesh.n_faces();
        let pool = Pool::new(0).unwrap();
        let rounds: Vec<[f64; 7]> =
            (0..ROUNDS).map(|_| pool.run(|| round(&final_mesh, &given, &flat))).collect();
        let cell = |job: usize| {
            let seconds = median(rounds.iter().map(|r| r[job]).collect());
            let ratio = median(rounds.iter().map(|r| r[job] / r[0]).collect());
            if job == 0 { format!("{seconds:.4}") } else { format!("{seconds:.4} ({ratio:.1})") }
        };
        let cells: Vec<String> = (0..JOBS.len()).map(cell).collect();
        println!("| {} | {} |", surface.mesh().n_vertices(), cells.join(" | "));
        let seconds: f64 = median(rounds.iter().map(|r| r[JOBS.len() - 1]).collect());
        let each = 1e6 * seconds / n_flat as f64;
        eprintln!("{} vertices: in E² {n_flat} triangles, {each:.2} µs each", surface.mesh().n_vertices());
    }
}
