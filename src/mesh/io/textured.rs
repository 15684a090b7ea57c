//! Triangle lists whose corners have separate numbers for positions and texture coordinates, as in OBJ.

use super::labels::FaceLabels;
use super::soup::{Attributes, Soup, finite, in_range};
use crate::error::{Error, Result, check_size};
use crate::mesh::Point;
use std::collections::HashMap;

/// The data for [`super::write_obj`] and [`super::write_glb`].
#[derive(Debug, Clone, Copy, Default)]
pub struct TexturedMesh<'a> {
    /// Vertex positions.
    pub positions: &'a [Point],
    /// Colours of the vertices: red, green, blue, opacity, from 0 to 1; empty for none.
    pub colors: &'a [[f64; 4]],
    /// Normals, of the vertices unless `face_normals` says otherwise; empty for none.
    pub normals: &'a [Point],
    /// Texture coordinates; empty for none.
    pub texcoords: &'a [[f64; 2]],
    /// Homogeneous weights q of the texture coordinates, one for each; empty for none. OBJ then has `vt qs qt q`: within a triangle the
    /// map to the texture is linear in these three, and divided by the third. Other formats cannot hold them.
    pub texcoord_weights: &'a [f64],
    /// Corners of the faces, 0-based into `positions`.
    pub faces: &'a [[u32; 3]],
    /// Corners of the faces, 0-based into `texcoords`; as many as faces, or empty for none.
    pub face_texcoords: &'a [[u32; 3]],
    /// Corners of the faces, 0-based into `normals`; as many as faces, or empty where each vertex has its own.
    pub face_normals: &'a [[u32; 3]],
    /// The objects, groups and materials of the faces, which OBJ alone can hold.
    pub labels: Option<&'a FaceLabels>,
}

impl TexturedMesh<'_> {
    /// Checks that numbers are finite, corners name entries, and attributes have an entry for each element.
    pub(super) fn check(&self) -> Result<()> {
        let (n, f) = (self.positions.len(), self.faces.len());
        let vertex_normals = if self.face_normals.is_empty() { self.normals.len() } else { 0 };
        for (what, size, expected) in [
            ("face_texcoords", self.face_texcoords.len(), f),
            ("face_normals", self.face_normals.len(), f),
            ("normals", vertex_normals, n),
            ("colors", self.colors.len(), n),
            ("texcoord_weights", self.texcoord_weights.len(), self.texcoords.len()),
        ] {
            if size > 0 {
                check_size(what, size, expected)?;
            }
        }
        self.labels.into_iter().try_for_each(|labels| labels.check(f))?;
        finite("position", self.positions)?;
        finite("colour", self.colors)?;
        finite("normal", self.normals)?;
        finite("texture coordinate", self.texcoords)?;
        in_range("vertex", self.faces, self.positions.len())?;
        in_range("normal", self.face_normals, self.normals.len())?;
        in_range("texture vertex", self.face_texcoords, self.texcoords.len())
    }
}

/// Calls `write` with a soup; equal texture coordinates become one entry, and so do equal normals of corners.
pub(super) fn with_textured<T>(soup: &Soup, write: impl FnOnce(&TexturedMesh<'_>) -> Result<T>) -> Result<T> {
    soup.check_writable()?;
    let Attributes { normals, corner_normals, colors, uv, labels, .. } = &soup.attributes;
    let (texcoords, face_texcoords) = indexed("texture coordinates", uv.as_deref().unwrap_or_default())?;
    let (of_corners, face_normals) = indexed("normals", corner_normals.as_deref().unwrap_or_default())?;
    write(&TexturedMesh {
        positions: &soup.positions,
        faces: &soup.faces,
        colors: colors.as_deref().unwrap_or_default(),
        normals: if face_normals.is_empty() { normals.as_deref().unwrap_or_default() } else { &of_corners },
        texcoords: &texcoords,
        texcoord_weights: &[],
        face_texcoords: &face_texcoords,
        face_normals: &face_normals,
        labels: labels.as_ref(),
    })
}

/// The different values in order of appearance, and the number of the value at each corner.
fn indexed<const N: usize>(
    what: &'static str,
    corners: &[[[f64; N]; 3]],
) -> Result<(Vec<[f64; N]>, Vec<[u32; 3]>)> {
    if corners.len() > u32::MAX as usize / 3 {
        return Err(Error::TooLarge { what, count: corners.len().saturating_mul(3) });
    }
    let (mut values, mut known) = (Vec::new(), HashMap::new());
    let mut number = |value: [f64; N]| {
        *known.entry(value.map(f64::to_bits)).or_insert_with(|| {
            values.push(value);
            values.len() as u32 - 1
        })
    };
    let numbers = corners.iter().map(|values| values.map(&mut number)).collect();
    Ok((values, numbers))
}
