//! Finds the place of each vertex of one triangulation in the other one, with decisions in double-double precision: inside a face, on a
//! side at the boundary, or at a vertex.

use super::super::cover::{LocatedVertex, WalkSeed, located};
use super::super::cover::{PlacedMesh, PrecisePoint, aimed, determinant, logarithm, moved};
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::plane_triangle::PlaneTriangle;
use crate::geometry::{DoubleDouble, Motion};
use crate::mesh::{FaceId, HalfedgeId, PerVertex, Place, VertexId};

/// Number of vertices between two looks at the control.
const VERTICES_PER_LOOK: usize = 256;
/// Least distance by which a vertex is moved aside, as a share of the least height of its triangles, so that no three different points lie
/// on one line.
const ASIDE: f64 = 1e-12;
/// The same as a multiple of the largest gap between copies of the domain, so that decisions on one copy hold on the others.
const GAPS: f64 = 1e3;
/// Largest distance by which a vertex is moved aside, as the same share.
const MOST_ASIDE: f64 = 1e-6;
/// Largest distance at which a vertex is identified with one of the other triangulation, as a multiple of that by which it is moved aside.
const SAME: f64 = 10.0;
/// Largest number of sides that are crossed from the face that a search has found to the one that contains a point.
const MOST_STEPS: usize = 64;
/// The golden angle, by which the directions turn in which vertices are moved aside, so that all are different.
const GOLDEN: f64 = 2.399_963_229_728_653;

/// A vertex of one triangulation in the opened domain of the other one.
#[derive(Debug, Clone, Copy)]
pub(super) struct PlacedVertex {
    /// A half-edge of the face that contains it, the side at the boundary that it lies on, or a half-edge that leaves the vertex that it is
    /// at.
    pub near: HalfedgeId,
    /// The transformation that carries the vertex's own position into the opened domain.
    pub copy: Motion<DoubleDouble>,
    pub at: VertexPlace,
}

/// The place of a vertex of one triangulation in the other one.
#[derive(Debug, Clone, Copy)]
pub(super) enum VertexPlace {
    Inside(WeightedPlace),
    /// On a side at the boundary, at this distance from its origin.
    Side(WeightedPlace, f64),
    Vertex(VertexId),
}

/// A place, and the sum of the weights with which the corners, as vectors, give the point.
#[derive(Debug, Clone, Copy)]
pub(super) struct WeightedPlace {
    pub place: Place,
    pub total: f64,
}

/// A face of a domain in the frame of one of its corners, where the coordinates of small triangles differ in all their digits.
pub(super) struct FaceView {
    pub home: Motion<DoubleDouble>,
    /// Its half-edges, from that of the frame on.
    pub sides: [HalfedgeId; 3],
    pub corners: [PrecisePoint; 3],
}

impl FaceView {
    pub fn new(domain: &PlacedMesh, near: HalfedgeId) -> FaceView {
        let mesh = &domain.cover.mesh;
        let home = domain.frame_at(near).inverse();
        let sides = [near, mesh.next(near), mesh.prev(near)];
        FaceView { home, sides, corners: sides.map(|h| home.apply(domain.corner(h))) }
    }

    /// The determinant of a point with the side opposite each corner, positive inside.
    fn parts(&self, p: PrecisePoint) -> [f64; 3] {
        [0, 1, 2].map(|k| f64::from(determinant([p, self.corners[(k + 1) % 3], self.corners[(k + 2) % 3]])))
    }

    fn spot(&self, domain: &PlacedMesh, parts: [f64; 3]) -> WeightedPlace {
        let inside = parts.map(|x| x.max(0.0));
        let sum: f64 = inside.iter().sum();
        let own = if sum > 0.0 { inside.map(|x| x / sum) } else { [1.0 / 3.0; 3] };
        let (face, first) = domain.cover.mesh.corner(self.sides[0]).unwrap_or((FaceId(0), 0));
        let weights = std::array::from_fn(|k| own[(k + 3 - first) % 3]);
        let total = sum / f64::from(determinant(self.corners));
        WeightedPlace { place: Place { face, weights }, total: if total > 0.0 { total } else { 1.0 } }
    }
}

/// A face of a domain near a point: a half-edge of that, and the transformation that carries the point there.
#[derive(Clone, Copy)]
struct FaceNearPoint {
    near: HalfedgeId,
    copy: Motion<DoubleDouble>,
}

impl FaceNearPoint {
    /// The same for the face across a side of this one.
    fn across(&self, domain: &PlacedMesh, side: HalfedgeId) -> FaceNearPoint {
        let copy = domain
            .cover
            .across(side)
            .map_or(self.copy, |across| across.inverse().compose(&self.copy).normalised());
        FaceNearPoint { near: side.twin(), copy }
    }
}

