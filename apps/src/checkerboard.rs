//! The checkerboard that a layout carries in binary glTF.

use crate::failure::Failure;

/// Squares along the longer side of the layout.
const SQUARES: f64 = 24.0;
/// Pixels per side of the texture, which holds 2 × 2 squares and repeats.
const PIXELS: u32 = 64;
const LIGHT: u8 = 235;
const DARK: u8 = 70;

/// The number of repetitions of the texture, which is two squares wide, along a unit of the layout.
pub fn repeat(layout: &[[f64; 2]]) -> f64 {
    let bound =
        |k: usize, pick: fn(f64, f64) -> f64, start: f64| layout.iter().map(|p| p[k]).fold(start, pick);
    let [x, y] = [0, 1].map(|k| bound(k, f64::max, f64::NEG_INFINITY) - bound(k, f64::min, f64::INFINITY));
    SQUARES / (2.0 * x.max(y).max(f64::MIN_POSITIVE))
}

/// A PNG of 2 × 2 squares.
pub fn png() -> Result<Vec<u8>, Failure> {
    let shade = |i: u32| if (i % PIXELS < PIXELS / 2) ^ (i / PIXELS < PIXELS / 2) { DARK } else { LIGHT };
    let pixels: Vec<u8> = (0..PIXELS * PIXELS).map(shade).collect();
    let mut png = Vec::new();
    let mut encoder = png::Encoder::new(&mut png, PIXELS, PIXELS);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::Eight);
    let failed = |e: png::EncodingError| Failure::Failed(format!("texture: {e}"));
    let mut writer = encoder.write_header().map_err(failed)?;
    writer.write_image_data(&pixels).map_err(failed)?;
    writer.finish().map_err(failed)?;
    Ok(png)
}
