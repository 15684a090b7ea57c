//! Crossings of the input's edges with final edges where the input's edges are drawn straight on the surface, not in the class.
//!
//! Isometric flips have led from the input to an intrinsic triangulation of the same surface, and flips inside the class from there to
//! the final one. The map of the first step is the identity. That of the second is projective on each of the pieces into which
//! intrinsic edges cut the final triangles. A line that is straight in the class is straight on the surface only where it follows an
//! intrinsic edge. Every other edge of the input is followed through the intrinsic faces on a straight line ([`super::geodesic`]), and
//! its crossings with the final edges in these faces ([`super::chords`]) are those of the map itself.
//!
//! That line may cross a final edge and at once cross it back, or cross final edges around its own ends. Curves in normal coordinates do
//! neither. So these crossings are taken out, and those that normal coordinates count are left. Rounding, or taking crossings out, may
//! have put them out of order along either edge; [`restore_order`] brings them into order, because the crossings define a bijection only
//! if their order is right along both edges.

use super::chords::{BorderPlace, FaceChords, Passing, Station};
use super::data::{Crossing, torn};
use super::geodesic::{Straight, straight};
use super::lines::StraightLines;
use super::order::{ORIGIN, OnEdge, TIP, restore_order, restore_order_across};
use super::triangulations::IntrinsicTriangulation;
use crate::control::Control;
use crate::error::Result;
use crate::mesh::normal_trace::CurveCrossing;
use crate::mesh::{Curves, EdgeId, FaceId, HalfedgeId, Mesh, PerEdge};

/// The input's edges as straight lines on the intrinsic triangulation, and the final edges as chords of its faces.
pub(super) struct CrossingPlacement<'a> {
    /// The input's edges on the intrinsic triangulation, with their crossings.
    curves: Curves,
    straight: Vec<Straight>,
    /// Per intrinsic edge: the final half-edge along its half-edge 2e, if it stays.
    stays: PerEdge<Option<HalfedgeId>>,
    chords: FaceChords<'a>,
}

