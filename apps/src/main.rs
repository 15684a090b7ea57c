//! The `ricci` command: from the command line to the exit code.

#![warn(clippy::too_many_lines)]

mod atlas;
mod brain;
mod carry;
mod charts;
mod checkerboard;
mod circle_file;
mod circles;
mod cli;
mod components;
mod csv;
mod defects;
mod demo;
mod failure;
mod figures;
mod flat;
mod flatten;
mod flow;
mod flow_args;
mod flow_summary;
mod forms;
mod gallery;
mod harmonic;
mod info;
mod info_lists;
mod input;
mod job;
mod lengths;
mod listed;
mod make;
mod matching;
mod metric_file;
mod modulus;
mod on_sphere;
mod options;
mod output;
mod page;
mod picture;
mod progress;
mod quads;
mod quantity;
mod refine;
mod repair;
mod repair_summary;
mod report;
mod runner;
mod say;
mod seamless;
mod shape;
mod shape_quality;
mod show;
mod solved;
mod spline;
mod structure;
mod surface;
mod surface_layout;
mod timing;
mod uniformize;
mod uv;
mod vertex_distortion;
mod view;

use clap::{CommandFactory, Parser};
use cli::{Cli, Command};
use components::ComponentsJob;
use failure::Failure;
use ricci::Control;
use std::io::Write;
use std::process::ExitCode;
use uniformize::CanonicalJob;

fn main() -> ExitCode {
    let control = progress::cancellable();
    match run(&Cli::parse().command, &control) {
        Ok(code) => ExitCode::from(code),
        Err(failure) => {
            let _ = writeln!(std::io::stderr(), "ricci: {failure}");
            ExitCode::from(failure.exit_code())
        }
    }
}

fn run(command: &Command, control: &Control) -> Result<u8, Failure> {
    match command {
        Command::Flow(args) if args.components.is_some() => runner::run(&ComponentsJob(args), control),
        Command::Flow(args) => runner::run(args, control),
        Command::Uniformize(args) => runner::run(&CanonicalJob::from(args), control),
        Command::Cover(args) => runner::run(&CanonicalJob::from(args), control),
        Command::Lengths(args) => runner::run(args, control),
        Command::Atlas(args) => runner::run(args, control),
        Command::Harmonic(args) => runner::run(args, control),
        Command::Forms(args) => runner::run(args, control),
        Command::Circles(args) => runner::run(args, control),
        Command::Flatten(args) => runner::run(args, control),
        Command::Brain(args) => runner::run(args, control),
        Command::Match(args) => runner::run(args, control),
        Command::Seamless(args) => runner::run(args, control),
        Command::Quads(args) => runner::run(args, control),
        Command::Layout(args) => runner::run(args, control),
        Command::Surface(args) => runner::run(args, control),
        Command::Structure(args) => runner::run(args, control),
        Command::Info(args) => runner::run(args, control),
        Command::Repair(args) => runner::run(args, control),
        Command::Refine(args) => runner::run(args, control),
        Command::Spline(args) => spline::run(args, control),
        Command::View(args) => runner::run(args, control),
        Command::Make(args) => runner::run(args, control),
        Command::Demo(args) => demo::run(args, control),
        Command::Gallery(args) => gallery::run(args, control),
        Command::Completions { shell } => {
            let mut script = Vec::new();
            clap_complete::generate(*shell, &mut Cli::command(), "ricci", &mut script);
            say::print(&String::from_utf8_lossy(&script), say::NO_FILES).map(|()| 0)
        }
    }
}
