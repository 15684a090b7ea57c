//! Round holes, cut into any surface.

use crate::error::{Error, Result};
use crate::geometry::vector::{Vector, add, distance, dot, lerp, norm, normalised, sub, triangle_normal};
use crate::mesh::incidence::drop_unused;
use crate::mesh::io::Soup;
use crate::mesh::{HalfedgeId, Mesh, PerVertex, Point, VertexId};

/// A hole's radius as a share of the distance from its centre to the nearest other centre or boundary vertex: below a half, so that some
/// surface is left between two holes.
const RADIUS_SHARE: f64 = 0.3;
/// Least cosine of the angle, 60°, between the normals at a hole's centre and at any vertex in the hole.
const LEAST_FACING_COSINE: f64 = 0.5;
/// Ratio of a hole's radii in successive attempts.
const SHRINK: f64 = 0.95;
/// Least radius that is tried, as a share of the largest that can be cut; the one with the largest angles is chosen.
const LEAST_RADIUS_SHARE: f64 = 0.7;

/// Cuts `count` round holes out of a surface, as far from each other and from the boundary as its vertices allow. The surface stays
/// connected and has `count` more boundary loops.
///
/// Centres are vertices where the surface is flat over two edges, each the farthest (in space) from those before it and from the
/// boundary. A hole is the piece of the surface around its centre within a ball; its rim lies on the ball's sphere, onto which the
/// nearest vertices move along edges. The radius is 0.3 of the least distance of two centres or of a centre and the boundary, less at a
/// hole around which the surface curves away, and by up to a third less where that makes better triangles. On a mesh too coarse for that,
/// a hole is the faces around a vertex, and no two holes, nor a hole and the boundary, share a vertex. Vertices and faces keep their
/// order, those cut out are dropped, and so are attributes.
///
/// # Errors
///
/// Those of [`Mesh::from_soup`] for the surface; [`Error::Argument`] if there is not enough room for the holes of either kind.
pub fn punch(soup: &Soup, count: usize) -> Result<Soup> {
    let mesh = Mesh::from_soup(soup)?;
    if count == 0 {
        return Ok(soup.clone());
    }
    let surface = PositionedMesh::new(&mesh, &soup.positions);
    if let Some(punched) = surface.round(count).or_else(|| surface.stars(count)) {
        return Ok(punched);
    }
    let need = "fewer, or more vertices: there is no room for one more hole";
    Err(Error::argument("holes", count, need))
}

/// Nearly the sine of the smallest angle: the least height over the longest side.
fn smallest_sine(soup: &Soup) -> f64 {
    let sine = |f: &[u32; 3]| {
        let p = f.map(|v| soup.positions[v as usize]);
        let longest = [0, 1, 2].map(|k| distance(p[k], p[(k + 1) % 3])).into_iter().fold(0.0, f64::max);
        norm(triangle_normal(p)) / (longest * longest)
    };
    soup.faces.iter().map(sine).fold(f64::INFINITY, f64::min)
}

/// The surface with some of its holes cut.
#[derive(Clone)]
struct PunchedState {
    region: PerVertex<HoleRegion>,
    positions: Vec<Point>,
}

impl PunchedState {
    fn new(mesh: &Mesh, positions: &[Point]) -> PunchedState {
        PunchedState {
            region: PerVertex::filled(mesh.n_vertices(), HoleRegion::Outside),
            positions: positions.to_vec(),
        }
    }
}

struct PositionedMesh<'a> {
    mesh: &'a Mesh,
    positions: &'a [Point],
    normals: PerVertex<Vector>,
}