/// Per vertex the least height of the triangles at it, in their domain.
fn heights(placed: &PlacedMesh) -> PerVertex<f64> {
    let mesh = &placed.cover.mesh;
    let vectors = placed.logarithms();
    let mut heights = PerVertex::filled(mesh.n_vertices(), f64::INFINITY);
    for f in mesh.faces() {
        let sides = mesh.face_halfedges(f).map(|h| vectors[h][0].hypot(vectors[h][1]));
        let longest = sides.into_iter().fold(f64::MIN_POSITIVE, f64::max);
        let height = 2.0 * PlaneTriangle::from_sides(sides).area / longest;
        mesh.face_vertices(f).into_iter().for_each(|v| heights[v] = heights[v].min(height));
    }
    heights
}

/// The largest distance between the positions of a corner in two neighbouring faces, which differ by the rounding of deck transformations.
fn gap(placed: &PlacedMesh) -> f64 {
    let mesh = &placed.cover.mesh;
    let of = |h: HalfedgeId| {
        let across = placed.cover.across(h)?;
        let there = across.apply(placed.corner(mesh.next(h.twin())));
        let [x, y, _] = placed.frame_at(h).inverse().apply(there);
        Some(f64::from(x).hypot(f64::from(y)))
    };
    let inner = mesh.halfedges().filter(|&h| !mesh.is_outside(h) && !mesh.is_outside(h.twin()));
    inner.filter_map(of).fold(0.0, f64::max)
}

/// The places of the vertices of both triangulations in each other. The source's vertices have been moved by tiny distances: aside, or to
/// vertices of the target that are so near. Vertices of the target with one of the source at them have no place of their own.
pub(super) struct SettledVertices {
    pub source: PlacedMesh,
    pub forward: Vec<PlacedVertex>,
    pub backward: Vec<Option<PlacedVertex>>,
    /// Per vertex of the target, the vertex of the source at it.
    pub taken: PerVertex<Option<VertexId>>,
}

impl SettledVertices {
    /// # Errors
    /// [`Error::Matching`] if the places of vertices cannot be decided; [`Error::Cancelled`].
    pub fn new(
        [source, target]: [&PlacedMesh; 2],
        seeds: [WalkSeed; 2],
        control: &Control,
    ) -> Result<SettledVertices> {
        let high = [heights(source), heights(target)];
        let gap = gap(source).max(gap(target));
        let aside = |v: VertexId| (ASIDE * high[0][v]).max(GAPS * gap).min(MOST_ASIDE * high[0][v]);
        let mut source = source.clone();
        let mesh = source.cover.mesh.clone();
        for v in mesh.vertices().filter(|&v| !mesh.is_boundary_vertex(v)) {
            let (angle, by) = (GOLDEN * v.index() as f64, aside(v));
            source.at[v] = moved(&source.at[v], [by * angle.cos(), by * angle.sin()]);
        }
        let (found, _) = located(&source, target, seeds[0], control)?;
        let mut taken = PerVertex::filled(target.at.len(), None);
        let mut forward = Vec::with_capacity(found.len());
        let mut steps = 0;
        for (v, found) in mesh.vertices().zip(&found) {
            control.check_every(VERTICES_PER_LOOK, &mut steps)?;
            let mut standing = stand(&source, target, v, found)?;
            let same = |b: VertexId| (SAME * aside(v)).min(SAME * MOST_ASIDE * high[1][b]);
            if let Some((h, b)) = next_to(&source, target, v, &standing, same)
                && taken[b].is_none()
            {
                taken[b] = Some(v);
                source.at[v] = standing.copy.inverse().compose(&target.frame_at(h)).normalised();
                standing = PlacedVertex { near: h, at: VertexPlace::Vertex(b), ..standing };
            }
            forward.push(standing);
        }
        if let Some(f) = source.flipped().first() {
            return Err(Error::Matching(format!("face {f} of the source is too thin for an overlay")));
        }
        let (found, _) = located(target, &source, seeds[1], control)?;
        let mut back = |(v, found): (VertexId, &LocatedVertex)| {
            control.check_every(VERTICES_PER_LOOK, &mut steps)?;
            match taken[v] {
                Some(_) => Ok(None),
                None => stand(target, &source, v, found).map(Some),
            }
        };
        let backward = target.cover.mesh.vertices().zip(&found).map(&mut back).collect::<Result<_>>()?;
        Ok(SettledVertices { source, forward, backward, taken })
    }
}

