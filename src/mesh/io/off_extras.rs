//! The attributes of the vertices of an OFF file.

use super::budget::Budget;
use super::polygon::Polygons;
use super::scan::Location;
use super::soup::{Attributes, NO_NORMAL, NO_TEXCOORD, Soup};
use crate::error::Result;
use crate::mesh::Point;

/// The attributes of each vertex after its coordinates, in this order.
#[derive(Clone, Copy, Default)]
pub(super) struct Columns {
    pub normal: bool,
    pub color: bool,
    pub texture: bool,
}

/// The attributes of the vertices read so far.
pub(super) struct Extras {
    has: Columns,
    /// The attributes that at least one vertex has.
    any: Columns,
    normals: Vec<Point>,
    colors: Vec<[f64; 4]>,
    texture: Vec<[f64; 2]>,
    /// True if a face has a colour.
    pub face_colors: bool,
}

impl Extras {
    pub fn new(has: Columns) -> Extras {
        let (normals, colors, texture) = (Vec::new(), Vec::new(), Vec::new());
        Extras { has, any: Columns::default(), normals, colors, texture, face_colors: false }
    }

    /// Adds the numbers after the coordinates of a vertex. The colour is what the other columns leave, three numbers or four.
    pub fn push(&mut self, rest: &[f64]) {
        let (normal, rest) = rest.split_at(if self.has.normal { rest.len().min(3) } else { 0 });
        let (color, texture) = rest.split_at(rest.len().saturating_sub(if self.has.texture { 2 } else { 0 }));
        let finite = |list: &&[f64]| list.iter().all(|x| x.is_finite());
        let normal = Some(normal).filter(finite).and_then(|x| <Point>::try_from(x).ok());
        let texture = Some(texture).filter(finite).and_then(|x| <[f64; 2]>::try_from(x).ok());
        let color = match *color {
            [r, g, b] => Some([r, g, b, f64::NAN]),
            [r, g, b, a, ..] => Some([r, g, b, a]),
            _ => None,
        };
        self.any.normal |= normal.is_some();
        self.any.texture |= texture.is_some();
        self.any.color |= self.has.color && color.is_some();
        if self.has.normal {
            self.normals.push(normal.unwrap_or(NO_NORMAL));
        }
        if self.has.texture {
            self.texture.push(texture.unwrap_or(NO_TEXCOORD));
        }
        if self.has.color {
            self.colors.push(color.unwrap_or([f64::NAN; 4]));
        }
    }

    /// The triangle list, with the attributes that vertices have.
    pub fn soup(
        self,
        positions: Vec<Point>,
        polygons: &Polygons,
        mut budget: Budget,
        place: Location<'_>,
    ) -> Result<Soup> {
        let triangles = polygons.triangles(&positions, &mut budget, place)?;
        // Components are from 0 to 1, or from 0 to 255 as soon as one is larger.
        let full = if self.colors.iter().flatten().any(|&x| x > 1.0) { 255.0 } else { 1.0 };
        let color = |c: [f64; 4]| c.map(|x| if x.is_nan() { 1.0 } else { x / full });
        let uv = |v: u32| self.texture.get(v as usize).copied().unwrap_or_default();
        let attributes = Attributes {
            normals: self.any.normal.then_some(self.normals),
            colors: self.any.color.then(|| self.colors.into_iter().map(color).collect()),
            uv: self.any.texture.then(|| triangles.iter().map(|&t| polygons.face(t).map(uv)).collect()),
            unread: self.face_colors.then(|| "colours of faces".to_string()).into_iter().collect(),
            ..Attributes::default()
        };
        Ok(Soup { faces: polygons.faces(&triangles), positions, attributes })
    }
}
