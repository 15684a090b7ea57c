//! Options that several commands share.

use crate::failure::Failure;
use clap::builder::TypedValueParser;
use clap::{Args, ValueEnum};
use ricci::flow::{Flips, Method, Options};
use ricci::geometry::Space;
use ricci::mesh::io::SheetUnit;
use ricci::metric::Scheme;
use serde::{Serialize, Serializer};
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// The name of a file on the command line, which reports hold as text.
#[derive(Debug, Clone, PartialEq)]
pub struct FileName(PathBuf);

impl From<OsString> for FileName {
    fn from(name: OsString) -> FileName {
        FileName(name.into())
    }
}

impl std::ops::Deref for FileName {
    type Target = Path;

    fn deref(&self) -> &Path {
        &self.0
    }
}

impl Serialize for FileName {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&self.to_string_lossy())
    }
}

/// The options of every command.
#[derive(Args, Serialize, Debug, Clone)]
pub struct Common {
    /// Write all numbers of the run as JSON
    #[arg(long, value_name = "R.json")]
    #[serde(skip)]
    pub report: Option<FileName>,
    /// No progress bar, no summary
    #[arg(long)]
    #[serde(skip)]
    pub quiet: bool,
    /// Threads, 0 for one per core; results do not depend on it
    #[arg(long, value_name = "N", default_value = "0", value_parser = threads())]
    pub threads: usize,
}

/// A number of threads; more than 1024 are of no use and can exhaust the system.
fn threads() -> impl TypedValueParser<Value = usize> {
    let all = || std::thread::available_parallelism().map_or(1, |n| n.get());
    clap::value_parser!(u16).range(..=1024).map(move |n| if n == 0 { all() } else { n.into() })
}

/// A mesh file, with the distance of welding.
#[derive(Args, Serialize, Debug, Clone)]
pub struct MeshArgs {
    /// Mesh file (.obj, .off, .ply, .stl, .glb, .gltf, .gii, .vtk, .vtp, .mz3, FreeSurfer's; also .gz) or intrinsic metric (.json: `faces` and `lengths` suffice); - for stdin
    #[serde(skip)]
    pub mesh: PathBuf,
    /// STL: corners within this distance are one vertex; 0: those in exactly the same place
    #[arg(long, value_name = "DISTANCE", value_parser = distance)]
    pub weld: Option<f64>,
}

/// The file of a surface, and the geometry of its lengths.
#[derive(Args, Serialize, Debug, Clone)]
pub struct SurfaceArgs {
    #[command(flatten)]
    #[serde(flatten)]
    pub file: MeshArgs,
    /// Geometry in which the input's lengths are read [default: the file's, e2 for mesh files]
    #[arg(long, value_enum, value_name = "GEOMETRY")]
    #[serde(skip)]
    pub input_geometry: Option<GeometryChoice>,
}

/// The options of the commands that compute a metric: the surface, the method, and the files that all of them write.
#[derive(Args, Serialize, Debug, Clone)]
pub struct MetricArgs {
    #[command(flatten)]
    #[serde(flatten)]
    pub surface: SurfaceArgs,
    #[command(flatten)]
    #[serde(flatten)]
    pub solve: SolveArgs,
    /// Write the metric
    #[arg(long, value_name = "M.json")]
    pub metric: Option<FileName>,
    /// Write the surface with its layout as texture coordinates (E²; H² of closed surfaces), .obj or .glb
    #[arg(long, value_name = "OUT.obj")]
    pub uv: Option<FileName>,
    /// Faces of --uv and --flat: those of the common subdivision, on which the map is exact, or the input's own
    #[arg(long, value_enum, value_name = "FACES", default_value_t = OnChoice::Refined)]
    pub on: OnChoice,
    /// With --on input: split the fewest of the input's edges so that no face of --uv or --flat is turned over; the surface
    /// stays as it is
    #[arg(long)]
    pub repair: bool,
    /// Write where the faces and vertices of --uv lie in the input's, numbered from 0: rows output_face,source_face, then
    /// output_vertex,source_face,b0,b1,b2
    #[arg(long, value_name = "X.csv", requires = "uv")]
    pub xref: Option<FileName>,
    #[command(flatten)]
    #[serde(flatten)]
    pub flat: FlatArgs,
    #[command(flatten)]
    #[serde(flatten)]
    pub common: Common,
}

/// The method by which a metric is computed.
#[derive(Args, Serialize, Debug, Clone)]
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
    #[serde(skip)]
    pub max_iterations: Option<u64>,
}

