//! Notes of GIFTI files: metadata, and the spaces that coordinates are in; and the files themselves, with notes.

use crate::arrays::{self, array, output_text, text};
use crate::data_file::{read, write};
use crate::failure::{Failure, FailureElement, Outcome, no_such};
use crate::guard::{self, MutableHandle, handle, output, shared};
use crate::memory;
use crate::status::{RICCI_TOO_LARGE, ricci_status};
use crate::structs::{self, sized};
use ricci::mesh::io::{
    GiftiLabel, GiftiNotes, GiftiTransform, Soup, gifti_labels, gifti_surface, gifti_values,
    parse_gifti_notes,
};
use std::ffi::{CString, c_char};

/// Bytes of notes for which a call takes as much memory as for an element of another handle.
const NOTE_BYTES: usize = 128;

/// Most bytes per vertex, face or value while a file is put together: 4 bytes for each number, the same compressed, and in base64.
const WRITTEN: usize = 1 << 7;

pub struct ricci_gifti_notes {
    poisoned: bool,
    metadata: Vec<[CString; 2]>,
    transforms: Vec<TransformTexts>,
}
handle!(ricci_gifti_notes, "notes", |notes| notes.bytes() / NOTE_BYTES);

/// A transform, with the names of its spaces as C strings.
struct TransformTexts {
    from: CString,
    to: CString,
    matrix: [f64; 16],
}

impl MutableHandle for ricci_gifti_notes {
    fn poisoned(&mut self) -> &mut bool {
        &mut self.poisoned
    }
}

impl From<GiftiNotes> for ricci_gifti_notes {
    fn from(found: GiftiNotes) -> ricci_gifti_notes {
        let metadata = found.metadata.iter().map(|(name, value)| [output_text(name), output_text(value)]);
        let transform = |way: &GiftiTransform| TransformTexts {
            from: output_text(&way.from),
            to: output_text(&way.to),
            matrix: std::array::from_fn(|k| way.matrix[k / 4][k % 4]),
        };
        ricci_gifti_notes {
            poisoned: false,
            metadata: metadata.collect(),
            transforms: found.transforms.iter().map(transform).collect(),
        }
    }
}

impl ricci_gifti_notes {
    /// The bytes of its texts and numbers.
    fn bytes(&self) -> usize {
        let texts = self.metadata.iter().flatten().map(|text| text.count_bytes()).sum::<usize>();
        texts + size_of::<TransformTexts>() * self.transforms.len()
    }

    /// The notes as the library has them.
    fn notes(&self) -> GiftiNotes {
        let words = |text: &CString| text.to_string_lossy().into_owned();
        let transform = |way: &TransformTexts| GiftiTransform {
            from: words(&way.from),
            to: words(&way.to),
            matrix: std::array::from_fn(|i| std::array::from_fn(|j| way.matrix[4 * i + j])),
        };
        GiftiNotes {
            metadata: self.metadata.iter().map(|[name, value]| (words(name), words(value))).collect(),
            transforms: self.transforms.iter().map(transform).collect(),
        }
    }
}

/// The notes of a handle; NULL stands for none.
fn given(notes: *const ricci_gifti_notes) -> Outcome<GiftiNotes> {
    if notes.is_null() { Ok(GiftiNotes::default()) } else { Ok(shared(notes)?.notes()) }
}

/// A copy of a caller's text, with memory for it.
fn kept(what: &str, given: *const c_char) -> Outcome<CString> {
    let words = text(what, given)?;
    memory::for_call(words.len() / NOTE_BYTES)?;
    Ok(output_text(words))
}

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_gifti_note {
    pub size: usize,
    pub name: *const c_char,
    pub value: *const c_char,
}
// SAFETY: numbers and raw pointers; 8-byte alignment, size first.
sized!(ricci_gifti_note, "note");

