//! Lettering as outlines of a font that the command contains, so that a picture looks the same on every machine.

use super::sheet::SvgPath;
use ttf_parser::{Face, OutlineBuilder};

/// STIX Two Text, its Latin letters, digits and signs.
const UPRIGHT: &[u8] = include_bytes!("fonts/STIXTwoText-Regular.ttf");
/// Its italic letters.
const ITALIC: &[u8] = include_bytes!("fonts/STIXTwoText-Italic.ttf");

/// Height of capitals and half the height of letters like x, over the size of the font.
pub const CAPITALS: f64 = 0.657;
const MIDDLE: f64 = 0.235;
/// Size of numbers and exponents, and their distances from the middle of the line, over the size of the font.
const SMALL: f64 = 0.68;
const BELOW: f64 = 0.16;
const ABOVE: f64 = 0.36;
/// Space between the letters of a word in generators, over the size of the font.
const SPACE: f64 = 0.2;

/// Outlines of letters in pixels, y down, and the width of the line.
#[derive(Default)]
pub struct Lettering {
    pub path: SvgPath,
    pub width: f64,
}

/// A line of text that begins at x = 0 and stands on y = 0.
pub fn line(text: &str, size: f64) -> Lettering {
    let mut lettering = Lettering::default();
    lettering.write(text, UPRIGHT, size, 0.0);
    lettering
}

/// A word in generators, `a1 b2^-1` with the number below the exponent, that begins at x = 0 and is centred at y = 0.
pub fn word(word: &str, size: f64) -> Lettering {
    let mut lettering = Lettering::default();
    for letter in word.split_whitespace() {
        if lettering.width > 0.0 {
            lettering.width += SPACE * size;
        }
        let [name, number, exponent] = parts(letter);
        let font = if name.starts_with(char::is_alphabetic) { ITALIC } else { UPRIGHT };
        lettering.write(name, font, size, MIDDLE * size);
        let after = lettering.width;
        lettering.write(exponent, UPRIGHT, SMALL * size, (MIDDLE - ABOVE) * size);
        let widest = std::mem::replace(&mut lettering.width, after);
        lettering.write(number, UPRIGHT, SMALL * size, (MIDDLE + BELOW) * size);
        lettering.width = widest.max(lettering.width);
    }
    lettering
}

/// The name of a letter, its number and its exponent.
fn parts(letter: &str) -> [&str; 3] {
    let (name, exponent) = letter.strip_suffix("^-1").map_or((letter, ""), |name| (name, "−1"));
    let digits = name.find(|c: char| c.is_ascii_digit()).filter(|k| *k > 0).unwrap_or(name.len());
    [&name[..digits], &name[digits..], exponent]
}

impl Lettering {
    fn write(&mut self, text: &str, font: &[u8], size: f64, y: f64) {
        let Ok(face) = Face::parse(font, 0) else { return };
        let scale = size / f64::from(face.units_per_em());
        for character in text.chars() {
            let glyph = face.glyph_index(character).unwrap_or_default();
            let mut pen = Pen { path: &mut self.path, scale, at: [self.width, y] };
            face.outline_glyph(glyph, &mut pen);
            self.width += scale * f64::from(face.glyph_hor_advance(glyph).unwrap_or_default());
        }
    }
}

struct Pen<'a> {
    path: &'a mut SvgPath,
    scale: f64,
    at: [f64; 2],
}

impl Pen<'_> {
    fn add(&mut self, command: char, points: &[[f32; 2]]) {
        let at = |[x, y]: &[f32; 2]| {
            [self.at[0] + self.scale * f64::from(*x), self.at[1] - self.scale * f64::from(*y)]
        };
        self.path.command(command, &points.iter().map(at).collect::<Vec<_>>());
    }
}

impl OutlineBuilder for Pen<'_> {
    fn move_to(&mut self, x: f32, y: f32) {
        self.add('M', &[[x, y]]);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.add('L', &[[x, y]]);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.add('Q', &[[x1, y1], [x, y]]);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.add('C', &[[x1, y1], [x2, y2], [x, y]]);
    }

    fn close(&mut self) {
        self.add('Z', &[]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_have_a_number_and_an_exponent_over_one_another() {
        assert_eq!(parts("a12"), ["a", "12", ""]);
        assert_eq!(parts("b1^-1"), ["b", "1", "−1"]);
        assert_eq!(parts("1"), ["1", "", ""]);
        assert!(word("b1^-1", 20.0).width < word("b1", 20.0).width + line("1", 20.0).width);
    }

    #[test]
    fn the_fonts_have_every_character_that_is_written() {
        let [upright, italic] = [UPRIGHT, ITALIC].map(|font| Face::parse(font, 0).unwrap());
        for c in (' '..='~').chain("−²".chars()) {
            assert!(upright.glyph_index(c).is_some(), "{c}");
        }
        assert!(('a'..='z').all(|c| italic.glyph_index(c).is_some()));
        assert!((f64::from(upright.capital_height().unwrap()) / 1000.0 - CAPITALS).abs() < 1e-3);
    }

    #[test]
    fn words_are_as_wide_as_their_letters() {
        let width = |text| word(text, 20.0).width;
        assert!((width("a1 a1") - 2.0 * width("a1") - 20.0 * SPACE).abs() < 1e-9);
        assert!(width("a1") > 0.0 && line("", 20.0).width == 0.0);
    }
}
