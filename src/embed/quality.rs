//! Distortion of a layout: quasi-conformal dilatation and area.
//!
//! ```
//! use ricci::embed::layout;
//! use ricci::{Control, Surface, mesh::shapes, topology::cut_graph};
//! # fn main() -> ricci::Result<()> {
//! let disk = Surface::from_soup(&shapes::disk(4)?)?;
//! let cut = cut_graph(disk.mesh(), disk.lengths(), &[], &Control::new())?;
//! let isometric = layout(disk.mesh(), disk.lengths(), &cut, &Control::new())?;
//! let quality = isometric.quality(disk.mesh(), disk.lengths())?;
//! assert!(quality.qc_max < 1.0 + 1e-12 && quality.degenerate.is_empty());
//! # Ok(())
//! # }
//! ```

use super::layout::{Layout, distance, shape_of};
use super::overlap::Triangle;
use super::pieces::CORNERS;
use super::shape::{LEAST_SHARE, Shape, Standing, extent, is_surely_upright};
use super::triangle::Triangle as PlaneTriangle;
use crate::error::{Error, Result, check_size};
use crate::geometry::complex::{Complex, conj, cross, doubled_area, mul, norm2, quick_norm, sub};
use crate::geometry::triangle::area;
use crate::geometry::{Space, vector};
use crate::mesh::{FaceId, Mesh, PerEdge, PerFace, Point};
use crate::metric::Refinement;
use crate::parallel;
use crate::topology::check_lengths;
use std::ops::RangeInclusive;

/// The dilatation of a face whose image or original has no area. It is 1/ε, since doubles resolve no larger one.
pub const DILATATION_CAP: f64 = 1.0 / f64::EPSILON;

/// Length of the longest edge of a piece on the unit sphere below which its shape is not measured: coordinates are rounded by 1e-16, which
/// leaves the shape of a larger piece right to 1e-9.
const LEAST_EDGE_ON_SPHERE: f64 = 1e-7;

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

impl Layout {
    /// How the linear maps from the input's triangles, or their pieces, to those of the layout's plane coordinates distort; areas are those
    /// of the space. `input`: the triangulation of the surface as it came (of a double: that or the surface's own) with the `lengths` of
    /// its edges in E².
    ///
    /// A flipped face counts with the dilatation of its mirror image. Triangles that are degenerate on either side are named, and
    /// left out of the mean and the extremes.
    ///
    /// # Errors
    /// [`Error::Size`], [`Error::EdgeLength`], [`Error::TriangleInequality`] of the input lengths.
    pub fn quality(&self, input: &Mesh, lengths: &PerEdge<f64>) -> Result<Quality> {
        let place = (|f| self.pieces.input_face(f), |f| self.pieces.input_barycentric(f));
        let over = 1.0 / self.diameter;
        Given::new(input, lengths)?.quality(self.mesh(), place, |f, from| {
            let to = self.face_uv(f).map(|p| p.map(|x| x * over));
            let corners = self.face_points(f);
            let can_compare = self.can_compare(from, to, corners);
            (if can_compare { dilatation(from, to) } else { DILATATION_CAP }, self.area_of(to, corners))
        })
    }

    /// [`Layout::quality`] of the map that is linear on the faces of the surface as it came ([`Layout::on_input`]); `None` where the cut
    /// does not run along its edges. `lengths`: of its edges in E².
    ///
    /// # Errors
    /// [`Error::Size`], [`Error::EdgeLength`], [`Error::TriangleInequality`] of the lengths.
    pub fn quality_on_input(&self, lengths: &PerEdge<f64>) -> Result<Option<Quality>> {
        let (Some((input, _)), Some(on_input)) = (&self.input, self.on_input()) else { return Ok(None) };
        let place = (|f| f, |_| CORNERS);
        let over = 1.0 / self.diameter;
        let quality = Given::new(input, lengths)?.quality(input, place, |f, from| {
            let face = input.face_halfedges(f);
            let points = face.map(|h| on_input.points[on_input.corner_index[h] as usize] as usize);
            let to = points.map(|k| self.coordinates[k].map(|x| x * over));
            (dilatation(from, to), self.area_of(to, points.map(|k| self.points[k])))
        });
        quality.map(Some)
    }

