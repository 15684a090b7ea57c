//! Surfaces with vertices added on their edges and inside their faces.
//!
//! ```
//! use ricci::{Surface, mesh::shapes, metric::Split};
//! let disk = Surface::from_soup(&shapes::disk(1)?)?;
//! let mut split = Split::new(&disk);
//! split.halve(disk.mesh().boundary_loops()[0][0].edge())?;
//! let finer = split.surface()?;
//! assert_eq!(finer.mesh().n_vertices(), disk.mesh().n_vertices() + 1);
//! assert!((finer.area()? / disk.area()? - 1.0).abs() < 1e-15);
//! # Ok::<(), ricci::Error>(())
//! ```

use super::common_subdivision::CORNERS;
use super::surface::Surface;
use crate::archive::stored;
use crate::error::{Error, Result, check_size};
use crate::geometry::flip::diagonal;
use crate::geometry::triangle::{self, sine};
use crate::geometry::vector::{cross, dot};
use crate::mesh::{EdgeId, FaceId, HalfedgeId, Mesh, PerEdge, Point, VertexId};

/// A surface some of whose edges have been halved, the faces beside them with them: the same metric on a finer triangulation.
///
/// The first vertices, edges and faces are the given ones, or one of their halves.
#[derive(Debug, Clone)]
pub struct Split {
    given: Surface,
    /// Per half-edge.
    origin: Vec<u32>,
    face: Vec<Option<u32>>,
    sides: Vec<[u32; 3]>,
    lengths: Vec<f64>,
    positions: Option<Vec<Point>>,
    n_vertices: usize,
    /// Per edge the next part of the same given edge, at the tip of its half-edge 2e.
    ahead: Vec<Option<u32>>,
    /// The ends of the edge that each added vertex has parted, with their weights.
    added: Vec<[(u32, f64); 2]>,
    /// Per face: the given face that it is a part of, and the weights of its corners there.
    parent: Vec<FaceId>,
    corners: Vec<[[f64; 3]; 3]>,
}
stored!(sections Split { given, origin, face, sides, lengths, positions, n_vertices, ahead, added, parent,
    corners });

/// Largest amount by which weights may be negative, or their sum may differ from 1.
const WEIGHTS: f64 = 1e-9;
/// Weight up to which a point counts as one on the opposite side, and at a corner.
const AT_CORNER: f64 = 1e-12;

/// Weights of a point as those of corners that are given by their own weights.
fn weights_in(corners: [[f64; 3]; 3], point: [f64; 3]) -> [f64; 3] {
    let [a, b, c] = corners;
    let total = dot(a, cross(b, c));
    [dot(point, cross(b, c)), dot(point, cross(c, a)), dot(point, cross(a, b))].map(|x| x / total)
}

impl Split {
    /// The surface with nothing halved yet.
    pub fn new(given: &Surface) -> Split {
        let mesh = given.mesh();
        Split {
            origin: mesh.halfedges().map(|h| mesh.origin(h).0).collect(),
            face: mesh.halfedges().map(|h| mesh.face(h).map(|f| f.0)).collect(),
            sides: mesh.faces().map(|f| mesh.face_halfedges(f).map(|h| h.0)).collect(),
            lengths: given.lengths().iter().copied().collect(),
            positions: given.positions().map(|positions| positions.to_vec()),
            n_vertices: mesh.n_vertices(),
            ahead: vec![None; mesh.n_edges()],
            added: Vec::new(),
            parent: mesh.faces().collect(),
            corners: vec![CORNERS; mesh.n_faces()],
            given: given.clone(),
        }
    }

    /// The surface as it was given.
    pub fn given(&self) -> &Surface {
        &self.given
    }

    /// The number of vertices that were added.
    pub fn n_added(&self) -> usize {
        self.n_vertices - self.given.mesh().n_vertices()
    }

    /// The given face that a face is a part of, and the weights of its corners there: barycentric coordinates if that is plane.
    pub fn place(&self, f: FaceId) -> (FaceId, [[f64; 3]; 3]) {
        (self.parent[f.index()], self.corners[f.index()])
    }

