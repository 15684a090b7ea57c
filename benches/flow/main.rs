//! Times of the flow compared with its linear algebra by faer, CHOLMOD and Eigen on the same matrix, in one run.
//!
//! `cargo bench --bench flow [-- VERTICES… SCHEME…] > docs/results/bench.md` (default: 10000 50000 200000 850000 yamabe inversive). Disks
//! of the same sizes are flattened by the flow and by a linear conformal map. The target is a flat torus, from a torus of revolution of
//! that size, noisy so that Newton has work to do. A round is one flow, then one analysis, factorisation and solve by each solver of ∂K/∂u
//! at the solution; several rounds follow each other, so that other load of the machine affects all alike, and medians are printed.
//!
//! `cargo bench --bench flow -- flips [VERTICES… SCHEME…] > docs/results/bench-flips.md` (default: 10000 50000 200000 400000) measures
//! what edge flips cost instead.
//!
//! CHOLMOD and Eigen are measured by the program of benches/peers: it stands in the folder `RICCI_PEERS`, or else cmake builds it. Where
//! cmake, Eigen or CHOLMOD are missing, the page says so and has no columns for them.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::print_stderr)]

#[path = "../common/mod.rs"]
mod common;
mod conformal;
mod flips;
mod flips_page;
mod linear;
mod page;
mod peers;

use common::{heap, machine, median, peers::Program};
use linear::{Linear, Matrix};
use ricci::flow::{Flips, Options, Report, flow};
use ricci::geometry::Space;
use ricci::mesh::shapes;
use ricci::metric::Scheme;
use ricci::{Class, Control, Surface, Target};

/// Rounds of measurements, of which the medians are printed: below 100,000 vertices they are short.
fn rounds(vertices: usize) -> usize {
    if vertices < 100_000 { 9 } else { 3 }
}

/// Numbers of threads of the flow.
const THREADS: [usize; 2] = [1, 2];

/// Largest ‖A x − b‖∞ of a solver that solved the system: ‖b‖∞ = 1, and rounding leaves less than 1e-13.
const SOLVED: f64 = 1e-10;

/// The measurements of one size and scheme.
struct Row {
    vertices: usize,
    scheme: Scheme,
    threads: usize,
    rounds: usize,
    /// Of the flow of median time.
    report: Report,
    /// Most bytes of the heap during the flow: surface, start, target and factor together.
    peak: usize,
    /// faer first, then the flow's own factorisation, then the peers: medians.
    linear: Vec<Linear>,
}

/// The medians of the same solver over the rounds.
fn medians(rounds: &[Vec<Linear>], solver: usize) -> Linear {
    let of = |field: fn(&Linear) -> f64| median(rounds.iter().map(|round| field(&round[solver])));
    Linear {
        analyse: of(|x| x.analyse),
        factor: of(|x| x.factor),
        solve: of(|x| x.solve),
        cores: of(|x| x.cores),
        ..rounds[0][solver].clone()
    }
}

/// A row for each number of threads in [`THREADS`].
fn measure(vertices: usize, scheme: Scheme, peers: Option<&Program>) -> Vec<Row> {
    let side = (vertices as f64 / 2.0).sqrt();
    let mut soup = shapes::torus(2.0, 0.9, (2.0 * side) as usize, side as usize).unwrap();
    shapes::noise(&mut soup, 0.05, 1).unwrap();
    let (surface, class) = (Surface::from_soup(&soup).unwrap(), Class::new(scheme, Space::E2));
    drop(soup);
    let (mut reports, mut solvers) = (THREADS.map(|_| Vec::new()), Vec::new());
    let mut peak = [0; THREADS.len()];
    let rounds = rounds(vertices);
    for round in 1..=rounds {
        eprintln!("{vertices} {scheme}: round {round} of {rounds}");
        let mut matrix = None;
        for (k, threads) in THREADS.into_iter().enumerate() {
            let options = Options { flips: Flips::Never, threads, ..Options::default() };
            let run = || flow(surface.clone(), class, &Target::Uniform, &options, &Control::new()).unwrap();
            let (most, solution) = heap::peak(run);
            let report = solution.report().unwrap().clone();
            assert!(report.converged(), "{report:?}");
            peak[k] = peak[k].max(most);
            reports[k].push(report);
            matrix.get_or_insert_with(|| Matrix::new(solution.mesh(), solution.metric()));
        }
        let matrix = matrix.unwrap();
        let mut linear = vec![matrix.faer()];
        linear.extend(THREADS.map(|threads| matrix.own(threads)));
        if let Some(peers) = peers {
            linear.extend(peers::measure(peers, &matrix));
        }
        for solver in &linear {
            assert!(solver.residual <= SOLVED, "{} leaves {:e}", solver.solver, solver.residual);
        }
        solvers.push(linear);
    }
    let row = |(k, mut reports): (usize, Vec<Report>)| {
        reports.sort_by(|a, b| a.seconds.total.total_cmp(&b.seconds.total));
        Row {
            vertices: surface.mesh().n_vertices(),
            scheme,
            threads: THREADS[k],
            report: reports.swap_remove(rounds / 2),
            peak: peak[k],
            linear: (0..solvers[0].len()).map(|solver| medians(&solvers, solver)).collect(),
            rounds,
        }
    };
    reports.into_iter().enumerate().map(row).collect()
}

fn main() {
    let (mut sizes, mut schemes) = (Vec::<usize>::new(), Vec::<Scheme>::new());
    let mut with_flips = false;
    // Cargo adds --bench.
    for argument in std::env::args().skip(1).filter(|a| a != "--bench") {
        if argument == "flips" {
            with_flips = true;
            continue;
        }
        match (argument.parse(), argument.parse()) {
            (Ok(size), _) => sizes.push(size),
            (_, Ok(scheme)) => schemes.push(scheme),
            _ => panic!("{argument} is neither a number of vertices nor a scheme"),
        }
    }
    if sizes.is_empty() {
        sizes = vec![10_000, 50_000, 200_000, if with_flips { 400_000 } else { 850_000 }];
    }
    if schemes.is_empty() {
        schemes = vec![Scheme::Yamabe, Scheme::Inversive];
    }
    let load = machine::load();
    let cases: Vec<_> =
        sizes.iter().flat_map(|&size| schemes.iter().map(move |&scheme| (size, scheme))).collect();
    if with_flips {
        let rows: Vec<_> = cases.iter().map(|&(size, scheme)| flips::measure(size, scheme)).collect();
        println!("{}", flips_page::page(&rows, load));
        return;
    }
    let peers = Program::find("peers");
    if let Err(why) = &peers {
        eprintln!("no peers: {why}");
    }
    let rows: Vec<Row> =
        cases.into_iter().flat_map(|(size, scheme)| measure(size, scheme, peers.as_ref().ok())).collect();
    let disks: Vec<_> = sizes.into_iter().map(conformal::measure).collect();
    println!("{}", page::page((&rows, &disks), peers.map(|p| p.libraries()), [load, machine::load()]));
}
