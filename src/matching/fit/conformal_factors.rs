//! The conformal factor of a map at the vertices, from the areas around them.

use crate::geometry::triangle;
use crate::mesh::FaceId;
use crate::metric::Surface;
use crate::metric::lengths::face_lengths;

/// Conformal factors of a map with their weights.
pub(crate) struct ConformalFactors {
    /// Per vertex: `½ log` of the area around it on the surface over that of the image, both as shares of the totals.
    pub values: Vec<f64>,
    /// Per vertex: its share of the surface's area.
    pub weights: Vec<f64>,
}

/// The factors of a map, given the area of the image of every face.
pub(crate) fn factors(surface: &Surface, image: impl Fn(FaceId) -> f64) -> ConformalFactors {
    let mesh = surface.mesh();
    let mut areas = vec![[0.0f64; 2]; mesh.n_vertices()];
    for f in mesh.faces() {
        let own = triangle::area(surface.geometry(), face_lengths(mesh, surface.lengths(), f));
        let image = image(f);
        for v in mesh.face_vertices(f) {
            let [a, b] = &mut areas[v.index()];
            (*a, *b) = (*a + own / 3.0, *b + image / 3.0);
        }
    }
    let totals = [0, 1].map(|k| areas.iter().map(|a| a[k]).sum::<f64>().max(f64::MIN_POSITIVE));
    let share = |a: &[f64; 2], k: usize| a[k] / totals[k];
    let log = |x: f64| x.max(f64::MIN_POSITIVE).ln();
    ConformalFactors {
        values: areas.iter().map(|a| 0.5 * (log(share(a, 0)) - log(share(a, 1)))).collect(),
        weights: areas.iter().map(|a| share(a, 0)).collect(),
    }
}
