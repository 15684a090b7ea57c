//! Trees of axis-parallel boxes, in single precision: none is smaller than what it has to contain.

use super::bounds::Bounds;
use super::vector::Vector;
use glam::Vec3A;
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2;
use std::time::Duration;

/// Boxes in a tree, whose root is node 0.
#[derive(Clone)]
pub(crate) struct Boxes {
    /// In coordinates from −1 to 1.
    tree: Bvh2,
    middle: Vector,
    /// Half of the largest extent.
    size: f64,
}

/// What lies below a node.
pub(crate) enum Node<'a> {
    Inner([usize; 2]),
    /// Numbers of boxes.
    Leaf(&'a [u32]),
}

impl Boxes {
    /// Of boxes, which keep their order.
    pub fn new(boxes: &[Bounds]) -> Boxes {
        let all = boxes.iter().copied().reduce(Bounds::union).unwrap_or(Bounds::of([]));
        let middle = [0, 1, 2].map(|x| 0.5 * all.low[x] + 0.5 * all.high[x]);
        let size = (0..3).map(|x| 0.5 * all.high[x] - 0.5 * all.low[x]).fold(0.0, f64::max);
        let size = if size > 0.0 { size } else { 1.0 };
        // Rounded to single precision away from the box.
        let single = |p: Vector, round: fn(f32) -> f32| {
            Vec3A::from([0, 1, 2].map(|x| round(((p[x] - middle[x]) / size) as f32)))
        };
        let boxes: Vec<Aabb> = boxes
            .iter()
            .map(|b| Aabb::new(single(b.low, f32::next_down), single(b.high, f32::next_up)))
            .collect();
        let params = BvhBuildParams { max_prims_per_leaf: 1, ..BvhBuildParams::medium_build() };
        let tree = build_bvh2(&boxes, params, &mut Duration::default());
        Boxes { tree, middle, size }
    }

    /// How far a point is from the box of a node at least: 0 in it.
    pub fn distance(&self, node: usize, point: Vector) -> f64 {
        let Aabb { min, max } = self.tree.nodes[node].aabb();
        let (low, high) = (min.to_array(), max.to_array());
        let beyond = |x: usize| {
            let seen = (point[x] - self.middle[x]) / self.size;
            (f64::from(low[x]) - seen).max(seen - f64::from(high[x])).max(0.0)
        };
        beyond(0).hypot(beyond(1)).hypot(beyond(2)) * self.size
    }

    pub fn node(&self, node: usize) -> Node<'_> {
        let of = &self.tree.nodes[node];
        let first = of.first_index as usize;
        match of.is_leaf() {
            false => Node::Inner([first, first + 1]),
            true => Node::Leaf(&self.tree.primitive_indices[first..first + of.prim_count as usize]),
        }
    }
}
