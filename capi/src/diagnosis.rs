//! What is wrong with a triangle list, also when no mesh can be built from it.

use crate::arrays;
use crate::failure::{Failure, Outcome};
use crate::guard::{self, Poison, handle};
use crate::sized::{self, sized};
use crate::status::ricci_status;
use ricci::mesh::check::{self, Diagnosis};
use ricci::mesh::{Point, io};
use std::ffi::{CString, c_char};

/// Every defect of a triangle list.
pub struct ricci_diagnosis {
    poison: Poison,
    diagnosis: Diagnosis,
    defects: Vec<Record>,
}

/// One defect with its texts as C strings.
struct Record {
    code: CString,
    message: CString,
    remedy: CString,
    vertices: Vec<u32>,
    faces: Vec<u32>,
}

handle!(ricci_diagnosis, "diagnosis");

/// Counts of a triangle list.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_diagnosis_summary {
    /// Bytes of this struct that are filled.
    pub size: usize,
    /// Number of defects.
    pub n_defects: usize,
    /// Vertices given.
    pub n_vertices: usize,
    /// Distinct edges.
    pub n_edges: usize,
    /// Faces given.
    pub n_faces: usize,
    /// Connected pieces.
    pub n_components: usize,
    /// V - E + F over the vertices in use.
    pub euler: i64,
    /// Boundary loops, as connected pieces of the edges with one face (where the surface is no manifold, too).
    pub n_boundary_loops: i64,
    /// Genus; -1 where the surface is not a connected, orientable manifold.
    pub genus: i64,
}

// SAFETY: integers of 8 bytes, size first.
sized!(ricci_diagnosis_summary, "summary");

/// One defect. The pointers are views into the diagnosis and live as long as it does.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_defect {
    /// Bytes of this struct that are filled.
    pub size: usize,
    /// Stable name of the kind of defect, such as "non_manifold_edge".
    pub code: *const c_char,
    /// One sentence with the elements concerned.
    pub message: *const c_char,
    /// What to do about it.
    pub remedy: *const c_char,
    /// The vertices concerned: n_vertices 0-based indices.
    pub vertices: *const u32,
    /// Number of vertices.
    pub n_vertices: usize,
    /// The faces concerned: n_faces 0-based indices.
    pub faces: *const u32,
    /// Number of faces.
    pub n_faces: usize,
}

// SAFETY: pointers and integers of 8 bytes, size first.
sized!(ricci_defect, "defect");

fn diagnose(positions: &[Point], faces: &[[u32; 3]]) -> ricci_diagnosis {
    check::diagnose(positions, faces).into()
}

impl From<Diagnosis> for ricci_diagnosis {
    fn from(diagnosis: Diagnosis) -> Self {
        let text = |words: String| CString::new(words.replace('\0', "\u{fffd}")).unwrap_or_default();
        let defects = diagnosis
            .defects
            .iter()
            .map(|defect| Record {
                code: text(defect.code().to_string()),
                message: text(defect.to_string()),
                remedy: text(defect.remedy().to_string()),
                vertices: defect.vertices(),
                faces: defect.faces(),
            })
            .collect();
        ricci_diagnosis { poison: Poison::default(), diagnosis, defects }
    }
}

/// Every defect of positions and faces; defects are a result, not an error.
///
/// Faces of int32_t may be passed through a cast: a negative index shows as one that is out of range.
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (stride), RICCI_TOO_LARGE.
///
/// @param positions   n_vertices points: x, y, z as double.
/// @param stride      bytes from one point to the next, at least 24; 0 means 24.
/// @param n_vertices  number of points.
/// @param faces       n_faces x 3 vertex indices, 0-based.
/// @param n_faces     number of triangles.
/// @param diagnosis   out: the new handle, to be released by ricci_diagnosis_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_diagnose_arrays(
    positions: *const f64,
    stride: usize,
    n_vertices: usize,
    faces: *const u32,
    n_faces: usize,
    diagnosis: *mut *mut ricci_diagnosis,
) -> ricci_status {
    guard::make("diagnosis", diagnosis, |_| {
        let positions = arrays::points(positions, stride, n_vertices)?;
        Ok(diagnose(&positions, &arrays::faces(faces, n_faces)?))
    })
}

/// Every defect of a mesh file; defects are a result, not an error.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_IO, RICCI_PARSE, RICCI_UNKNOWN_FORMAT.
///
/// @param path       file name ending in .obj, .off, .ply, .stl, .glb, .gltf or .gii, NUL-terminated.
/// @param diagnosis  out: the new handle, to be released by ricci_diagnosis_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_diagnose_file(
    path: *const c_char,
    diagnosis: *mut *mut ricci_diagnosis,
) -> ricci_status {
    guard::make("diagnosis", diagnosis, |_| {
        let soup = io::read(&arrays::path("path", path)?)?;
        Ok(diagnose(&soup.positions, &soup.faces))
    })
}

/// Release a diagnosis.
///
/// @param diagnosis  the handle, or NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_diagnosis_free(diagnosis: *mut ricci_diagnosis) {
    guard::free(diagnosis);
}

/// Counts of the triangle list, and the number of its defects; without any, a mesh can be built.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE.
///
/// @param diagnosis  the diagnosis.
/// @param summary    out: the counts.
/// @param size       sizeof *summary.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_diagnosis_summarise(
    diagnosis: *const ricci_diagnosis,
    summary: *mut ricci_diagnosis_summary,
    size: usize,
) -> ricci_status {
    guard::call(|door| {
        let found = &door.shared(diagnosis)?.diagnosis;
        let counts = ricci_diagnosis_summary {
            size,
            n_defects: found.defects.len(),
            n_vertices: found.vertices,
            n_edges: found.edges,
            n_faces: found.faces,
            n_components: found.components,
            euler: found.euler,
            n_boundary_loops: found.boundary_loops as i64,
            genus: found.genus.map_or(-1, |genus| genus as i64),
        };
        sized::write(counts, summary, size)
    })
}

/// One defect.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (index), RICCI_STRUCT_SIZE.
///
/// @param diagnosis  the diagnosis.
/// @param index      which one, below n_defects.
/// @param defect     out: the defect.
/// @param size       sizeof *defect.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_diagnosis_defect(
    diagnosis: *const ricci_diagnosis,
    index: usize,
    defect: *mut ricci_defect,
    size: usize,
) -> ricci_status {
    guard::call(|door| {
        let record = entry(&door.shared(diagnosis)?.defects, index)?;
        let view = ricci_defect {
            size,
            code: record.code.as_ptr(),
            message: record.message.as_ptr(),
            remedy: record.remedy.as_ptr(),
            vertices: record.vertices.as_ptr(),
            n_vertices: record.vertices.len(),
            faces: record.faces.as_ptr(),
            n_faces: record.faces.len(),
        };
        sized::write(view, defect, size)
    })
}

fn entry(defects: &[Record], index: usize) -> Outcome<&Record> {
    defects
        .get(index)
        .ok_or_else(|| Failure::argument(format!("index is {index}: there are {} defects", defects.len())))
}
