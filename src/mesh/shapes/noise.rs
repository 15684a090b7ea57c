//! Seeded noise on vertex positions, the same on every machine.

use super::check_corners;
use crate::error::{Error, Result};
use crate::geometry::random::SplitMix64;
use crate::geometry::vector::distance;
use crate::mesh::io::Soup;

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
