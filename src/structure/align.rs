//! Rotations of charts by which the transitions along a spanning forest of their overlaps become translations.

use super::developable::DevelopableSurface;
use super::draft::ChartDraft;
use super::overlaps::Overlap;
use crate::control::Control;
use crate::error::Result;
use crate::geometry::Motion;
use crate::geometry::complex::norm2;
use std::collections::VecDeque;

/// Charts that are turned between two looks at the control.
const CHARTS_PER_CHECK: usize = 64;

/// Turns charts about their origins so that transitions along a spanning forest of overlaps are translations. In E² this makes all
/// transitions translations if the holonomy has no rotations.
///
/// # Errors
/// [`Error::Cancelled`](crate::error::Error::Cancelled).
pub(super) fn align(
    drafts: &mut [ChartDraft],
    overlaps: &[Overlap],
    surface: &DevelopableSurface,
    control: &Control,
) -> Result<()> {
    // Per chart the overlaps with others: the number of the overlap, and of the other chart.
    let mut neighbours: Vec<Vec<(usize, usize)>> = vec![Vec::new(); drafts.len()];
    for (k, overlap) in overlaps.iter().enumerate() {
        let [i, j] = overlap.charts.map(|chart| chart as usize);
        neighbours[i].push((k, j));
        neighbours[j].push((k, i));
    }
    let (mut done, mut steps) = (vec![false; drafts.len()], 0);
    for start in 0..drafts.len() {
        if std::mem::replace(&mut done[start], true) {
            continue;
        }
        let mut queue = VecDeque::from([start]);
        while let Some(i) = queue.pop_front() {
            control.check_every(CHARTS_PER_CHECK, &mut steps)?;
            for &(k, j) in &neighbours[i] {
                if std::mem::replace(&mut done[j], true) {
                    continue;
                }
                let overlap = &overlaps[k];
                let [a, b] = overlap.face;
                let [a, b] = if overlap.charts[0] as usize == i { [a, b] } else { [b, a] };
                let transition =
                    drafts[j].places[b as usize].compose(&drafts[i].places[a as usize].inverse());
                // With a = 0 it exchanges antipodes of the sphere and has no rotation; else it has that of the motion with b = 0.
                if f64::from(norm2(transition.a)) > 0.0 {
                    let rotation = Motion { b: [0.0.into(); 2], ..transition };
                    drafts[j].turn(surface, &rotation.inverse().normalised());
                }
                queue.push_back(j);
            }
        }
    }
    Ok(())
}
