//! The loops of generators as edge paths: straight lines of the hyperbolic plane, followed from hexagon to hexagon.

use super::decomposition::PlacedPants;
use super::hexagon::{HyperboloidPoint, orientation, unit};
use super::tiles::{HexagonTiles, Tile};
use crate::error::{Error, Result};
use crate::geometry::{DoubleDouble, Motion, Space};
use std::collections::HashMap;

/// Most hexagons that a loop passes.
const MOST_STEPS: usize = 1_000_000;
/// Largest distance of the end of a loop from its start, as it is computed.
const SAME_END: f64 = 1e-6;

/// The motion that brings the origin to p and the x axis to the line from p to q.
fn frame(p: &HyperboloidPoint, q: &HyperboloidPoint) -> Motion<DoubleDouble> {
    let home = Motion::to_origin(Space::H2, *p);
    let [x, y, _] = home.apply(*q);
    let one = DoubleDouble::from(1.0);
    let size = (x * x + y * y).sqrt();
    let (cos, sin) = (x / size, y / size);
    // Half the angle, from the larger of 1 ± cos.
    let half = match (cos.high >= 0.0, sin.high >= 0.0) {
        (true, _) => [one + cos, sin],
        (false, true) => [sin, one - cos],
        (false, false) => [-sin, cos - one],
    };
    let size = (half[0] * half[0] + half[1] * half[1]).sqrt();
    home.inverse().compose(&Motion::rotation(half.map(|x| x / size), Space::H2)).normalised()
}

impl Tile {
    /// The frame of a side, from its first vertex to its second or back.
    fn side_frame(&self, k: usize, is_forward: bool) -> Motion<DoubleDouble> {
        let (p, q) = (&self.points[k], &self.points[(k + 1) % self.points.len()]);
        if is_forward { frame(p, q) } else { frame(q, p) }
    }

    /// A point inside hexagon number `tile`. No symmetry of the surface brings such points of two hexagons to each other, so that lines between them
    /// pass through no vertex that it fixes.
    fn inner_point(&self, tile: usize) -> HyperboloidPoint {
        let mut sum = [DoubleDouble::from(0.0); 3];
        for (k, point) in self.points.iter().enumerate() {
            let bend = 0.37 + 0.013 * (tile % 29) as f64;
            let weight = DoubleDouble::from(1.0 / (1.0 + bend * (k * k) as f64));
            sum = [0, 1, 2].map(|c| sum[c] + weight * point[c]);
        }
        unit(sum)
    }

    /// The side through which a line from `start` leaves, unless it ends at `goal` before.
    fn exit(&self, start: &HyperboloidPoint, goal: &HyperboloidPoint) -> Option<usize> {
        let n = self.points.len();
        let is_left: Vec<bool> = self.points.iter().map(|p| orientation([start, goal, p]) >= 0.0).collect();
        let k = (0..n).find(|&k| !is_left[k] && is_left[(k + 1) % n])?;
        (orientation([&self.points[k], &self.points[(k + 1) % n], goal]) < 0.0).then_some(k)
    }
}

/// Walks over the hexagons.
struct TileWalks<'a> {
    tiles: &'a HexagonTiles,
    /// Per side, as an edge with its direction, the hexagon on its left and the number of the side there.
    sides: HashMap<i32, (usize, usize)>,
}

impl TileWalks<'_> {
    /// The path from the middle of the front of one pair of pants to that of another, which has the frame `to` as seen from the first: over
    /// a vertex of each side that a straight line crosses.
    fn path(&self, [p, q]: [usize; 2], to: &Motion<DoubleDouble>) -> Option<Vec<i32>> {
        let tiles = &self.tiles.tiles;
        let (mut tile, mut here, mut path) = (2 * p, Motion::identity(Space::H2), Vec::new());
        let [mut from, there] = [2 * p, 2 * q].map(|tile| tiles[tile].inner_point(tile));
        let mut goal = to.apply(there);
        for _ in 0..MOST_STEPS {
            let a = &tiles[tile];
            let Some(k) = a.exit(&from, &goal) else {
                let off = here.inverse().compose(to).displacement();
                return (tile == 2 * q && off < SAME_END).then_some(path);
            };
            let &(next, l) = self.sides.get(&-a.sides[k])?;
            let b = &tiles[next];
            let step = a.side_frame(k, true).compose(&b.side_frame(l, false).inverse()).normalised();
            (from, goal) = (step.inverse().apply(from), step.inverse().apply(goal));
            here = here.compose(&step).normalised();
            path.extend([a.spokes[k], -b.spokes[(l + 1) % b.spokes.len()]]);
            tile = next;
        }
        None
    }

    /// The path from the root to the front of pair of pants p, by way of the pairs from which it was placed.
    fn path_to(&self, placed: &[PlacedPants], p: usize) -> Option<Vec<i32>> {
        let Some((from, step)) = &placed[p].from else { return Some(Vec::new()) };
        let mut path = self.path_to(placed, *from)?;
        path.extend(self.path([*from, p], step)?);
        Some(path)
    }
}

/// The loop of every generator, at vertex 0.
///
/// # Errors
/// [`Error::Layout`] where a line does not lead to its end within rounding.
pub(super) fn generator_loops(
    tiles: &HexagonTiles,
    placed: &[PlacedPants],
    local: &[(usize, Motion<DoubleDouble>)],
) -> Result<Vec<Vec<i32>>> {
    let mut walks = TileWalks { tiles, sides: HashMap::new() };
    for (t, tile) in tiles.tiles.iter().enumerate() {
        walks.sides.extend(tile.sides.iter().enumerate().map(|(k, &e)| (e, (t, k))));
    }
    let of = |&(p, ref g): &(usize, Motion<DoubleDouble>)| {
        let there = walks.path_to(placed, p)?;
        let mut path = there.clone();
        path.extend(walks.path([p, p], g)?);
        path.extend(there.iter().rev().map(|e| -e));
        Some(path)
    };
    let lost = || Error::Layout("the loop of a generator of glued pairs of pants does not close".into());
    local.iter().map(|g| of(g).ok_or_else(lost)).collect()
}
