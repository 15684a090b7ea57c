//! Values at the vertices of a surface: curv, sulc, area, thickness.

use super::big_endian::{BigEndianWords, signed, single};
use crate::error::Result;
#[cfg(feature = "gifti")]
use crate::mesh::io::gifti_values::{is_xml, parse_gifti_columns};

/// The first three bytes of files in single precision; older ones begin with the number of vertices.
const MARK: u32 = 0xff_ffff;
/// The numbers of older files are hundredths.
const HUNDREDTH: f64 = 100.0;

/// Parses a file of one value per vertex; also, by its content, one of GIFTI with one array (`.shape.gii`, `.func.gii`), with the cargo feature
/// `gifti`. `path` is used in errors.
///
/// # Errors
/// [`crate::Error::Parse`] with the byte, or the line.
pub fn parse_values(bytes: &[u8], path: &str) -> Result<Vec<f64>> {
    #[cfg(feature = "gifti")]
    if is_xml(bytes) {
        return parse_gifti_columns(bytes, path)?.only(path);
    }
    let mut words = BigEndianWords::new(bytes, path);
    let first = words.small("the mark")?;
    if first != MARK {
        words.small("the number of triangles")?;
        let n = first as usize;
        words.holds(n, 2, "values")?;
        let value = |_| words.array("a value").map(|word| f64::from(i16::from_be_bytes(word)) / HUNDREDTH);
        return (0..n).map(value).collect();
    }
    let n = words.count("the number of vertices")?;
    words.count("the number of triangles")?;
    let place = words.place();
    let columns = words.count("the number of values per vertex")?;
    if columns != 1 {
        return place.error(format!("{columns} values per vertex; files with one are read"));
    }
    words.holds(n, 4, "values")?;
    (0..n).map(|_| words.real("a value")).collect()
}

/// The bytes of a file of one value per vertex, in single precision. `n_faces`: the triangles of the surface, which the file names too.
///
/// # Errors
/// [`crate::Error::Argument`] for values that are not finite or not in the range of single precision; [`crate::Error::TooLarge`].
pub fn values_bytes(values: &[f64], n_faces: usize) -> Result<Vec<u8>> {
    let mut bytes = MARK.to_be_bytes()[1..].to_vec();
    bytes.extend(signed(values.len(), "vertices")?);
    bytes.extend(signed(n_faces, "triangles")?);
    bytes.extend(1_i32.to_be_bytes());
    for x in values {
        bytes.extend(single(*x, "value")?);
    }
    Ok(bytes)
}
