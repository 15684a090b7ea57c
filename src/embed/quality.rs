//! Distortion of a layout: quasi-conformal dilatation and area.
//!
//! ```
//! use ricci::embed::Layout;
//! use ricci::{Control, Surface, mesh::shapes, topology::cut_graph};
//! # fn main() -> ricci::Result<()> {
//! let disk = Surface::from_soup(&shapes::disk(4)?)?;
//! let cut = cut_graph(disk.mesh(), disk.lengths(), &[], &Control::new())?;
//! let isometric = Layout::of_lengths(disk.mesh(), disk.lengths(), &cut, &Control::new())?;
//! let quality = isometric.quality(disk.mesh(), disk.lengths())?;
//! assert!(quality.qc_max < 1.0 + 1e-12 && quality.degenerate.is_empty());
//! # Ok(())
//! # }
//! ```

use super::layout::{Layout, distance};
use super::pieces::CORNERS;
use super::repaired_input::RepairedInput;
use crate::error::{Error, Result, check_size};
use crate::geometry::complex::{Complex, conj, cross, doubled_area, mul, norm2, quick_norm, sub};
use crate::geometry::plane_triangle::PlaneTriangle;
use crate::geometry::triangle::area;
use crate::geometry::triangle_flatness::{
    LEAST_RELATIVE_AREA, TriangleFlatness, TriangleOrientation, is_surely_upright, largest_coordinate,
};
use crate::geometry::triangle_overlap::TriangleCorners;
use crate::geometry::{Space, vector};
use crate::mesh::{FaceId, Mesh, PerEdge, PerFace, Point};
use crate::metric::CommonSubdivision;
use crate::parallel;
use crate::topology::check_lengths;
use std::ops::RangeInclusive;

/// The dilatation of a face that has no area in the input or in the layout. It is 1/ε, since f64s resolve no larger dilatation.
pub const DILATATION_CAP: f64 = 1.0 / f64::EPSILON;

/// Least length of the longest edge of a piece on the unit sphere whose shape is measured: coordinates are rounded by 1e-16, which leaves
/// the shape of a larger piece right to 1e-9.
const LEAST_EDGE_ON_SPHERE: f64 = 1e-7;

/// The distortion of the linear maps from the input's triangles to the layout's triangles. Every number is finite.
#[derive(Debug, Clone, PartialEq)]
pub struct Quality {
    /// Per face, the quasi-conformal dilatation K ≥ 1, the largest over the smallest singular value; at most [`DILATATION_CAP`].
    pub qc: PerFace<f64>,
    /// Per face, the area in the layout over the area in the input, both relative to their totals; 1 for a degenerate input face.
    pub area_ratio: PerFace<f64>,
    /// The mean of `qc`, weighed with the input areas.
    pub qc_mean: f64,
    /// The largest `qc`.
    pub qc_max: f64,
    /// The smallest `area_ratio`.
    pub area_ratio_min: f64,
    /// The largest `area_ratio`.
    pub area_ratio_max: f64,
    /// The symmetric Dirichlet energy: the mean, weighed with the input areas, of `σ² + τ² + σ⁻² + τ⁻²` of the singular values σ and τ of the
    /// linear maps, scaled such that both total areas are the same; 4 for an isometry.
    pub symmetric_dirichlet: f64,
    /// The faces that have no area in the input or in the layout, or whose dilatation reaches the cap: their `qc` is [`DILATATION_CAP`],
    /// and the mean and the extremes leave them out.
    pub degenerate: Vec<FaceId>,
}

impl Layout {
    /// The distortion of the linear maps from the input's triangles, or their pieces, to those of the layout's plane coordinates; areas are
    /// those of the space. `input`: the triangulation of the surface as it came (of a double: that or the surface's own); `lengths`: of its
    /// edges in E².
    ///
    /// A flipped face counts with the dilatation of its mirror image.
    ///
    /// # Errors
    /// [`Error::Size`], [`Error::EdgeLength`], [`Error::TriangleInequality`] of the input lengths.
    pub fn quality(&self, input: &Mesh, lengths: &PerEdge<f64>) -> Result<Quality> {
        let face = |f| self.pieces.input_face(f);
        let weights = |f| self.pieces.input_barycentric(f);
        let over = 1.0 / self.diameter;
        InputTriangles::new(input, lengths)?.quality(self.mesh(), face, weights, |f, from| {
            let to = self.face_uv(f).map(|p| p.map(|x| x * over));
            let corners = self.face_points(f);
            let can_compare = self.can_compare(from, to, corners);
            (if can_compare { dilatation(from, to) } else { DILATATION_CAP }, self.area_of(to, corners))
        })
    }

