//! Patches: a part of the vertices of a surface with places of their own, such as a cortex without its medial wall, laid flat.

use super::big_endian::{BigEndianWords, signed, single};
use crate::error::{Result, check_size};
use crate::mesh::Point;

/// A part of a surface.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SurfacePatch {
    /// The vertices of the whole surface that belong to the part.
    pub vertices: Vec<u32>,
    /// Their places; z = 0 where the part lies flat.
    pub positions: Vec<Point>,
    /// True for vertices on the part's border.
    pub is_border: Vec<bool>,
}

/// The number with which a file begins.
const MARK: i32 = -1;

/// Parses a patch: the mark −1, the number of vertices, then for each its number, 1 and more, negative on the border, and its place in single
/// precision. `path` is used in errors.
///
/// # Errors
/// [`crate::Error::Parse`] with the byte.
pub fn parse_patch(bytes: &[u8], path: &str) -> Result<SurfacePatch> {
    let mut words = BigEndianWords::new(bytes, path);
    if words.integer("the mark")? != MARK {
        return crate::mesh::io::scan::Location::whole(path)
            .error("this is no patch: its mark is missing".into());
    }
    let n = words.count("the number of vertices")?;
    words.holds(n, 16, "vertices")?;
    let mut patch = SurfacePatch::default();
    for _ in 0..n {
        let place = words.place();
        let number = words.integer("a vertex")?;
        if number == 0 {
            return place.error("a vertex has the number 0: patches count from 1".into());
        }
        patch.vertices.push(number.unsigned_abs() - 1);
        patch.is_border.push(number < 0);
        patch.positions.push(words.point("a vertex")?);
    }
    Ok(patch)
}

/// The bytes of a patch.
///
/// # Errors
/// [`crate::Error::Size`] unless each vertex has a place and a flag; [`crate::Error::Argument`] for coordinates that are not finite or not in the
/// range of single precision; [`crate::Error::TooLarge`].
pub fn patch_bytes(patch: &SurfacePatch) -> Result<Vec<u8>> {
    let SurfacePatch { vertices, positions, is_border } = patch;
    check_size("positions", positions.len(), vertices.len())?;
    check_size("border flags", is_border.len(), vertices.len())?;
    let mut bytes = MARK.to_be_bytes().to_vec();
    bytes.extend(signed(vertices.len(), "vertices")?);
    for ((v, position), border) in vertices.iter().zip(positions).zip(is_border) {
        let number = i32::from_be_bytes(signed(*v as usize + 1, "vertices")?);
        bytes.extend(if *border { -number } else { number }.to_be_bytes());
        for x in position {
            bytes.extend(single(*x, "coordinate")?);
        }
    }
    Ok(bytes)
}
