//! Colours in linear light, and their sRGB values in files.

/// Linear light, each channel in [0, 1].
pub type Rgb = [f64; 3];

/// The 8-bit sRGB value of a channel (IEC 61966-2-1).
pub fn encode(x: f64) -> u8 {
    let x = x.clamp(0.0, 1.0);
    let y = if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 };
    (255.0 * y + 0.5) as u8
}

/// The colour of an sRGB triple as it is written in web pages, 0xRRGGBB.
pub fn from_hex(hex: u32) -> Rgb {
    [16, 8, 0].map(|shift| {
        let y = f64::from((hex >> shift) & 0xff) / 255.0;
        if y <= 0.040_45 { y / 12.92 } else { ((y + 0.055) / 1.055).powf(2.4) }
    })
}

/// `#rrggbb`.
pub fn to_hex(color: Rgb) -> String {
    let [r, g, b] = color.map(encode);
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// From `a` at t = 0 to `b` at t = 1.
pub fn mix(a: Rgb, b: Rgb, t: f64) -> Rgb {
    [0, 1, 2].map(|k| a[k] + t * (b[k] - a[k]))
}

/// Colours of the seams, in turn; none is near those of the pattern.
pub fn seam_color(seam: usize) -> Rgb {
    const COLORS: [u32; 8] = [0xd6262b, 0x2f9e3c, 0xe8820c, 0x8e44ad, 0x18b89e, 0xc93a8a, 0x8a6d1f, 0xe6b800];
    from_hex(COLORS[seam % COLORS.len()])
}

/// Red for positive curvature, blue for negative.
pub fn cone_color(curvature: f64) -> Rgb {
    from_hex(if curvature > 0.0 { 0xd7191c } else { 0x1f4fd0 })
}

/// Boundary curves, wire and lettering.
pub const INK: Rgb = [0.012, 0.014, 0.02];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seams_stand_out_from_both_colours_of_the_pattern() {
        for seam in (0..8).map(seam_color) {
            for ground in [0xf3efe6, 0x3a6ea5].map(from_hex) {
                let apart = (0..3).map(|k| (seam[k] - ground[k]).powi(2)).sum::<f64>().sqrt();
                assert!(apart > 0.25, "{} on {}", to_hex(seam), to_hex(ground));
            }
        }
    }

    #[test]
    fn colours_come_back_from_hex() {
        for hex in [0x000000, 0xffffff, 0x440154, 0x7f0b01, 0x0a0b0c] {
            assert_eq!(to_hex(from_hex(hex)), format!("#{hex:06x}"));
        }
    }
}
