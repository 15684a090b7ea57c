//! The legend: a bar of colours with numbers, and what they are.

use super::Style;
use super::color::{INK, Rgb};
use super::colormap::{Ramp, Scale, number};
use super::font::text;
use super::raster::{Hit, Image, Painter, Shape, render};

/// Height of the legend and of its parts, over the size of a panel.
const HEIGHT: f64 = 0.142;
const BAR_TOP: f64 = 0.045;
const BAR_HEIGHT: f64 = 0.020;
const TICK: f64 = 0.008;
const LETTERS: f64 = 0.0165;
const SMALL: f64 = 0.0125;
/// Length of the bar.
const LENGTH: f64 = 0.62;

/// A legend is as large as for a panel of this many pixels at least, to be read.
const LEAST: f64 = 560.0;

/// Where the parts of a legend are, in pixels of an image of this width: the same in raster and vector pictures.
pub struct Plan {
    pub height: f64,
    /// Left, top, width, height.
    pub bar: [f64; 4],
    /// Text with the middle of the line it stands on and the height of its letters.
    pub lines: Vec<(String, [f64; 2], f64)>,
    /// x of the ticks.
    pub ticks: Vec<f64>,
    pub tick: f64,
}

impl Plan {
    pub fn new(scale: &Scale, width: f64, size: f64) -> Plan {
        let size = size.max(LEAST);
        let length = (LENGTH * size).min(0.8 * width);
        let bar = [0.5 * (width - length), BAR_TOP * size, length, BAR_HEIGHT * size];
        let [low, high] = scale.range;
        let place = |v: f64| {
            let t = if high > low { (v - low) / (high - low) } else { 0.5 };
            bar[0] + length * t
        };
        let mut values = vec![low];
        values.extend(scale.ticks());
        values.extend((high > low).then_some(high));
        // Classes have no numbers.
        values.retain(|_| scale.ramp != Ramp::Pairs);
        let below = bar[1] + bar[3] + (TICK + 1.35 * LETTERS) * size;
        let mut lines: Vec<_> =
            values.iter().map(|&v| (number(v), [place(v), below], LETTERS * size)).collect();
        let middle = 0.5 * width;
        lines.push((scale.title.clone(), [middle, bar[1] - 0.9 * LETTERS * size], LETTERS * size));
        lines.push((format!("({})", scale.ends), [middle, below + 1.9 * SMALL * size], SMALL * size));
        let ticks = values.into_iter().map(place).collect();
        Plan { height: (HEIGHT * size).ceil(), bar, lines, ticks, tick: TICK * size }
    }
}

/// Draw a legend as wide as the picture.
pub fn draw(scale: &Scale, width: usize, style: &Style) -> Image {
    let size = style.size;
    let plan = Plan::new(scale, width as f64, size as f64);
    let mut shapes = Vec::new();
    for (line, [x, y], height) in &plan.lines {
        let (strokes, length) = text(line, *height);
        shapes.extend(strokes.into_iter().map(|s| moved(s, [x - 0.5 * length, *y])));
    }
    let bottom = plan.bar[1] + plan.bar[3];
    let radius = 0.0006 * size as f64;
    shapes.extend(plan.ticks.iter().map(|&x| Shape::Capsule {
        ends: [[x, bottom, 0.0], [x, bottom + plan.tick, 0.0]],
        radius: radius.max(0.4),
    }));
    render(&shapes, width, plan.height as usize, &Ink { scale, bar: plan.bar }, style.threads)
}

fn moved(shape: Shape, by: [f64; 2]) -> Shape {
    let to = |p: [f64; 3]| [p[0] + by[0], p[1] + by[1], p[2]];
    match shape {
        Shape::Triangle(p) => Shape::Triangle(p.map(to)),
        Shape::Capsule { ends, radius } => Shape::Capsule { ends: ends.map(to), radius },
    }
}

struct Ink<'a> {
    scale: &'a Scale,
    bar: [f64; 4],
}

impl Painter for Ink<'_> {
    fn paint(&self, [x, y]: [f64; 2], hit: Option<&Hit>) -> Rgb {
        let [left, top, width, height] = self.bar;
        let inside = (0.0..=width).contains(&(x - left)) && (0.0..=height).contains(&(y - top));
        match hit {
            Some(_) => INK,
            None if inside => self.scale.on_bar((x - left) / width),
            None => [1.0; 3],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_numbers_at_the_ends_are_the_percentiles() {
        let values: Vec<f64> = (1..=1000).map(f64::from).collect();
        let scale = Scale::of_amounts("area", &values);
        let plan = Plan::new(&scale, 900.0, 900.0);
        let written: Vec<&str> = plan.lines.iter().map(|l| l.0.as_str()).collect();
        assert_eq!((written[0], written[written.len() - 3]), ("20", "980"));
        assert_eq!(written[written.len() - 2], "area");
        assert!((plan.ticks[0] - plan.bar[0]).abs() < 1e-9, "{:?}", plan.ticks);
        assert!((plan.ticks[plan.ticks.len() - 1] - plan.bar[0] - plan.bar[2]).abs() < 1e-9);
    }

    #[test]
    fn the_bar_runs_through_the_map() {
        let scale = Scale::of_amounts("a", &[0.0, 1.0]);
        let image = draw(&scale, 400, &Style { size: 400, ..Style::default() });
        let [left, top, width, height] = Plan::new(&scale, 400.0, 400.0).bar;
        let at = |t: f64| {
            let (x, y) = ((left + t * width) as usize, (top + 0.5 * height) as usize);
            let i = 3 * (y * image.width + x);
            [image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]]
        };
        // The violet and yellow ends of viridis.
        assert_eq!(image.height, (HEIGHT * LEAST).ceil() as usize);
        assert!(at(0.02)[2] > at(0.02)[1] && at(0.98)[0] > 220 && at(0.98)[2] < 80);
    }
}
