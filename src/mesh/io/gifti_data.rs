//! The arrays of a GIFTI file: their attributes, and the numbers of their text.

use super::base64;
use super::budget::Budget;
use super::kind::NumberType;
use super::scan::{Location, Quoted};
use crate::error::{FilePosition, Result};
use flate2::read::{GzDecoder, ZlibDecoder};
use quick_xml::events::BytesStart;
use std::io::Read;

/// Most bytes that deflate makes of one byte, by the definition of its format.
const MOST_INFLATION: usize = 1032;

/// The text of an array, a description of the array, and the position at which the text begins.
pub(super) struct ArrayText<'a> {
    pub what: &'static str,
    pub text: &'a str,
    pub place: Location<'a>,
}

impl ArrayText<'_> {
    fn error<T>(&self, message: impl std::fmt::Display) -> Result<T> {
        self.place.error(format!("{}: {message}", self.what))
    }
}

#[derive(Clone, Copy, PartialEq)]
enum DataEncoding {
    Ascii,
    Base64,
    Compressed,
}

/// The attributes of an array; words are empty where the file has none.
#[derive(Default)]
pub(super) struct ArrayHeader {
    pub intent: String,
    /// The name that a note gives it.
    pub name: String,
    data_type: String,
    encoding: String,
    external: String,
    big_endian: bool,
    column_major: bool,
    /// Rows and columns; −1 where the file does not say.
    dims: [i64; 2],
    dimensionality: i64,
}

impl ArrayHeader {
    pub fn new(tag: &BytesStart<'_>, place: Location<'_>) -> Result<ArrayHeader> {
        let mut header = ArrayHeader { dims: [-1; 2], dimensionality: -1, ..ArrayHeader::default() };
        for attribute in tag.attributes().with_checks(false) {
            let attribute = match attribute {
                Ok(attribute) => attribute,
                Err(e) => return place.error(format!("DataArray: {e}")),
            };
            let (name, value) = (attribute.key.0, attribute.value.trim());
            let number = || match value.parse::<i64>() {
                Ok(n) if n >= 0 => Ok(n),
                _ => place.error(format!("{name}=\"{value}\" is not a count")),
            };
            match name {
                "Intent" => header.intent = value.into(),
                "DataType" => header.data_type = value.into(),
                "Encoding" => header.encoding = value.into(),
                "ExternalFileName" => header.external = value.into(),
                "Dimensionality" => header.dimensionality = number()?,
                "Dim0" => header.dims[0] = number()?,
                "Dim1" => header.dims[1] = number()?,
                "Endian" => header.big_endian = choice(name, value, ["little", "big"], place)?,
                "ArrayIndexingOrder" => {
                    header.column_major = choice(name, value, ["row", "column"], place)?;
                }
                _ => {}
            }
        }
        Ok(header)
    }

    /// True if the array has rows of three floating-point numbers.
    pub fn is_vectors(&self) -> bool {
        self.dimensionality == 2 && self.dims[1] == 3 && self.data_type.starts_with("NIFTI_TYPE_FLOAT")
    }

    /// True if the array has one number per row.
    pub fn is_column(&self) -> bool {
        self.dimensionality == 1 || (self.dimensionality == 2 && self.dims[1] == 1)
    }

    /// The rows of three numbers in a text.
    pub fn table(&self, data: &ArrayText<'_>, budget: &mut Budget) -> Result<VectorTable> {
        if self.dimensionality != 2 || self.dims[1] != 3 {
            let what = data.what;
            return data.place.error(format!("{what} have Dimensionality=\"2\" and Dim1=\"3\""));
        }
        self.rows(data, 3, budget)
    }

    /// The numbers in a text, one per row ([`ArrayHeader::is_column`]).
    pub fn column(&self, data: &ArrayText<'_>, budget: &mut Budget) -> Result<Vec<f64>> {
        let table = self.rows(data, 1, budget)?;
        Ok((0..table.rows).map(|i| table.number(i)).collect())
    }

