//! The share of a surface laid out in the plane that lies on other parts of it.
//!
//! Where no triangle is turned over, the number of points of the surface over a point of the plane is the winding number of the surface's
//! boundary around it. So the boundary alone tells how much is covered more than once, without a test of triangles.
//!
//! ```
//! use ricci::geometry::cover_share::covered_again;
//! let square = |x: f64| [[x, 0.0], [x + 1.0, 0.0], [x + 1.0, 1.0], [x, 1.0]];
//! let sides = |c: [[f64; 2]; 4]| [0, 1, 2, 3].map(|k| [c[k], c[(k + 1) % 4]]);
//! assert_eq!(covered_again(&sides(square(0.0))), 0.0);
//! let two: Vec<_> = [sides(square(0.0)), sides(square(0.5))].concat();
//! assert!((covered_again(&two) - 0.25).abs() < 1e-3);
//! ```

/// The number of lines in either direction along which a boundary's winding numbers are found. A part that is covered again is seen unless
/// it lies between two lines of both directions, so unless it is narrower than this part of the surface's height and width.
const LINES: usize = 1024;

/// The share of the area of a surface in the plane that is covered more than once: 1 − (area of its image) / (its area). `sides`: the
/// directed sides of its boundary, with the surface on their left. The areas are those along 1,024 horizontal and as many vertical lines;
/// the result is the larger of both shares.
pub fn covered_again(sides: &[[[f64; 2]; 2]]) -> f64 {
    // A quarter turn keeps the surface on the left.
    let turned: Vec<[[f64; 2]; 2]> = sides.iter().map(|side| side.map(|[x, y]| [-y, x])).collect();
    along_lines(sides).max(along_lines(&turned))
}

/// [`covered_again`] along horizontal lines.
fn along_lines(sides: &[[[f64; 2]; 2]]) -> f64 {
    let heights = || sides.iter().flat_map(|side| side.iter().map(|p| p[1]));
    let (low, high) = (heights().fold(f64::INFINITY, f64::min), heights().fold(f64::NEG_INFINITY, f64::max));
    let step = (high - low) / LINES as f64;
    if !(step > 0.0 && step.is_finite()) {
        return 0.0;
    }
    let height = |line: usize| low + (line as f64 + 0.5) * step;
    // The line, the place on it, and by how much the winding number grows from left to right there.
    let mut met: Vec<(usize, f64, i32)> = Vec::new();
    for &[p, q] in sides {
        let [bottom, top] = if p[1] < q[1] { [p, q] } else { [q, p] };
        let first = (((bottom[1] - low) / step - 1.0).max(0.0)) as usize;
        let lines = (first..LINES).skip_while(|&line| height(line) < bottom[1]);
        for line in lines.take_while(|&line| height(line) < top[1]) {
            let part = (height(line) - bottom[1]) / (top[1] - bottom[1]);
            let x = bottom[0] + part * (top[0] - bottom[0]);
            met.push((line, x, if p[1] < q[1] { -1 } else { 1 }));
        }
    }
    met.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).then(b.2.cmp(&a.2)));
    let (mut all, mut image, mut winding) = (0.0, 0.0, 0);
    for pair in met.windows(2) {
        winding += pair[0].2;
        if pair[0].0 != pair[1].0 {
            winding = 0;
        } else if winding > 0 {
            let length = pair[1].1 - pair[0].1;
            (all, image) = (all + f64::from(winding) * length, image + length);
        }
    }
    if all > 0.0 { ((all - image) / all).max(0.0) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// A ring that is opened and goes around `turns` times.
    fn ramp(turns: f64) -> Vec<[[f64; 2]; 2]> {
        let at = |r: f64, k: usize| {
            let angle = turns * TAU * k as f64 / 1000.0;
            [r * angle.cos(), r * angle.sin()]
        };
        let mut around: Vec<[f64; 2]> = (0..=1000).map(|k| at(2.0, k)).collect();
        around.extend((0..=1000).rev().map(|k| at(1.0, k)));
        (0..around.len()).map(|k| [around[k], around[(k + 1) % around.len()]]).collect()
    }

    #[test]
    fn a_ramp_of_one_and_a_half_turns_covers_a_third_of_itself_again() {
        assert_eq!(covered_again(&ramp(0.9)), 0.0);
        let share = covered_again(&ramp(1.5));
        assert!((share - 1.0 / 3.0).abs() < 1e-3, "{share}");
    }

    #[test]
    fn a_hole_and_a_slit_cover_nothing_again() {
        let square = |half: f64| [[-half, -half], [half, -half], [half, half], [-half, half]];
        let loop_of = |c: [[f64; 2]; 4]| [0, 1, 2, 3].map(|k| [c[k], c[(k + 1) % 4]]);
        let mut sides = loop_of(square(2.0)).to_vec();
        sides.extend(loop_of(square(1.0)).map(|[p, q]| [q, p]));
        sides.extend([[[1.0, 0.3], [2.0, 0.7]], [[2.0, 0.7], [1.0, 0.3]]]);
        assert!(covered_again(&sides) < 1e-12);
    }
}
