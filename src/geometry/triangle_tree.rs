//! The nearest points of triangles in space.

use super::bounds::Bounds;
use super::boxes::{BoundsNode, BoundsTree};
use super::vector::{Vector, add, cross, dot, norm, scale, sub};

/// Triangles in a tree of their boxes.
pub(crate) struct TriangleTree {
    triangles: Vec<[Vector; 3]>,
    tree: BoundsTree,
}

/// The point of some triangles that is nearest to another point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct NearestOfTriangles {
    /// The triangle; of several the one with the smallest number.
    pub triangle: usize,
    /// Barycentric coordinates in it.
    pub weights: [f64; 3],
    /// The distance; infinite if there is no triangle.
    pub distance: f64,
}

impl TriangleTree {
    pub fn new(triangles: Vec<[Vector; 3]>) -> TriangleTree {
        let boxes: Vec<Bounds> = triangles.iter().map(|corners| Bounds::of(*corners)).collect();
        TriangleTree { tree: BoundsTree::new(&boxes), triangles }
    }

    pub fn nearest(&self, point: Vector) -> NearestOfTriangles {
        self.search(point, f64::INFINITY, &|_| true)
    }

    /// The nearest point of the triangles whose normal is at an acute angle to a direction, if one is within a distance.
    #[cfg(any(feature = "splines", test))]
    pub fn nearest_facing(
        &self,
        point: Vector,
        direction: Vector,
        within: f64,
    ) -> Option<NearestOfTriangles> {
        let is_facing = |t: usize| {
            let [a, b, c] = self.triangles[t];
            dot(cross(sub(b, a), sub(c, a)), direction) > 0.0
        };
        let found = self.search(point, within, &is_facing);
        (found.distance < within).then_some(found)
    }

    /// The nearest point of triangles of a kind nearer than a distance, which is that of the result where there is none.
    fn search(&self, point: Vector, within: f64, is_wanted: &dyn Fn(usize) -> bool) -> NearestOfTriangles {
        let mut best =
            NearestOfTriangles { triangle: usize::MAX, weights: [1.0, 0.0, 0.0], distance: within };
        let mut open = vec![(self.tree.distance(0, point), 0)];
        while let Some((least, node)) = open.pop() {
            if least > best.distance {
                continue;
            }
            match self.tree.node(node) {
                BoundsNode::Inner(children) => {
                    let mut both = children.map(|child| (self.tree.distance(child, point), child));
                    both.sort_by(|a, b| b.0.total_cmp(&a.0));
                    open.extend(both);
                }
                BoundsNode::Leaf(triangles) => {
                    for t in triangles.iter().map(|&t| t as usize).filter(|&t| is_wanted(t)) {
                        let corners = self.triangles[t];
                        let weights = nearest_weights(corners, point);
                        let distance = norm(sub(combined(weights, corners), point));
                        if (distance, t) < (best.distance, best.triangle) {
                            best = NearestOfTriangles { triangle: t, weights, distance };
                        }
                    }
                }
            }
        }
        best.triangle = if best.triangle == usize::MAX { 0 } else { best.triangle };
        best
    }
}

/// The point of a triangle with these barycentric coordinates.
pub(crate) fn combined(weights: [f64; 3], [a, b, c]: [Vector; 3]) -> Vector {
    [0, 1, 2].map(|x| weights[0] * a[x] + weights[1] * b[x] + weights[2] * c[x])
}

/// The barycentric coordinates of the point of a triangle that is nearest to a point [Eri05, §5.1.5].
pub(crate) fn nearest_weights([a, b, c]: [Vector; 3], point: Vector) -> [f64; 3] {
    let (ab, ac) = (sub(b, a), sub(c, a));
    let normal = cross(ab, ac);
    let square = dot(normal, normal);
    let to = sub(point, a);
    let [v, w] = [dot(cross(to, ac), normal) / square, dot(cross(ab, to), normal) / square];
    let inside = [1.0 - v - w, v, w];
    if inside.iter().all(|&x| x >= 0.0) {
        return inside;
    }
    let corners = [a, b, c];
    let on_side = |k: usize| {
        let (from, along) = (corners[k], sub(corners[(k + 1) % 3], corners[k]));
        let t = (dot(sub(point, from), along) / dot(along, along)).clamp(0.0, 1.0);
        let mut weights = [0.0; 3];
        (weights[k], weights[(k + 1) % 3]) = (1.0 - t, t);
        (norm(sub(add(from, scale(t, along)), point)), weights)
    };
    let [first, second, third] = [0, 1, 2].map(on_side);
    [second, third].into_iter().fold(first, |best, side| if side.0 < best.0 { side } else { best }).1
}

#[cfg(test)]
mod tests {
    use super::TriangleTree;

    #[test]
    fn nearest_points_of_two_triangles() {
        let low = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let tree = TriangleTree::new(vec![low, low.map(|[x, y, _]| [x, y, 1.0])]);
        let above = tree.nearest([0.25, 0.25, 0.75]);
        assert_eq!((above.triangle, above.distance, above.weights), (1, 0.25, [0.5, 0.25, 0.25]));
        let beside = tree.nearest([-3.0, 0.0, -4.0]);
        assert_eq!((beside.triangle, beside.distance, beside.weights), (0, 5.0, [1.0, 0.0, 0.0]));
    }

    #[test]
    fn nearest_points_that_face_a_direction() {
        let low = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let [a, b, c] = low.map(|[x, y, _]| [x, y, 1.0]);
        let tree = TriangleTree::new(vec![low, [a, c, b]]);
        let up = tree.nearest_facing([0.25, 0.25, 0.75], [0.1, 0.0, 1.0], 0.8).unwrap();
        assert_eq!((up.triangle, up.distance), (0, 0.75));
        assert_eq!(tree.nearest_facing([0.25, 0.25, 0.75], [0.1, 0.0, 1.0], 0.7), None);
        let down = tree.nearest_facing([0.25, 0.25, 0.75], [0.1, 0.0, -1.0], 0.8).unwrap();
        assert_eq!((down.triangle, down.distance), (1, 0.25));
    }
}
