//! The arrays of a VTK file in XML: text, base64 or raw bytes, perhaps compressed by zlib in blocks.

use super::poly_data::number_type;
use crate::error::Result;
use crate::mesh::io::base64;
use crate::mesh::io::budget::Budget;
use crate::mesh::io::kind::NumberType;
use crate::mesh::io::scan::{Location, Quoted};
use flate2::read::ZlibDecoder;
use quick_xml::events::BytesStart;
use std::io::Read;

/// Most bytes that deflate makes of one byte, by the definition of its format.
const MOST_INFLATION: usize = 1032;

/// What the first element of the file says about all arrays.
#[derive(Clone, Copy, Default)]
pub(super) struct XmlEncoding {
    pub big_endian: bool,
    /// Sizes are integers of 64 bits, not of 32.
    pub wide_sizes: bool,
    pub is_compressed: bool,
}

/// The data that arrays refer to by offsets.
#[derive(Clone, Copy)]
pub(super) struct AppendedData<'a> {
    pub bytes: &'a [u8],
    pub is_base64: bool,
}

/// The attributes of an array.
pub(super) struct XmlArray {
    pub name: String,
    pub kind: NumberType,
    pub components: usize,
    format: String,
    offset: usize,
}

/// Where the bytes of an array are, from its start on.
struct ByteSource<'a> {
    bytes: &'a [u8],
    is_base64: bool,
}

impl ByteSource<'_> {
    /// The `n` bytes from the start of a run of bytes that was encoded as one, and the source behind them.
    fn take(&self, n: usize, place: Location<'_>) -> Result<(Vec<u8>, ByteSource<'_>)> {
        let size = if self.is_base64 { n.div_ceil(3).saturating_mul(4) } else { n };
        let (Some(head), Some(rest)) = (self.bytes.get(..size), self.bytes.get(size..)) else {
            return place.error(format!("the data of an array end early: {n} bytes are announced"));
        };
        let rest = ByteSource { bytes: rest, is_base64: self.is_base64 };
        if !self.is_base64 {
            return Ok((head.to_vec(), rest));
        }
        match base64::decode(head) {
            Ok(mut bytes) if bytes.len() >= n => {
                bytes.truncate(n);
                Ok((bytes, rest))
            }
            Ok(bytes) => {
                place.error(format!("the data of an array have {} bytes, {n} are announced", bytes.len()))
            }
            Err(why) => place.error(why),
        }
    }
}

/// The text of an attribute.
pub(super) fn unescaped(text: &str) -> String {
    let plain = [("&lt;", "<"), ("&gt;", ">"), ("&quot;", "\""), ("&apos;", "'"), ("&amp;", "&")];
    plain.into_iter().fold(text.to_string(), |text, (from, to)| text.replace(from, to))
}

impl XmlArray {
    pub fn new(tag: &BytesStart<'_>, place: Location<'_>) -> Result<XmlArray> {
        let mut array = XmlArray {
            name: String::new(),
            kind: NumberType::F32,
            components: 1,
            format: "ascii".into(),
            offset: 0,
        };
        let mut kind = String::new();
        for attribute in tag.attributes().with_checks(false) {
            let attribute = match attribute {
                Ok(attribute) => attribute,
                Err(e) => return place.error(format!("DataArray: {e}")),
            };
            let (name, value) = (attribute.key.0, attribute.value.trim());
            let number = || place.count(Some(value), format_args!("{name}"));
            match name {
                "Name" => array.name = unescaped(value),
                "type" => kind = value.into(),
                "NumberOfComponents" => array.components = number()?,
                "format" => array.format = value.to_ascii_lowercase(),
                "offset" => array.offset = number()?,
                _ => {}
            }
        }
        match number_type(&kind) {
            Some(kind) => Ok(XmlArray { kind, ..array }),
            None => place.error(format!(
                "array {}: numbers of the type {} are not read",
                Quoted(&array.name),
                Quoted(&kind)
            )),
        }
    }

    /// True if its numbers are in the element itself.
    pub fn is_inline(&self) -> bool {
        self.format != "appended"
    }

