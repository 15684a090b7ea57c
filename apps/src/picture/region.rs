//! Regions of the plane as closed polygons: their outlines, and the cells of a pattern in them.

use super::texture::{CIRCLE_SPACING, RING, TextureChoice};
use super::vector::ends;
use ricci::geometry::clip::{clip, strip};
use std::collections::{HashMap, HashSet};
use std::f64::consts::TAU;

/// A closed polygon, or a line, by its points.
pub type Polyline = Vec<[f64; 2]>;

/// Checks with sides below this many pixels are not drawn one by one, since they would only add up to their mean colour.
pub const FINEST: f64 = 1.2;
/// Sides of the polygons that stand for the circles of a pattern, in the order of [`RING`].
const CIRCLE_SIDES: [usize; 3] = [24, 24, 12];
/// Number of pieces of a cell's side, so that it can follow a curve.
const PIECES: usize = 3;

pub fn is_finite(points: &[[f64; 2]]) -> bool {
    points.as_flattened().iter().all(|x| x.is_finite())
}

/// A point as a number that can be looked up.
fn key(p: [f64; 2]) -> [u64; 2] {
    p.map(f64::to_bits)
}

/// The sides that belong to one triangle alone, in the direction in which they run around it.
pub fn border<P: Copy + Ord>(triangles: impl Iterator<Item = [P; 3]>) -> Vec<(P, P)> {
    let sides = triangles.flat_map(|t| [0, 1, 2].map(|k| (t[k], t[(k + 1) % 3])));
    let mut sides: Vec<_> = sides.map(|(a, b)| (a.min(b), a.max(b), a < b)).collect();
    sides.sort_unstable();
    let runs = sides.chunk_by(|p, q| (p.0, p.1) == (q.0, q.1)).filter(|run| run.len() == 1);
    runs.map(|run| if run[0].2 { (run[0].0, run[0].1) } else { (run[0].1, run[0].0) }).collect()
}

/// The border of triangles as closed polygons.
pub fn outline(triangles: impl Iterator<Item = [[f64; 2]; 3]>) -> Vec<Polyline> {
    let sides = border(triangles.filter(|t| is_finite(t)).map(|t| t.map(key)));
    let place = |p: [u64; 2]| p.map(f64::from_bits);
    chains(sides.into_iter().map(|(a, b)| (place(a), place(b))))
}

/// The segments without repetitions, in whichever direction they run.
pub fn once(segments: impl Iterator<Item = [[f64; 2]; 2]>) -> impl Iterator<Item = [[f64; 2]; 2]> {
    let mut known = HashSet::new();
    segments.filter(move |[a, b]| {
        let (a, b) = (key(*a), key(*b));
        known.insert([a.min(b), a.max(b)])
    })
}

/// Lines from segments that are joined end to start; a closed line ends at its first point.
pub fn chains(segments: impl Iterator<Item = ([f64; 2], [f64; 2])>) -> Vec<Polyline> {
    let segments: Vec<_> = segments.filter(|(a, b)| is_finite(&[*a, *b])).collect();
    let mut from: HashMap<_, Vec<usize>> = HashMap::new();
    for (i, (a, _)) in segments.iter().enumerate().rev() {
        from.entry(key(*a)).or_default().push(i);
    }
    let ends: HashSet<_> = segments.iter().map(|(_, b)| key(*b)).collect();
    // Lines from their free ends first, then what is closed.
    let free = |i: &usize| !ends.contains(&key(segments[*i].0));
    let order: Vec<usize> = (0..segments.len()).filter(free).chain(0..segments.len()).collect();
    let mut used = vec![false; segments.len()];
    let mut chains = Vec::new();
    for first in order {
        let mut next = (!used[first]).then_some(first);
        let mut chain = Vec::new();
        while let Some(i) = next {
            used[i] = true;
            chain.extend(chain.is_empty().then_some(segments[i].0));
            chain.push(segments[i].1);
            let open = from.get_mut(&key(segments[i].1));
            next = open.and_then(|list| std::iter::from_fn(|| list.pop()).find(|j| !used[*j]));
        }
        chains.extend((!chain.is_empty()).then_some(chain));
    }
    chains
}

/// The dark cells of a pattern in a region, whose polygons run around it on the left; circles have their inner edges run the
/// other way. `check`: the side of a check.
pub fn cells(region: &[Polyline], texture: TextureChoice, check: f64) -> Vec<Polyline> {
    let cells = region.iter().flat_map(|polygon| match texture {
        TextureChoice::Checker => checks(polygon, check),
        TextureChoice::Circles => circles(polygon, check * CIRCLE_SPACING),
        TextureChoice::None => Vec::new(),
    });
    cells.filter(|cell| cell.len() > 2).collect()
}

/// The numbers of the intervals between multiples of `step` that meet the polygon.
fn intervals(polygon: &[[f64; 2]], axis: usize, step: f64) -> std::ops::RangeInclusive<i64> {
    let [low, high] = ends(polygon.iter().map(|p| p[axis]));
    (low / step).floor() as i64..=(high / step).floor() as i64
}

