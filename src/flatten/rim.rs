//! The border of a flat map: whether it crosses itself, by exact arithmetic, and which of its vertices come near which of its sides.

use super::step_bound::positive_roots;
use super::term::distance_to_side;
use super::upright::is_upright;
use crate::geometry::complex::{cross, dot, doubled_area, sub};
use crate::geometry::predicates::orientation;
use crate::mesh::Mesh;
use std::cmp::Ordering;

/// The sides of the border, with the surface on their left.
pub(crate) struct BorderRim {
    sides: Vec<[u32; 2]>,
    /// Per loop its vertices, with the surface on the left.
    loops: Vec<Vec<u32>>,
}

/// A rectangle around what a vertex or a side sweeps: least x and y, largest x and y.
type SweptBox = [f64; 4];

impl BorderRim {
    pub fn new(mesh: &Mesh) -> BorderRim {
        let outside = mesh.boundary_loops();
        let loops: Vec<Vec<u32>> =
            outside.iter().map(|rim| rim.iter().rev().map(|&h| mesh.tip(h).0).collect()).collect();
        let next = |rim: &Vec<u32>, k: usize| rim[(k + 1) % rim.len()];
        let sides =
            loops.iter().flat_map(|rim| (0..rim.len()).map(move |k| [rim[k], next(rim, k)])).collect();
        BorderRim { sides, loops }
    }

    pub fn n_sides(&self) -> usize {
        self.sides.len()
    }

    /// True if a map is one to one: no triangle is turned over, no two sides of the border meet but at the vertex that they share, and one
    /// loop alone runs counterclockwise. Then the number of points over a point of the plane, which is the sum of the winding numbers of
    /// the loops around it, is nowhere above 1. All by exact arithmetic on the numbers of the points.
    pub fn is_one_to_one(&self, faces: &[[u32; 3]], points: &[[f64; 2]]) -> bool {
        is_upright(faces, points) && !self.crosses(points) && self.n_counterclockwise(points) == 1
    }

    /// True if two sides of the border meet elsewhere than at the vertex that they share.
    pub fn crosses(&self, points: &[[f64; 2]]) -> bool {
        let boxes: Vec<SweptBox> =
            self.sides.iter().map(|side| box_of(side.map(|v| points[v as usize]))).collect();
        let mut crossed = false;
        meeting(&boxes, &boxes, |i, j| {
            crossed = crossed || (i < j && sides_meet(self.sides[i], self.sides[j], points));
        });
        crossed
    }

    /// The pairs of sides that meet elsewhere than at the vertex that they share, each pair ascending, in ascending order.
    pub fn crossings(&self, points: &[[f64; 2]]) -> Vec<[usize; 2]> {
        let boxes: Vec<SweptBox> =
            self.sides.iter().map(|side| box_of(side.map(|v| points[v as usize]))).collect();
        let mut found = Vec::new();
        meeting(&boxes, &boxes, |i, j| {
            if i < j && sides_meet(self.sides[i], self.sides[j], points) {
                found.push([i, j]);
            }
        });
        found.sort_unstable();
        found
    }

    /// The vertices of the loops, with the surface on the left.
    pub fn loops(&self) -> &[Vec<u32>] {
        &self.loops
    }

    /// The number of loops that run counterclockwise, of loops that do not cross themselves: by the turn at the lowest vertex.
    fn n_counterclockwise(&self, points: &[[f64; 2]]) -> usize {
        let at = |v: u32| points[v as usize];
        let lower = |p: [f64; 2], q: [f64; 2]| p[1].total_cmp(&q[1]).then(p[0].total_cmp(&q[0]));
        let is_left = |rim: &&Vec<u32>| {
            let n = rim.len();
            let lowest = (0..n).min_by(|&i, &j| lower(at(rim[i]), at(rim[j]))).unwrap_or(0);
            let [a, b, c] = [n - 1, 0, 1].map(|k| at(rim[(lowest + k) % n]));
            orientation(a, b, c) == Ordering::Greater
        };
        self.loops.iter().filter(is_left).count()
    }

