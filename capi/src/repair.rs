//! Repair of triangle lists, with the way back.

use crate::arrays::{self, copy_out, copy_rows};
use crate::diagnosis::ricci_diagnosis;
use crate::failure::{Failure, Outcome};
use crate::guard::{self, Poison, handle};
use crate::mesh_file::present;
use crate::sized::{self, sized};
use crate::status::ricci_status;
use ricci::mesh::io::{self, Soup};
use ricci::mesh::repair::{Repair, Repaired, repair};
use std::ffi::c_char;

/// A repaired triangle list, with the way back to what was given.
pub struct ricci_repair {
    poison: Poison,
    done: Repaired,
}

handle!(ricci_repair, "repair");

/// What a repair may do beyond what is always done: dropping faces that use a vertex twice or repeat a face, giving each fan of
/// faces a vertex of its own, turning faces until neighbours agree, dropping isolated vertices. Let
/// ricci_repair_options_init fill it, then change fields.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_repair_options {
    /// Bytes of this struct that are filled.
    pub size: usize,
    /// Vertices within this distance become one; 0 (default): those in exactly the same place, where their faces
    /// are then connected through edges, but not in edges in which more than two faces would meet
    /// (ricci_repair_refused); negative: no welding.
    pub weld: f64,
    /// 1 cuts the surface open along edges in which more than two faces meet; default 0.
    pub cut_non_manifold_edges: i32,
    /// 0.
    pub reserved: i32,
    /// Keep one connected piece: 0 is that with the most faces, and so on; negative (default): all.
    pub component: i64,
}

// SAFETY: numbers; 8-byte alignment, size first.
sized!(ricci_repair_options, "options");

impl ricci_repair_options {
    fn standard() -> Self {
        let size = size_of::<Self>();
        ricci_repair_options { size, weld: 0.0, cut_non_manifold_edges: 0, reserved: 0, component: -1 }
    }

    fn read(options: *const ricci_repair_options) -> Outcome<Repair> {
        let given = sized::read(Self::standard(), options)?;
        let cut_non_manifold_edges = match given.cut_non_manifold_edges {
            0 => false,
            1 => true,
            other => return Err(Failure::argument(format!("cut_non_manifold_edges is {other}: 0 or 1"))),
        };
        // NaN is no tolerance, which the library says.
        let weld = (given.weld.is_nan() || given.weld >= 0.0).then_some(given.weld);
        Ok(Repair { weld, cut_non_manifold_edges, component: usize::try_from(given.component).ok() })
    }
}

/// What a repair did, and the size of its result.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_repair_summary {
    /// Bytes of this struct that are filled.
    pub size: usize,
    /// Vertices of the result.
    pub n_vertices: usize,
    /// Faces of the result.
    pub n_faces: usize,
    /// Defects that are left: ricci_repair_diagnosis lists them.
    pub n_defects: usize,
    /// Vertices that became one with an earlier vertex.
    pub welded_vertices: usize,
    /// Faces dropped because they used a vertex twice.
    pub degenerate_faces: usize,
    /// Faces dropped because an earlier face had their vertices.
    pub duplicate_faces: usize,
    /// Edges along which the surface was cut open.
    pub cut_edges: usize,
    /// Vertices made for further fans of faces.
    pub split_vertices: usize,
    /// Faces turned around.
    pub turned_faces: usize,
    /// Faces of other components than the one that was asked for.
    pub faces_of_other_components: usize,
    /// Vertices dropped because no face uses them.
    pub isolated_vertices: usize,
    /// Edges in which welding would have made more than two faces meet: ricci_repair_refused lists them.
    pub refused_edges: usize,
    /// Faces of all these edges together.
    pub refused_faces: usize,
}

// SAFETY: integers of 8 bytes, size first.
sized!(ricci_repair_summary, "summary");

fn mended(soup: &Soup, options: *const ricci_repair_options) -> Outcome<ricci_repair> {
    let done = repair(soup, &ricci_repair_options::read(options)?)?;
    Ok(ricci_repair { poison: Poison::default(), done })
}

/// Fill options with their defaults.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE.
///
/// @param options  out: the defaults.
/// @param size     sizeof *options.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_repair_options_init(
    options: *mut ricci_repair_options,
    size: usize,
) -> ricci_status {
    guard::call(|_| sized::write(ricci_repair_options::standard(), options, size))
}

