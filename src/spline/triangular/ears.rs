//! Edge flips that leave each convex corner of a plane domain with a single triangle.
//!
//! All knots coincide at a corner of the boundary, so a spline is less smooth across an inner edge that ends there. A corner with a single
//! triangle has no such edge.

use super::knots::{PlaneDomain, is_straight};
use crate::geometry::complex::{distance, doubled_area, sub};
use std::collections::HashMap;

/// Least height of a triangle that a flip makes, over its longest side.
const LEAST_HEIGHT: f64 = 0.1;

impl PlaneDomain {
    /// Flips edges at every corner of the boundary, which leaves a convex one with a single triangle unless that would make a thin one.
    /// Returns the sum of the numbers of inner edges that were left at each corner when it was visited.
    pub fn make_ears(&mut self) -> usize {
        let mut around = vec![Vec::new(); self.vertices.len()];
        for (t, triangle) in self.triangles.iter().enumerate() {
            triangle.iter().for_each(|v| around[*v as usize].push(t));
        }
        let corners = self.corners();
        corners.into_iter().map(|corner| self.make_ear(corner, &mut around)).sum()
    }

    /// Flips edges at the middle one of three vertices of the boundary; returns the number of inner edges that are left there.
    fn make_ear(&mut self, [before, corner, after]: [u32; 3], around: &mut [Vec<usize>]) -> usize {
        loop {
            // The neighbours of the corner from `after` to `before`, each with the triangle between it and the previous one.
            let ends = around[corner as usize].iter().filter_map(|&t| {
                let triangle = self.triangles[t];
                let k = triangle.iter().position(|&v| v == corner)?;
                Some((triangle[(k + 1) % 3], (triangle[(k + 2) % 3], t)))
            });
            let next: HashMap<u32, (u32, usize)> = ends.collect();
            let mut fan = vec![(after, usize::MAX)];
            while let Some(&step) = next.get(&fan[fan.len() - 1].0).filter(|_| fan.len() <= next.len()) {
                fan.push(step);
            }
            debug_assert_eq!(fan.last().map(|last| last.0), Some(before));
            let inner = fan.len().saturating_sub(2);
            let flip = (1..=inner).find(|&i| self.can_flip(corner, [fan[i - 1].0, fan[i].0, fan[i + 1].0]));
            let Some(i) = flip else { return inner };
            let [from, middle, to] = [fan[i - 1].0, fan[i].0, fan[i + 1].0];
            let (first, second) = (fan[i].1, fan[i + 1].1);
            self.triangles[first] = [corner, from, to];
            self.triangles[second] = [from, middle, to];
            around[corner as usize].retain(|&t| t != second);
            around[middle as usize].retain(|&t| t != first);
            around[from as usize].push(second);
            around[to as usize].push(first);
        }
    }

    /// True if the edge from a corner to the middle one of three vertices can be flipped without making a thin triangle.
    fn can_flip(&self, corner: u32, [from, middle, to]: [u32; 3]) -> bool {
        let is_good = |triangle: [u32; 3]| {
            let [a, b, c] = triangle.map(|v| self.vertices[v as usize]);
            let longest = distance(a, b).max(distance(b, c)).max(distance(c, a));
            doubled_area([a, b, c]) > LEAST_HEIGHT * longest * longest
        };
        is_good([corner, from, to]) && is_good([from, middle, to])
    }

    /// The vertices at which the boundary turns, each between its neighbours there; vertices that the boundary meets twice are left out.
    fn corners(&self) -> Vec<[u32; 3]> {
        let sides = self.boundary();
        let mut around: HashMap<u32, [Vec<u32>; 2]> = HashMap::new();
        for &[a, b] in &sides {
            around.entry(a).or_default()[1].push(b);
            around.entry(b).or_default()[0].push(a);
        }
        let place = |v: u32| self.vertices[v as usize];
        let direction = |a: u32, b: u32| sub(place(b), place(a)).map(|x| x / distance(place(a), place(b)));
        let corner = |&[v, _]: &[u32; 2]| match &around[&v] {
            [before, after] if before.len() == 1 && after.len() == 1 => {
                let [before, after] = [before[0], after[0]];
                (!is_straight(direction(before, v), direction(v, after))).then_some([before, v, after])
            }
            _ => None,
        };
        sides.iter().filter_map(corner).collect()
    }
}