    /// [`Layout::quality`] of the map that is linear on the faces of the surface as it came ([`Layout::on_input`]); `None` if the cut does
    /// not run along their edges. `lengths`: of these edges in E².
    ///
    /// # Errors
    /// [`Error::Size`], [`Error::EdgeLength`], [`Error::TriangleInequality`] of the lengths.
    pub fn quality_on_input(&self, lengths: &PerEdge<f64>) -> Result<Option<Quality>> {
        let (Some((input, _)), Some(on_input)) = (&self.input, self.on_input()) else { return Ok(None) };
        let corner = |h| on_input.points[on_input.corner_index[h] as usize];
        let quality = InputTriangles::new(input, lengths)?.quality(
            input,
            |f| f,
            |_| CORNERS,
            |f, from| self.linear_image(input.face_halfedges(f).map(corner), from),
        );
        quality.map(Some)
    }

    /// [`Layout::quality`] of the map that is linear on the faces of [`Layout::repaired_input`]. `lengths`: of the edges of the surface as
    /// it came, in E².
    ///
    /// # Errors
    /// [`Error::Size`], [`Error::EdgeLength`], [`Error::TriangleInequality`] of the lengths; [`Error::Layout`] where the cut does not run
    /// along the edges of the input.
    pub fn quality_of_repaired(&self, repaired: &RepairedInput, lengths: &PerEdge<f64>) -> Result<Quality> {
        let Some((input, _)) = &self.input else {
            return Err(Error::Layout("this layout is not cut along edges of the input".into()));
        };
        let (r, mesh) = (&repaired.refinement, repaired.mesh());
        let corner = |h| repaired.points[repaired.corner_index[h] as usize];
        InputTriangles::new(input, lengths)?.quality(
            mesh,
            |f| r.faces[0][f],
            |f| r.barycentric(0, f),
            |f, from| self.linear_image(mesh.face_halfedges(f).map(corner), from),
        )
    }

    /// The dilatation of the linear map of a triangle to points of the layout, and the area of its image.
    fn linear_image(&self, points: [u32; 3], from: TriangleCorners) -> (f64, f64) {
        let over = 1.0 / self.diameter;
        let points = points.map(|k| k as usize);
        let to = points.map(|k| self.coordinates[k].map(|x| x * over));
        (dilatation(from, to), self.area_of(to, points.map(|k| self.points[k])))
    }

    /// True if a piece and its image both have a shape that can be compared. The triangles of a mesh always have one, since they come from
    /// their lengths, but the corners of a subdivision's pieces are rounded. `to`: the image in E², divided by the diameter; `corners`: the
    /// image in ambient coordinates.
    fn can_compare(&self, from: TriangleCorners, to: TriangleCorners, corners: [Point; 3]) -> bool {
        let is_sound = || match self.space {
            Space::E2 => !TriangleFlatness::of(to).is_degenerate(largest_coordinate(&to).max(1.0)),
            Space::H2 if is_surely_upright(corners) => true,
            _ => {
                let (flatness, extent) =
                    TriangleFlatness::in_curved_space(corners, self.moved_to_origin(corners));
                flatness.orientation(extent) == TriangleOrientation::Upright
            }
        };
        self.common_subdivision().is_none()
            || (TriangleFlatness::of(from).relative_area > LEAST_RELATIVE_AREA && is_sound())
    }

    /// The area of a triangle: in E² from `to`, its coordinates divided by the diameter; elsewhere from its corners in ambient coordinates.
    fn area_of(&self, to: TriangleCorners, corners: [Point; 3]) -> f64 {
        match self.space {
            Space::E2 => 0.5 * doubled_area(to).abs(),
            Space::H2 if corners.iter().all(|p| p[2] < NEAR) => area_near(corners),
            space => {
                let p = self.moved_to_origin(corners);
                area(space, [[1, 2], [2, 0], [0, 1]].map(|[i, j]| distance(space, p[i], p[j])))
            }
        }
    }
}

