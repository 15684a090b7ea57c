//! The boundary loops when a map changes from one domain of the target to another one: straight lines between corners, and the places of
//! the vertices on them.

use super::slits::Slits;
use crate::error::{Error, Result};
use crate::geometry::{DoubleDouble, Motion, Space};
use crate::matching::cover::{LocatedVertex, PlacedMesh, aimed, logarithm, moved};
use crate::matching::landmarks::{MarkedSurface, Marks};
use crate::mesh::{HalfedgeId, Mesh, Place, VertexId};
use std::collections::HashMap;

/// Largest weight of the opposite corner at a point on a side of a face.
const ON_SIDE: f64 = 1e-9;

/// A vertex of the source's boundary on the boundary of the new domain.
pub(super) struct BoundaryPlace {
    pub vertex: VertexId,
    /// The vertex of the target's boundary before it.
    pub before: VertexId,
    /// The distance from that vertex in the new domain.
    pub distance: f64,
}

/// The vertices of the source's boundary in the new domain.
pub(super) struct BoundaryPlacement {
    /// Per vertex that goes to another face the transformation of the new domain from the old face to the new one.
    shifts: HashMap<VertexId, Motion<DoubleDouble>>,
    pub places: Vec<BoundaryPlace>,
}

/// A point of a loop. The numbers of half-edges go on when the loop is run through again.
#[derive(Clone, Copy)]
struct LoopPoint {
    /// The number of its half-edge.
    edge: i64,
    /// Its distance from the start of the loop in the new domain, less than the length of the loop.
    distance: f64,
}

/// Puts the boundary exactly on straight lines between its corners, and a loop without corners on one closed line, with frames along them.
pub(super) fn straighten(placed: &mut PlacedMesh, marks: &Marks) {
    let (mesh, space) = (placed.cover.mesh.clone(), placed.cover.space);
    for arc in marks.loops.iter().flat_map(|around| arcs(&mesh, around, &marks.corners)) {
        let (Some(&first), Some(&last)) = (arc.first(), arc.last()) else { continue };
        let mut total = Motion::identity(space);
        let mut lifts = Vec::with_capacity(arc.len());
        for &h in &arc {
            lifts.push((mesh.origin(h), total));
            if let Some(along) = placed.cover.along(h) {
                total = total.compose(&along).normalised();
            }
        }
        let ends = [placed.at[mesh.origin(first)].origin(), total.apply(placed.at[mesh.tip(last)].origin())];
        let (line, _) = aimed(space, ends);
        for (v, lift) in lifts {
            let [x, _] = logarithm(space, line.inverse().apply(lift.apply(placed.at[v].origin())));
            placed.at[v] = lift.inverse().compose(&moved(&line, [x, 0.0])).normalised();
        }
    }
}

/// The parts of a loop from corner to corner; the whole loop if it has no corners.
fn arcs(mesh: &Mesh, around: &[HalfedgeId], corners: &[VertexId]) -> Vec<Vec<HalfedgeId>> {
    let is_corner = |h: &HalfedgeId| corners.contains(&mesh.origin(*h));
    let Some(first) = around.iter().position(is_corner) else { return vec![around.to_vec()] };
    let mut arcs: Vec<Vec<HalfedgeId>> = Vec::new();
    for k in 0..around.len() {
        let h = around[(first + k) % around.len()];
        if is_corner(&h) {
            arcs.push(Vec::new());
        }
        if let Some(arc) = arcs.last_mut() {
            arc.push(h);
        }
    }
    arcs
}

/// A boundary loop of the target.
struct TargetLoop<'a> {
    mesh: &'a Mesh,
    space: Space,
    around: &'a [HalfedgeId],
    /// The lengths in the new domain from the start to each half-edge, and of the whole loop.
    before: Vec<f64>,
    /// The transformations of the new domain from the face of each half-edge to that of the next.
    steps: Vec<Motion<DoubleDouble>>,
}

