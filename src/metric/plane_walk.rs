//! Straight walks over a Euclidean triangulation, whose faces are unfolded into one plane on the way.
//!
//! With them the centre of a triangle's circumcircle is found on the surface, and the faces whose circumcircles contain it.

use crate::geometry::plane_triangle::PlaneTriangle;
use crate::mesh::{EdgeId, FaceId, HalfedgeId, Mesh, PerEdge};

pub(super) type PlanePoint = [f64; 2];

/// A face unfolded into the plane: its sides, and the points at which they start, counterclockwise.
#[derive(Debug, Clone, Copy)]
pub(super) struct UnfoldedFace {
    pub face: FaceId,
    pub sides: [HalfedgeId; 3],
    pub points: [PlanePoint; 3],
}

/// The end of a walk towards a point.
#[derive(Debug, Clone, Copy)]
pub(super) enum WalkEnd {
    /// The face that contains the point.
    Inside(UnfoldedFace),
    /// The boundary edge that the walk met first.
    Boundary(EdgeId),
    /// More faces than the surface has: rounding on thin triangles.
    Lost,
}

/// How many times a straight walk may pass through a face, in the mean of all faces, before it counts as lost.
const MOST_PASSAGES: usize = 100;

fn sub(a: PlanePoint, b: PlanePoint) -> PlanePoint {
    [a[0] - b[0], a[1] - b[1]]
}

fn cross(a: PlanePoint, b: PlanePoint) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

fn dot(a: PlanePoint, b: PlanePoint) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// Distance of two points of the plane.
pub(super) fn plane_distance(a: PlanePoint, b: PlanePoint) -> f64 {
    let [x, y] = sub(a, b);
    x.hypot(y)
}

impl UnfoldedFace {
    /// A face with its first corner at the origin and its second on the x axis.
    pub fn new(mesh: &Mesh, lengths: &PerEdge<f64>, face: FaceId) -> UnfoldedFace {
        UnfoldedFace::with_sides(lengths, face, mesh.face_halfedges(face))
    }

    /// The face of a half-edge, which starts at the origin and runs along the x axis; none outside the surface.
    pub fn beside(mesh: &Mesh, lengths: &PerEdge<f64>, h: HalfedgeId) -> Option<UnfoldedFace> {
        let sides = [h, mesh.next(h), mesh.prev(h)];
        mesh.face(h).map(|face| UnfoldedFace::with_sides(lengths, face, sides))
    }

    fn with_sides(lengths: &PerEdge<f64>, face: FaceId, sides: [HalfedgeId; 3]) -> UnfoldedFace {
        let [ab, bc, ca] = sides.map(|h| lengths[h.edge()]);
        let [cos, sin] = PlaneTriangle::direction_at([bc, ca, ab], 0).0;
        UnfoldedFace { face, sides, points: [[0.0, 0.0], [ab, 0.0], [ca * cos, ca * sin]] }
    }

    /// The face across side k, unfolded; its first side is the twin of side k. None across the boundary.
    pub fn across(&self, mesh: &Mesh, lengths: &PerEdge<f64>, k: usize) -> Option<UnfoldedFace> {
        let twin = self.sides[k].twin();
        let face = mesh.face(twin)?;
        let sides = [twin, mesh.next(twin), mesh.prev(twin)];
        let [near, far] = [self.points[(k + 1) % 3], self.points[k]];
        let [ab, bc, ca] = sides.map(|h| lengths[h.edge()]);
        let [cos, sin] = PlaneTriangle::direction_at([bc, ca, ab], 0).0;
        let along = sub(far, near);
        let length = along[0].hypot(along[1]);
        let [x, y] = [ca * cos / length, ca * sin / length];
        let third = [near[0] + x * along[0] - y * along[1], near[1] + x * along[1] + y * along[0]];
        Some(UnfoldedFace { face, sides, points: [near, far, third] })
    }

    /// The centre of the circumcircle; none for a face without an area.
    pub fn centre(&self) -> Option<PlanePoint> {
        let [a, b, c] = self.points;
        let [u, v] = [sub(b, a), sub(c, a)];
        let area = 2.0 * cross(u, v);
        let [uu, vv] = [dot(u, u), dot(v, v)];
        let centre = [a[0] + (uu * v[1] - vv * u[1]) / area, a[1] + (vv * u[0] - uu * v[0]) / area];
        centre.iter().all(|x| x.is_finite()).then_some(centre)
    }

