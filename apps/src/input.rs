//! The surface that a command works on.

use crate::failure::Failure;
use crate::metric_file::{self, Intrinsic};
use crate::options::SurfaceArgs;
use crate::output::extension;
use crate::timing::timed;
use ricci::Control;
use ricci::Surface;
use ricci::control::Stage;
use ricci::geometry::Space;
use ricci::mesh::io::{self, Attributes, Soup};
use ricci::mesh::{Mesh, Point};
use std::path::{Path, PathBuf};

/// A connected oriented surface with edge lengths.
pub struct Input {
    pub path: PathBuf,
    pub surface: Surface,
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
    let geometry = args.input_geometry.map(Space::from);
    let (surface, attributes) = if extension(path) == "json" && weld.is_none() {
        let text = timed(&mut seconds_read, || read_text(path))?;
        let build = || -> Result<_, Failure> {
            let Intrinsic { mesh, lengths, geometry: written } = metric_file::parse(path, &text)?;
            Ok(Surface::intrinsic(mesh, lengths, geometry.unwrap_or(written))?)
        };
        (timed(&mut seconds_build, build)?, Attributes::default())
    } else {
        let soup = timed(&mut seconds_read, || read_soup(path, weld))?;
        control.step(Stage::Build, 0.0)?;
        let build = || -> Result<_, Failure> {
            let surface = Surface::from_soup(&soup)?;
            Ok(match geometry {
                Some(geometry) => surface.read_in(geometry),
                None => surface,
            })
        };
        (timed(&mut seconds_build, build)?, soup.attributes)
    };
    control.check()?;
    Ok(Input { path: path.into(), surface, attributes, seconds_read, seconds_build })
}

impl Input {
    pub fn mesh(&self) -> &Mesh {
        self.surface.mesh()
    }

    /// Positions in space; none for an intrinsic metric.
    pub fn positions(&self) -> Option<&[Point]> {
        self.surface.positions().map(|positions| positions.as_slice())
    }
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
