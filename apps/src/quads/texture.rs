//! Texture coordinates of quads: whole numbers in each patch, in which every quad is a unit square.

use std::collections::{BTreeMap, VecDeque};

/// A corner of a quad in its patch.
pub type PatchPoint = [i32; 2];

/// Per quad the coordinates of its corners in its patch, from 0; the first edge of a patch, if one is given, begins at the origin and runs along
/// the first axis. A patch is a piece of a grid.
pub fn patch_coordinates(quads: &[[u32; 4]], patches: &[PatchQuads<'_>]) -> Vec<[PatchPoint; 4]> {
    let mut corners = vec![[[0; 2]; 4]; quads.len()];
    for patch in patches {
        patch.place(quads, &mut corners);
    }
    corners
}

/// The quads of a patch.
pub struct PatchQuads<'a> {
    pub quads: &'a [u32],
    /// An edge of it, with the patch to its left.
    pub first: Option<[u32; 2]>,
}

impl PatchQuads<'_> {
    /// Places the quads beside each other.
    fn place(&self, quads: &[[u32; 4]], corners: &mut [[PatchPoint; 4]]) {
        let mut at: BTreeMap<[u32; 2], (u32, usize)> = BTreeMap::new();
        for &q in self.quads {
            let quad = quads[q as usize];
            (0..4).for_each(|i| {
                at.insert([quad[i], quad[(i + 1) % 4]], (q, i));
            });
        }
        let Some(&first) = self.quads.first() else { return };
        let start = self.first.and_then(|edge| at.get(&edge).copied()).unwrap_or((first, 0));
        let mut is_placed: BTreeMap<u32, bool> = self.quads.iter().map(|&q| (q, false)).collect();
        corners[start.0 as usize] = square([0, 0], [1, 0], start.1);
        is_placed.insert(start.0, true);
        let mut waiting = VecDeque::from([start.0]);
        while let Some(q) = waiting.pop_front() {
            let (quad, here) = (quads[q as usize], corners[q as usize]);
            for i in 0..4 {
                let [from, to] = [i, (i + 1) % 4];
                let Some(&(other, k)) = at.get(&[quad[to], quad[from]]) else { continue };
                if is_placed.insert(other, true) == Some(false) {
                    corners[other as usize] = square(here[to], here[from], k);
                    waiting.push_back(other);
                }
            }
        }
        let all = || self.quads.iter().flat_map(|&q| corners[q as usize]);
        let least = [0, 1].map(|c| all().map(|p| p[c]).min().unwrap_or(0));
        for &q in self.quads {
            corners[q as usize].iter_mut().for_each(|p| *p = [p[0] - least[0], p[1] - least[1]]);
        }
    }
}

/// A unit square counterclockwise, whose side `k` runs from one point to the other.
fn square(from: PatchPoint, to: PatchPoint, k: usize) -> [PatchPoint; 4] {
    let [x, y] = [to[0] - from[0], to[1] - from[1]];
    let around = [from, to, [to[0] - y, to[1] + x], [from[0] - y, from[1] + x]];
    [0, 1, 2, 3].map(|i| around[(i + 4 - k) % 4])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quads_of_a_strip_are_squares_beside_each_other() {
        // Two rows of three, numbered from 0 along the rows; the corners of each quad begin elsewhere.
        let vertex = |x: u32, y: u32| 4 * y + x;
        let mut quads = Vec::new();
        for y in 0..2 {
            for x in 0..3 {
                let mut quad = [vertex(x, y), vertex(x + 1, y), vertex(x + 1, y + 1), vertex(x, y + 1)];
                quad.rotate_left(((x + y) % 4) as usize);
                quads.push(quad);
            }
        }
        let patch = PatchQuads { quads: &[0, 1, 2, 3, 4, 5], first: Some([vertex(1, 0), vertex(2, 0)]) };
        let found = patch_coordinates(&quads, &[patch]);
        for (quad, corners) in quads.iter().zip(found) {
            for (v, [x, y]) in quad.iter().zip(corners) {
                assert_eq!([x, y], [(v % 4) as i32, (v / 4) as i32]);
            }
        }
    }
}
