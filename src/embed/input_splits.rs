//! The search for the fewest splits of edges of the input with which no face folds in a layout.

use super::edge_parts::InputEdgeParts;
use super::face_polygon::{BorderPoint, BorderSpot, FacePolygon, FaceTriangulation};
use super::layout::{Layout, OnInput};
use crate::control::Control;
use crate::error::Result;
use crate::geometry::predicates::orientation;
use crate::mesh::{EdgeId, FaceId, HalfedgeId, Mesh};
use crate::metric::common_subdivision::CORNERS;
use std::cmp::Ordering;
use std::collections::VecDeque;

/// Most crossings of a side that are tried as places to split it. The first limit is enough for nearly every face; the search of a face
/// takes time with the cube of their number, so the last one bounds it to a second.
const TRIED: [usize; 3] = [12, 48, 192];
/// The price of a new point, and the part that is added where the face across the edge would fold if it were split there.
const PRICE: u32 = 4;
const PRICE_OF_FOLD: u32 = 3;
/// Number of faces after which the control is asked again whether to stop.
const FACES_PER_STEP: usize = 256;

/// The places where the edges of the input are split.
pub(super) struct InputSplits<'a> {
    pub layout: &'a Layout,
    pub input: &'a Mesh,
    pub on_input: &'a OnInput,
    parts: InputEdgeParts,
    /// Per edge, the crossings at which it is split, ascending; they are counted from 1 along its half-edge 2e.
    pub taken: Vec<Vec<u32>>,
}

