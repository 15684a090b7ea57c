//! A triangle of the surface and its linear map to the plane: the energy, its gradient and its Hessian in the places of the corners.

use super::energy::{EnergyShares, EnergySlopes};
use crate::error::{Error, Result};
use crate::geometry::complex::{Complex, cross, norm, norm2, sub};
use crate::geometry::plane_triangle::PlaneTriangle;
use crate::mesh::{EdgeId, FaceId};
use crate::metric::Surface;
use crate::parallel;

/// The triangle as it is on the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct RestTriangle {
    /// Per corner the gradient of the function that is 1 there and 0 at the others.
    pub gradient: [[f64; 2]; 3],
    /// 1 over twice the area.
    pub inverse: f64,
    /// The corner opposite the longest side, where a needle's sides are far from parallel.
    pub wide: usize,
    /// The share of the surface's area.
    pub share: f64,
    /// The weight in the energy: the share times the weight that the caller gives, of weights with the sum 1.
    pub weight: f64,
}

/// The linear map of a triangle: `F = U diag(σ, τ) Vᵀ` with two rotations, each as the cosine and sine of its angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct TriangleMap {
    pub singular: [f64; 2],
    left: Complex,
    right: Complex,
}

/// The gradient of a triangle's energy in x and y of its three corners, and the lower triangle of the Hessian by rows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct TriangleModel {
    pub gradient: [f64; 6],
    pub hessian: [f64; 21],
}

impl RestTriangle {
    /// The triangle with these sides, side k opposite corner k; `None` if it has no area in doubles. The share and the weight are set later.
    pub fn new(sides: [f64; 3]) -> Option<RestTriangle> {
        let longest = (0..3).fold(0, |k, i| if sides[i] > sides[k] { i } else { k });
        let (i, j) = ((longest + 1) % 3, (longest + 2) % 3);
        let (direction, _) = PlaneTriangle::direction_at(sides, longest);
        let mut corner = [[0.0; 2]; 3];
        (corner[i], corner[j]) = ([sides[j], 0.0], direction.map(|x| sides[i] * x));
        let doubled = sides[j] * corner[j][1];
        let gradient = [0, 1, 2].map(|k| {
            let [x, y] = sub(corner[(k + 2) % 3], corner[(k + 1) % 3]);
            [-y / doubled, x / doubled]
        });
        let rest = RestTriangle { gradient, inverse: 1.0 / doubled, wide: longest, share: 0.0, weight: 0.0 };
        gradient.as_flattened().iter().all(|x| x.is_finite()).then_some(rest)
    }

    /// ‖F‖² and det F of the map with these corners.
    pub fn square_and_det(&self, corners: [[f64; 2]; 3]) -> [f64; 2] {
        let f = self.matrix(corners);
        [norm2(f[0]) + norm2(f[1]), self.det(corners)]
    }

    /// The sides that leave the wide corner.
    fn sides(&self, corners: [[f64; 2]; 3]) -> [[f64; 2]; 2] {
        let k = self.wide;
        [1, 2].map(|i| sub(corners[(k + i) % 3], corners[k]))
    }

    /// The matrix of the map to these corners.
    pub fn matrix(&self, corners: [[f64; 2]; 3]) -> [[f64; 2]; 2] {
        let [p, q] = self.sides(corners);
        let [g, h] = [1, 2].map(|i| self.gradient[(self.wide + i) % 3]);
        [0, 1].map(|row| [0, 1].map(|column| p[row] * g[column] + q[row] * h[column]))
    }

    /// The determinant, as the ratio of areas.
    fn det(&self, corners: [[f64; 2]; 3]) -> f64 {
        let [p, q] = self.sides(corners);
        cross(p, q) * self.inverse
    }

    /// The map with these corners.
    pub fn map(&self, corners: [[f64; 2]; 3]) -> TriangleMap {
        let [[a, b], [c, d]] = self.matrix(corners);
        // F is |z| times a rotation plus |w| times a reflection.
        let (z, w) = ([0.5 * (a + d), 0.5 * (c - b)], [0.5 * (a - d), 0.5 * (c + b)]);
        let (turn, mirror) = (z[1].atan2(z[0]), w[1].atan2(w[0]));
        let [left, right] = [0.5 * (turn + mirror), 0.5 * (turn - mirror)].map(|angle| {
            let (sin, cos) = angle.sin_cos();
            [cos, sin]
        });
        let large = norm(z) + norm(w);
        TriangleMap { singular: [large, self.det(corners) / large], left, right }
    }

