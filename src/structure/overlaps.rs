//! The overlaps of charts, and the transitions between them.

use super::draft::{ChartDraft, NONE};
use super::element::GroupElement;
use super::kind::Structure;
use crate::archive::{in_range, invalid, stored};
use crate::control::{Control, Stage};
use crate::error::Result;
use crate::mesh::FaceId;
use std::collections::BTreeMap;

/// Number of charts between two checks for cancellation.
const CHARTS_PER_STEP: usize = 256;

/// The lift of a face: its chart, and its number among the chart's faces.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FaceLift {
    /// The chart.
    pub chart: u32,
    /// The number of the face in the chart.
    pub face: u32,
}
stored!(row FaceLift { chart: u32, face: u32 });

/// The change of coordinates over one connected overlap of two charts.
#[derive(Debug, Clone, PartialEq)]
pub struct Transition {
    /// The chart from whose coordinates it maps.
    pub from: u32,
    /// The chart to whose coordinates it maps; the same one if two lifts of a face belong to it.
    pub to: u32,
    /// The map.
    pub element: GroupElement,
    /// The vertices of the overlap, by their numbers in both charts; for an integer structure with cones those that are not singular.
    pub pairs: Vec<[u32; 2]>,
}
stored!(sections Transition { from, to, element, pairs });

/// The lifts of every face, and the transition between any two of them.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct FaceLifts {
    /// The lifts of face f are `all[starts[f]..starts[f + 1]]`, ascending.
    starts: Vec<u32>,
    all: Vec<FaceLift>,
    /// For each face the index of its first pair in `transition`.
    pairs: Vec<u32>,
    /// For each pair of lifts of a face, first before second, the number of the transition from the first to the second.
    transition: Vec<u32>,
}
stored!(sections FaceLifts { starts, all, pairs, transition });

impl FaceLifts {
    /// Checks that the lifts of an archive are those of faces of charts with these numbers of faces.
    pub(super) fn check_parts(&self, n_faces: usize, charts: &[usize], n_transitions: usize) -> Result<()> {
        let ends = self.starts.first() == Some(&0) && self.starts.last() == Some(&(self.all.len() as u32));
        if !ends || self.starts.len() != n_faces + 1 || self.starts.windows(2).any(|pair| pair[0] > pair[1]) {
            return Err(invalid("lifts of faces", "a list for each face"));
        }
        in_range("chart", self.all.iter().map(|lift| lift.chart as usize), charts.len())?;
        if self.all.iter().any(|lift| lift.face as usize >= charts[lift.chart as usize]) {
            return Err(invalid("lifts of faces", "faces of their charts"));
        }
        in_range("transition", self.transition.iter().map(|&k| k as usize), n_transitions)
    }

    pub fn new(drafts: &[ChartDraft], n_faces: usize) -> FaceLifts {
        let mut count = vec![0u32; n_faces + 1];
        drafts.iter().flat_map(|draft| &draft.faces).for_each(|f| count[f.index() + 1] += 1);
        let (mut starts, mut pairs) = (vec![0; n_faces + 1], vec![0; n_faces + 1]);
        for f in 0..n_faces {
            let n = count[f + 1];
            (starts[f + 1], pairs[f + 1]) = (starts[f] + n, pairs[f] + n * n.saturating_sub(1) / 2);
        }
        let mut next = starts.clone();
        let mut all = vec![FaceLift { chart: 0, face: 0 }; starts[n_faces] as usize];
        for (chart, draft) in (0..).zip(drafts) {
            for (face, f) in (0..).zip(&draft.faces) {
                all[next[f.index()] as usize] = FaceLift { chart, face };
                next[f.index()] += 1;
            }
        }
        let transition = vec![NONE; pairs[n_faces] as usize];
        FaceLifts { starts, all, pairs, transition }
    }

    /// The lifts of a face, ascending.
    pub fn of(&self, f: FaceId) -> &[FaceLift] {
        &self.all[self.starts[f.index()] as usize..self.starts[f.index() + 1] as usize]
    }

    /// The index in `transition` of the pair of lift `i` and lift `j > i` of a face.
    fn pair(&self, f: FaceId, i: usize, j: usize) -> usize {
        let n = self.of(f).len();
        self.pairs[f.index()] as usize + i * (2 * n - i - 1) / 2 + (j - i - 1)
    }

