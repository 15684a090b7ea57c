//! `ricci demo`: makes three surfaces and runs the flow on each, through the same command lines that a user would type.

use crate::cli::{Cli, Command, DemoArgs};
use crate::failure::Failure;
use crate::figures::FlowResult;
use crate::flow::{self, Done};
use crate::output::{Outputs, check_writable};
use crate::report::{Checks, InputSummary, Report, path_text, peak_bytes};
use crate::{make, say};
use clap::Parser;
use ricci::Control;
use serde::Serialize;
use std::time::Instant;

/// A surface, what `ricci make` and `ricci flow` are given for it, and what there is to see.
struct Example {
    name: &'static str,
    make: &'static [&'static str],
    flow: &'static [&'static str],
    about: &'static str,
}

const EXAMPLES: [Example; 3] = [
    Example {
        name: "torus",
        make: &["torus"],
        flow: &[],
        about: "a torus becomes flat: the layout is a parallelogram up to its seams",
    },
    Example {
        name: "genus2",
        make: &["genus", "--genus", "2"],
        flow: &["--space", "e2", "--target", "single:0"],
        about: "all curvature of a genus-2 surface, −4π, gathered at vertex 0; flat elsewhere",
    },
    Example {
        name: "disk",
        make: &["disk", "--height", "0.4"],
        flow: &[],
        about: "a bumpy disk flattened, its curvature spread over the boundary",
    },
];

#[derive(Serialize)]
struct Asked {
    out: String,
    threads: usize,
}

#[derive(Serialize)]
struct Runs {
    runs: Vec<Run>,
}

/// One surface of the demo; the check of its name counts the checks that failed.
#[derive(Serialize)]
struct Run {
    name: &'static str,
    command: String,
    input: InputSummary,
    result: FlowResult,
}

/// Run the command; the exit code is the worst of its flows.
pub fn run(args: &DemoArgs, control: &Control) -> Result<u8, Failure> {
    let start = Instant::now();
    let out = &args.out;
    args.common.report.as_deref().map_or(Ok(()), check_writable)?;
    std::fs::create_dir_all(out)
        .map_err(|e| Failure::Usage(format!("{}: cannot be made: {e}", out.display())))?;
    let mut table = format!(
        "{:<8} {:>8} {:>6} {:>6} {:>12} {:>8} {:>10} {:>8}\n",
        "surface", "vertices", "genus", "steps", "max |K − K̄|", "flipped", "dilatation", "seconds"
    );
    let mut notes = String::new();
    let (mut exit_code, mut runs, mut checks) = (0, Vec::new(), Checks::default());
    for example in &EXAMPLES {
        let (line, done) = run_example(example, args, control)?;
        let laid = done.outcome.layout.as_ref().ok();
        table += &format!(
            "{:<8} {:>8} {:>6} {:>6} {:>12.1e} {:>8} {:>10} {:>8.2}\n",
            example.name,
            done.input.mesh.n_vertices(),
            done.input.mesh.genus(),
            done.outcome.report.iterations,
            done.outcome.report.max_curvature_error,
            laid.map_or("–".into(), |l| l.flipped().len().to_string()),
            laid.map_or("–".into(), |l| format!("{:.4}", l.quality.qc_mean)),
            done.seconds,
        );
        notes += &format!("\n{}: {}\n  ricci {line}\n", example.name, example.about);
        exit_code = exit_code.max(done.exit_code);
        let input = InputSummary::of(&done.input);
        runs.push(Run {
            name: example.name,
            command: line,
            input,
            result: FlowResult::new(&done.input, &done.outcome),
        });
        checks.add(example.name, done.checks.failed().len() as f64, 0.0);
    }
    if let Some(path) = &args.common.report {
        let asked = Asked { out: path_text(out), threads: args.common.threads() };
        let mut report = Report::new("demo", None, asked, Runs { runs });
        report.checks = checks;
        report.seconds.total = start.elapsed().as_secs_f64();
        report.peak_bytes = peak_bytes();
        let mut outputs = Outputs::default();
        outputs.add_report(path, &report)?;
        outputs.commit()?;
    }
    if !args.common.quiet {
        say::lines(&format!("{table}{notes}"));
    }
    Ok(exit_code)
}

/// Make one surface and run the flow on it; returns the flow's command line with what came out.
fn run_example(example: &Example, args: &DemoArgs, control: &Control) -> Result<(String, Done), Failure> {
    let path = |suffix: &str| path_text(&args.out.join(format!("{}{suffix}", example.name)));
    let mut make = vec!["make".to_string()];
    make.extend(example.make.iter().map(ToString::to_string));
    make.extend(["-o".into(), path(".obj"), "--quiet".into()]);
    if let Command::Make(make) = parse(make)? {
        make::run(&make)?;
    }
    let mut flow = vec!["flow".to_string(), path(".obj")];
    flow.extend(example.flow.iter().map(ToString::to_string));
    for (option, suffix) in [
        ("--uv", "_uv.obj"),
        ("--metric", "_metric.json"),
        ("--report", "_report.json"),
        ("--picture", ".png"),
    ] {
        flow.extend([option.into(), path(suffix)]);
    }
    let line = flow.join(" ");
    flow.push(format!("--threads={}", args.common.threads()));
    flow.extend(args.common.quiet.then(|| "--quiet".into()));
    match parse(flow)? {
        Command::Flow(flow) => Ok((line, flow::execute(&flow, control)?)),
        other => Err(Failure::Failed(format!("{other:?} is no flow"))),
    }
}

/// The command of a line of words.
pub fn parse(line: Vec<String>) -> Result<Command, Failure> {
    let words = std::iter::once("ricci".to_string()).chain(line);
    Cli::try_parse_from(words).map(|cli| cli.command).map_err(|e| Failure::Usage(e.to_string()))
}
