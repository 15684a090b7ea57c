//! An image in at most 256 colours, by median cut \[Hec82\].

use std::collections::HashMap;

/// Colours of an indexed PNG, whose pixels are bytes.
const MOST: usize = 256;
/// Greys from this one on, in which shadows on paper end.
const LIGHT_GREY: u8 = 200;

/// A palette (three bytes a colour) and for each pixel the number of its colour.
pub fn reduce(rgb: &[u8]) -> (Vec<u8>, Vec<u8>) {
    let mut count: HashMap<[u8; 3], usize> = HashMap::new();
    for p in rgb.chunks_exact(3) {
        *count.entry([p[0], p[1], p[2]]).or_default() += 1;
    }
    let mut colors: Vec<([u8; 3], usize)> = count.into_iter().collect();
    // The steps of a soft shadow on white paper show: light greys keep a colour of their own each.
    let own = |c: &[u8; 3]| c[0] >= LIGHT_GREY && c[0] == c[1] && c[1] == c[2];
    colors.sort_unstable_by_key(|(c, _)| (!own(c), *c));
    let greys = colors.iter().take_while(|(c, _)| own(c)).count();
    // Boxes of colours, as ranges of the list.
    let mut boxes: Vec<_> =
        (0..greys).map(|k| k..k + 1).chain(std::iter::once(greys..colors.len())).collect();
    while boxes.len() < MOST {
        // The box whose colours are spread most, each by how often it occurs.
        let spread = |range: &std::ops::Range<usize>| spread(&colors[range.clone()]);
        let scores: Vec<(f64, usize)> = boxes.iter().map(spread).collect();
        let widest = (0..boxes.len()).fold(0, |w, i| if scores[i].0 > scores[w].0 { i } else { w });
        if boxes.is_empty() || scores[widest].0 <= 0.0 {
            break;
        }
        let (range, channel) = (boxes[widest].clone(), scores[widest].1);
        let part = &mut colors[range.clone()];
        part.sort_unstable_by_key(|(c, _)| (c[channel], *c));
        let middle = range.start + split(part, channel);
        boxes[widest] = range.start..middle;
        boxes.push(middle..range.end);
    }
    let (mut palette, mut number) = (Vec::new(), HashMap::new());
    for (index, range) in boxes.into_iter().filter(|r| !r.is_empty()).enumerate() {
        let part = &colors[range];
        let total: usize = part.iter().map(|(_, n)| n).sum();
        for k in 0..3 {
            let sum: usize = part.iter().map(|(c, n)| c[k] as usize * n).sum();
            palette.push(((sum + total / 2) / total) as u8);
        }
        part.iter().for_each(|(c, _)| {
            number.insert(*c, index as u8);
        });
    }
    let indices = rgb.chunks_exact(3).map(|p| number.get(&[p[0], p[1], p[2]]).copied().unwrap_or(0));
    let indices = indices.collect();
    (palette, indices)
}

/// The largest squared deviation of a channel from its mean, summed over the pixels, and that channel.
fn spread(part: &[([u8; 3], usize)]) -> (f64, usize) {
    let total: f64 = part.iter().map(|(_, n)| *n as f64).sum();
    let of = |k: usize| {
        let mean = part.iter().map(|(c, n)| f64::from(c[k]) * *n as f64).sum::<f64>() / total;
        // Below one pixel's worth of a full step nothing is gained.
        part.iter().map(|(c, n)| (f64::from(c[k]) - mean).powi(2) * (*n as f64).sqrt()).sum::<f64>()
    };
    (0..3).map(|k| (of(k), k)).fold((0.0, 0), |best, x| if x.0 > best.0 { x } else { best })
}

/// Where to cut a sorted box of at least two colours: at the mean.
fn split(part: &[([u8; 3], usize)], channel: usize) -> usize {
    let total: f64 = part.iter().map(|(_, n)| *n as f64).sum();
    let mean = part.iter().map(|(c, n)| f64::from(c[channel]) * *n as f64).sum::<f64>() / total;
    part.iter().position(|(c, _)| f64::from(c[channel]) > mean).unwrap_or(1).clamp(1, part.len() - 1)
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
