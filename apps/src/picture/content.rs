//! What a picture shows: surfaces, layouts, a drawing, and the meaning of their lines.

use super::drawing::Drawing;
use super::scene::{ColorField, ShownLayout, ShownSurface};
use super::texture::Tiles;

/// The content of a picture: the surface on the left, the layout or a drawing on the right, or one of them.
#[derive(Clone, Copy, Default)]
pub struct Picture<'a> {
    pub surface: Option<ShownSurface<'a>>,
    /// A second surface, on the right.
    pub beside: Option<ShownSurface<'a>>,
    pub flat: Option<ShownLayout<'a>>,
    /// A second layout, on the right of the first.
    pub flat_beside: Option<ShownLayout<'a>>,
    /// A drawing in place of the layout, or beside it.
    pub drawing: Option<&'a Drawing<'a>>,
    /// The size of the pattern, where it is not to be found from the areas on both sides.
    pub pattern: Option<&'a Tiles>,
    pub field: Option<&'a ColorField>,
    /// What the coloured lines and the dots mean.
    pub lines: LineMeaning,
}

/// The meaning of the coloured lines and of the dots of a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum LineMeaning {
    /// Seams of a layout, and its cones.
    #[default]
    Seams,
    /// Sides of a fundamental domain, and corners of the boundary.
    Sides,
    /// The cut along which a form was integrated.
    Cut,
    /// Horizontal and vertical trajectories, in this order of their colours.
    Trajectories,
    /// Borders of charts of an atlas, and its singular vertices.
    Charts,
    /// Edges of quads, and irregular vertices.
    Quads,
    /// Arcs of a layout of four-sided patches, those on features second, and irregular vertices.
    Arcs,
    /// Closed geodesics.
    Geodesics,
    /// Something else, which other words tell.
    Untold,
}
