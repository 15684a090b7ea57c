//! Whether the triangles of a map to the plane keep their orientation.

use crate::geometry::predicates::orientation;
use crate::parallel;
use std::cmp::Ordering;

/// True if all triangles run counterclockwise, by exact arithmetic.
pub(super) fn is_upright(faces: &[[u32; 3]], points: &[[f64; 2]]) -> bool {
    let mut upright = vec![false; faces.len()];
    parallel::fill(&mut upright, |f| {
        let [a, b, c] = faces[f].map(|v| points[v as usize]);
        orientation(a, b, c) == Ordering::Greater
    });
    !upright.contains(&false)
}