impl<'a> PositionedMesh<'a> {
    fn new(mesh: &'a Mesh, positions: &'a [Point]) -> PositionedMesh<'a> {
        let normals = PerVertex::from_fn(mesh.n_vertices(), |v| {
            let faces = mesh.outgoing(v).filter_map(|h| mesh.face(h));
            let normal = |f| triangle_normal(mesh.face_vertices(f).map(|v| positions[v.index()]));
            normalised(faces.fold([0.0; 3], |sum, f| add(sum, normal(f))))
        });
        PositionedMesh { mesh, positions, normals }
    }

    fn at(&self, v: VertexId) -> Point {
        self.positions[v.index()]
    }

    /// The surface with round holes.
    fn round(&self, count: usize) -> Option<Soup> {
        let (centres, apart) = self.centres(count)?;
        let mut state = PunchedState::new(self.mesh, self.positions);
        for (done, &c) in centres.iter().enumerate() {
            let attempt = |radius: f64| {
                let mut next = state.clone();
                self.cut(Ball { centre: c, radius }, &mut next)?;
                let rest = self.rest(&next);
                self.is_punched(&rest, done + 1).then(|| (smallest_sine(&rest), next))
            };
            // Sine, largest radius that works, state.
            let mut best: Option<(f64, f64, PunchedState)> = None;
            let mut radius = RADIUS_SHARE * apart;
            let least = self.ring_radius(c);
            while radius
                > least.max(best.as_ref().map_or(0.0, |(_, largest, _)| LEAST_RADIUS_SHARE * largest))
            {
                if let Some((sine, next)) = attempt(radius) {
                    let largest = best.as_ref().map_or(radius, |&(_, largest, _)| largest);
                    if best.as_ref().is_none_or(|&(known, ..)| sine > known) {
                        best = Some((sine, largest, next));
                    }
                }
                radius *= SHRINK;
            }
            state = best?.2;
        }
        Some(self.rest(&state))
    }

    /// The surface without the faces around some vertices, each the farthest from those before it and from the boundary.
    fn stars(&self, count: usize) -> Option<Soup> {
        let mut state = PunchedState::new(self.mesh, self.positions);
        let mut free = self.off_boundary();
        // True for vertices on a hole's rim or on the boundary.
        let mut taken = PerVertex::from_fn(self.mesh.n_vertices(), |v| self.mesh.is_boundary_vertex(v));
        let ring = |v: VertexId| self.mesh.outgoing(v).map(|h| self.mesh.tip(h));
        for _ in 0..count {
            let open = |v: &VertexId| !taken[*v] && ring(*v).all(|w| !taken[w]);
            let c = self.mesh.vertices().filter(open).max_by(|&v, &w| free[v].total_cmp(&free[w]))?;
            state.region[c] = HoleRegion::Inside;
            taken[c] = true;
            ring(c).for_each(|v| taken[v] = true);
            self.keep_off(&mut free, self.at(c));
        }
        let rest = self.rest(&state);
        self.is_punched(&rest, count).then_some(rest)
    }

    /// True if exactly this many holes were cut and nothing else changed.
    fn is_punched(&self, rest: &Soup, holes: usize) -> bool {
        let loops = self.mesh.boundary_loops().len() + holes;
        let right = |m: Mesh| m.boundary_loops().len() == loops && m.genus() == self.mesh.genus();
        Mesh::from_soup(rest).is_ok_and(right)
    }

    /// For each vertex the distance to the boundary.
    fn off_boundary(&self) -> PerVertex<f64> {
        let mut free = PerVertex::filled(self.mesh.n_vertices(), f64::INFINITY);
        for v in self.mesh.vertices().filter(|&v| self.mesh.is_boundary_vertex(v)) {
            self.keep_off(&mut free, self.at(v));
        }
        free
    }

    /// Lowers the distances to those from one more point.
    fn keep_off(&self, free: &mut PerVertex<f64>, p: Point) {
        for v in self.mesh.vertices() {
            free[v] = free[v].min(distance(self.at(v), p));
        }
    }

    /// Centres by farthest-point sampling, and the least distance among them and to the boundary.
    fn centres(&self, count: usize) -> Option<(Vec<VertexId>, f64)> {
        let mut free = self.off_boundary();
        let flat: Vec<VertexId> = self.mesh.vertices().filter(|&v| self.is_flat(v)).collect();
        let farthest =
            |free: &PerVertex<f64>| flat.iter().copied().max_by(|&v, &w| free[v].total_cmp(&free[w]));
        let mut centres: Vec<VertexId> = Vec::with_capacity(count.min(self.mesh.n_vertices()));
        let mut apart = f64::INFINITY;
        for _ in 0..count {
            let v = farthest(&free)?;
            apart = apart.min(free[v]);
            if apart <= 0.0 {
                return None;
            }
            centres.push(v);
            self.keep_off(&mut free, self.at(v));
        }
        // A single hole in a closed surface: its only bound is the far side.
        let far =
            || self.mesh.vertices().map(|v| distance(self.at(v), self.at(centres[0]))).fold(0.0, f64::max);
        let apart = if apart.is_finite() { apart } else { far() };
        Some((centres, apart))
    }

    /// True if the surface within two edges of a vertex faces the same way as there.
    fn is_flat(&self, v: VertexId) -> bool {
        let along = |w: VertexId| self.mesh.outgoing(w).map(|h| self.mesh.tip(h));
        along(v).flat_map(along).all(|w| dot(self.normals[w], self.normals[v]) >= LEAST_FACING_COSINE)
    }

    /// The longest edge at a vertex.
    fn ring_radius(&self, v: VertexId) -> f64 {
        self.mesh.outgoing(v).map(|h| distance(self.at(v), self.at(self.mesh.tip(h)))).fold(0.0, f64::max)
    }

    /// Cuts a ball out; `None` where the piece of the surface in it does not face the centre's way, or meets another hole.
    fn cut(&self, ball: Ball, state: &mut PunchedState) -> Option<()> {
        let inside = self.inside(ball, &mut state.region)?;
        self.snap(ball, &inside, state)
    }

    /// The surface without the faces that were cut out.
    fn rest(&self, state: &PunchedState) -> Soup {
        let PunchedState { region, positions } = state;
        let gone = |f: &[VertexId; 3]| {
            f.iter().any(|&v| region[v] == HoleRegion::Inside)
                || f.iter().all(|&v| region[v] == HoleRegion::Rim)
        };
        let left = self.mesh.faces().map(|f| self.mesh.face_vertices(f)).filter(|f| !gone(f));
        let mut faces: Vec<[u32; 3]> = left.map(|f| f.map(|v| v.0)).collect();
        let used = drop_unused(positions.len(), &mut faces);
        Soup::new(used.into_iter().map(|v| positions[v as usize]).collect(), faces)
    }

    /// The vertices within the ball, searched from its centre along edges.
    fn inside(&self, ball: Ball, region: &mut PerVertex<HoleRegion>) -> Option<Vec<VertexId>> {
        let Ball { centre: c, radius } = ball;
        let mut inside = vec![c];
        if region[c] != HoleRegion::Outside {
            return None;
        }
        region[c] = HoleRegion::Inside;
        let mut next = 0;
        while next < inside.len() {
            let v = inside[next];
            if self.mesh.is_boundary_vertex(v) || dot(self.normals[v], self.normals[c]) < LEAST_FACING_COSINE
            {
                return None;
            }
            for tip in self.mesh.outgoing(v).map(|h| self.mesh.tip(h)) {
                if distance(self.at(tip), self.at(c)) < radius {
                    match region[tip] {
                        HoleRegion::Outside => {
                            region[tip] = HoleRegion::Inside;
                            inside.push(tip);
                        }
                        HoleRegion::Inside => {}
                        HoleRegion::Rim => return None,
                    }
                }
            }
            next += 1;
        }
        Some(inside)
    }

    /// Moves the vertices nearest to the rim onto it, each along the edge on which it is nearest.
    fn snap(&self, ball: Ball, inside: &[VertexId], state: &mut PunchedState) -> Option<()> {
        let Ball { centre: c, radius } = ball;
        let PunchedState { region, positions } = state;
        // Distance moved, vertex, new position.
        let mut moves: Vec<(f64, VertexId, Point)> = Vec::new();
        let leaving = |h: &HalfedgeId| region[self.mesh.tip(*h)] != HoleRegion::Inside;
        for h in inside.iter().flat_map(|&v| self.mesh.outgoing(v)).filter(leaving) {
            let (a, b) = (self.mesh.origin(h), self.mesh.tip(h));
            if region[b] == HoleRegion::Rim || self.mesh.is_boundary_vertex(b) {
                return None;
            }
            let t = leave(self.at(a), self.at(b), self.at(c), radius);
            let p = lerp(self.at(a), self.at(b), t);
            let v = if t < 0.5 { a } else { b };
            moves.push((distance(p, self.at(v)), v, p));
        }
        moves.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
        for (_, v, p) in moves {
            if region[v] != HoleRegion::Rim {
                region[v] = HoleRegion::Rim;
                positions[v.index()] = p;
            }
        }
        (region[c] == HoleRegion::Inside).then_some(())
    }
}

/// The ball with which a hole is cut out.
#[derive(Clone, Copy)]
struct Ball {
    centre: VertexId,
    radius: f64,
}

/// The position of a vertex with respect to the holes.
#[derive(Debug, Clone, Copy, PartialEq)]
enum HoleRegion {
    Outside,
    Inside,
    Rim,
}

/// The point where the segment from `a`, inside the ball about `c`, to `b`, outside, leaves the ball, as a share in [0, 1].
fn leave(a: Point, b: Point, c: Point, radius: f64) -> f64 {
    let (d, e) = (sub(b, a), sub(a, c));
    let (square, half, rest) = (dot(d, d), dot(d, e), dot(e, e) - radius * radius);
    // square t² + 2 half t + rest = 0 with rest ≤ 0: the root that is not negative.
    let root = (half * half - square * rest).max(0.0).sqrt();
    let t = if half > 0.0 { -rest / (half + root) } else { (root - half) / square };
    t.clamp(0.0, 1.0)
}