    /// Whether a piece and its image have a shape to compare. The triangles of a mesh always have, as far as doubles go: they come from
    /// their lengths; the corners of a refinement's pieces are rounded. `to`: the image in E², divided by the diameter; `corners`: in
    /// ambient coordinates.
    fn can_compare(&self, from: Triangle, to: Triangle, corners: [Point; 3]) -> bool {
        let is_sound = || match self.space {
            Space::E2 => !Shape::of(to).is_degenerate(extent(&to).max(1.0)),
            Space::H2 if is_surely_upright(corners) => true,
            _ => {
                let (shape, far) = shape_of(corners, self.brought_home(corners));
                Standing::of(&shape, far) == Standing::Upright
            }
        };
        self.refinement().is_none() || (Shape::of(from).share > LEAST_SHARE && is_sound())
    }

    /// The area of a triangle: in E² of its coordinates, divided by the diameter; elsewhere of its corners in ambient coordinates.
    fn area_of(&self, to: Triangle, corners: [Point; 3]) -> f64 {
        match self.space {
            Space::E2 => 0.5 * doubled_area(to).abs(),
            Space::H2 if corners.iter().all(|p| p[2] < NEAR) => area_near(corners),
            space => {
                let p = self.brought_home(corners);
                area(space, [[1, 2], [2, 0], [0, 1]].map(|[i, j]| distance(space, p[i], p[j])))
            }
        }
    }
}

impl Quality {
    /// How the linear maps from the pieces of a refinement of the `input`, with the `lengths` of its edges in E², to triangles in space
    /// with corners on the unit sphere distort. `corners`: those of a piece, in its corner order.
    ///
    /// Degenerate pieces are those within [`LEAST_SHARE`] of no area on either side, and those whose image is so small that rounding of
    /// positions shows in its shape.
    ///
    /// # Errors
    /// [`Error::Size`], [`Error::EdgeLength`], [`Error::TriangleInequality`] of the input lengths.
    pub fn on_sphere(
        refinement: &Refinement,
        input: &Mesh,
        lengths: &PerEdge<f64>,
        corners: impl Fn(FaceId) -> [Point; 3] + Sync,
    ) -> Result<Quality> {
        let place = (|f| refinement.input_face[f], |f| refinement.input_barycentric(f));
        Given::new(input, lengths)?.quality(&refinement.mesh, place, |f, from| {
            let [a, b, c] = corners(f);
            let sides = [[b, c], [c, a], [a, b]].map(|[p, q]| vector::distance(p, q));
            let (to, _) = in_plane(sides, CORNERS);
            let (before, after) = (Shape::of(from), Shape::of(to));
            let is_sound =
                before.share.min(after.share) > LEAST_SHARE && after.longest >= LEAST_EDGE_ON_SPHERE;
            let dilatation = if is_sound { dilatation(from, to) } else { DILATATION_CAP };
            (dilatation, 0.5 * doubled_area(to).abs())
        })
    }
}

/// cosh of the distance from the origin up to which areas in H² are formed where triangles lie: products of three coordinates then lose at
/// most 4 digits to those of the triangle's sides.
const NEAR: f64 = 16.0;

/// The area of a triangle in H² by its corners p, q, r on the hyperboloid: `tan(area/2) = |det(p, q, r)| / (1 − ⟨p, q⟩ − ⟨q, r⟩ − ⟨r, p⟩)`.
fn area_near([p, q, r]: [Point; 3]) -> f64 {
    let (a, b) = (vector::sub(q, p), vector::sub(r, p));
    let form = |p: Point, q: Point| p[2] * q[2] - p[0] * q[0] - p[1] * q[1];
    let det = vector::dot(p, vector::cross(a, b)).abs();
    2.0 * det.atan2(1.0 + form(p, q) + form(q, r) + form(r, p))
}