impl BoundaryPlacement {
    /// The places of the source's boundary vertices in the new domain. In the old one, where they were `found`, they are put exactly on the
    /// boundary.
    ///
    /// # Errors
    /// [`Error::Matching`] for a vertex that was not found at the boundary.
    pub fn new(
        [old, new]: [&PlacedMesh; 2],
        sides: [MarkedSurface; 2],
        found: &mut [LocatedVertex],
        slits: &Slits,
    ) -> Result<BoundaryPlacement> {
        let mut all = BoundaryPlacement { shifts: HashMap::new(), places: Vec::new() };
        let marks = sides.map(|side| side.marks);
        for (own, around) in marks[0].loops.iter().zip(&marks[1].loops) {
            let mut before = vec![0.0];
            for &h in around {
                let ends = new.corner(new.cover.mesh.next(h));
                let [x, y] = logarithm(new.cover.space, new.frame_at(h).inverse().apply(ends));
                before.push(before[before.len() - 1] + x.hypot(y));
            }
            let (mesh, space) = (&new.cover.mesh, new.cover.space);
            let target = TargetLoop { mesh, space, around, before, steps: slits.along_loop(around)? };
            let mesh = sides[0].surface.mesh();
            let arcs = arcs(mesh, own, &marks[0].corners);
            let has_corners = arcs
                .first()
                .and_then(|arc| arc.first())
                .is_some_and(|&h| marks[0].corners.contains(&mesh.origin(h)));
            let own: Vec<HalfedgeId> = arcs.concat();
            // The number of the half-edge of the target's loop, ascending even beyond its end, and the share of it before the vertex.
            let mut at: Vec<(usize, f64)> = Vec::with_capacity(own.len());
            for &h in &own {
                let (mut k, share) = on_boundary(around, old, &mut found[mesh.origin(h).index()])?;
                while at.last().is_some_and(|last| (k, share) < *last) {
                    k += around.len();
                }
                at.push((k, share));
            }
            if has_corners {
                let goals = target.between_corners(sides, &arcs, &at)?;
                for ((&h, from), to) in own.iter().zip(&at).zip(goals) {
                    all.push(&target, mesh.origin(h), from.0 as i64, to);
                }
            } else {
                for (&h, &(k, share)) in own.iter().zip(&at) {
                    let k = k % around.len();
                    let distance = target.before[k] + share * (target.before[k + 1] - target.before[k]);
                    let to = LoopPoint { edge: k as i64, distance };
                    all.push(&target, mesh.origin(h), to.edge, to);
                }
            }
        }
        Ok(all)
    }

    /// The transformation of the new domain from the face in which a vertex was found to the face of its place; `None` if they are one.
    pub fn shift(&self, v: VertexId) -> Option<&Motion<DoubleDouble>> {
        self.shifts.get(&v)
    }

    /// Adds a vertex that goes from the half-edge `from` of a loop to another point of it.
    fn push(&mut self, target: &TargetLoop, vertex: VertexId, from: i64, to: LoopPoint) {
        let n = target.around.len() as i64;
        let mut shift = Motion::identity(target.space);
        for k in from.min(to.edge)..from.max(to.edge) {
            shift = shift.compose(&target.steps[k.rem_euclid(n) as usize]).normalised();
        }
        if from != to.edge {
            self.shifts.insert(vertex, if to.edge > from { shift } else { shift.inverse() });
        }
        let k = to.edge.rem_euclid(n) as usize;
        let before = target.mesh.origin(target.around[k]);
        self.places.push(BoundaryPlace { vertex, before, distance: to.distance - target.before[k] });
    }
}