    /// The rows of so many numbers in a text.
    fn rows(&self, data: &ArrayText<'_>, columns: usize, budget: &mut Budget) -> Result<VectorTable> {
        let &ArrayText { what, text, place } = data;
        let name = self.data_type.strip_prefix("NIFTI_TYPE_").map(str::to_ascii_lowercase);
        let Some(kind) = name.and_then(|name| NumberType::named(&name)) else {
            return place.error(format!("{what} of DataType=\"{}\" are not known", self.data_type));
        };
        if what == "triangles" && !kind.is_integer() {
            return place.error(format!("{what} of DataType=\"{}\" have no integers", self.data_type));
        }
        let Ok(rows) = usize::try_from(self.dims[0]) else {
            return place.error(format!("{what} have no Dim0"));
        };
        if rows > u32::MAX as usize {
            return place.error(format!("{rows} {what} are more than can be numbered"));
        }
        let encoding = match self.encoding.as_str() {
            "ASCII" => DataEncoding::Ascii,
            "Base64Binary" => DataEncoding::Base64,
            "GZipBase64Binary" => DataEncoding::Compressed,
            "ExternalFileBinary" => {
                return place.error(format!(
                    "the {what} are in another file, `{}`; convert the surface to one file",
                    self.external
                ));
            }
            other => return place.error(format!("Encoding=\"{other}\" is not known")),
        };
        if text.contains(['<', '&']) {
            return place.error(format!("the {what} have markup among their data"));
        }
        let stored = if encoding == DataEncoding::Ascii { size_of::<f64>() } else { kind.size() };
        let kept = if what == "triangles" { size_of::<u32>() } else { size_of::<f64>() };
        budget.take(rows, columns * (stored + kept), what, place)?;
        let numbers = match encoding {
            DataEncoding::Ascii => ArrayNumbers::Text(ascii(data, columns * rows)?),
            _ => ArrayNumbers::Binary(binary(data, encoding, columns * rows * stored)?, kind),
        };
        Ok(VectorTable { rows, numbers, big_endian: self.big_endian, column_major: self.column_major })
    }
}

/// The `size` bytes that a base64 text encodes, plain or compressed.
fn binary(data: &ArrayText<'_>, encoding: DataEncoding, size: usize) -> Result<Vec<u8>> {
    let mut bytes = match base64::decode(data.text.as_bytes()) {
        Ok(bytes) => bytes,
        Err(message) => return data.error(message),
    };
    if encoding == DataEncoding::Compressed {
        let n = bytes.len();
        if size > MOST_INFLATION.saturating_mul(n) {
            return data.error(format!("{n} compressed bytes cannot hold the {size} of the table"));
        }
        let mut plain = Vec::with_capacity(size);
        // One byte more than the table has shows that there are too many. The format says zlib; some programs write gzip and say so in
        // the name of the encoding.
        let most = size as u64 + 1;
        let inflated = if bytes.starts_with(&[0x1f, 0x8b]) {
            GzDecoder::new(bytes.as_slice()).take(most).read_to_end(&mut plain)
        } else {
            ZlibDecoder::new(bytes.as_slice()).take(most).read_to_end(&mut plain)
        };
        if let Err(e) = inflated {
            return data.error(format!("the compressed data are damaged: {e}"));
        }
        bytes = plain;
    }
    if bytes.len() != size {
        let (n, more) = (bytes.len(), if bytes.len() > size { "at least " } else { "" });
        return data.error(format!("the data have {more}{n} bytes, the table has {size}"));
    }
    Ok(bytes)
}

/// True if the attribute's value contains the second of two words, false for the first: files say `LittleEndian` and
/// `GIFTI_ENDIAN_LITTLE`.
fn choice(name: &str, value: &str, [first, second]: [&str; 2], place: Location<'_>) -> Result<bool> {
    let lower = value.to_ascii_lowercase();
    match (lower.contains(first), lower.contains(second)) {
        (true, false) => Ok(false),
        (false, true) => Ok(true),
        _ => place.error(format!("{name}=\"{value}\" is neither {first} nor {second}")),
    }
}

/// The `count` numbers of a text.
fn ascii(data: &ArrayText<'_>, count: usize) -> Result<Vec<f64>> {
    let &ArrayText { what, text, place } = data;
    let mut numbers = Vec::new();
    let mut last = place;
    for (i, line) in text.split('\n').enumerate() {
        if let FilePosition::Line(first) = place.at {
            last = Location::line(place.path, first + i);
        }
        for token in line.split_ascii_whitespace() {
            if numbers.len() == count {
                return last
                    .error(format!("{what}: {} comes after the last of {count} numbers", Quoted(token)));
            }
            numbers.push(last.number(Some(token), format_args!("{what}:"))?);
        }
    }
    if numbers.len() < count {
        return last.error(format!("{what}: the data end after {} of {count} numbers", numbers.len()));
    }
    Ok(numbers)
}

enum ArrayNumbers {
    Text(Vec<f64>),
    Binary(Vec<u8>, NumberType),
}

/// Rows of three numbers.
pub(super) struct VectorTable {
    pub rows: usize,
    numbers: ArrayNumbers,
    big_endian: bool,
    column_major: bool,
}

impl VectorTable {
    /// Row i, below `rows`.
    pub fn row(&self, i: usize) -> [f64; 3] {
        std::array::from_fn(|j| self.number(if self.column_major { j * self.rows + i } else { 3 * i + j }))
    }

    fn number(&self, at: usize) -> f64 {
        match &self.numbers {
            ArrayNumbers::Text(numbers) => numbers[at],
            ArrayNumbers::Binary(bytes, kind) => kind.read(&bytes[kind.size() * at..], self.big_endian),
        }
    }
}
