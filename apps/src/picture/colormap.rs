//! Colour maps, and the ranges of numbers that they cover.

use super::color::{Rgb, from_hex, mix};
use super::vector::ends;

/// A colour map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ramp {
    /// For amounts: viridis \[SW15\], ten of its 256 colours.
    Viridis,
    /// For signed quantities: ColorBrewer's RdBu \[HB03\], blue for negative.
    BlueRed,
    /// For pairs of classes, k for hue k/4 and shade k mod 4: ColorBrewer's Set2 \[HB03\], four of its colours.
    Pairs,
    /// For classes, [`HUES`] of them: ColorBrewer's Set2 \[HB03\].
    Hues,
    /// Light and dark stripes in turn, [`STRIPES`] of them.
    Stripes,
}

const VIRIDIS: [u32; 10] =
    [0x440154, 0x482878, 0x3e4a89, 0x31688e, 0x26828e, 0x1f9e89, 0x35b779, 0x6dcd59, 0xb4de2c, 0xfde725];
const BLUE_RED: [u32; 11] = [
    0x053061, 0x2166ac, 0x4393c3, 0x92c5de, 0xd1e5f0, 0xf7f7f7, 0xfddbc7, 0xf4a582, 0xd6604d, 0xb2182b,
    0x67001f,
];
const SET2: [u32; HUES] = [0x66c2a5, 0xfc8d62, 0x8da0cb, 0xe78ac3, 0xa6d854, 0xffd92f, 0xe5c494, 0xb3b3b3];
/// Colours of [`Ramp::Hues`].
pub const HUES: usize = 8;
/// Share of white in each shade.
const SHADES: [f64; 4] = [0.0, 0.42, 0.64, 0.22];
/// Hues, and shades of each, of [`Ramp::Pairs`].
pub const CLASSES: usize = 4;
/// Stripes of [`Ramp::Stripes`]: over half a turn each takes 10 degrees.
pub const STRIPES: usize = 18;
const STRIPE_COLORS: [u32; 2] = [0xf7f7f2, 0x22303f];
/// The colour of places without a value.
pub const NO_VALUE: Rgb = [0.4; 3];
/// The ends of a range are these percentiles of the data: a few extreme values do not take all the colours.
pub const PERCENTILES: [f64; 2] = [2.0, 98.0];
/// Where a percentile of [`PERCENTILES`] is farther from the middle than this many times the quartile, the range ends there instead, so
/// that most of the colours are left to most of the values.
const TAIL: f64 = 4.0;

impl Ramp {
    /// The number of classes, for a map of classes.
    pub fn classes(self) -> Option<usize> {
        match self {
            Ramp::Pairs => Some(CLASSES * CLASSES),
            Ramp::Hues => Some(HUES),
            Ramp::Viridis | Ramp::BlueRed | Ramp::Stripes => None,
        }
    }

    /// The colour at t, which is clamped to [0, 1].
    pub fn color(self, t: f64) -> Rgb {
        if t.is_nan() {
            return NO_VALUE;
        }
        let table: &[u32] = match self {
            Ramp::Viridis => &VIRIDIS,
            Ramp::BlueRed => &BLUE_RED,
            Ramp::Pairs => {
                let k = (t.clamp(0.0, 1.0) * (CLASSES * CLASSES - 1) as f64).round() as usize;
                return mix(from_hex(SET2[k / CLASSES]), [1.0; 3], SHADES[k % CLASSES]);
            }
            Ramp::Hues => return from_hex(SET2[(t.clamp(0.0, 1.0) * (HUES - 1) as f64).round() as usize]),
            Ramp::Stripes => {
                let k = ((t.clamp(0.0, 1.0) * STRIPES as f64) as usize).min(STRIPES - 1);
                return from_hex(STRIPE_COLORS[k % 2]);
            }
        };
        let x = t.clamp(0.0, 1.0) * (table.len() - 1) as f64;
        let k = (x as usize).min(table.len() - 2);
        mix(from_hex(table[k]), from_hex(table[k + 1]), x - k as f64)
    }
}

/// The colours of a quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct ColorScale {
    /// The name of the quantity, with its unit.
    pub title: String,
    pub ramp: Ramp,
    /// The numbers at the ends of the map.
    pub range: [f64; 2],
    /// A remark on the ends of the range.
    pub ends: String,
}

impl ColorScale {
    /// For amounts: between the percentiles of the data.
    pub fn of_amounts(title: &str, values: &[f64]) -> ColorScale {
        let middle = percentile(values, 50.0).unwrap_or(0.0);
        let [low, high] = PERCENTILES;
        let range = [[low, 25.0], [high, 75.0]].map(|percents| end(values, middle, percents));
        ColorScale { title: title.into(), ramp: Ramp::Viridis, range, ends: clipping(values, range) }
    }