    /// The energy of a map.
    pub fn energy(&self, shares: &EnergyShares, corners: [[f64; 2]; 3]) -> f64 {
        let [square, det] = self.square_and_det(corners);
        self.weight * shares.value(square, det)
    }

    /// The gradient and the Hessian of the energy; where `clamped`, with its negative eigenvalues replaced by 0.
    pub fn model(&self, shares: &EnergyShares, corners: [[f64; 2]; 3], clamped: bool) -> TriangleModel {
        let map = self.map(corners);
        let slopes = shares.slopes(map.singular);
        // The gradients of the corners' functions in the frame of the singular vectors.
        let [cos, sin] = map.right;
        let hats = self.gradient.map(|[x, y]| [cos * x - sin * y, sin * x + cos * y]);
        let to_plane = |[x, y]: [f64; 2]| {
            let [cos, sin] = map.left;
            [cos * x - sin * y, sin * x + cos * y]
        };
        let along = |part: &dyn Fn([f64; 2]) -> [f64; 2]| {
            let [a, b, c] = hats.map(|hat| to_plane(part(hat)));
            [a[0], a[1], b[0], b[1], c[0], c[1]]
        };
        let gradient = along(&|[x, y]| [slopes.slope[0] * x, slopes.slope[1] * y]).map(|x| self.weight * x);
        let mut model = TriangleModel { gradient, hessian: [0.0; 21] };
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let mut add = |value: f64, part: &dyn Fn([f64; 2]) -> [f64; 2]| {
            let value = self.weight * if clamped { value.max(0.0) } else { value };
            if value != 0.0 {
                model.add_square(value, along(part));
            }
        };
        let ([more, less], [cos, sin]) = stretches(&slopes);
        add(more, &|[x, y]| [cos * x, sin * y]);
        add(less, &|[x, y]| [-sin * x, cos * y]);
        add(slopes.turn, &|[x, y]| [-half * y, half * x]);
        add(slopes.shear, &|[x, y]| [half * y, half * x]);
        model
    }
}

impl TriangleModel {
    /// Adds value · v vᵀ to the lower triangle of the Hessian.
    pub fn add_square(&mut self, value: f64, v: [f64; 6]) {
        let mut k = 0;
        for i in 0..6 {
            for j in 0..=i {
                self.hessian[k] += value * v[i] * v[j];
                k += 1;
            }
        }
    }
}

/// The triangles of the surface, with lengths in this unit. `weights`: a factor per face, or none.
///
/// # Errors
/// [`Error::Layout`] for a triangle without area.
pub(super) fn rest_triangles(surface: &Surface, unit: f64, weights: &[f64]) -> Result<Vec<RestTriangle>> {
    let mesh = surface.mesh();
    let sides = |f: FaceId| mesh.opposite_edges(f).map(|e: EdgeId| surface.lengths()[e] / unit);
    let mut found = vec![None; mesh.n_faces()];
    parallel::fill(&mut found, |f| RestTriangle::new(sides(f.into())));
    let mut rest = Vec::with_capacity(found.len());
    for (f, triangle) in found.into_iter().enumerate() {
        let none = || {
            Error::Layout(format!("face {f} of the surface has no area: weld or remesh it (`ricci repair`)"))
        };
        rest.push(triangle.ok_or_else(none)?);
    }
    let total: f64 = rest.iter().map(|rest| rest.inverse.recip()).sum();
    rest.iter_mut().for_each(|rest| rest.share = rest.inverse.recip() / total);
    rest.iter_mut().for_each(|rest| rest.weight = rest.share);
    if !weights.is_empty() {
        let weighted: f64 = rest.iter().zip(weights).map(|(rest, weight)| weight * rest.share).sum();
        rest.iter_mut().zip(weights).for_each(|(rest, weight)| rest.weight = weight * rest.share / weighted);
    }
    Ok(rest)
}

/// The eigenvalues of the Hessian in the singular values, and the unit vector of the first.
fn stretches(slopes: &EnergySlopes) -> ([f64; 2], [f64; 2]) {
    let [first, mixed, second] = slopes.second;
    if mixed == 0.0 {
        return ([first, second], [1.0, 0.0]);
    }
    let (mean, apart) = (0.5 * (first + second), 0.5 * (first - second));
    let radius = apart.hypot(mixed);
    let (sin, cos) = (0.5 * mixed.atan2(apart)).sin_cos();
    ([mean + radius, mean - radius], [cos, sin])
}