#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_gifti_transform {
    pub size: usize,
    pub from: *const c_char,
    pub to: *const c_char,
    pub matrix: [f64; 16],
}
// SAFETY: numbers and raw pointers; 8-byte alignment, size first.
sized!(ricci_gifti_transform, "transform");

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_gifti_notes_new(notes: *mut *mut ricci_gifti_notes) -> ricci_status {
    guard::make(notes, || Ok(GiftiNotes::default().into()))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_gifti_notes_read(
    path: *const c_char,
    notes: *mut *mut ricci_gifti_notes,
) -> ricci_status {
    guard::make(notes, || {
        let (bytes, name) = read(path)?;
        let _reserve = memory::work(bytes.len(), memory::FILE)?;
        Ok(parse_gifti_notes(&bytes, &name)?.into())
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_gifti_notes_free(notes: *mut ricci_gifti_notes) {
    guard::free(notes);
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_gifti_notes_add(
    notes: *mut ricci_gifti_notes,
    name: *const c_char,
    value: *const c_char,
) -> ricci_status {
    guard::call(|| {
        let note = [kept("name", name)?, kept("value", value)?];
        guard::change(notes, |notes| {
            memory::for_call(notes.metadata.len())?;
            notes.metadata.push(note);
            Ok(())
        })
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_gifti_notes_add_transform(
    notes: *mut ricci_gifti_notes,
    from: *const c_char,
    to: *const c_char,
    matrix: *const f64,
) -> ricci_status {
    guard::call(|| {
        let (from, to) = (kept("from", from)?, kept("to", to)?);
        let numbers: Vec<f64> = array("matrix", matrix, 16)?;
        if let Some(k) = numbers.iter().position(|x| !x.is_finite()) {
            let why = format!("matrix: entry {k} is {}, a finite number is needed", numbers[k]);
            return Err(Failure::argument(why).at(FailureElement::Entry, k));
        }
        let matrix = std::array::from_fn(|k| numbers[k]);
        guard::change(notes, |notes| {
            memory::for_call(notes.transforms.len())?;
            notes.transforms.push(TransformTexts { from, to, matrix });
            Ok(())
        })
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_gifti_notes_count(
    notes: *const ricci_gifti_notes,
    n_metadata: *mut usize,
    n_transforms: *mut usize,
) -> ricci_status {
    guard::with(notes, |notes| {
        let metadata = output("n_metadata", n_metadata)?;
        output("n_transforms", n_transforms)?.set(notes.transforms.len());
        metadata.set(notes.metadata.len());
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_gifti_notes_get(
    notes: *const ricci_gifti_notes,
    index: usize,
    note: *mut ricci_gifti_note,
    size: usize,
) -> ricci_status {
    guard::with(notes, |notes| {
        let missing = || no_such(FailureElement::Entry, "note", index, notes.metadata.len());
        let [name, value] = notes.metadata.get(index).ok_or_else(missing)?;
        let view = ricci_gifti_note { size, name: name.as_ptr(), value: value.as_ptr() };
        structs::write(view, note, size)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_gifti_notes_transform(
    notes: *const ricci_gifti_notes,
    index: usize,
    transform: *mut ricci_gifti_transform,
    size: usize,
) -> ricci_status {
    guard::with(notes, |notes| {
        let missing = || no_such(FailureElement::Entry, "transform", index, notes.transforms.len());
        let TransformTexts { from, to, matrix } = notes.transforms.get(index).ok_or_else(missing)?;
        let view = ricci_gifti_transform { size, from: from.as_ptr(), to: to.as_ptr(), matrix: *matrix };
        structs::write(view, transform, size)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_gifti_surface_write(
    path: *const c_char,
    positions: *const f64,
    n_vertices: usize,
    faces: *const u32,
    n_faces: usize,
    notes: *const ricci_gifti_notes,
) -> ricci_status {
    guard::call(|| {
        let path = arrays::path(path)?;
        let positions = arrays::points(positions, 0, n_vertices)?;
        let soup = Soup::new(positions, arrays::faces(faces, n_faces)?);
        let notes = given(notes)?;
        let _reserve = memory::work(n_vertices.saturating_add(n_faces), WRITTEN)?;
        write(&path, gifti_surface(&soup, &notes)?)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_gifti_values_write(
    path: *const c_char,
    names: *const c_char,
    values: *const f64,
    n: usize,
    n_columns: usize,
    notes: *const ricci_gifti_notes,
) -> ricci_status {
    guard::call(|| {
        let path = arrays::path(path)?;
        let names = lines("names", names, n_columns)?;
        let Some(entries) = n.checked_mul(n_columns) else {
            return Err(Failure::new(RICCI_TOO_LARGE, format!("values: {n_columns} columns of {n} entries")));
        };
        let values: Vec<f64> = array("values", values, entries)?;
        let notes = given(notes)?;
        let _reserve = memory::work(entries, WRITTEN)?;
        let column = |(k, name)| (name, &values[k * n..(k + 1) * n]);
        let columns: Vec<(&str, &[f64])> = names.into_iter().enumerate().map(column).collect();
        write(&path, gifti_values(&columns, &notes)?)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_gifti_labels_write(
    path: *const c_char,
    labels: *const i32,
    n: usize,
    keys: *const i32,
    names: *const c_char,
    colors: *const f64,
    n_rows: usize,
    notes: *const ricci_gifti_notes,
) -> ricci_status {
    guard::call(|| {
        let path = arrays::path(path)?;
        let labels: Vec<i32> = array("labels", labels, n)?;
        let keys: Vec<i32> = array("keys", keys, n_rows)?;
        let colors: Vec<[f64; 4]> = array("colors", colors.cast(), n_rows)?;
        let names = lines("names", names, n_rows)?;
        let rows = keys.iter().zip(names).zip(&colors);
        let row = |((&key, name), &color): ((_, &str), _)| GiftiLabel { key, name: name.into(), color };
        let table: Vec<GiftiLabel> = rows.map(row).collect();
        let notes = given(notes)?;
        let _reserve = memory::work(n.saturating_add(n_rows), WRITTEN)?;
        write(&path, gifti_labels(&labels, &table, &notes)?)
    })
}

/// The lines of a text, of which there must be so many.
fn lines<'a>(what: &str, names: *const c_char, wanted: usize) -> Outcome<Vec<&'a str>> {
    let lines: Vec<&str> = text(what, names)?.lines().collect();
    if lines.len() != wanted {
        return Err(Failure::argument(format!("{what} has {} lines for {wanted}", lines.len())));
    }
    Ok(lines)
}
