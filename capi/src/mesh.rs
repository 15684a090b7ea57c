//! Meshes: connectivity with positions in space, with edge lengths, or with both.

use crate::arrays::{self, CallerBuffer, copy_each, copy_out, copy_rows};
use crate::choice::choices;
use crate::control;
use crate::failure::{Failure, Outcome};
use crate::guard::{self, handle, shared};
use crate::memory;
use crate::optional::{Wrap, write_textured};
use crate::paths::signed_edge;
use crate::soup_file::{read_soup, write_soup};
use crate::status::ricci_status;
use crate::structs::{self, sized};
use ricci::control::Stage;
use ricci::geometry::Space;
use ricci::mesh::io::{Attributes, Soup};
use ricci::mesh::{Mesh, PerEdge, Place, Point};
use ricci::{Control, Surface};
use std::ffi::c_char;
use std::sync::{Arc, OnceLock};

choices!(pub(crate) SPACES: Space = "space", [
    RICCI_SPACE_E2 => Space::E2,
    RICCI_SPACE_H2 => Space::H2,
    RICCI_SPACE_S2 => Space::S2,
]);

// A kind of numbers that the elements of a mesh or of a triangle list have.
choices!(pub(crate) enum MeshValue, VALUES = "which", [
    RICCI_POSITIONS => Positions,
    RICCI_LENGTHS => Lengths,
    RICCI_NORMALS => Normals,
    RICCI_COLORS => Colors,
    RICCI_UV => Uv,
    RICCI_CORNER_NORMALS => CornerNormals,
]);

choices!(WRAPS: Wrap = "wrap", [
    RICCI_WRAP_REPEAT => Wrap::Repeat,
    RICCI_WRAP_MIRROR => Wrap::Mirror,
    RICCI_WRAP_CLAMP => Wrap::Clamp,
]);

pub struct ricci_mesh {
    pub(crate) connectivity: Arc<Mesh>,
    pub(crate) positions: Option<Arc<Vec<Point>>>,
    /// The caller's edge lengths with their geometry; without them lengths are measured in space.
    pub(crate) lengths: Option<(Arc<PerEdge<f64>>, Space)>,
    /// The attributes that the file had beside positions and faces.
    pub(crate) attributes: Attributes,
    /// Of a refined metric, the places of its vertices on the surface that it was made from.
    pub(crate) places: Option<Vec<Place>>,
    pub(crate) surface: OnceLock<Surface>,
    pub(crate) summary: OnceLock<ricci_mesh_summary>,
}
handle!(ricci_mesh, "mesh", |mesh| mesh.connectivity.n_vertices().max(mesh.connectivity.n_faces() / 2));

/// The connectivity of a triangle list. A list with defects takes several times the memory of one without, to name them, which is asked for when
/// they are found.
fn connected(soup: &Soup, control: &Control) -> Outcome<Mesh> {
    let n = soup.positions.len().max(soup.faces.len().div_ceil(2));
    let reserve = memory::work(n, memory::SOUND_MESH)?;
    if let Some(mesh) = Mesh::from_sound(soup)? {
        return Ok(mesh);
    }
    drop(reserve);
    control.check()?;
    let _reserve = memory::work(n, memory::MESH)?;
    Ok(Mesh::from_soup(soup)?)
}

impl ricci_mesh {
    pub(crate) fn in_space(connectivity: Arc<Mesh>, positions: Arc<Vec<Point>>) -> ricci_mesh {
        ricci_mesh {
            connectivity,
            positions: Some(positions),
            lengths: None,
            attributes: Attributes::default(),
            places: None,
            surface: OnceLock::new(),
            summary: OnceLock::new(),
        }
    }

    pub(crate) fn intrinsic(connectivity: Arc<Mesh>, lengths: Arc<PerEdge<f64>>, space: Space) -> ricci_mesh {
        let mesh = ricci_mesh::in_space(connectivity, Arc::default());
        ricci_mesh { positions: None, lengths: Some((lengths, space)), ..mesh }
    }

    /// A refined metric with the places of its vertices on the surface that it was made from.
    pub(crate) fn placed(self, places: Vec<Place>) -> ricci_mesh {
        ricci_mesh { places: Some(places), ..self }
    }

