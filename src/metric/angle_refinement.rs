//! Refinement of a Euclidean surface to a least angle of its triangles, without a change of its metric.
//!
//! Intrinsic Delaunay refinement \[SSC19\] §4.2: while a triangle has a smaller angle, the centre of its circumcircle becomes a vertex,
//! found by a straight walk over the surface, and edges are flipped until the triangulation is Delaunay again. A boundary edge whose
//! diametral circle would contain the new vertex is parted in its place \[Rup95\].
//!
//! ```
//! use ricci::metric::angle_refinement::{AngleRefinement, refine_to_angle};
//! use ricci::{Control, Surface, mesh::shapes};
//! let torus = Surface::from_soup(&shapes::torus(2.0, 0.1, 12, 6)?)?;
//! let finer = refine_to_angle(&torus, &AngleRefinement::default(), &Control::new())?;
//! assert!(finer.report.least_angle >= 25f64.to_radians() && finer.report.below == 0);
//! assert!((finer.surface.area()? / torus.area()? - 1.0).abs() < 1e-12);
//! assert_eq!(finer.places.len(), finer.surface.mesh().n_vertices());
//! # Ok::<(), ricci::Error>(())
//! ```

use super::isometric::{IntrinsicOptions, Triangulated, delaunay_flip, intrinsic_delaunay};
use super::lengths::face_lengths;
use super::plane_walk::{UnfoldedFace, WalkEnd, plane_distance};
use super::signposts::Signposts;
use super::surface::Surface;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::plane_triangle::PlaneTriangle;
use crate::geometry::{Space, triangle};
use crate::mesh::{EdgeId, FaceId, Flip, HalfedgeId, Mesh, PerEdge, Place, VertexId};
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::f64::consts::FRAC_PI_3;

/// Options of [`refine_to_angle`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AngleRefinement {
    /// The least angle, radians, at most 30°: above it the refinement need not end. Default 25°.
    pub least_angle: f64,
    /// The most vertices that are added; 0, the default, for ten per given face and 100,000 more.
    pub most_added: usize,
}

impl Default for AngleRefinement {
    fn default() -> Self {
        AngleRefinement { least_angle: 25f64.to_radians(), most_added: 0 }
    }
}

/// A refined metric with the way back.
#[derive(Debug, Clone)]
pub struct FinerMetric {
    /// The same metric on the finer triangulation. Its first vertices are the given ones.
    pub surface: Surface,
    /// Per vertex of that, its place on the given surface.
    pub places: Vec<Place>,
    /// The course of the refinement.
    pub report: AngleReport,
}

impl FinerMetric {
    /// The largest excess of the straight line in space between the places of two neighbours over the length of their edge, as a share of that
    /// length: 0 but for rounding, since the edge is a geodesic of the given surface. `None` where that has no positions in space.
    pub fn line_excess(&self, given: &Surface) -> Option<f64> {
        let positions = given.positions()?;
        let at = |v: VertexId| self.places[v.index()].point(given.mesh(), positions);
        let mesh = self.surface.mesh();
        let excess = |e: EdgeId| {
            let [a, b] = mesh.ends(e).map(at);
            let line = [0, 1, 2].map(|k| b[k] - a[k]);
            line[0].hypot(line[1]).hypot(line[2]) / self.surface.lengths()[e] - 1.0
        };
        Some(mesh.edges().map(excess).fold(0.0, f64::max))
    }
}

/// The course and the result of a refinement.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct AngleReport {
    /// Vertices that were added inside the surface.
    pub inside: usize,
    /// Vertices that were added on its boundary.
    pub on_boundary: usize,
    /// Edges that were flipped.
    pub flips: usize,
    /// Smallest angle of the given triangles, radians.
    pub given_angle: f64,
    /// Smallest angle of the triangles that are not [`AngleReport::forced`], radians.
    pub least_angle: f64,
    /// Triangles with a smaller angle that could be larger: 0 unless the most vertices were added.
    pub below: usize,
    /// Triangles with a smaller angle that the surface forces: their corner is at a vertex where the surface itself has an angle below
    /// 60°, or their shortest side joins the two boundary edges of such a vertex.
    pub forced: usize,
}

/// Largest least angle, radians.
const MOST_ANGLE: f64 = 30.0 * std::f64::consts::PI / 180.0;

/// Barycentric coordinate below which a point counts as one on the opposite side: a triangle between them would be thin beyond use.
const ON_SIDE: f64 = 1e-7;

/// Cosine below whose negative an angle counts as more than 90°: rounding leaves the corners of right angles near 0.
const OBTUSE: f64 = 1e-9;

/// Relative difference up to which two vertices on the boundary count as equally far from its corner.
const SAME_SHELL: f64 = 1e-9;

