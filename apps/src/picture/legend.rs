//! The legend below a picture: the bar of colours with its numbers.

use super::Style;
use super::color::{INK, to_hex};
use super::colormap::{ColorScale, number};
use super::sheet::{SvgPath, VectorSheet};
use super::text::{CAPITALS, line};

/// Length and height of the bar, over the size of a panel.
const BAR: [f64; 2] = [0.62, 0.022];
/// Colours of the bar.
const STEPS: usize = 160;

/// The bar of colours of a quantity, with its title above and its numbers below.
pub fn bar(scale: &ColorScale, style: &Style) -> VectorSheet {
    let (size, letters) = (style.size as f64, style.letters());
    let [length, height] = [(BAR[0] * size).max(16.0 * letters), (BAR[1] * size).max(0.8 * letters)];
    let [title, top] = [1.3 * letters, 1.9 * letters];
    let [low, high] = scale.range;
    let place = |v: f64| if high > low { length * (v - low) / (high - low) } else { 0.5 * length };
    let mut values: Vec<f64> = [low].into_iter().chain(scale.ticks()).collect();
    values.extend((high > low).then_some(high));
    // Classes have no numbers.
    values.retain(|_| scale.ramp.classes().is_none());
    // The base line of the numbers; the remark on the ends stands below it.
    let below = top + height + if values.is_empty() { 0.0 } else { (0.45 + CAPITALS) * letters };
    // Lines of text, with the middle of the base line of each.
    let caption = |text: &str, size: f64, x: f64, y: f64| (text.to_string(), line(text, size), [x, y]);
    let ends = format!("({})", scale.ends);
    let mut captions = vec![
        caption(&scale.title, letters, 0.5 * length, title),
        caption(&ends, 0.8 * letters, 0.5 * length, below + 1.25 * letters),
    ];
    captions.extend(values.iter().map(|v| caption(&number(*v), letters, place(*v), below)));
    let reach =
        captions.iter().map(|(_, lettering, at)| (at[0] - 0.5 * length).abs() + 0.5 * lettering.width);
    let width = reach.fold(0.5 * length, f64::max) * 2.0 + letters;
    let mut sheet = VectorSheet::new(width.ceil() as usize, (below + 1.8 * letters).ceil() as usize);
    let left = 0.5 * (sheet.width as f64 - length);
    for k in 0..STEPS {
        let [from, to] = [k, k + 1].map(|k| length * k as f64 / STEPS as f64);
        let mut path = SvgPath::default();
        path.rectangle([left + from, top, to - from, height]);
        let color = to_hex(scale.on_bar((k as f64 + 0.5) / STEPS as f64));
        sheet.add(&format!(r#"fill="{color}" shape-rendering="crispEdges""#), &path);
    }
    let mut ticks = SvgPath::default();
    let tick = |v: &f64| [top + height, top + height + 0.3 * letters].map(|y| [left + place(*v), y]);
    values.iter().for_each(|v| ticks.line(&tick(v)));
    sheet.stroke(INK, (0.05 * letters).max(0.8), &ticks);
    for (text, lettering, [x, y]) in &captions {
        sheet.write(text, &lettering.path, ([left + x - 0.5 * lettering.width, *y], INK), 0.0);
    }
    sheet
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_numbers_at_the_ends_are_the_percentiles() {
        let values: Vec<f64> = (1..=1000).map(f64::from).collect();
        let svg = String::from_utf8(bar(&ColorScale::of_amounts("area", &values), &Style::default()).svg())
            .unwrap();
        let written: Vec<&str> =
            svg.split("aria-label=\"").skip(1).filter_map(|s| s.split('"').next()).collect();
        assert_eq!((written[0], written[2], written[written.len() - 1]), ("area", "20", "980"));
    }

    #[test]
    fn the_bar_runs_through_the_map_and_its_letters_can_be_read_at_any_size() {
        let scale = ColorScale::of_amounts("a", &[0.0, 1.0]);
        for size in [64, 320, 900, 4096] {
            let style = Style { size, ..Style::default() };
            let image = bar(&scale, &style).image().unwrap();
            let (letters, length) = (style.letters(), (BAR[0] * size as f64).max(16.0 * style.letters()));
            assert!((12.0..=44.0).contains(&letters));
            let at = |t: f64| {
                let x = 0.5 * (image.width as f64 - length) + t * length;
                let i = 4 * ((2.2 * letters) as usize * image.width + x as usize);
                [image.rgba[i], image.rgba[i + 1], image.rgba[i + 2]]
            };
            // The violet and yellow ends of viridis.
            assert!(at(0.02)[2] > at(0.02)[1] && at(0.98)[0] > 220 && at(0.98)[2] < 80, "{size}");
        }
    }
}
