//! Crossings where the input's edges are straight on the surface, not in the class.
//!
//! Isometric flips have led from the input to an intrinsic triangulation of the same surface, flips inside the class from there to
//! the final one. The map of the first step is the identity, that of the second projective on the pieces into which intrinsic
//! edges cut the final triangles. A line that is straight in the class is straight on the surface only where it follows an
//! intrinsic edge; what other edges of the input cross is therefore placed anew:
//!
//! - on a final edge that is an intrinsic one too: where the edge of the input, straight on the surface, crosses it
//!   ([`super::geodesic`]); the image of a point w_i, w_j of an edge has the weights q_i w_i, q_j w_j. That is the map itself;
//! - on other final edges: on these where the straight line of the class is, so that the order there is kept; on the edge of the input
//!   between the nearest crossings of the first kind, or ends, in the proportion that the straight line of the class has there, with
//!   the weight q that the point there has on the surface.
//!
//! Both orders of crossings, along either edge, are kept, which is all that a bijection takes.

use super::geodesic::{Straight, straight};
use super::order::{ORIGIN, Place, TIP, between, share};
use super::pieces::torn;
use super::{Crossing, Final, HALFEDGES};
use crate::control::Control;
use crate::error::{Error, Result, check_size};
use crate::geometry::Space;
use crate::mesh::normal_trace::CurveCrossing;
use crate::mesh::{Curves, EdgeId, HalfedgeId, Mesh, NormalCoordinates, PerEdge};

/// Another triangulation of the same surface, which a flow starts from.
#[derive(Debug, Clone, Copy)]
pub struct Intrinsic<'a> {
    /// The triangulation.
    pub mesh: &'a Mesh,
    /// Lengths of its edges, in the geometry of the input.
    pub lengths: &'a PerEdge<f64>,
    /// The input's edges on it.
    pub given: &'a NormalCoordinates,
    /// Its edges on the final triangulation.
    pub normal: &'a NormalCoordinates,
}

/// Where crossings are to be placed.
pub(super) struct Placement<'a> {
    intrinsic: Intrinsic<'a>,
    result: Final<'a>,
    /// Homogeneous weights of the vertices.
    weight: Vec<f64>,
    /// The input's edges on the intrinsic triangulation, with all their crossings.
    curves: Curves,
    straight: Vec<Straight>,
    /// Per intrinsic edge: whether it is a final one.
    stays: Vec<bool>,
}