/// The same metric on a Delaunay triangulation without small angles, and the course of the refinement. The first vertices are the given
/// ones. Small angles are left where the surface forces them ([`AngleReport::forced`]), and where the most vertices were added.
///
/// # Errors
/// [`Error::Argument`] for an angle outside 0 … 30°, and for lengths that are not Euclidean; those of [`intrinsic_delaunay`];
/// [`Error::TooLarge`]; [`Error::Cancelled`].
pub fn refine_to_angle(
    surface: &Surface,
    options: &AngleRefinement,
    control: &Control,
) -> Result<FinerMetric> {
    if !(options.least_angle > 0.0 && options.least_angle <= MOST_ANGLE) {
        let need = "between 0 and 30°, in radians: above it the refinement need not end";
        return Err(Error::argument("least angle", options.least_angle, need));
    }
    if surface.geometry() != Space::E2 {
        let need = "e2: centres of circles are found in unfolded Euclidean triangles";
        return Err(Error::argument("geometry of the lengths", surface.geometry().name(), need));
    }
    let mesh = Mesh::clone(surface.mesh());
    let lengths = PerEdge::clone(surface.lengths());
    let mut work = Triangulated { mesh, lengths, geometry: Space::E2 };
    let mut report = AngleReport { given_angle: least_of_all(&work), ..AngleReport::default() };
    let mut flips = Vec::new();
    let mut record = |_: &Mesh, flip: Flip| flips.push(flip.edge);
    report.flips = intrinsic_delaunay(&mut work, IntrinsicOptions::default(), &mut record, control)?;
    let mut signposts = Signposts::new(surface)?;
    signposts.replay(&flips)?;
    let mut refining = Refining::new(work, signposts, options.least_angle, report);
    let most = match options.most_added {
        0 => 10 * surface.mesh().n_faces() + 100_000,
        most => most,
    };
    refining.run(most, control)?;
    let (work, places, report) = refining.finish();
    work.mesh.validate()?;
    Ok(FinerMetric { surface: Surface::intrinsic(work.mesh, work.lengths, Space::E2)?, places, report })
}

fn least_of_all(work: &Triangulated) -> f64 {
    work.mesh.faces().map(|f| smallest_angle(work, f).0).fold(f64::INFINITY, f64::min)
}

/// The smallest angle of a face, radians, and its corner.
fn smallest_angle(work: &Triangulated, f: FaceId) -> (f64, usize) {
    let at = PlaneTriangle::from_sides(face_lengths(&work.mesh, &work.lengths, f)).direction;
    let angles = at.map(|[cos, sin]| sin.atan2(cos));
    let k = (1..3).fold(0, |least, k| if angles[k] < angles[least] { k } else { least });
    (angles[k], k)
}

/// A surface that is being refined.
struct Refining {
    work: Triangulated,
    signposts: Signposts,
    bound: f64,
    /// Per given vertex, true where the angle of the surface is below 60°.
    is_narrow: Vec<bool>,
    /// Per added vertex on a boundary edge that starts at a narrow corner: the corner, and its distance.
    shells: Vec<Option<(VertexId, f64)>>,
    /// Faces with a small angle, the smallest first: the bits of the angle, and the face. An entry whose face has another angle by now is
    /// passed over.
    thin: BinaryHeap<Reverse<(u64, u32)>>,
    /// Boundary edges whose diametral circle contains the opposite corner of their face.
    encroached: Vec<EdgeId>,
    report: AngleReport,
}

impl Refining {
    fn new(work: Triangulated, signposts: Signposts, bound: f64, report: AngleReport) -> Refining {
        let n = work.mesh.n_vertices();
        let mut around = vec![0.0; n];
        for f in work.mesh.faces() {
            let angles = triangle::angles(Space::E2, face_lengths(&work.mesh, &work.lengths, f)).at;
            work.mesh.face_vertices(f).into_iter().zip(angles).for_each(|(v, a)| around[v.index()] += a);
        }
        let is_narrow = around.into_iter().map(|angle| angle < FRAC_PI_3).collect();
        let mut refining = Refining {
            work,
            signposts,
            bound,
            is_narrow,
            shells: vec![None; n],
            thin: BinaryHeap::new(),
            encroached: Vec::new(),
            report,
        };
        for f in refining.work.mesh.faces() {
            refining.look_at(f);
        }
        // The last entry comes first.
        refining.encroached.reverse();
        refining
    }

