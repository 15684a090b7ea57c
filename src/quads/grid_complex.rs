//! The squares of an integer-grid map: each rectangle of a T-mesh divided into unit squares, glued along arcs. Arcs of length 0 and
//! rectangles without width bring their points together.

use super::collapse::RawQuads;
use super::t_mesh::{HalfArc, TMesh, TRectangle};
use crate::mesh::union_find::UnionFind;

/// Points and squares, numbered node by node, arc by arc, rectangle by rectangle.
pub(super) struct GridComplex<'a> {
    t_mesh: &'a TMesh,
    numbers: &'a [i64],
    /// Per arc the number of its first inner point.
    arc_start: Vec<u32>,
    /// Per rectangle the number of its first inner point.
    rectangle_start: Vec<u32>,
    /// The number of points.
    pub n_points: usize,
    /// The number of points at nodes and on arcs, which come first.
    pub n_arc_points: usize,
}

/// The points along the sides of a rectangle: bottom and top from left to right, left and right from bottom to top.
pub(super) struct RectangleSides {
    pub bottom: Vec<u32>,
    pub right: Vec<u32>,
    pub top: Vec<u32>,
    pub left: Vec<u32>,
}

impl<'a> GridComplex<'a> {
    pub fn new(t_mesh: &'a TMesh, numbers: &'a [i64]) -> GridComplex<'a> {
        let mut complex = GridComplex {
            t_mesh,
            numbers,
            arc_start: Vec::new(),
            rectangle_start: Vec::new(),
            n_points: 0,
            n_arc_points: 0,
        };
        let mut next = t_mesh.nodes.len();
        for &n in numbers {
            complex.arc_start.push(next as u32);
            next += (n - 1).max(0) as usize;
        }
        complex.n_arc_points = next;
        for rectangle in &t_mesh.rectangles {
            complex.rectangle_start.push(next as u32);
            let [m, n] = complex.size(rectangle);
            next += (m.saturating_sub(1)) * (n.saturating_sub(1));
        }
        complex.n_points = next;
        complex
    }

    /// The squares along the first and the second side of a rectangle.
    pub fn size(&self, rectangle: &TRectangle) -> [usize; 2] {
        [0, 1].map(|k| rectangle.sides[k].iter().map(|h| self.numbers[h / 2]).sum::<i64>().max(0) as usize)
    }

    /// The number of squares.
    pub fn n_squares(&self) -> usize {
        self.t_mesh.rectangles.iter().map(|r| self.size(r).iter().product::<usize>()).sum()
    }

    /// The point of an arc at this distance from the half-arc's beginning.
    pub fn arc_point(&self, h: HalfArc, k: i64) -> u32 {
        let n = self.numbers[h / 2];
        if k == 0 {
            return self.t_mesh.origin(h) as u32;
        }
        if k == n {
            return self.t_mesh.tip(h) as u32;
        }
        let from_first = if h.is_multiple_of(2) { k } else { n - k };
        self.arc_start[h / 2] + (from_first - 1) as u32
    }

    /// The points along a side, in its direction.
    fn side(&self, side: &[HalfArc]) -> Vec<u32> {
        let mut points: Vec<u32> = side.first().map(|&h| self.t_mesh.origin(h) as u32).into_iter().collect();
        for &h in side {
            points.extend((1..=self.numbers[h / 2]).map(|k| self.arc_point(h, k)));
        }
        points
    }

    pub fn sides(&self, rectangle: &TRectangle) -> RectangleSides {
        let [bottom, right, mut top, mut left] = [0, 1, 2, 3].map(|k| self.side(&rectangle.sides[k]));
        top.reverse();
        left.reverse();
        // An arc of length 0 at the end of a reversed side leaves its first node in the list; both are one point.
        RectangleSides { bottom, right, top, left }
    }

    /// The number of an inner point of a rectangle.
    pub fn inner_point(&self, r: usize, [m, _]: [usize; 2], [i, j]: [usize; 2]) -> u32 {
        self.rectangle_start[r] + ((j - 1) * (m - 1) + i - 1) as u32
    }

    /// The point of a rectangle in column i and row j.
    pub fn point(&self, r: usize, size: [usize; 2], sides: &RectangleSides, [i, j]: [usize; 2]) -> u32 {
        let [m, n] = size;
        match (i, j) {
            (_, 0) => sides.bottom[i],
            (_, j) if j == n => sides.top[i],
            (0, _) => sides.left[j],
            (i, _) if i == m => sides.right[j],
            _ => self.inner_point(r, size, [i, j]),
        }
    }

    /// The points that are the same, among the first so many: all of them, or those at nodes and on arcs.
    pub fn identified(&self, n_points: usize) -> UnionFind {
        let mut same = UnionFind::new(n_points);
        for (arc, _) in self.numbers.iter().enumerate().filter(|(_, n)| **n == 0) {
            same.join(self.t_mesh.origin(2 * arc) as u32, self.t_mesh.tip(2 * arc) as u32);
        }
        for rectangle in &self.t_mesh.rectangles {
            let [m, n] = self.size(rectangle);
            if m > 0 && n > 0 {
                continue;
            }
            let sides = self.sides(rectangle);
            let pairs = if m == 0 { [&sides.left, &sides.right] } else { [&sides.bottom, &sides.top] };
            pairs[0].iter().zip(pairs[1]).for_each(|(&a, &b)| {
                same.join(a, b);
            });
        }
        same
    }

    /// The corners of all squares, counterclockwise, as points that are not yet identified; and per square its rectangle.
    pub fn squares(&self) -> (Vec<[u32; 4]>, Vec<u32>) {
        let mut squares = Vec::new();
        let mut of = Vec::new();
        for (r, rectangle) in self.t_mesh.rectangles.iter().enumerate() {
            let size = self.size(rectangle);
            let sides = self.sides(rectangle);
            for j in 0..size[1] {
                for i in 0..size[0] {
                    let corners = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]];
                    squares.push(corners.map(|at| self.point(r, size, &sides, at)));
                    of.push(r as u32);
                }
            }
        }
        (squares, of)
    }

    /// The edges on the boundary.
    pub fn border_edges(&self) -> Vec<[u32; 2]> {
        let mut sides = vec![0; self.numbers.len()];
        let rectangles = self.t_mesh.rectangles.iter();
        rectangles.flat_map(|r| r.sides.iter().flatten()).for_each(|h| sides[h / 2] += 1);
        let border = (0..sides.len()).filter(|&a| sides[a] < 2);
        let edges =
            |a: usize| (0..self.numbers[a]).map(move |k| [k, k + 1].map(|k| self.arc_point(2 * a, k)));
        border.flat_map(edges).collect()
    }

    /// Points, each standing for all that are the same, at ends of edges that are not the only ones between these ends, once quads with two
    /// sides in one edge are collapsed; and at corners that a quad has twice.
    pub fn repeated_edges(&self) -> Vec<usize> {
        let mut same = self.identified(self.n_points);
        let (mut quads, rectangle) = self.squares();
        quads.iter_mut().flatten().for_each(|p| *p = same.root(*p));
        let mut is_border = vec![false; self.n_points];
        let border: Vec<[u32; 2]> =
            self.border_edges().into_iter().map(|ends| ends.map(|p| same.root(p))).collect();
        border.iter().flatten().for_each(|&p| is_border[p as usize] = true);
        let mut raw = RawQuads { quads, rectangle, creases: Vec::new(), is_border };
        let (points, _) = raw.collapse_single_corners((0..self.n_points).collect());
        let mut sides = Vec::with_capacity(4 * raw.quads.len());
        let mut repeated = Vec::new();
        for quad in &raw.quads {
            for k in 0..4 {
                let side = [quad[k], quad[(k + 1) % 4]];
                sides.push(side);
                if side[0] == side[1] || side[0] == quad[(k + 2) % 4] {
                    repeated.extend(side);
                }
            }
        }
        sides.sort_unstable();
        let twice = sides.windows(2).filter(|pair| pair[0] == pair[1]);
        repeated.extend(twice.flat_map(|pair| pair[0]));
        // Beyond an edge of the boundary there is no quad; a hole of two edges looks as if it were closed.
        for ends in border {
            let numbers = ends.map(|p| points.binary_search(&(p as usize)));
            if let [Ok(a), Ok(b)] = numbers.map(|found| found.map(|v| v as u32)) {
                let is_side = |side: [u32; 2]| sides.binary_search(&side).is_ok();
                if is_side([a, b]) && is_side([b, a]) {
                    repeated.extend([a, b]);
                }
            }
        }
        repeated.sort_unstable();
        repeated.dedup();
        repeated.into_iter().map(|v| points[v as usize]).collect()
    }
}
