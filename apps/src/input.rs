//! The surface that a command works on.

use crate::failure::Failure;
use crate::metric_file;
use crate::options::MeshArgs;
use crate::output::extension;
use crate::timing::{Seconds, timed};
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
    /// Those of reading and building.
    pub seconds: Seconds,
}

/// Read a mesh file ([`read_soup`]) or, from a name that ends in `.json`, an intrinsic metric; its lengths in a `geometry` other than
/// the file's if one is given.
pub fn read(file: &MeshArgs, geometry: Option<Space>, control: &Control) -> Result<Input, Failure> {
    let path = &file.mesh;
    let mut seconds = Seconds::default();
    control.step(Stage::Read, 0.0)?;
    let (surface, attributes) = if file.is_intrinsic() {
        let text = timed(&mut seconds.read, || read_text(path))?;
        let surface = timed(&mut seconds.build, || metric_file::parse(path, &text, geometry))?;
        (surface, Attributes::default())
    } else {
        let soup = timed(&mut seconds.read, || read_soup(file))?;
        control.step(Stage::Build, 0.0)?;
        let surface = timed(&mut seconds.build, || Surface::from_soup(&soup))?;
        (geometry.into_iter().fold(surface, Surface::read_in), soup.attributes)
    };
    control.check()?;
    Ok(Input { path: path.clone(), surface, attributes, seconds })
}

impl MeshArgs {
    /// Whether the file holds edge lengths in place of positions.
    pub fn is_intrinsic(&self) -> bool {
        extension(&self.mesh) == "json" && self.weld.is_none()
    }
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

/// Read a mesh file.
pub fn read_soup(file: &MeshArgs) -> Result<Soup, Failure> {
    match file.weld {
        None => Ok(io::read(&file.mesh)?),
        Some(weld) if extension(&file.mesh) == "stl" => Ok(io::read_stl(&file.mesh, weld)?),
        Some(_) => Err(Failure::Usage(
            "--weld: only an STL file has no vertices of its own; ricci repair welds".into(),
        )),
    }
}

/// The text of a file, with the file's name in the error.
pub fn read_text(path: &Path) -> Result<String, Failure> {
    std::fs::read_to_string(path).map_err(|e| Failure::Input(format!("{}: {e}", path.display())))
}
