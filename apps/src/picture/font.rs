//! Lettering of our own: each character as strokes of a round pen.
//!
//! A stroke is a list of points `xy`, one digit each, on a grid where letters stand on y = 2, small ones reach y = 6 and
//! tall ones y = 8. `~` makes it a quadratic B-spline that begins and ends at its first and last point, `@` a closed one.

use super::raster::Shape;

/// Grid units from the line that letters stand on to the top of tall ones.
const TALL: f64 = 6.0;
/// Half the width of the pen, grid units.
const PEN: f64 = 0.36;
/// Between characters, and for a space.
const GAP: f64 = 1.9;
const SPACE: f64 = 2.2;
/// Points per piece of a curve.
const PIECES: usize = 6;

fn strokes(character: char) -> &'static str {
    match character {
        '0' => "@08484202",
        '1' => "062822",
        '2' => "~0608484502 0242",
        '3' => "~0708484515 ~1545420203",
        '4' => "32380444",
        '5' => "480805 ~051646421202",
        '6' => "@06464202 ~040838",
        '7' => "084812",
        '8' => "@08484505 @05454202",
        '9' => "@08484404 ~464212",
        'a' => "@06464202 4642",
        'b' => "0802 @06464202",
        'c' => "~454606024243",
        'd' => "4842 @06464202",
        'e' => "0444 ~444606024243",
        'f' => "~381815 1512 0636",
        'g' => "@06464202 4642 ~42400001",
        'h' => "0802 ~04064644 4442",
        'i' => "0602 0808",
        'j' => "1612 ~121000 1818",
        'k' => "0802 4604 2542",
        'l' => "0802",
        'm' => "0602 ~04063634 3432 ~34366664 6462",
        'n' => "0602 ~04064644 4442",
        'o' => "@06464202",
        'p' => "0600 @06464202",
        'q' => "4640 @06464202",
        'r' => "0602 ~040636",
        's' => "~4546060444420203",
        't' => "1813 ~131232 0636",
        'u' => "0604 ~04024244 4642",
        'v' => "062246",
        'w' => "0612365266",
        'x' => "0642 4602",
        'y' => "0622 4610",
        'z' => "06460242",
        'A' => "022842 1434",
        'G' => "~474808024245 4525",
        'K' => "0802 4804 2642",
        '.' => "0202",
        ',' => "0201",
        '-' | '−' => "0434",
        '+' => "0444 2622",
        '/' => "0248",
        '%' => "0248 @08282606 @24444222",
        '(' => "~280420",
        ')' => "~082400",
        '²' => "~0809292705 0525",
        '|' => "0900",
        '=' => "0343 0545",
        _ => "",
    }
}

/// A line of text of tall letters `height` pixels high that begins at x = 0 and stands on y = 0, with its width.
pub fn text(line: &str, height: f64) -> (Vec<Shape>, f64) {
    let unit = height / TALL;
    let mut shapes = Vec::new();
    let mut x = 0.0;
    for character in line.chars() {
        let mut width: f64 = if strokes(character).is_empty() { SPACE } else { 0.0 };
        for stroke in strokes(character).split(' ') {
            let points = points(stroke);
            width = points.iter().map(|p| p[0]).fold(width, f64::max);
            let place = |p: [f64; 2]| [unit * (x + p[0]), unit * (2.0 - p[1]), 0.0];
            for pair in points.windows(2) {
                shapes.push(Shape::Capsule { ends: [place(pair[0]), place(pair[1])], radius: unit * PEN });
            }
        }
        x += width + GAP;
    }
    (shapes, unit * (x - GAP).max(0.0))
}

/// The points of a stroke, curves as polygons.
fn points(stroke: &str) -> Vec<[f64; 2]> {
    let digits: Vec<f64> = stroke.chars().filter_map(|c| c.to_digit(10)).map(f64::from).collect();
    let control: Vec<[f64; 2]> = digits.chunks_exact(2).map(|p| [p[0], p[1]]).collect();
    let closed = stroke.starts_with('@');
    if !(closed || stroke.starts_with('~')) || control.len() < 3 {
        return control;
    }
    let middle = |a: [f64; 2], b: [f64; 2]| [0, 1].map(|k| 0.5 * (a[k] + b[k]));
    let n = control.len();
    let corners: Vec<usize> = if closed { (0..n).collect() } else { (1..n - 1).collect() };
    let mut out = Vec::new();
    for &k in &corners {
        let (before, here, after) = (control[(k + n - 1) % n], control[k], control[(k + 1) % n]);
        let start = if !closed && k == 1 { before } else { middle(before, here) };
        let end = if !closed && k == n - 2 { after } else { middle(here, after) };
        for i in 0..PIECES {
            let t = i as f64 / PIECES as f64;
            let (a, b) = ((1.0 - t) * (1.0 - t), t * t);
            out.push([0, 1].map(|k| a * start[k] + (1.0 - a - b) * here[k] + b * end[k]));
        }
        if k == corners[corners.len() - 1] {
            out.push(end);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_character_of_the_legends_has_strokes() {
        let used = "abcdefghijklmnopqrstuvwxyz0123456789AGK.,-−+/%()²|=";
        for c in used.chars() {
            assert!(!strokes(c).is_empty(), "{c}");
            for stroke in strokes(c).split(' ') {
                let digits = stroke.trim_start_matches(['~', '@']);
                assert!(digits.len() % 2 == 0 && digits.len() >= 4, "{c}: {stroke}");
                assert!(points(stroke).len() >= 2, "{c}: {stroke}");
            }
        }
    }

    #[test]
    fn lines_are_as_wide_as_their_letters_and_curves_end_where_they_should() {
        let width = |line| text(line, 6.0).1;
        assert_eq!(width("oo"), 4.0 + GAP + 4.0);
        assert_eq!(width(""), 0.0);
        let curve = points("~040838");
        assert_eq!((curve[0], curve[curve.len() - 1]), ([0.0, 4.0], [3.0, 8.0]));
        // A closed curve returns to its start.
        let round = points("@06464202");
        assert_eq!(round[0], round[round.len() - 1]);
    }
}
