//! Distortion of a layout: quasi-conformal dilatation and area.

use super::layout::Layout;
use super::shape::{FLAT, Shape};
use super::triangle::Triangle;
use crate::error::{Error, Result, check_size};
use crate::mesh::{FaceId, Mesh, PerEdge, PerFace};
use crate::metric::Refinement;
use crate::topology::check_lengths;

/// The dilatation of a face whose image or original has no area: doubles resolve none beyond 1/ε.
pub const DILATATION_CAP: f64 = 1.0 / f64::EPSILON;

/// How the linear maps from the input triangles to the layout's triangles distort. Every number is finite.
#[derive(Debug, Clone, PartialEq)]
pub struct Quality {
    /// Quasi-conformal dilatation K ≥ 1 per face: largest over smallest singular value; [`DILATATION_CAP`] at
    /// most.
    pub qc: PerFace<f64>,
    /// Area in the layout over area in the input, both relative to their totals; 1 for a degenerate input
    /// face.
    pub area_ratio: PerFace<f64>,
    /// Mean of `qc`, weighed with the input areas.
    pub qc_mean: f64,
    /// Largest `qc`.
    pub qc_max: f64,
    /// Smallest `area_ratio`.
    pub area_ratio_min: f64,
    /// Largest `area_ratio`.
    pub area_ratio_max: f64,
    /// Faces with no area in the input or in the layout (or a dilatation that reaches the cap): their `qc` is
    /// [`DILATATION_CAP`], and the mean and extremes leave them out.
    pub degenerate: Vec<FaceId>,
}

/// Compare the layout's triangles with those of the input's edge lengths, given on the same mesh.
///
/// A flipped face counts with the dilatation of its mirror image ([`Layout::flipped`] names it).
///
/// Errors: [`crate::Error::Size`], [`crate::Error::EdgeLength`], [`crate::Error::TriangleInequality`] of the
/// input lengths.
pub fn quality(mesh: &Mesh, input_lengths: &PerEdge<f64>, layout: &Layout) -> Result<Quality> {
    check_lengths(mesh, input_lengths)?;
    check_size("corner_index", layout.corner_index.len(), mesh.n_halfedges())?;
    // Units in which no area over- or underflows that matters.
    let unit = input_lengths.iter().copied().fold(0.0, f64::max);
    let mut qc = PerFace::filled(mesh.n_faces(), DILATATION_CAP);
    let mut areas = PerFace::filled(mesh.n_faces(), [0.0; 2]);
    for f in mesh.faces() {
        let sides = mesh.opposite_edges(f).map(|e| input_lengths[e] / unit);
        let triangle = Triangle::from_sides(sides);
        if triangle.excess > 0.0 {
            return Err(Error::TriangleInequality { face: f.index(), excess: triangle.excess });
        }
        let image = layout.face_uv(mesh, f).map(|p| p.map(|x| x / layout.diameter));
        let image_area = 0.5 * cross(minus(image[1], image[0]), minus(image[2], image[0])).abs();
        areas[f] = [triangle.area, image_area];
        qc[f] = dilatation(sides, &triangle, image);
    }
    Ok(summary(mesh, qc, &areas))
}

/// Compare the pieces of a refinement with their images: corners, area and whether there is anything to compare.
pub(super) fn refined_quality(
    r: &Refinement,
    input: &Mesh,
    lengths: &PerEdge<f64>,
    image: impl Fn(FaceId) -> ([[f64; 2]; 3], f64, bool),
) -> Result<Quality> {
    check_lengths(input, lengths)?;
    let need = r.input_face.iter().map(|f| f.index() + 1).fold(0, usize::max);
    check_size("input faces", input.n_faces().min(need), need)?;
    let unit = lengths.iter().copied().fold(0.0, f64::max);
    let mut qc = PerFace::filled(r.mesh.n_faces(), DILATATION_CAP);
    let mut areas = PerFace::filled(r.mesh.n_faces(), [0.0; 2]);
    let vectors = |p: [[f64; 2]; 3]| [minus(p[1], p[0]), minus(p[2], p[0])];
    for f in r.mesh.faces() {
        let face = r.input_face[f];
        let sides = input.opposite_edges(face).map(|e| lengths[e] / unit);
        let triangle = Triangle::from_sides(sides);
        if triangle.excess > 0.0 {
            return Err(Error::TriangleInequality { face: face.index(), excess: triangle.excess });
        }
        let [first, way] = [[sides[2], 0.0], triangle.direction[0].map(|x| sides[1] * x)];
        let from = r.input_barycentric(f).map(|[_, x, y]| [x * first[0] + y * way[0], y * way[1]]);
        let [p, q] = vectors(from);
        let (to, area, sound) = image(f);
        areas[f] = [0.5 * cross(p, q).abs(), area];
        if Shape::of(from).share > FLAT && sound {
            qc[f] = dilatation_of_vectors(vectors(from), vectors(to));
        }
    }
    Ok(summary(&r.mesh, qc, &areas))
}

