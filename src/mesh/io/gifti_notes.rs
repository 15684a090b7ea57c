//! What a GIFTI file says beside its numbers: metadata, and the spaces that coordinates are in.

use super::budget::Budget;
use super::gifti::{GiftiVisitor, read_gifti};
use super::gifti_data::{ArrayHeader, ArrayText};
use super::scan::{Location, Quoted};
use crate::error::Result;
use std::collections::BTreeSet;

/// What a GIFTI file says beside its numbers.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct GiftiNotes {
    /// Names and values, such as `AnatomicalStructurePrimary` and `CortexLeft`. They are written of the file and, unless it has a name, of its
    /// first array, and read from both; the name of an array is no such note.
    pub metadata: Vec<(String, String)>,
    /// The ways from the coordinates of a surface to those of other spaces; where there is none, the identity is written.
    pub transforms: Vec<GiftiTransform>,
}

/// The way from coordinates to those of another space, as `CoordinateSystemTransformMatrix` has it.
#[derive(Debug, Clone, PartialEq)]
pub struct GiftiTransform {
    /// The name of the space of the coordinates, such as `NIFTI_XFORM_SCANNER_ANAT`.
    pub from: String,
    /// The name of the other space.
    pub to: String,
    /// Rows of the matrix that acts on (x, y, z, 1).
    pub matrix: [[f64; 4]; 4],
}

impl Default for GiftiTransform {
    /// The identity of a space that is not known.
    fn default() -> GiftiTransform {
        let unknown = || "NIFTI_XFORM_UNKNOWN".to_string();
        let matrix = [0, 1, 2, 3].map(|i| [0, 1, 2, 3].map(|j| f64::from(u8::from(i == j))));
        GiftiTransform { from: unknown(), to: unknown(), matrix }
    }
}

/// Reads the notes of a GIFTI file; data are passed over. `path` is used in errors.
///
/// ```
/// use ricci::mesh::io::{GiftiNotes, gifti_values, parse_gifti_notes};
/// let metadata = vec![("AnatomicalStructurePrimary".to_string(), "CortexLeft".to_string())];
/// let notes = GiftiNotes { metadata, ..GiftiNotes::default() };
/// let bytes = gifti_values(&[("thickness", &[2.5, 3.25])], &notes)?;
/// assert_eq!(parse_gifti_notes(&bytes, "lh.thickness.shape.gii")?, notes);
/// # Ok::<(), ricci::Error>(())
/// ```
///
/// # Errors
/// [`crate::Error::Parse`] with the line, also for a matrix that is not 16 finite numbers.
pub fn parse_gifti_notes(bytes: &[u8], path: &str) -> Result<GiftiNotes> {
    let mut reading = NotesReading {
        budget: Budget::of(bytes),
        found: GiftiNotes::default(),
        known: BTreeSet::new(),
        open: GiftiTransform::default(),
        arrays: 0,
    };
    read_gifti(bytes, path, &mut reading)?;
    Ok(reading.found)
}

struct NotesReading {
    budget: Budget,
    found: GiftiNotes,
    /// The notes that have been found.
    known: BTreeSet<[String; 2]>,
    /// The transform of which a part has been read.
    open: GiftiTransform,
    /// The arrays whose data have been passed over.
    arrays: usize,
}

impl GiftiVisitor for NotesReading {
    fn array(&mut self, _header: &ArrayHeader, _data: &ArrayText<'_>) -> Result<()> {
        self.arrays += 1;
        Ok(())
    }

    fn note(&mut self, within: Option<&ArrayHeader>, note: [&str; 2], place: Location<'_>) -> Result<()> {
        let [name, value] = note;
        let is_of_all = match within {
            Some(_) => self.arrays == 0 && name != "Name",
            None => true,
        };
        if is_of_all {
            // They are kept twice.
            self.budget.take(2, size_of::<[String; 2]>() + name.len() + value.len(), "notes", place)?;
            let note = note.map(str::to_string);
            if self.known.insert(note.clone()) {
                self.found.metadata.push(note.into());
            }
        }
        Ok(())
    }

    fn transform(&mut self, element: &str, text: &str, place: Location<'_>) -> Result<()> {
        match element {
            "DataSpace" => self.open.from = text.into(),
            "TransformedSpace" => self.open.to = text.into(),
            _ => {
                self.open.matrix = matrix(text, place)?;
                let done = std::mem::take(&mut self.open);
                let bytes = size_of::<GiftiTransform>() + done.from.len() + done.to.len();
                self.budget.take(1, bytes, "transforms", place)?;
                self.found.transforms.push(done);
            }
        }
        Ok(())
    }
}

/// The matrix in a text of 16 numbers, row after row.
fn matrix(text: &str, place: Location<'_>) -> Result<[[f64; 4]; 4]> {
    let mut matrix = [[0.0; 4]; 4];
    let mut words = text.split_ascii_whitespace();
    for entry in matrix.as_flattened_mut() {
        let Some(word) = words.next() else {
            return place.error("MatrixData has fewer than 16 numbers".into());
        };
        *entry = match word.parse::<f64>() {
            Ok(number) if number.is_finite() => number,
            _ => return place.error(format!("MatrixData: {} is no finite number", Quoted(word))),
        };
    }
    match words.next() {
        None => Ok(matrix),
        Some(_) => place.error("MatrixData has more than 16 numbers".into()),
    }
}