    /// For signed quantities: as far to both sides of 0 as the upper percentile of the absolute values.
    pub fn of_signed(title: &str, values: &[f64]) -> ColorScale {
        let sizes: Vec<f64> = values.iter().map(|x| x.abs()).collect();
        let most = end(&sizes, 0.0, [PERCENTILES[1], 75.0]);
        let range = [-most, most];
        ColorScale { title: title.into(), ramp: Ramp::BlueRed, range, ends: clipping(values, range) }
    }

    /// For pairs of classes.
    pub fn of_pairs(title: &str, ends: &str) -> ColorScale {
        let range = [0.0, (CLASSES * CLASSES - 1) as f64];
        ColorScale { title: title.into(), ramp: Ramp::Pairs, range, ends: ends.into() }
    }

    /// For classes that are numbers from 0 to below [`HUES`].
    pub fn of_hues(title: &str, ends: &str) -> ColorScale {
        ColorScale {
            title: title.into(),
            ramp: Ramp::Hues,
            range: [0.0, (HUES - 1) as f64],
            ends: ends.into(),
        }
    }

    /// For stripes of equal width over a range.
    pub fn of_stripes(title: &str, range: [f64; 2], ends: &str) -> ColorScale {
        ColorScale { title: title.into(), ramp: Ramp::Stripes, range, ends: ends.into() }
    }

    /// The place of a value on the map, in [0, 1]; NaN for NaN.
    pub fn place(&self, value: f64) -> f64 {
        let [low, high] = self.range;
        let t = if high > low { (value - low) / (high - low) } else { 0.5 + 0.0 * value };
        t.clamp(0.0, 1.0)
    }

    /// The colour of the legend's bar at t in [0, 1]: classes take equal parts of it.
    pub fn on_bar(&self, t: f64) -> Rgb {
        let class = |n: usize| (t * n as f64).floor() / (n - 1) as f64;
        self.ramp.color(self.ramp.classes().map_or(t, class))
    }

    /// The map as a table of `n` colours.
    pub fn table(&self, n: usize) -> Vec<Rgb> {
        (0..n).map(|k| self.ramp.color(k as f64 / (n - 1).max(1) as f64)).collect()
    }

    /// Round numbers inside the range, away from its ends, which are written too.
    pub fn ticks(&self) -> Vec<f64> {
        let [low, high] = self.range;
        let width = high - low;
        if !(width > 0.0 && width.is_finite()) {
            return Vec::new();
        }
        let power = 10f64.powf((width / 4.0).log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0].map(|x| x * power).into_iter().find(|s| width / s <= 5.0);
        let Some(step) = step else { return Vec::new() };
        let first = (low / step).ceil();
        let inside = |x: &f64| (x - low).min(high - x) > 0.13 * width;
        (0..8).map(|k| (first + f64::from(k)) * step).filter(inside).collect()
    }
}

/// The end of the range on one side of the middle. `percents`: the percentile of the end, and that of the quartile.
fn end(values: &[f64], middle: f64, percents: [f64; 2]) -> f64 {
    let [far, quartile] = percents.map(|p| percentile(values, p).unwrap_or(middle) - middle);
    let short = quartile != 0.0 && far.abs() > TAIL * quartile.abs();
    middle + if short { TAIL * quartile } else { far }
}

/// A remark on the share of the values that lie outside a range, and how far they reach.
fn clipping(values: &[f64], [low, high]: [f64; 2]) -> String {
    let finite = values.iter().copied().filter(|x| x.is_finite());
    let beyond = finite.clone().filter(|x| *x < low || *x > high).count();
    if beyond == 0 {
        return "all values lie within the colours".into();
    }
    let percent = 100.0 * beyond as f64 / finite.clone().count() as f64;
    let [least, most] = ends(finite).map(number);
    format!("{percent:.1}% of the values are clipped, all reach from {least} to {most}")
}

