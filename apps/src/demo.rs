//! `ricci demo`: makes a few surfaces and runs a command on each, through the same command lines that a user would type.

use crate::cli::{Cli, Command, DemoArgs};
use crate::failure::Failure;
use crate::output::{Outputs, check_outputs};
use crate::report::{Checks, Done, InputSummary, Report, Seconds, path_text};
use crate::{domain, flow, forms, harmonic, make, matching, say, structure, uniform};
use clap::Parser;
use ricci::Control;
use serde_json::{Value, json};
use std::time::Instant;

/// The name of a surface, what `ricci make` is given for it, what is run on it (its file is `{}`), and what there is to see.
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

/// Run the command; the exit code is the worst of its flows.
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
        let (input, figures) = (InputSummary::of(&done.input), &done.figures);
        let shown = |name: &str, digits: usize| match figures.get(name) {
            Value::Number(n) => format!("{:.digits$}", n.as_f64().unwrap_or(f64::NAN)),
            _ => "–".into(),
        };
        table += &format!(
            "{name:<8} {:>8} {:>6} {:>6} {:>12.1e} {:>8} {:>10} {:>8.2}\n",
            input.counts.vertices,
            input.counts.genus.unwrap_or(0),
            shown("iterations", 0),
            figures.get("max_curvature_error").as_f64().unwrap_or(f64::NAN),
            shown("flipped_triangles", 0),
            shown("qc_mean", 4),
            done.seconds,
        );
        notes += &format!("\n{name}: {about}\n  ricci {line}\n");
        exit_code = exit_code.max(done.exit_code);
        // The check of a surface's name counts the checks that failed.
        checks.add(name, done.checks.failed().len() as f64, 0.0);
        runs.push(json!({"name": name, "command": line, "input": input, "result": figures}));
    }
    let mut outputs = Outputs::default();
    if let Some(path) = &args.common.report {
        let asked = json!({"out": path_text(out), "threads": args.common.threads});
        let seconds = Seconds { total: start.elapsed().as_secs_f64(), ..Seconds::default() };
        let report = Report::new("demo", None, asked, json!({"runs": runs})).finished(checks, seconds);
        outputs.add_report(path, &report)?;
    }
    let files = outputs.commit()?;
    if !args.common.quiet {
        say::lines(&format!("{table}{notes}"), &files)?;
    }
    Ok(exit_code)
}

/// Make one surface and run the command on it; returns the line that a user would type.
fn run_example(
    name: &str,
    [made_by, line]: [&str; 2],
    args: &DemoArgs,
    control: &Control,
) -> Result<(String, Done<()>), Failure> {
    let path = |suffix: &str| path_text(&args.out.join(format!("{name}{suffix}")));
    let words =
        |line: &str| line.split(' ').map(|word| word.replace("{}", &path(".obj"))).collect::<Vec<_>>();
    if let Command::Make(make) = parse(words(&format!("make {made_by} -o {{}} --quiet")))? {
        make::run(&make)?;
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

/// Run a command that finds a metric, a map or forms, without a word.
pub fn execute(command: Command, control: &Control) -> Result<Done<()>, Failure> {
    Ok(match command {
        Command::Flow(args) => flow::execute(&args, control)?.drop_result(),
        Command::Uniformize(args) => uniform::execute_uniformize(&args, control)?.drop_result(),
        Command::Cover(args) => uniform::execute_cover(&args, control)?.drop_result(),
        Command::Circles(args) => domain::execute(&args, control)?.drop_result(),
        Command::Harmonic(args) => harmonic::execute(&args, control)?.drop_result(),
        Command::Match(args) => matching::execute(&args, control)?.drop_result(),
        Command::Forms(args) => forms::execute(&args, control)?.drop_result(),
        Command::Structure(args) => structure::execute(&args, control)?.drop_result(),
        other => return Err(Failure::Failed(format!("{other:?} has nothing to draw"))),
    })
}

/// Make a directory, if it does not exist.
pub fn make_directory(path: &std::path::Path) -> Result<(), Failure> {
    std::fs::create_dir_all(path)
        .map_err(|e| Failure::Usage(format!("{}: cannot be made: {e}", path.display())))
}
