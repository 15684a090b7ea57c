//! Mean value weights of a triangulation in its own canonical metric: they are positive, and by them every vertex is the mean of its
//! neighbours.

use crate::control::Control;
use crate::error::Result;
use crate::geometry::complex::{cross, dot};
use crate::geometry::{Space, triangle};
use crate::matching::cover::{PlacedMesh, determinant, logarithm, seen_from};
use crate::mesh::{FaceId, HalfedgeId, Mesh, PerHalfedge, VertexId};
use crate::metric::Surface;
use crate::metric::lengths::face_lengths;
use std::f64::consts::{PI, TAU};

/// Largest difference, radians, of the angles around a vertex from a full turn (half of one on a straight boundary) up to which they are
/// taken from the layout: this has the rounding errors of f64s, magnified by the distance from the root.
const FULL_TURN: f64 = 1e-3;
/// Largest angle that enters a weight, radians: the tangent of its half is then below 2e9.
const LARGEST_ANGLE: f64 = PI - 1e-9;
/// Least length that enters a weight, as a share of the longest of the face.
const LEAST_LENGTH: f64 = 1e-12;
/// Faces whose shapes are taken between two looks at the control.
const FACES_PER_CHECK: usize = 1 << 10;

/// The angles of a face, the lengths of the sides that start at its corners, and true if the face is not turned over.
#[derive(Debug, Clone, Copy)]
struct FaceShape {
    angles: [f64; 3],
    lengths: [f64; 3],
    is_upright: bool,
}

/// Per half-edge from i to j of a surface, the weight of j at i: `(tan(α/2) + tan(β/2))/r` with the angles α and β at i beside the edge and
/// its length r \[Flo03\]. The logarithms of the neighbours, weighted with them, add up to 0 at every vertex where the surface is flat or
/// hyperbolic, in the geometry in which angles and lengths are taken; along a straight boundary they do so together with their mirror
/// images.
///
/// Angles and lengths are taken from `placed`, the triangulation as it lies in its own canonical domain; at vertices where this folds they
/// are taken from the surface, where the weights are positive too. The weights of each vertex are multiplied by the mean length of its
/// edges.
///
/// # Errors
/// [`Error::Cancelled`](crate::error::Error::Cancelled).
pub(crate) fn mean_value_weights(
    placed: &PlacedMesh,
    surface: &Surface,
    control: &Control,
) -> Result<PerHalfedge<f64>> {
    let mesh = &placed.cover.mesh;
    let (mut canonical, mut steps) = (Vec::with_capacity(mesh.n_faces()), 0);
    for f in mesh.faces() {
        control.check_every(FACES_PER_CHECK, &mut steps)?;
        canonical.push(shape_in_place(placed, f));
    }
    control.check()?;
    let given: Vec<FaceShape> = mesh.faces().map(|f| shape_given(surface, f)).collect();
    let mut weights = PerHalfedge::filled(mesh.n_halfedges(), 0.0);
    for v in mesh.vertices() {
        let shapes = if is_whole(mesh, v, &canonical) { &canonical } else { &given };
        let (mut length, mut count) = (0.0, 0.0);
        for (f, k) in mesh.outgoing(v).filter_map(|h| mesh.corner(h)) {
            (length, count) = (length + shapes[f.index()].lengths[k], count + 1.0);
        }
        // A common factor of the weights at one vertex changes no mean. With the mean length of the edges weights are pure numbers.
        for h in mesh.outgoing(v) {
            weights[h] = sides(mesh, h, shapes).into_iter().flatten().sum::<f64>() * (length / count);
        }
    }
    Ok(weights)
}

/// The summands of a half-edge's weight from the faces on its two sides.
fn sides(mesh: &Mesh, h: HalfedgeId, shapes: &[FaceShape]) -> [Option<f64>; 2] {
    let part = |angle: f64, length: f64| (0.5 * angle.min(LARGEST_ANGLE)).tan() / length;
    // On the left the half-edge starts at the corner, on the right its twin ends there.
    let left = mesh.corner(h).map(|(f, k)| part(shapes[f.index()].angles[k], shapes[f.index()].lengths[k]));
    let right = mesh.corner(h.twin()).map(|(f, k)| {
        let shape = &shapes[f.index()];
        part(shape.angles[(k + 1) % 3], shape.lengths[k])
    });
    [left, right]
}

/// True if the faces around a vertex lie around it once, none turned over.
fn is_whole(mesh: &Mesh, v: VertexId, shapes: &[FaceShape]) -> bool {
    let corners: Vec<_> = mesh.outgoing(v).filter_map(|h| mesh.corner(h)).collect();
    let total: f64 = corners.iter().map(|&(f, k)| shapes[f.index()].angles[k]).sum();
    let full = if mesh.is_boundary_vertex(v) { PI } else { TAU };
    (total - full).abs() < FULL_TURN && corners.iter().all(|(f, _)| shapes[f.index()].is_upright)
}

/// The shape of a face as it lies in the canonical domain.
fn shape_in_place(placed: &PlacedMesh, f: FaceId) -> FaceShape {
    let space = placed.cover.space;
    let frames = placed.face(f);
    let (mut angles, mut lengths) = ([0.0; 3], [0.0; 3]);
    for k in 0..3 {
        let [ahead, behind] = [1, 2].map(|j| logarithm(space, seen_from(&frames[k], &frames[(k + j) % 3])));
        angles[k] = cross(ahead, behind).atan2(dot(ahead, behind));
        lengths[k] = ahead[0].hypot(ahead[1]);
    }
    let longest = lengths.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    lengths.iter_mut().for_each(|l| *l = l.max(LEAST_LENGTH * longest));
    let points = frames.map(|frame| seen_from(&frames[0], &frame));
    let is_upright = f64::from(determinant(points)) > 0.0 && angles.iter().all(|a| *a > 0.0);
    FaceShape { angles, lengths, is_upright }
}

/// The shape of a face of the surface as it came.
fn shape_given(surface: &Surface, f: FaceId) -> FaceShape {
    let mesh = surface.mesh();
    // Angles opposite the lengths [bc, ca, ab].
    let opposite = face_lengths(mesh, surface.lengths(), f);
    let angles = triangle::angles(Space::E2, opposite).at;
    let [bc, ca, ab] = opposite;
    FaceShape { angles, lengths: [ab, bc, ca], is_upright: true }
}