impl Quality {
    /// The distortion of the linear maps from the pieces of a subdivision to triangles in space with corners on the unit sphere. `input`:
    /// the triangulation that is refined; `lengths`: of its edges in E²; `corners`: those of a piece's image, in its corner order.
    ///
    /// Degenerate pieces are those whose relative area is at most [`LEAST_RELATIVE_AREA`] on either side, and those whose image is so small
    /// that rounding of positions shows in its shape.
    ///
    /// # Errors
    /// [`Error::Size`], [`Error::EdgeLength`], [`Error::TriangleInequality`] of the input lengths.
    pub fn on_sphere(
        subdivision: &CommonSubdivision,
        input: &Mesh,
        lengths: &PerEdge<f64>,
        corners: impl Fn(FaceId) -> [Point; 3] + Sync,
    ) -> Result<Quality> {
        let (face, weights) = (|f| subdivision.faces[0][f], |f| subdivision.barycentric(0, f));
        InputTriangles::new(input, lengths)?.quality(&subdivision.mesh, face, weights, |f, from| {
            let [a, b, c] = corners(f);
            let sides = [[b, c], [c, a], [a, b]].map(|[p, q]| vector::distance(p, q));
            let (to, _) = in_plane(sides, CORNERS);
            let (before, after) = (TriangleFlatness::of(from), TriangleFlatness::of(to));
            let is_sound = before.relative_area.min(after.relative_area) > LEAST_RELATIVE_AREA
                && after.longest >= LEAST_EDGE_ON_SPHERE;
            let dilatation = if is_sound { dilatation(from, to) } else { DILATATION_CAP };
            (dilatation, 0.5 * doubled_area(to).abs())
        })
    }
}

/// Largest cosh of the distance from the origin at which the area of a triangle in H² is computed without a move to the origin: products of
/// three coordinates then lose at most 4 digits against those of the triangle's sides.
const NEAR: f64 = 16.0;

/// The area of a triangle in H² from its corners p, q, r on the hyperboloid: `tan(area/2) = |det(p, q, r)| / (1 − ⟨p, q⟩ − ⟨q, r⟩ − ⟨r,
/// p⟩)`.
fn area_near([p, q, r]: [Point; 3]) -> f64 {
    let (a, b) = (vector::sub(q, p), vector::sub(r, p));
    let form = |p: Point, q: Point| p[2] * q[2] - p[0] * q[0] - p[1] * q[1];
    let det = vector::dot(p, vector::cross(a, b)).abs();
    2.0 * det.atan2(1.0 + form(p, q) + form(q, r) + form(r, p))
}

impl Quality {
    /// The distortion of texture coordinates: of the linear maps from triangles in space to triangles in the plane. `faces`: F triples of
    /// indices into `positions`; `uv`: F triples of points of the plane, those of the corners. A triangle that is turned over counts with
    /// the dilatation of its mirror image.
    ///
    /// # Errors
    /// [`Error::Size`] where there are fewer positions than the faces name, or another number of texture coordinates.
    pub fn of_texture(positions: &[Point], faces: &[[u32; 3]], uv: &[[[f64; 2]; 3]]) -> Result<Quality> {
        check_size("texture coordinates", uv.len(), faces.len())?;
        let need = faces.as_flattened().iter().map(|&v| v as usize + 1).fold(0, usize::max);
        check_size("positions", positions.len().min(need), need)?;
        // Units in which the longest side is 1 keep areas from over- and underflow.
        let side = |f: &[u32; 3], [i, j]: [usize; 2]| {
            vector::norm(vector::sub(positions[f[i] as usize], positions[f[j] as usize]))
        };
        let sides = |f: &[u32; 3]| [[1, 2], [2, 0], [0, 1]].map(|ends| side(f, ends));
        let longest = faces.iter().flat_map(sides).fold(f64::MIN_POSITIVE, f64::max);
        let extent = largest_coordinate(uv.as_flattened()).max(f64::MIN_POSITIVE);
        let (mut qc, mut areas) = (vec![DILATATION_CAP; faces.len()], vec![[0.0; 2]; faces.len()]);
        parallel::fill_both(&mut qc, &mut areas, |f| {
            // The excess is that of rounding: the sides are those of a triangle.
            let (from, _) = in_plane(sides(&faces[f]).map(|l| l / longest), CORNERS);
            let to = uv[f].map(|p| p.map(|x| x / extent));
            (dilatation(from, to), [from, to].map(|t| 0.5 * doubled_area(t).abs()))
        });
        Ok(summary(qc.into(), &areas.into()))
    }
}

