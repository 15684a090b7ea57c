//! The order of points along a Z-order curve \[Mor66\]: points that follow each other in it are mostly near each other in space.

use super::bounds::Bounds;
use super::vector::Vector;

/// Bits of each coordinate that count.
const BITS: u32 = 16;

/// The numbers of points in their order along a Z-order curve through their bounding box; of points in one cell of the curve, the first one
/// first. The coordinates are finite, at most 1e150 in size.
pub(crate) fn z_order(points: &[Vector]) -> Vec<u32> {
    let Bounds { low, high } = Bounds::of(points.iter().copied());
    let longest = (0..3).map(|x| high[x] - low[x]).fold(0.0, f64::max);
    let cells = f64::from((1 << BITS) - 1);
    let key = |p: &Vector| {
        let cell = |x: usize| if longest > 0.0 { ((p[x] - low[x]) / longest * cells) as u64 } else { 0 };
        (0..3).fold(0, |key, x| key | spread(cell(x)) << x)
    };
    let keys: Vec<u64> = points.iter().map(key).collect();
    let mut order: Vec<u32> = (0..points.len() as u32).collect();
    order.sort_by_key(|&i| (keys[i as usize], i));
    order
}

/// The bits of a number with two zeros after each.
fn spread(x: u64) -> u64 {
    (0..BITS).fold(0, |all, bit| all | (x >> bit & 1) << (3 * bit))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::vector::distance;

    /// A way through a shuffled grid along the curve is much shorter than in the given order, and visits every point once.
    #[test]
    fn neighbours_along_the_curve_are_near_each_other() {
        let n = 16;
        let at = |i: usize| [i % n, i / n % n, i / (n * n)].map(|x| x as f64 * 0.5 - 3.0);
        let points: Vec<Vector> = (0..n * n * n).map(|i| at(i * 1021 % (n * n * n))).collect();
        let order = z_order(&points);
        let mut sorted = order.clone();
        sorted.sort_unstable();
        assert!(sorted.iter().enumerate().all(|(i, &v)| i == v as usize));
        let way = |order: &[u32]| {
            order.windows(2).map(|w| distance(points[w[0] as usize], points[w[1] as usize])).sum::<f64>()
        };
        let given: Vec<u32> = (0..points.len() as u32).collect();
        assert!(way(&order) < 0.2 * way(&given), "{} {}", way(&order), way(&given));
        assert_eq!(z_order(&[[1.0; 3]; 3]), [0, 1, 2]);
        assert!(z_order(&[]).is_empty());
    }
}
