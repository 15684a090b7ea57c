//! What is wrong with a triangle list, also when no mesh can be built from it.

use crate::arrays;
use crate::failure::{Failure, Outcome};
use crate::guard::{self, Handle, Poison, output};
use crate::sized::{self, Sized64};
use crate::status::ricci_status;
use ricci::mesh::{Point, check, io};
use std::ffi::{CString, c_char};

/// Every defect of a triangle list.
pub struct ricci_diagnosis {
    poison: Poison,
    defects: Vec<Record>,
}

/// One defect with its texts as C strings.
struct Record {
    code: CString,
    message: CString,
    remedy: CString,
    elements: Vec<u32>,
}

impl Handle for ricci_diagnosis {
    const NAME: &'static str = "diagnosis";
    fn poison(&self) -> &Poison {
        &self.poison
    }
}

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
    /// The elements concerned: n_elements 0-based indices; the message says of what.
    pub elements: *const u32,
    /// Number of elements.
    pub n_elements: usize,
}

// SAFETY: pointers and integers of 8 bytes, size first.
unsafe impl Sized64 for ricci_defect {
    const NAME: &'static str = "defect";
    fn with_size(self, size: usize) -> Self {
        Self { size, ..self }
    }
}

fn diagnose(positions: &[Point], faces: &[[u32; 3]]) -> ricci_diagnosis {
    let text = |words: String| CString::new(words.replace('\0', "\u{fffd}")).unwrap_or_default();
    let defects = check::diagnose(positions, faces)
        .defects
        .iter()
        .map(|defect| Record {
            code: text(defect.code().to_string()),
            message: text(defect.to_string()),
            remedy: text(defect.remedy().to_string()),
            elements: defect.elements(),
        })
        .collect();
    ricci_diagnosis { poison: Poison::default(), defects }
}

/// Every defect of positions and faces; defects are a result, not an error.
///
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
    guard::call(|_| {
        let diagnosis = output("diagnosis", diagnosis)?;
        let positions = arrays::points(positions, stride, n_vertices)?;
        diagnosis.hand_over(diagnose(&positions, &arrays::faces(faces, n_faces)?));
        Ok(())
    })
}

/// Every defect of a mesh file; defects are a result, not an error.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_IO, RICCI_PARSE, RICCI_UNKNOWN_FORMAT.
///
/// @param path       file name ending in .obj or .off, NUL-terminated.
/// @param diagnosis  out: the new handle, to be released by ricci_diagnosis_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_diagnose_file(
    path: *const c_char,
    diagnosis: *mut *mut ricci_diagnosis,
) -> ricci_status {
    guard::call(|_| {
        let diagnosis = output("diagnosis", diagnosis)?;
        let soup = io::read(&arrays::path("path", path)?)?;
        diagnosis.hand_over(diagnose(&soup.positions, &soup.faces));
        Ok(())
    })
}

/// Release a diagnosis.
///
/// @param diagnosis  the handle, or NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_diagnosis_free(diagnosis: *mut ricci_diagnosis) {
    guard::free(diagnosis);
}

/// Number of defects; 0: a mesh can be built.
///
/// @return RICCI_OK, RICCI_NULL_POINTER.
///
/// @param diagnosis  the diagnosis.
/// @param count      out: number of defects.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_diagnosis_count(
    diagnosis: *const ricci_diagnosis,
    count: *mut usize,
) -> ricci_status {
    guard::call(|door| {
        let count = output("count", count)?;
        count.set(door.shared(diagnosis)?.defects.len());
        Ok(())
    })
}

/// One defect.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (index), RICCI_STRUCT_SIZE.
///
/// @param diagnosis  the diagnosis.
/// @param index      which one, below the count.
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
            elements: record.elements.as_ptr(),
            n_elements: record.elements.len(),
        };
        sized::write(view, defect, size)
    })
}

fn entry(defects: &[Record], index: usize) -> Outcome<&Record> {
    defects
        .get(index)
        .ok_or_else(|| Failure::argument(format!("index is {index}: there are {} defects", defects.len())))
}
