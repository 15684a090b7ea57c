//! Overlaps of triangles in the plane, found by exact arithmetic and without a test of every pair.
//!
//! ```
//! use ricci::{Control, geometry::triangle_overlap::overlapping};
//! # fn main() -> ricci::Result<()> {
//! let left = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
//! let right = [[1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
//! assert!(overlapping(&[left, right], &Control::new())?.is_empty());
//! assert_eq!(overlapping(&[left, right, left], &Control::new())?, [2]);
//! # Ok(())
//! # }
//! ```

use super::predicates::orientation;
use crate::control::Control;
use crate::error::Result;
use std::cmp::Ordering;

/// Number of triangles after which the control is asked again whether to stop.
const TRIANGLES_PER_STEP: usize = 4096;

/// The corners of a triangle in the plane.
pub type TriangleCorners = [[f64; 2]; 3];

/// True if the interiors of two counterclockwise triangles meet, not only their sides or corners. Exact.
///
/// Two convex polygons whose interiors do not meet are separated by the line of a side of one of them.
pub fn interiors_meet(a: &TriangleCorners, b: &TriangleCorners) -> bool {
    let separates = |a: &TriangleCorners, b: &TriangleCorners| {
        (0..3).any(|k| b.iter().all(|&p| orientation(a[k], a[(k + 1) % 3], p) != Ordering::Greater))
    };
    !separates(a, b) && !separates(b, a)
}

/// A tree of the bounding boxes of triangles, for searches among those that are marked as *present*.
///
/// The tree is built once over all triangles, by halving along the longer side of the box of their centres. Each node counts the present
/// triangles below it, and a search only enters nodes that have some. Unlike a grid, the tree suits triangles whose sizes differ by any
/// factor. Adding and removing take O(log n), a search O(log n) and the number of boxes that it meets.
pub struct BoxTree<'a> {
    triangles: &'a [TriangleCorners],
    /// The number of leaves, a power of two; leaf k is node `leaves + k`, the children of node i are 2i and 2i + 1.
    leaves: usize,
    /// Per leaf, its triangle.
    order: Vec<u32>,
    /// TriangleCorners → leaf.
    leaf: Vec<u32>,
    /// Per node, the least x and y, then the largest x and y.
    boxes: Vec<[f64; 4]>,
    /// Per node, the number of present triangles below it.
    present: Vec<u32>,
}

const EMPTY: [f64; 4] = [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY];

impl<'a> BoxTree<'a> {
    /// The tree of triangles with finite coordinates, none of which is present yet. O(n log n).
    ///
    /// # Errors
    /// [`crate::Error::Cancelled`].
    pub fn new(triangles: &'a [TriangleCorners], control: &Control) -> Result<BoxTree<'a>> {
        let n = triangles.len();
        let leaves = n.next_power_of_two();
        let mut order: Vec<u32> = (0..n as u32).collect();
        halve(triangles, &mut order, leaves, control)?;
        let mut leaf = vec![0; n];
        order.iter().enumerate().for_each(|(k, &f)| leaf[f as usize] = k as u32);
        let mut boxes = vec![EMPTY; 2 * leaves];
        order.iter().enumerate().for_each(|(k, &f)| boxes[leaves + k] = bounds(&triangles[f as usize]));
        for i in (1..leaves).rev() {
            boxes[i] = join(boxes[2 * i], boxes[2 * i + 1]);
        }
        control.check()?;
        Ok(BoxTree { triangles, leaves, order, leaf, boxes, present: vec![0; 2 * leaves] })
    }

    /// Makes a triangle present; it must be counterclockwise and not be present yet.
    pub fn insert(&mut self, f: usize) {
        self.update(f, |count| *count += 1);
    }

    /// Makes a present triangle absent.
    pub fn remove(&mut self, f: usize) {
        self.update(f, |count| *count -= 1);
    }

    fn update(&mut self, f: usize, change: impl Fn(&mut u32)) {
        let mut node = self.leaves + self.leaf[f] as usize;
        while node > 0 {
            change(&mut self.present[node]);
            node /= 2;
        }
    }

    /// Some present triangle whose interior meets that of the counterclockwise triangle f, which is not present itself.
    pub fn meeting(&self, f: usize) -> Option<usize> {
        let (triangle, around) = (&self.triangles[f], self.boxes[self.leaves + self.leaf[f] as usize]);
        let apart =
            |b: [f64; 4]| b[0] >= around[2] || around[0] >= b[2] || b[1] >= around[3] || around[1] >= b[3];
        let mut open = vec![1];
        while let Some(node) = open.pop() {
            if self.present.get(node).is_none_or(|&count| count == 0) || apart(self.boxes[node]) {
                continue;
            }
            if node < self.leaves {
                open.extend([2 * node, 2 * node + 1]);
                continue;
            }
            let other = self.order[node - self.leaves] as usize;
            if interiors_meet(triangle, &self.triangles[other]) {
                return Some(other);
            }
        }
        None
    }
}

/// The triangles, ascending, whose interiors meet that of an earlier triangle that is not in this list itself. Clockwise triangles count as
/// their counterclockwise copies, and triangles without area meet nothing. Exact.
///
/// # Errors
/// [`crate::Error::Cancelled`].
pub fn overlapping(triangles: &[TriangleCorners], control: &Control) -> Result<Vec<usize>> {
    let turned: Vec<TriangleCorners> = triangles
        .iter()
        .map(|&[a, b, c]| if orientation(a, b, c) == Ordering::Less { [a, c, b] } else { [a, b, c] })
        .collect();
    let mut tree = BoxTree::new(&turned, control)?;
    let mut found = Vec::new();
    for (f, &[a, b, c]) in turned.iter().enumerate() {
        if f.is_multiple_of(TRIANGLES_PER_STEP) {
            control.check()?;
        }
        if orientation(a, b, c) != Ordering::Greater {
            continue;
        }
        if tree.meeting(f).is_some() {
            found.push(f);
        } else {
            tree.insert(f);
        }
    }
    Ok(found)
}

/// Orders the triangles below a node with this number of leaves so that its two halves lie on different sides of a line along an axis, and
/// so on down to the leaves.
fn halve(triangles: &[TriangleCorners], order: &mut [u32], leaves: usize, control: &Control) -> Result<()> {
    let half = leaves / 2;
    if half == 0 || order.len() <= 1 {
        return Ok(());
    }
    if order.len() >= TRIANGLES_PER_STEP {
        control.check()?;
    }
    if order.len() > half {
        let centre = |f: u32, k: usize| triangles[f as usize].iter().map(|p| p[k] / 3.0).sum::<f64>();
        let extent = |k: usize| {
            let range = order.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], &f| {
                [low.min(centre(f, k)), high.max(centre(f, k))]
            });
            range[1] - range[0]
        };
        let k = usize::from(extent(1) > extent(0));
        order.select_nth_unstable_by(half, |&f, &g| centre(f, k).total_cmp(&centre(g, k)).then(f.cmp(&g)));
        let (left, right) = order.split_at_mut(half);
        halve(triangles, left, half, control)?;
        halve(triangles, right, half, control)
    } else {
        halve(triangles, order, half, control)
    }
}