    /// Add vertices until no triangle is thin, or `most` are added.
    fn run(&mut self, most: usize, control: &Control) -> Result<()> {
        loop {
            let added = self.report.inside + self.report.on_boundary;
            if added.is_multiple_of(256) {
                control.check()?;
            }
            if u32::try_from(self.work.mesh.n_halfedges() + 12).is_err() {
                let count = self.work.mesh.n_halfedges();
                return Err(Error::TooLarge { what: "half-edges of a refined surface", count });
            }
            if added >= most {
                return Ok(());
            }
            if let Some(e) = self.encroached.pop() {
                if self.is_encroached(e) {
                    self.part(e);
                }
                continue;
            }
            let Some(Reverse((bits, face))) = self.thin.pop() else { return Ok(()) };
            let face = FaceId(face);
            if smallest_angle(&self.work, face).0.to_bits() == bits {
                self.relieve(face);
            }
        }
    }

    /// Put a face, and its boundary edges, on the lists that they belong to.
    fn look_at(&mut self, f: FaceId) {
        for h in self.work.mesh.face_halfedges(f) {
            if self.is_encroached(h.edge()) {
                self.encroached.push(h.edge());
            }
        }
        let (angle, corner) = smallest_angle(&self.work, f);
        if angle < self.bound && !self.is_forced(f, corner) {
            self.thin.push(Reverse((angle.to_bits(), f.0)));
        }
    }

    /// True for a boundary edge under an angle of more than 90° in its face.
    fn is_encroached(&self, e: EdgeId) -> bool {
        let Triangulated { mesh, lengths, .. } = &self.work;
        let inside = [e.halfedge(), e.halfedge().twin()].into_iter().find(|&h| !mesh.is_outside(h));
        let Some(h) = inside.filter(|_| mesh.is_boundary_edge(e)) else { return false };
        let [c, a, b] = [h, mesh.next(h), mesh.prev(h)].map(|h| lengths[h.edge()]);
        let [cos, _] = PlaneTriangle::direction_at([c, a, b], 0).0;
        cos < -OBTUSE
    }

    /// The narrow corner from which the vertices at the starts of two half-edges are equally far on two boundary edges.
    fn shell_of(&self, one: HalfedgeId, other: HalfedgeId) -> Option<VertexId> {
        let [one, other] = [one, other].map(|h| self.shells[self.work.mesh.origin(h).index()]);
        let ((apex, near), (also, far)) = (one?, other?);
        (apex == also && (near - far).abs() <= SAME_SHELL * near).then_some(apex)
    }

    /// True if the surface forces the smallest angle of a face, at this corner.
    fn is_forced(&self, f: FaceId, corner: usize) -> bool {
        let mesh = &self.work.mesh;
        let sides = mesh.face_halfedges(f);
        let apex = mesh.origin(sides[corner]).index();
        let is_narrow = self.is_narrow.get(apex).is_some_and(|&narrow| narrow);
        is_narrow || self.shell_of(sides[(corner + 1) % 3], sides[(corner + 2) % 3]).is_some()
    }

    /// Add the centre of the circumcircle of a thin face, or part boundary edges that are in its way.
    fn relieve(&mut self, f: FaceId) {
        let Triangulated { mesh, lengths, .. } = &self.work;
        let unfolded = UnfoldedFace::new(mesh, lengths, f);
        let Some(centre) = unfolded.centre() else { return };
        let found = match unfolded.walk_to(mesh, lengths, centre) {
            WalkEnd::Lost => return,
            WalkEnd::Boundary(e) => {
                self.part(e);
                return self.look_at(f);
            }
            WalkEnd::Inside(found) => found,
        };
        let encroached = found.encroached_by(mesh, lengths, centre);
        if encroached.is_empty() {
            return self.insert(&found, centre);
        }
        encroached.into_iter().for_each(|e| self.part(e));
        self.look_at(f);
    }

    /// Add a point of an unfolded face.
    fn insert(&mut self, found: &UnfoldedFace, at: [f64; 2]) {
        let weights = found.weights(at);
        let k = (1..3).fold(0, |least, k| if weights[k] < weights[least] { k } else { least });
        let side = found.sides[(k + 1) % 3];
        let mesh = &self.work.mesh;
        if weights[k] >= ON_SIDE || mesh.face(side.twin()) == mesh.face(side) {
            let distances = found.points.map(|p| plane_distance(p, at));
            // The unfolded face may start at another corner than the face.
            let first = mesh.face_halfedge(found.face);
            let turn = found.sides.iter().position(|&h| h == first).unwrap_or(0);
            let (_, spokes) = self.work.mesh.insert_in_face(found.face);
            let ordered = [0, 1, 2].map(|k| distances[(k + turn) % 3]);
            self.work.lengths.extend(ordered);
            self.signposts.added_in_face(&self.work, spokes);
            let around = spokes.map(EdgeId::halfedge);
            self.report.inside += 1;
            self.shells.push(None);
            return self.restore(&around.map(|h| self.work.mesh.next(h)));
        }
        if mesh.is_boundary_edge(side.edge()) {
            return self.part(side.edge());
        }
        let [p, q] = [weights[(k + 1) % 3].max(0.0), weights[(k + 2) % 3].max(0.0)];
        // Share from the start of the half-edge 2e.
        let share = if side == side.edge().halfedge() { q / (p + q) } else { p / (p + q) };
        self.report.inside += 1;
        self.part_at(side.edge(), share.clamp(ON_SIDE, 1.0 - ON_SIDE), None);
    }

