//! Packing of shapes into the unit square by their bounding rectangles, all with one scale.
//!
//! ```
//! use ricci::{Control, geometry::packing::pack};
//! # fn main() -> ricci::Result<()> {
//! let (scale, places) = pack(&[[2.0, 2.0]; 4], 0.0, &Control::new())?.unwrap();
//! assert!((scale - 0.25).abs() < 1e-4 && places.len() == 4);
//! # Ok(())
//! # }
//! ```

use super::complex::doubled_area;
use crate::control::Control;
use crate::error::Result;
use std::f64::consts::FRAC_PI_2;

/// Relative accuracy of the scale at which its search ends: a smaller gain is not visible.
const ACCURACY: f64 = 1e-4;
/// Number of rectangles above which only one order is tried, since packing takes the square of their number in the worst case.
const MANY: usize = 4000;
/// Number of rectangles after which the control is asked again whether to stop.
const RECTANGLES_PER_STEP: usize = 256;

/// The rectangle of least area around some points: the angle by which they have to be turned for its longer side to lie along x, and its
/// sides (longer, shorter).
///
/// One of its sides lies on a side of the convex hull, so these are tried. O(n log n).
pub fn least_rectangle(points: &[[f64; 2]]) -> (f64, [f64; 2]) {
    let hull = convex_hull(points);
    let n = hull.len();
    // Rotating calipers: the corners of the hull that are farthest along the side, away from it, and back along it.
    let at = |i: usize| hull[i % n];
    let (mut best, mut least) = (0.0, f64::INFINITY);
    let (mut right, mut far, mut left) = (1, 1, 1);
    for i in 0..n {
        let [p, q] = [at(i), at(i + 1)];
        let side = [q[0] - p[0], q[1] - p[1]];
        let length = side[0].hypot(side[1]);
        if length == 0.0 {
            continue;
        }
        let d = side.map(|x| x / length);
        let along = |j: usize| d[0] * (at(j)[0] - p[0]) + d[1] * (at(j)[1] - p[1]);
        let away = |j: usize| d[0] * (at(j)[1] - p[1]) - d[1] * (at(j)[0] - p[0]);
        right = right.max(i + 1);
        while right < i + n && along(right + 1) > along(right) {
            right += 1;
        }
        far = far.max(right);
        while far < i + n && away(far + 1) > away(far) {
            far += 1;
        }
        left = left.max(far);
        while left < i + n && along(left + 1) < along(left) {
            left += 1;
        }
        let area = (along(right) - along(left)) * away(far);
        if area < least {
            (best, least) = (-d[1].atan2(d[0]), area);
        }
    }
    lengthwise(&hull, best)
}

/// Number of angles between 0 and π/2 at which the least square is searched before the best one is refined.
const SQUARE_ANGLES: usize = 180;
/// Number of halvings of the step in that refinement.
const SQUARE_STEPS: usize = 20;

/// The angle by which some points have to be turned to fit into the smallest square along the axes, and their extents then, the longer
/// along x. A long thin shape lies along the diagonal. O(n log n).
pub fn least_square(points: &[[f64; 2]]) -> (f64, [f64; 2]) {
    let hull = convex_hull(points);
    let side = |angle: f64| {
        let [x, y] = extent(&hull, angle);
        x.max(y)
    };
    let mut step = FRAC_PI_2 / SQUARE_ANGLES as f64;
    let best = |angles: &mut dyn Iterator<Item = f64>| {
        angles.map(|a| (side(a), a)).reduce(|a, b| if b.0 < a.0 { b } else { a }).map_or(0.0, |b| b.1)
    };
    let mut angle = best(&mut (0..SQUARE_ANGLES).map(|k| k as f64 * step));
    for _ in 0..SQUARE_STEPS {
        step *= 0.5;
        angle = best(&mut [angle, angle - step, angle + step].into_iter());
    }
    lengthwise(&hull, angle)
}

/// The extents along x and y after a turn by an angle.
fn extent(points: &[[f64; 2]], angle: f64) -> [f64; 2] {
    let (s, c) = angle.sin_cos();
    let range = points.iter().fold([[f64::INFINITY, f64::NEG_INFINITY]; 2], |r, &[x, y]| {
        let turned = [c * x - s * y, s * x + c * y];
        [0, 1].map(|k| [r[k][0].min(turned[k]), r[k][1].max(turned[k])])
    });
    range.map(|[low, high]| high - low)
}

/// The angle, plus π/2 if the longer extent would lie along y, and the extents then.
fn lengthwise(points: &[[f64; 2]], angle: f64) -> (f64, [f64; 2]) {
    let [x, y] = extent(points, angle);
    if x >= y { (angle, [x, y]) } else { (angle + FRAC_PI_2, [y, x]) }
}

