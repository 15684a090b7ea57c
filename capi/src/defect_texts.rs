//! The texts of a defect of a triangle list, or of a hint, as C has them.

use crate::arrays::output_text;
use crate::structs::sized;
use crate::wording::in_functions;
use ricci::mesh::check::{Defect, Hint};
use std::ffi::{CString, c_char};

/// A defect or a hint, with its texts as C strings.
pub(crate) struct DefectTexts {
    code: CString,
    message: CString,
    remedy: CString,
    vertices: Vec<u32>,
    faces: Vec<u32>,
}

impl DefectTexts {
    pub fn of_defect(defect: &Defect) -> DefectTexts {
        let texts = [defect.code().to_string(), defect.to_string(), defect.remedy().to_string()];
        DefectTexts::new(texts, defect.vertices(), defect.faces())
    }

    pub fn of_hint(hint: &Hint) -> DefectTexts {
        DefectTexts::new(
            [hint.code().to_string(), hint.to_string(), hint.remedy()],
            hint.vertices(),
            hint.faces(),
        )
    }

    fn new(texts: [String; 3], vertices: Vec<u32>, faces: Vec<u32>) -> DefectTexts {
        let [code, message, remedy] = texts.map(|words| output_text(&in_functions(&words)));
        DefectTexts { code, message, remedy, vertices, faces }
    }

    pub fn view(&self, size: usize) -> ricci_defect {
        ricci_defect {
            size,
            code: self.code.as_ptr(),
            message: self.message.as_ptr(),
            remedy: self.remedy.as_ptr(),
            vertices: self.vertices.as_ptr(),
            n_vertices: self.vertices.len(),
            faces: self.faces.as_ptr(),
            n_faces: self.faces.len(),
        }
    }
}

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_defect {
    pub size: usize,
    pub code: *const c_char,
    pub message: *const c_char,
    pub remedy: *const c_char,
    pub vertices: *const u32,
    pub n_vertices: usize,
    pub faces: *const u32,
    pub n_faces: usize,
}
// SAFETY: numbers and raw pointers; 8-byte alignment, size first.
sized!(ricci_defect, "defect");
