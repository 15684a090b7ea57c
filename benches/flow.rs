//! The flow against the linear algebra it stands on, in one run.
//!
//! `cargo bench --bench flow [-- VERTICES… SCHEME…]` (default 50000 200000 yamabe inversive). For a generated torus of
//! that size, noisy so that Newton has work to do, it prints the seconds of each phase; the yardstick, which is
//! iterations × (one factorisation + one solve) + one analysis measured in the same run on the same matrix; the ratio
//! of the two; and the peak of heap bytes per vertex during the flow: mesh, start, target and solver together.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use ricci::Control;
use ricci::flow::{Options, Report, curvature_derivative, flow};
use ricci::geometry::Space;
use ricci::linalg::{Cholesky, Pattern, Symmetric};
use ricci::mesh::Mesh;
use ricci::mesh::shapes;
use ricci::metric::{Metric, Scheme, Target, initial_metric, lengths_from_positions};
use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

/// Counts live and peak bytes of the heap.
struct Counting;

static LIVE: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);
/// Not counted: the matrix products under the factorisation reserve 960 MiB of address space once per thread, of which
/// they touch a few (resident memory shows it).
const RESERVATION: usize = 960 << 20;

impl Counting {
    fn add(size: usize) {
        if size < RESERVATION {
            let live = LIVE.fetch_add(size, Ordering::Relaxed) + size;
            PEAK.fetch_max(live, Ordering::Relaxed);
        }
    }
}

// SAFETY: forwards to the system allocator; the counters do not allocate.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        Counting::add(layout.size());
        // SAFETY: the caller's contract is the same.
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        if layout.size() < RESERVATION {
            LIVE.fetch_sub(layout.size(), Ordering::Relaxed);
        }
        // SAFETY: the caller's contract is the same.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Runs of each measurement; the median is printed.
const RUNS: usize = 3;

fn median(mut x: Vec<f64>) -> f64 {
    x.sort_by(f64::total_cmp);
    x[x.len() / 2]
}

fn seconds<R>(work: impl FnOnce() -> R) -> (f64, R) {
    let start = Instant::now();
    let result = work();
    (start.elapsed().as_secs_f64(), result)
}

/// Medians of one analysis, one factorisation and one solve of ∂K/∂u (the first vertex held) at `metric`.
fn yardstick(mesh: &Mesh, metric: &Metric) -> [f64; 3] {
    let entries = curvature_derivative(mesh, metric).unwrap();
    let free = |i: ricci::mesh::VertexId| i.0.checked_sub(1);
    let kept: Vec<(u32, u32, f64)> =
        entries.into_iter().filter_map(|(i, j, x)| Some((free(i)?, free(j)?, x))).collect();
    let pairs: Vec<(u32, u32)> = kept.iter().map(|&(i, j, _)| (i, j)).collect();
    let n = mesh.n_vertices() - 1;
    let pattern = Pattern::new(n, &pairs).unwrap();
    let mut values = vec![0.0; pattern.entries()];
    for (i, j, x) in kept {
        values[pattern.position(i as usize, j as usize).unwrap()] = x;
    }
    let matrix = Symmetric { pattern: &pattern, values: &values };
    let mut times = [vec![], vec![], vec![]];
    for _ in 0..RUNS {
        let (analyse, mut cholesky) = seconds(|| Cholesky::analyse(&pattern).unwrap());
        let (factor, _) = seconds(|| cholesky.factor(matrix).unwrap());
        let mut x = vec![1.0; n];
        let (solve, ()) = seconds(|| cholesky.solve(&mut x));
        times[0].push(analyse);
        times[1].push(factor);
        times[2].push(solve);
    }
    times.map(median)
}

fn bench(vertices: usize, scheme: Scheme) {
    let side = (vertices as f64 / 2.0).sqrt();
    let mut soup = shapes::torus(2.0, 0.9, (2.0 * side) as usize, side as usize).unwrap();
    shapes::noise(&mut soup, 0.05, 1).unwrap();
    let mesh = Mesh::from_soup(&soup).unwrap();
    let lengths = lengths_from_positions(&mesh, &soup.positions).unwrap();
    let start = initial_metric(&mesh, &lengths, Space::E2, scheme, Space::E2).unwrap().metric;
    let target = Target::Uniform.resolve(&mesh, &lengths, Space::E2, scheme).unwrap();
    drop((soup, lengths));
    let mut reports: Vec<Report> = Vec::with_capacity(RUNS);
    let mut metric = start.clone();
    let mut peak = 0;
    for _ in 0..RUNS {
        PEAK.store(LIVE.load(Ordering::Relaxed), Ordering::Relaxed);
        drop(metric);
        let (result, report) = flow(&mesh, &start, &target, &Options::default(), &Control::new()).unwrap();
        metric = result;
        reports.push(report);
        peak = peak.max(PEAK.load(Ordering::Relaxed));
    }
    reports.sort_by(|a, b| a.seconds.total.total_cmp(&b.seconds.total));
    let report = &reports[RUNS / 2];
    assert!(report.converged, "{report:?}");
    let [analyse, factor, solve] = yardstick(&mesh, &metric);
    let n = mesh.n_vertices();
    let bound = report.iterations as f64 * (factor + solve) + analyse;
    let s = report.seconds;
    println!(
        "{n:>8} vertices  {scheme:<10} {:>2} iterations  {:.3} s = assemble {:.3} + analyse {:.3} + factor {:.3} + solve {:.3} + rest",
        report.iterations, s.total, s.assemble, s.analyse, s.factor, s.solve
    );
    let verdict = |met: bool| if met { "met" } else { "MISSED" };
    let ratio = s.total / bound;
    println!(
        "          yardstick {bound:.3} s (analyse {analyse:.3}, factor {factor:.3}, solve {solve:.3})   ratio {ratio:.2} (1.5 {})   peak {} bytes per vertex (1536 {})",
        verdict(ratio <= 1.5),
        peak / n,
        verdict(peak <= 1536 * n),
    );
    let tail: Vec<String> = report.residuals.iter().map(|r| format!("{r:.1e}")).collect();
    println!("          max |K − K̄| by step: {}", tail.join(" "));
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let mut sizes: Vec<usize> = arguments.iter().filter_map(|a| a.parse().ok()).collect();
    let mut schemes: Vec<Scheme> = arguments.iter().filter_map(|a| a.parse().ok()).collect();
    if sizes.is_empty() {
        sizes = vec![50_000, 200_000];
    }
    if schemes.is_empty() {
        schemes = vec![Scheme::Yamabe, Scheme::Inversive];
    }
    for vertices in sizes {
        schemes.iter().for_each(|&scheme| bench(vertices, scheme));
    }
}
