//! The growth of charts face by face, and the joining of charts that fit together.

use crate::control::{Control, Stage};
use crate::error::Result;
use crate::geometry::triangle_flatness::TriangleOrientation;
use crate::geometry::triangle_overlap::{BoxTree, TriangleCorners};
use crate::mesh::{FaceId, Mesh, PerEdge, PerFace};
use crate::topology::spanning::Key;
use std::cmp::Reverse;
use std::collections::{BTreeSet, BinaryHeap};

/// Number of faces after which the control is asked again whether to stop.
const FACES_PER_STEP: usize = 4096;
/// The chart number of a face that is in no chart yet.
const NONE: u32 = u32::MAX;

/// A layout in the plane that is to be cut into charts.
pub(super) struct PlaneLayout<'a> {
    pub mesh: &'a Mesh,
    /// Per face, its corners in the layout.
    pub triangles: Vec<TriangleCorners>,
    /// Per face, its orientation. An upright face must not overlap another one of its chart; a degenerate one belongs to the chart that
    /// reaches it first; a flipped one is a chart of its own.
    pub orientation: PerFace<TriangleOrientation>,
    /// Per edge, true if the faces on its two sides may be in one chart.
    pub joined: PerEdge<bool>,
    /// Per face, twice its area in the layout.
    pub area: PerFace<f64>,
}

/// The division of a layout into charts, which are numbered by their area, the largest first.
pub(super) struct ChartPartition {
    pub chart: PerFace<u32>,
    pub count: usize,
}

/// The division of a layout into connected charts. Overlaps are tested on the corners `triangles`, those in the layout or after packing: with
/// these the interiors of the upright faces of one chart are disjoint, exactly. `done` and `share`: the part of the control's stage that is over, and the part
/// that this call takes.
pub(super) fn partition(
    layout: &PlaneLayout,
    triangles: &[TriangleCorners],
    [done, share]: [f64; 2],
    control: &Control,
) -> Result<ChartPartition> {
    let mut growth = ChartGrowth::new(layout, triangles, control)?;
    growth.grow([done, share], control)?;
    growth.join(control)?;
    Ok(growth.numbered())
}

/// The charts while they grow.
struct ChartGrowth<'a> {
    layout: &'a PlaneLayout<'a>,
    triangles: &'a [TriangleCorners],
    chart: PerFace<u32>,
    /// Per chart, its faces.
    members: Vec<Vec<FaceId>>,
    /// A search tree over the boxes of all faces, in which only the upright faces of the chart that grows are present.
    tree: BoxTree<'a>,
}

