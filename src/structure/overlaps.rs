//! Where charts overlap, and the transitions between them.

use super::draft::{Draft, NONE};
use super::element::Element;
use super::kind::Structure;
use crate::control::{Control, Stage};
use crate::error::Result;
use crate::mesh::FaceId;
use std::collections::BTreeMap;

/// Charts between two looks at the control.
const CHARTS_PER_STEP: usize = 256;

/// The lift of a face: its chart, and its number among the chart's faces.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Lift {
    /// The chart.
    pub chart: u32,
    /// The number of the face in the chart.
    pub face: u32,
}

/// The change of coordinates over one connected overlap of two charts.
#[derive(Debug, Clone, PartialEq)]
pub struct Transition {
    /// The chart whose coordinates it takes.
    pub from: u32,
    /// The chart whose coordinates it gives; the same one where two lifts of a face belong to it.
    pub to: u32,
    /// The map.
    pub element: Element,
    /// The vertices of the overlap: their numbers in both charts.
    pub pairs: Vec<[u32; 2]>,
}

/// The lifts of every face, and the transition between any two of them.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Lifts {
    /// The lifts of face f are `all[starts[f]..starts[f + 1]]`, ascending.
    starts: Vec<u32>,
    all: Vec<Lift>,
    /// Per face the place of its first pair in `transition`.
    pairs: Vec<u32>,
    /// Per pair of lifts of a face, first before second, the number of the transition that carries the first to the second.
    transition: Vec<u32>,
}

impl Lifts {
    pub fn new(drafts: &[Draft], n_faces: usize) -> Lifts {
        let mut count = vec![0u32; n_faces + 1];
        drafts.iter().flat_map(|draft| &draft.faces).for_each(|f| count[f.index() + 1] += 1);
        let (mut starts, mut pairs) = (vec![0; n_faces + 1], vec![0; n_faces + 1]);
        for f in 0..n_faces {
            let n = count[f + 1];
            (starts[f + 1], pairs[f + 1]) = (starts[f] + n, pairs[f] + n * n.saturating_sub(1) / 2);
        }
        let mut next = starts.clone();
        let mut all = vec![Lift { chart: 0, face: 0 }; starts[n_faces] as usize];
        for (chart, draft) in (0..).zip(drafts) {
            for (face, f) in (0..).zip(&draft.faces) {
                all[next[f.index()] as usize] = Lift { chart, face };
                next[f.index()] += 1;
            }
        }
        let transition = vec![NONE; pairs[n_faces] as usize];
        Lifts { starts, all, pairs, transition }
    }

    /// The lifts of a face, ascending.
    pub fn of(&self, f: FaceId) -> &[Lift] {
        &self.all[self.starts[f.index()] as usize..self.starts[f.index() + 1] as usize]
    }

    /// Where the transition from lift `i` to lift `j > i` of a face is kept.
    fn pair(&self, f: FaceId, i: usize, j: usize) -> usize {
        let n = self.of(f).len();
        self.pairs[f.index()] as usize + i * (2 * n - i - 1) / 2 + (j - i - 1)
    }

    /// The number of the transition from lift `i` to lift `j > i` of a face.
    pub fn transition(&self, f: FaceId, i: usize, j: usize) -> u32 {
        self.transition[self.pair(f, i, j)]
    }

    /// Finds the connected overlaps: faces in both charts that hang together in both. Per chart, those with later charts and with itself.
    pub fn find_overlaps(&mut self, drafts: &[Draft], control: &Control) -> Result<Vec<Overlap>> {
        let mut found = Vec::new();
        for (i, draft) in drafts.iter().enumerate() {
            if i.is_multiple_of(CHARTS_PER_STEP) {
                control.step(Stage::Layout, i as f64 / drafts.len() as f64)?;
            }
            // Per other chart, the faces that both have.
            let mut shared: BTreeMap<u32, Vec<[u32; 2]>> = BTreeMap::new();
            for (a, &f) in (0..).zip(&draft.faces) {
                let own = Lift { chart: i as u32, face: a };
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

    fn number(&mut self, part: &[[u32; 2]], [i, j]: [u32; 2], draft: &Draft, number: u32) {
        for &[a, b] in part {
            let f = draft.faces[a as usize];
            let ends = [Lift { chart: i, face: a }, Lift { chart: j, face: b }];
            let [p, q] = ends.map(|lift| self.of(f).binary_search(&lift).unwrap_or(0));
            let at = self.pair(f, p, q);
            self.transition[at] = number;
        }
    }
}

/// A connected overlap of two charts.
pub(super) struct Overlap {
    pub charts: [u32; 2],
    /// A face of it near the origins of both: its numbers in them.
    pub face: [u32; 2],
    pairs: Vec<[u32; 2]>,
}

impl Overlap {
    fn new(charts: [u32; 2], part: Vec<[u32; 2]>, drafts: &[Draft]) -> Overlap {
        let [i, j] = charts.map(|chart| &drafts[chart as usize]);
        let mut pairs = Vec::new();
        for &[a, b] in &part {
            for k in 0..3 {
                pairs.push([i.corners[a as usize][k], j.corners[b as usize][k]]);
            }
        }
        pairs.sort_unstable();
        pairs.dedup();
        // Lifts are numbered outwards.
        let nearest = part.iter().min_by_key(|[a, b]| a + b);
        Overlap { charts, face: nearest.copied().unwrap_or_default(), pairs }
    }

    pub fn transition(self, structure: Structure, drafts: &[Draft]) -> Transition {
        let [from, to] = self.charts;
        let place = |k: usize| drafts[self.charts[k] as usize].places[self.face[k] as usize];
        let motion = place(1).compose(&place(0).inverse()).normalised();
        Transition { from, to, element: Element::of_motion(structure, &motion), pairs: self.pairs }
    }
}

/// The connected parts of an overlap; `nodes` are the numbers in both charts of the faces that both have.
fn connected(nodes: &[[u32; 2]], i: &Draft, j: &Draft) -> Vec<Vec<[u32; 2]>> {
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