    /// Barycentric coordinates of a point of the plane.
    pub fn weights(&self, at: PlanePoint) -> [f64; 3] {
        let [a, b, c] = self.points;
        let total = cross(sub(b, a), sub(c, a));
        [(b, c), (c, a), (a, b)].map(|(p, q)| cross(sub(p, at), sub(q, at)) / total)
    }

    /// True if the circumcircle contains a point of the plane.
    fn circle_contains(&self, at: PlanePoint) -> bool {
        let [a, b, c] = self.points.map(|p| sub(p, at));
        dot(a, a) * cross(b, c) + dot(b, b) * cross(c, a) + dot(c, c) * cross(a, b) > 0.0
    }

    /// The walk from the middle of this face straight to a point of its plane.
    pub fn walk_to(self, mesh: &Mesh, lengths: &PerEdge<f64>, goal: PlanePoint) -> WalkEnd {
        let [a, b, c] = self.points;
        let start = [(a[0] + b[0] + c[0]) / 3.0, (a[1] + b[1] + c[1]) / 3.0];
        let most = mesh.n_faces();
        match self.walk(mesh, lengths, [start, goal], most) {
            (end, None) => WalkEnd::Inside(end),
            (end, Some(k)) if mesh.face(end.sides[k].twin()).is_none() => {
                WalkEnd::Boundary(end.sides[k].edge())
            }
            _ => WalkEnd::Lost,
        }
    }

    /// The face at the end of the straight walk between two points of the plane, of which this face contains the first, on its boundary
    /// or inside. Where rounding leads over the boundary of the surface, that is the face at the boundary.
    pub fn walk_on(self, mesh: &Mesh, lengths: &PerEdge<f64>, way: [PlanePoint; 2]) -> UnfoldedFace {
        self.walk(mesh, lengths, way, MOST_PASSAGES * mesh.n_faces()).0
    }

    /// The last face of a straight walk over at most so many sides; where it does not contain the goal, the side that leads on.
    fn walk(
        self,
        mesh: &Mesh,
        lengths: &PerEdge<f64>,
        [start, goal]: [PlanePoint; 2],
        most: usize,
    ) -> (UnfoldedFace, Option<usize>) {
        let direction = sub(goal, start);
        let mut at = self;
        let mut entered = None;
        for passed in 0.. {
            // The way leaves a face through the side whose start lies to its right and whose end lies to its left.
            let turn = at.points.map(|p| cross(direction, sub(p, start)));
            let leaves = |&k: &usize| Some(k) != entered && turn[k] <= 0.0 && turn[(k + 1) % 3] > 0.0;
            let Some(k) = (0..3).find(leaves) else { break };
            let [p, q] = [at.points[k], at.points[(k + 1) % 3]];
            if cross(sub(q, p), sub(goal, p)) >= 0.0 {
                break;
            }
            match at.across(mesh, lengths, k).filter(|_| passed <= most) {
                Some(next) => at = next,
                None => return (at, Some(k)),
            }
            entered = Some(0);
        }
        (at, None)
    }

    /// The boundary edges whose diametral circle contains a point of this face, among those of the faces whose circumcircle contains it:
    /// those that the point would see in a Delaunay triangulation.
    pub fn encroached_by(self, mesh: &Mesh, lengths: &PerEdge<f64>, at: PlanePoint) -> Vec<EdgeId> {
        let (mut seen, mut waiting) = (vec![self.face], vec![self]);
        let mut found = Vec::new();
        while let Some(face) = waiting.pop() {
            for k in 0..3 {
                let Some(next) = face.across(mesh, lengths, k) else {
                    let [p, q] = [face.points[k], face.points[(k + 1) % 3]];
                    if dot(sub(p, at), sub(q, at)) < 0.0 {
                        found.push(face.sides[k].edge());
                    }
                    continue;
                };
                if !seen.contains(&next.face) && next.circle_contains(at) {
                    seen.push(next.face);
                    waiting.push(next);
                }
            }
        }
        found
    }
}
