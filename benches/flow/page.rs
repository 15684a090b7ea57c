//! The measurements as the page docs/results/bench.md.

use crate::Row;
use crate::common::machine::{machine, put};

/// What the project asks of the flow, against faer.
const RATIO: f64 = 1.5;
/// What the project asks of its memory, bytes per vertex.
const PEAK: usize = 1536;

impl Row {
    /// The flow's seconds over those of Newton steps that are nothing but linear algebra.
    fn ratios(&self) -> impl Iterator<Item = f64> + '_ {
        self.linear.iter().map(|solver| self.report.seconds.total / solver.newton(self.report.iterations))
    }

    fn bytes_per_vertex(&self) -> usize {
        self.peak / self.vertices
    }
}

/// The page; `peers` says what they are, or why there are none.
pub fn page(rows: &[Row], peers: Result<String, String>, load: [Option<String>; 2]) -> String {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    let arguments = if arguments.is_empty() { String::new() } else { format!(" -- {}", arguments.join(" ")) };
    let mut page = format!(
        "# Bench of the flow

Made by `cargo bench --bench flow{arguments} > docs/results/bench.md`. A torus of revolution with noise becomes flat: E², Newton
without flips; medians over the rounds, in seconds. Steps: Newton iterations. Bytes: the peak of the heap during the flow, per
vertex; mesh, start, target and solver together. The columns after it are ratios: the flow over steps × (factor + solve) + analyse
by that solver, measured in the same rounds on the same matrix (next table). Below 1, the whole flow takes less time than its
linear algebra alone would take with that solver.

"
    );
    flows(&mut page, rows);
    page += "
## One analysis, factorisation and solve

∂K/∂u at the solution, the first vertex held. The second factorisation and solve in the same memory count, as in all steps of Newton
but the first. Cores: processor seconds per second of the factorisation. Residual: ‖A x − b‖∞ for b = 1, −1, 1, −1, …

";
    solvers(&mut page, rows);
    page += "\n## Newton's error\n\nmax |K − K̄| at the start and after each step.\n\n";
    for row in rows {
        let tail: Vec<String> = row.report.residuals.iter().map(|r| format!("{r:.1e}")).collect();
        put(&mut page, format_args!("- {} {}: {}\n", row.vertices, row.scheme, tail.join(" ")));
    }
    machine(&mut page, Some(peers), load);
    page.truncate(page.trim_end().len());
    page
}

fn flows(page: &mut String, rows: &[Row]) {
    let columns =
        "| vertices | scheme | rounds | steps | flow | assemble | analyse | factor | solve | rest | bytes |";
    let solvers = rows.first().map_or(&[][..], |row| &row.linear);
    let names: String = solvers.iter().map(|solver| format!(" {} |", solver.solver)).collect();
    put(page, format_args!("{columns}{names}\n|{}\n", "---|".repeat(11 + solvers.len())));
    for row in rows {
        let s = row.report.seconds;
        let rest = s.total - s.assemble - s.analyse - s.factor - s.solve;
        put(
            page,
            format_args!(
                "| {} | {} | {} | {} |",
                row.vertices, row.scheme, row.rounds, row.report.iterations
            ),
        );
        for seconds in [s.total, s.assemble, s.analyse, s.factor, s.solve, rest] {
            put(page, format_args!(" {seconds:.3} |"));
        }
        put(page, format_args!(" {} |", row.bytes_per_vertex()));
        row.ratios().for_each(|ratio| put(page, format_args!(" {ratio:.2} |")));
        page.push('\n');
    }
    page.push('\n');
    let above = |row: &&Row| row.ratios().next().is_some_and(|r| r > RATIO) || row.bytes_per_vertex() > PEAK;
    let above: Vec<String> =
        rows.iter().filter(above).map(|row| format!("{} {}", row.vertices, row.scheme)).collect();
    let above = if above.is_empty() { "none".into() } else { above.join(", ") };
    let asked = format_args!(
        "Asked at 200,000 vertices: at most {RATIO} × faer and {PEAK} bytes per vertex. Rows above: {above}.\n"
    );
    put(page, asked);
}

fn solvers(page: &mut String, rows: &[Row]) {
    *page += "| vertices | scheme | solver | analyse | factor | solve | numbers in the factor | cores | residual |\n";
    put(page, format_args!("|{}\n", "---|".repeat(9)));
    for row in rows {
        for x in &row.linear {
            put(page, format_args!("| {} | {} | {} |", row.vertices, row.scheme, x.solver));
            put(page, format_args!(" {:.4} | {:.4} | {:.4} |", x.analyse, x.factor, x.solve));
            put(page, format_args!(" {} | {:.2} | {:.1e} |\n", x.entries, x.cores, x.residual));
        }
    }
}
