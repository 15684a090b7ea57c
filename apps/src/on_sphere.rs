//! Surfaces on a sphere, as their files have them.

use ricci::geometry::predicates::winding;
use ricci::mesh::io::Soup;
use std::cmp::Ordering;

/// The number of triangles that are not counterclockwise as seen from outside of a sphere around the origin, by exact arithmetic.
pub fn n_turned(soup: &Soup) -> usize {
    let is_turned = |f: &&[u32; 3]| {
        let [a, b, c] = f.map(|v| soup.positions[v as usize]);
        winding(a, b, c) != Ordering::Greater
    };
    soup.faces.iter().filter(is_turned).count()
}
