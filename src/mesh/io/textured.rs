//! Triangle lists whose corners number positions and texture coordinates apart, as OBJ has them.

use super::{Attributes, Point, Soup, finite, in_range};
use crate::error::{Error, Result, check_size};

/// What [`super::write_obj`] and [`super::write_glb`] write.
#[derive(Debug, Clone, Copy, Default)]
pub struct Textured<'a> {
    /// Vertex positions.
    pub positions: &'a [Point],
    /// Colours of the vertices: red, green, blue, opacity, from 0 to 1; empty for none.
    pub colors: &'a [[f64; 4]],
    /// Normals of the vertices; empty for none.
    pub normals: &'a [Point],
    /// Texture coordinates; empty for none.
    pub texcoords: &'a [[f64; 2]],
    /// Corners of the faces, 0-based into `positions`.
    pub faces: &'a [[u32; 3]],
    /// Corners of the faces, 0-based into `texcoords`; as many as faces, or empty for none.
    pub face_texcoords: &'a [[u32; 3]],
}

impl Textured<'_> {
    /// Numbers are finite, corners name entries, attributes have an entry for each element.
    pub(super) fn check(&self) -> Result<()> {
        if !self.face_texcoords.is_empty() {
            check_size("face_texcoords", self.face_texcoords.len(), self.faces.len())?;
        }
        for (what, len) in [("colors", self.colors.len()), ("normals", self.normals.len())] {
            if len > 0 {
                check_size(what, len, self.positions.len())?;
            }
        }
        finite("position", self.positions)?;
        finite("colour", self.colors)?;
        finite("normal", self.normals)?;
        finite("texture coordinate", self.texcoords)?;
        in_range("vertex", self.faces, self.positions.len())?;
        in_range("texture vertex", self.face_texcoords, self.texcoords.len())
    }
}

/// Call `write` with the triangle list that a soup is, with texture coordinates of their own for each corner.
pub(super) fn with_textured<T>(soup: &Soup, write: impl FnOnce(&Textured<'_>) -> Result<T>) -> Result<T> {
    soup.check_writable()?;
    let Attributes { normals, colors, uv } = &soup.attributes;
    let uv = uv.as_deref().unwrap_or_default();
    if uv.len() > u32::MAX as usize / 3 {
        return Err(Error::TooLarge { what: "texture coordinates", count: uv.len().saturating_mul(3) });
    }
    let corners: Vec<[u32; 3]> = (0..uv.len() as u32).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]).collect();
    write(&Textured {
        positions: &soup.positions,
        faces: &soup.faces,
        colors: colors.as_deref().unwrap_or_default(),
        normals: normals.as_deref().unwrap_or_default(),
        texcoords: uv.as_flattened(),
        face_texcoords: &corners,
    })
}