/// The value that this percentage of the finite values does not exceed; none if there are no values.
pub fn percentile(values: &[f64], percent: f64) -> Option<f64> {
    let mut sorted: Vec<f64> = values.iter().copied().filter(|x| x.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    let rank = (percent / 100.0 * sorted.len() as f64).ceil() as usize;
    sorted.get(rank.saturating_sub(1)).copied()
}

/// A number with three digits, without needless zeros.
pub fn number(x: f64) -> String {
    let short = if (1e2..1e5).contains(&x.abs()) { format!("{x:.0}") } else { format!("{x:.2e}") };
    let x = short.parse().ok().filter(|x: &f64| x.is_finite()).unwrap_or(0.0) + 0.0;
    let plain = x == 0.0 || (1e-3..1e5).contains(&x.abs());
    if plain { format!("{x}") } else { format!("{x:e}") }.replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_end_at_the_percentiles() {
        // 1 … 100 in any order, and one value that is none.
        let mut values: Vec<f64> = (0..100).map(|k| f64::from((k * 37) % 100 + 1)).collect();
        values.push(f64::NAN);
        assert_eq!(ColorScale::of_amounts("x", &values).range, [2.0, 98.0]);
        assert_eq!(percentile(&values, 100.0), Some(100.0));
        let signed: Vec<f64> = values.iter().map(|x| if *x > 50.0 { -x } else { *x }).collect();
        assert_eq!(ColorScale::of_signed("x", &signed).range, [-98.0, 98.0]);
        assert_eq!(percentile(&[], 50.0), None);
        // A tenth of the values far out leaves the colours to the others, but for where these are all the same.
        let tail =
            |bulk: fn(u32) -> f64| (0..100).map(|k| if k < 90 { bulk(k) } else { 1e6 }).collect::<Vec<_>>();
        assert_eq!(ColorScale::of_signed("x", &tail(f64::from)).range, [-296.0, 296.0]);
        assert_eq!(ColorScale::of_amounts("x", &tail(f64::from)).range, [1.0, 149.0]);
        assert_eq!(ColorScale::of_amounts("x", &tail(|_| 1.0)).range, [1.0, 1e6]);
        // Where colours are clipped the scale says so, and how far the values reach.
        let ends = |values: &[f64]| ColorScale::of_amounts("x", values).ends;
        assert_eq!(ends(&values), "3.0% of the values are clipped, all reach from 1 to 100");
        assert_eq!(ends(&[3.0, 4.0]), "all values lie within the colours");
    }

    #[test]
    fn maps_are_monotone_in_lightness_and_signed_ones_are_white_in_the_middle() {
        let lightness = |c: Rgb| 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
        let viridis = |k: i32| lightness(Ramp::Viridis.color(f64::from(k) / 50.0));
        assert!((0..50).all(|k| viridis(k) < viridis(k + 1)));
        let signed = |k: i32| lightness(Ramp::BlueRed.color(0.5 + f64::from(k) / 100.0));
        assert!((0..50).all(|k| signed(k) > signed(k + 1) && signed(-k) > signed(-k - 1)));
        assert!(
            Ramp::BlueRed.color(ColorScale::of_signed("x", &[-1.0, 2.0]).place(0.0)).iter().all(|c| *c > 0.9)
        );
    }

    #[test]
    fn classes_have_colours_of_their_own() {
        let scale = ColorScale::of_pairs("", "");
        let n = CLASSES * CLASSES;
        let of = |k: usize| scale.ramp.color(scale.place(k as f64));
        for k in 0..n {
            assert!((0..k).all(|j| (0..3).any(|c| (of(k)[c] - of(j)[c]).abs() > 0.01)), "{k}");
            assert_eq!(scale.on_bar((k as f64 + 0.9) / n as f64), of(k));
            // Tables in which values are looked up keep classes apart.
            let table = scale.table(40);
            assert_eq!(table[(scale.place(k as f64) * 39.0 + 0.5) as usize], of(k));
        }
    }

    #[test]
    fn stripes_alternate_and_are_equally_wide() {
        let scale = ColorScale::of_stripes("", [0.0, 180.0], "");
        let of = |x: f64| scale.ramp.color(scale.place(x));
        let wide = 180.0 / STRIPES as f64;
        for k in 1..STRIPES {
            let edge = k as f64 * wide;
            assert_eq!(of(edge + 0.01), of(edge + wide - 0.01), "{k}");
            assert!((of(edge - 0.01)[0] - of(edge + 0.01)[0]).abs() > 0.5, "{k}");
        }
        assert_eq!(of(180.0), of(179.9));
    }

    #[test]
    fn numbers_have_three_digits() {
        let cases = [
            (0.0, "0"),
            (-1.5, "−1.5"),
            (1234.5, "1234"),
            (0.001234, "0.00123"),
            (6.02e23, "6.02e23"),
            (-1e-7, "−1e−7"),
        ];
        for (x, text) in cases {
            assert_eq!(number(x), text);
        }
    }

    #[test]
    fn ticks_are_round_and_inside() {
        let scale =
            ColorScale { title: String::new(), ramp: Ramp::Viridis, range: [0.0, 1.0], ends: String::new() };
        assert_eq!(scale.ticks(), [0.2, 0.4, 0.6000000000000001, 0.8]);
        assert!(ColorScale { range: [2.0, 2.0], ..scale }.ticks().is_empty());
    }
}
