//! Slits along which landmarks are pushed: they turn deck transformations of one domain of the target into those of another one.
//!
//! A surface lies in the opened *old* domain of the target, its landmarks not yet at their partners. A path along edges leads from each
//! landmark to its partner; no two paths meet. A landmark that is pushed along its path, the *slit*, pushes ahead of itself every line that
//! crosses the path: afterwards the line goes around the end of the path. So the class of a line that is straight in the old domain, up to
//! homotopy in the target without the partners, is known from the edges of the target and the slits that it crosses, and with it the deck
//! transformation along the line in any *new* domain of the target. Nothing is moved, so nothing can fold.

use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::{DoubleDouble, Motion, Space};
use crate::matching::cover::{PlacedMesh, PrecisePoint, determinant, logarithm};
use crate::matching::landmarks::{Marks, PathRouter};
use crate::mesh::shapes::SplitMix64;
use crate::mesh::{FaceId, HalfedgeId, Mesh, PerEdge, VertexId};
use crate::topology::shortest_paths;
use std::collections::HashMap;

/// Least weight of a corner at a point inside a face: points on edges and at vertices are moved beside them, so that lines cross edges.
const LEAST_WEIGHT: f64 = 1e-7;
/// Most faces that a line crosses.
const MOST_CROSSED: usize = 100_000;

/// A point strictly inside a face of the target, in the opened old domain.
#[derive(Debug, Clone, Copy)]
pub(super) struct PointInFace {
    /// Face of the target.
    pub face: FaceId,
    pub point: PrecisePoint,
}

impl PointInFace {
    /// The point of a face with these weights, or near it where it lies on a side of the face.
    pub fn new(old: &PlacedMesh, face: FaceId, weights: [f64; 3]) -> PointInFace {
        let weights = weights.map(|w| DoubleDouble::from(w.max(LEAST_WEIGHT)));
        let total = weights[0] + weights[1] + weights[2];
        let corners = old.corners(face);
        let point =
            [0, 1, 2].map(|i| (0..3).fold(DoubleDouble::from(0.0), |p, k| p + weights[k] * corners[k][i]));
        PointInFace { face, point: point.map(|x| x / total) }
    }
}

/// The point from which a landmark of the source is pushed.
#[derive(Debug, Clone, Copy)]
pub(super) enum PushStart {
    /// Its partner already, at the corner of this half-edge.
    AtPartner(HalfedgeId),
    /// This point.
    AtPoint(PointInFace),
}

/// A landmark that is pushed to its partner, with its name in messages.
#[derive(Debug, Clone)]
pub(super) struct PushedLandmark {
    pub start: PushStart,
    /// Its partner, a vertex of the target.
    pub to: VertexId,
    pub name: String,
}

/// The target with the starts of the landmarks as additional vertices, and the slits.
pub(super) struct Slits<'a> {
    old: &'a PlacedMesh,
    new: &'a PlacedMesh,
    mesh: Mesh,
    /// Per face of `mesh` its corners in the opened old domain.
    corners: Vec<[PrecisePoint; 3]>,
    /// Per face of the target with additional vertices the faces of `mesh` in it.
    parts: HashMap<FaceId, Vec<FaceId>>,
    /// Per half-edge on a slit the transformation of the new domain from its face around the end of the slit to the face across.
    around: HashMap<HalfedgeId, Motion<DoubleDouble>>,
    /// Per landmark a half-edge that leaves its start, and the transformation from its place in the new domain to the face of this
    /// half-edge.
    exits: Vec<(HalfedgeId, Motion<DoubleDouble>)>,
}

/// A triangulation that points are added to.
struct GrowingMesh {
    n_vertices: usize,
    origin: Vec<u32>,
    sides: Vec<[u32; 3]>,
    corners: Vec<[PrecisePoint; 3]>,
    parts: HashMap<FaceId, Vec<FaceId>>,
}

impl GrowingMesh {
    fn new(old: &PlacedMesh) -> GrowingMesh {
        let mesh = &old.cover.mesh;
        GrowingMesh {
            n_vertices: mesh.n_vertices(),
            origin: mesh.halfedges().map(|h| mesh.origin(h).0).collect(),
            sides: mesh.faces().map(|f| mesh.face_halfedges(f).map(|h| h.0)).collect(),
            corners: mesh.faces().map(|f| old.corners(f)).collect(),
            parts: HashMap::new(),
        }
    }

