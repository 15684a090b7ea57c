//! How far the metric that a scheme starts from lies from the surface: circle packings cannot represent every metric.
//!
//! ```
//! # use ricci::{Class, Surface, geometry::Space, mesh::shapes, metric::Scheme};
//! let torus = Surface::from_soup(&shapes::torus(2.0, 1.0, 24, 12)?)?;
//! let far = |scheme| torus.initial(Class::new(scheme, Space::E2)).map(|initial| initial.distance);
//! assert_eq!(far(Scheme::Inversive)?.max_dilatation, 1.0);
//! assert!(far(Scheme::Tangential)?.max_dilatation > 1.1);
//! # Ok::<(), ricci::Error>(())
//! ```

use super::lengths::face_lengths;
use crate::archive::stored;
use crate::geometry::triangle::half_differences;
use crate::mesh::{EdgeId, FaceId, Mesh, PerEdge, PerFace};
use crate::parallel;

/// Mean dilatation above which the start counts as another surface: moduli and angles are then off by several percent at any refinement.
const FAR_MEAN: f64 = 1.02;
/// Dilatation of a single face above which the start counts as another surface: circles become ellipses twice as long as wide.
const FAR_MAX: f64 = 2.0;
/// The dilatation of a face without area in one of the metrics; f64s resolve no larger one.
const LARGEST: f64 = 1.0 / f64::EPSILON;

/// The distance of the metric that a scheme starts from, in the geometry of the input, from the lengths of the surface, and the dilatation of
/// the maps from the surface's triangles to those of the start. A flow is conformal to its start: this dilatation stays, whatever the
/// flow does, and refining the surface does not lower it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SchemeDistance {
    /// Largest |log(length of the start / length on the surface)|.
    pub max_log_length: f64,
    /// The mean of that over the sides of the faces.
    pub mean_log_length: f64,
    /// The edge where it is largest; none if no length differs.
    pub edge: Option<EdgeId>,
    /// Largest dilatation of a face, ≥ 1: that of the linear map between the plane triangles with these sides.
    pub max_dilatation: f64,
    /// The mean dilatation, weighed with the areas on the surface.
    pub mean_dilatation: f64,
    /// The face where it is largest; none if no length differs.
    pub face: Option<FaceId>,
}
stored!(sections SchemeDistance { max_log_length, mean_log_length, edge, max_dilatation, mean_dilatation,
    face });

impl Default for SchemeDistance {
    /// No distance: the start is the surface's own metric.
    fn default() -> Self {
        SchemeDistance {
            max_log_length: 0.0,
            mean_log_length: 0.0,
            edge: None,
            max_dilatation: 1.0,
            mean_dilatation: 1.0,
            face: None,
        }
    }
}

impl SchemeDistance {
    /// The distance of the lengths of a start from those of the surface, both positive.
    pub(super) fn between(mesh: &Mesh, surface: &PerEdge<f64>, start: &PerEdge<f64>) -> SchemeDistance {
        let change = |e: EdgeId| (start[e] / surface[e]).ln().abs();
        let edge = mesh.edges().max_by(|&a, &b| change(a).total_cmp(&change(b)).then(b.cmp(&a)));
        let mut of_faces = vec![[0.0; 3]; mesh.n_faces()];
        parallel::fill(&mut of_faces, |f| {
            let f = FaceId::from(f);
            let [from, to] = [surface, start].map(|lengths| face_lengths(mesh, lengths, f));
            let (dilatation, area) = dilatation(from, to);
            let sides = mesh.opposite_edges(f).into_iter().map(change).sum::<f64>();
            [dilatation, area, sides]
        });
        let of_faces: PerFace<[f64; 3]> = of_faces.into();
        let total = |value: fn(&[f64; 3]) -> f64| of_faces.iter().map(value).sum::<f64>();
        let face = mesh.faces().max_by(|&a, &b| of_faces[a][0].total_cmp(&of_faces[b][0]).then(b.cmp(&a)));
        let area = total(|[_, area, _]| *area);
        SchemeDistance {
            max_log_length: edge.map_or(0.0, change),
            mean_log_length: total(|[_, _, sides]| *sides) / (3 * mesh.n_faces().max(1)) as f64,
            edge,
            max_dilatation: face.map_or(1.0, |f| of_faces[f][0]),
            mean_dilatation: if area > 0.0 { total(|[k, area, _]| k * area) / area } else { 1.0 },
            face,
        }
    }

    /// True if results belong to another conformal structure than the surface's for all practical purposes.
    pub fn is_far(&self) -> bool {
        self.mean_dilatation > FAR_MEAN || self.max_dilatation > FAR_MAX
    }
}

/// The dilatation K of the linear map between the plane triangles with these sides, and the area of the first one.
///
/// Half the Dirichlet energy of the map over the area A′ of its image is `Σ cot θ_k l′_k² / (2 A′) = K + 1/K`; with the half-perimeter
/// differences r and their sum s, `cot θ_k = (s r_k − r_i r_j)/(2 A)`.
fn dilatation(from: [f64; 3], to: [f64; 3]) -> (f64, f64) {
    let longest = |l: [f64; 3]| l.into_iter().fold(0.0, f64::max);
    let (size, image_size) = (longest(from), longest(to));
    let [r, image_r] =
        [(from, size), (to, image_size)].map(|(l, unit)| half_differences(l.map(|x| x / unit)));
    let [area, image_area] = [r, image_r].map(|r| {
        let s = r[0] + r[1] + r[2];
        (s * r[0].max(0.0) * r[1].max(0.0) * r[2].max(0.0)).sqrt()
    });
    let s = r[0] + r[1] + r[2];
    let energy: f64 =
        (0..3).map(|k| (s * r[k] - r[(k + 1) % 3] * r[(k + 2) % 3]) * (to[k] / image_size).powi(2)).sum();
    let x = energy / (8.0 * area * image_area);
    let k = if x.is_finite() { x + (x * x - 1.0).max(0.0).sqrt() } else { LARGEST };
    (k.clamp(1.0, LARGEST), area * size * size)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stretched_triangles_have_the_dilatation_of_the_stretch() {
        let triangle = [[0.0, 0.0], [1.3, 0.2], [0.4, 0.9f64]];
        let sides = |stretch: [f64; 2]| {
            let p = triangle.map(|[x, y]| [stretch[0] * x, stretch[1] * y]);
            [[1, 2], [2, 0], [0, 1]].map(|[i, j]: [usize; 2]| (p[i][0] - p[j][0]).hypot(p[i][1] - p[j][1]))
        };
        for (stretch, k) in [([1.0, 1.0], 1.0), ([3.0, 1.0], 3.0), ([0.25, 2.0], 8.0), ([7e3, 7e-1], 1e4)] {
            let (found, area) = dilatation(sides([1.0, 1.0]), sides(stretch));
            assert!((found / k - 1.0).abs() < 1e-7, "{stretch:?}: {found}");
            assert!((area - 0.545).abs() < 1e-12, "{area}");
        }
        assert_eq!(dilatation([1.0, 1.0, 1.0], [1.0, 1.0, 2.0]).0, LARGEST);
    }
}
