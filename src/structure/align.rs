//! Rotations of charts that make as many transitions as possible translations.

use super::developable::DevelopableSurface;
use super::draft::ChartDraft;
use super::overlaps::Overlap;
use crate::geometry::Motion;
use crate::geometry::complex::norm2;
use std::collections::VecDeque;

/// Turns charts about their origins so that transitions along a spanning tree of overlaps are translations. In E² all are then, if the
/// holonomy has no rotation.
pub(super) fn align(drafts: &mut [ChartDraft], overlaps: &[Overlap], surface: &DevelopableSurface) {
    let mut beside: Vec<Vec<(usize, usize)>> = vec![Vec::new(); drafts.len()];
    for (k, overlap) in overlaps.iter().enumerate() {
        let [i, j] = overlap.charts.map(|chart| chart as usize);
        beside[i].push((k, j));
        beside[j].push((k, i));
    }
    let mut done = vec![false; drafts.len()];
    for start in 0..drafts.len() {
        if std::mem::replace(&mut done[start], true) {
            continue;
        }
        let mut open = VecDeque::from([start]);
        while let Some(i) = open.pop_front() {
            for &(k, j) in &beside[i] {
                if std::mem::replace(&mut done[j], true) {
                    continue;
                }
                let overlap = &overlaps[k];
                let [a, b] = overlap.face;
                let [a, b] = if overlap.charts[0] as usize == i { [a, b] } else { [b, a] };
                let there = drafts[j].places[b as usize].compose(&drafts[i].places[a as usize].inverse());
                // Charts of a sphere about antipodes have no translation between them.
                if f64::from(norm2(there.a)) > 0.0 {
                    let back = Motion { b: [0.0.into(); 2], ..there }.inverse().normalised();
                    drafts[j].turn(surface, &back);
                }
                open.push_back(j);
            }
        }
    }
}