    /// Adds a point, joined to the corners of the part that it lies in.
    fn add(&mut self, at: PointInFace) -> Result<VertexId> {
        let parts = self.parts.entry(at.face).or_insert_with(|| vec![at.face]);
        let Some(f) = parts.iter().find(|f| is_inside(&self.corners[f.index()], at.point)).map(|f| f.index())
        else {
            return Err(Error::Matching(format!("landmarks coincide in face {} of the target", at.face)));
        };
        let (new, middle, p) = (self.sides.len(), self.n_vertices as u32, at.point);
        self.n_vertices += 1;
        let ([a, b, c], [x, y, z]) = (self.sides[f], self.corners[f]);
        // Half-edges from the three corners to the point; their twins have the next numbers.
        let to = [a, b, c].map(|side| {
            self.origin.extend([self.origin[side as usize], middle]);
            self.origin.len() as u32 - 2
        });
        self.sides[f] = [a, to[1], to[0] + 1];
        self.corners[f] = [x, y, p];
        self.sides.extend([[b, to[2], to[1] + 1], [c, to[0], to[2] + 1]]);
        self.corners.extend([[y, z, p], [z, x, p]]);
        parts.extend([FaceId::from(new), FaceId::from(new + 1)]);
        Ok(VertexId(middle))
    }
}

impl<'a> Slits<'a> {
    /// The slits of landmarks in the target, which lies in the old and the new domain and has these boundary loops. The variant selects
    /// other paths than the shortest: by variant 0 they are the shortest.
    ///
    /// # Errors
    /// [`Error::Matching`] for landmarks that coincide or have no path beside each other, named.
    pub fn new(
        [old, new]: [&'a PlacedMesh; 2],
        pushes: &[PushedLandmark],
        loops: &[Vec<HalfedgeId>],
        variant: u64,
        control: &Control,
    ) -> Result<Slits<'a>> {
        let mut growing = GrowingMesh::new(old);
        let add = |push: &PushedLandmark| match push.start {
            PushStart::AtPartner(_) => Ok(push.to),
            PushStart::AtPoint(point) => growing.add(point),
        };
        let starts: Vec<VertexId> = pushes.iter().map(add).collect::<Result<_>>()?;
        let GrowingMesh { n_vertices, origin, sides, corners, parts } = growing;
        let mesh = Mesh::assemble(n_vertices, origin, &sides)?;
        let lengths = varied(&mesh, lengths(old.cover.space, &mesh, &corners), variant, control)?;
        let paths = paths(&mesh, lengths, pushes, &starts, loops)?;
        let mut slits = Slits { old, new, mesh, corners, parts, around: HashMap::new(), exits: Vec::new() };
        for (push, path) in pushes.iter().zip(&paths) {
            let exit = match (push.start, path.first(), path.last()) {
                (PushStart::AtPartner(h), ..) => (h, slits.vertex_to(h)?),
                (_, Some(&first), Some(&last)) => {
                    // Along the left side of the slit, from its end.
                    let mut back = slits.vertex_to(slits.mesh.next(last))?;
                    for pair in path.windows(2).rev() {
                        back = back.compose(&slits.turn(pair[1], slits.mesh.next(pair[0]))?);
                    }
                    (first, back.normalised())
                }
                _ => return Err(no_way(pushes, slits.exits.len(), Vec::new())),
            };
            slits.exits.push(exit);
            slits.open(path)?;
        }
        Ok(slits)
    }

    /// Notes for the edges of a slit the transformations around its end from their left side to the right one.
    fn open(&mut self, path: &[HalfedgeId]) -> Result<()> {
        let Some(&last) = path.last() else { return Ok(()) };
        let mut around = self.turn(last.twin(), self.mesh.next(last))?.inverse();
        let mut next: Option<HalfedgeId> = None;
        for &h in path.iter().rev() {
            if let Some(ahead) = next {
                let left = self.turn(ahead, self.mesh.next(h))?;
                let right = self.turn(h.twin(), self.mesh.next(ahead.twin()))?;
                around = left.inverse().compose(&around).compose(&right.inverse()).normalised();
            }
            self.around.insert(h, around);
            self.around.insert(h.twin(), around.inverse());
            next = Some(h);
        }
        Ok(())
    }

    /// The transformation of the new domain across a half-edge that lies on no slit.
    fn across(&self, h: HalfedgeId) -> Option<&Motion<DoubleDouble>> {
        if h.index() < self.new.cover.mesh.n_halfedges() { self.new.cover.across(h) } else { None }
    }

