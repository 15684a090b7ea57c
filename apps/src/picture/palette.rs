//! Reduction of an image to at most 256 colours, by median cut \[Hec82\].

use std::collections::BTreeMap;

/// Most colours of an indexed PNG, whose pixels are bytes.
const MOST: usize = 256;
/// The darkest of the light greys, which keep colours of their own because soft shadows end in them.
const LIGHT_GREY: u8 = 200;

/// Colours and how often each occurs.
type Colors = Vec<([u8; 3], usize)>;

/// A palette (three bytes a colour) and for each pixel the number of its colour.
pub fn reduce(rgb: &[u8]) -> (Vec<u8>, Vec<u8>) {
    let pixels = || rgb.chunks_exact(3).map(|p| [p[0], p[1], p[2]]);
    let mut count: BTreeMap<[u8; 3], usize> = BTreeMap::new();
    pixels().for_each(|p| *count.entry(p).or_default() += 1);
    // Steps in a soft shadow on white would be visible, so that each light grey keeps a colour of its own.
    let own = |(c, _): &([u8; 3], usize)| c[0] >= LIGHT_GREY && c[0] == c[1] && c[1] == c[2];
    let (greys, others): (Colors, Colors) = count.into_iter().partition(own);
    let mut boxes: Vec<Colors> = greys.into_iter().map(|c| vec![c]).collect();
    boxes.extend((!others.is_empty()).then_some(others));
    let mut spreads: Vec<_> = boxes.iter().map(|part| spread(part)).collect();
    while boxes.len() < MOST {
        let widest = (0..boxes.len()).max_by(|a, b| spreads[*a].0.total_cmp(&spreads[*b].0));
        let Some((widest, (_, channel, mean))) = widest.map(|w| (w, spreads[w])).filter(|w| w.1.0 > 0.0)
        else {
            break;
        };
        let part = std::mem::take(&mut boxes[widest]);
        let (low, high): (Colors, Colors) =
            part.into_iter().partition(|(c, _)| f64::from(c[channel]) <= mean);
        (spreads[widest], boxes[widest]) = (spread(&low), low);
        spreads.push(spread(&high));
        boxes.push(high);
    }
    let total = |part: &Colors| part.iter().map(|(_, n)| n).sum::<usize>();
    let sum = |part: &Colors, k: usize| part.iter().map(|(c, n)| c[k] as usize * n).sum::<usize>();
    let mean = |part: &Colors| [0, 1, 2].map(|k| ((sum(part, k) + total(part) / 2) / total(part)) as u8);
    let numbered =
        (0..=u8::MAX).zip(&boxes).flat_map(|(index, part)| part.iter().map(move |(c, _)| (*c, index)));
    let number: BTreeMap<[u8; 3], u8> = numbered.collect();
    (boxes.iter().flat_map(mean).collect(), pixels().map(|p| number[&p]).collect())
}

/// The largest squared deviation of a channel from its mean, summed over the colours, that channel and the mean.
fn spread(part: &[([u8; 3], usize)]) -> (f64, usize, f64) {
    let total: f64 = part.iter().map(|(_, n)| *n as f64).sum();
    let of = |k: usize| {
        let mean = part.iter().map(|(c, n)| f64::from(c[k]) * *n as f64).sum::<f64>() / total;
        // Colours that fill large parts of a picture do not take all the steps.
        let deviation = part.iter().map(|(c, n)| (f64::from(c[k]) - mean).powi(2) * (*n as f64).sqrt());
        (deviation.sum::<f64>(), k, mean)
    };
    (0..3).map(of).fold((0.0, 0, 0.0), |best, x| if x.0 > best.0 { x } else { best })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_colours_stay_as_they_are_and_many_stay_close() {
        let few = [255, 255, 255, 0, 0, 0, 10, 20, 30, 255, 255, 255];
        let back = |rgb: &[u8]| -> Vec<u8> {
            let (palette, indices) = reduce(rgb);
            assert!(palette.len() <= 3 * MOST);
            indices.iter().flat_map(|i| palette[3 * *i as usize..][..3].to_vec()).collect()
        };
        assert_eq!(back(&few), few);
        let many: Vec<u8> = (0..100_000u32).flat_map(|i| [(i % 251) as u8, (i / 397) as u8, 128]).collect();
        // A shadow on paper beside many colours keeps all its steps.
        let grey: Vec<u8> = (0..=255).skip(LIGHT_GREY.into()).flat_map(|g| [g; 3]).collect();
        let both = [&many[..], &grey].concat();
        assert_eq!(back(&both)[many.len()..], grey);
        let worst = back(&many).iter().zip(&many).map(|(a, b)| a.abs_diff(*b)).max();
        assert!(worst <= Some(16), "{worst:?}");
    }
}