/// The surface as it came: triangles by their lengths.
struct Given<'a> {
    mesh: &'a Mesh,
    lengths: &'a PerEdge<f64>,
    /// The longest edge: in units of it no area over- or underflows that matters.
    unit: f64,
}

impl<'a> Given<'a> {
    fn new(mesh: &'a Mesh, lengths: &'a PerEdge<f64>) -> Result<Self> {
        check_lengths(mesh, lengths)?;
        Ok(Given { mesh, lengths, unit: lengths.iter().copied().fold(0.0, f64::max) })
    }

    /// The sides of a face, in units of the longest edge.
    fn sides(&self, f: FaceId) -> [f64; 3] {
        self.mesh.opposite_edges(f).map(|e| self.lengths[e] / self.unit)
    }

    /// The quality of a map of pieces. `source`: the face of a piece, and `weights`: those of the piece's corners in it. `image`: the
    /// dilatation of a piece that lies so in the plane, and the area of its image.
    fn quality(
        &self,
        pieces: &Mesh,
        (source, weights): (impl Fn(FaceId) -> FaceId + Sync, impl Fn(FaceId) -> [[f64; 3]; 3] + Sync),
        image: impl Fn(FaceId, Triangle) -> (f64, f64) + Sync,
    ) -> Result<Quality> {
        let need = pieces.faces().map(|f| source(f).index() + 1).fold(0, usize::max);
        check_size("input faces", self.mesh.n_faces().min(need), need)?;
        let (mut qc, mut areas) = (vec![DILATATION_CAP; pieces.n_faces()], vec![[0.0; 2]; pieces.n_faces()]);
        // No dilatation is negative: where one is, it says by how much the triangle inequality is broken.
        parallel::fill_both(&mut qc, &mut areas, |f| {
            let (face, weights) = (source(f.into()), weights(f.into()));
            let (from, excess) = in_plane(self.sides(face), weights);
            if excess > 0.0 {
                return (-excess, [0.0; 2]);
            }
            let (dilatation, area) = image(f.into(), from);
            (dilatation, [0.5 * doubled_area(from).abs(), area])
        });
        if let Some(f) = qc.iter().position(|&qc| qc < 0.0) {
            return Err(Error::TriangleInequality { face: source(f.into()).index(), excess: -qc[f] });
        }
        Ok(summary(qc.into(), &areas.into()))
    }
}

/// Points of a triangle in the plane, by the weights of its corners. The corner opposite the longest side lies at the origin: the edges of
/// a needle are far from parallel there. Also by how much the longest side exceeds the others ([`PlaneTriangle::excess`]).
fn in_plane(sides: [f64; 3], weights: [[f64; 3]; 3]) -> (Triangle, f64) {
    let k = longest_side(sides);
    let (i, j) = ((k + 1) % 3, (k + 2) % 3);
    let (direction, excess) = PlaneTriangle::direction_at(sides, k);
    let way = direction.map(|x| sides[i] * x);
    (weights.map(|w| [w[i] * sides[j] + w[j] * way[0], w[j] * way[1]]), excess)
}

fn longest_side(sides: [f64; 3]) -> usize {
    (0..3).fold(0, |k, i| if sides[i] > sides[k] { i } else { k })
}

/// The statistics of dilatations and of areas `[input, layout]` per face.
fn summary(qc: PerFace<f64>, areas: &PerFace<[f64; 2]>) -> Quality {
    let total = areas.iter().fold([0.0; 2], |t, a| [t[0] + a[0], t[1] + a[1]]);
    let scale = total[0] / total[1];
    let mut area_ratio = vec![1.0; areas.len()];
    parallel::fill(&mut area_ratio, |f| {
        let [a, b] = areas[FaceId::from(f)];
        let r = b * scale / a;
        if r.is_finite() { r } else { 1.0 }
    });
    let (mut weight, mut sum, mut most, mut ratios) = (0.0, 0.0, f64::NEG_INFINITY, [f64::INFINITY, 0.0]);
    let mut degenerate = Vec::new();
    for (f, (&qc, (area, &ratio))) in qc.iter().zip(areas.iter().zip(&area_ratio)).enumerate() {
        if qc >= DILATATION_CAP {
            degenerate.push(FaceId::from(f));
            continue;
        }
        (weight, sum) = (weight + area[0], sum + area[0] * qc);
        (most, ratios) = (most.max(qc), [ratios[0].min(ratio), ratios[1].max(ratio)]);
    }
    let is_any = degenerate.len() < qc.len();
    let or_one = |x: f64| if is_any { x } else { 1.0 };
    Quality {
        qc_mean: if weight > 0.0 { sum / weight } else { 1.0 },
        qc_max: or_one(most),
        area_ratio_min: or_one(ratios[0]),
        area_ratio_max: or_one(ratios[1]),
        qc,
        area_ratio: area_ratio.into(),
        degenerate,
    }
}

