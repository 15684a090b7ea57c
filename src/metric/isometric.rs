//! The intrinsic Delaunay triangulation of a surface, by isometric flips.
//!
//! The surface stays as it is: an edge is replaced by the geodesic across its two triangles. The triangulation may be weighted by
//! circles around the vertices; it depends on the surface and the circles alone, up to ties.
//!
//! ```
//! use ricci::metric::isometric::{IntrinsicOptions, Triangulated, intrinsic_delaunay};
//! use ricci::{Control, geometry::Space, mesh::{Mesh, PerEdge}};
//!
//! // A rhombus with its long diagonal, from vertex 0 to vertex 2.
//! let mesh = Mesh::from_faces(4, &[[0, 1, 2], [0, 2, 3]])?;
//! let is_diagonal = |e| mesh.ends(e).iter().all(|v| v.0 % 2 == 0);
//! let lengths = PerEdge::from_fn(mesh.n_edges(), |e| if is_diagonal(e) { 1.6 } else { 1.0 });
//! let mut rhombus = Triangulated { mesh, lengths, geometry: Space::E2 };
//! let flips = intrinsic_delaunay(&mut rhombus, IntrinsicOptions::default(), &mut |_, _| {}, &Control::new())?;
//! assert!(flips == 1 && rhombus.lengths.iter().any(|l| (l - 1.2).abs() < 1e-15));
//! # Ok::<(), ricci::Error>(())
//! ```

use super::flip_queue::{FlipQueue, Flippable, allowance, between_faces, endless};
use super::lengths::face_lengths;
use crate::control::Control;
use crate::error::{Result, check_size};
use crate::geometry::flip::{Hinge, TOLERANCE, circle_product, circle_square, diagonal};
use crate::geometry::{Space, triangle};
use crate::mesh::{FixedEdges, Flip, FlipLog, HalfedgeId, Mesh, PerEdge, PerVertex};
use crate::topology::check_lengths;
use std::f64::consts::PI;

/// A triangulated surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Triangulated {
    /// Its connectivity.
    pub mesh: Mesh,
    /// Lengths of its edges (E entries).
    pub lengths: PerEdge<f64>,
    /// The geometry of its triangles.
    pub geometry: Space,
}

/// Options of [`intrinsic_delaunay`]; by default it makes the Delaunay triangulation without circles.
#[derive(Debug, Clone, Copy)]
pub struct IntrinsicOptions<'a> {
    /// Radii of circles around the vertices (V entries, 0 for none), for a triangulation that is weighted by them.
    pub circles: Option<&'a PerVertex<f64>>,
    /// Edges that stay.
    pub fixed: &'a FixedEdges,
}

static NO_EDGES: FixedEdges = FixedEdges::none();

impl Default for IntrinsicOptions<'_> {
    fn default() -> Self {
        IntrinsicOptions { circles: None, fixed: &NO_EDGES }
    }
}

/// Least |sum of the cosines of two angles| whose sign decides whether the angles add up to less than π (positive) or more (negative).
/// It is far above the rounding of the cosines, a few 1e-16. Nearer to 0 one angle may be near π and the other near 0, where cosines do
/// not tell a sum from π.
const DECISIVE: f64 = 1e-3;

/// Share by which the sum of all cotangents must have fallen for a series of flips to count as progress. The sum has about 16 digits,
/// of which the rounded lengths of thin triangles leave fewer.
const PROGRESS: f64 = 1e-6;

/// Isometric flips until every edge of the triangulation is Delaunay, except for fixed edges and those whose flip would make a triangle
/// too thin for f64. Returns the number of flips. `record` is called with each flip (the edge with its length) just before it is made.
///
/// Every flip towards the plain Delaunay triangulation lowers the sum of all cotangents \[Musin97\]. On triangles that are nearly
/// degenerate rounding could repeat the same flips without end; then the sum does not fall.
///
/// # Errors
/// The surface is left as it was, bit for bit, although `record` was called.
/// - [`crate::Error::Size`]: lengths or circles are not one per edge, per vertex.
/// - [`crate::Error::EdgeLength`]: a length out of range.
/// - [`crate::Error::Connectivity`]: the flips do not end, since the sum of cotangents does not fall any more.
/// - [`crate::Error::Cancelled`].
pub fn intrinsic_delaunay(
    surface: &mut Triangulated,
    options: IntrinsicOptions,
    record: &mut dyn FnMut(&Mesh, Flip),
    control: &Control,
) -> Result<usize> {
    control.check()?;
    let Triangulated { mesh, lengths, geometry } = &*surface;
    check_lengths(mesh, lengths)?;
    if let Some(radii) = options.circles {
        check_size("radii", radii.len(), mesh.n_vertices())?;
    }
    let most = allowance(mesh.n_edges());
    let flips = IsometricFlips { geometry: *geometry, circles: options.circles, most };
    flips.make(surface, options.fixed, record, control)
}