    /// Weights of points in a face ([`Split::place`]) as weights in the given face that it is a part of.
    pub fn carried<const M: usize>(&self, f: FaceId, weights: [[f64; 3]; M]) -> (FaceId, [[f64; 3]; M]) {
        let (face, corners) = self.place(f);
        (face, weights.map(|w| [0, 1, 2].map(|k| (0..3).map(|c| w[c] * corners[c][k]).sum())))
    }

    /// The parts of a given half-edge, from its origin to its tip.
    ///
    /// # Errors
    /// [`Error::Argument`] for a half-edge that the given mesh has not.
    pub fn path(&self, h: HalfedgeId) -> Result<Vec<HalfedgeId>> {
        if h.index() >= self.given.mesh().n_halfedges() {
            return Err(Error::argument("half-edge", h, "one of the given mesh"));
        }
        let parts = std::iter::successors(Some(h.edge().0), |&e| self.ahead[e as usize]);
        let mut path: Vec<HalfedgeId> = parts.map(|e| EdgeId(e).halfedge()).collect();
        if h != h.edge().halfedge() {
            path.reverse();
            path.iter_mut().for_each(|h| *h = h.twin());
        }
        Ok(path)
    }

    /// Values at the given vertices (V entries), on the finer triangulation: linear along the edges that were parted.
    ///
    /// # Errors
    /// [`Error::Size`].
    pub fn from_given_vertices<const N: usize>(&self, values: &[[f64; N]]) -> Result<Vec<[f64; N]>> {
        check_size("values", values.len(), self.given.mesh().n_vertices())?;
        let mut all = values.to_vec();
        for &[(a, p), (b, q)] in &self.added {
            let [a, b] = [a, b].map(|v| all[v as usize]);
            all.push(std::array::from_fn(|k| p * a[k] + q * b[k]));
        }
        Ok(all)
    }

    /// Values at the corners of the given faces (F entries), at those of the finer triangulation: linear in each given face.
    ///
    /// # Errors
    /// [`Error::Size`].
    pub fn from_given_corners<const N: usize>(&self, values: &[[[f64; N]; 3]]) -> Result<Vec<[[f64; N]; 3]>> {
        check_size("corner values", values.len(), self.given.mesh().n_faces())?;
        let at = |f: usize| {
            let corners = values[self.parent[f].index()];
            self.corners[f].map(|w| std::array::from_fn(|k| (0..3).map(|c| w[c] * corners[c][k]).sum()))
        };
        Ok((0..self.parent.len()).map(at).collect())
    }

    /// Halve an edge: [`Split::part`] at its midpoint.
    ///
    /// # Errors
    /// Those of [`Split::part`].
    pub fn halve(&mut self, e: EdgeId) -> Result<EdgeId> {
        self.part(e, 0.5)
    }

