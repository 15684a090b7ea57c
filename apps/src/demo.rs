//! `ricci demo`: makes a few surfaces and runs a command on each, through the same command lines that a user would type.

use crate::cli::{Cli, Command, DemoArgs};
use crate::failure::Failure;
use crate::figures::FlowResult;
use crate::flow;
use crate::job::Outcome;
use crate::output::{Outputs, check_outputs};
use crate::report::{Checks, Done, InputSummary, Report, Seconds, path_text};
use crate::uniform::{self, Shape, UniformFigures};
use crate::{make, say};
use clap::Parser;
use ricci::Control;
use serde::Serialize;
use std::time::Instant;

/// A surface, what `ricci make` is given for it, what is run on it, and what there is to see.
struct Example {
    name: &'static str,
    make: &'static [&'static str],
    command: &'static str,
    options: &'static [&'static str],
    about: &'static str,
}

const EXAMPLES: [Example; 5] = [
    Example {
        name: "torus",
        make: &["torus"],
        command: "flow",
        options: &[],
        about: "a torus becomes flat: the layout is a parallelogram up to its seams",
    },
    Example {
        name: "genus2",
        make: &["genus", "--genus", "2"],
        command: "flow",
        options: &["--space", "e2", "--target", "single:0"],
        about: "all curvature of a genus-2 surface, −4π, gathered at vertex 0; flat elsewhere",
    },
    Example {
        name: "disk",
        make: &["disk", "--height", "0.4"],
        command: "flow",
        options: &[],
        about: "a bumpy disk flattened, its curvature spread over the boundary",
    },
    Example {
        name: "two",
        make: &["genus", "--genus", "2", "-n", "6"],
        command: "uniformize",
        options: &[],
        about: "a surface of genus 2 in the hyperbolic plane, opened, with the loops that generate its group",
    },
    Example {
        name: "plane",
        make: &["torus", "-n", "24"],
        command: "cover",
        options: &["--depth", "3"],
        about: "the plane, tiled by copies of a torus",
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
    result: Figures,
}

#[derive(Serialize)]
#[serde(untagged)]
enum Figures {
    Flow(Box<FlowResult>),
    Uniform(Box<UniformFigures>),
}

/// What came of one run.
struct Ran {
    line: String,
    input: InputSummary,
    steps: usize,
    error: f64,
    /// Flipped triangles and mean dilatation of the layout.
    layout: Option<(usize, f64)>,
    seconds: f64,
    exit_code: u8,
    checks: Checks,
    result: Figures,
}

/// Run the command; the exit code is the worst of its flows.
pub fn run(args: &DemoArgs, control: &Control) -> Result<u8, Failure> {
    let start = Instant::now();
    let out = &args.out;
    check_outputs(&[], &[args.common.report.as_deref()])?;
    std::fs::create_dir_all(out)
        .map_err(|e| Failure::Usage(format!("{}: cannot be made: {e}", out.display())))?;
    let mut table = format!(
        "{:<8} {:>8} {:>6} {:>6} {:>12} {:>8} {:>10} {:>8}\n",
        "surface", "vertices", "genus", "steps", "max |K − K̄|", "flipped", "dilatation", "seconds"
    );
    let mut notes = String::new();
    let (mut exit_code, mut runs, mut checks) = (0, Vec::new(), Checks::default());
    for example in &EXAMPLES {
        let ran = run_example(example, args, control)?;
        table += &format!(
            "{:<8} {:>8} {:>6} {:>6} {:>12.1e} {:>8} {:>10} {:>8.2}\n",
            example.name,
            ran.input.vertices,
            ran.input.genus.unwrap_or(0),
            ran.steps,
            ran.error,
            ran.layout.map_or("–".into(), |l| l.0.to_string()),
            ran.layout.map_or("–".into(), |l| format!("{:.4}", l.1)),
            ran.seconds,
        );
        notes += &format!("\n{}: {}\n  ricci {}\n", example.name, example.about, ran.line);
        exit_code = exit_code.max(ran.exit_code);
        checks.add(example.name, ran.checks.failed().len() as f64, 0.0);
        runs.push(Run { name: example.name, command: ran.line, input: ran.input, result: ran.result });
    }
    if let Some(path) = &args.common.report {
        let asked = Asked { out: path_text(out), threads: args.common.threads() };
        let seconds = Seconds { total: start.elapsed().as_secs_f64(), ..Seconds::default() };
        let report = Report::new("demo", None, asked, Runs { runs }).finished(checks, seconds);
        let mut outputs = Outputs::default();
        outputs.add_report(path, &report)?;
        outputs.commit()?;
    }
    if !args.common.quiet {
        say::lines(&format!("{table}{notes}"));
    }
    Ok(exit_code)
}

/// Make one surface and run the command on it.
fn run_example(example: &Example, args: &DemoArgs, control: &Control) -> Result<Ran, Failure> {
    let path = |suffix: &str| path_text(&args.out.join(format!("{}{suffix}", example.name)));
    let mut make = vec!["make".to_string()];
    make.extend(example.make.iter().map(ToString::to_string));
    make.extend(["-o".into(), path(".obj"), "--quiet".into()]);
    if let Command::Make(make) = parse(make)? {
        make::run(&make)?;
    }
    let mut words = vec![example.command.to_string(), path(".obj")];
    words.extend(example.options.iter().map(ToString::to_string));
    for (option, suffix) in [
        ("--uv", "_uv.obj"),
        ("--metric", "_metric.json"),
        ("--report", "_report.json"),
        ("--picture", ".png"),
    ] {
        words.extend([option.into(), path(suffix)]);
    }
    let line = words.join(" ");
    words.push(format!("--threads={}", args.common.threads()));
    words.extend(args.common.quiet.then(|| "--quiet".into()));
    match parse(words)? {
        Command::Flow(flow) => Ok(flowed(line, flow::execute(&flow, control)?)),
        Command::Uniformize(args) => uniformized(line, uniform::execute_uniformize(&args, control)?),
        Command::Cover(args) => uniformized(line, uniform::execute_cover(&args, control)?),
        other => Err(Failure::Failed(format!("{other:?} is no example"))),
    }
}

fn flowed(line: String, done: Done<Outcome>) -> Ran {
    let laid = done.result.layout.as_ref().ok();
    Ran {
        line,
        input: InputSummary::of(&done.input),
        steps: done.result.report.iterations,
        error: done.result.report.max_curvature_error,
        layout: laid.map(|l| (l.flipped().len(), l.quality.qc_mean)),
        seconds: done.seconds,
        exit_code: done.exit_code,
        result: Figures::Flow(Box::new(FlowResult::new(&done.input, &done.result))),
        checks: done.checks,
    }
}

fn uniformized(line: String, done: Done<Shape>) -> Result<Ran, Failure> {
    let Shape::Quotient(u) = &done.result else {
        return Err(Failure::Failed("a sphere is no example".into()));
    };
    Ok(Ran {
        line,
        input: InputSummary::of(&done.input),
        steps: u.report.iterations,
        error: u.curvature_error(),
        layout: u.laid().ok().map(|laid| (laid.flipped().len(), laid.quality.qc_mean)),
        seconds: done.seconds,
        exit_code: done.exit_code,
        result: Figures::Uniform(Box::new(UniformFigures::new(
            u,
            u.elements.as_ref().is_ok_and(|elements| elements.len() > 1),
        ))),
        checks: done.checks,
    })
}

/// The command of a line of words.
pub fn parse(line: Vec<String>) -> Result<Command, Failure> {
    let words = std::iter::once("ricci".to_string()).chain(line);
    Cli::try_parse_from(words).map(|cli| cli.command).map_err(|e| Failure::Usage(e.to_string()))
}
