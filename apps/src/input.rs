//! The surface that a command works on.

use crate::failure::Failure;
use crate::metric_file;
use crate::options::{MeshArgs, SurfaceArgs};
use crate::output::STANDARD;
use crate::timing::{PhaseSeconds, timed};
use ricci::Control;
use ricci::Surface;
use ricci::control::Stage;
use ricci::geometry::Space;
use ricci::mesh::io::{Attributes, NumberColumn, Soup, SurfaceFile, SurfaceFormat};
use ricci::mesh::{Mesh, Point};
use ricci::metric::{CommonSubdivision, Split};
use std::io::Read;
use std::path::{Path, PathBuf};

/// A connected oriented surface with edge lengths.
pub struct Input {
    pub path: PathBuf,
    pub surface: Surface,
    /// The data of the mesh file beside positions and faces.
    pub attributes: Attributes,
    /// The edges that were halved after the surface was read, if any were.
    pub split: Option<Split>,
}

/// The contents of a file.
pub enum FileContent {
    /// The text of an intrinsic metric.
    Lengths(String),
    Triangles(Box<Soup>),
}

/// Read the file of a mesh or of an intrinsic metric. A file on stdin is read as one with a name is: what it holds says what it is.
pub fn content(file: &MeshArgs) -> Result<FileContent, Failure> {
    let found = opened(&file.mesh)?;
    match (found.format(), file.weld) {
        (SurfaceFormat::Stl, Some(weld)) => Ok(FileContent::Triangles(Box::new(found.welded(weld)?))),
        (_, Some(_)) => Err(Failure::Usage(WELD_ELSEWHERE.into())),
        (SurfaceFormat::Metric, None) => Ok(FileContent::Lengths(found.text())),
        (_, None) => Ok(FileContent::Triangles(Box::new(found.soup()?))),
    }
}

/// The vertices and polygons of an OBJ file, by its name or from stdin.
pub fn polygons(mesh: &Path) -> ricci::Result<(Vec<Point>, Vec<Vec<u32>>)> {
    opened(mesh)?.polygons()
}

/// A file, by its name or from stdin.
fn opened(mesh: &Path) -> ricci::Result<SurfaceFile> {
    if mesh != Path::new(STANDARD) {
        return SurfaceFile::open(mesh);
    }
    let failed = |e: std::io::Error| ricci::Error::Io { path: "stdin".into(), message: e.to_string() };
    let mut bytes = Vec::new();
    std::io::stdin().lock().read_to_end(&mut bytes).map_err(failed)?;
    SurfaceFile::of_bytes(bytes, "stdin")
}

const WELD_ELSEWHERE: &str = "--weld: only an STL file has no vertices of its own; ricci repair welds";

/// Read a mesh file that must hold triangles.
pub fn read_triangles(path: &Path) -> Result<Soup, Failure> {
    match content(&MeshArgs { mesh: path.into(), weld: None })? {
        FileContent::Triangles(soup) => Ok(*soup),
        FileContent::Lengths(_) => {
            Err(Failure::Input(format!("{}: an intrinsic metric has no triangles in space", path.display())))
        }
    }
}

/// Least length and largest coordinate whose products with others neither underflow nor overflow.
const RANGE: [f64; 2] = [1e-150, 1e150];

/// The first coordinate that is too large to compute with, if there is one.
pub fn out_of_range(soup: &Soup) -> Option<String> {
    let coordinates = soup.positions.iter().enumerate().flat_map(|(v, p)| p.iter().map(move |x| (v, *x)));
    let (v, x) = coordinates.into_iter().find(|(_, x)| x.is_finite() && x.abs() > RANGE[1])?;
    let [least, most] = RANGE;
    Some(format!(
        "vertex {v}: the coordinate {x:e} is outside the range: lengths between {least:e} and {most:e} (rescale)"
    ))
}

/// Read the surface of a command.
pub fn surface(args: &SurfaceArgs, seconds: &mut PhaseSeconds, control: &Control) -> Result<Input, Failure> {
    read(&args.file, args.input_geometry.map(Space::from), seconds, control)
}