/// The corners of the convex hull, counterclockwise (Andrew's monotone chain).
pub fn convex_hull(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|p, q| p[0].total_cmp(&q[0]).then(p[1].total_cmp(&q[1])));
    sorted.dedup();
    let turn = |a, b, c| doubled_area([a, b, c]);
    let chain = |points: &mut dyn Iterator<Item = [f64; 2]>| {
        let mut chain: Vec<[f64; 2]> = Vec::new();
        for p in points {
            while chain.len() >= 2 && turn(chain[chain.len() - 2], chain[chain.len() - 1], p) <= 0.0 {
                chain.pop();
            }
            chain.push(p);
        }
        chain
    };
    let mut hull = chain(&mut sorted.iter().copied());
    let upper = chain(&mut sorted.iter().rev().copied());
    hull.pop();
    hull.extend(&upper[..upper.len().saturating_sub(1)]);
    if hull.is_empty() { sorted } else { hull }
}

/// The place of a packed rectangle.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RectanglePlace {
    /// The lower left corner.
    pub at: [f64; 2],
    /// True if the rectangle is turned by π/2, so that its longer side is upright.
    pub turned: bool,
}

/// The largest scale that is found for rectangles with these sides, and their places in the unit square at that scale: `margin` apart and
/// half of that from the border. `None` if there are too many for the margin, or all are points.
///
/// The scale is found by bisection. At each scale the rectangles are placed by skyline packing \[Jyl10\]: in the order of their size, each
/// where its upper side lies lowest, turned by π/2 or not.
///
/// # Errors
/// [`crate::Error::Cancelled`].
pub fn pack(
    sides: &[[f64; 2]],
    margin: f64,
    control: &Control,
) -> Result<Option<(f64, Vec<RectanglePlace>)>> {
    let area: f64 = sides.iter().map(|s| s[0] * s[1]).sum();
    let longest = sides.iter().fold(0.0f64, |m, s| m.max(s[0]).max(s[1]));
    let mut high = ((1.0 - margin) / longest).min(1.0 / area.sqrt());
    if !(high > 0.0 && high.is_finite()) {
        return Ok(None);
    }
    let size: [fn([f64; 2]) -> f64; 3] = [|s| s[0].max(s[1]), |s| s[0].min(s[1]), |s| s[0] + s[1]];
    let tried = if sides.len() > MANY { 1 } else { size.len() };
    let orders: Vec<Vec<usize>> = size[..tried]
        .iter()
        .map(|size| {
            let mut order: Vec<usize> = (0..sides.len()).collect();
            order.sort_by(|&i, &j| size(sides[j]).total_cmp(&size(sides[i])).then(i.cmp(&j)));
            order
        })
        .collect();
    let fit = |scale: f64| -> Result<Option<Vec<RectanglePlace>>> {
        for order in &orders {
            if let Some(places) = skyline(sides, order, scale, margin, control)? {
                return Ok(Some(places));
            }
        }
        Ok(None)
    };
    if let Some(places) = fit(high)? {
        return Ok(Some((high, places)));
    }
    if fit(0.0)?.is_none() {
        return Ok(None);
    }
    let (mut low, mut best) = (0.0, None);
    while high - low > ACCURACY * high {
        let scale = 0.5 * (low + high);
        match fit(scale)? {
            Some(places) => (low, best) = (scale, Some((scale, places))),
            None => high = scale,
        }
        if high < f64::MIN_POSITIVE {
            return Ok(None);
        }
    }
    Ok(best)
}

/// A step of the skyline, the upper outline of the packed rectangles: it reaches from `x` to the `x` of the next step at height `y`.
#[derive(Clone, Copy)]
struct SkylineStep {
    x: f64,
    y: f64,
}

