//! The right angles of sectors that a field of directions asks for, made such that a metric can have them, and with fewer cones.

use super::sectors::Sectors;
use crate::error::{Error, Result};
use crate::mesh::Mesh;
use std::collections::VecDeque;

/// Edges from sector to sector, each sector with those that it shares an edge inside a piece with.
pub(super) struct Neighbours(Vec<Vec<u32>>);

impl Neighbours {
    /// Those of these sectors.
    pub fn new(mesh: &Mesh, sectors: &Sectors) -> Neighbours {
        let corners = sectors.of_corners(mesh);
        let mut near = vec![Vec::new(); sectors.len()];
        for f in mesh.faces() {
            let around = mesh.face_halfedges(f).map(|h| corners[h]);
            for k in 0..3 {
                let (a, b) = (around[k], around[(k + 1) % 3]);
                near[a as usize].push(b);
                near[b as usize].push(a);
            }
        }
        near.iter_mut().for_each(|list| {
            list.sort_unstable();
            list.dedup();
        });
        Neighbours(near)
    }

    /// The sector nearest to one, in edges, that is as asked.
    pub fn nearest(&self, from: usize, is_asked: impl Fn(usize) -> bool) -> Option<usize> {
        let mut is_seen = vec![false; self.0.len()];
        is_seen[from] = true;
        let mut waiting = VecDeque::from([from]);
        while let Some(at) = waiting.pop_front() {
            for &next in &self.0[at] {
                let next = next as usize;
                if !std::mem::replace(&mut is_seen[next], true) {
                    if is_asked(next) {
                        return Some(next);
                    }
                    waiting.push_back(next);
                }
            }
        }
        None
    }
}

/// Right angles of sectors with one at least in each, and without pairs of neighbouring cones that cancel, at vertices off features. What a
/// sector has too little comes from the nearest that can spare it: one off features with 2 or more, or one with more than is straight.
///
/// # Errors
/// A sector of a piece in which there is not enough to give every sector a right angle.
pub(super) fn simplified(
    mesh: &Mesh,
    sectors: &Sectors,
    mut right_angles: Vec<i32>,
) -> std::result::Result<Vec<i32>, usize> {
    let neighbours = Neighbours::new(mesh, sectors);
    for sector in 0..sectors.len() {
        while right_angles[sector] < 1 {
            let can_spare = |s: usize| right_angles[s] > if sectors.is_bounded(s) { 2 } else { 1 };
            let giver = neighbours.nearest(sector, can_spare);
            let any = || neighbours.nearest(sector, |s| right_angles[s] > 1);
            let giver = giver.or_else(any).ok_or(sector)?;
            right_angles[giver] -= 1;
            right_angles[sector] += 1;
        }
    }
    for sector in 0..sectors.len() {
        while !sectors.is_bounded(sector) && right_angles[sector] > 4 {
            let partner = neighbours.0[sector].iter().map(|&s| s as usize);
            let Some(partner) = partner.into_iter().find(|&s| !sectors.is_bounded(s) && right_angles[s] < 4)
            else {
                break;
            };
            right_angles[sector] -= 1;
            right_angles[partner] += 1;
        }
    }
    Ok(right_angles)
}

/// Checks that a flat metric can have these right angles by the theorem of Gauss and Bonnet in each piece.
///
/// # Errors
/// [`Error::TargetKind`].
pub(super) fn check_totals(mesh: &Mesh, sectors: &Sectors, right_angles: &[i32]) -> Result<()> {
    let mut total = vec![0i64; sectors.n_pieces];
    for (sector, &k) in right_angles.iter().enumerate() {
        let regular = if sectors.is_bounded(sector) { 2 } else { 4 };
        total[sectors.piece[sector] as usize] += regular - i64::from(k);
    }
    for (is, euler) in total.iter().zip(sectors.euler(mesh)) {
        if *is != 4 * euler {
            let wanted = 4 * euler;
            let message = format!(
                "the sum of 4 − valence, and of 2 − valence on the boundary, is {is}; this surface has {wanted}"
            );
            return Err(Error::TargetKind { target: "cones", message });
        }
    }
    Ok(())
}