    /// Part an edge at this share of its length from the origin of its half-edge 2e, and each face beside it by the line from there to the
    /// opposite corner. The edge keeps its number at that origin; the new vertex and the other part, which is returned, get the next ones.
    ///
    /// # Errors
    /// [`Error::Argument`] for an edge that does not exist, and for a share outside (0, 1); [`Error::TooLarge`].
    pub fn part(&mut self, e: EdgeId, share: f64) -> Result<EdgeId> {
        let n_edges = self.lengths.len();
        if e.index() >= n_edges {
            return Err(Error::argument("edge to part", e, "an existing edge"));
        }
        if !(share > 0.0 && share < 1.0) {
            return Err(Error::argument("share of an edge", share, "between 0 and 1"));
        }
        if u32::try_from(2 * n_edges + 6).is_err() {
            return Err(Error::TooLarge { what: "half-edges of a split surface", count: 2 * n_edges + 6 });
        }
        let there = e.halfedge().index();
        let (from, middle, to) = (self.origin[there], self.n_vertices as u32, self.origin[there ^ 1]);
        let length = self.lengths[e.index()];
        let (near, far) = (share * length, (1.0 - share) * length);
        // The point as a combination of the ends, which are vectors in H² and S².
        let weights = [far, near].map(|x| sine(self.given.geometry(), x));
        let weights = weights.map(|w| w / (weights[0] + weights[1]));
        self.n_vertices += 1;
        self.added.push([(from, weights[0]), (to, weights[1])]);
        if let Some(positions) = &mut self.positions {
            let [a, b] = [from, to].map(|v| positions[v as usize]);
            positions.push([0, 1, 2].map(|k| weights[0] * a[k] + weights[1] * b[k]));
        }
        // The faces are measured before the edge is shortened.
        let lines = [(there, near), (there ^ 1, far)].map(|(h, x)| self.line(h, x));
        let other = self.add_edge(middle, to, far);
        self.lengths[e.index()] = near;
        self.ahead[other] = self.ahead[e.index()].replace(other as u32);
        self.origin[there ^ 1] = middle;
        for (k, line) in lines.into_iter().enumerate() {
            if let Some(length) = line {
                // The part at the origin of the half-edge 2e lies along `there`; of its twin, along the new edge.
                let [first, second] = [[there, 2 * other], [2 * other + 1, there ^ 1]][k];
                let weights = if k == 0 { weights } else { [weights[1], weights[0]] };
                self.cut_face(there ^ k, [first, second], weights, length);
            }
        }
        Ok(EdgeId::from(other))
    }

    /// Add a point of a given face, with barycentric weights: on the line from a corner of the part that it lies in to the side across, at
    /// shares of lengths. The vertex there; none is added where there is one.
    ///
    /// # Errors
    /// [`Error::Argument`] for a face that does not exist, and for weights that are negative or not finite or have not the sum 1; those of
    /// [`Split::part`].
    pub fn insert(&mut self, face: FaceId, weights: [f64; 3]) -> Result<VertexId> {
        if face.index() >= self.given.mesh().n_faces() {
            return Err(Error::argument("face of a point", face, "an existing face"));
        }
        let sum: f64 = weights.iter().sum();
        if !((sum - 1.0).abs() < WEIGHTS && weights.iter().all(|w| *w > -WEIGHTS)) {
            return Err(Error::argument(
                "weights of a point",
                format!("{weights:?}"),
                "three that are not negative, with the sum 1",
            ));
        }
        let parts = (0..self.sides.len()).filter(|&f| self.parent[f] == face);
        let local = parts.map(|f| (f, weights_in(self.corners[f], weights)));
        let least = |w: &[f64; 3]| w.iter().copied().fold(f64::INFINITY, f64::min);
        let Some((f, w)) = local.max_by(|a, b| least(&a.1).total_cmp(&least(&b.1))) else {
            return Err(Error::argument("face of a point", face, "an existing face"));
        };
        // The line starts at the corner with the largest weight, from which its direction is determined best.
        let first = (0..3).fold(0, |best, k| if w[k] > w[best] { k } else { best });
        let [p, q, r] = [0, 1, 2].map(|k| w[(first + k) % 3].max(0.0));
        let sides = [0, 1, 2].map(|k| self.sides[f][(first + k) % 3] as usize);
        let corner = VertexId(self.origin[sides[0]]);
        match (q > AT_CORNER, r > AT_CORNER) {
            (false, false) => Ok(corner),
            (true, false) => self.part_from(sides[0], q / (p + q)).map(|_| self.last()),
            (false, true) => self.part_from(sides[2], p / (p + r)).map(|_| self.last()),
            (true, true) => {
                let line = self.part_from(sides[1], r / (q + r))?;
                // The line runs from the side to the corner.
                self.part(line, p)?;
                Ok(self.last())
            }
        }
    }

    /// The vertex that was added last.
    fn last(&self) -> VertexId {
        VertexId::from(self.n_vertices - 1)
    }