    /// The pairs of a vertex and a side that it does not end whose distance is below `reach`.
    pub fn near(&self, points: &[[f64; 2]], reach: f64) -> Vec<[u32; 3]> {
        let at = |v: u32| points[v as usize];
        let vertices: Vec<u32> = self.sides.iter().map(|side| side[0]).collect();
        let dots: Vec<SweptBox> = vertices.iter().map(|&v| grown(box_of([at(v); 2]), reach)).collect();
        let boxes: Vec<SweptBox> = self.sides.iter().map(|side| box_of(side.map(at))).collect();
        let mut found = Vec::new();
        meeting(&dots, &boxes, |i, j| {
            let ([a, b], v) = (self.sides[j], vertices[i]);
            if v != a && v != b && distance_to_side([v, a, b].map(at)) < reach {
                found.push([v, a, b]);
            }
        });
        found.sort_unstable();
        found
    }

    /// The least time, at most `until`, at which a vertex of the border meets a side along a direction; infinite if none does.
    pub fn time_to_meet(&self, points: &[[f64; 2]], direction: &[[f64; 2]], until: f64) -> f64 {
        let end = |v: u32| {
            let (p, d) = (points[v as usize], direction[v as usize]);
            [p[0] + until * d[0], p[1] + until * d[1]]
        };
        let swept = |v: u32| box_of([points[v as usize], end(v)]);
        let vertices: Vec<u32> = self.sides.iter().map(|side| side[0]).collect();
        let dots: Vec<SweptBox> = vertices.iter().map(|&v| swept(v)).collect();
        let boxes: Vec<SweptBox> = self.sides.iter().map(|&[a, b]| joined(swept(a), swept(b))).collect();
        let mut least = f64::INFINITY;
        meeting(&dots, &boxes, |i, j| {
            let ([a, b], v) = (self.sides[j], vertices[i]);
            if v != a && v != b {
                let from = |all: &[[f64; 2]]| [v, a, b].map(|k| all[k as usize]);
                least = least.min(time_on_side(from(points), from(direction)));
            }
        });
        least
    }
}

fn box_of([p, q]: [[f64; 2]; 2]) -> SweptBox {
    [p[0].min(q[0]), p[1].min(q[1]), p[0].max(q[0]), p[1].max(q[1])]
}

fn joined(a: SweptBox, b: SweptBox) -> SweptBox {
    [a[0].min(b[0]), a[1].min(b[1]), a[2].max(b[2]), a[3].max(b[3])]
}

fn grown([x, y, z, w]: SweptBox, by: f64) -> SweptBox {
    [x - by, y - by, z + by, w + by]
}

/// Calls for all pairs of boxes of two lists that meet, found by a sweep along x.
fn meeting(first: &[SweptBox], second: &[SweptBox], mut call: impl FnMut(usize, usize)) {
    let by_start = |boxes: &[SweptBox]| {
        let mut order: Vec<usize> = (0..boxes.len()).collect();
        order.sort_unstable_by(|&i, &j| boxes[i][0].total_cmp(&boxes[j][0]).then(i.cmp(&j)));
        order
    };
    let orders = [by_start(first), by_start(second)];
    let lists = [first, second];
    let (mut next, mut open) = ([0, 0], [Vec::<usize>::new(), Vec::new()]);
    loop {
        let start = |k: usize| orders[k].get(next[k]).map(|&i| lists[k][i][0]);
        let k = match (start(0), start(1)) {
            (Some(x), Some(y)) => usize::from(y < x),
            (Some(_), None) => 0,
            (None, Some(_)) => 1,
            (None, None) => return,
        };
        let i = orders[k][next[k]];
        next[k] += 1;
        let own = lists[k][i];
        open[1 - k].retain(|&j| lists[1 - k][j][2] >= own[0]);
        for &j in &open[1 - k] {
            let other = lists[1 - k][j];
            if other[1] <= own[3] && own[1] <= other[3] {
                if k == 0 { call(i, j) } else { call(j, i) }
            }
        }
        open[k].push(i);
    }
}

/// True if two different sides meet elsewhere than at a vertex that ends both.
fn sides_meet(one: [u32; 2], two: [u32; 2], points: &[[f64; 2]]) -> bool {
    let at = |v: u32| points[v as usize];
    if let Some(&shared) = one.iter().find(|v| two.contains(v)) {
        // They meet elsewhere only if one lies along the other.
        let other = |side: [u32; 2]| at(if side[0] == shared { side[1] } else { side[0] });
        let (p, q, o) = (other(one), other(two), at(shared));
        return orientation(o, p, q) == Ordering::Equal && dot(sub(p, o), sub(q, o)) > 0.0;
    }
    let ([a, b], [c, d]) = (one.map(at), two.map(at));
    let [from_c, from_d, from_a, from_b] =
        [orientation(a, b, c), orientation(a, b, d), orientation(c, d, a), orientation(c, d, b)];
    let all_on_a_line = [from_c, from_d, from_a, from_b].iter().all(|o| o.is_eq());
    // On one line sides meet if their boxes do, as they do here.
    all_on_a_line || (from_c != from_d && from_a != from_b)
}