/// Mend what can be mended without a guess. Defects that are left are a result, not an error.
///
/// Elements keep their order. Attributes of arrays are the caller's: the origins say where each element came from.
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (stride, options, no such component), RICCI_TOO_LARGE,
/// RICCI_STRUCT_SIZE, RICCI_DEFECTS (a face that names no vertex or one without finite coordinates).
///
/// @param positions   n_vertices points: x, y, z as double.
/// @param stride      bytes from one point to the next, at least 24; 0 means 24.
/// @param n_vertices  number of points.
/// @param faces       n_faces x 3 vertex indices, 0-based.
/// @param n_faces     number of triangles.
/// @param options     what may be done, or NULL for the defaults.
/// @param repair      out: the new handle, to be released by ricci_repair_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_repair_arrays(
    positions: *const f64,
    stride: usize,
    n_vertices: usize,
    faces: *const u32,
    n_faces: usize,
    options: *const ricci_repair_options,
    repair: *mut *mut ricci_repair,
) -> ricci_status {
    guard::make("repair", repair, |_| {
        let soup = Soup::new(arrays::points(positions, stride, n_vertices)?, arrays::faces(faces, n_faces)?);
        mended(&soup, options)
    })
}

/// ricci_repair_arrays for a mesh file, whose attributes stay with their elements.
///
/// @return as ricci_repair_arrays; RICCI_IO, RICCI_PARSE, RICCI_UNKNOWN_FORMAT.
///
/// @param path     file name ending in .obj, .off, .ply, .stl, .glb, .gltf or .gii, NUL-terminated.
/// @param options  what may be done, or NULL for the defaults.
/// @param repair   out: the new handle, to be released by ricci_repair_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_repair_file(
    path: *const c_char,
    options: *const ricci_repair_options,
    repair: *mut *mut ricci_repair,
) -> ricci_status {
    guard::make("repair", repair, |_| {
        let soup = io::read(&arrays::path("path", path)?)?;
        mended(&soup, options)
    })
}

/// Release a repair.
///
/// @param repair  the handle, or NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_repair_free(repair: *mut ricci_repair) {
    guard::free(repair);
}

/// What was done, and the size of the result.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE.
///
/// @param repair   the repair.
/// @param summary  out: the figures.
/// @param size     sizeof *summary.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_repair_summarise(
    repair: *const ricci_repair,
    summary: *mut ricci_repair_summary,
    size: usize,
) -> ricci_status {
    guard::call(|door| {
        let Repaired { soup, steps, diagnosis, weld_refused, .. } = &door.shared(repair)?.done;
        let figures = ricci_repair_summary {
            size,
            n_vertices: soup.positions.len(),
            n_faces: soup.faces.len(),
            n_defects: diagnosis.defects.len(),
            welded_vertices: steps.welded_vertices,
            degenerate_faces: steps.degenerate_faces,
            duplicate_faces: steps.duplicate_faces,
            cut_edges: steps.cut_edges,
            split_vertices: steps.split_vertices,
            turned_faces: steps.turned_faces,
            faces_of_other_components: steps.faces_of_other_components,
            isolated_vertices: steps.isolated_vertices,
            refused_edges: weld_refused.len(),
            refused_faces: weld_refused.iter().map(|refused| refused.faces.len()).sum(),
        };
        sized::write(figures, summary, size)
    })
}

/// Positions and faces of the result.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param repair              the repair.
/// @param positions           out: n_vertices x 3 coordinates.
/// @param positions_capacity  entries of `positions`.
/// @param faces               out: n_faces x 3 vertex indices, 0-based.
/// @param faces_capacity      entries of `faces`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_repair_result(
    repair: *const ricci_repair,
    positions: *mut f64,
    positions_capacity: usize,
    faces: *mut u32,
    faces_capacity: usize,
) -> ricci_status {
    guard::call(|door| {
        let soup = &door.shared(repair)?.done.soup;
        arrays::check_buffer("faces", 3 * soup.faces.len(), faces, faces_capacity)?;
        copy_out("positions", &soup.positions, positions, positions_capacity)?;
        copy_out("faces", &soup.faces, faces, faces_capacity)
    })
}

/// Where the elements of the result came from.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param repair             the repair.
/// @param vertices           out: n_vertices input vertices.
/// @param vertices_capacity  entries of `vertices`.
/// @param faces              out: n_faces input faces.
/// @param faces_capacity     entries of `faces`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_repair_origins(
    repair: *const ricci_repair,
    vertices: *mut u32,
    vertices_capacity: usize,
    faces: *mut u32,
    faces_capacity: usize,
) -> ricci_status {
    guard::call(|door| {
        let done = &door.shared(repair)?.done;
        arrays::check_buffer("faces", done.face_origin.len(), faces, faces_capacity)?;
        copy_out("vertices", &done.vertex_origin, vertices, vertices_capacity)?;
        copy_out("faces", &done.face_origin, faces, faces_capacity)
    })
}

