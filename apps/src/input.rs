//! The surface that a command works on.

use crate::failure::Failure;
use crate::metric_file::{self, Intrinsic};
use crate::options::SurfaceArgs;
use crate::output::extension;
use crate::timing::timed;
use ricci::Control;
use ricci::control::Stage;
use ricci::geometry::Space;
use ricci::mesh::io::{self, Attributes, Soup};
use ricci::mesh::{Mesh, PerEdge, Point};
use ricci::metric::lengths_from_positions;
use std::path::{Path, PathBuf};

/// A connected oriented surface with edge lengths.
pub struct Input {
    pub path: PathBuf,
    pub mesh: Mesh,
    pub lengths: PerEdge<f64>,
    /// The geometry in which the lengths are read.
    pub geometry: Space,
    /// Positions in space; none for an intrinsic metric.
    pub positions: Option<Vec<Point>>,
    /// What else the mesh file says of vertices and corners.
    pub attributes: Attributes,
    pub seconds_read: f64,
    pub seconds_build: f64,
}

/// Read a mesh file ([`read_soup`]) or, from a name that ends in `.json`, an intrinsic metric.
pub fn read(args: &SurfaceArgs, control: &Control) -> Result<Input, Failure> {
    let (path, weld) = (args.mesh.as_path(), args.weld);
    let (mut seconds_read, mut seconds_build) = (0.0, 0.0);
    control.step(Stage::Read, 0.0)?;
    let (mesh, lengths, geometry, positions, attributes) = if extension(path) == "json" && weld.is_none() {
        let text = timed(&mut seconds_read, || read_text(path))?;
        let Intrinsic { mesh, lengths, geometry } =
            timed(&mut seconds_build, || metric_file::parse(path, &text))?;
        (mesh, lengths, geometry, None, Attributes::default())
    } else {
        let soup = timed(&mut seconds_read, || read_soup(path, weld))?;
        control.step(Stage::Build, 0.0)?;
        let build = || -> Result<_, Failure> {
            let mesh = Mesh::from_soup(&soup)?;
            let lengths = lengths_from_positions(&mesh, &soup.positions)?;
            Ok((mesh, lengths))
        };
        let (mesh, lengths) = timed(&mut seconds_build, build)?;
        (mesh, lengths, Space::E2, Some(soup.positions), soup.attributes)
    };
    control.check()?;
    let path = path.into();
    let geometry = args.input_geometry.map_or(geometry, Space::from);
    Ok(Input { path, mesh, lengths, geometry, positions, attributes, seconds_read, seconds_build })
}

/// Read a mesh file; the corners of an STL file are one vertex within the distance `weld`.
pub fn read_soup(path: &Path, weld: Option<f64>) -> Result<Soup, Failure> {
    match weld {
        None => Ok(io::read(path)?),
        Some(weld) if extension(path) == "stl" => Ok(io::read_stl(path, weld)?),
        Some(_) => Err(Failure::Usage(
            "--weld: only an STL file has no vertices of its own; ricci repair welds".into(),
        )),
    }
}

/// The text of a file, with the file's name in the error.
pub fn read_text(path: &Path) -> Result<String, Failure> {
    std::fs::read_to_string(path).map_err(|e| Failure::Input(format!("{}: {e}", path.display())))
}