impl<'a> InputSplits<'a> {
    /// The fewest splits that leave no fold.
    ///
    /// # Errors
    /// [`crate::Error::Cancelled`]; [`crate::Error::Layout`] for a subdivision that is not one of the input.
    pub fn fewest(
        layout: &'a Layout,
        input: &'a Mesh,
        on_input: &'a OnInput,
        control: &Control,
    ) -> Result<InputSplits<'a>> {
        let parts = match layout.common_subdivision() {
            Some(r) => InputEdgeParts::of_subdivision(input, r)?,
            None => InputEdgeParts::whole(input),
        };
        let taken = vec![Vec::new(); input.n_edges()];
        let mut splits = InputSplits { layout, input, on_input, parts, taken };
        if layout.common_subdivision().is_some() {
            splits.search(control)?;
            splits.prune(control)?;
        }
        Ok(splits)
    }

    /// Splits edges until no face folds whose fold a split can undo.
    fn search(&mut self, control: &Control) -> Result<()> {
        let mut is_waiting = vec![false; self.input.n_faces()];
        let mut waiting: VecDeque<FaceId> = self.on_input.flipped.iter().copied().collect();
        waiting.iter().for_each(|f| is_waiting[f.index()] = true);
        let mut done = 0;
        while let Some(f) = waiting.pop_front() {
            if usize::is_multiple_of(done, FACES_PER_STEP) {
                control.check()?;
            }
            (done, is_waiting[f.index()]) = (done + 1, false);
            for (e, crossing) in self.needed(f) {
                let at = self.taken[e.index()].partition_point(|&c| c < crossing);
                self.taken[e.index()].insert(at, crossing);
                for beside in
                    [e.halfedge(), e.halfedge().twin()].into_iter().filter_map(|h| self.input.face(h))
                {
                    if beside != f && !std::mem::replace(&mut is_waiting[beside.index()], true) {
                        waiting.push_back(beside);
                    }
                }
            }
        }
        Ok(())
    }

    /// Takes splits away without which no more faces fold.
    fn prune(&mut self, control: &Control) -> Result<()> {
        for e in self.input.edges() {
            if e.index().is_multiple_of(FACES_PER_STEP) {
                control.check()?;
            }
            let sides = [e.halfedge(), e.halfedge().twin()];
            for crossing in self.taken[e.index()].clone() {
                let folded = |splits: &Self| -> u32 {
                    let faces = sides.into_iter().filter_map(|h| splits.input.face(h));
                    faces.map(|f| splits.triangulation(f).1.cost.folded).sum()
                };
                let before = folded(self);
                let with = self.taken[e.index()].clone();
                self.taken[e.index()].retain(|&c| c != crossing);
                if folded(self) > before {
                    self.taken[e.index()] = with;
                }
            }
        }
        Ok(())
    }

    /// The crossings at which sides of a face have to be split beside those that are taken, so that as few of its triangles as possible
    /// fold.
    fn needed(&self, f: FaceId) -> Vec<(EdgeId, u32)> {
        let (_, known) = self.triangulation(f);
        if known.cost.folded == 0 {
            return Vec::new();
        }
        let mut best: Option<(FacePolygon, FaceTriangulation)> = None;
        for most in TRIED {
            let (polygon, is_all) = self.polygon(f, most);
            let found = polygon.triangulate();
            let is_sound = found.cost.folded == 0;
            if best.as_ref().is_none_or(|(_, best)| found.cost < best.cost) {
                best = Some((polygon, found));
            }
            if is_all || is_sound {
                break;
            }
        }
        let Some((polygon, found)) = best.filter(|(_, best)| best.cost.folded < known.cost.folded) else {
            return Vec::new();
        };
        let mut corners: Vec<usize> = found.triangles.concat();
        corners.sort_unstable();
        corners.dedup();
        let is_new = |i: &usize| polygon.points[*i].price > 0;
        let crossing = |i: usize| match polygon.points[i].spot {
            BorderSpot::Crossing(e, crossing) => Some((e, crossing)),
            BorderSpot::Corner(_) => None,
        };
        corners.into_iter().filter(is_new).filter_map(crossing).collect()
    }

    /// A face with its sides split where they are, and its triangulation.
    pub fn triangulation(&self, f: FaceId) -> (FacePolygon, FaceTriangulation) {
        let (polygon, _) = self.polygon(f, 0);
        let found = polygon.triangulate();
        (polygon, found)
    }

    /// The border of a face with the crossings that are taken, and at most so many others per side; true if these are all.
    fn polygon(&self, f: FaceId, most: usize) -> (FacePolygon, bool) {
        let (mut points, mut start, mut is_all) = (Vec::new(), [0; 4], true);
        for (k, h) in self.input.face_halfedges(f).into_iter().enumerate() {
            start[k] = points.len();
            points.push(self.corner(h, k));
            let (e, n) = (h.edge(), self.parts.n_crossings(h.edge()));
            is_all &= n <= most;
            for rank in 0..n {
                let crossing = (if h.0 & 1 == 0 { rank + 1 } else { n - rank }) as u32;
                let is_taken = self.taken[e.index()].binary_search(&crossing).is_ok();
                // Those that are tried are spread evenly by their rank.
                if is_taken || n <= most || rank * most / n != (rank + 1) * most / n {
                    points.push(self.crossing(h, k, crossing, is_taken));
                }
            }
        }
        start[3] = points.len();
        (FacePolygon { points, start }, is_all)
    }

    fn corner(&self, h: HalfedgeId, k: usize) -> BorderPoint {
        let corner = self.on_input.points[self.on_input.corner_index[h] as usize];
        let place = self.layout.coordinates[corner as usize];
        BorderPoint { spot: BorderSpot::Corner(k), corner, place, weights: CORNERS[k], price: 0 }
    }

    /// A crossing on the side k of a face, which is the half-edge h.
    fn crossing(&self, h: HalfedgeId, k: usize, crossing: u32, is_taken: bool) -> BorderPoint {
        let corner = self.layout.corner_index[self.parts.from(h, crossing)];
        let place = self.layout.coordinates[corner as usize];
        // Without a subdivision there are no crossings.
        let weights = self.weights_on(h, crossing).unwrap_or(CORNERS[k]);
        let price = if is_taken { 0 } else { self.price(h, crossing) };
        BorderPoint { spot: BorderSpot::Crossing(h.edge(), crossing), corner, place, weights, price }
    }

    /// The weights, in the face of the half-edge h, of a crossing on it.
    fn weights_on(&self, h: HalfedgeId, crossing: u32) -> Option<[f64; 3]> {
        let r = self.layout.common_subdivision()?;
        let part = self.parts.from(h, crossing);
        let (piece, corner) = r.mesh.corner(part)?;
        Some(r.place(0, (piece, corner), part).weights())
    }

    /// The price of splitting a half-edge at a crossing: less where the face across the edge stays sound with that alone.
    fn price(&self, h: HalfedgeId, crossing: u32) -> u32 {
        let across = h.twin();
        let Some(f) = self.input.face(across) else { return PRICE };
        let is_split = self.input.opposite_edges(f).iter().any(|e| !self.taken[e.index()].is_empty());
        if is_split || self.on_input.flipped.binary_search(&f).is_ok() {
            return PRICE;
        }
        let place = |h: HalfedgeId| self.on_input.coordinates[self.on_input.corner_index[h] as usize];
        let at =
            self.layout.coordinates[self.layout.corner_index[self.parts.from(across, crossing)] as usize];
        let [a, b, c] = [across, self.input.next(across), self.input.prev(across)].map(place);
        let is_left = |a, b, c| orientation(a, b, c) == Ordering::Greater;
        if is_left(a, at, c) && is_left(at, b, c) { PRICE } else { PRICE + PRICE_OF_FOLD }
    }
}
