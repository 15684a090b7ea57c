//! The model of an atlas: one triangle list, of one or several parts that no chart joins.

use crate::error::{Result, check_size};
use crate::mesh::Point;
use crate::mesh::io::Soup;
use crate::mesh::sheets::{SheetList, sheets, sheets_of_parts};

/// A triangle list with the parts of its vertices.
#[derive(Clone, Copy)]
pub(super) struct AtlasModel<'a> {
    pub soup: &'a Soup,
    /// Per vertex its part; none for a model of one part.
    parts: Option<&'a [u32]>,
}

impl<'a> AtlasModel<'a> {
    pub fn new(soup: &'a Soup, parts: Option<&'a [u32]>) -> Result<AtlasModel<'a>> {
        parts.map_or(Ok(()), |parts| check_size("parts", parts.len(), soup.positions.len()))?;
        Ok(AtlasModel { soup, parts })
    }

    pub fn sheets(&self) -> SheetList {
        self.parts.map_or_else(|| sheets(self.soup), |parts| sheets_of_parts(self.soup, parts))
    }

    /// The same for vertices in one place of one part.
    pub fn place(&self, v: u32) -> ([u64; 3], u32) {
        (self.point(v).map(f64::to_bits), self.parts.map_or(0, |parts| parts[v as usize]))
    }

    pub fn point(&self, v: u32) -> Point {
        self.soup.positions[v as usize]
    }
}
