//! Hyperelliptic surfaces, double covers of the sphere over given branch points.

use super::check_count;
use super::intrinsic::IntrinsicSurface;
use super::sphere::icosphere;
use crate::error::{Error, Result};
use crate::geometry::vector::{Vector, add, cross, distance, dot, norm, normalised, scale, sub};
use crate::geometry::{Space, hyperelliptic};
use crate::mesh::io::Soup;
use crate::mesh::{HalfedgeId, Mesh, PerEdge, PerHalfedge, PerVertex, VertexId};
use num_complex::Complex64;

/// Rounds of smoothing after vertices have been moved to the branch points. Each spreads the dent of a move to one more ring of vertices.
const SMOOTHING_ROUNDS: usize = 10;

/// The Riemann surface of `y² = Π (x − e_j)` as the double cover of the round sphere, branched over the points `e_j` and,
/// if their number is odd, over ∞: genus g for 2g + 1 or 2g + 2 points, g ≥ 1. Its period matrix is known:
/// [`crate::geometry::hyperelliptic::period_matrix`].
///
/// The plane is moved and scaled so that the points' mean is 0 and their mean square 1, then mapped to the unit sphere by stereographic
/// projection from the south pole, which keeps the orientation as seen from outside. The sphere is an icosphere of frequency `n` whose
/// nearest vertices are moved to the points and whose other ones are smoothed: 20 n² faces below, 40 n² above. Triangles are spherical,
/// edge lengths arcs of great circles; a branch point has the angle 4π, curvature −2π, every other vertex curvature 0.
///
/// Vertex j lies over e_j, then comes the one over ∞ if there is one, then the pairs over the other vertices.
///
/// # Errors
///
/// [`Error::Argument`] for fewer than three points, points that are not finite, and points so close to each other on the sphere that
/// their nearest vertices are the same or neighbours (raise n).
pub fn hyperelliptic(branch_points: &[Complex64], n: usize) -> Result<IntrinsicSurface> {
    hyperelliptic_graded(branch_points, n, 1.0)
}

/// [`hyperelliptic()`] with edges that shorten towards the branch points: around each, up to half of the distance R from the nearest
/// other one, a vertex at distance r is moved to `R (r/R)^grading`. The length of edges at distance r is then about `r^(1 − 1/grading)`
/// times that elsewhere. Holomorphic forms grow like `r^(−1/2)` there, so that linear elements have rate 1 for grading 1; rate 2 up to a
/// logarithm for grading 2, which makes triangles even in the chart √(x − e); and rate 2 beyond.
///
/// # Errors
///
/// Those of [`hyperelliptic()`]; [`Error::Argument`] for a grading outside 1 … 4, and one that turns a triangle over (raise n).
pub fn hyperelliptic_graded(branch_points: &[Complex64], n: usize, grading: f64) -> Result<IntrinsicSurface> {
    check_count("branch points", branch_points.len(), 3, 20.0 * (n as f64).powi(2))?;
    check_count("frequency", n, 1, 20.0 * (n as f64).powi(2))?;
    if !(1.0..=4.0).contains(&grading) {
        return Err(Error::argument("grading", grading, "from 1 to 4"));
    }
    let points = on_the_sphere(branch_points)?;
    let (mut sphere, branch) = sphere(&points, n)?;
    if grading > 1.0 {
        grade(&mut sphere, &points, grading)?;
    }
    let mesh = Mesh::from_soup(&sphere)?;
    let is_branch = PerVertex::from_fn(mesh.n_vertices(), |v: VertexId| branch.contains(&v.0));
    let cover = BranchedCover { crossing: crossings(&mesh, &is_branch), mesh: &mesh, branch: &branch };
    let lengths = PerEdge::from_fn(mesh.n_edges(), |e| {
        let [p, q] = mesh.ends(e).map(|v| sphere.positions[v.index()]);
        arc(p, q)
    });
    Ok(cover.surface(&lengths))
}

/// Length of the arc of a great circle between two points of the unit sphere.
fn arc(p: Vector, q: Vector) -> f64 {
    norm(cross(p, q)).atan2(dot(p, q))
}

/// Moves the vertices of the sphere towards the branch points.
fn grade(sphere: &mut Soup, points: &[Vector], grading: f64) -> Result<()> {
    let others = |j: usize| (0..points.len()).filter(move |&k| k != j);
    let reach = |j: usize| others(j).map(|k| 0.5 * arc(points[j], points[k])).fold(f64::INFINITY, f64::min);
    let reaches: Vec<f64> = (0..points.len()).map(reach).collect();
    for q in &mut sphere.positions {
        let near = |&j: &usize| (1e-12..reaches[j]).contains(&arc(points[j], *q));
        if let Some(j) = (0..points.len()).find(near) {
            let (p, r) = (points[j], reaches[j]);
            let across = normalised(sub(*q, scale(dot(*q, p), p)));
            let (sin, cos) = (r * (arc(p, *q) / r).powf(grading)).sin_cos();
            *q = normalised(add(scale(cos, p), scale(sin, across)));
        }
    }
    let turned = |face: &[u32; 3]| {
        let [a, b, c] = face.map(|v| sphere.positions[v as usize]);
        dot(cross(sub(b, a), sub(c, a)), a) <= 0.0
    };
    match sphere.faces.iter().position(turned) {
        Some(f) => {
            let need = "less, or a larger frequency: a triangle of the sphere turns over";
            Err(Error::argument("grading", format!("{grading} (face {f})"), need))
        }
        None => Ok(()),
    }
}

