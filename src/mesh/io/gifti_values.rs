//! Reader of GIFTI's data on surfaces: values at vertices (`.shape.gii`, `.func.gii`) and labels (`.label.gii`) with their table.

use super::budget::Budget;
use super::gifti::{GiftiVisitor, read_gifti};
use super::gifti_data::{ArrayHeader, ArrayText};
use super::gifti_write::GiftiLabel;
use super::scan::Location;
use crate::error::Result;
use quick_xml::events::BytesStart;

/// The intent of arrays of labels.
const LABELS: &str = "LABEL";

/// One number per vertex.
#[derive(Debug, Clone, PartialEq)]
pub struct GiftiColumn {
    /// What the numbers are, without the prefix `NIFTI_INTENT_`: `SHAPE`, `LABEL`, `TIME_SERIES`, `NONE` and others.
    pub intent: String,
    /// The name that the file gives the array; empty where it gives none.
    pub name: String,
    /// The numbers; a NaN in the file stays one.
    pub values: Vec<f64>,
}

/// The data on a surface that a GIFTI file holds.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct GiftiColumns {
    /// The arrays with one number per row, in the order of the file.
    pub columns: Vec<GiftiColumn>,
    /// The table of labels.
    pub table: Vec<GiftiLabel>,
}

impl GiftiColumns {
    /// The values of a file that has one array. `path` is used in errors.
    ///
    /// # Errors
    /// [`crate::Error::Parse`] for another number of arrays.
    pub fn only(mut self, path: &str) -> Result<Vec<f64>> {
        match (self.columns.pop(), self.columns.len()) {
            (Some(column), 0) => Ok(column.values),
            (None, _) => Location::whole(path).error("the file has no array of one value per vertex".into()),
            (Some(_), others) => {
                let n = others + 1;
                Location::whole(path).error(format!(
                    "{n} arrays of one value per vertex; files with one are read here: take one with `parse_gifti_columns`, or keep one in the file"
                ))
            }
        }
    }

    /// The first array of labels: per vertex its row in the table; `None` where the table has no such key.
    pub fn labels(&self) -> Option<Vec<Option<usize>>> {
        let column = self.columns.iter().find(|column| column.intent == LABELS)?;
        let row = |key: &f64| self.table.iter().position(|label| f64::from(label.key) == *key);
        // Tables are short, and neighbours mostly have the same label.
        let mut last: Option<(f64, Option<usize>)> = None;
        let found = column.values.iter().map(|key| match last {
            Some((before, row)) if before == *key => row,
            _ => {
                let found = row(key);
                last = Some((*key, found));
                found
            }
        });
        Some(found.collect())
    }
}

/// Parses the arrays of a GIFTI file that have one number per row, and its table of labels; surfaces and vectors are skipped. Data are
/// encoded as [`super::parse_gifti`] has it. `path` is used in errors.
///
/// ```
/// use ricci::mesh::io::{GiftiNotes, gifti_values, parse_gifti_columns};
/// let bytes = gifti_values(&[("thickness", &[2.5, 3.25])], &GiftiNotes::default())?;
/// let found = parse_gifti_columns(&bytes, "lh.thickness.shape.gii")?;
/// assert_eq!((found.columns[0].name.as_str(), &found.columns[0].values[..]), ("thickness", &[2.5, 3.25][..]));
/// # Ok::<(), ricci::Error>(())
/// ```
///
/// # Errors
/// [`crate::Error::Parse`] with the line.
pub fn parse_gifti_columns(bytes: &[u8], path: &str) -> Result<GiftiColumns> {
    let mut reading = ColumnsReading { budget: Budget::of(bytes), found: GiftiColumns::default() };
    read_gifti(bytes, path, &mut reading)?;
    Ok(reading.found)
}

/// True if bytes begin as an XML file does.
pub(super) fn is_xml(bytes: &[u8]) -> bool {
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    text.starts_with(b"<?xml") || text.starts_with(b"<GIFTI")
}

struct ColumnsReading {
    budget: Budget,
    found: GiftiColumns,
}

impl GiftiVisitor for ColumnsReading {
    fn array(&mut self, header: &ArrayHeader, data: &ArrayText<'_>) -> Result<()> {
        if header.is_column() {
            let values = header.column(&ArrayText { what: "values", ..*data }, &mut self.budget)?;
            let intent = header.intent.trim_start_matches("NIFTI_INTENT_").to_string();
            self.budget.take(1, size_of::<GiftiColumn>() + header.name.len(), "arrays", data.place)?;
            self.found.columns.push(GiftiColumn { intent, name: header.name.clone(), values });
        }
        Ok(())
    }

    fn label(&mut self, tag: &BytesStart<'_>, name: &str, place: Location<'_>) -> Result<()> {
        let mut key = None;
        let mut color = [0.0, 0.0, 0.0, 1.0];
        for attribute in tag.attributes().with_checks(false) {
            let attribute = match attribute {
                Ok(attribute) => attribute,
                Err(e) => return place.error(format!("Label: {e}")),
            };
            let (word, value) = (attribute.key.0, attribute.value.trim());
            match word {
                // Older files say Index.
                "Key" | "Index" => match value.parse() {
                    Ok(number) => key = Some(number),
                    Err(_) => return place.error(format!("{word}=\"{value}\" is not a whole number")),
                },
                "Red" | "Green" | "Blue" | "Alpha" => match value.parse::<f64>() {
                    Ok(part) if (0.0..=1.0).contains(&part) => {
                        color["RGBA".find(&word[..1]).unwrap_or(3)] = part;
                    }
                    _ => return place.error(format!("{word}=\"{value}\" is not from 0 to 1")),
                },
                _ => {}
            }
        }
        let Some(key) = key else { return place.error("a Label without Key".into()) };
        self.budget.take(1, size_of::<GiftiLabel>() + name.len(), "labels", place)?;
        self.found.table.push(GiftiLabel { key, name: name.into(), color });
        Ok(())
    }
}