    /// The transformation of the new domain from the face of a half-edge to that of another one with the same origin, counterclockwise.
    fn turn(&self, from: HalfedgeId, to: HalfedgeId) -> Result<Motion<DoubleDouble>> {
        let (mut h, mut total) = (from, Motion::identity(self.new.cover.space));
        for _ in 0..self.mesh.n_halfedges() {
            if h == to {
                return Ok(total.normalised());
            }
            let side = self.mesh.prev(h);
            if let Some(across) = self.across(side) {
                total = total.compose(across);
            }
            h = side.twin();
        }
        Err(Error::connectivity("half-edge", to.index(), "is not found around its vertex"))
    }

    /// From the place of a vertex of the target in the new domain to the face of a half-edge that leaves it.
    fn vertex_to(&self, h: HalfedgeId) -> Result<Motion<DoubleDouble>> {
        let own = self.new.cover.own(self.mesh.origin(h));
        self.turn(own, h)
    }

    /// Per half-edge of a loop the transformation of the new domain from its face to the face of the next one.
    pub fn along_loop(&self, around: &[HalfedgeId]) -> Result<Vec<Motion<DoubleDouble>>> {
        let step = |k: usize| {
            let ahead = around[(k + 1) % around.len()];
            Ok(self.turn(ahead, self.mesh.next(around[k]))?.inverse())
        };
        (0..around.len()).map(step).collect()
    }

    /// The transformation of the new domain, from face to face, along the straight line of the old one from a point to the lift `to` of
    /// another one.
    ///
    /// # Errors
    /// [`Error::Matching`] if the line does not arrive.
    pub fn between(&self, from: PointInFace, to: PrecisePoint) -> Result<Motion<DoubleDouble>> {
        let start = match self.parts.get(&from.face) {
            None => Some(from.face),
            Some(parts) => parts.iter().copied().find(|f| is_inside(&self.corners[f.index()], from.point)),
        };
        let start = start.ok_or_else(|| lost(from.face))?;
        self.walk(start, Motion::identity(self.new.cover.space), [from.point, to])
    }

    /// As [`Slits::between`] from landmark k, from its place in the new domain. The point `to` is given in the face in which the landmark
    /// starts.
    ///
    /// # Errors
    /// As [`Slits::between`].
    pub fn landmark_to(&self, k: usize, mut to: PrecisePoint) -> Result<Motion<DoubleDouble>> {
        let (mut h, mut total) = self.exits[k];
        let first = h;
        loop {
            let Some((f, corner)) = self.mesh.corner(h) else { return Err(lost(FaceId(0))) };
            let of = |k: usize| self.corners[f.index()][(corner + k) % 3];
            let [right, left] = [1, 2].map(|k| is_left([of(0), to], of(k)));
            if !right && left {
                return self.walk(f, total, [of(0), to]);
            }
            let side = self.mesh.prev(h);
            if let Some(across) = self.across(side) {
                total = total.compose(across);
            }
            if let Some(across) = self.old_across(side) {
                to = across.inverse().apply(to);
            }
            h = side.twin();
            if h == first {
                return Err(lost(f));
            }
        }
    }

    fn old_across(&self, h: HalfedgeId) -> Option<&Motion<DoubleDouble>> {
        if h.index() < self.old.cover.mesh.n_halfedges() { self.old.cover.across(h) } else { None }
    }

    /// Follows a line from a point of face f; `total`: the transformation up to this face.
    fn walk(
        &self,
        mut f: FaceId,
        mut total: Motion<DoubleDouble>,
        [mut from, mut to]: [PrecisePoint; 2],
    ) -> Result<Motion<DoubleDouble>> {
        for _ in 0..MOST_CROSSED {
            let corners = &self.corners[f.index()];
            if is_inside(corners, to) {
                return Ok(total.normalised());
            }
            // A line leaves a triangle through the side from a corner on its right to one on its left.
            let left = corners.map(|p| is_left([from, to], p));
            let Some(k) = (0..3).find(|&k| !left[k] && left[(k + 1) % 3]) else { return Err(lost(f)) };
            let h = self.mesh.face_halfedges(f)[k];
            if let Some(across) = self.around.get(&h).or_else(|| self.across(h)) {
                total = total.compose(across);
            }
            if let Some(across) = self.old_across(h) {
                let back = across.inverse();
                (from, to) = (back.apply(from), back.apply(to));
            }
            f = self.mesh.face(h.twin()).ok_or_else(|| lost(f))?;
        }
        Err(lost(f))
    }
}

