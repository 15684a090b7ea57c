//! Options that several commands share.

use clap::Args;
use ricci::flow::{Flips, Method, Options};
use ricci::geometry::Space;
use ricci::metric::Scheme;
use std::path::PathBuf;

/// What every command takes.
#[derive(Args, Debug, Clone)]
pub struct Common {
    /// Write all numbers of the run as JSON
    #[arg(long, value_name = "R.json")]
    pub report: Option<PathBuf>,
    /// No progress bar, no summary
    #[arg(long)]
    pub quiet: bool,
    /// Threads, 0 for one per core; results do not depend on it
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = threads())]
    threads: u16,
}

impl Common {
    /// The number of threads to use, at least 1.
    pub fn threads(&self) -> usize {
        match self.threads {
            0 => std::thread::available_parallelism().map_or(1, |n| n.get()),
            n => n.into(),
        }
    }
}

/// More threads than this help nobody and can exhaust the system.
fn threads() -> impl clap::builder::TypedValueParser<Value = u16> {
    clap::value_parser!(u16).range(..=1024)
}

/// The surface that a metric is computed for.
#[derive(Args, Debug, Clone)]
pub struct SurfaceArgs {
    /// Mesh file (.obj, .off, .ply, .stl, .glb, .gltf, .gii) or intrinsic metric (.json: `faces` and `lengths` suffice)
    pub mesh: PathBuf,
    /// STL: corners within this distance are one vertex; 0: those in exactly the same place
    #[arg(long, value_name = "DISTANCE", value_parser = distance)]
    pub weld: Option<f64>,
    /// Geometry in which the input's lengths are read [default: the file's, e2 for mesh files]
    #[arg(long, value_enum, value_name = "GEOMETRY")]
    pub input_geometry: Option<GeometryChoice>,
}

/// How a metric is computed.
#[derive(Args, Debug, Clone)]
pub struct SolveArgs {
    /// Discrete conformal structure
    #[arg(long, value_enum, default_value_t = SchemeChoice::Yamabe)]
    pub scheme: SchemeChoice,
    /// Newton's method, or the flow itself
    #[arg(long, value_enum, default_value_t = MethodChoice::Newton)]
    pub method: MethodChoice,
    /// Edge flips inside the conformal class: as needed, with the layout carried back to the given triangulation, or never
    #[arg(long, value_enum, default_value_t = FlipsChoice::Auto)]
    pub flips: FlipsChoice,
    /// Largest |K − K̄| of a converged metric, radians
    #[arg(long, value_name = "T", default_value = "1e-10", value_parser = positive)]
    pub tolerance: f64,
    /// Steps before giving up [default: 500 for newton, 200000 for gradient]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    pub max_iterations: Option<u64>,
}

impl SolveArgs {
    /// The library's options for this.
    pub fn options(&self, threads: usize) -> Options {
        Options {
            method: self.method.into(),
            tolerance: self.tolerance,
            flips: self.flips.into(),
            max_iterations: self.max_iterations.map_or(0, |n| n as usize),
            threads,
            ..Options::default()
        }
    }
}

pub fn distance(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x >= 0.0 && x.is_finite() => Ok(x),
        _ => Err("must be a finite distance, 0 or more".into()),
    }
}

/// A distance to which copies of a surface can be made: the one at 0 is the surface itself.
pub fn radius(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x > 0.0 && x.is_finite() => Ok(x),
        _ => Err("must be a finite distance greater than 0".into()),
    }
}

pub fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x > 0.0 && x.is_finite() => Ok(x),
        _ => Err("must be a positive number".into()),
    }
}

/// Choices of an option that are those of a type of the library, by the same names.
macro_rules! choices {
    ($(#[$about:meta])* $name:ident = $of:ty { $($(#[$what:meta])* $choice:ident),+ $(,)? }) => {
        $(#[$about])*
        #[derive(clap::ValueEnum, serde::Serialize, Debug, Clone, Copy, PartialEq)]
        #[serde(rename_all = "kebab-case")]
        pub enum $name {
            $($(#[$what])* $choice),+
        }

        impl From<$name> for $of {
            fn from(choice: $name) -> Self {
                match choice {
                    $($name::$choice => Self::$choice),+
                }
            }
        }
    };
}
pub(crate) use choices;

choices!(GeometryChoice = Space { E2, H2, S2 });
choices!(SchemeChoice = Scheme { Yamabe, Inversive, Thurston, Tangential, Virtual });
choices!(MethodChoice = Method { Newton, Gradient });
choices!(FlipsChoice = Flips { Auto, Never });

/// The faces of `--uv`.
#[derive(clap::ValueEnum, serde::Serialize, Debug, Clone, Copy, PartialEq, Default)]
#[serde(rename_all = "lowercase")]
pub enum OnChoice {
    /// Those of the common refinement with the final triangulation: the map as it is
    #[default]
    Refined,
    /// The input's own: the map made linear on each
    Input,
}
