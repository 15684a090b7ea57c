//! Values and labels on surfaces in GIFTI files: columns with names, and the table of labels.

use crate::arrays::output_text;
use crate::data_file::read;
use crate::failure::{FailureElement, no_such};
use crate::guard::{self, handle, output};
use crate::memory;
use crate::status::ricci_status;
use crate::structs::{self, sized};
use ricci::mesh::io::{GiftiColumn, GiftiLabel, parse_gifti_columns};
use std::ffi::{CString, c_char};

pub struct ricci_gifti_columns {
    columns: Vec<ColumnTexts>,
    table: Vec<LabelTexts>,
}
handle!(ricci_gifti_columns, "columns");

/// A column, with its texts as C strings.
struct ColumnTexts {
    intent: CString,
    name: CString,
    values: Vec<f64>,
}

/// A row of the table of labels, with its name as a C string.
struct LabelTexts {
    name: CString,
    color: [f64; 4],
    key: i32,
}

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_gifti_column {
    pub size: usize,
    pub intent: *const c_char,
    pub name: *const c_char,
    pub values: *const f64,
    pub n: usize,
}
// SAFETY: numbers and raw pointers; 8-byte alignment, size first.
sized!(ricci_gifti_column, "column");

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_gifti_label {
    pub size: usize,
    pub name: *const c_char,
    pub color: [f64; 4],
    pub key: i32,
    pub reserved: u32,
}
// SAFETY: numbers and raw pointers; 8-byte alignment, size first.
sized!(ricci_gifti_label, "label", reserved);

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_gifti_columns_read(
    path: *const c_char,
    columns: *mut *mut ricci_gifti_columns,
) -> ricci_status {
    guard::make(columns, || {
        let (bytes, name) = read(path)?;
        let _reserve = memory::work(bytes.len(), memory::FILE)?;
        let found = parse_gifti_columns(&bytes, &name)?;
        let column = |GiftiColumn { intent, name, values }| ColumnTexts {
            intent: output_text(&intent),
            name: output_text(&name),
            values,
        };
        let row = |GiftiLabel { key, name, color }| LabelTexts { name: output_text(&name), color, key };
        Ok(ricci_gifti_columns {
            columns: found.columns.into_iter().map(column).collect(),
            table: found.table.into_iter().map(row).collect(),
        })
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_gifti_columns_free(columns: *mut ricci_gifti_columns) {
    guard::free(columns);
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_gifti_columns_count(
    columns: *const ricci_gifti_columns,
    n_columns: *mut usize,
    n_labels: *mut usize,
) -> ricci_status {
    guard::with(columns, |of| {
        let count = output("n_columns", n_columns)?;
        output("n_labels", n_labels)?.set(of.table.len());
        count.set(of.columns.len());
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_gifti_columns_get(
    columns: *const ricci_gifti_columns,
    index: usize,
    column: *mut ricci_gifti_column,
    size: usize,
) -> ricci_status {
    guard::with(columns, |of| {
        let missing = || no_such(FailureElement::Entry, "column", index, of.columns.len());
        let ColumnTexts { intent, name, values } = of.columns.get(index).ok_or_else(missing)?;
        let view = ricci_gifti_column {
            size,
            intent: intent.as_ptr(),
            name: name.as_ptr(),
            values: values.as_ptr(),
            n: values.len(),
        };
        structs::write(view, column, size)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_gifti_columns_label(
    columns: *const ricci_gifti_columns,
    index: usize,
    label: *mut ricci_gifti_label,
    size: usize,
) -> ricci_status {
    guard::with(columns, |of| {
        let missing = || no_such(FailureElement::Entry, "label", index, of.table.len());
        let LabelTexts { name, color, key } = of.table.get(index).ok_or_else(missing)?;
        let view = ricci_gifti_label { size, name: name.as_ptr(), color: *color, key: *key, reserved: 0 };
        structs::write(view, label, size)
    })
}