fn checks(polygon: &[[f64; 2]], side: f64) -> Vec<Polyline> {
    let of = |polygon: &[[f64; 2]], axis: usize, k: i64| -> Polyline {
        strip(polygon, axis, [k as f64 * side, (k + 1) as f64 * side])
    };
    let mut cells = Vec::new();
    for i in intervals(polygon, 0, side) {
        let column = of(polygon, 0, i);
        let rows = intervals(&column, 1, side).filter(|j| (i + j) % 2 != 0);
        cells.extend(rows.map(|j| of(&column, 1, j)));
    }
    cells
}

/// Rings with a dot at their centre, around the points of a triangular lattice.
fn circles(polygon: &[[f64; 2]], step: f64) -> Vec<Polyline> {
    let (height, radius) = (0.75f64.sqrt() * step, RING[0] * step);
    let mut cells = Vec::new();
    let numbers = |polygon: &[[f64; 2]], axis: usize, step: f64| {
        let range = intervals(polygon, axis, step);
        *range.start()..=range.end().saturating_add(1)
    };
    for j in numbers(polygon, 1, height) {
        let y = j as f64 * height;
        let row = strip(polygon, 1, [y - radius, y + radius]);
        let shift = 0.5 * step * (j.rem_euclid(2)) as f64;
        for i in numbers(&row, 0, step) {
            let x = i as f64 * step + shift;
            let square = strip(&row, 0, [x - radius, x + radius]);
            let mut parts = [0, 1, 2].map(|k| disk(&square, [x, y], RING[k] * step, CIRCLE_SIDES[k]));
            parts[1].reverse();
            cells.extend(parts);
        }
    }
    cells
}

/// The part of a polygon in a disk, for which a polygon with the same area stands.
fn disk(polygon: &[[f64; 2]], [x, y]: [f64; 2], radius: f64, sides: usize) -> Polyline {
    let turn = TAU / sides as f64;
    let apothem = radius * (0.5 * turn / (0.5 * turn).tan()).sqrt();
    (0..sides).fold(polygon.to_vec(), |part, k| {
        let (b, a) = (turn * k as f64).sin_cos();
        if part.is_empty() { part } else { clip(&part, |p| apothem - a * (p[0] - x) - b * (p[1] - y)) }
    })
}

/// The same polygon with points between on sides that are long beside `side`.
pub fn in_pieces(polygon: &[[f64; 2]], side: f64) -> Polyline {
    let pieces = |k: usize| {
        let (p, q) = (polygon[k], polygon[(k + 1) % polygon.len()]);
        let n = ((q[0] - p[0]).hypot(q[1] - p[1]) / side * PIECES as f64).ceil().clamp(1.0, PIECES as f64);
        (0..n as usize).map(move |i| [0, 1].map(|k| p[k] + i as f64 / n * (q[k] - p[k])))
    };
    (0..polygon.len()).flat_map(pieces).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use ricci::geometry::complex::doubled_area;

    /// Twice the area that polygons run around on the left.
    fn area(polygons: &[Polyline]) -> f64 {
        let of = |p: &Polyline| (2..p.len()).map(|k| doubled_area([p[0], p[k - 1], p[k]])).sum::<f64>();
        polygons.iter().map(of).sum()
    }

    #[test]
    fn segments_chain_into_lines_and_loops() {
        let p = |k: f64| [k, 0.0];
        let joined =
            chains([(p(2.0), p(3.0)), (p(1.0), p(2.0)), (p(7.0), p(8.0)), (p(8.0), p(7.0))].into_iter());
        assert_eq!(joined, [vec![p(1.0), p(2.0), p(3.0)], vec![p(7.0), p(8.0), p(7.0)]]);
    }

    #[test]
    fn the_outline_of_triangles_has_no_inner_sides() {
        let [a, b, c, d] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let around = outline([[a, b, c], [a, c, d]].into_iter());
        assert_eq!(around, [vec![d, a, b, c, d]]);
        assert_eq!(once([[a, b], [b, c], [b, a]].into_iter()).count(), 2);
    }

    #[test]
    fn cells_fill_their_share_of_a_region_with_a_bay_and_a_hole() {
        let square = |r: f64| vec![[-r, -r], [r, -r], [r, r], [-r, r]];
        let mut hole = square(1.0);
        hole.reverse();
        let bay = vec![
            [-4.0, -4.0],
            [4.0, -4.0],
            [4.0, 4.0],
            [1.9, 4.0],
            [1.9, 1.1],
            [-1.9, 1.1],
            [-1.9, 4.0],
            [-4.0, 4.0],
        ];
        let region = [bay, hole];
        let whole = area(&region);
        let dark = area(&cells(&region, TextureChoice::Checker, 0.05));
        assert!((dark / whole - 0.5).abs() < 0.01, "{dark} of {whole}");
        let dark = area(&cells(&region, TextureChoice::Circles, 0.05));
        let share =
            std::f64::consts::PI * (RING[0].powi(2) - RING[1].powi(2) + RING[2].powi(2)) / 0.75f64.sqrt();
        assert!((dark / whole / share - 1.0).abs() < 0.02, "{dark} of {whole}");
    }
}