/// The least positive time at which a moving point is on a moving segment: corners p + t d of the point and the segment's ends.
fn time_on_side(p: [[f64; 2]; 3], d: [[f64; 2]; 3]) -> f64 {
    let ([u, v], [du, dv]) = ([sub(p[1], p[0]), sub(p[2], p[0])], [sub(d[1], d[0]), sub(d[2], d[0])]);
    let roots = positive_roots(doubled_area(p), cross(du, v) + cross(u, dv), cross(du, dv));
    let is_between = |t: &f64| {
        let [to_a, to_b] = [(u, du), (v, dv)].map(|(x, dx)| [x[0] + t * dx[0], x[1] + t * dx[1]]);
        // A little beyond the ends counts too: other pairs of the same corner may be rounded away.
        let way = sub(to_b, to_a);
        let (along, whole) = (-dot(to_a, way), dot(way, way));
        (-NEAR_END * whole..=(1.0 + NEAR_END) * whole).contains(&along)
    };
    roots.into_iter().filter(is_between).fold(f64::INFINITY, f64::min)
}

/// The part of a side's length by which a point beyond its end still counts as met.
const NEAR_END: f64 = 1e-6;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::shapes;

    /// An annulus of triangles, and its points in the plane.
    fn annulus() -> (Mesh, Vec<[f64; 2]>) {
        let soup = shapes::annulus(0.5, 1.0, 2, 12).unwrap();
        let points = soup.positions.iter().map(|p| [p[0], p[1]]).collect();
        (Mesh::from_soup(&soup).unwrap(), points)
    }

    #[test]
    fn one_loop_of_an_annulus_runs_counterclockwise_and_no_sides_meet() {
        let (mesh, points) = annulus();
        let rim = BorderRim::new(&mesh);
        assert_eq!((rim.n_sides(), rim.n_counterclockwise(&points)), (24, 1));
        assert!(rim.is_one_to_one(&mesh.triangles(), &points) && !rim.crosses(&points));
        // An inner vertex is pulled over the outer loop.
        let inner = (0..points.len()).find(|&v| points[v][0].hypot(points[v][1]) < 0.51).unwrap();
        let mut pulled = points.clone();
        pulled[inner] = points[inner].map(|x| 3.0 * x);
        assert!(rim.crosses(&pulled) && !rim.is_one_to_one(&mesh.triangles(), &pulled));
    }

    #[test]
    fn sides_that_touch_meet() {
        let points = [[0.0, 0.0], [2.0, 0.0], [1.0, 0.0], [1.0, 1.0], [3.0, 0.0], [1.0, -1.0], [1.0, 5e-324]];
        assert!(sides_meet([0, 1], [2, 3], &points));
        assert!(!sides_meet([0, 1], [6, 3], &points));
        assert!(sides_meet([0, 1], [3, 5], &points));
        // Along each other: past a shared end, or back from it.
        assert!(sides_meet([0, 1], [2, 4], &points) && sides_meet([0, 1], [1, 2], &points));
        assert!(!sides_meet([0, 2], [2, 1], &points));
    }

    #[test]
    fn a_vertex_meets_a_side_in_time_or_passes_it() {
        let points = [[0.0, 1.0], [-1.0, 0.0], [1.0, 0.0]];
        let fall = |x: f64| time_on_side(points, [[x, -2.0], [0.0; 2], [0.0; 2]]);
        assert_eq!((fall(0.0), fall(1.0), fall(4.0)), (0.5, 0.5, f64::INFINITY));
        // The side comes to meet it.
        assert_eq!(time_on_side(points, [[0.0, -1.0], [0.0, 1.0], [0.0, 1.0]]), 0.5);
    }

    #[test]
    fn near_pairs_are_those_of_all_pairs() {
        let (mesh, points) = annulus();
        let rim = BorderRim::new(&mesh);
        let reach = 0.4;
        let mut all = Vec::new();
        for &[v, _] in &rim.sides {
            for &[a, b] in &rim.sides {
                let at = [v, a, b].map(|k| points[k as usize]);
                if v != a && v != b && distance_to_side(at) < reach {
                    all.push([v, a, b]);
                }
            }
        }
        all.sort_unstable();
        assert!(!all.is_empty() && rim.near(&points, reach) == all);
    }
}
