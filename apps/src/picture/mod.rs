//! Pictures: the surface with the checkerboard of its layout beside the flat layout.
//!
//! A small software renderer: everything becomes triangles (lines are ribbons, dots are fans) that go through one
//! supersampled z-buffer in linear light. Orthographic, so that attributes interpolate linearly.

mod checker;
mod flat;
mod raster;
mod solid;
mod svg;

pub use svg::write_svg;

use checker::{Tiles, doubled_area};
use raster::Rgb;

/// A surface in space.
#[derive(Clone, Copy)]
pub struct Surface<'a> {
    pub positions: &'a [[f64; 3]],
    pub faces: &'a [[u32; 3]],
    /// Layout coordinates of each face's corners.
    pub corner_uv: Option<&'a [[[f64; 2]; 3]]>,
    /// Cut edges: two vertices and the number of their seam.
    pub seams: &'a [(u32, u32, usize)],
    /// Cone vertices and their curvature.
    pub cones: &'a [(u32, f64)],
}

/// A circle in the layout.
#[derive(Clone, Copy)]
pub struct Circle {
    pub center: [f64; 2],
    pub radius: f64,
}

/// A layout in the plane.
#[derive(Clone, Copy)]
pub struct Flat<'a> {
    pub corner_uv: &'a [[[f64; 2]; 3]],
    /// Both copies of each cut edge: ends and the number of their seam.
    pub seams: &'a [([f64; 2], [f64; 2], usize)],
    pub boundary: &'a [([f64; 2], [f64; 2])],
    pub cones: &'a [([f64; 2], f64)],
    pub circles: &'a [Circle],
    pub dual_circles: &'a [Circle],
}

/// What one picture shows: the surface on the left, the layout on the right, or one of them.
#[derive(Clone, Copy)]
pub struct Picture<'a> {
    pub surface: Option<Surface<'a>>,
    pub flat: Option<Flat<'a>>,
}

impl Picture<'_> {
    /// The checks that both panels show; without a surface those of the layout alone.
    fn tiles(&self) -> Option<Tiles> {
        let uv = self.flat.map(|f| f.corner_uv).or(self.surface.and_then(|s| s.corner_uv))?;
        let layout: Vec<f64> = uv.iter().map(|uv| 0.5 * doubled_area(*uv).abs()).collect();
        Some(match &self.surface {
            Some(s) => {
                let area =
                    |f: &[u32; 3]| 0.5 * solid::norm(solid::normal(f.map(|v| s.positions[v as usize])));
                let surface: Vec<f64> = s.faces.iter().map(area).collect();
                Tiles::new(&surface, &layout, s.faces, s.positions.len())
            }
            None => {
                let apart: Vec<[u32; 3]> =
                    (0..uv.len() as u32).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]).collect();
                Tiles::new(&layout, &layout, &apart, 3 * uv.len())
            }
        })
    }
}

/// Pixels of a (square) panel.
const PANEL: usize = 900;
/// Share of the panel left free on each side.
const MARGIN: f64 = 0.04;
/// Line width in pixels.
const LINE: f64 = 2.2;

/// The picture as a PNG file, drawn by this many threads (0: one per core).
pub fn png(picture: &Picture<'_>, threads: usize) -> Result<Vec<u8>, png::EncodingError> {
    let tiles = picture.tiles();
    let surface = picture.surface.as_ref().map(|s| solid::primitives(s, tiles.as_ref()));
    let flat = picture.flat.as_ref().zip(tiles.as_ref()).map(|(f, tiles)| flat::primitives(f, tiles));
    let panels: Vec<Vec<u8>> =
        [surface, flat].into_iter().flatten().map(|p| raster::render(&p, PANEL, threads)).collect();
    let width = PANEL * panels.len().max(1);
    let mut image = vec![255u8; 3 * width * PANEL];
    for (p, panel) in panels.iter().enumerate() {
        for (y, row) in panel.chunks_exact(3 * PANEL).enumerate() {
            let start = 3 * (y * width + p * PANEL);
            image[start..start + 3 * PANEL].copy_from_slice(row);
        }
    }
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width as u32, PANEL as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::High);
    encoder.write_header()?.write_image_data(&image)?;
    Ok(bytes)
}

/// Colours of the seams, in turn (linear light).
fn seam_color(seam: usize) -> Rgb {
    const COLORS: [Rgb; 8] = [
        [0.75, 0.02, 0.03],
        [0.01, 0.17, 0.65],
        [0.02, 0.36, 0.05],
        [0.75, 0.25, 0.0],
        [0.30, 0.03, 0.52],
        [0.0, 0.40, 0.42],
        [0.62, 0.02, 0.30],
        [0.32, 0.22, 0.02],
    ];
    COLORS[seam % COLORS.len()]
}

/// Red for positive curvature, blue for negative.
fn cone_color(curvature: f64) -> Rgb {
    if curvature > 0.0 { [0.80, 0.03, 0.02] } else { [0.01, 0.10, 0.70] }
}

/// Map of a bounding box onto the panel: equal scales, y up, centred.
struct Fit {
    scale: f64,
    offset: [f64; 2],
}

impl Fit {
    /// The whole layout with its circles.
    fn of(flat: &Flat<'_>) -> Fit {
        let ends = |c: &Circle| [-1.0, 1.0].map(|s| [c.center[0] + s * c.radius, c.center[1] + s * c.radius]);
        Fit::new(flat.corner_uv.iter().flatten().copied().chain(flat.circles.iter().flat_map(ends)))
    }

    fn new(points: impl Iterator<Item = [f64; 2]>) -> Fit {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for p in points.filter(|p| p.iter().all(|x| x.is_finite())) {
            for k in 0..2 {
                low[k] = low[k].min(p[k]);
                high[k] = high[k].max(p[k]);
            }
        }
        if low[0] > high[0] {
            (low, high) = ([0.0; 2], [1.0; 2]);
        }
        let size = (high[0] - low[0]).max(high[1] - low[1]).max(f64::MIN_POSITIVE);
        let scale = PANEL as f64 * (1.0 - 2.0 * MARGIN) / size;
        let offset = [0, 1].map(|k| 0.5 * PANEL as f64 - scale * 0.5 * (low[k] + high[k]));
        Fit { scale, offset }
    }

    /// Pixel coordinates, y down.
    fn apply(&self, p: [f64; 2]) -> [f64; 2] {
        [self.scale * p[0] + self.offset[0], PANEL as f64 - (self.scale * p[1] + self.offset[1])]
    }
}

#[cfg(test)]
mod tests;