/// The places of the rectangles at this scale, in this order, or `None` if not all fit.
fn skyline(
    sides: &[[f64; 2]],
    order: &[usize],
    scale: f64,
    margin: f64,
    control: &Control,
) -> Result<Option<Vec<RectanglePlace>>> {
    let mut places = vec![RectanglePlace::default(); sides.len()];
    let mut outline = vec![SkylineStep { x: 0.0, y: 0.0 }];
    for (done, &i) in order.iter().enumerate() {
        if done.is_multiple_of(RECTANGLES_PER_STEP) {
            control.check()?;
        }
        let [long, short] = sides[i].map(|s| scale * s + margin);
        let mut best: Option<([f64; 2], usize, f64, bool)> = None;
        for turned in [false, true] {
            let (width, height) = if turned { (short, long) } else { (long, short) };
            for first in 0..outline.len() {
                let x = outline[first].x;
                if x + width > 1.0 {
                    break;
                }
                let under = outline[first..].iter().take_while(|step| step.x < x + width);
                let y = under.map(|step| step.y).fold(0.0, f64::max);
                let top = y + height;
                let lower = best.as_ref().is_none_or(|&([_, y], _, height, _)| top < y + height);
                if top <= 1.0 && lower {
                    best = Some(([x, y], first, height, turned));
                }
            }
        }
        let Some((at, first, height, turned)) = best else { return Ok(None) };
        let width = if turned { short } else { long };
        places[i] = RectanglePlace { at: at.map(|x| x + 0.5 * margin), turned };
        let end = at[0] + width;
        // The steps under the rectangle are replaced by its upper side; the last of them may reach beyond it.
        let covered = outline[first..].iter().take_while(|step| step.x < end).count();
        let last = outline[first + covered - 1];
        let next = outline.get(first + covered).map_or(1.0, |step| step.x);
        let mut new = vec![SkylineStep { x: at[0], y: at[1] + height }];
        if next > end {
            new.push(SkylineStep { x: end, y: last.y });
        }
        outline.splice(first..first + covered, new);
    }
    Ok(Some(places))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::random::SplitMix64;

    #[test]
    fn the_least_rectangle_is_no_larger_than_at_any_angle() {
        let mut random = SplitMix64::new(3);
        for n in [1, 2, 3, 4, 10, 200] {
            let points: Vec<[f64; 2]> = (0..n).map(|_| [random.unit(), 0.4 * random.unit()]).collect();
            let extent = |angle: f64| {
                let (s, c) = angle.sin_cos();
                let range = |x: Vec<f64>| {
                    x.iter().fold(f64::NEG_INFINITY, |m, x| m.max(*x))
                        - x.iter().fold(f64::INFINITY, |m, x| m.min(*x))
                };
                let turned = |p: &[f64; 2]| [c * p[0] - s * p[1], s * p[0] + c * p[1]];
                [0, 1].map(|k| range(points.iter().map(|p| turned(p)[k]).collect()))
            };
            let (angle, [long, short]) = least_rectangle(&points);
            assert!(long >= short);
            let [x, y] = extent(angle);
            assert!((x - long).abs() < 1e-12 && (y - short).abs() < 1e-12, "n = {n}");
            for k in 0..1000 {
                let [x, y] = extent(k as f64 * 0.01);
                assert!(long * short <= x * y + 1e-12, "n = {n}: {} at angle {}", x * y, k as f64 * 0.01);
            }
        }
    }

    #[test]
    fn a_thin_shape_lies_along_the_diagonal() {
        let (angle, [x, y]) = least_square(&[[0.0, 0.0], [10.0, 0.0], [10.0, 0.1], [0.0, 0.1]]);
        assert!((x - 10.1 / 2f64.sqrt()).abs() < 1e-4 && (y - x).abs() < 1e-4, "{x} {y}");
        assert!((angle.abs() % FRAC_PI_2 - 0.5 * FRAC_PI_2).abs() < 1e-4, "{angle}");
        let (_, [x, y]) = least_square(&[[0.0, 0.0], [3.0, 0.0], [3.0, 3.0], [0.0, 3.0]]);
        assert_eq!([x, y], [3.0, 3.0]);
    }

    #[test]
    fn packed_rectangles_keep_their_distance() {
        let mut random = SplitMix64::new(8);
        for (n, margin) in [(1, 0.01), (2, 0.0), (17, 0.01), (300, 0.002)] {
            let sides: Vec<[f64; 2]> = (0..n)
                .map(|_| {
                    let long = 3.0 * random.unit() + 0.1;
                    [long, long * random.unit()]
                })
                .collect();
            let (scale, places) = pack(&sides, margin, &Control::new()).unwrap().unwrap();
            let area: f64 = sides.iter().map(|s| s[0] * s[1]).sum::<f64>() * scale * scale;
            assert!(n < 10 || area > 0.6, "{area}");
            let boxes: Vec<[f64; 4]> = places
                .iter()
                .zip(&sides)
                .map(|(p, s)| {
                    let [w, h] = if p.turned { [s[1], s[0]] } else { *s };
                    [p.at[0], p.at[1], p.at[0] + scale * w, p.at[1] + scale * h]
                })
                .collect();
            let eps = 1e-12;
            for (i, a) in boxes.iter().enumerate() {
                assert!(a.iter().all(|&x| x >= 0.5 * margin - eps && x <= 1.0 - 0.5 * margin + eps));
                for b in &boxes[..i] {
                    let gap = [b[0] - a[2], a[0] - b[2], b[1] - a[3], a[1] - b[3]];
                    assert!(gap.iter().any(|&g| g >= margin - eps), "{a:?} {b:?}");
                }
            }
        }
    }

    #[test]
    fn a_square_fills_the_square_and_too_much_margin_is_refused() {
        let (scale, places) = pack(&[[2.0, 2.0]], 0.0, &Control::new()).unwrap().unwrap();
        assert_eq!((scale, places[0].at), (0.5, [0.0; 2]));
        let packs = |sides: &[[f64; 2]], margin| pack(sides, margin, &Control::new()).unwrap().is_some();
        assert!(!packs(&[[1.0, 1.0]; 26], 0.2));
        assert!(packs(&[[1.0, 1.0]; 16], 0.2));
        assert!(!packs(&[[0.0, 0.0]], 0.1));
    }
}