/// Stereographic projection of the normalised points from the south pole, which keeps the orientation as seen from outside; with that
/// pole itself if the number of points is odd.
fn on_the_sphere(branch_points: &[Complex64]) -> Result<Vec<Vector>> {
    let place = |z: &Complex64| {
        let r = z.norm_sqr();
        [2.0 * z.re / (1.0 + r), 2.0 * z.im / (1.0 + r), (1.0 - r) / (1.0 + r)]
    };
    let mut points: Vec<Vector> = hyperelliptic::normalised(branch_points)?.iter().map(place).collect();
    if points.len() % 2 == 1 {
        points.push([0.0, 0.0, -1.0]);
    }
    Ok(points)
}

/// The sphere with a vertex at each point, and these vertices.
fn sphere(points: &[Vector], n: usize) -> Result<(Soup, Vec<u32>)> {
    let mut soup = icosphere(n)?;
    let mesh = Mesh::from_faces(soup.positions.len(), &soup.faces)?;
    let mut branch: Vec<u32> = Vec::with_capacity(points.len());
    for (j, &p) in points.iter().enumerate() {
        let nearer = |v: &VertexId, w: &VertexId| {
            distance(soup.positions[v.index()], p).total_cmp(&distance(soup.positions[w.index()], p))
        };
        let Some(v) = mesh.vertices().min_by(nearer) else { break };
        let taken = |w: u32| branch.contains(&w);
        if taken(v.0) || mesh.outgoing(v).any(|h| taken(mesh.tip(h).0)) {
            let need = "larger: vertices next to each other would sit on two branch points";
            return Err(Error::argument("frequency", n, need));
        }
        branch.push(v.0);
        soup.positions[v.index()] = points[j];
    }
    for _ in 0..SMOOTHING_ROUNDS {
        let old = soup.positions.clone();
        for v in mesh.vertices().filter(|v| !branch.contains(&v.0)) {
            let sum = mesh.outgoing(v).fold([0.0; 3], |sum, h| add(sum, old[mesh.tip(h).index()]));
            soup.positions[v.index()] = normalised(sum);
        }
    }
    Ok((soup, branch))
}

/// Edges across which the sheets change: a set of edges with an odd number at each branch point and an even one elsewhere. It consists of
/// the edges of a spanning tree that split the branch points into two odd sets.
fn crossings(mesh: &Mesh, is_branch: &PerVertex<bool>) -> PerEdge<bool> {
    let mut crossing = PerEdge::filled(mesh.n_edges(), false);
    let mut reached_by = PerVertex::filled(mesh.n_vertices(), None);
    let root = VertexId(0);
    let mut order = vec![root];
    let mut next = 0;
    while next < order.len() {
        for h in mesh.outgoing(order[next]) {
            let tip = mesh.tip(h);
            if tip != root && reached_by[tip].is_none() {
                reached_by[tip] = Some(h);
                order.push(tip);
            }
        }
        next += 1;
    }
    let mut odd = is_branch.clone();
    for v in order.into_iter().rev() {
        if let Some(h) = reached_by[v].filter(|_| odd[v]) {
            crossing[h.edge()] = true;
            odd[mesh.origin(h)] ^= true;
        }
    }
    crossing
}

/// Two copies of a closed surface, glued crosswise along edges.
struct BranchedCover<'a> {
    mesh: &'a Mesh,
    branch: &'a [u32],
    crossing: PerEdge<bool>,
}

impl BranchedCover<'_> {
    /// The surface. Face 2f + s is face f on sheet s; edge 2e + s is the one whose left face (along half-edge 2e) is on sheet s.
    fn surface(&self, lengths: &PerEdge<f64>) -> IntrinsicSurface {
        let mesh = self.mesh;
        let (lifted, n_vertices) = self.corners();
        let mut surface = IntrinsicSurface {
            n_vertices,
            faces: Vec::with_capacity(2 * mesh.n_faces()),
            face_edges: Vec::with_capacity(2 * mesh.n_faces()),
            lengths: lengths.iter().flat_map(|&l| [l, l]).collect(),
            geometry: Space::S2,
        };
        for f in mesh.faces() {
            let [ab, bc, ca] = mesh.face_halfedges(f);
            for sheet in [0, 1] {
                let side = |h: HalfedgeId| {
                    let forward = h == h.edge().halfedge();
                    let left = sheet ^ u32::from(!forward && self.crossing[h.edge()]);
                    let number = (2 * h.edge().0 + left + 1) as i32;
                    if forward { number } else { -number }
                };
                surface.faces.push([ab, bc, ca].map(|h| lifted[h][sheet as usize]));
                surface.face_edges.push([bc, ca, ab].map(side));
            }
        }
        surface
    }

    /// The vertex above each corner (given by the half-edge that leaves it) on each sheet, and the number of vertices.
    fn corners(&self) -> (PerHalfedge<[u32; 2]>, usize) {
        let mesh = self.mesh;
        let mut lifted = PerHalfedge::filled(mesh.n_halfedges(), [0; 2]);
        let mut count = self.branch.len() as u32;
        for v in mesh.vertices() {
            let above = match self.branch.iter().position(|&b| b == v.0) {
                Some(j) => [j as u32; 2],
                None => {
                    count += 2;
                    [count - 2, count - 1]
                }
            };
            // Once around, counterclockwise; `sheet` belongs to the corner that continues sheet 0 of the first corner.
            let (start, mut sheet) = (mesh.out(v), 0);
            let mut h = start;
            loop {
                lifted[h] = [above[sheet], above[1 - sheet]];
                let across = mesh.prev(h);
                sheet ^= usize::from(self.crossing[across.edge()]);
                h = across.twin();
                if h == start {
                    break;
                }
            }
        }
        (lifted, count as usize)
    }
}