impl<'a> CrossingPlacement<'a> {
    /// O(edges + crossings of any two of the three triangulations). Errors: those of [`super::CommonSubdivision::new`].
    pub fn new(
        intrinsic: IntrinsicTriangulation<'a>,
        lines: &StraightLines,
        control: &Control,
    ) -> Result<CrossingPlacement<'a>> {
        let (mesh, result) = (intrinsic.mesh, lines.result.mesh);
        let curves = Curves::trace(mesh, intrinsic.given, control)?;
        control.check()?;
        let straight = straight(&intrinsic, lines.geometry, &curves);
        control.check()?;
        let on_final = Curves::trace(result, intrinsic.normal, control)?;
        let crossings = lines.crossings(mesh, &on_final)?;
        control.check()?;
        let stays = PerEdge::from_fn(mesh.n_edges(), |e| on_final.along(e));
        let chords = FaceChords { mesh, curves: on_final, crossings, weight: lines.vertex_weights() };
        Ok(CrossingPlacement { curves, straight, stays, chords })
    }

    /// Move the crossings of an edge of the input from the straight line of the class, where they are, to the straight line on the
    /// surface; true if that has changed any.
    pub fn place(&self, e: EdgeId, strip: &[CurveCrossing], placed: &mut [(Crossing, f64)]) -> Result<bool> {
        let along_intrinsic = self.curves.along(e).is_some();
        if !along_intrinsic && !strip.is_empty() {
            for ((crossing, weight), passing) in placed.iter_mut().zip(reduced(self.line(e)?, strip)?) {
                let Passing { halfedge, line, across: [x, y], weight: q } = passing;
                crossing[0].weights = line;
                crossing[1].weights = if halfedge.0 & 1 == 0 { [x, y] } else { [y, x] };
                *weight = q;
            }
        }
        let mut places: Vec<OnEdge> = placed.iter().map(|(crossing, _)| crossing[0].weights).collect();
        restore_order(&mut places);
        let mut moved = !along_intrinsic;
        for ((crossing, _), place) in placed.iter_mut().zip(places) {
            moved |= crossing[0].weights != place;
            crossing[0].weights = place;
        }
        Ok(moved)
    }

    /// Once all crossings are placed, bring those on each final edge into order, and mark in `moved` those that this moves.
    pub fn settle(result: &Mesh, curves: &Curves, crossings: &mut [Crossing], moved: &mut [bool]) {
        let mut places: Vec<OnEdge> = crossings.iter().map(|c| c[1].weights).collect();
        restore_order_across(result, curves, &mut places);
        for ((crossing, place), moved) in crossings.iter_mut().zip(places).zip(moved) {
            *moved |= crossing[1].weights != place;
            crossing[1].weights = place;
        }
    }

    /// All crossings of the straight line of an edge of the input with final edges. Errors: [`crate::Error::Connectivity`] where it leaves the surface.
    fn line(&self, e: EdgeId) -> Result<Vec<Passing>> {
        let (mesh, crossings) = (self.chords.mesh, self.curves.crossings(e));
        // The corner opposite a half-edge, in its face.
        let opposite = |h: HalfedgeId, line: OnEdge| -> Result<(FaceId, Station)> {
            let (f, k) = mesh.corner(h).ok_or_else(torn)?;
            let k = (k + 2) % 3;
            let mut vector = [0.0; 3];
            vector[k] = 1.0;
            Ok((f, Station { border: BorderPlace::Corner(k), line, vector }))
        };
        let mut passed = Vec::new();
        let mut from = None;
        for (straight, at) in self.straight[self.curves.numbers(e)].iter().zip(crossings) {
            let h = at.halfedge;
            // The station on a half-edge, in its face.
            let on = |h: HalfedgeId, [x, y]: OnEdge, rank: i64| -> Result<(FaceId, Station)> {
                let (f, k) = mesh.corner(h).ok_or_else(torn)?;
                let mut vector = [0.0; 3];
                (vector[k], vector[(k + 1) % 3]) = (straight.ratio * x, straight.ratio * y);
                Ok((f, Station { border: BorderPlace::Side(k, rank), line: straight.edge, vector }))
            };
            let rank = self.chords.rank(h, straight.across);
            let (f, to) = on(h, straight.across, rank)?;
            let (_, start) = match from {
                Some(station) => station,
                None => opposite(h, ORIGIN)?,
            };
            self.chords.pass(f, start, to, &mut passed);
            passed.extend(self.along_final(h, straight));
            // The same crossing seen from the other face: ranks along a half-edge and its twin add up to the number of chords.
            let [x, y] = straight.across;
            from = Some(on(h.twin(), [y, x], self.chords.count(h) - rank)?);
        }
        if let (Some((f, start)), Some(last)) = (from, crossings.last()) {
            let (_, end) = opposite(last.halfedge.twin(), TIP)?;
            self.chords.pass(f, start, end, &mut passed);
        }
        Ok(passed)
    }

    /// The crossing of a line with an intrinsic half-edge as one with the final edge along that, if there is one.
    fn along_final(&self, h: HalfedgeId, straight: &Straight) -> Option<Passing> {
        let along = self.stays[h.edge()]?;
        let mesh = self.chords.mesh;
        let ends = [mesh.origin(h), mesh.tip(h)].map(|v| self.chords.weight[v.index()]);
        let [x, y] = straight.across;
        let image = [x * ends[0], y * ends[1]];
        let total = image[0] + image[1];
        Some(Passing {
            halfedge: if h.0 & 1 == 0 { along } else { along.twin() },
            line: straight.edge,
            across: image.map(|x| x / total),
            weight: straight.ratio * total,
        })
    }
}

/// The crossings of `strip` among all those of a line.
fn reduced(passed: Vec<Passing>, strip: &[CurveCrossing]) -> Result<Vec<Passing>> {
    let mut tight: Vec<Passing> = Vec::with_capacity(strip.len());
    for passing in passed {
        match tight.last() {
            Some(last) if last.halfedge == passing.halfedge.twin() => drop(tight.pop()),
            _ => tight.push(passing),
        }
    }
    // Crossings around the ends of the line come before and after those of the strip.
    let same =
        |window: &[Passing]| window.iter().zip(strip).all(|(passing, at)| passing.halfedge == at.halfedge);
    let start = tight.windows(strip.len()).position(same).ok_or_else(torn)?;
    tight.drain(..start);
    tight.truncate(strip.len());
    Ok(tight)
}
