//! The measurements as the page docs/results/bench.md.

use crate::Row;
use crate::common::machine::{machine, put};
use crate::conformal;

/// The project's bound of the flow's time, over that of one analysis and one factorisation by faer.
const RATIO: f64 = 2.5;
/// The project's bound of the flow's memory, bytes per vertex.
const PEAK: usize = 1536;

impl Row {
    /// The flow's seconds over those of Newton steps that are nothing but linear algebra.
    fn ratios(&self) -> impl Iterator<Item = f64> + '_ {
        self.linear.iter().map(|solver| self.report.seconds.total / solver.newton(self.report.iterations))
    }

    /// The flow's seconds over those of one analysis and one factorisation by faer.
    fn over_once(&self) -> f64 {
        self.linear.first().map_or(f64::NAN, |faer| self.report.seconds.total / faer.once())
    }

    fn bytes_per_vertex(&self) -> usize {
        self.peak / self.vertices
    }
}

/// The page. `peers`: the versions of the peers, or why there are none.
pub fn page(
    (rows, disks): (&[Row], &[conformal::Row]),
    peers: Result<String, String>,
    load: [Option<String>; 2],
) -> String {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    let arguments = if arguments.is_empty() { String::new() } else { format!(" -- {}", arguments.join(" ")) };
    let mut page = format!(
        "# Bench of the flow

Made by `cargo bench --bench flow{arguments} > docs/results/bench.md`. A torus of revolution with noise becomes flat: E², Newton
without flips; medians over the rounds, in seconds. Steps: Newton iterations. Bytes: the peak of the heap during the flow, per
vertex; mesh, start, target and solver together. The columns after it are ratios: the flow over steps × (factor + solve) + analyse
by that solver, measured in the same rounds on the same matrix (next table). Below 1, the whole flow takes less time than its
linear algebra alone would take with that solver. Factors: numeric factorisations of the flow. Over once: the flow over one analysis and
one factorisation by faer on one thread.

"
    );
    flows(&mut page, rows);
    conformal_maps(&mut page, disks);
    page += "
## One analysis, factorisation and solve

∂K/∂u at the solution, the first vertex held. The second factorisation and solve in the same memory count, as in all steps of Newton
but the first. Cores: processor seconds per second of the factorisation. Residual: ‖A x − b‖∞ for b = 1, −1, 1, −1, …

";
    solvers(&mut page, rows);
    page += "\n## Newton's error\n\nmax |K − K̄| at the start and after each step.\n\n";
    for row in rows.iter().filter(|row| row.threads == 1) {
        let tail: Vec<String> = row.report.residuals.iter().map(|r| format!("{r:.1e}")).collect();
        put(&mut page, format_args!("- {} {}: {}\n", row.vertices, row.scheme, tail.join(" ")));
    }
    machine(&mut page, Some(peers), load);
    page.truncate(page.trim_end().len());
    page
}

fn flows(page: &mut String, rows: &[Row]) {
    let columns = "| vertices | scheme | threads | rounds | steps | factors | flow | assemble | analyse | factor | solve | rest | bytes | over once |";
    let solvers = rows.first().map_or(&[][..], |row| &row.linear);
    let names: String = solvers.iter().map(|solver| format!(" {} |", solver.solver)).collect();
    put(page, format_args!("{columns}{names}\n|{}\n", "---|".repeat(14 + solvers.len())));
    for row in rows {
        let s = row.report.seconds;
        let rest = s.total - s.assemble - s.analyse - s.factor - s.solve;
        put(
            page,
            format_args!(
                "| {} | {} | {} | {} | {} | {} |",
                row.vertices,
                row.scheme,
                row.threads,
                row.rounds,
                row.report.iterations,
                row.report.factorisations
            ),
        );
        for seconds in [s.total, s.assemble, s.analyse, s.factor, s.solve, rest] {
            put(page, format_args!(" {seconds:.3} |"));
        }
        put(page, format_args!(" {} | {:.2} |", row.bytes_per_vertex(), row.over_once()));
        row.ratios().for_each(|ratio| put(page, format_args!(" {ratio:.2} |")));
        page.push('\n');
    }
    page.push('\n');
    let above = |row: &&Row| row.over_once() > RATIO || row.bytes_per_vertex() > PEAK;
    let above: Vec<String> = rows
        .iter()
        .filter(above)
        .map(|row| format!("{} {} ({})", row.vertices, row.scheme, row.threads))
        .collect();
    let above = if above.is_empty() { "none".into() } else { above.join(", ") };
    let asked = format_args!(
        "Asked at 200,000 vertices: at most {RATIO} × one analysis and factorisation by faer, and {PEAK} bytes per vertex. Rows above (threads): {above}.\n"
    );
    put(page, asked);
}

fn conformal_maps(page: &mut String, disks: &[conformal::Row]) {
    *page += "
## Beside a linear conformal map

A disk with a hill becomes flat inside: by the flow (E², yamabe, without flips), and by a least-squares conformal map, which is one linear
system of twice the size, with the same factoriser, both on one thread. Neither is laid out or written. Energy: what is left of the conformal energy, over the
area of the image; the flow leaves none.

| vertices | flow | its steps | linear map | its assembling | analysis | factorisation | solution | energy | flow over linear map |
";
    put(page, format_args!("|{}\n", "---|".repeat(10)));
    for disk in disks {
        let (flow, whole) = (disk.report.seconds.total, disk.linear.iter().sum::<f64>());
        let [assemble, analyse, factor, solve] = disk.linear;
        put(
            page,
            format_args!("| {} | {flow:.3} | {} | {whole:.3} |", disk.vertices, disk.report.iterations),
        );
        put(page, format_args!(" {assemble:.3} | {analyse:.3} | {factor:.3} | {solve:.3} |"));
        put(page, format_args!(" {:.1e} | {:.2} |\n", disk.energy, flow / whole));
    }
}

fn solvers(page: &mut String, rows: &[Row]) {
    *page += "| vertices | scheme | solver | analyse | factor | solve | numbers in the factor | cores | residual |\n";
    put(page, format_args!("|{}\n", "---|".repeat(9)));
    for row in rows.iter().filter(|row| row.threads == 1) {
        for x in &row.linear {
            put(page, format_args!("| {} | {} | {} |", row.vertices, row.scheme, x.solver));
            put(page, format_args!(" {:.4} | {:.4} | {:.4} |", x.analyse, x.factor, x.solve));
            let cores = if x.cores.is_nan() { String::new() } else { format!("{:.2}", x.cores) };
            put(page, format_args!(" {} | {cores} | {:.1e} |\n", x.entries, x.residual));
        }
    }
}
