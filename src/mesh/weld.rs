//! Which points coincide.

use super::Point;
use super::incidence::UnionFind;
use crate::error::{Error, Result};
use std::collections::HashMap;

/// Size of a cell over the tolerance: below 1/√3.
const CELL: f64 = 0.577;

/// Whether this is a distance within which points can coincide.
pub(super) fn check_tolerance(weld: f64) -> Result<()> {
    if weld >= 0.0 && weld.is_finite() {
        return Ok(());
    }
    Err(Error::Argument { what: "weld", value: weld.to_string(), need: "a distance that is not negative" })
}

/// Per point, the first point that it coincides with: in exactly the same place for `tolerance` 0, else within that distance
/// by a chain of such points. Points that are not finite coincide with none.
pub(super) fn coincident(positions: &[Point], tolerance: f64) -> Vec<u32> {
    if tolerance == 0.0 {
        return same_place(positions);
    }
    let mut sets = UnionFind::new(positions.len());
    // Points of one cell are within the tolerance of each other, those within it are at most two cells apart. A cell number
    // beyond the range of i64 is its end: points out there are only compared more often.
    let cell = |p: &Point| p.map(|x| (x / (CELL * tolerance)).floor() as i64);
    let mut cells: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
    for (v, p) in (0u32..).zip(positions).filter(|(_, p)| p.iter().all(|x| x.is_finite())) {
        let [x, y, z] = cell(p);
        for neighbour in 0..125 {
            let step = |k: i64, at: i64| at.saturating_add(neighbour / k % 5 - 2);
            let near = |w: &&u32| {
                let q = positions[**w as usize];
                (p[0] - q[0]).hypot(p[1] - q[1]).hypot(p[2] - q[2]) <= tolerance
            };
            // The points of a cell are one set: the first that is near enough joins them all.
            let others = cells.get(&[step(25, x), step(5, y), step(1, z)]);
            if let Some(&w) = others.and_then(|others| others.iter().find(near)) {
                sets.join(v, w);
            }
        }
        cells.entry([x, y, z]).or_default().push(v);
    }
    (0..positions.len() as u32).map(|v| sets.root(v)).collect()
}

fn same_place(positions: &[Point]) -> Vec<u32> {
    let mut known: HashMap<[u64; 3], u32> = HashMap::with_capacity(positions.len());
    let first = |(v, p): (u32, &Point)| {
        if !p.iter().all(|x| x.is_finite()) {
            return v;
        }
        // −0 is 0.
        *known.entry(p.map(|x| if x == 0.0 { 0 } else { x.to_bits() })).or_insert(v)
    };
    (0u32..).zip(positions).map(first).collect()
}
