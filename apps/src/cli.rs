//! The command line.

use crate::flow_args::FlowArgs;
use crate::info::InfoArgs;
use crate::options::Common;
use crate::repair::RepairArgs;
use crate::uniform::{CoverArgs, UniformizeArgs};
use clap::{Args, Parser, Subcommand};
use std::path::PathBuf;

/// Conformal metrics of prescribed curvature on triangle meshes, by discrete surface Ricci flow.
#[derive(Parser, Debug)]
#[command(name = "ricci", version, arg_required_else_help = true, after_help = EXIT_CODES)]
pub struct Cli {
    #[command(subcommand)]
    pub command: Command,
}

const EXIT_CODES: &str = "\
Exit codes: 0 done and every check of the report holds; 1 not converged or a check failed (the files are still
written, the report says what failed); 2 usage; 3 bad input; 4 cancelled.

`ricci help COMMAND` shows the options of a command and an example.";

#[derive(Subcommand, Debug)]
pub enum Command {
    /// What a mesh is: counts, topology, quality; each defect with its elements and its remedy
    #[command(after_help = crate::info::HELP)]
    Info(InfoArgs),
    /// Mend what can be mended without a guess, with a map back to the input
    #[command(after_help = crate::repair::HELP)]
    Repair(RepairArgs),
    /// The conformal metric with a prescribed curvature, and its layout
    #[command(after_help = crate::flow_args::HELP)]
    Flow(FlowArgs),
    /// The metric of constant curvature of a closed surface, in the sphere, the plane or the hyperbolic plane
    #[command(after_help = crate::uniform::UNIFORMIZE_HELP)]
    Uniformize(UniformizeArgs),
    /// A finite piece of the universal cover, with the group that rebuilds the surface from one copy
    #[command(after_help = crate::uniform::COVER_HELP)]
    Cover(CoverArgs),
    /// Make a sample surface
    #[command(after_help = crate::make::HELP)]
    Make(crate::make::MakeArgs),
    /// Flows, a uniformization and a universal cover of small surfaces, with pictures and reports
    #[command(after_help = DEMO_EXAMPLE)]
    Demo(DemoArgs),
    /// One picture per kind of surface and of picture, with the commands that make them
    #[command(after_help = GALLERY_EXAMPLE)]
    Gallery(GalleryArgs),
    /// Completions for a shell, on stdout
    #[command(after_help = COMPLETIONS_EXAMPLE)]
    Completions {
        #[arg(value_enum)]
        shell: clap_complete::Shell,
    },
}

const DEMO_EXAMPLE: &str = "\
Example
    ricci demo out && ls out";

const GALLERY_EXAMPLE: &str = "\
Example
    ricci gallery pictures && cat pictures/README.md";

const COMPLETIONS_EXAMPLE: &str = "\
Example
    ricci completions bash > ~/.local/share/bash-completion/completions/ricci";

#[derive(Args, Debug)]
pub struct DemoArgs {
    /// Directory to write into; made if it does not exist
    pub out: PathBuf,
    #[command(flatten)]
    pub common: Common,
}

#[derive(Args, Debug)]
pub struct GalleryArgs {
    /// Directory to write into; made if it does not exist
    pub out: PathBuf,
    /// A folder of meshes with good/INDEX.csv, for pictures of real surfaces
    pub meshes: Option<PathBuf>,
    #[command(flatten)]
    pub common: Common,
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_well_formed() {
        Cli::command().debug_assert();
    }
}
