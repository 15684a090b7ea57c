//! Seeded noise on vertex positions, the same on every machine.

use super::check_corners;
use crate::error::{Error, Result};
use crate::geometry::vector::distance;
use crate::mesh::io::Soup;

/// SplitMix64 \[SLF14\], a small generator whose sequence is part of its definition.
#[derive(Debug, Clone)]
pub struct SplitMix64(u64);

impl SplitMix64 {
    /// The sequence of a seed.
    pub fn new(seed: u64) -> SplitMix64 {
        SplitMix64(seed)
    }

    /// The next 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// The next number in [0, 1), a multiple of 2⁻⁵³.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Moves every vertex by up to `amplitude` times the mean edge length in each coordinate, uniformly.
///
/// # Errors
///
/// [`Error::Argument`] for an amplitude that is not between 0 and 1000, and for faces that name a vertex that does not exist.
pub fn noise(soup: &mut Soup, amplitude: f64, seed: u64) -> Result<()> {
    if !(0.0..=1e3).contains(&amplitude) {
        return Err(Error::argument("noise", amplitude, "between 0 and 1000"));
    }
    check_corners(soup)?;
    let (mut total, mut count) = (0.0, 0usize);
    for [a, b, c] in soup.faces.iter().map(|f| f.map(|v| soup.positions[v as usize])) {
        for (p, q) in [(a, b), (b, c), (c, a)] {
            total += distance(p, q);
            count += 1;
        }
    }
    let step = amplitude * total / count.max(1) as f64;
    let mut random = SplitMix64::new(seed);
    for x in soup.positions.iter_mut().flatten() {
        *x += step * (2.0 * random.unit() - 1.0);
    }
    Ok(())
}
