//! Charts turned so that as many transitions as possible are translations.

use super::draft::Draft;
use super::overlaps::Overlap;
use super::sheet::Sheet;
use crate::geometry::Motion;
use crate::geometry::complex::norm2;
use std::collections::VecDeque;

/// Turns charts about their origins so that transitions along a tree of overlaps are translations; in E² then all are, where the holonomy
/// has no rotation.
pub(super) fn align(drafts: &mut [Draft], overlaps: &[Overlap], sheet: &Sheet) {
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
                let [a, b] = match overlap.charts[0] as usize == i {
                    true => overlap.face,
                    false => [overlap.face[1], overlap.face[0]],
                };
                let there = drafts[j].places[b as usize].compose(&drafts[i].places[a as usize].inverse());
                // A sphere's charts about antipodes have no translation between them.
                if f64::from(norm2(there.a)) > 0.0 {
                    let back = Motion { b: [0.0.into(); 2], ..there }.inverse().normalised();
                    drafts[j].turn(sheet, &back);
                }
                open.push_back(j);
            }
        }
    }
}
