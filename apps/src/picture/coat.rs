//! The colouring of the faces of a panel: a colour or a pattern, and the edges of the mesh.

use super::color::{INK, Rgb, from_hex, mix};
use super::colormap::NO_VALUE;
use super::texture::{TextureChoice, TexturePatch, Tiles};
use super::{ColorField, Style};
use ricci::geometry::complex::doubled_area;

/// Colour of a surface that shows nothing else.
pub const CLAY: u32 = 0xd3c6b4;
/// The two colours of a pattern.
pub const LIGHT: u32 = 0xf3efe6;
pub const DARK: u32 = 0x3a6ea5;
/// Number of colours in the table of a colour map.
const TABLE: usize = 512;
/// Share by which the dark parts of a pattern darken the colours of a quantity.
const SHADE: f64 = 0.35;
/// Half the width of a wire, over the size of the picture.
const WIRE: f64 = 0.00045;
const WIRE_OPACITY: f64 = 0.75;
/// The wire of faces with a side (square root of the area) below the first number of pixels is left out; from the
/// second on it is drawn in full.
const DENSE: [f64; 2] = [2.0, 9.0];

/// The colouring of all faces of a panel.
pub struct Coat<'a> {
    patches: Option<Vec<TexturePatch>>,
    field: Option<(&'a ColorField, Vec<Rgb>)>,
    wire: Option<Vec<Wire>>,
    clay: Rgb,
    light: Rgb,
    dark: Rgb,
}

/// The pattern and the quantity that the faces of a panel are to show.
#[derive(Clone, Copy)]
pub struct PanelContent<'a> {
    pub tiles: Option<&'a Tiles>,
    pub corner_uv: Option<&'a [[[f64; 2]; 3]]>,
    pub field: Option<&'a ColorField>,
}

impl<'a> Coat<'a> {
    /// `triangles`: each face on the panel.
    pub fn new(wish: &PanelContent<'a>, style: &Style, triangles: &[[[f64; 2]; 3]]) -> Coat<'a> {
        let patch = |uv: &[[[f64; 2]; 3]], tiles: &Tiles| -> Vec<TexturePatch> {
            let each = triangles.iter().zip(uv).enumerate();
            each.map(|(f, (pixels, uv))| TexturePatch::new(style.texture, *uv, tiles, f, *pixels)).collect()
        };
        let textured = style.texture != TextureChoice::None;
        let patches = wish.corner_uv.zip(wish.tiles).filter(|_| textured).map(|(uv, tiles)| patch(uv, tiles));
        let half_width = wire_width(style.size);
        let wire = style.wire.then(|| triangles.iter().map(|t| Wire::new(*t, half_width)).collect());
        let field = wish.field.filter(|f| f.corners.len() == triangles.len());
        let field = field.map(|f| (f, f.scale.table(TABLE)));
        let [clay, light, dark] = [CLAY, LIGHT, DARK].map(from_hex);
        Coat { patches, field, wire, clay, light, dark }
    }

    /// The colour of a face at barycentric coordinates.
    pub fn color(&self, face: usize, b: [f64; 3]) -> Rgb {
        let value = self.patches.as_ref().map(|p| p[face].value(b));
        let color = match (&self.field, value) {
            (Some((field, table)), pattern) => {
                let c = field.corners[face];
                let t = field.scale.place(b[0] * c[0] + b[1] * c[1] + b[2] * c[2]);
                let color =
                    if t.is_nan() { NO_VALUE } else { table[(t * (TABLE - 1) as f64 + 0.5) as usize] };
                color.map(|x| x * (1.0 - SHADE * pattern.unwrap_or(0.0)))
            }
            (None, Some(pattern)) => mix(self.light, self.dark, pattern),
            (None, None) => self.clay,
        };
        let wire = self.wire.as_ref().map_or(0.0, |w| w[face].opacity(b));
        mix(color, INK, wire)
    }
}

/// Half the width of a wire, pixels.
pub fn wire_width(size: usize) -> f64 {
    (WIRE * size as f64).max(0.35)
}

/// The opacity of the wire of faces with this area in pixels.
pub fn wire_opacity(area: f64) -> f64 {
    WIRE_OPACITY * ((area.sqrt() - DENSE[0]) / (DENSE[1] - DENSE[0])).clamp(0.0, 1.0)
}

/// The edges of one face on the panel.
pub struct Wire {
    /// Heights of the triangle in pixels: a barycentric coordinate times its height is the distance from its side.
    heights: [f64; 3],
    half_width: f64,
    opacity: f64,
}

impl Wire {
    /// A face in pixels; `half_width` of [`wire_width`].
    pub fn new(p: [[f64; 2]; 3], half_width: f64) -> Wire {
        let area = doubled_area(p).abs();
        let side = |k: usize| {
            let (a, b) = (p[(k + 1) % 3], p[(k + 2) % 3]);
            (b[0] - a[0]).hypot(b[1] - a[1])
        };
        let heights = [0, 1, 2].map(|k| area / side(k).max(f64::MIN_POSITIVE));
        Wire { heights, half_width, opacity: wire_opacity(0.5 * area) }
    }

    /// Each of the two faces at an edge draws its half, whose outline is softened over half a pixel.
    pub fn opacity(&self, b: [f64; 3]) -> f64 {
        let distance = (0..3).map(|k| b[k] * self.heights[k]).fold(f64::INFINITY, f64::min);
        self.opacity * ((self.half_width - distance) * 2.0 + 0.5).clamp(0.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wires_have_one_width_and_dense_ones_fade() {
        // The distance from a side, not a share of the triangle, decides.
        for size in [50.0, 500.0] {
            let wire = Wire::new([[0.0, 0.0], [size, 0.0], [0.0, size]], 1.0);
            let at = |pixels: f64| wire.opacity([0.5 - pixels / size, 0.5, pixels / size]);
            assert_eq!((at(0.2), at(1.6)), (WIRE_OPACITY, 0.0));
        }
        let dense = Wire::new([[0.0, 0.0], [2.0, 0.0], [0.0, 2.0]], 1.0);
        assert_eq!(dense.opacity([0.0, 0.5, 0.5]), 0.0);
    }
}