    /// The numbers.
    pub fn numbers(
        &self,
        text: &str,
        file: &XmlFile<'_>,
        budget: &mut Budget,
        place: Location<'_>,
    ) -> Result<Vec<f64>> {
        match self.format.as_str() {
            "ascii" => {
                budget.take(text.len() / 2 + 1, size_of::<f64>(), "numbers of an array", place)?;
                let number = |word| place.number(Some(word), format_args!("array {}:", Quoted(&self.name)));
                text.split_ascii_whitespace().map(number).collect()
            }
            "binary" => {
                let plain: Vec<u8> = text.bytes().filter(|b| !b.is_ascii_whitespace()).collect();
                self.decoded(&ByteSource { bytes: &plain, is_base64: true }, file.encoding, budget, place)
            }
            "appended" => {
                let appended =
                    file.appended.and_then(|all| Some((all.bytes.get(self.offset..)?, all.is_base64)));
                let Some((bytes, is_base64)) = appended else {
                    return place.error(format!(
                        "array {} has no data at offset {}",
                        Quoted(&self.name),
                        self.offset
                    ));
                };
                self.decoded(&ByteSource { bytes, is_base64 }, file.encoding, budget, place)
            }
            other => place.error(format!("the format {} of an array is not known", Quoted(other))),
        }
    }

    fn decoded(
        &self,
        source: &ByteSource<'_>,
        encoding: XmlEncoding,
        budget: &mut Budget,
        place: Location<'_>,
    ) -> Result<Vec<f64>> {
        let bytes = if encoding.is_compressed {
            inflated(source, encoding, budget, place)?
        } else {
            let width = if encoding.wide_sizes { 8 } else { 4 };
            let (head, _) = source.take(width, place)?;
            let size = sizes(&head, encoding)[0];
            budget.take(size, 1, "bytes of an array", place)?;
            source.take(size.saturating_add(width), place)?.0.split_off(width)
        };
        let size = self.kind.size();
        if !bytes.len().is_multiple_of(size) {
            return place.error(format!(
                "array {} has {} bytes, no whole numbers",
                Quoted(&self.name),
                bytes.len()
            ));
        }
        budget.take(bytes.len() / size, size_of::<f64>(), "numbers of an array", place)?;
        Ok(bytes.chunks_exact(size).map(|word| self.kind.read(word, encoding.big_endian)).collect())
    }
}

/// The file as far as arrays need it.
#[derive(Default)]
pub(super) struct XmlFile<'a> {
    pub encoding: XmlEncoding,
    pub appended: Option<AppendedData<'a>>,
}

/// The sizes in these bytes; one that no memory holds is the largest number.
fn sizes(bytes: &[u8], encoding: XmlEncoding) -> Vec<usize> {
    let kind = if encoding.wide_sizes { NumberType::U64 } else { NumberType::U32 };
    bytes.chunks_exact(kind.size()).map(|word| kind.read(word, encoding.big_endian) as usize).collect()
}

/// The bytes of blocks that zlib has compressed: their number, the size of each and of the last before compression, and the size of each
/// after it stand before them.
fn inflated(
    source: &ByteSource<'_>,
    encoding: XmlEncoding,
    budget: &mut Budget,
    place: Location<'_>,
) -> Result<Vec<u8>> {
    let width = if encoding.wide_sizes { 8 } else { 4 };
    let blocks = sizes(&source.take(3 * width, place)?.0, encoding);
    let (n, whole, last) = (blocks[0], blocks[1], blocks[2]);
    let head = n.saturating_add(3).saturating_mul(width);
    // So that a count of blocks alone asks for no memory.
    if head > source.bytes.len() {
        return place.error(format!("{n} blocks are announced, more than the array has bytes"));
    }
    let (head, rest) = source.take(head, place)?;
    let packed: Vec<usize> = sizes(&head, encoding).split_off(3);
    let total = n.saturating_sub(1).saturating_mul(whole).saturating_add(if n == 0 {
        0
    } else if last > 0 {
        last
    } else {
        whole
    });
    let size = packed.iter().fold(0, |sum: usize, size| sum.saturating_add(*size));
    if total > MOST_INFLATION.saturating_mul(size) {
        return place.error(format!("{size} compressed bytes cannot hold {total}"));
    }
    budget.take(total, 1, "bytes of an array", place)?;
    budget.take(size, 1, "compressed bytes of an array", place)?;
    let (data, _) = rest.take(size, place)?;
    let (mut plain, mut at) = (Vec::with_capacity(total), 0);
    for packed in packed {
        let block = &data[at..at + packed];
        at += packed;
        let left = (total - plain.len()) as u64;
        if let Err(e) = ZlibDecoder::new(block).take(left + 1).read_to_end(&mut plain) {
            return place.error(format!("the compressed data are damaged: {e}"));
        }
        if plain.len() > total {
            return place.error(format!("the compressed data hold more than the {total} bytes announced"));
        }
    }
    if plain.len() != total {
        return place.error(format!("the compressed data hold {} bytes, {total} are announced", plain.len()));
    }
    Ok(plain)
}