fn bounds(triangle: &TriangleCorners) -> [f64; 4] {
    triangle.iter().fold(EMPTY, |b, &[x, y]| join(b, [x, y, x, y]))
}

fn join(a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
    [a[0].min(b[0]), a[1].min(b[1]), a[2].max(b[2]), a[3].max(b[3])]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::clip::clip;
    use crate::geometry::random::SplitMix64;

    /// The area of the intersection, by clipping one triangle with the sides of the other.
    fn common_area(a: &TriangleCorners, b: &TriangleCorners) -> f64 {
        let mut polygon = a.to_vec();
        for k in 0..3 {
            let (p, q) = (b[k], b[(k + 1) % 3]);
            let side = |r: &[f64; 2]| (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
            polygon = clip(&polygon, side);
        }
        let cross = |i: usize| {
            let (p, q) = (polygon[i], polygon[(i + 1) % polygon.len()]);
            p[0] * q[1] - p[1] * q[0]
        };
        0.5 * (0..polygon.len()).map(cross).sum::<f64>()
    }

    fn triangles(n: usize, seed: u64) -> Vec<TriangleCorners> {
        let mut random = SplitMix64::new(seed);
        let mut next = || {
            let size = 0.001f64.powf(random.unit());
            let at = [random.unit(), random.unit()];
            let corner = [0; 3].map(|_| at.map(|x| x + size * (random.unit() - 0.5)));
            let [a, b, c] = corner;
            if orientation(a, b, c) == Ordering::Less { [a, c, b] } else { corner }
        };
        (0..n).map(|_| next()).collect()
    }

    #[test]
    fn triangles_overlap_where_their_intersection_has_area() {
        let all = triangles(120, 5);
        let mut meeting = 0;
        for a in &all {
            for b in &all {
                let area = common_area(a, b);
                if area.abs() > 1e-12 || !interiors_meet(a, b) {
                    assert_eq!(interiors_meet(a, b), area > 1e-12, "{area}");
                }
                meeting += usize::from(interiors_meet(a, b));
            }
        }
        assert!(meeting > 200 && meeting < 10_000, "{meeting}");
    }

    #[test]
    fn the_tree_finds_what_a_look_at_every_pair_finds() {
        let all = triangles(400, 9);
        let mut tree = BoxTree::new(&all, &Control::new()).unwrap();
        for f in 0..400 {
            let expected = (0..f).filter(|g| g % 3 != 0).any(|g| interiors_meet(&all[f], &all[g]));
            assert_eq!(tree.meeting(f).is_some(), expected);
            tree.insert(f);
            if f % 3 == 0 {
                tree.remove(f);
            }
        }
    }

    #[test]
    fn neighbours_do_not_overlap_and_one_ulp_more_does() {
        let a = [[0.0, 0.0], [1.0, 0.1], [0.3, 0.9]];
        let across = [[1.0, 0.1], [0.0, 0.0], [0.4, -0.7]];
        assert!(!interiors_meet(&a, &across));
        assert!(overlapping(&[a, across], &Control::new()).unwrap().is_empty());
        let at_a_corner = [[0.3, 0.9], [0.5, 1.2], [0.1, 1.1]];
        assert!(!interiors_meet(&a, &at_a_corner));
        let inside = [[0.3, 0.9_f64.next_down()], [0.5, 1.2], [0.1, 1.1]];
        assert!(interiors_meet(&a, &inside));
        assert_eq!(overlapping(&[a, a, inside], &Control::new()).unwrap(), [1, 2]);
    }
}
