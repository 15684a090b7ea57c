//! Triangulation of long polygons, one ear after the other.

use super::triangulate::weight;
use crate::geometry::vector;
use crate::mesh::Point;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// The triangles of a polygon: ears of least weight first, those that lie inside in the plane of the polygon's vector area before all
/// others. O(n log n) as long as few vertices lie in the box of an ear. `None` where an ear without area or with a taken edge is left.
pub(super) fn cut_ears(points: &[Point], is_taken: &dyn Fn(usize, usize) -> bool) -> Option<Vec<[u32; 3]>> {
    let n = points.len();
    let mut polygon = EarPolygon::new(points);
    let mut heap: BinaryHeap<Reverse<(Rank, usize, usize, usize)>> = BinaryHeap::new();
    let push = |polygon: &EarPolygon<'_>, heap: &mut BinaryHeap<_>, k: usize| {
        let [before, after] = [polygon.before[k], polygon.after[k]];
        heap.push(Reverse((polygon.rank(k, is_taken), k, before, after)));
    };
    (0..n).for_each(|k| push(&polygon, &mut heap, k));
    let (mut triangles, mut left) = (Vec::with_capacity(n.saturating_sub(2)), n);
    while left > 3 {
        let Reverse((rank, k, before, after)) = heap.pop()?;
        if !polygon.is_left[k] || [before, after] != [polygon.before[k], polygon.after[k]] {
            continue;
        }
        // A vertex that was inside the ear can have been cut off since.
        let now = polygon.rank(k, is_taken);
        if now != rank {
            heap.push(Reverse((now, k, before, after)));
            continue;
        }
        if rank.0 == Kind::Impossible {
            return None;
        }
        triangles.push([before as u32, k as u32, after as u32]);
        polygon.cut(k);
        left -= 1;
        [before, after].into_iter().for_each(|k| push(&polygon, &mut heap, k));
    }
    let last: Vec<u32> = (0..n).filter(|&k| polygon.is_left[k]).map(|k| k as u32).collect();
    let last: [u32; 3] = last.try_into().ok()?;
    triangles.push(last);
    weight(last.map(|k| points[k as usize])).is_finite().then_some(triangles)
}

/// Ears of a lower kind are cut first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Kind {
    Inside,
    Outside,
    Impossible,
}

/// The order in which ears are cut: their kind, then the bits of their weight, which is positive.
type Rank = (Kind, u64);

/// A polygon from which ears are cut.
struct EarPolygon<'a> {
    points: &'a [Point],
    /// The points in the plane of the vector area.
    flat: Vec<[f64; 2]>,
    before: Vec<usize>,
    after: Vec<usize>,
    is_left: Vec<bool>,
    /// The points in cells of a square grid over the plane.
    cells: Vec<Vec<u32>>,
    low: [f64; 2],
    step: f64,
    side: usize,
}

impl<'a> EarPolygon<'a> {
    fn new(points: &'a [Point]) -> Self {
        let n = points.len();
        let from = |k: usize| vector::sub(points[k % n], points[0]);
        let area = (0..n).map(|k| vector::cross(from(k), from(k + 1))).fold([0.0; 3], vector::add);
        let normal = vector::normalised(area);
        // The axis least along the normal spans the plane with it.
        let axis =
            [1, 2].into_iter().fold(0, |best, x| if normal[x].abs() < normal[best].abs() { x } else { best });
        let first = vector::normalised(vector::cross(
            std::array::from_fn(|x| f64::from(u8::from(x == axis))),
            normal,
        ));
        let second = vector::cross(normal, first);
        let flat: Vec<[f64; 2]> =
            (0..n).map(|k| [vector::dot(from(k), first), vector::dot(from(k), second)]).collect();
        let bound = |pick: fn(f64, f64) -> f64| {
            flat.iter().copied().reduce(|a, b| [pick(a[0], b[0]), pick(a[1], b[1])]).unwrap_or_default()
        };
        let (low, high) = (bound(f64::min), bound(f64::max));
        let side = (n as f64).sqrt().ceil().max(1.0) as usize;
        let step = (high[0] - low[0]).max(high[1] - low[1]) / side as f64;
        let mut polygon = EarPolygon {
            points,
            flat,
            before: (0..n).map(|k| (k + n - 1) % n).collect(),
            after: (0..n).map(|k| (k + 1) % n).collect(),
            is_left: vec![true; n],
            cells: vec![Vec::new(); side * side],
            low,
            step,
            side,
        };
        for k in 0..n {
            let [x, y] = polygon.cell(polygon.flat[k]);
            polygon.cells[x * side + y].push(k as u32);
        }
        polygon
    }

    fn cell(&self, p: [f64; 2]) -> [usize; 2] {
        [0, 1].map(|x| {
            let cell = ((p[x] - self.low[x]) / self.step).floor();
            if cell > 0.0 { (cell as usize).min(self.side - 1) } else { 0 }
        })
    }

    fn cut(&mut self, k: usize) {
        let [before, after] = [self.before[k], self.after[k]];
        (self.after[before], self.before[after], self.is_left[k]) = (after, before, false);
        let [x, y] = self.cell(self.flat[k]);
        self.cells[x * self.side + y].retain(|&other| other as usize != k);
    }

    fn rank(&self, k: usize, is_taken: &dyn Fn(usize, usize) -> bool) -> Rank {
        let [before, after] = [self.before[k], self.after[k]];
        let weight = weight([before, k, after].map(|k| self.points[k]));
        let kind = match () {
            () if weight.is_infinite() || is_taken(before, after) => Kind::Impossible,
            () if self.is_ear(before, k, after) => Kind::Inside,
            () => Kind::Outside,
        };
        (kind, weight.to_bits())
    }

    /// True if the triangle runs counterclockwise in the plane and no vertex that is left lies in it.
    fn is_ear(&self, before: usize, k: usize, after: usize) -> bool {
        let [a, b, c] = [before, k, after].map(|k| self.flat[k]);
        let turn = |p: [f64; 2], q: [f64; 2], r: [f64; 2]| {
            (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
        };
        if turn(a, b, c) <= 0.0 {
            return false;
        }
        let bound = |pick: fn(f64, f64) -> f64| [0, 1].map(|x| pick(pick(a[x], b[x]), c[x]));
        let (low, high) = (self.cell(bound(f64::min)), self.cell(bound(f64::max)));
        let is_inside = |p: [f64; 2]| turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0;
        (low[0]..=high[0]).flat_map(|x| (low[1]..=high[1]).map(move |y| (x, y))).all(|(x, y)| {
            let others = self.cells[x * self.side + y].iter().map(|&k| k as usize);
            let mut others = others.filter(|other| ![before, k, after].contains(other));
            !others.any(|other| is_inside(self.flat[other]))
        })
    }
}
