//! Words in generators as strokes: `a1 b2^-1` with the number below and the exponent above the line.

use super::font::text;
use super::raster::Shape;

/// Height of tall letters over the size of the panel, and in pixels at least.
const HEIGHT: [f64; 2] = [0.0175, 8.0];
/// Size of numbers and exponents, and how far they are off the line, over the height of tall letters.
const SMALL: f64 = 0.66;
const BELOW: f64 = 0.28;
const ABOVE: f64 = 0.55;
/// Space after a letter with its number and exponent, and between these.
const SPACE: f64 = 0.3;
const NARROW: f64 = 0.12;
/// Pens of the white line around letters, over the pen of the letters.
pub const HALO: f64 = 3.2;

/// A stroke in pixels, y down, and half the width of its pen.
pub type Stroke = ([[f64; 2]; 2], f64);

/// The strokes of a word that begins at x = 0 and is centred at y = 0, with its width.
pub fn lettering(word: &str, size: f64) -> (Vec<Stroke>, f64) {
    let height = (HEIGHT[0] * size).max(HEIGHT[1]);
    let (mut strokes, mut x) = (Vec::new(), 0.0);
    for letter in word.split_whitespace() {
        for (part, scale, rise) in parts(letter) {
            let (shapes, width) = text(&part, scale * height);
            for shape in shapes {
                if let Shape::Capsule { ends, radius } = shape {
                    // Letters like a are centred half-way up theirs.
                    let y = (0.33 - rise) * height;
                    strokes.push((ends.map(|p| [p[0] + x, p[1] + y]), radius));
                }
            }
            x += width + NARROW * height;
        }
        x += (SPACE - NARROW) * height;
    }
    (strokes, (x - SPACE * height).max(0.0))
}

/// The parts of a letter with their size and how far they are raised.
fn parts(letter: &str) -> Vec<(String, f64, f64)> {
    let (name, inverse) = letter.strip_suffix("^-1").map_or((letter, false), |name| (name, true));
    let digits = name.find(|c: char| c.is_ascii_digit()).unwrap_or(name.len());
    let mut parts = vec![(name[..digits].to_string(), 1.0, 0.0)];
    if digits < name.len() && digits > 0 {
        parts.push((name[digits..].into(), SMALL, -BELOW));
    } else if digits == 0 {
        parts[0].0 = name.into();
    }
    if inverse {
        parts.push(("−1".into(), SMALL, ABOVE));
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_have_numbers_below_and_exponents_above() {
        let of = |letter| parts(letter).into_iter().map(|(text, _, rise)| (text, rise)).collect::<Vec<_>>();
        assert_eq!(of("a12"), [("a".into(), 0.0), ("12".into(), -BELOW)]);
        assert_eq!(of("b1^-1"), [("b".into(), 0.0), ("1".into(), -BELOW), ("−1".into(), ABOVE)]);
        assert_eq!(of("1"), [("1".into(), 0.0)]);
    }

    #[test]
    fn words_are_as_wide_as_their_letters() {
        let width = |word| lettering(word, 900.0).1;
        let (one, two) = (width("a1"), width("a1 a1"));
        assert!(one > 0.0 && (two - 2.0 * one - SPACE * HEIGHT[0] * 900.0).abs() < 1e-9, "{one} {two}");
        let strokes = lettering("a1 b1^-1", 900.0).0;
        assert!(strokes.iter().flat_map(|s| s.0).all(|[x, _]| x >= -1e-9 && x <= width("a1 b1^-1") + 1e-9));
    }
}