/// Puts a vertex that was found near the boundary exactly onto it. Returns the number of the half-edge of the loop and the share of this
/// half-edge before the vertex.
pub(crate) fn on_boundary(
    around: &[HalfedgeId],
    old: &PlacedMesh,
    found: &mut LocatedVertex,
) -> Result<(usize, f64)> {
    let mesh = &old.cover.mesh;
    let (sides, weights) = (mesh.face_halfedges(found.place.face), found.place.weights);
    for c in 0..3 {
        let (a, b) = (weights[c], weights[(c + 1) % 3]);
        let number = around.iter().position(|h| *h == sides[c]);
        if let Some(k) = number.filter(|_| weights[(c + 2) % 3] <= ON_SIDE) {
            return Ok((k, b / (a + b)));
        }
    }
    let nearest = (0..3).max_by(|&i, &j| weights[i].total_cmp(&weights[j])).unwrap_or(0);
    let v = mesh.origin(sides[nearest]);
    let Some(k) = around.iter().position(|&h| mesh.origin(h) == v) else {
        return Err(Error::Matching(format!(
            "a vertex of the boundary lies inside face {} of the target",
            found.place.face
        )));
    };
    let (face, corner) = mesh.corner(around[k]).unwrap_or((found.place.face, nearest));
    if let Some(motion) = old.cover.corner(sides[nearest]) {
        found.copy = motion.inverse().compose(&found.copy).normalised();
    }
    found.place = Place { face, weights: std::array::from_fn(|c| f64::from(c == corner)) };
    Ok((k, 0.0))
}

impl TargetLoop<'_> {
    /// The points to which the source's vertices go, so that corners go to corners, and vertices between them go by their share of the
    /// length. The number of turns around the loop is the one by which the corners move least from where they are now (`at`).
    fn between_corners(
        &self,
        sides: [MarkedSurface; 2],
        arcs: &[Vec<HalfedgeId>],
        at: &[(usize, f64)],
    ) -> Result<Vec<LoopPoint>> {
        let (source, marks) = (sides[0].surface, sides.map(|side| side.marks));
        let (mesh, n) = (source.mesh(), self.around.len());
        let starts = arcs.iter().scan(0, |next, arc| {
            let start = *next;
            *next += arc.len();
            Some(start)
        });
        // The corners' places now, and the half-edges to which they go.
        let (mut now, mut goals): (Vec<f64>, Vec<usize>) = (Vec::new(), Vec::new());
        for (start, arc) in starts.zip(arcs) {
            now.push(at[start].0 as f64 + at[start].1);
            let corner =
                arc.first().and_then(|&h| marks[0].corners.iter().position(|&v| v == mesh.origin(h)));
            let partner = corner.map(|j| marks[1].corners[j]);
            let goal = self.around.iter().position(|&h| Some(self.mesh.origin(h)) == partner);
            let Some(mut goal) = goal else {
                return Err(Error::Matching("a corner has no partner on its loop".into()));
            };
            while goals.last().is_some_and(|last| goal <= *last) {
                goal += n;
            }
            goals.push(goal);
        }
        let off: f64 =
            now.iter().zip(&goals).map(|(x, y)| x - *y as f64).sum::<f64>() / now.len().max(1) as f64;
        let laps = (off / n as f64).round() as i64;
        let total = self.before[n];
        let length = |k: usize| (k / n) as f64 * total + self.before[k % n];
        let mut all = Vec::with_capacity(at.len());
        for (j, arc) in arcs.iter().enumerate() {
            let from = length(goals[j]);
            let to = goals.get(j + 1).map_or(length(goals[0]) + total, |&k| length(k));
            let whole: f64 = arc.iter().map(|h| source.lengths()[h.edge()]).sum();
            let (mut before, mut k) = (0.0, goals[j]);
            for &h in arc {
                let here = from + (before / whole) * (to - from);
                while length(k + 1) <= here {
                    k += 1;
                }
                let edge = k as i64 + laps * n as i64;
                all.push(LoopPoint { edge, distance: here - (k / n) as f64 * total });
                before += source.lengths()[h.edge()];
            }
        }
        Ok(all)
    }
}