    pub(crate) fn places(&self) -> Outcome<&[Place]> {
        self.places.as_deref().ok_or_else(|| Failure::argument("this mesh was not refined"))
    }

    pub(crate) fn from_soup(soup: Soup) -> Outcome<ricci_mesh> {
        let control = control::of_thread()?;
        control.step(Stage::Build, 0.6)?;
        let connectivity = Arc::new(connected(&soup, &control)?);
        control.check()?;
        let Soup { positions, attributes, .. } = soup;
        Ok(ricci_mesh { attributes, ..ricci_mesh::in_space(connectivity, Arc::new(positions)) })
    }

    /// The mesh as a triangle list, with the attributes that it was read with.
    pub(crate) fn soup(&self) -> Outcome<Soup> {
        let positions = self.positions()?.to_vec();
        let faces = self.connectivity.triangles();
        Ok(Soup { positions, faces, attributes: self.attributes.clone() })
    }

    pub(crate) fn positions(&self) -> Outcome<&[Point]> {
        let positions = self.positions.as_ref().map(|positions| positions.as_slice());
        positions.ok_or_else(|| Failure::argument("this mesh is intrinsic: it has lengths, no positions"))
    }

    /// The surface with the lengths that the caller gave, or that are measured in space.
    pub(crate) fn surface(&self) -> Outcome<&Surface> {
        if let Some(surface) = self.surface.get() {
            return Ok(surface);
        }
        let mesh = self.connectivity.clone();
        let surface = match (&self.lengths, &self.positions) {
            (Some((lengths, space)), None) => Surface::intrinsic(mesh, lengths.clone(), *space)?,
            (Some((lengths, space)), Some(positions)) => {
                Surface::intrinsic(mesh, lengths.clone(), *space)?.with_positions(positions.clone())?
            }
            (None, positions) => Surface::in_space(mesh, positions.clone().unwrap_or_default())?,
        };
        Ok(self.surface.get_or_init(|| surface))
    }
}

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_mesh_summary {
    pub size: usize,
    pub n_vertices: usize,
    pub n_edges: usize,
    pub n_faces: usize,
    pub n_boundary_loops: usize,
    pub n_boundary_vertices: usize,
    pub euler: i64,
    pub genus: usize,
    pub has_positions: u32,
    pub geometry: u32,
    pub n_normals: usize,
    pub n_colors: usize,
    pub n_uv: usize,
    pub n_corner_normals: usize,
}
// SAFETY: numbers; 8-byte alignment, size first.
sized!(ricci_mesh_summary, "summary");

/// The numbers of normals, of colours, of faces with texture coordinates, and of faces with normals at their corners.
pub(crate) fn count(attributes: &Attributes) -> [usize; 4] {
    let Attributes { normals, colors, uv, corner_normals, .. } = attributes;
    fn n<T>(list: &Option<Vec<T>>) -> usize {
        list.as_ref().map_or(0, Vec::len)
    }
    [n(normals), n(colors), n(uv), n(corner_normals)]
}