    /// The number of the transition from lift `i` to lift `j > i` of a face.
    pub fn transition(&self, f: FaceId, i: usize, j: usize) -> u32 {
        self.transition[self.pair(f, i, j)]
    }

    /// The connected overlaps of each chart with later ones and with itself: faces in both charts that are connected in both.
    pub fn find_overlaps(&mut self, drafts: &[ChartDraft], control: &Control) -> Result<Vec<Overlap>> {
        let mut found = Vec::new();
        for (i, draft) in drafts.iter().enumerate() {
            if i.is_multiple_of(CHARTS_PER_STEP) {
                control.step(Stage::Layout, i as f64 / drafts.len() as f64)?;
            }
            // For each other chart, the faces that both have.
            let mut shared: BTreeMap<u32, Vec<[u32; 2]>> = BTreeMap::new();
            for (a, &f) in (0..).zip(&draft.faces) {
                let own = FaceLift { chart: i as u32, face: a };
                self.of(f).iter().filter(|&&lift| lift > own).for_each(|lift| {
                    shared.entry(lift.chart).or_default().push([a, lift.face]);
                });
            }
            for (j, nodes) in shared {
                for part in connected(&nodes, draft, &drafts[j as usize]) {
                    self.number(&part, [i as u32, j], draft, found.len() as u32);
                    found.push(Overlap::new([i as u32, j], part, drafts));
                }
            }
        }
        Ok(found)
    }

    fn number(&mut self, part: &[[u32; 2]], [i, j]: [u32; 2], draft: &ChartDraft, number: u32) {
        for &[a, b] in part {
            let f = draft.faces[a as usize];
            let ends = [FaceLift { chart: i, face: a }, FaceLift { chart: j, face: b }];
            let [p, q] = ends.map(|lift| self.of(f).binary_search(&lift).unwrap_or(0));
            let at = self.pair(f, p, q);
            self.transition[at] = number;
        }
    }
}

/// A connected overlap of two charts.
pub(super) struct Overlap {
    pub charts: [u32; 2],
    /// A face of the overlap near the origins of both charts, by its numbers in them.
    pub face: [u32; 2],
    pairs: Vec<[u32; 2]>,
}

impl Overlap {
    fn new(charts: [u32; 2], part: Vec<[u32; 2]>, drafts: &[ChartDraft]) -> Overlap {
        let [i, j] = charts.map(|chart| &drafts[chart as usize]);
        let mut pairs = Vec::new();
        for &[a, b] in &part {
            for k in 0..3 {
                pairs.push([i.corners[a as usize][k], j.corners[b as usize][k]]);
            }
        }
        pairs.sort_unstable();
        pairs.dedup();
        // Faces are numbered outwards.
        let nearest = part.iter().min_by_key(|[a, b]| a + b);
        Overlap { charts, face: nearest.copied().unwrap_or_default(), pairs }
    }

    pub fn transition(self, structure: Structure, drafts: &[ChartDraft]) -> Transition {
        let [from, to] = self.charts;
        let place = |k: usize| drafts[self.charts[k] as usize].places[self.face[k] as usize];
        let motion = place(1).compose(&place(0).inverse()).normalised();
        Transition { from, to, element: GroupElement::of_motion(structure, &motion), pairs: self.pairs }
    }
}

/// The connected parts of an overlap; `nodes` are the numbers in both charts of the faces that both have.
fn connected(nodes: &[[u32; 2]], i: &ChartDraft, j: &ChartDraft) -> Vec<Vec<[u32; 2]>> {
    let mut sorted = nodes.to_vec();
    sorted.sort_unstable();
    let mut seen = vec![false; sorted.len()];
    let mut parts = Vec::new();
    for start in 0..sorted.len() {
        if std::mem::replace(&mut seen[start], true) {
            continue;
        }
        let (mut part, mut done) = (vec![sorted[start]], 0);
        while let Some(&[a, b]) = part.get(done) {
            done += 1;
            for k in 0..3 {
                let next = [i.neighbours[a as usize][k], j.neighbours[b as usize][k]];
                if next.contains(&NONE) {
                    continue;
                }
                if let Ok(at) = sorted.binary_search(&next)
                    && !std::mem::replace(&mut seen[at], true)
                {
                    part.push(next);
                }
            }
        }
        parts.push(part);
    }
    parts
}