/// Read a surface, with its lengths in a `geometry` other than the file's if one is given. Adds the seconds of reading and building.
pub fn read(
    file: &MeshArgs,
    geometry: Option<Space>,
    seconds: &mut PhaseSeconds,
    control: &Control,
) -> Result<Input, Failure> {
    let path = file.mesh.clone();
    control.step(Stage::Read, 0.0)?;
    let content = timed(&mut seconds.read, || content(file))?;
    control.step(Stage::Build, 0.0)?;
    let (surface, attributes) = timed(&mut seconds.build, || -> Result<_, Failure> {
        Ok(match content {
            FileContent::Lengths(text) => {
                (metric_file::parse(&path, &text, geometry)?, Attributes::default())
            }
            FileContent::Triangles(soup) => {
                if let Some(why) = out_of_range(&soup) {
                    return Err(Failure::Input(format!("{}: {why}", path.display())));
                }
                in_space(*soup, geometry)?
            }
        })
    })?;
    control.check()?;
    Ok(Input { path, surface, attributes, split: None })
}

/// The surface of triangles in space, with its lengths in a `geometry` other than E² if one is given, and its attributes.
pub fn in_space(soup: Soup, geometry: Option<Space>) -> ricci::Result<(Surface, Attributes)> {
    let surface = Surface::in_space(Mesh::from_soup(&soup)?, soup.positions)?;
    Ok((geometry.into_iter().fold(surface, Surface::read_in), soup.attributes))
}

impl Input {
    pub fn mesh(&self) -> &Mesh {
        self.surface.mesh()
    }

    /// The same input with edges halved.
    pub fn halved(&self, split: &Split) -> ricci::Result<Input> {
        let given = &self.attributes;
        let surface = split.surface()?;
        let parents: Vec<u32> = surface.mesh().faces().map(|f| split.place(f).0.0).collect();
        let at_vertices = |column: &NumberColumn| -> ricci::Result<NumberColumn> {
            let rows: Vec<[f64; 1]> = column.values.iter().map(|&x| [x]).collect();
            let values = split.from_given_vertices(&rows)?.into_iter().map(|[x]| x).collect();
            Ok(NumberColumn { name: column.name.clone(), kind: column.kind, values })
        };
        let attributes = Attributes {
            normals: given.normals.as_ref().map(|values| split.from_given_vertices(values)).transpose()?,
            corner_normals: given.corner_normals.as_ref().map(|v| split.from_given_corners(v)).transpose()?,
            colors: given.colors.as_ref().map(|values| split.from_given_vertices(values)).transpose()?,
            uv: given.uv.as_ref().map(|values| split.from_given_corners(values)).transpose()?,
            labels: given.labels.as_ref().map(|labels| labels.of_origins(parents.iter().copied())),
            vertex_numbers: given.vertex_numbers.iter().map(at_vertices).collect::<ricci::Result<_>>()?,
            face_numbers: given.face_numbers.iter().map(|column| column.of_origins(&parents)).collect(),
            unread: given.unread.clone(),
        };
        let (path, split) = (self.path.clone(), Some(split.clone()));
        Ok(Input { path, surface, attributes, split })
    }

    /// The positions in space; none for an intrinsic metric.
    pub fn positions(&self) -> Option<&[Point]> {
        self.surface.positions().map(|positions| positions.as_slice())
    }

    /// The positions of the vertices of the input's own mesh, or of a `subdivision` of it.
    ///
    /// # Errors
    /// [`Failure::Failed`] for an intrinsic metric.
    pub fn positions_on(&self, subdivision: Option<&CommonSubdivision>) -> Result<Vec<Point>, Failure> {
        let given = self.positions().ok_or_else(Failure::no_positions)?;
        Ok(subdivision.map_or_else(|| Ok(given.to_vec()), |r| r.from_vertices(0, given))?)
    }

    /// Refuse the vertex of an option that the surface does not have.
    pub fn check_vertex(&self, option: &str, vertex: Option<u32>) -> Result<(), Failure> {
        let n = self.mesh().n_vertices();
        match vertex {
            Some(v) if v as usize >= n => {
                Err(Failure::Usage(format!("{option} {v}: there is no such vertex, they are 0 to {}", n - 1)))
            }
            _ => Ok(()),
        }
    }
}
