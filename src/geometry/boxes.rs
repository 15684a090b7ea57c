//! Trees of axis-parallel boxes in single precision, rounded outwards so that each contains its f64 box.

use super::bounds::Bounds;
use super::vector::Vector;
use glam::Vec3A;
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2;
use std::time::Duration;

/// A tree of boxes, whose root is node 0.
#[derive(Clone)]
pub(crate) struct BoundsTree {
    /// The tree, in coordinates from −1 to 1.
    tree: Bvh2,
    middle: Vector,
    /// Half of the largest extent.
    size: f64,
}

/// The children of a node.
pub(crate) enum BoundsNode<'a> {
    Inner([usize; 2]),
    /// The numbers of the boxes of a leaf.
    Leaf(&'a [u32]),
}

impl BoundsTree {
    /// The tree of these boxes, which keep their numbers.
    pub fn new(boxes: &[Bounds]) -> BoundsTree {
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
        BoundsTree { tree, middle, size }
    }

    /// A lower bound of the distance from a point to the boxes of a node: 0 inside.
    pub fn distance(&self, node: usize, point: Vector) -> f64 {
        let Aabb { min, max } = self.tree.nodes[node].aabb();
        let (low, high) = (min.to_array(), max.to_array());
        let beyond = |x: usize| {
            let seen = (point[x] - self.middle[x]) / self.size;
            (f64::from(low[x]) - seen).max(seen - f64::from(high[x])).max(0.0)
        };
        [0, 1, 2].map(|x| beyond(x) * beyond(x)).iter().sum::<f64>().sqrt() * self.size
    }

    pub fn node(&self, node: usize) -> BoundsNode<'_> {
        let of = &self.tree.nodes[node];
        let first = of.first_index as usize;
        if of.is_leaf() {
            BoundsNode::Leaf(&self.tree.primitive_indices[first..first + of.prim_count as usize])
        } else {
            BoundsNode::Inner([first, first + 1])
        }
    }
}