/// The triangles of the surface as it came, with the lengths of their edges.
struct InputTriangles<'a> {
    mesh: &'a Mesh,
    lengths: &'a PerEdge<f64>,
    /// The longest edge, the unit of all lengths, so that areas neither over- nor underflow.
    unit: f64,
}

impl<'a> InputTriangles<'a> {
    fn new(mesh: &'a Mesh, lengths: &'a PerEdge<f64>) -> Result<Self> {
        check_lengths(mesh, lengths)?;
        Ok(InputTriangles { mesh, lengths, unit: lengths.iter().copied().fold(0.0, f64::max) })
    }

    /// The sides of a face, in units of the longest edge.
    fn sides(&self, f: FaceId) -> [f64; 3] {
        self.mesh.opposite_edges(f).map(|e| self.lengths[e] / self.unit)
    }

    /// The quality of a map of pieces. `face`: the input face of a piece; `weights`: the barycentric weights of the piece's corners in it;
    /// `image`: the dilatation of a piece with these corners in the plane, and the area of its image.
    fn quality(
        &self,
        pieces: &Mesh,
        face: impl Fn(FaceId) -> FaceId + Sync,
        weights: impl Fn(FaceId) -> [[f64; 3]; 3] + Sync,
        image: impl Fn(FaceId, TriangleCorners) -> (f64, f64) + Sync,
    ) -> Result<Quality> {
        let need = pieces.faces().map(|f| face(f).index() + 1).fold(0, usize::max);
        check_size("input faces", self.mesh.n_faces().min(need), need)?;
        let (mut qc, mut areas) = (vec![DILATATION_CAP; pieces.n_faces()], vec![[0.0; 2]; pieces.n_faces()]);
        // A negative dilatation stands for the excess by which the triangle inequality is broken.
        parallel::fill_both(&mut qc, &mut areas, |f| {
            let (from, excess) = in_plane(self.sides(face(f.into())), weights(f.into()));
            if excess > 0.0 {
                return (-excess, [0.0; 2]);
            }
            let (dilatation, area) = image(f.into(), from);
            (dilatation, [0.5 * doubled_area(from).abs(), area])
        });
        if let Some(f) = qc.iter().position(|&qc| qc < 0.0) {
            return Err(Error::TriangleInequality { face: face(f.into()).index(), excess: -qc[f] });
        }
        Ok(summary(qc.into(), &areas.into()))
    }
}

/// Points of a plane triangle with these sides, from the barycentric weights of the points, and [`PlaneTriangle::excess`]. The corner
/// opposite the longest side lies at the origin, since there the edges of a needle are far from parallel.
fn in_plane(sides: [f64; 3], weights: [[f64; 3]; 3]) -> (TriangleCorners, f64) {
    let k = longest_side(sides);
    let (i, j) = ((k + 1) % 3, (k + 2) % 3);
    let (direction, excess) = PlaneTriangle::direction_at(sides, k);
    let side = direction.map(|x| sides[i] * x);
    (weights.map(|w| [w[i] * sides[j] + w[j] * side[0], w[j] * side[1]]), excess)
}

fn longest_side(sides: [f64; 3]) -> usize {
    (0..3).fold(0, |k, i| if sides[i] > sides[k] { i } else { k })
}