/// The paths of the landmarks, found in the order of their lengths; empty for those that are at their partners already.
fn paths(
    mesh: &Mesh,
    lengths: PerEdge<f64>,
    pushes: &[PushedLandmark],
    starts: &[VertexId],
    loops: &[Vec<HalfedgeId>],
) -> Result<Vec<Vec<HalfedgeId>>> {
    let n = pushes.len();
    let ends: Vec<VertexId> = pushes.iter().map(|push| push.to).collect();
    let moves: Vec<usize> = (0..n).filter(|&k| starts[k] != ends[k]).collect();
    // The ends of all, then the starts of those that move.
    let landmarks = ends.iter().copied().chain(moves.iter().map(|&k| starts[k])).collect();
    let marks = Marks { landmarks, loops: loops.to_vec(), corners: Vec::new() };
    let mut router = PathRouter::new(mesh, &lengths, &marks);
    // The length of the path of each alone; infinite for those that have no path even then, which come last.
    let length = |j: usize, k: usize| router.length([n + j, k]).unwrap_or(f64::INFINITY);
    let mut order: Vec<_> = moves.iter().enumerate().map(|(j, &k)| (length(j, k), j, k)).collect();
    order.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let mut paths = vec![Vec::new(); n];
    for (number, &(_, j, k)) in order.iter().enumerate() {
        if router.join([n + j, k], None).is_err() {
            let name = |mark: usize| match moves.get(mark.wrapping_sub(n)) {
                Some(&moved) => Some(moved),
                None => Some(mark).filter(|&mark| mark < n),
            };
            let mut others = Vec::new();
            for (marks, paths) in [router.around(k), router.around(n + j)] {
                others.extend(marks.into_iter().filter_map(name));
                others.extend(paths.into_iter().filter(|&path| path < number).map(|path| order[path].2));
            }
            return Err(no_way(pushes, k, others));
        }
        paths[k] = router.paths.last().cloned().unwrap_or_default();
    }
    Ok(paths)
}

/// Number of hills of a variant.
const HILLS: usize = 3;
/// Factor, less 1, by which lengths at the top of a hill are multiplied.
const HEIGHT: f64 = 8.0;
/// Width of a hill, as a share of the largest distance from its top.
const WIDTH: f64 = 0.25;

/// Lengths by which other paths are the shortest: multiplied by hills about random vertices. In variant 0 they are the given ones.
fn varied(mesh: &Mesh, lengths: PerEdge<f64>, variant: u64, control: &Control) -> Result<PerEdge<f64>> {
    let mut random = SplitMix64::new(variant);
    let mut longer = lengths.clone();
    for _ in 0..if variant == 0 { 0 } else { HILLS } {
        let top = VertexId((random.unit() * mesh.n_vertices() as f64) as u32);
        let far = shortest_paths(mesh, &lengths, vec![top], control)?.distance;
        let width = WIDTH * far.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        for e in mesh.edges() {
            let [a, b] = mesh.ends(e).map(|v| far[v] / width);
            longer[e] *= 1.0 + HEIGHT * (-a * b).exp();
        }
    }
    Ok(longer)
}

/// The lengths of the edges in the old domain.
fn lengths(space: Space, mesh: &Mesh, corners: &[[PrecisePoint; 3]]) -> PerEdge<f64> {
    PerEdge::from_fn(mesh.n_edges(), |e: crate::mesh::EdgeId| {
        let h = e.halfedge();
        let h = if mesh.is_outside(h) { h.twin() } else { h };
        mesh.corner(h).map_or(0.0, |(f, k)| {
            let [p, q] = [0, 1].map(|j| corners[f.index()][(k + j) % 3]);
            let [x, y] = logarithm(space, Motion::to_origin(space, p).apply(q));
            x.hypot(y)
        })
    })
}

/// True if a point lies on the left of the line from one point to another, or on this line.
fn is_left([from, to]: [PrecisePoint; 2], p: PrecisePoint) -> bool {
    f64::from(determinant([from, to, p])) >= 0.0
}

fn is_inside(corners: &[PrecisePoint; 3], p: PrecisePoint) -> bool {
    (0..3).all(|k| is_left([corners[k], corners[(k + 1) % 3]], p))
}

/// The error of landmark k, whose path meets those of others or these landmarks.
fn no_way(pushes: &[PushedLandmark], k: usize, mut others: Vec<usize>) -> Error {
    others.retain(|&other| other != k);
    others.sort_unstable();
    others.dedup();
    let names: Vec<&str> = others.into_iter().map(|other| pushes[other].name.as_str()).collect();
    Error::Matching(format!(
        "{} has no way to its goal: it is in conflict with {}; refine the target (`ricci refine --edge L`), or leave one of them out",
        pushes[k].name,
        names.join(", ")
    ))
}

fn lost(f: FaceId) -> Error {
    Error::Matching(format!("a straight line of the domain is lost in face {f} of the target"))
}
