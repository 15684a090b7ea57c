//! The measurements of flips as the page docs/results/bench-flips.md.

use super::flips::{Row, Run};
use crate::common::machine::{load, machine, put};

/// The project's bounds: time of auto over never where no flip is needed, and share of flips and checks where many are needed.
const RATIO: f64 = 1.10;
const SHARE: f64 = 0.15;

/// Time that a flow spends on flips and Delaunay checks, as a share of the solve.
fn share(run: &Run) -> f64 {
    run.report.seconds.flip / run.report.seconds.total
}

/// The page; `before` is the load of the machine when it began.
pub fn page(rows: &[Row], before: Option<String>) -> String {
    let mut page = String::from(
        "# Bench of the flow with flips

Made by `cargo bench --bench flow -- flips > docs/results/bench-flips.md`. E², medians over the rounds (five, from 100,000 vertices on three), in seconds. Solve: from the
first metric to the last. Start: what comes before (intrinsic Delaunay triangulation, circles, normal coordinates of the input's edges).

## Where no flip is needed

A flat torus of equilateral triangles becomes one with curvature in waves, with `Flips::Never` and `Flips::Auto` in turn. Ratios:
medians of auto over never in the same round.

| vertices | scheme | steps | solve never | solve auto | ratio | start never | start auto | ratio of start and solve |
|---|---|---|---|---|---|---|---|---|
",
    );
    for row in rows {
        let [never, auto] = &row.plain;
        put(
            &mut page,
            format_args!(
                "| {} | {} | {} | {:.3} | {:.3} | {:.2} | {:.3} | {:.3} | {:.2} |\n",
                row.vertices,
                row.scheme,
                auto.report.iterations,
                never.report.seconds.total,
                auto.report.seconds.total,
                row.ratio[0],
                never.start,
                auto.start,
                row.ratio[1]
            ),
        );
    }
    page += "
A flat disk of nearly equilateral triangles, from the input on: with flips it would be solved on its double if an edge were to be
flipped across the boundary.

| vertices | scheme | steps never | steps auto | start and solve never | start and solve auto | ratio |
|---|---|---|---|---|---|---|
";
    for row in rows {
        let ([never, auto], ratio) = &row.open;
        let (steps, more) = (never.report.iterations, auto.report.iterations);
        let (vertices, scheme, before, after) = (row.vertices, row.scheme, never.whole(), auto.whole());
        put(
            &mut page,
            format_args!(
                "| {vertices} | {scheme} | {steps} | {more} | {before:.3} | {after:.3} | {ratio:.2} |\n"
            ),
        );
    }
    let above = named(rows, |row| row.ratio[0] > RATIO);
    put(&mut page, format_args!("\nAsked: at most {RATIO:.2} × never for the solve. Rows above: {above}.\n"));
    page += "
## Where many are

A torus of revolution with triangles twice as long as wide and noise gets four cones of π and four of −π. Flips: isometric ones of the
start + those of the flow. Share: flips and Delaunay checks of the solve. The Newton system is analysed anew where the pattern has changed.

| vertices | scheme | steps | flips | start | solve | assemble | analyse | factor | triangular | flip | share | start / all |
|---|---|---|---|---|---|---|---|---|---|---|---|---|
";
    for row in rows {
        let Run { start, report, start_flips } = &row.flipped;
        let s = report.seconds;
        let steps = report.iterations;
        put(&mut page, format_args!("| {} | {} | {steps} |", row.vertices, row.scheme));
        put(&mut page, format_args!(" {start_flips} + {} | {start:.3} |", report.flips));
        for seconds in [s.total, s.assemble, s.analyse, s.factor, s.solve, s.flip] {
            put(&mut page, format_args!(" {seconds:.3} |"));
        }
        let all = row.flipped.whole();
        put(
            &mut page,
            format_args!(" {:.1} % | {:.1} % |\n", 100.0 * share(&row.flipped), 100.0 * start / all),
        );
    }
    let above = named(rows, |row| row.vertices >= 49_000 && share(&row.flipped) > SHARE);
    let asked = 100.0 * SHARE;
    put(
        &mut page,
        format_args!(
            "\nAsked: a share of at most {asked:.0} % from 50,000 vertices on. Rows above: {above}.\n"
        ),
    );
    page += "
## The way back

The common subdivision of the input with the result of the flows above. Bytes: peak of the heap during flow and subdivision, per vertex
of the input.

| vertices | scheme | triangles | seconds | µs per triangle | bytes |
|---|---|---|---|---|---|
";
    for row in rows {
        let (seconds, triangles) = row.subdivision;
        let each = 1e6 * seconds / triangles as f64;
        let (vertices, scheme, bytes) = (row.vertices, row.scheme, row.bytes);
        put(
            &mut page,
            format_args!("| {vertices} | {scheme} | {triangles} | {seconds:.3} | {each:.2} | {bytes} |\n"),
        );
    }
    machine(&mut page, None, [before, load()]);
    page.truncate(page.trim_end().len());
    page
}

fn named(rows: &[Row], which: impl Fn(&Row) -> bool) -> String {
    let names = rows.iter().filter(|row| which(row)).map(|row| format!("{} {}", row.vertices, row.scheme));
    let names: Vec<_> = names.collect();
    if names.is_empty() { "none".into() } else { names.join(", ") }
}
