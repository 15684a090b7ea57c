//! Pictures: the surface with the pattern of its layout beside the flat layout, and a legend below.
//!
//! A surface becomes triangles and round strokes, which one supersampled z-buffer draws in linear light. Layouts, drawings and legends become
//! SVG, which is the file itself or is drawn over the surfaces by resvg. Light and shadow come from depth maps, one for each of many small
//! lights. The projection is orthographic, so that attributes interpolate linearly. Each pixel is computed by itself, so that a picture
//! is the same for any number of threads.

mod args;
mod camera;
mod canvas;
mod coat;
mod color;
mod colormap;
mod content;
mod drawing;
mod fit;
mod flat;
mod key;
mod legend;
mod light;
mod normals;
mod occlusion;
mod palette;
mod raster;
mod region;
mod scene;
mod sheet;
mod solid;
mod standing;
mod text;
mod texture;
mod upright;
mod vector;

pub use args::{ColorChoice, FlowPictureArgs, PictureArgs, SurfacePictureArgs, Zoom, direction, zoom};
pub use camera::{Camera, Viewpoint};
pub use colormap::{CLASSES, ColorScale, HUES};
pub use content::{LineMeaning, Picture};
pub use drawing::{Area, Drawing, DrawingFrame, DrawingPattern, DrawnLine, Label, PALE, TINTS, tint_color};
pub use region::{FINEST, cells, in_pieces, outline};
pub use scene::{Circle, ColorField, Focus, ShownLayout, ShownSurface, Style};
pub use texture::{OCTAVE, TextureChoice, Tiles};

pub use ricci::geometry::complex::doubled_area;
pub use upright::stance;
pub use vector::normal;

use crate::failure::Failure;
use coat::PanelContent;
use raster::PixelImage;
use ricci::parallel;
use sheet::VectorSheet;

/// Space between two panels, over the size of a panel.
const BETWEEN: f64 = 0.03;

impl Picture<'_> {
    /// The pattern that both panels show; without a surface that of the layout alone.
    fn tiles(&self) -> Option<Tiles> {
        let uv = self.flat.map(|f| f.corner_uv).or(self.surface.and_then(|s| s.corner_uv))?;
        let layout: Vec<f64> = uv.iter().map(|uv| 0.5 * doubled_area(*uv).abs()).collect();
        Some(match &self.surface {
            Some(s) => {
                let area = |f: &[u32; 3]| 0.5 * vector::norm(normal(f.map(|v| s.positions[v as usize])));
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

    /// True if the checks of the layout would all be so small that it had one grey: then they change in size.
    fn is_grey(&self, tiles: &Tiles, style: &Style) -> bool {
        style.texture != TextureChoice::None
            && self.flat.is_some_and(|flat| tiles.size * flat::fit(&flat, style).scale < FINEST)
    }

    /// The panels side by side, and the legend below them.
    fn sheet(&self, style: &Style) -> ricci::Result<VectorSheet> {
        parallel::within(style.threads, || Ok(self.panels(style)))
    }

    fn panels(&self, style: &Style) -> VectorSheet {
        let own = if self.pattern.is_some() { None } else { self.tiles() };
        let own = own.map(|tiles| {
            let bands = style.bands || self.is_grey(&tiles, style);
            tiles.banded(bands)
        });
        let tiles = self.pattern.or(own.as_ref());
        let wish = |corner_uv| PanelContent { tiles, corner_uv, field: self.field };
        let [surface, beside] = [self.surface, self.beside].map(|surface| {
            surface.map(|s| VectorSheet::of_image(solid::draw(&s, &wish(s.corner_uv), style)))
        });
        let [flat, second] = [(self.flat, "layout"), (self.flat_beside, "second-layout")]
            .map(|(flat, id)| flat.map(|f| flat::draw(&f, &wish(Some(f.corner_uv)), style).cut(id)));
        let drawing = self.drawing.map(|d| drawing::draw(d, style));
        let panels =
            stack([surface, beside, flat, second, drawing], 0, (BETWEEN * style.size as f64) as usize);
        stack([Some(panels), key::draw(self, style), self.field.map(|f| legend::bar(&f.scale, style))], 1, 0)
    }
}

/// Sheets from left to right (axis 0) or from top to bottom (axis 1), their middles on one line.
fn stack(sheets: impl IntoIterator<Item = Option<VectorSheet>>, axis: usize, gap: usize) -> VectorSheet {
    let sheets: Vec<VectorSheet> = sheets.into_iter().flatten().collect();
    let sizes: Vec<[usize; 2]> = sheets.iter().map(|s| [s.width, s.height]).collect();
    let mut whole = [0, 1].map(|k| sizes.iter().map(|s| s[k]).max().unwrap_or(1));
    whole[axis] = sizes.iter().map(|s| s[axis]).sum::<usize>() + gap * sizes.len().saturating_sub(1);
    let (mut stacked, mut next) = (VectorSheet::new(whole[0], whole[1]), 0);
    for (sheet, size) in sheets.into_iter().zip(sizes) {
        let mut at = [0, 1].map(|k| (whole[k] - size[k].min(whole[k])) / 2);
        at[axis] = next;
        stacked.put(sheet, at);
        next += size[axis] + gap;
    }
    stacked
}

/// The picture of a layout or a drawing as an SVG file; surfaces are not in it.
pub fn svg(picture: &Picture<'_>, style: &Style) -> Result<Vec<u8>, Failure> {
    Ok(picture.sheet(style)?.svg())
}

/// The picture as a PNG file.
pub fn png(picture: &Picture<'_>, style: &Style) -> Result<Vec<u8>, Failure> {
    encoded(&picture.sheet(style)?.image()?, style.palette).map_err(|e| Failure::Failed(e.to_string()))
}

fn encoded(image: &PixelImage, palette: bool) -> Result<Vec<u8>, png::EncodingError> {
    let rgb: Vec<u8> = image.rgba.chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, image.width as u32, image.height as u32);
    encoder.set_depth(png::BitDepth::Eight);
    if palette {
        encoder.set_compression(png::Compression::High);
        let (colors, indices) = palette::reduce(&rgb);
        encoder.set_color(png::ColorType::Indexed);
        encoder.set_palette(colors);
        // Neighbouring numbers of a palette are unrelated, so that no filter would help.
        encoder.set_filter(png::Filter::NoFilter);
        encoder.write_header()?.write_image_data(&indices)?;
    } else {
        encoder.set_compression(png::Compression::Fast);
        encoder.set_color(png::ColorType::Rgb);
        encoder.write_header()?.write_image_data(&rgb)?;
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests;