impl<'a> ChartGrowth<'a> {
    /// The start of the growth: every flipped face is a chart, the other faces are in none yet.
    fn new(
        layout: &'a PlaneLayout<'a>,
        triangles: &'a [TriangleCorners],
        control: &Control,
    ) -> Result<ChartGrowth<'a>> {
        let mut chart = PerFace::filled(layout.mesh.n_faces(), NONE);
        let mut members = Vec::new();
        let is_flipped = |f: &FaceId| layout.orientation[*f] == TriangleOrientation::Flipped;
        for f in layout.mesh.faces().filter(is_flipped) {
            chart[f] = members.len() as u32;
            members.push(vec![f]);
        }
        Ok(ChartGrowth { layout, triangles, chart, members, tree: BoxTree::new(triangles, control)? })
    }

    fn is_upright(&self, f: FaceId) -> bool {
        self.layout.orientation[f] == TriangleOrientation::Upright
    }

    /// True if a face overlaps one that is present in the tree.
    fn is_refused(&self, f: FaceId) -> bool {
        self.is_upright(f) && self.tree.meeting(f.index()).is_some()
    }

    /// Makes a face present in the tree, if it counts for overlap.
    fn enter(&mut self, f: FaceId) {
        if self.is_upright(f) {
            self.tree.insert(f.index());
        }
    }

    /// Removes the faces of a chart from the tree.
    fn clear(&mut self, members: &[FaceId]) {
        for &f in members.iter().filter(|&&f| self.layout.orientation[f] == TriangleOrientation::Upright) {
            self.tree.remove(f.index());
        }
    }

    /// The faces across the joined edges of f.
    fn neighbours(&self, f: FaceId) -> impl Iterator<Item = FaceId> + '_ {
        let sides = self.layout.mesh.face_halfedges(f).into_iter();
        sides.filter(|h| self.layout.joined[h.edge()]).filter_map(|h| self.layout.mesh.face(h.twin()))
    }

    fn centre(&self, f: FaceId) -> [f64; 2] {
        let [a, b, c] = self.triangles[f.index()];
        [0, 1].map(|k| a[k] / 3.0 + b[k] / 3.0 + c[k] / 3.0)
    }

    /// Grows charts until every face is in one.
    fn grow(&mut self, [before, share]: [f64; 2], control: &Control) -> Result<()> {
        let mut seeds: Vec<FaceId> = self.layout.mesh.faces().filter(|&f| self.chart[f] == NONE).collect();
        let area = &self.layout.area;
        seeds.sort_by(|&f, &g| {
            let upright_first = self.is_upright(g).cmp(&self.is_upright(f));
            upright_first.then(area[g].total_cmp(&area[f])).then(f.cmp(&g))
        });
        // Per face, the last chart that it overlapped.
        let mut refused_by = PerFace::filled(self.layout.mesh.n_faces(), NONE);
        let mut faces_done = 0;
        for seed in seeds {
            if self.chart[seed] != NONE {
                continue;
            }
            let number = self.members.len() as u32;
            let mut members = Vec::new();
            let mut queue = BinaryHeap::from([Reverse((Key(0.0), seed))]);
            while let Some(Reverse((Key(distance), f))) = queue.pop() {
                if self.chart[f] != NONE || refused_by[f] == number {
                    continue;
                }
                if usize::is_multiple_of(faces_done, FACES_PER_STEP) {
                    let part = faces_done as f64 / self.layout.mesh.n_faces() as f64;
                    control.step(Stage::Layout, before + share * part)?;
                }
                if self.is_refused(f) {
                    // The chart only grows, so a face that overlaps it now will always overlap it.
                    refused_by[f] = number;
                    continue;
                }
                self.enter(f);
                self.chart[f] = number;
                members.push(f);
                faces_done += 1;
                let here = self.centre(f);
                for g in self.neighbours(f).filter(|&g| self.chart[g] == NONE && refused_by[g] != number) {
                    let there = self.centre(g);
                    let step = (there[0] - here[0]).hypot(there[1] - here[1]);
                    queue.push(Reverse((Key(distance + step), g)));
                }
            }
            self.clear(&members);
            self.members.push(members);
        }
        Ok(())
    }

    /// Joins charts that share a joined edge and do not overlap: each, from the largest down, with its neighbours, the largest first.
    fn join(&mut self, control: &Control) -> Result<()> {
        let size =
            |g: &Self, c: u32| -> f64 { g.members[c as usize].iter().map(|f| g.layout.area[*f]).sum() };
        let mut order: Vec<(Key, Reverse<u32>)> =
            (0..self.members.len() as u32).map(|c| (Key(size(self, c)), Reverse(c))).collect();
        order.sort_unstable_by(|a, b| b.cmp(a));
        let rank: Vec<u32> = {
            let mut rank = vec![0; order.len()];
            order.iter().enumerate().for_each(|(k, c)| rank[c.1.0 as usize] = k as u32);
            rank
        };
        let mut looked_at = 0;
        for &(_, Reverse(host)) in &order {
            if self.members[host as usize].is_empty() {
                continue;
            }
            let mut waiting: BTreeSet<u32> = self.around(host).map(|c| rank[c as usize]).collect();
            if waiting.is_empty() {
                continue;
            }
            let mut members = std::mem::take(&mut self.members[host as usize]);
            members.iter().for_each(|&f| self.enter(f));
            let mut tried = BTreeSet::new();
            while let Some(next) = waiting.pop_first() {
                let guest = order[next as usize].1.0;
                if !tried.insert(next) {
                    continue;
                }
                let mut fits = true;
                for &f in &self.members[guest as usize] {
                    if usize::is_multiple_of(looked_at, FACES_PER_STEP) {
                        control.check()?;
                    }
                    looked_at += 1;
                    fits = !self.is_refused(f);
                    if !fits {
                        break;
                    }
                }
                if !fits {
                    continue;
                }
                let further: Vec<u32> = self.around(guest).filter(|&c| c != host).collect();
                waiting.extend(further.into_iter().map(|c| rank[c as usize]).filter(|r| !tried.contains(r)));
                for f in std::mem::take(&mut self.members[guest as usize]) {
                    self.enter(f);
                    self.chart[f] = host;
                    members.push(f);
                }
            }
            self.clear(&members);
            self.members[host as usize] = members;
        }
        Ok(())
    }

    /// The charts across the joined edges of a chart; some more than once.
    fn around(&self, c: u32) -> impl Iterator<Item = u32> + '_ {
        let faces = self.members[c as usize].iter();
        faces.flat_map(|&f| self.neighbours(f)).map(|g| self.chart[g]).filter(move |&other| other != c)
    }

    /// The partition, with the charts numbered by area, the largest first.
    fn numbered(&self) -> ChartPartition {
        let area = |c: &usize| -> f64 { self.members[*c].iter().map(|f| self.layout.area[*f]).sum() };
        let mut order: Vec<usize> =
            (0..self.members.len()).filter(|&c| !self.members[c].is_empty()).collect();
        order.sort_by_cached_key(|c| (Reverse(Key(area(c))), *c));
        let mut chart = PerFace::filled(self.layout.mesh.n_faces(), 0);
        for (number, &c) in order.iter().enumerate() {
            self.members[c].iter().for_each(|&f| chart[f] = number as u32);
        }
        ChartPartition { chart, count: order.len() }
    }
}
