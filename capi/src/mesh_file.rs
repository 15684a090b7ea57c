//! Meshes from and to files, with their attributes.

use crate::arrays::{self, copy_out};
use crate::choice::{choice, choose};
use crate::failure::{Failure, Outcome};
use crate::guard;
use crate::mesh::ricci_mesh;
use crate::sized::{self, sized};
use crate::status::ricci_status;
use ricci::mesh::io::{self, Attributes, Format, Soup, Texture, Wrap};
use std::ffi::c_char;
use std::mem::MaybeUninit;
use std::ptr::null;

/// What is written beside positions and faces. Let ricci_mesh_attributes_init fill it, then change fields.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_mesh_attributes {
    /// Bytes of this struct that are filled.
    pub size: usize,
    /// Normals of the vertices, n_vertices x 3, of any length; NULL (default): none.
    pub normals: *const f64,
    /// Colours of the vertices, n_vertices x 4: red, green, blue, opacity, from 0 to 1; NULL (default): none.
    pub colors: *const f64,
    /// Texture coordinates of the faces' corners, n_faces x 3 x 2, v upwards; NULL (default): none.
    pub uv: *const f64,
    /// Normals of the faces' corners, n_faces x 3 x 3, of any length, in place of those of the vertices; NULL (default): none.
    pub corner_normals: *const f64,
}

// SAFETY: pointers of 8 bytes that are only read through `arrays`, size first.
sized!(ricci_mesh_attributes, "attributes");

impl ricci_mesh_attributes {
    fn none() -> Self {
        ricci_mesh_attributes {
            size: size_of::<Self>(),
            normals: null(),
            colors: null(),
            uv: null(),
            corner_normals: null(),
        }
    }

    fn read(
        attributes: *const ricci_mesh_attributes,
        n_vertices: usize,
        n_faces: usize,
    ) -> Outcome<Attributes> {
        fn list<T: Copy>(what: &str, data: *const f64, n: usize) -> Outcome<Option<Vec<T>>> {
            if data.is_null() { Ok(None) } else { arrays::array(what, data.cast(), n).map(Some) }
        }
        let given = sized::read(Self::none(), attributes)?;
        Ok(Attributes {
            normals: list("normals", given.normals, n_vertices)?,
            colors: list("colors", given.colors, n_vertices)?,
            uv: list("uv", given.uv, n_faces)?,
            corner_normals: list("corner_normals", given.corner_normals, n_faces)?,
        })
    }
}

/// A mesh from a file, with the attributes that it has.
///
/// Vertices and faces have the file's numbers; polygons are cut into triangles. Corners of an STL file in exactly the same place
/// are one vertex.
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_IO, RICCI_PARSE, RICCI_UNKNOWN_FORMAT, RICCI_DEFECTS (ask
/// ricci_diagnose_file for the list).
///
/// @param path  file name ending in .obj, .off, .ply, .stl, .glb, .gltf or .gii, NUL-terminated.
/// @param mesh  out: the new handle, to be released by ricci_mesh_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_mesh_read(path: *const c_char, mesh: *mut *mut ricci_mesh) -> ricci_status {
    guard::make("mesh", mesh, |_| ricci_mesh::from_soup(io::read(&arrays::path("path", path)?)?))
}

/// A mesh from an STL file whose corners within a distance of each other are one vertex.
///
/// Faces that this collapses are RICCI_DEFECTS; ricci_repair_file welds and drops them.
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_IO, RICCI_PARSE, RICCI_DEFECTS, RICCI_ARGUMENT (the distance).
///
/// @param path  file name, NUL-terminated.
/// @param weld  the distance, not negative; 0 welds corners in exactly the same place.
/// @param mesh  out: the new handle, to be released by ricci_mesh_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_mesh_read_stl(
    path: *const c_char,
    weld: f64,
    mesh: *mut *mut ricci_mesh,
) -> ricci_status {
    guard::make("mesh", mesh, |_| ricci_mesh::from_soup(io::read_stl(&arrays::path("path", path)?, weld)?))
}

/// Fill attributes with none.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE.
///
/// @param attributes  out: no attributes.
/// @param size        sizeof *attributes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_mesh_attributes_init(
    attributes: *mut ricci_mesh_attributes,
    size: usize,
) -> ricci_status {
    guard::call(|_| sized::write(ricci_mesh_attributes::none(), attributes, size))
}

/// Write a mesh in the format that the file's name says, with the attributes that the format has.
///
/// OBJ and OFF are text with 17 significant digits, PLY is binary, and positions read back as they are; GLB has 24 bits of the
/// distance from the centre of the mesh. What the format has no place for (in PLY and OFF, several normals at a vertex; in OFF,
/// several texture coordinates) is left out, with a warning to the callback of ricci_log_set. A file of that name is replaced only once the new one is complete.
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_IO, RICCI_UNKNOWN_FORMAT, RICCI_STRUCT_SIZE, RICCI_ARGUMENT (the mesh is
/// intrinsic, or a number is not finite), RICCI_TOO_LARGE.
///
/// @param mesh        the mesh.
/// @param attributes  what to write beside positions and faces, or NULL for what the mesh was read with.
/// @param path        file name ending in .obj, .off, .ply or .glb, NUL-terminated.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_mesh_write(
    mesh: *const ricci_mesh,
    attributes: *const ricci_mesh_attributes,
    path: *const c_char,
) -> ricci_status {
    guard::with(mesh, |mesh| {
        let path = arrays::path("path", path)?;
        let mut soup = whole(mesh)?;
        if !attributes.is_null() {
            soup.attributes =
                ricci_mesh_attributes::read(attributes, soup.positions.len(), soup.faces.len())?;
        }
        for what in io::write(&path, &soup)? {
            log::warn!("{}: the format has no place for {what}: left out", path.display());
        }
        Ok(())
    })
}