impl MetricArgs {
    /// Refuse options about the faces of --uv that do not go together.
    pub fn check_faces(&self) -> Result<(), Failure> {
        if self.repair && self.uv.is_none() && self.flat.flat.is_none() {
            return Err(Failure::Usage(
                "--repair changes the faces of --uv and --flat; add one of them".into(),
            ));
        }
        if self.repair && self.on != OnChoice::Input {
            return Err(Failure::Usage(
                "--repair: faces of the common subdivision do not fold; add --on input, or leave it out"
                    .into(),
            ));
        }
        Ok(())
    }

    /// The library's options of the flow.
    pub fn options(&self) -> Options {
        Options {
            method: self.solve.method.into(),
            tolerance: self.solve.tolerance,
            flips: self.solve.flips.into(),
            max_iterations: self.solve.max_iterations.map_or(0, |n| n as usize),
            threads: self.common.threads,
            ..Options::default()
        }
    }
}

/// A finite distance, 0 or more.
pub fn distance(text: &str) -> Result<f64, String> {
    number(text, |x| x >= 0.0, "must be a finite distance, 0 or more")
}

/// An angle in degrees from which on an edge is sharp.
pub fn sharp_angle(text: &str) -> Result<f64, String> {
    number(text, |x| x > 0.0 && x <= 180.0, "must be an angle in degrees above 0 and at most 180")
}

/// A radius around the base point, greater than 0: within 0 there is the surface alone.
pub fn radius(text: &str) -> Result<f64, String> {
    number(text, |x| x > 0.0, "must be a finite distance greater than 0")
}

/// A positive number.
pub fn positive(text: &str) -> Result<f64, String> {
    number(text, |x| x > 0.0, "must be a positive number")
}

/// A finite number that `fits`, or the error `otherwise`.
pub fn number(text: &str, fits: fn(f64) -> bool, otherwise: &str) -> Result<f64, String> {
    text.parse().ok().filter(|x: &f64| x.is_finite() && fits(*x)).ok_or_else(|| otherwise.into())
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

/// The faces of `--uv` and `--flat`.
#[derive(clap::ValueEnum, serde::Serialize, Debug, Clone, Copy, PartialEq, Default)]
#[serde(rename_all = "lowercase")]
pub enum OnChoice {
    /// Those of the common subdivision with the final triangulation: the map as it is
    #[default]
    Refined,
    /// The input's own: the map made linear on each
    Input,
}

/// The options of the layout as geometry.
#[derive(Args, Serialize, Debug, Clone, Default)]
pub struct FlatArgs {
    /// Write the layout in the plane as geometry (x, y, 0), a mesh .obj, .ply, .off or .glb; or as a drawing for cutting, .svg or .dxf, with
    /// the layers BOUNDARY, SEAMS and FOLDS
    #[arg(long, value_name = "OUT.obj")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flat: Option<FileName>,
    /// Edges of the input that are folds in drawings: the normals of the two faces differ by more than this [default: 30]
    #[arg(long, value_name = "DEGREES", requires = "flat", value_parser = angle)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fold_angle: Option<f64>,
    /// In drawings, a line outside the border and seams at this distance, on the layer ALLOWANCE
    #[arg(long, value_name = "DISTANCE", requires = "flat", value_parser = positive)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub allowance: Option<f64>,
    /// The unit of the coordinates, for the size of an SVG [default: mm]
    #[arg(long, value_enum, value_name = "UNIT", requires = "flat")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flat_unit: Option<FlatUnitChoice>,
}

/// The units of `--flat-unit`.
#[derive(ValueEnum, Serialize, Debug, Clone, Copy, PartialEq)]
#[serde(rename_all = "lowercase")]
pub enum FlatUnitChoice {
    /// Millimetres
    Mm,
    /// Centimetres
    Cm,
    /// Metres
    M,
    /// Inches
    In,
}

impl From<FlatUnitChoice> for SheetUnit {
    fn from(unit: FlatUnitChoice) -> SheetUnit {
        match unit {
            FlatUnitChoice::Mm => SheetUnit::Millimetre,
            FlatUnitChoice::Cm => SheetUnit::Centimetre,
            FlatUnitChoice::M => SheetUnit::Metre,
            FlatUnitChoice::In => SheetUnit::Inch,
        }
    }
}

fn angle(text: &str) -> Result<f64, String> {
    number(text, |x| (0.0..=180.0).contains(&x), "must be an angle from 0 to 180 degrees")
}
