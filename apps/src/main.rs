//! The `ricci` command.

#![warn(clippy::too_many_lines)]

mod carry;
mod charts;
mod checkerboard;
mod circles;
mod cli;
mod csv;
mod delivery;
mod demo;
mod domain;
mod failure;
mod figures;
mod flow;
mod flow_args;
mod flow_summary;
mod forms;
mod gallery;
mod harmonic;
mod info;
mod input;
mod job;
mod laid;
mod make;
mod matching;
mod metric_file;
mod options;
mod output;
mod picture;
mod progress;
mod quantity;
mod repair;
mod report;
mod say;
mod shape;
mod shape_quality;
mod show;
mod solved;
mod spline;
mod structure;
mod timing;
mod uniform;
mod uv;

use clap::{CommandFactory, Parser};
use cli::{Cli, Command};
use failure::Failure;
use std::io::Write;
use std::process::ExitCode;

fn main() -> ExitCode {
    let cli = Cli::parse();
    match run(&cli.command) {
        Ok(code) => ExitCode::from(code),
        Err(failure) => {
            let told = cli.command.report_failure(&failure);
            if let Err(why) = told {
                let _ = writeln!(std::io::stderr(), "ricci: {why}");
            }
            let _ = writeln!(std::io::stderr(), "ricci: {failure}");
            ExitCode::from(failure.exit_code())
        }
    }
}

fn run(command: &Command) -> Result<u8, Failure> {
    let control = progress::cancellable();
    match command {
        Command::Flow(args) => flow::run(args, &control),
        Command::Uniformize(args) => uniform::uniformize(args, &control),
        Command::Cover(args) => uniform::cover(args, &control),
        Command::Harmonic(args) => harmonic::run(args, &control),
        Command::Forms(args) => forms::run(args, &control),
        Command::Circles(args) => domain::run(args, &control),
        Command::Match(args) => matching::run(args, &control),
        Command::Structure(args) => structure::run(args, &control),
        Command::Info(args) => info::run(args, &control),
        Command::Repair(args) => repair::run(args, &control),
        Command::Spline(args) => spline::run(args, &control),
        Command::Make(args) => make::run(args),
        Command::Demo(args) => demo::run(args, &control),
        Command::Gallery(args) => gallery::run(args, &control),
        Command::Completions { shell } => {
            let mut script = Vec::new();
            clap_complete::generate(*shell, &mut Cli::command(), "ricci", &mut script);
            say::print(&String::from_utf8_lossy(&script), say::NO_FILES).map(|()| 0)
        }
    }
}
