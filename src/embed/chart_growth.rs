//! Growing charts face by face, and joining those that fit together.

use super::overlap::{BoxTree, Triangle};
use crate::control::{Control, Stage};
use crate::error::Result;
use crate::mesh::{FaceId, Mesh, PerEdge, PerFace};
use crate::topology::spanning::Key;
use std::cmp::Reverse;
use std::collections::{BTreeSet, BinaryHeap};

/// Faces between two looks at the control.
const FACES_PER_STEP: usize = 4096;
/// The chart number of a face that no chart has yet.
const NONE: u32 = u32::MAX;

/// How a face lies in the plane.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Lie {
    /// Counterclockwise, with more area than rounding could have given it.
    Solid,
    /// Without an area that rounding could not have given it: it overlaps nothing, and belongs to the chart that reaches it first.
    Degenerate,
    /// Clockwise: a chart of its own.
    Flipped,
}

/// A surface in the plane, to be cut into charts.
pub(super) struct Sheet<'a> {
    pub mesh: &'a Mesh,
    /// Per face, its corners in the layout.
    pub layout: Vec<Triangle>,
    pub lie: PerFace<Lie>,
    /// Edges across which faces may be in one chart.
    pub joined: PerEdge<bool>,
    /// Per face: twice its area in the layout.
    pub area: PerFace<f64>,
}

/// The chart of each face, numbered by their area, the largest first.
pub(super) struct Partition {
    pub chart: PerFace<u32>,
    pub count: usize,
}

/// Cuts a sheet into connected charts. Where its faces have these `triangles`, the interiors of the solid faces of one chart are disjoint,
/// exactly. `done` and `share`: the part of the control's stage that is over, and the part that this call takes.
pub(super) fn partition(
    sheet: &Sheet,
    triangles: &[Triangle],
    [done, share]: [f64; 2],
    control: &Control,
) -> Result<Partition> {
    let mut growth = Growth::new(sheet, triangles, control)?;
    growth.grow([done, share], control)?;
    growth.join(control)?;
    Ok(growth.numbered())
}

/// Charts in the making.
struct Growth<'a> {
    sheet: &'a Sheet<'a>,
    triangles: &'a [Triangle],
    chart: PerFace<u32>,
    /// The faces of each chart.
    members: Vec<Vec<FaceId>>,
    tree: BoxTree<'a>,
}

impl<'a> Growth<'a> {
    /// Every flipped face is a chart, the others are in none yet.
    fn new(sheet: &'a Sheet<'a>, triangles: &'a [Triangle], control: &Control) -> Result<Growth<'a>> {
        let mut chart = PerFace::filled(sheet.mesh.n_faces(), NONE);
        let mut members = Vec::new();
        for f in sheet.mesh.faces().filter(|&f| sheet.lie[f] == Lie::Flipped) {
            chart[f] = members.len() as u32;
            members.push(vec![f]);
        }
        Ok(Growth { sheet, triangles, chart, members, tree: BoxTree::new(triangles, control)? })
    }

    /// Whether a face counts for overlap.
    fn is_solid(&self, f: FaceId) -> bool {
        self.sheet.lie[f] == Lie::Solid
    }

    /// Whether a face overlaps one in the tree.
    fn is_refused(&self, f: FaceId) -> bool {
        self.is_solid(f) && self.tree.meeting(f.index()).is_some()
    }

    fn enter(&mut self, f: FaceId) {
        if self.is_solid(f) {
            self.tree.insert(f.index());
        }
    }

    fn clear(&mut self, members: &[FaceId]) {
        for &f in members.iter().filter(|&&f| self.sheet.lie[f] == Lie::Solid) {
            self.tree.remove(f.index());
        }
    }

    /// Faces across the joined edges of f.
    fn neighbours(&self, f: FaceId) -> impl Iterator<Item = FaceId> + '_ {
        let sides = self.sheet.mesh.face_halfedges(f).into_iter();
        sides.filter(|h| self.sheet.joined[h.edge()]).filter_map(|h| self.sheet.mesh.face(h.twin()))
    }

    fn centre(&self, f: FaceId) -> [f64; 2] {
        let [a, b, c] = self.triangles[f.index()];
        [0, 1].map(|k| a[k] / 3.0 + b[k] / 3.0 + c[k] / 3.0)
    }

    /// Grows charts until every face is in one.
    fn grow(&mut self, [before, share]: [f64; 2], control: &Control) -> Result<()> {
        let mut seeds: Vec<FaceId> = self.sheet.mesh.faces().filter(|&f| self.chart[f] == NONE).collect();
        let sheet = self.sheet;
        seeds.sort_by(|&f, &g| {
            let solid = self.is_solid(g).cmp(&self.is_solid(f));
            solid.then(sheet.area[g].total_cmp(&sheet.area[f])).then(f.cmp(&g))
        });
        let mut refused = PerFace::filled(self.sheet.mesh.n_faces(), NONE);
        let mut done = 0;
        for seed in seeds {
            if self.chart[seed] != NONE {
                continue;
            }
            let number = self.members.len() as u32;
            let mut members = Vec::new();
            let mut queue = BinaryHeap::from([Reverse((Key(0.0), seed))]);
            while let Some(Reverse((Key(distance), f))) = queue.pop() {
                if self.chart[f] != NONE || refused[f] == number {
                    continue;
                }
                if usize::is_multiple_of(done, FACES_PER_STEP) {
                    let part = done as f64 / self.sheet.mesh.n_faces() as f64;
                    control.step(Stage::Layout, before + share * part)?;
                }
                if self.is_refused(f) {
                    // The chart only grows, so that a face that overlaps it now always will.
                    refused[f] = number;
                    continue;
                }
                self.enter(f);
                self.chart[f] = number;
                members.push(f);
                done += 1;
                let here = self.centre(f);
                for g in self.neighbours(f).filter(|&g| self.chart[g] == NONE && refused[g] != number) {
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

    /// Joins charts that hang together and do not overlap: each, from the largest down, with its neighbours, the largest first.
    fn join(&mut self, control: &Control) -> Result<()> {
        let size = |g: &Self, c: u32| -> f64 { g.members[c as usize].iter().map(|f| g.sheet.area[*f]).sum() };
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

    /// Charts across the joined edges of a chart; some more than once.
    fn around(&self, c: u32) -> impl Iterator<Item = u32> + '_ {
        let faces = self.members[c as usize].iter();
        faces.flat_map(|&f| self.neighbours(f)).map(|g| self.chart[g]).filter(move |&other| other != c)
    }

    /// Chart numbers by area, the largest first, and how many there are.
    fn numbered(&self) -> Partition {
        let area = |c: &usize| -> f64 { self.members[*c].iter().map(|f| self.sheet.area[*f]).sum() };
        let mut order: Vec<usize> =
            (0..self.members.len()).filter(|&c| !self.members[c].is_empty()).collect();
        order.sort_by_cached_key(|c| (Reverse(Key(area(c))), *c));
        let mut chart = PerFace::filled(self.sheet.mesh.n_faces(), 0);
        for (number, &c) in order.iter().enumerate() {
            self.members[c].iter().for_each(|&f| chart[f] = number as u32);
        }
        Partition { chart, count: order.len() }
    }
}