/// Copies one of the attributes to the caller.
pub(crate) fn copy_attribute(
    which: MeshValue,
    attributes: &Attributes,
    values: *mut f64,
    capacity: usize,
) -> Outcome {
    fn copy<T: arrays::CopiedRow<Entry = f64>>(
        what: &str,
        list: &Option<Vec<T>>,
        values: *mut f64,
        capacity: usize,
    ) -> Outcome {
        let list =
            list.as_deref().ok_or_else(|| Failure::argument(format!("there are no {what} to be had")))?;
        copy_out("values", list, values, capacity)
    }
    match which {
        MeshValue::Normals => copy("normals", &attributes.normals, values, capacity),
        MeshValue::Colors => copy("colors", &attributes.colors, values, capacity),
        MeshValue::Uv => copy("uv", &attributes.uv, values, capacity),
        MeshValue::CornerNormals => copy("corner normals", &attributes.corner_normals, values, capacity),
        MeshValue::Positions | MeshValue::Lengths => Err(Failure::argument("a triangle list has no lengths")),
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_mesh_from_arrays(
    positions: *const f64,
    stride: usize,
    n_vertices: usize,
    faces: *const u32,
    n_faces: usize,
    mesh: *mut *mut ricci_mesh,
) -> ricci_status {
    guard::make(mesh, || {
        let positions = arrays::points(positions, stride, n_vertices)?;
        ricci_mesh::from_soup(Soup::new(positions, arrays::faces(faces, n_faces)?))
    })
}

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_gluing {
    pub size: usize,
    pub n_vertices: usize,
    pub faces: *const u32,
    pub face_edges: *const i32,
    pub n_faces: usize,
    pub lengths: *const f64,
    pub n_edges: usize,
    pub geometry: u32,
    pub reserved: u32,
}
// SAFETY: numbers and raw pointers; 8-byte alignment, size first.
sized!(ricci_gluing, "gluing", reserved);

/// The caller's lengths of the edges of a mesh, which must be finite and positive.
fn lengths_of(mesh: &Mesh, lengths: *const f64, n: usize) -> Outcome<Arc<PerEdge<f64>>> {
    let lengths = arrays::array_of("lengths", lengths, n, mesh.n_edges())?;
    for (edge, &length) in lengths.iter().enumerate() {
        if !(length.is_finite() && length > 0.0) {
            return Err(ricci::Error::EdgeLength { edge, length }.into());
        }
    }
    Ok(Arc::new(lengths.into()))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_mesh_from_gluing(
    gluing: *const ricci_gluing,
    mesh: *mut *mut ricci_mesh,
) -> ricci_status {
    guard::make(mesh, || {
        if gluing.is_null() {
            return Err(Failure::null("gluing"));
        }
        let given = structs::read(gluing)?;
        let geometry = SPACES.choose(given.geometry)?;
        let faces = arrays::faces(given.faces, given.n_faces)?;
        let face_edges: Vec<[i32; 3]> = arrays::array("face_edges", given.face_edges.cast(), given.n_faces)?;
        let connectivity = Mesh::from_gluing(given.n_vertices, &faces, &face_edges)?;
        let lengths = lengths_of(&connectivity, given.lengths, given.n_edges)?;
        Ok(ricci_mesh::intrinsic(Arc::new(connectivity), lengths, geometry))
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_mesh_with_lengths(
    mesh: *const ricci_mesh,
    lengths: *const f64,
    n_edges: usize,
    geometry: u32,
    result: *mut *mut ricci_mesh,
) -> ricci_status {
    guard::make(result, || {
        let mesh = shared(mesh)?;
        let lengths = lengths_of(&mesh.connectivity, lengths, n_edges)?;
        let measured = ricci_mesh::intrinsic(mesh.connectivity.clone(), lengths, SPACES.choose(geometry)?);
        let (positions, attributes) = (mesh.positions.clone(), mesh.attributes.clone());
        Ok(ricci_mesh { positions, attributes, ..measured })
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_mesh_read(path: *const c_char, mesh: *mut *mut ricci_mesh) -> ricci_status {
    guard::make(mesh, || {
        let path = arrays::path(path)?;
        ricci_mesh::from_soup(read_soup(&path)?)
    })
}

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_attributes {
    pub size: usize,
    pub normals: *const f64,
    pub colors: *const f64,
    pub uv: *const f64,
    pub corner_normals: *const f64,
    pub png: *const u8,
    pub png_size: usize,
    pub wrap: u32,
    pub reserved: u32,
}
// SAFETY: numbers and raw pointers; 8-byte alignment, size first.
sized!(ricci_attributes, "attributes", reserved);

impl ricci_attributes {
    /// The attributes of a triangle list with the caller's in place of those that the caller can give: names of faces and further numbers stay.
    pub(crate) fn of(&self, soup: &Soup) -> Outcome<Attributes> {
        let (v, f) = (soup.positions.len(), soup.faces.len());
        let mut attributes = soup.attributes.clone();
        attributes.normals = arrays::optional("normals", self.normals, v)?;
        attributes.colors = arrays::optional("colors", self.colors, v)?;
        attributes.uv = arrays::optional("uv", self.uv, f)?;
        attributes.corner_normals = arrays::optional("corner_normals", self.corner_normals, f)?;
        Ok(attributes)
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_mesh_write(
    mesh: *const ricci_mesh,
    attributes: *const ricci_attributes,
    path: *const c_char,
) -> ricci_status {
    guard::with(mesh, |mesh| {
        let path = arrays::path(path)?;
        let mut soup = mesh.soup()?;
        let given = structs::read(attributes)?;
        if !attributes.is_null() {
            soup.attributes = given.of(&soup)?;
        }
        if given.png.is_null() && given.png_size == 0 {
            return write_soup(&path, &soup);
        }
        let wrap = WRAPS.choose(given.wrap)?;
        let png: Vec<u8> = arrays::array("png", given.png, given.png_size)?;
        if !png.starts_with(b"\x89PNG\r\n\x1a\n") {
            return Err(Failure::argument("png is no PNG file: its first eight bytes are not that format's"));
        }
        if soup.attributes.uv.is_none() {
            return Err(Failure::argument("a texture needs uv, texture coordinates"));
        }
        if !path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("glb")) {
            return Err(Failure::argument("a texture is written in .glb files only"));
        }
        write_textured(&path, &soup, &png, wrap)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_mesh_free(mesh: *mut ricci_mesh) {
    guard::free(mesh);
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_mesh_summarise(
    mesh: *const ricci_mesh,
    summary: *mut ricci_mesh_summary,
    size: usize,
) -> ricci_status {
    guard::with(mesh, |handle| {
        let mesh = &handle.connectivity;
        let geometry = SPACES.number(handle.lengths.as_ref().map_or(Space::E2, |(_, space)| *space))?;
        let [n_normals, n_colors, n_uv, n_corner_normals] = count(&handle.attributes);
        let counts = handle.summary.get_or_init(|| ricci_mesh_summary {
            size,
            n_vertices: mesh.n_vertices(),
            n_edges: mesh.n_edges(),
            n_faces: mesh.n_faces(),
            n_boundary_loops: mesh.boundary_loops().len(),
            n_boundary_vertices: mesh.vertices().filter(|&v| mesh.is_boundary_vertex(v)).count(),
            euler: mesh.euler(),
            genus: mesh.genus(),
            has_positions: handle.positions.is_some().into(),
            geometry,
            n_normals,
            n_colors,
            n_uv,
            n_corner_normals,
        });
        structs::write(*counts, summary, size)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_mesh_values(
    mesh: *const ricci_mesh,
    which: u32,
    values: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(mesh, |mesh| match VALUES.choose(which)? {
        MeshValue::Positions => copy_out("positions", mesh.positions()?, values, capacity),
        MeshValue::Lengths => copy_out("lengths", mesh.surface()?.lengths(), values, capacity),
        which => copy_attribute(which, &mesh.attributes, values, capacity),
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_mesh_faces(
    mesh: *const ricci_mesh,
    faces: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::with(mesh, |mesh| copy_out("faces", &mesh.connectivity.triangles(), faces, capacity))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_mesh_edges(
    mesh: *const ricci_mesh,
    edges: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::with(mesh, |mesh| {
        let mesh = &mesh.connectivity;
        let ends = mesh.edges().map(|e| mesh.ends(e).map(|v| v.0));
        copy_each("edges", mesh.n_edges(), ends, edges, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_mesh_face_edges(
    mesh: *const ricci_mesh,
    face_edges: *mut i32,
    capacity: usize,
) -> ricci_status {
    guard::with(mesh, |mesh| {
        let mesh = &mesh.connectivity;
        let signed = mesh.faces().map(|f| {
            let [ab, bc, ca] = mesh.face_halfedges(f).map(signed_edge);
            [bc, ca, ab]
        });
        copy_each("face_edges", mesh.n_faces(), signed, face_edges, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_mesh_boundary(
    mesh: *const ricci_mesh,
    vertices: *mut u32,
    vertices_capacity: usize,
    starts: *mut usize,
    starts_capacity: usize,
) -> ricci_status {
    guard::with(mesh, |mesh| {
        let mesh = &mesh.connectivity;
        let loops = mesh.boundary_loops();
        let rows = loops.iter().map(|walk| walk.iter().rev().map(|&h| mesh.origin(h).0));
        copy_rows(
            "vertices",
            rows,
            CallerBuffer(vertices, vertices_capacity),
            CallerBuffer(starts, starts_capacity),
        )
    })
}
