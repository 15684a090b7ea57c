//! Points on an edge, and their order.
//!
//! A point is the pair of weights of the edge's ends, which add up to 1: near either end the smaller weight says how near, to the
//! relative accuracy of f64.

use crate::mesh::normal_trace::CurveCrossing;
use crate::mesh::{Curves, Mesh};

/// A point on an edge: weights of the origin and of the tip.
pub(super) type OnEdge = [f64; 2];

/// The origin itself.
pub(super) const ORIGIN: OnEdge = [1.0, 0.0];
/// The tip itself.
pub(super) const TIP: OnEdge = [0.0, 1.0];

/// Share of the way to its neighbours over which points are spread that rounding has swapped or merged. The true points are nearer
/// to each other than rounding, so the share must be small; 1e-6 is still far above the 1e-16 of rounding, so that the points
/// differ afterwards.
const SPREAD: f64 = 1.0 / (1 << 20) as f64;

/// True if a lies nearer to the origin than b by one weight and not farther by the other.
pub(super) fn before(a: OnEdge, b: OnEdge) -> bool {
    a[1] <= b[1] && a[0] >= b[0] && a != b
}

/// `(1 − t) a + t b`.
pub(super) fn between(a: OnEdge, b: OnEdge, t: f64) -> OnEdge {
    [0, 1].map(|k| (1.0 - t) * a[k] + t * b[k])
}

/// Bring points into strict order that would be in order without rounding. Points in order stay as they are, bit for bit.
///
/// Points out of order, or equal to their neighbour, are moved to their mean, which is the least change (in the mean square) that
/// leaves none out of order. Then they are spread evenly around it, over [`SPREAD`] of the way to the next point on both sides. Points
/// between which there is no f64 still coincide afterwards, but none is in the wrong order.
pub(super) fn restore_order(places: &mut [OnEdge]) {
    if places.windows(2).all(|pair| before(pair[0], pair[1])) {
        return;
    }
    let mut pools: Vec<(OnEdge, usize)> = Vec::with_capacity(places.len());
    for &place in places.iter() {
        let (mut mean, mut n) = (place, 1);
        while let Some(&(last, m)) = pools.last().filter(|(last, _)| !before(*last, mean)) {
            mean = between(last, mean, n as f64 / (n + m) as f64);
            n += m;
            pools.pop();
        }
        pools.push((mean, n));
    }
    let mut at = 0;
    for (k, &(mean, n)) in pools.iter().enumerate() {
        let low = k.checked_sub(1).map_or(ORIGIN, |k| pools[k].0);
        let high = pools.get(k + 1).map_or(TIP, |pool| pool.0);
        for (i, place) in places[at..at + n].iter_mut().enumerate() {
            let off = (2 * i + 1) as f64 / n as f64 - 1.0;
            *place = between(mean, if off < 0.0 { low } else { high }, off.abs() * SPREAD);
        }
        at += n;
    }
    // Two places with no f64 between them may have been put out of order by rounding.
    for k in 1..places.len() {
        let [x, y] = places[k - 1];
        places[k] = [places[k][0].min(x), places[k][1].max(y)];
    }
}

/// The same for the crossings of all `curves` with the edges of a triangulation, in the order of the curves:
/// places along the half-edges 2e.
pub(super) fn restore_order_across(mesh: &Mesh, curves: &Curves, places: &mut [OnEdge]) {
    let crossings = || mesh.edges().flat_map(|e| curves.crossings(e));
    let mut start = vec![0; mesh.n_edges() + 1];
    crossings().for_each(|at| start[at.halfedge.edge().index() + 1] += 1);
    (0..mesh.n_edges()).for_each(|e| start[e + 1] += start[e]);
    let slot = |at: &CurveCrossing| {
        let (e, position) = (at.halfedge.edge().index(), at.position as usize);
        if at.halfedge.0 & 1 == 0 { start[e] + position } else { start[e + 1] - 1 - position }
    };
    let mut sorted = vec![ORIGIN; places.len()];
    crossings().zip(places.iter()).for_each(|(at, &place)| sorted[slot(at)] = place);
    (0..mesh.n_edges()).for_each(|e| restore_order(&mut sorted[start[e]..start[e + 1]]));
    crossings().zip(places).for_each(|(at, place)| *place = sorted[slot(at)]);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::shapes::SplitMix64;

    fn at(t: f64) -> OnEdge {
        [1.0 - t, t]
    }

    #[test]
    fn places_in_order_stay_as_they_are() {
        let mut places: Vec<_> = [1e-300, 1e-20, 0.3, 0.5, 0.7].map(at).to_vec();
        places.extend([[1e-17, 1.0], [1e-200, 1.0]]);
        let before = places.clone();
        restore_order(&mut places);
        assert_eq!(places, before);
    }

    #[test]
    fn what_doubles_cannot_tell_apart_coincides() {
        let next = f64::from_bits(0.3f64.to_bits() + 1);
        let mut places = [0.3, 0.3, next, 0.3, 0.3, next, next].map(at);
        restore_order(&mut places);
        assert!(places.windows(2).all(|p| before(p[0], p[1]) || p[0] == p[1]), "{places:?}");
        assert!(places.iter().all(|p| (p[1] - 0.3).abs() < 1e-6));
    }

    #[test]
    fn places_out_of_order_move_no_farther_than_they_were_out_of_it_and_come_into_strict_order() {
        let mut random = SplitMix64::new(3);
        let mut unit = || (random.bits() >> 11) as f64 / (1u64 << 53) as f64;
        for round in 0..200 {
            let n = 2 + round % 30;
            let noise = [1e-12, 1e-6, 0.3][round % 3];
            let exact: Vec<f64> = (1..=n).map(|k| k as f64 / (n + 1) as f64).collect();
            let mut places: Vec<_> =
                exact.iter().map(|t| (t + noise * (unit() - 0.5)).clamp(1e-9, 0.999)).map(at).collect();
            places[n / 2] = places[n / 2 - 1];
            let given = places.clone();
            restore_order(&mut places);
            assert!(places.windows(2).all(|p| before(p[0], p[1])), "{given:?} {places:?}");
            assert!(places.iter().flatten().all(|&w| w > 0.0 && w < 1.0));
            let gap = 1.0 / (n + 1) as f64;
            for (place, t) in places.iter().zip(&exact) {
                assert!((place[1] - t).abs() <= 1.01 * (noise + gap + SPREAD));
                assert!((place[0] + place[1] - 1.0).abs() < 1e-15);
            }
        }
    }
}
