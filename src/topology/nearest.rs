//! A priority queue that returns the nearest item first, for searches that grow outwards.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Rings per unit of distance.
const RINGS_PER_UNIT: f64 = 32.0;
/// Rings that are kept apart.
const RINGS: u64 = 1024;

/// A queue of items by distance: the nearest is returned first, of equally near ones the least. The order is that of a heap of all items.
///
/// A search that grows outwards adds hardly any items nearer than the last one that it took. So items are sorted into rings of equal
/// width, and only those of the innermost ring are in a heap, which stays small.
pub(crate) struct NearestQueue<T> {
    rings_per_distance: f64,
    /// The innermost ring.
    innermost: u64,
    /// The items of the innermost ring, and nearer ones.
    near: BinaryHeap<Reverse<(i64, T)>>,
    /// The items of ring r are at r modulo [`RINGS`], for less than so many rings beyond the innermost one.
    rings: Vec<Vec<(i64, T)>>,
    n_in_rings: usize,
    /// The items of rings farther out. They are sorted into rings when the innermost one is a multiple of [`RINGS`].
    beyond: Vec<(i64, T)>,
}

impl<T: Ord + Copy> NearestQueue<T> {
    /// An empty queue. `unit` is about the distance by which added items are farther than the last one taken; it affects nothing but the
    /// time.
    pub fn new(unit: f64) -> NearestQueue<T> {
        let rings_per_distance = RINGS_PER_UNIT / unit;
        let is_sound = rings_per_distance.is_finite() && rings_per_distance > 0.0;
        NearestQueue {
            rings_per_distance: if is_sound { rings_per_distance } else { 0.0 },
            innermost: 0,
            near: BinaryHeap::new(),
            rings: (0..RINGS).map(|_| Vec::new()).collect(),
            n_in_rings: 0,
            beyond: Vec::new(),
        }
    }

    /// The ring of a distance, which grows with the distance.
    fn ring(&self, distance: f64) -> u64 {
        (distance * self.rings_per_distance) as u64
    }

    pub fn push(&mut self, distance: f64, item: T) {
        self.drop_in(ordered(distance), self.ring(distance), item);
    }

    fn drop_in(&mut self, key: i64, ring: u64, item: T) {
        if ring <= self.innermost {
            self.near.push(Reverse((key, item)));
        } else if ring - self.innermost < RINGS {
            self.rings[(ring % RINGS) as usize].push((key, item));
            self.n_in_rings += 1;
        } else {
            self.beyond.push((key, item));
        }
    }

    /// Takes the nearest item, with its distance.
    pub fn pop(&mut self) -> Option<(f64, T)> {
        loop {
            if let Some(Reverse((key, item))) = self.near.pop() {
                return Some((distance(key), item));
            }
            if self.n_in_rings == 0 {
                let nearest = self.beyond.iter().map(|&(key, _)| key).min()?;
                self.innermost = self.ring(distance(nearest));
                self.take_beyond();
                continue;
            }
            self.innermost += 1;
            if self.innermost.is_multiple_of(RINGS) {
                self.take_beyond();
            }
            let ring = &mut self.rings[(self.innermost % RINGS) as usize];
            self.n_in_rings -= ring.len();
            self.near.extend(ring.drain(..).map(Reverse));
        }
    }

    fn take_beyond(&mut self) {
        for (key, item) in std::mem::take(&mut self.beyond) {
            self.drop_in(key, self.ring(distance(key)), item);
        }
    }
}

/// The number whose order as an integer is that of [`f64::total_cmp`].
fn ordered(x: f64) -> i64 {
    let bits = x.to_bits() as i64;
    bits ^ (((bits >> 63) as u64) >> 1) as i64
}

/// The inverse of [`ordered`].
fn distance(key: i64) -> f64 {
    f64::from_bits((key ^ (((key >> 63) as u64) >> 1) as i64) as u64)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Items as a search adds them, in the order of a heap: small steps, few large ones, equal distances, negative ones.
    #[test]
    fn items_come_in_the_order_of_a_heap() {
        for unit in [1.0, 1e-3, 1e3, 0.0, f64::NAN, f64::INFINITY, 1e-308] {
            let (mut queue, mut heap) = (NearestQueue::new(unit), BinaryHeap::new());
            let mut state = 1_u64;
            let mut random = move || {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                state >> 40
            };
            let mut last = 0.0;
            for k in 0..20_000_u32 {
                let step = [0.0, 1.0, 0.37, 1e-6, 40.0, 1e5, -2.0, 1e-3][random() as usize % 8];
                let far = if k.is_multiple_of(97) { 1e9 } else { last + step * (random() % 5) as f64 };
                queue.push(far, k % 64);
                heap.push(Reverse((ordered(far), k % 64)));
                if random() % 3 > 0 {
                    let (distance, item) = queue.pop().unwrap();
                    assert_eq!(heap.pop(), Some(Reverse((ordered(distance), item))));
                    last = distance;
                }
            }
            while let Some((distance, item)) = queue.pop() {
                assert_eq!(heap.pop(), Some(Reverse((ordered(distance), item))));
            }
            assert!(heap.is_empty());
        }
    }
}