/// Length of the other diagonal of an edge that is not Delaunay; none for an edge that is, that has none, or whose flip would make a
/// triangle too thin for f64.
pub(super) fn delaunay_flip(
    geometry: Space,
    mesh: &Mesh,
    lengths: &PerEdge<f64>,
    h: HalfedgeId,
) -> Option<f64> {
    let flips = IsometricFlips { geometry, circles: None, most: 0 };
    let may_flip = between_faces(mesh, h) && flips.fails(mesh, lengths, h);
    may_flip.then(|| flips.flipped(mesh, lengths, h)).flatten()
}

/// Flips of the edges that fail a Delaunay condition.
#[derive(Clone, Copy)]
struct IsometricFlips<'a> {
    geometry: Space,
    /// Radii of the circles that weight the condition.
    circles: Option<&'a PerVertex<f64>>,
    /// Number of flips after which the sum of cotangents must have fallen.
    most: usize,
}

impl IsometricFlips<'_> {
    /// Flip until no edge fails; where that is an error, the surface is put back.
    fn make(
        self,
        surface: &mut Triangulated,
        fixed: &FixedEdges,
        record: &mut dyn FnMut(&Mesh, Flip),
        control: &Control,
    ) -> Result<usize> {
        let Triangulated { mesh, lengths, .. } = surface;
        let mut queue = FlipQueue::where_holds(mesh, fixed, |h| self.fails(mesh, lengths, h));
        if queue.is_empty() {
            return Ok(0);
        }
        let mut log = FlipLog::default();
        let mut logged = |mesh: &Mesh, flip: Flip| {
            log.record(mesh, flip, &mut []);
            record(mesh, flip);
        };
        let flips = self.flip(surface, &mut queue, &mut logged, control);
        if flips.is_err() {
            log.undo(&mut surface.mesh, &mut surface.lengths, &mut [])?;
        }
        flips
    }

    /// [`FlipQueue::flip_until_empty`], for as long as the sum of cotangents falls.
    fn flip(
        self,
        Triangulated { mesh, lengths, .. }: &mut Triangulated,
        queue: &mut FlipQueue,
        record: &mut dyn FnMut(&Mesh, Flip),
        control: &Control,
    ) -> Result<usize> {
        let mut lowest = self.cotangents(mesh, lengths);
        let mut flips = 0;
        loop {
            let decide = |mesh: &Mesh, lengths: &PerEdge<f64>, h: HalfedgeId| {
                if self.fails(mesh, lengths, h) { self.flipped(mesh, lengths, h) } else { None }
            };
            let mut surface = Flippable { mesh, values: lengths, decide, record };
            flips += queue.flip_until_empty(self.most, &mut surface, control)?;
            if queue.is_empty() {
                return Ok(flips);
            }
            let now = self.cotangents(mesh, lengths);
            if now >= (1.0 - PROGRESS) * lowest {
                return Err(endless(
                    "isometric flips towards Delaunay do not end: 100 per edge and a million have not lowered the sum of \
                     cotangents; its triangles are too thin for floating-point numbers",
                ));
            }
            lowest = now;
        }
    }

    /// True if the edge of a half-edge between two faces fails the condition.
    fn fails(self, mesh: &Mesh, lengths: &PerEdge<f64>, h: HalfedgeId) -> bool {
        match self.circles {
            None => is_obtuse(self.geometry, sides(mesh, lengths, h)),
            Some(radii) => self.hinge(mesh, lengths, radii, h).wants_flip(),
        }
    }

    /// The hinge of an edge with circles of these radii around its four vertices, whose w are γ, tanh γ, tan γ.
    fn hinge(self, mesh: &Mesh, lengths: &PerEdge<f64>, radii: &PerVertex<f64>, h: HalfedgeId) -> Hinge {
        let [jk, ki, il, lj] = mesh.quadrilateral(h);
        let vertices = [h, h.twin(), ki, lj].map(|h| mesh.origin(h));
        let product = |e: HalfedgeId| {
            circle_product(self.geometry, lengths[e.edge()], mesh.ends(e.edge()).map(|v| radii[v]))
        };
        let squares = vertices.map(|v| circle_square(self.geometry, radii[v]));
        Hinge::from_products(squares, [h, ki, jk, il, lj].map(product))
    }

    /// Length of the other diagonal, if there is one and both triangles that it makes have an area in f64.
    fn flipped(self, mesh: &Mesh, lengths: &PerEdge<f64>, h: HalfedgeId) -> Option<f64> {
        let sides = sides(mesh, lengths, h);
        let [left, right] = sides.map(|l| triangle::angles(self.geometry, l));
        // The angle at the origin of h is at corner 0 on the left, and at corner 1 on the right, where the twin of h starts at the tip.
        let at_origin = left.at[0] + right.at[1];
        let at_tip = left.at[1] + right.at[0];
        if left.broken() || right.broken() || at_origin >= PI || at_tip >= PI {
            return None;
        }
        let [near, far] = [sides[0][1], sides[1][0]];
        let length = diagonal(self.geometry, near, far, at_origin);
        let made = [[near, far], [sides[0][0], sides[1][1]]].map(|[a, b]| [a, b, length]);
        let fits = length > 0.0 && length.is_finite() && made.iter().all(has_area);
        fits.then_some(length)
    }

    /// The sum of the cotangents of all angles, `Σ (a² + b² + c²)/4A` over the Euclidean triangles of the half chords; without
    /// triangles that have no area.
    fn cotangents(self, mesh: &Mesh, lengths: &PerEdge<f64>) -> f64 {
        let of = |f| {
            let chords = face_lengths(mesh, lengths, f).map(|l| half_chord(self.geometry, l));
            let squares: f64 = chords.iter().map(|l| l * l).sum();
            squares / (4.0 * triangle::area(Space::E2, chords))
        };
        mesh.faces().map(of).filter(|sum| sum.is_finite()).sum()
    }
}