/// Dilatation of the linear map of triangles.
///
/// With edge vectors P, P′ from one corner and their images Q, Q′ as complex numbers, the map is `z ↦ αz +
/// βz̄` where `α ∝ Q P̄′ − Q′ P̄` and `β ∝ Q P′ − Q′ P`, and `K = (|α| + |β|) / ||α| − |β|| = (|α| + |β|)² /
/// (16 A A′)`: the areas are formed directly, so nothing cancels where K is large. The corner is the one
/// opposite the longest side, where a needle's edge vectors are far from parallel.
fn dilatation(from: Triangle, to: Triangle) -> f64 {
    let k = longest_side([[1, 2], [2, 0], [0, 1]].map(|[i, j]| norm2(sub(from[i], from[j]))));
    let (i, j) = ((k + 1) % 3, (k + 2) % 3);
    let vectors = |t: Triangle| [sub(t[i], t[k]), sub(t[j], t[k])];
    let ([p, q], [p_image, q_image]) = (vectors(from), vectors(to));
    let found = if [p, q, p_image, q_image].iter().all(|&z| USUAL_SQUARES.contains(&norm2(z))) {
        dilatation_of_sides([p, q], [p_image, q_image])
    } else {
        // Scaled by their lengths: sides of very different lengths pass.
        let size = [p, q].map(quick_norm);
        let scaled = |sides: [Complex; 2]| [0, 1].map(|k| sides[k].map(|x| x / size[k]));
        dilatation_of_sides(scaled([p, q]), scaled([p_image, q_image]))
    };
    if found.is_finite() { found.clamp(1.0, DILATATION_CAP) } else { DILATATION_CAP }
}

/// Squares of lengths of which no product of four lengths is beyond doubles.
const USUAL_SQUARES: RangeInclusive<f64> = 1e-60..=1e60;

/// The dilatation of the linear map that takes two sides to their images, not a finite number where a triangle has no area.
fn dilatation_of_sides([p, q]: [Complex; 2], [p_image, q_image]: [Complex; 2]) -> f64 {
    let alpha = sub(mul(p_image, conj(q)), mul(q_image, conj(p)));
    let beta = sub(mul(p_image, q), mul(q_image, p));
    let sum = quick_norm(alpha) + quick_norm(beta);
    sum * sum / (4.0 * (cross(p, q) * cross(p_image, q_image)).abs())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::model::from_poincare;

    #[test]
    fn areas_near_the_origin_are_those_of_the_sides() {
        for [p, q, r] in [
            [[0.0, 0.0], [0.3, 0.1], [0.1, 0.4]],
            [[0.8, 0.1], [0.81, 0.1], [0.8, 0.12]],
            [[0.9, 0.0], [-0.5, 0.7], [-0.5, -0.7]],
        ] {
            let corners = [p, q, r].map(from_poincare);
            assert!(corners.iter().all(|p| p[2] < NEAR));
            let sides = [[1, 2], [2, 0], [0, 1]].map(|[i, j]| distance(Space::H2, corners[i], corners[j]));
            let known = area(Space::H2, sides);
            let [p, q, r] = corners;
            assert!((area_near([p, q, r]) / known - 1.0).abs() < 1e-11, "{corners:?}");
            assert_eq!(area_near([p, r, q]), area_near([p, q, r]));
        }
    }
}
