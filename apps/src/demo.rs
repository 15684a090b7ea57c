//! `ricci demo`: makes a few surfaces and runs a command on each, through the same command lines that a user would type.

use crate::cli::{Cli, Command, DemoArgs};
use crate::csv::read_text;
use crate::failure::Failure;
use crate::output::{Outputs, check_outputs};
use crate::report::{Checks, Done, PhaseSeconds, RunReport, path_text};
use crate::uniformize::CanonicalJob;
use crate::{runner, say};
use clap::Parser;
use ricci::Control;
use serde_json::{Value, json};
use std::time::Instant;

/// The name of a surface, the arguments of `ricci make` for it, the command that is run on it (its file is `{}`), and what can be seen.
const EXAMPLES: [[&str; 4]; 5] = [
    ["torus", "torus", "flow {}", "a torus becomes flat: the layout is a parallelogram up to its seams"],
    [
        "genus2",
        "genus --genus 2",
        "flow {} --space e2 --target single:0",
        "all curvature of a genus-2 surface, −4π, gathered at vertex 0; flat elsewhere",
    ],
    [
        "disk",
        "disk --height 0.4",
        "flow {}",
        "a bumpy disk flattened, its curvature spread over the boundary",
    ],
    [
        "two",
        "genus --genus 2 -n 6",
        "uniformize {}",
        "a surface of genus 2, opened in the hyperbolic plane along geodesics",
    ],
    ["plane", "torus -n 24", "cover {} --depth 3", "the plane, tiled by copies of a torus"],
];

/// Run the command; returns the largest exit code of its parts.
pub fn run(args: &DemoArgs, control: &Control) -> Result<u8, Failure> {
    let start = Instant::now();
    let out = &args.out;
    check_outputs(&[], &[args.common.report.as_deref()])?;
    make_directory(out)?;
    let mut table = format!(
        "{:<8} {:>8} {:>6} {:>6} {:>12} {:>8} {:>10} {:>8}\n",
        "surface", "vertices", "genus", "steps", "max |K − K̄|", "flipped", "dilatation", "seconds"
    );
    let mut notes = String::new();
    let (mut exit_code, mut runs, mut checks) = (0, Vec::new(), Checks::default());
    for [name, made_by, line, about] in EXAMPLES {
        let (line, done) = run_example(name, [made_by, line], args, control)?;
        let report = read_text(&out.join(format!("{name}_report.json")))?;
        let report: Value = serde_json::from_str(&report).map_err(|e| Failure::Failed(e.to_string()))?;
        let (input, figures) = (&report["input"], &report["result"]);
        let shown = |name: &str, digits: usize| match &figures[name] {
            Value::Number(n) => format!("{:.digits$}", n.as_f64().unwrap_or(f64::NAN)),
            _ => "–".into(),
        };
        table += &format!(
            "{name:<8} {:>8} {:>6} {:>6} {:>12.1e} {:>8} {:>10} {:>8.2}\n",
            input["vertices"].as_u64().unwrap_or(0),
            input["genus"].as_u64().unwrap_or(0),
            shown("iterations", 0),
            figures["max_curvature_error"].as_f64().unwrap_or(f64::NAN),
            shown("flipped_triangles", 0),
            shown("qc_mean", 4),
            done.seconds,
        );
        notes += &format!("\n{name}: {about}\n  ricci {line}\n");
        exit_code = exit_code.max(done.exit_code);
        // Each surface has one check of its name: the number of its checks that failed.
        checks.add(name, done.checks.failed().len() as f64, 0.0);
        runs.push(json!({"name": name, "command": line, "input": input, "result": figures}));
    }
    let mut outputs = Outputs::default();
    if let Some(path) = &args.common.report {
        let asked = json!({"out": path_text(out), "threads": args.common.threads});
        let seconds = PhaseSeconds { total: start.elapsed().as_secs_f64(), ..PhaseSeconds::default() };
        let report = RunReport::new("demo", None, asked, json!({"runs": runs})).finished(checks, seconds);
        outputs.add_report(path, &report)?;
    }
    let files = outputs.commit()?;
    if !args.common.quiet {
        say::lines(&format!("{table}{notes}"), &files)?;
    }
    Ok(exit_code)
}

/// Make one surface and run the command on it; returns the line that a user would type for it, too.
fn run_example(
    name: &str,
    [made_by, line]: [&str; 2],
    args: &DemoArgs,
    control: &Control,
) -> Result<(String, Done), Failure> {
    let path = |suffix: &str| path_text(&args.out.join(format!("{name}{suffix}")));
    let words =
        |line: &str| line.split(' ').map(|word| word.replace("{}", &path(".obj"))).collect::<Vec<_>>();
    if let Command::Make(make) = parse(words(&format!("make {made_by} -o {{}} --quiet")))? {
        runner::run(&make, control)?;
    }
    let mut words = words(line);
    for (option, suffix) in [
        ("--uv", "_uv.obj"),
        ("--metric", "_metric.json"),
        ("--report", "_report.json"),
        ("--picture", ".png"),
    ] {
        words.extend([option.into(), path(suffix)]);
    }
    let line = words.join(" ");
    words.push(format!("--threads={}", args.common.threads));
    words.extend(args.common.quiet.then(|| "--quiet".into()));
    Ok((line, execute(parse(words)?, control)?))
}

/// The command of a line of words.
pub fn parse(line: Vec<String>) -> Result<Command, Failure> {
    let words = std::iter::once("ricci".to_string()).chain(line);
    Cli::try_parse_from(words).map(|cli| cli.command).map_err(|e| Failure::Usage(e.to_string()))
}

/// Run a command that finds a metric, a map or forms, without a summary.
pub fn execute(command: Command, control: &Control) -> Result<Done, Failure> {
    match command {
        Command::Flow(args) => runner::execute(&args, control),
        Command::Uniformize(args) => runner::execute(&CanonicalJob::from(&args), control),
        Command::Cover(args) => runner::execute(&CanonicalJob::from(&args), control),
        Command::Circles(args) => runner::execute(&args, control),
        Command::Lengths(args) => runner::execute(&args, control),
        Command::Harmonic(args) => runner::execute(&args, control),
        Command::Match(args) => runner::execute(&args, control),
        Command::Forms(args) => runner::execute(&args, control),
        Command::Structure(args) => runner::execute(&args, control),
        other => Err(Failure::Failed(format!("{other:?} has nothing to draw"))),
    }
}

/// Make a directory, if it does not exist.
pub fn make_directory(path: &std::path::Path) -> Result<(), Failure> {
    std::fs::create_dir_all(path)
        .map_err(|e| Failure::Usage(format!("{}: cannot be made: {e}", path.display())))
}