/// True if these lengths are, in f64, those of a triangle with an area.
fn has_area(l: &[f64; 3]) -> bool {
    triangle::half_differences(*l).into_iter().all(|r| r > 0.0)
}

/// The half chord of an edge, up to a factor: l, sinh(l/2), sin(l/2).
fn half_chord(geometry: Space, length: f64) -> f64 {
    match geometry {
        Space::E2 => length,
        Space::H2 => (0.5 * length).sinh(),
        Space::S2 => (0.5 * length).sin(),
    }
}

/// Sides of the faces left and right of h, each from the side opposite to the origin of h, or of its twin, to h itself.
fn sides(mesh: &Mesh, lengths: &PerEdge<f64>, h: HalfedgeId) -> [[f64; 3]; 2] {
    [h, h.twin()].map(|h| [mesh.next(h), mesh.prev(h), h].map(|side| lengths[side.edge()]))
}

/// True if the angles α, β opposite a common side add up to more than π by more than [`TOLERANCE`]. In curved spaces the angles are
/// those of the Euclidean triangles of the half chords, which decide alike.
///
/// Far from π the sum of the cosines decides. Near π, where α is near π and β near 0, it cannot, but `sin(α + β)` can.
fn is_obtuse(geometry: Space, sides: [[f64; 3]; 2]) -> bool {
    let chords = sides.map(|sides| sides.map(|l| half_chord(geometry, l)));
    let [cos_k, cos_l] = chords.map(|[a, b, c]| (a * a + b * b - c * c) / (2.0 * a * b));
    if (cos_k + cos_l).abs() > DECISIVE {
        return cos_k + cos_l < 0.0;
    }
    let [sin_k, sin_l] = chords.map(|[a, b, c]| 2.0 * triangle::area(Space::E2, [a, b, c]) / (a * b));
    sin_k * cos_l + cos_k * sin_l < -TOLERANCE
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::error::Error;

    /// A square of side 1 and its diagonal from vertex 0 to vertex 2, which is Delaunay, but no longer with a circle around vertex 1.
    fn square() -> (Triangulated, PerVertex<f64>) {
        let mesh = Mesh::from_faces(4, &[[0, 1, 2], [0, 2, 3]]).unwrap();
        let is_diagonal = |e| mesh.ends(e).iter().all(|v| v.0 % 2 == 0);
        let lengths = PerEdge::from_fn(mesh.n_edges(), |e| if is_diagonal(e) { 2f64.sqrt() } else { 1.0 });
        (Triangulated { mesh, lengths, geometry: Space::E2 }, vec![0.0, 0.3, 0.0, 0.0].into())
    }

    /// Both diagonals of a square give the same sum of cotangents, so one flip is no progress. After two flips, or after one and a
    /// look at the sides, the queue is empty.
    #[test]
    fn flips_without_progress_are_an_error_that_leaves_the_surface_as_it_was() {
        let (square, radii) = square();
        for (most, ends) in [(1, false), (2, true)] {
            let mut surface = square.clone();
            let flips = IsometricFlips { geometry: Space::E2, circles: Some(&radii), most };
            let mut told = 0;
            let made = flips.make(&mut surface, &NO_EDGES, &mut |_, _| told += 1, &Control::new());
            assert_eq!(told, 1);
            match made {
                Ok(n) => assert!(ends && n == 1 && surface != square),
                Err(Error::Connectivity { element: "mesh", message, .. }) => {
                    assert!(!ends && surface == square && message.contains("do not end"), "{message}");
                }
                Err(other) => panic!("{other}"),
            }
        }
    }
}