/// The statistics of dilatations and of areas `[input, layout]` per face.
fn summary(mesh: &Mesh, qc: PerFace<f64>, areas: &PerFace<[f64; 2]>) -> Quality {
    let total = areas.iter().fold([0.0; 2], |t, a| [t[0] + a[0], t[1] + a[1]]);
    let ratio = |&[a, b]: &[f64; 2]| {
        let r = (b / total[1]) / (a / total[0]);
        if r.is_finite() { r } else { 1.0 }
    };
    let area_ratio: PerFace<f64> = areas.iter().map(ratio).collect::<Vec<_>>().into();

    let (degenerate, sound): (Vec<_>, Vec<_>) = mesh.faces().partition(|&f| qc[f] >= DILATATION_CAP);
    let weight: f64 = sound.iter().map(|&f| areas[f][0]).sum();
    let sum: f64 = sound.iter().map(|&f| areas[f][0] * qc[f]).sum();
    let most = |values: &PerFace<f64>| sound.iter().map(|&f| values[f]).reduce(f64::max).unwrap_or(1.0);
    let least = |values: &PerFace<f64>| sound.iter().map(|&f| values[f]).reduce(f64::min).unwrap_or(1.0);
    Quality {
        qc_mean: if weight > 0.0 { sum / weight } else { 1.0 },
        qc_max: most(&qc),
        area_ratio_min: least(&area_ratio),
        area_ratio_max: most(&area_ratio),
        qc,
        area_ratio,
        degenerate,
    }
}

/// Dilatation of the linear map from the triangle with these sides onto the triangle `image`.
///
/// With edge vectors P, P′ from one corner and their images Q, Q′ as complex numbers, the map is `z ↦ αz +
/// βz̄` where `α ∝ Q P̄′ − Q′ P̄` and `β ∝ Q P′ − Q′ P`, and `K = (|α| + |β|) / ||α| − |β|| = (|α| + |β|)² /
/// (16 A A′)`: the areas are formed directly, so nothing cancels where K is large. The corner is the one
/// opposite the longest side, where a needle's edge vectors are far from parallel.
fn dilatation(sides: [f64; 3], triangle: &Triangle, image: [[f64; 2]; 3]) -> f64 {
    let k = (0..3).max_by(|&i, &j| sides[i].total_cmp(&sides[j])).unwrap_or(0);
    let [i, j] = [(k + 1) % 3, (k + 2) % 3];
    let [c, s] = triangle.direction[k];
    let q = minus(image[i], image[k]).map(|x| x / sides[j]);
    let r = minus(image[j], image[k]).map(|x| x / sides[i]);
    // Scaled by their lengths, P = 1, P′ = c + i s, Q = q, Q′ = r.
    let alpha = [q[0] * c + q[1] * s - r[0], q[1] * c - q[0] * s - r[1]];
    let beta = [q[0] * c - q[1] * s - r[0], q[1] * c + q[0] * s - r[1]];
    bounded(alpha, beta, s * cross(q, r))
}

/// Dilatation of the linear map that carries the vectors `p` to the vectors `q`.
fn dilatation_of_vectors(p: [[f64; 2]; 2], q: [[f64; 2]; 2]) -> f64 {
    let [[p, r], [q, s]] = [p, q];
    // α = q r̄ − s p̄, β = q r − s p.
    let alpha = [
        q[0] * r[0] + q[1] * r[1] - s[0] * p[0] - s[1] * p[1],
        q[1] * r[0] - q[0] * r[1] - s[1] * p[0] + s[0] * p[1],
    ];
    let beta = [
        q[0] * r[0] - q[1] * r[1] - s[0] * p[0] + s[1] * p[1],
        q[1] * r[0] + q[0] * r[1] - s[1] * p[0] - s[0] * p[1],
    ];
    bounded(alpha, beta, cross(p, r) * cross(q, s))
}

/// `(|α| + |β|)² / 4|product of the cross products|`, at least 1 and at most the cap.
fn bounded(alpha: [f64; 2], beta: [f64; 2], product: f64) -> f64 {
    let norm = alpha[0].hypot(alpha[1]) + beta[0].hypot(beta[1]);
    let dilatation = norm * norm / (4.0 * product.abs());
    if dilatation.is_finite() { dilatation.clamp(1.0, DILATATION_CAP) } else { DILATATION_CAP }
}

pub(super) fn minus(p: [f64; 2], q: [f64; 2]) -> [f64; 2] {
    [p[0] - q[0], p[1] - q[1]]
}

pub(super) fn cross(p: [f64; 2], q: [f64; 2]) -> f64 {
    p[0] * q[1] - p[1] * q[0]
}
