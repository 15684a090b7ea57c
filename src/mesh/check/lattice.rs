//! Coordinates that lie on a lattice which is coarse for the edges.

use super::hint::CoordinateLattice;
use crate::geometry::vector;
use crate::mesh::Point;

/// Smallest step, as a share of the mean edge, that is named: it moves angles by as much.
const COARSE: f64 = 1e-3;
/// The largest coordinate in steps of the lattice of single precision, which has 24 bits: between these, because the last bits of all
/// coordinates can be 0 by chance.
const STEPS: [f64; 2] = [2e6, 1.7e7];

/// The coarsest lattice of single precision on which a coordinate of all vertices lies, if it is coarse for the edges.
pub(super) fn lattice(positions: &[Point], faces: &[[u32; 3]]) -> Option<CoordinateLattice> {
    if !positions.as_flattened().iter().all(|x| x.is_finite()) {
        return None;
    }
    let side = |f: &[u32; 3], k: usize| {
        Some([*positions.get(f[k] as usize)?, *positions.get(f[(k + 1) % 3] as usize)?])
    };
    let lengths = faces
        .iter()
        .flat_map(|f| [0, 1, 2].map(|k| side(f, k)))
        .flatten()
        .map(|[a, b]| vector::distance(a, b));
    let (sum, count) = lengths.fold((0.0, 0.0), |(sum, count), length| (sum + length, count + 1.0));
    let mean = sum / count;
    let on_axis = |axis: usize| {
        let size = positions.iter().map(|p| p[axis].abs()).fold(0.0, f64::max);
        let step = positions.iter().map(|p| last_bit(p[axis])).fold(f64::INFINITY, f64::min);
        let is_single = (STEPS[0]..STEPS[1]).contains(&(size / step));
        let share = step / mean;
        (is_single && share > COARSE).then_some(CoordinateLattice { axis, step, size, share })
    };
    (0..3).filter_map(on_axis).reduce(|a, b| if b.step > a.step { b } else { a })
}

/// The largest power of 2 of which a number is a multiple; infinite for 0.
fn last_bit(x: f64) -> f64 {
    if x == 0.0 {
        return f64::INFINITY;
    }
    // One unit of the last place, times the power of 2 in the digits.
    let unit = f64::from_bits(x.abs().to_bits() + 1) - x.abs();
    let digits = x.abs() / unit;
    unit * (1u64 << (digits as u64).trailing_zeros().min(62)) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn single_precision_far_away_is_found() {
        let grid = |offset: f64, step: f64| -> (Vec<Point>, Vec<[u32; 3]>) {
            let at = |k: u32| f64::from(k % 9) * step;
            let positions =
                (0..81).map(|k| [f64::from((offset + at(k)) as f32), f64::from(k / 9) * step, 0.0]);
            let square = |k: u32| [[k, k + 1, k + 10], [k, k + 10, k + 9]];
            let faces = (0..72).filter(|k| k % 9 < 8).flat_map(square);
            (positions.collect(), faces.collect())
        };
        let (positions, faces) = grid(6_378_137.3, 10.37);
        let found = lattice(&positions, &faces).unwrap();
        assert_eq!((found.axis, found.step), (0, 0.5));
        assert!(found.size > 6.3e6 && found.share > 0.03, "{found:?}");
        // Near the origin, and in a grid of whole numbers, there is nothing to say.
        for (offset, step) in [(0.3, 0.137), (0.0, 1.0), (1000.0, 0.25)] {
            let (positions, faces) = grid(offset, step);
            assert_eq!(lattice(&positions, &faces), None);
        }
        assert_eq!([last_bit(6.0), last_bit(0.75), last_bit(1.0)], [2.0, 0.25, 1.0]);
    }
}