/// The corner, of the face that contains a vertex, that is so near that both count as one, if both are inside the surface or both on the
/// boundary.
fn next_to(
    points: &PlacedMesh,
    domain: &PlacedMesh,
    v: VertexId,
    standing: &PlacedVertex,
    same: impl Fn(VertexId) -> f64,
) -> Option<(HalfedgeId, VertexId)> {
    let mesh = &domain.cover.mesh;
    let point = standing.copy.apply(points.at[v].origin());
    let outside = points.cover.mesh.is_boundary_vertex(v);
    let near = |h: HalfedgeId| {
        let [x, y] = logarithm(domain.cover.space, domain.frame_at(h).inverse().apply(point));
        let b = mesh.origin(h);
        (x.hypot(y) <= same(b) && mesh.is_boundary_vertex(b) == outside).then_some((h, b))
    };
    [standing.near, mesh.next(standing.near), mesh.prev(standing.near)].into_iter().find_map(near)
}

fn stand(
    points: &PlacedMesh,
    domain: &PlacedMesh,
    v: VertexId,
    found: &LocatedVertex,
) -> Result<PlacedVertex> {
    let seen = FaceNearPoint { near: found.near, copy: found.copy };
    let point = points.at[v].origin();
    if points.cover.mesh.is_boundary_vertex(v) {
        return on_side(domain, point, seen).ok_or_else(|| lost(v));
    }
    inside(domain, point, seen).ok_or_else(|| lost(v))
}

fn lost(v: VertexId) -> Error {
    Error::Matching(format!(
        "the place of vertex {v} in the other surface is not clear enough for an overlay"
    ))
}

/// The place of a point inside a face, from a face that contains it up to rounding.
fn inside(domain: &PlacedMesh, point: PrecisePoint, mut seen: FaceNearPoint) -> Option<PlacedVertex> {
    for _ in 0..MOST_STEPS {
        let view = FaceView::new(domain, seen.near);
        let parts = view.parts(view.home.apply(seen.copy.apply(point)));
        let Some(k) = (0..3).find(|&k| parts[k] < 0.0) else {
            let at = VertexPlace::Inside(view.spot(domain, parts));
            return Some(PlacedVertex { near: seen.near, copy: seen.copy, at });
        };
        let side = view.sides[(k + 1) % 3];
        if domain.cover.mesh.is_outside(side.twin()) {
            return None;
        }
        seen = seen.across(domain, side);
    }
    None
}

/// The place of a point on the side at the boundary that is nearest to it, of those around the face.
fn on_side(domain: &PlacedMesh, point: PrecisePoint, seen: FaceNearPoint) -> Option<PlacedVertex> {
    let (mesh, space) = (&domain.cover.mesh, domain.cover.space);
    let mut best: Option<(f64, FaceNearPoint, f64)> = None;
    for seen in around(domain, seen) {
        for side in [seen.near, mesh.next(seen.near), mesh.prev(seen.near)] {
            if !mesh.is_outside(side.twin()) {
                continue;
            }
            let ends = [side, mesh.next(side)].map(|h| domain.corner(h));
            let (frame, length) = aimed(space, ends);
            let [x, y] = logarithm(space, frame.inverse().apply(seen.copy.apply(point)));
            let off = (-x).max(x - length).max(0.0) + y.abs();
            if best.is_none_or(|(least, ..)| off < least) {
                best = Some((off, FaceNearPoint { near: side, ..seen }, x));
            }
        }
    }
    let (_, seen, x) = best?;
    let view = FaceView::new(domain, seen.near);
    let [a, b, _] = view.parts(view.home.apply(seen.copy.apply(point)));
    // The point is on the side, so that its weight of the third corner is set to 0.
    let spot = view.spot(domain, [a, b, 0.0]);
    Some(PlacedVertex { near: seen.near, copy: seen.copy, at: VertexPlace::Side(spot, x) })
}

/// The faces around the corners of a face.
fn around(domain: &PlacedMesh, seen: FaceNearPoint) -> Vec<FaceNearPoint> {
    let mesh = &domain.cover.mesh;
    let mut all = Vec::new();
    for near in [seen.near, mesh.next(seen.near), mesh.prev(seen.near)] {
        let most = mesh.fan(mesh.origin(near)).len();
        let mut at = FaceNearPoint { near, ..seen };
        all.push(at);
        for _ in 1..most {
            let side = mesh.prev(at.near);
            if mesh.is_outside(side.twin()) {
                break;
            }
            at = at.across(domain, side);
            all.push(at);
        }
        at = FaceNearPoint { near, ..seen };
        for _ in 1..most {
            if mesh.is_outside(at.near.twin()) {
                break;
            }
            at = at.across(domain, at.near);
            at.near = mesh.next(at.near);
            all.push(at);
        }
    }
    all
}