    /// Part an edge at this share of its length from the origin of a half-edge of a face; the edge that cuts this face, from the point to
    /// the corner.
    fn part_from(&mut self, h: usize, share: f64) -> Result<EdgeId> {
        let is_first = h & 1 == 0 || self.face[h ^ 1].is_none();
        let other = self.part(EdgeId::from(h / 2), if h & 1 == 0 { share } else { 1.0 - share })?;
        Ok(EdgeId::from(other.index() + if is_first { 1 } else { 2 }))
    }

    /// The face of a half-edge and its corner there.
    fn corner(&self, h: usize) -> Option<(usize, usize)> {
        let f = self.face[h]? as usize;
        self.sides[f].iter().position(|&side| side as usize == h).map(|k| (f, k))
    }

    /// Length of the line from the point at distance `x` along a half-edge to the opposite corner of its face.
    fn line(&self, h: usize, x: f64) -> Option<f64> {
        let (f, k) = self.corner(h)?;
        let space = self.given.geometry();
        // Opposite the corners: of the half-edge's origin, its tip, the third one.
        let [a, b, c] = [1, 2, 0].map(|turn| self.lengths[self.sides[f][(k + turn) % 3] as usize >> 1]);
        let angle = triangle::angles(space, [a, b, c]).at[0];
        Some(diagonal(space, b, x, angle))
    }

    fn add_edge(&mut self, from: u32, to: u32, length: f64) -> usize {
        self.origin.extend([from, to]);
        self.face.extend([None, None]);
        self.ahead.push(None);
        self.lengths.push(length);
        self.lengths.len() - 1
    }

    /// Cut the face of half-edge `h`, whose two parts are `parts` in its direction at the point with these weights of its ends, by a line
    /// of this length.
    fn cut_face(&mut self, h: usize, parts: [usize; 2], [p, q]: [f64; 2], length: f64) {
        let Some((f, k)) = self.corner(h) else { return };
        let [next, prev] = [1, 2].map(|turn| self.sides[f][(k + turn) % 3]);
        let [middle, opposite] = [self.origin[parts[1]], self.origin[prev as usize]];
        let line = 2 * self.add_edge(middle, opposite, length) as u32;
        let [a, b, c] = [0, 1, 2].map(|turn| self.corners[f][(k + turn) % 3]);
        let m = [0, 1, 2].map(|i| p * a[i] + q * b[i]);
        self.sides[f] = [parts[0] as u32, line, prev];
        self.corners[f] = [a, m, c];
        let new = self.sides.len();
        self.sides.push([parts[1] as u32, next, line ^ 1]);
        self.corners.push([m, b, c]);
        self.parent.push(self.parent[f]);
        for f in [f, new] {
            self.sides[f].into_iter().for_each(|side| self.face[side as usize] = Some(f as u32));
        }
    }

    /// The surface on the finer triangulation; the given one, arrays and all, where nothing was halved.
    ///
    /// # Errors
    /// Those of [`Surface::intrinsic`].
    pub fn surface(&self) -> Result<Surface> {
        if self.n_added() == 0 {
            return Ok(self.given.clone());
        }
        let mesh = Mesh::assemble(self.n_vertices, self.origin.clone(), &self.sides)?;
        let lengths = PerEdge::from(self.lengths.clone());
        let surface = Surface::intrinsic(mesh, lengths, self.given.geometry())?;
        match &self.positions {
            Some(positions) => surface.with_positions(positions.clone()),
            None => Ok(surface),
        }
    }

    /// Halve the longest edge of a loop, given by the boundary half-edges of its present edges, until it has this many.
    ///
    /// # Errors
    /// Those of [`Split::halve`].
    pub fn refine_loop(&mut self, rim: &[HalfedgeId], n: usize) -> Result<()> {
        let mut edges: Vec<EdgeId> = rim.iter().map(|h| h.edge()).collect();
        while edges.len() < n {
            let Some(&longest) =
                edges.iter().max_by(|a, b| self.lengths[a.index()].total_cmp(&self.lengths[b.index()]))
            else {
                break;
            };
            edges.push(self.halve(longest)?);
        }
        Ok(())
    }
}