/// Write a mesh as OBJ, with 17 significant digits and the attributes that it was read with, whatever the file's name.
///
/// A file of that name is replaced only once the new one is complete.
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_IO, RICCI_ARGUMENT (the mesh is intrinsic, or a number is not finite).
///
/// @param mesh  the mesh.
/// @param path  file name, NUL-terminated.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_mesh_write_obj(mesh: *const ricci_mesh, path: *const c_char) -> ricci_status {
    guard::with(mesh, |mesh| {
        io::write_as(&arrays::path("path", path)?, Format::Obj, &whole(mesh)?)?;
        Ok(())
    })
}

/// The normals of vertices that the mesh was read with.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (it has none).
///
/// @param mesh      the mesh.
/// @param normals   out: n_vertices x 3, of any length.
/// @param capacity  entries of `normals`, at least 3 n_vertices.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_mesh_normals(
    mesh: *const ricci_mesh,
    normals: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(mesh, |mesh| {
        copy_out("normals", present("normals", &mesh.attributes.normals)?, normals, capacity)
    })
}

/// The colours that the mesh was read with.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (it has none).
///
/// @param mesh      the mesh.
/// @param colors    out: n_vertices x 4: red, green, blue, opacity, from 0 to 1.
/// @param capacity  entries of `colors`, at least 4 n_vertices.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_mesh_colors(
    mesh: *const ricci_mesh,
    colors: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(mesh, |mesh| {
        copy_out("colors", present("colors", &mesh.attributes.colors)?, colors, capacity)
    })
}

/// The texture coordinates that the mesh was read with.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (it has none).
///
/// @param mesh      the mesh.
/// @param uv        out: n_faces x 3 x 2: u, v of every corner, v upwards.
/// @param capacity  entries of `uv`, at least 6 n_faces.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_mesh_uv(
    mesh: *const ricci_mesh,
    uv: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(mesh, |mesh| copy_out("uv", present("uv", &mesh.attributes.uv)?, uv, capacity))
}

/// The normals of corners that the mesh was read with: of one whose vertices have several, as at hard edges.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (it has none).
///
/// @param mesh            the mesh.
/// @param corner_normals  out: n_faces x 3 x 3, of any length.
/// @param capacity        entries of `corner_normals`, at least 9 n_faces.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_mesh_corner_normals(
    mesh: *const ricci_mesh,
    corner_normals: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(mesh, |mesh| {
        copy_out(
            "corner_normals",
            present("corner normals", &mesh.attributes.corner_normals)?,
            corner_normals,
            capacity,
        )
    })
}

/// The attribute, or that there is none.
pub fn present<'a, T>(what: &str, list: &'a Option<Vec<T>>) -> Outcome<&'a [T]> {
    list.as_deref().ok_or_else(|| Failure::argument(format!("this mesh was read without {what}")))
}

/// How a texture goes on outside the unit square.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ricci_wrap {
    /// Periodically.
    RICCI_WRAP_REPEAT = 0,
    /// Periodically, every other time mirrored.
    RICCI_WRAP_MIRROR = 1,
    /// With the colours of its border.
    RICCI_WRAP_CLAMP = 2,
}

choice!(ricci_wrap, "wrap", Wrap, [
    RICCI_WRAP_REPEAT => Repeat,
    RICCI_WRAP_MIRROR => Mirror,
    RICCI_WRAP_CLAMP => Clamp,
]);

/// Write a mesh as binary glTF with a texture, whatever the file's name.
///
/// A vertex with several texture coordinates is written once for each. A file of that name is replaced only once the new one
/// is complete.
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_IO, RICCI_STRUCT_SIZE, RICCI_ARGUMENT (the mesh is intrinsic, a number is not
/// finite, there are no texture coordinates, the texture is no PNG file, wrap is unknown), RICCI_TOO_LARGE.
///
/// @param mesh        the mesh.
/// @param attributes  what to write beside positions and faces, texture coordinates among it, or NULL for what the mesh was
///                    read with.
/// @param png         the texture: a PNG file's png_size bytes.
/// @param png_size    their number.
/// @param wrap        what is outside the unit square.
/// @param path        file name, NUL-terminated.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_mesh_write_textured(
    mesh: *const ricci_mesh,
    attributes: *const ricci_mesh_attributes,
    png: *const u8,
    png_size: usize,
    wrap: MaybeUninit<ricci_wrap>,
    path: *const c_char,
) -> ricci_status {
    guard::with(mesh, |mesh| {
        let path = arrays::path("path", path)?;
        let wrap = choose(wrap)?;
        let png: Vec<u8> = arrays::array("png", png, png_size)?;
        if !png.starts_with(b"\x89PNG\r\n\x1a\n") {
            return Err(Failure::argument("png is no PNG file: its first eight bytes are not that format's"));
        }
        let mut soup = whole(mesh)?;
        if !attributes.is_null() {
            soup.attributes =
                ricci_mesh_attributes::read(attributes, soup.positions.len(), soup.faces.len())?;
        }
        present("uv", &soup.attributes.uv)?;
        io::write_glb_textured(&path, &soup, Texture { png: &png, wrap, repeat: 1.0 })?;
        Ok(())
    })
}

/// The triangle list that the mesh is, with what it was read with.
fn whole(mesh: &ricci_mesh) -> Outcome<Soup> {
    let positions = mesh.positions()?.to_vec();
    let faces = mesh.connectivity.triangles();
    Ok(Soup { positions, faces, attributes: mesh.attributes.clone() })
}
