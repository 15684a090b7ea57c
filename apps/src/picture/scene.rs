//! The content of a picture, and the style in which it is drawn.

use super::camera::Viewpoint;
use super::colormap::ColorScale;
use super::texture::TextureChoice;

/// Half the width of a line and the radius of a cone's ball, over the size of a panel, and in pixels at least.
const LINE: [f64; 2] = [0.0013, 0.7];
const CONE_RADIUS: [f64; 2] = [0.0062, 2.6];
/// Size of letters over that of a panel, and its bounds in pixels: neither too small to be read nor larger than a title.
const LETTERS: [f64; 3] = [0.025, 12.0, 44.0];

/// A surface in space.
#[derive(Clone, Copy)]
pub struct ShownSurface<'a> {
    pub positions: &'a [[f64; 3]],
    pub faces: &'a [[u32; 3]],
    /// Layout coordinates of each face's corners.
    pub corner_uv: Option<&'a [[[f64; 2]; 3]]>,
    /// Cut edges: two vertices and the number of their seam.
    pub seams: &'a [(u32, u32, usize)],
    /// Cone vertices and their curvature.
    pub cones: &'a [(u32, f64)],
    /// True if the surface is known to have no boundary; the boundary of others is searched and drawn.
    pub is_closed: bool,
}

/// A circle in the layout.
#[derive(Clone, Copy)]
pub struct Circle {
    pub centre: [f64; 2],
    pub radius: f64,
}

/// A layout in the plane.
#[derive(Clone, Copy, Default)]
pub struct ShownLayout<'a> {
    pub corner_uv: &'a [[[f64; 2]; 3]],
    /// Both copies of each cut edge: ends in the order of their face, and the number of their seam.
    pub seams: &'a [([f64; 2], [f64; 2], usize)],
    /// Lines that are no part of the layout: the unit square around charts.
    pub frame: &'a [([f64; 2], [f64; 2])],
    /// Boundary edges, ends in the order of their face.
    pub boundary: &'a [([f64; 2], [f64; 2])],
    pub cones: &'a [([f64; 2], f64)],
    pub circles: &'a [Circle],
    pub dual_circles: &'a [Circle],
    /// Round holes, which are white and whose edges are drawn as circles.
    pub holes: &'a [Circle],
    /// Circles that bound the layout from outside.
    pub rims: &'a [Circle],
}

/// A quantity on the surface, to be shown in colours.
#[derive(Clone)]
pub struct ColorField {
    /// Its value at each face's corners; NaN where it has none.
    pub corners: Vec<[f64; 3]>,
    pub scale: ColorScale,
}

/// How a picture is drawn.
#[derive(Clone, Copy, Debug)]
pub struct Style {
    /// Pixels of the longer side of a panel.
    pub size: usize,
    /// 0: one per core.
    pub threads: usize,
    pub view: Viewpoint,
    pub texture: TextureChoice,
    /// Draw the edges of the mesh.
    pub wire: bool,
    /// Stand the surface on a ground that takes its shadow.
    pub ground: bool,
    /// Write at most 256 colours, for a small file.
    pub palette: bool,
    /// Leave shadows out.
    pub draft: bool,
    /// Change the size of the pattern by steps where the layout's scale varies much.
    pub bands: bool,
    /// Show a part only.
    pub focus: Option<Focus>,
}

/// A part of a surface and the same part of its layout: centre and half the side of the square that is shown.
#[derive(Clone, Copy, Debug)]
pub struct Focus {
    pub at: [f64; 3],
    pub radius: f64,
    /// A normal of the surface there, of any length, which is the direction of the view unless one is given.
    pub normal: [f64; 3],
    pub at_layout: [f64; 2],
    pub radius_layout: f64,
}

impl Style {
    /// Half the width of a line, pixels.
    pub fn line(&self) -> f64 {
        (LINE[0] * self.size as f64).max(LINE[1])
    }

    /// The size of letters, pixels.
    pub fn letters(&self) -> f64 {
        (LETTERS[0] * self.size as f64).clamp(LETTERS[1], LETTERS[2])
    }

    /// The radius of a cone's ball, pixels.
    pub fn cone(&self) -> f64 {
        (CONE_RADIUS[0] * self.size as f64).max(CONE_RADIUS[1])
    }
}

impl Default for Style {
    fn default() -> Style {
        let (view, texture) = (Viewpoint::default(), TextureChoice::Checker);
        Style {
            size: 900,
            threads: 0,
            view,
            texture,
            wire: false,
            ground: true,
            palette: false,
            focus: None,
            draft: false,
            bands: false,
        }
    }
}