impl<'a> Placement<'a> {
    /// O(edges + crossings of the input with the intrinsic triangulation). Errors: [`Error::Size`], [`Error::TooLarge`],
    /// [`Error::Connectivity`] as those of [`super::Refinement::new`].
    pub fn new(
        intrinsic: Intrinsic<'a>,
        geometry: Space,
        result: Final<'a>,
        weight: &[f64],
        control: &Control,
    ) -> Result<Placement<'a>> {
        let mesh = intrinsic.mesh;
        check_size("intrinsic edges", mesh.n_edges(), result.mesh.n_edges())?;
        check_size("intrinsic lengths", intrinsic.lengths.len(), mesh.n_edges())?;
        intrinsic.normal.check(result.mesh)?;
        let count = intrinsic.given.check(mesh)?;
        if count > u32::MAX as usize / HALFEDGES {
            return Err(Error::TooLarge { what: "crossings of input and intrinsic edges", count });
        }
        let curves = Curves::trace(mesh, intrinsic.given)?;
        control.check()?;
        let straight = straight(&intrinsic, geometry, &curves);
        let mut stays = vec![false; mesh.n_edges()];
        for e in result.mesh.edges() {
            if let Some(h) = intrinsic.normal.along(result.mesh, e.halfedge()) {
                stays[h.edge().index()] = true;
            }
        }
        Ok(Placement { intrinsic, result, weight: weight.to_vec(), curves, straight, stays })
    }

    /// Place the crossings of an edge of the input, which are on straight lines of the class; whether they have been moved.
    pub fn place(&self, e: EdgeId, strip: &[CurveCrossing], placed: &mut [(Crossing, f64)]) -> Result<bool> {
        let Some(&(Crossing { input_ends, .. }, _)) = placed.first() else { return Ok(false) };
        if self.curves.along(e).is_some() {
            return Ok(false);
        }
        // The same edges are met in the same order, whatever lies between.
        let on_intrinsic = |at: &CurveCrossing| self.intrinsic.normal.along(self.result.mesh, at.halfedge);
        let ours = self.curves.numbers(e).zip(self.curves.crossings(e));
        let mut common = ours.filter(|(_, at)| self.stays[at.halfedge.edge().index()]);
        let mut anchors: Vec<(usize, usize)> = Vec::new();
        for (k, at) in strip.iter().enumerate() {
            let Some(h) = on_intrinsic(at) else { continue };
            match common.next() {
                Some((c, ours)) if ours.halfedge == h => anchors.push((k, c)),
                _ => return Err(torn()),
            }
        }
        if common.next().is_some() {
            return Err(torn());
        }
        if anchors.is_empty() {
            return Ok(false);
        }
        let class: Vec<Place> = placed.iter().map(|(crossing, _)| crossing.input_weights).collect();
        let profile = self.profile(e, input_ends.map(|v| self.weight[v.index()]));
        let mut last = (None, ORIGIN);
        let ends = anchors.iter().map(|&(k, c)| (Some(k), self.straight[c].edge));
        for (next, place) in ends.chain([(None, TIP)]) {
            let (begin, end) = (last.0.map_or(0, |k: usize| k + 1), next.unwrap_or(placed.len()));
            let on_class = [last.0.map_or(ORIGIN, |k| class[k]), next.map_or(TIP, |k| class[k])];
            for k in begin..end {
                let even = (k + 1 - begin) as f64 / (end + 1 - begin) as f64;
                let t = share(on_class[0], on_class[1], class[k]).unwrap_or(even);
                placed[k].0.input_weights = between(last.1, place, t);
                placed[k].1 = weight_at(&profile, placed[k].0.input_weights);
            }
            last = (next, place);
        }
        for (k, c) in anchors {
            let (crossing, q) = &mut placed[k];
            let across = self.image(c, self.crossed(e, c));
            let total = across[0] + across[1];
            let weights = across.map(|x| x / total);
            let backward = strip[k].halfedge.0 & 1 == 1;
            crossing.final_weights = if backward { [weights[1], weights[0]] } else { weights };
            crossing.input_weights = self.straight[c].edge;
            *q = total;
        }
        Ok(true)
    }

    /// The intrinsic half-edge that crossing c of edge e of the input is on.
    fn crossed(&self, e: EdgeId, c: usize) -> HalfedgeId {
        self.curves.crossings(e)[c - self.curves.numbers(e).start].halfedge
    }

    /// A crossing with an intrinsic half-edge as a vector of the final metric: coefficients of the positions of its ends.
    fn image(&self, c: usize, h: HalfedgeId) -> [f64; 2] {
        let Straight { across, ratio, .. } = self.straight[c];
        let mesh = self.intrinsic.mesh;
        let ends = [mesh.origin(h), mesh.tip(h)];
        [0, 1].map(|k| ratio * across[k] * self.weight[ends[k].index()])
    }

    /// The homogeneous weight along an edge of the input: linear between these places.
    fn profile(&self, e: EdgeId, ends: [f64; 2]) -> Vec<(Place, f64)> {
        let crossings = self.curves.numbers(e).zip(self.curves.crossings(e));
        let inside = crossings.map(|(c, at)| {
            let [x, y] = self.image(c, at.halfedge);
            (self.straight[c].edge, x + y)
        });
        std::iter::once((ORIGIN, ends[0])).chain(inside).chain([(TIP, ends[1])]).collect()
    }
}

fn weight_at(profile: &[(Place, f64)], at: Place) -> f64 {
    let next =
        profile.partition_point(|(place, _)| super::order::before(*place, at)).clamp(1, profile.len() - 1);
    let ((from, q), (to, r)) = (profile[next - 1], profile[next]);
    let t = share(from, to, at).unwrap_or(0.5);
    (1.0 - t) * q + t * r
}