    /// Part a boundary edge in the middle, or, from a narrow corner, at the power of two nearest to it: boundary edges on both sides of
    /// the corner are then parted at equal distances, and do not make each other shorter without end.
    fn part(&mut self, e: EdgeId) {
        let Triangulated { mesh, lengths, .. } = &self.work;
        let length = lengths[e];
        let narrow = mesh.ends(e).map(|v| self.is_narrow.get(v.index()).is_some_and(|&narrow| narrow));
        let (share, shell) = match narrow {
            [true, false] | [false, true] => {
                let near = (2.0 * length / 3.0).log2().floor().exp2();
                let corner = mesh.ends(e)[usize::from(narrow[1])];
                let share = near / length;
                (if narrow[0] { share } else { 1.0 - share }, Some((corner, near)))
            }
            _ => (0.5, None),
        };
        self.report.on_boundary += 1;
        self.part_at(e, share, shell);
    }

    fn part_at(&mut self, e: EdgeId, share: f64, shell: Option<(VertexId, f64)>) {
        let Triangulated { mesh, lengths, .. } = &mut self.work;
        let [near, far] = [share * lengths[e], (1.0 - share) * lengths[e]];
        // Lengths of the lines to the opposite corners, measured before the faces are cut.
        let line = |h: HalfedgeId, x: f64| {
            mesh.face(h)?;
            let [c, a, b] = [h, mesh.next(h), mesh.prev(h)].map(|h| lengths[h.edge()]);
            let [cos, sin] = PlaneTriangle::direction_at([a, b, c], 0).0;
            Some((b * cos - x).hypot(b * sin))
        };
        let lines = [line(e.halfedge(), near), line(e.halfedge().twin(), far)];
        let (v, beyond, added) = mesh.insert_on_edge(e);
        lengths[e] = near;
        lengths.extend([far]);
        lengths.extend(lines.into_iter().flatten());
        self.shells.push(shell);
        self.signposts.added_on_edge(&self.work, [e, beyond], added);
        debug_assert!(added.iter().zip(lines).all(|(edge, line)| edge.is_some() == line.is_some()));
        let mesh = &self.work.mesh;
        let around: Vec<HalfedgeId> = mesh.fan(v).into_iter().map(|h| mesh.next(h)).collect();
        debug_assert!(mesh.ends(beyond)[0] == v);
        self.restore(&around);
    }

    /// Flip edges, from these sides of faces at a new vertex on, until the triangulation is Delaunay; look at the faces that changed.
    fn restore(&mut self, sides: &[HalfedgeId]) {
        let mut changed: Vec<FaceId> = sides.iter().filter_map(|&h| self.work.mesh.face(h)).collect();
        let mut waiting: Vec<EdgeId> = sides.iter().map(|h| h.edge()).collect();
        // As in every series of flips, a bound stands against rounding.
        for _ in 0..MOST_FLIPS {
            let Some(e) = waiting.pop() else { break };
            let h = e.halfedge();
            let Triangulated { mesh, lengths, geometry } = &mut self.work;
            let Some(length) = delaunay_flip(*geometry, mesh, lengths, h) else { continue };
            waiting.extend(mesh.quadrilateral(h).map(HalfedgeId::edge));
            mesh.flip(e);
            lengths[e] = length;
            self.report.flips += 1;
            changed.extend([h, h.twin()].into_iter().filter_map(|h| mesh.face(h)));
            self.signposts.flipped(&self.work, e);
        }
        changed.sort_unstable();
        changed.dedup();
        changed.into_iter().for_each(|f| self.look_at(f));
    }

    fn finish(mut self) -> (Triangulated, Vec<Place>, AngleReport) {
        self.report.least_angle = f64::INFINITY;
        for f in self.work.mesh.faces() {
            let (angle, corner) = smallest_angle(&self.work, f);
            if angle < self.bound && self.is_forced(f, corner) {
                self.report.forced += 1;
                continue;
            }
            self.report.below += usize::from(angle < self.bound);
            self.report.least_angle = self.report.least_angle.min(angle);
        }
        if self.report.least_angle.is_infinite() {
            self.report.least_angle = least_of_all(&self.work);
        }
        (self.work, self.signposts.into_places(), self.report)
    }
}

/// Most edges that are looked at after one vertex was added: a new vertex has few neighbours, except on surfaces of few long triangles.
const MOST_FLIPS: usize = 100_000;
