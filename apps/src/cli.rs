//! The command line: all commands with their options.

use crate::atlas::TextureArgs;
use crate::brain::BrainArgs;
use crate::circles::CirclesArgs;
use crate::flatten::FlattenArgs;
use crate::flow_args::FlowArgs;
use crate::forms::FormsArgs;
use crate::harmonic::HarmonicArgs;
use crate::info::InfoArgs;
use crate::lengths::LengthsArgs;
use crate::matching::MatchArgs;
use crate::options::Common;
use crate::quads::{LayoutArgs, QuadsArgs};
use crate::refine::RefineArgs;
use crate::repair::RepairArgs;
use crate::seamless::SeamlessArgs;
use crate::spline::SplineArgs;
use crate::structure::StructureArgs;
use crate::surface::ScanArgs;
use crate::uniformize::{CoverArgs, UniformizeArgs};
use crate::view::ViewArgs;
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
Exit codes: 0 done and every check of the report holds; 1 not converged, a check failed or a file could not be made (what there is
is written, summary and report name the rest); 2 usage; 3 bad input (the report says why); 4 cancelled.

Vertices and faces are numbered from 0. A file name - is stdin or stdout.

`ricci help COMMAND` shows the options of a command and an example.";

#[derive(Subcommand, Debug)]
pub enum Command {
    /// What a mesh is: counts, topology, quality; each defect with its elements and its remedy
    #[command(after_help = crate::info::HELP)]
    Info(InfoArgs),
    /// Mend what can be mended without a guess, with a map back to the input
    #[command(after_help = crate::repair::HELP)]
    Repair(RepairArgs),
    /// Finer triangles of the same surface, in space with the way back, or of its metric with a least angle
    #[command(after_help = crate::refine::HELP)]
    Refine(RefineArgs),
    /// The conformal metric with a prescribed curvature, and its layout
    #[command(after_help = crate::flow_args::HELP)]
    Flow(FlowArgs),
    /// A map to the plane of least stretch, with a free boundary and no triangle turned over
    #[command(after_help = crate::flatten::HELP)]
    Flatten(FlattenArgs),
    /// The maps of a cortical hemisphere, or of both: to the sphere, inflated, flat without the medial wall, with their distortion
    #[command(after_help = crate::brain::HELP)]
    Brain(BrainArgs),
    /// The metric of constant curvature of a closed surface, in the sphere, the plane or the hyperbolic plane
    #[command(after_help = crate::uniformize::UNIFORMIZE_HELP)]
    Uniformize(UniformizeArgs),
    /// A finite piece of the universal cover, with the group that rebuilds the surface from one copy
    #[command(after_help = crate::uniformize::COVER_HELP)]
    Cover(CoverArgs),
    /// Closed geodesics of the metric of constant curvature, all up to a length, and the shortest on the surface
    #[command(after_help = crate::lengths::HELP)]
    Lengths(LengthsArgs),
    /// Texture coordinates for a whole model of any kind, on its own faces, packed into a page
    #[command(after_help = crate::atlas::HELP)]
    Atlas(TextureArgs),
    /// Harmonic maps to a disk, a rectangle, the sphere, or with given values
    #[command(after_help = crate::harmonic::HELP)]
    Harmonic(HarmonicArgs),
    /// Harmonic and holomorphic 1-forms, period matrix, zeros and trajectories
    #[command(after_help = crate::forms::HELP)]
    Forms(FormsArgs),
    /// A surface with boundary whose loops are circles: in the unit disk, a flat torus or a hyperbolic surface
    #[command(after_help = crate::circles::HELP)]
    Circles(CirclesArgs),
    /// A map between two surfaces of the same topology, landmarks to landmarks
    #[command(after_help = crate::matching::HELP)]
    Match(MatchArgs),
    /// An atlas of a conformal, spherical, affine, hyperbolic, projective or integer structure, with its transitions and holonomy
    #[command(after_help = crate::structure::HELP)]
    Structure(StructureArgs),
    /// A flat metric whose cones and handles turn by multiples of 90°, and its map, whose seams a grid of squares crosses
    #[command(after_help = crate::seamless::HELP)]
    Seamless(SeamlessArgs),
    /// A quad mesh of the surface from a seamless map, regular but at its cones
    #[command(after_help = crate::quads::HELP)]
    Quads(QuadsArgs),
    /// Few four-sided patches with whole sides, from the coarsest quad mesh of a seamless map
    #[command(after_help = crate::quads::LAYOUT_HELP)]
    Layout(LayoutArgs),
    /// A solid of few four-sided faces with common tangent planes, fitted to a scan, as STEP
    #[command(after_help = crate::surface::HELP)]
    Surface(ScanArgs),
    /// Triangular B-splines: fitted to meshes, evaluated
    #[command(after_help = crate::spline::HELP)]
    Spline(SplineArgs),
    /// A page in which surfaces turn, each beside its layout or image, with quantities in colours
    #[command(after_help = crate::view::HELP)]
    View(ViewArgs),
    /// Make a sample surface
    #[command(after_help = crate::make::HELP)]
    Make(crate::make::MakeArgs),
    /// Flows, a uniformization and a universal cover of small surfaces, with pictures and reports
    #[command(after_help = DEMO_EXAMPLE)]
    Demo(DemoArgs),
    /// One picture per kind of surface and of picture, with the commands that make them, and a page with views that turn
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
    ricci gallery pictures && cat pictures/README.md && xdg-open pictures/index.html";

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

    #[test]
    fn the_examples_of_the_help_are_commands() {
        let mut seen = 0;
        for command in Cli::command().get_subcommands() {
            let help = command.get_after_help().map(ToString::to_string).unwrap_or_default();
            let lines = help.lines().filter(|line| line.starts_with("    ricci "));
            for example in lines.flat_map(|line| line.split("&&")).map(|line| line.split(['>', '#']).next()) {
                let words: Vec<&str> = example.unwrap_or_default().split_whitespace().collect();
                if words.first() == Some(&"ricci") {
                    let parsed = Cli::try_parse_from(&words);
                    assert!(parsed.is_ok(), "{words:?}: {}", parsed.unwrap_err());
                    seen += 1;
                }
            }
        }
        assert!(seen > 15, "{seen}");
    }
}
