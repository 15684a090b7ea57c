//! Boundary loops of a map that goes over from one domain of the target to another one: straight lines between corners, and the vertices on
//! them.

use super::cover::{Placed, aimed, logarithm, moved};
use super::route::Marks;
use super::slits::Slits;
use super::walk::Found;
use crate::error::{Error, Result};
use crate::geometry::{DoubleDouble, Motion};
use crate::mesh::{HalfedgeId, Mesh, Place, VertexId};
use crate::metric::Surface;
use std::collections::HashMap;

/// Largest weight of the opposite corner at a point on a side of a face.
const ON_SIDE: f64 = 1e-9;

/// The vertices of the source's boundary in the new domain.
pub(super) struct Rims {
    /// Of vertices that go to another face than they were in: the transformation of the new domain from the face where they were.
    ways: HashMap<VertexId, Motion<DoubleDouble>>,
    /// The vertex of the target's boundary before each vertex, and the distance from there in the new domain.
    pub places: Vec<(VertexId, (VertexId, f64))>,
}

/// Puts the boundary exactly on straight lines between its corners, around a loop without corners on one closed line, with frames along
/// them.
pub(super) fn straighten(placed: &mut Placed, marks: &Marks) {
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

/// A loop from corner to corner; the whole loop where it has none.
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
struct Loop<'a> {
    mesh: &'a Mesh,
    around: &'a [HalfedgeId],
    /// Lengths in the new domain before each half-edge, and of the whole loop.
    before: Vec<f64>,
    /// The transformations of the new domain from the face of each half-edge to that of the next.
    steps: Vec<Motion<DoubleDouble>>,
}

impl Rims {
    /// Vertices of the source's boundary, `found` in the old domain; there they are put on the boundary.
    ///
    /// # Errors
    /// [`Error::Matching`] for a vertex that was not found at the boundary.
    pub fn new(
        source: &Surface,
        (old, new): (&Placed, &Placed),
        marks: [&Marks; 2],
        (found, slits): (&mut [Found], &Slits),
    ) -> Result<Rims> {
        let mut rims = Rims { ways: HashMap::new(), places: Vec::new() };
        for (own, around) in marks[0].loops.iter().zip(&marks[1].loops) {
            let mut before = vec![0.0];
            for &h in around {
                let ends = new.corner(new.cover.mesh.next(h));
                let [x, y] = logarithm(new.cover.space, new.frame_at(h).inverse().apply(ends));
                before.push(before[before.len() - 1] + x.hypot(y));
            }
            let target = Loop { mesh: &new.cover.mesh, around, before, steps: slits.along_loop(around)? };
            let mesh = source.mesh();
            let arcs = arcs(mesh, own, &marks[0].corners);
            let has_corners = arcs
                .first()
                .and_then(|arc| arc.first())
                .is_some_and(|&h| marks[0].corners.contains(&mesh.origin(h)));
            let own: Vec<HalfedgeId> = arcs.concat();
            // Counted on around the loop.
            let mut at: Vec<(usize, f64)> = Vec::with_capacity(own.len());
            for &h in &own {
                let (mut k, share) = put(around, old, &mut found[mesh.origin(h).index()])?;
                while at.last().is_some_and(|last| (k, share) < *last) {
                    k += around.len();
                }
                at.push((k, share));
            }
            if has_corners {
                let goals = target.between_corners(source, &arcs, (marks, &at))?;
                for ((&h, from), to) in own.iter().zip(&at).zip(goals) {
                    rims.push(&target, new, (mesh.origin(h), from.0 as i64, to));
                }
            } else {
                for (&h, &(k, share)) in own.iter().zip(&at) {
                    let k = k % around.len();
                    let to = target.before[k] + share * (target.before[k + 1] - target.before[k]);
                    rims.push(&target, new, (mesh.origin(h), k as i64, (k as i64, to)));
                }
            }
        }
        Ok(rims)
    }

    /// The transformation of the new domain from the face where a vertex was found to that in which it has its place.
    pub fn way(&self, v: VertexId) -> Option<&Motion<DoubleDouble>> {
        self.ways.get(&v)
    }

    /// A vertex that goes from one half-edge of a loop to another, counted on around it, and there to this length from the start of the
    /// loop.
    fn push(&mut self, target: &Loop, new: &Placed, (v, from, (to, length)): (VertexId, i64, (i64, f64))) {
        let n = target.around.len() as i64;
        let mut way = Motion::identity(new.cover.space);
        for k in from.min(to)..from.max(to) {
            way = way.compose(&target.steps[k.rem_euclid(n) as usize]).normalised();
        }
        if from != to {
            self.ways.insert(v, if to > from { way } else { way.inverse() });
        }
        let k = to.rem_euclid(n) as usize;
        let x = new.cover.mesh.origin(target.around[k]);
        self.places.push((v, (x, length - target.before[k])));
    }
}

/// Puts a vertex that was found near the boundary onto it: the number of the half-edge of the loop, and the share of that before the
/// vertex.
pub(super) fn put(around: &[HalfedgeId], old: &Placed, found: &mut Found) -> Result<(usize, f64)> {
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

impl Loop<'_> {
    /// Where the vertices go so that corners go to corners, those between them by their share of the length, on the way along the loop that
    /// is shortest for the corners: the number of a half-edge, counted on around the loop, and the length before the vertex there.
    fn between_corners(
        &self,
        source: &Surface,
        arcs: &[Vec<HalfedgeId>],
        (marks, at): ([&Marks; 2], &[(usize, f64)]),
    ) -> Result<Vec<(i64, f64)>> {
        let (mesh, n) = (source.mesh(), self.around.len());
        let starts = arcs.iter().scan(0, |next, arc| {
            let start = *next;
            *next += arc.len();
            Some(start)
        });
        // Where the corners are and where they go.
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
                all.push((k as i64 + laps * n as i64, here - (k / n) as f64 * total));
                before += source.lengths()[h.edge()];
            }
        }
        Ok(all)
    }
}