/// The edges that kept vertices in exactly the same place from being welded throughout.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param repair             the repair.
/// @param vertices           out: refused_edges x 2 input vertices: the first in the place of either end.
/// @param vertices_capacity  entries of `vertices`.
/// @param faces              out: the refused_faces input faces that would meet, edge by edge.
/// @param faces_capacity     entries of `faces`.
/// @param starts             out: refused_edges + 1 entries: where each edge's faces start in `faces`, and their end.
/// @param starts_capacity    entries of `starts`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_repair_refused(
    repair: *const ricci_repair,
    vertices: *mut u32,
    vertices_capacity: usize,
    faces: *mut u32,
    faces_capacity: usize,
    starts: *mut usize,
    starts_capacity: usize,
) -> ricci_status {
    guard::call(|door| {
        let refused = &door.shared(repair)?.done.weld_refused;
        let ends: Vec<u32> = refused.iter().flat_map(|edge| edge.vertices).collect();
        arrays::check_buffer("vertices", ends.len(), vertices, vertices_capacity)?;
        let rows = refused.iter().map(|edge| edge.faces.iter().copied());
        copy_rows("faces", rows, (faces, faces_capacity), (starts, starts_capacity))?;
        copy_out("vertices", &ends, vertices, vertices_capacity)
    })
}

/// The normals of the result, for a file that has them.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (there are none).
///
/// @param repair    the repair.
/// @param normals   out: n_vertices x 3, of any length.
/// @param capacity  entries of `normals`, at least 3 n_vertices.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_repair_normals(
    repair: *const ricci_repair,
    normals: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(repair, |repair| {
        copy_out("normals", present("normals", &repair.done.soup.attributes.normals)?, normals, capacity)
    })
}

/// The colours of the result, for a file that has them.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (there are none).
///
/// @param repair    the repair.
/// @param colors    out: n_vertices x 4: red, green, blue, opacity, from 0 to 1.
/// @param capacity  entries of `colors`, at least 4 n_vertices.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_repair_colors(
    repair: *const ricci_repair,
    colors: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(repair, |repair| {
        copy_out("colors", present("colors", &repair.done.soup.attributes.colors)?, colors, capacity)
    })
}

/// The texture coordinates of the result, for a file that has them.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (there are none).
///
/// @param repair    the repair.
/// @param uv        out: n_faces x 3 x 2: u, v of every corner, v upwards.
/// @param capacity  entries of `uv`, at least 6 n_faces.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_repair_uv(
    repair: *const ricci_repair,
    uv: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(repair, |repair| {
        copy_out("uv", present("uv", &repair.done.soup.attributes.uv)?, uv, capacity)
    })
}

/// The normals of corners of the result, for a file that has them: at hard edges.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (there are none).
///
/// @param repair          the repair.
/// @param corner_normals  out: n_faces x 3 x 3, of any length.
/// @param capacity        entries of `corner_normals`, at least 9 n_faces.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_repair_corner_normals(
    repair: *const ricci_repair,
    corner_normals: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(repair, |repair| {
        copy_out(
            "corner_normals",
            present("corner normals", &repair.done.soup.attributes.corner_normals)?,
            corner_normals,
            capacity,
        )
    })
}

/// Write the result, whatever defects are left, in the format that the file's name says, with its attributes; what the format
/// has no place for is left out, with a warning to the callback of ricci_log_set.
///
/// A file of that name is replaced only once the new one is complete.
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_IO, RICCI_UNKNOWN_FORMAT, RICCI_ARGUMENT (an attribute is not finite),
/// RICCI_TOO_LARGE.
///
/// @param repair  the repair.
/// @param path    file name ending in .obj, .off, .ply or .glb, NUL-terminated.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_repair_write(
    repair: *const ricci_repair,
    path: *const c_char,
) -> ricci_status {
    guard::call(|door| {
        let soup = &door.shared(repair)?.done.soup;
        let path = arrays::path("path", path)?;
        for what in io::write(&path, soup)? {
            log::warn!("{}: the format has no place for {what}: left out", path.display());
        }
        Ok(())
    })
}

/// The defects that are left.
///
/// @return RICCI_OK, RICCI_NULL_POINTER.
///
/// @param repair     the repair.
/// @param diagnosis  out: the new handle, to be released by ricci_diagnosis_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_repair_diagnosis(
    repair: *const ricci_repair,
    diagnosis: *mut *mut ricci_diagnosis,
) -> ricci_status {
    guard::make("diagnosis", diagnosis, |door| {
        Ok(ricci_diagnosis::from(door.shared(repair)?.done.diagnosis.clone()))
    })
}