/// The quality with these dilatations and areas `[input, layout]` per face.
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
    let mut energy = 0.0;
    let mut degenerate = Vec::new();
    for (f, (&qc, (area, &ratio))) in qc.iter().zip(areas.iter().zip(&area_ratio)).enumerate() {
        if qc >= DILATATION_CAP {
            degenerate.push(FaceId::from(f));
            continue;
        }
        (weight, sum) = (weight + area[0], sum + area[0] * qc);
        // σ² and τ² are the area's ratio times K and over K.
        energy += area[0] * (ratio * qc + ratio / qc + 1.0 / (ratio * qc) + qc / ratio);
        (most, ratios) = (most.max(qc), [ratios[0].min(ratio), ratios[1].max(ratio)]);
    }
    let is_any = degenerate.len() < qc.len();
    let or_one = |x: f64| if is_any { x } else { 1.0 };
    Quality {
        qc_mean: if weight > 0.0 { sum / weight } else { 1.0 },
        symmetric_dirichlet: if weight > 0.0 { (energy / weight).min(f64::MAX) } else { 4.0 },
        qc_max: or_one(most),
        area_ratio_min: or_one(ratios[0]),
        area_ratio_max: or_one(ratios[1]),
        qc,
        area_ratio: area_ratio.into(),
        degenerate,
    }
}

/// The dilatation of the linear map between two triangles.
///
/// With edge vectors P, P′ from one corner and their images Q, Q′ as complex numbers, the map is `z ↦ αz + βz̄` with `α ∝ Q P̄′ − Q′ P̄`
/// and `β ∝ Q P′ − Q′ P`, and `K = (|α| + |β|) / ||α| − |β|| = (|α| + |β|)² / (16 A A′)`: the areas are computed directly, so nothing
/// cancels when K is large. The corner is the one opposite the longest side, where a needle's edge vectors are far from parallel.
fn dilatation(from: TriangleCorners, to: TriangleCorners) -> f64 {
    let k = longest_side([[1, 2], [2, 0], [0, 1]].map(|[i, j]| norm2(sub(from[i], from[j]))));
    let (i, j) = ((k + 1) % 3, (k + 2) % 3);
    let vectors = |t: TriangleCorners| [sub(t[i], t[k]), sub(t[j], t[k])];
    let ([p, q], [p_image, q_image]) = (vectors(from), vectors(to));
    let found = if [p, q, p_image, q_image].iter().all(|&z| USUAL_SQUARES.contains(&norm2(z))) {
        dilatation_of_sides([p, q], [p_image, q_image])
    } else {
        // Scaling by the lengths makes products of sides of very different lengths representable.
        let size = [p, q].map(quick_norm);
        let scaled = |sides: [Complex; 2]| [0, 1].map(|k| sides[k].map(|x| x / size[k]));
        dilatation_of_sides(scaled([p, q]), scaled([p_image, q_image]))
    };
    if found.is_finite() { found.clamp(1.0, DILATATION_CAP) } else { DILATATION_CAP }
}

/// Range of squares of lengths in which no product of four lengths over- or underflows.
const USUAL_SQUARES: RangeInclusive<f64> = 1e-60..=1e60;

/// The dilatation of the linear map that takes two sides to their images; not finite if a triangle has no area.
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
    fn texture_coordinates_have_the_dilatation_and_the_areas_of_their_linear_maps() {
        let positions = [[0.0, 0.0, 7.0], [3.0, 0.0, 7.0], [0.0, 4.0, 7.0], [3.0, 4.0, 7.0], [6.0, 8.0, 7.0]];
        let faces = [[0, 1, 2], [1, 3, 2], [0, 3, 4]];
        // The first face twice as wide, the second as it is and turned over, the third without area in both.
        let uv = [
            [[0.0, 0.0], [6.0, 0.0], [0.0, 4.0]],
            [[0.0, 0.0], [0.0, 4.0], [3.0, 4.0]],
            [[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]],
        ];
        let found = Quality::of_texture(&positions, &faces, &uv).unwrap();
        for (f, qc, ratio) in [(0, 2.0, 4.0 / 3.0), (1, 1.0, 2.0 / 3.0)] {
            let f = FaceId(f);
            assert!(
                (found.qc[f] - qc).abs() < 1e-12 && (found.area_ratio[f] - ratio).abs() < 1e-12,
                "{found:?}"
            );
        }
        assert_eq!((found.degenerate, found.area_ratio[FaceId(2)]), (vec![FaceId(2)], 1.0));
        assert!(matches!(
            Quality::of_texture(&positions, &faces, &uv[1..]),
            Err(Error::Size { expected: 3, .. })
        ));
        assert!(matches!(
            Quality::of_texture(&positions[..3], &faces, &uv),
            Err(Error::Size { expected: 5, .. })
        ));
    }

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
