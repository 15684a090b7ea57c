//! A triangle of the surface and its map to the unit sphere: the energy, its gradient and its Hessian in tangential steps of the corners.
//!
//! The map is linear to the flat triangle of the three points, with ‖F‖² as there. Its determinant is taken from the triangle's area as seen
//! along the sum s of the points: `det F = 3 det(a, b, c)/(|s| · 2A)` with the area A on the surface, which for small triangles is the ratio of
//! areas to the second order, and which vanishes exactly where the points come to lie on a great circle.

use super::energy::EnergyShares;
use super::rest_triangle::{RestTriangle, TriangleModel};
use crate::geometry::vector::{Vector, add, cross, dot, norm, normalised, scale, sub};
use nalgebra::{SMatrix, SymmetricEigen};

/// A softened determinant, which lets triangles be turned over: `(j + √(j² + ε²))/2` \[GKKPR21\]; j itself for ε = 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SoftDet {
    pub softness: f64,
}

impl SoftDet {
    fn value(self, j: f64) -> f64 {
        if self.softness == 0.0 {
            return j;
        }
        let root = j.hypot(self.softness);
        // Without cancellation on either side of 0.
        if j > 0.0 { 0.5 * (j + root) } else { 0.5 * self.softness * self.softness / (root - j) }
    }

    /// The value and the first two derivatives.
    fn jet(self, j: f64) -> [f64; 3] {
        if self.softness == 0.0 {
            return [j, 1.0, 0.0];
        }
        let (value, root) = (self.value(j), j.hypot(self.softness));
        [value, value / root, 0.5 * self.softness * self.softness / root.powi(3)]
    }
}

/// The two tangents at a point of the unit sphere that steps are made along.
pub(super) fn tangents(x: Vector) -> [Vector; 2] {
    let least = (0..3).fold(0, |k, i| if x[i].abs() < x[k].abs() { i } else { k });
    let mut axis = [0.0; 3];
    axis[least] = 1.0;
    let first = normalised(cross(axis, x));
    [first, cross(x, first)]
}

fn det(a: Vector, b: Vector, c: Vector) -> f64 {
    dot(a, cross(sub(b, a), sub(c, a)))
}

impl RestTriangle {
    /// The columns of the map to the triangle of three points.
    fn columns(&self, x: [Vector; 3]) -> [Vector; 2] {
        let k = self.wide;
        let [i, j] = [(k + 1) % 3, (k + 2) % 3];
        let (p, q) = (sub(x[i], x[k]), sub(x[j], x[k]));
        [0, 1].map(|c| add(scale(self.gradient[i][c], p), scale(self.gradient[j][c], q)))
    }

    /// ‖F‖² and det F of the map to these points of the sphere.
    pub fn sphere_square_and_det(&self, x: [Vector; 3]) -> [f64; 2] {
        let [u, v] = self.columns(x);
        let k = self.wide;
        let (p, q) = (sub(x[(k + 1) % 3], x[k]), sub(x[(k + 2) % 3], x[k]));
        let sum = add(add(x[0], x[1]), x[2]);
        [dot(u, u) + dot(v, v), dot(cross(p, q), sum) / norm(sum) * self.inverse]
    }

    /// The energy of a map; infinite for a triangle that is turned over, unless the determinant is softened.
    pub fn sphere_energy(&self, shares: &EnergyShares, soft: SoftDet, x: [Vector; 3]) -> f64 {
        let [q, j] = self.sphere_square_and_det(x);
        self.weight * shares.value(q, soft.value(j))
    }

    /// The gradient and the Hessian in steps along the tangents of the corners, which then return to the sphere; where `clamped`, with the
    /// negative eigenvalues of the Hessian replaced by 0.
    pub fn sphere_model(
        &self,
        shares: &EnergyShares,
        soft: SoftDet,
        x: [Vector; 3],
        clamped: bool,
    ) -> TriangleModel {
        let parts = SphereParts::new(self, x);
        let [q, j] = self.sphere_square_and_det(x);
        let [chi, first, second] = soft.jet(j);
        let [in_q, in_chi, in_both, twice] = shares.slopes_in_square_and_det(q, chi);
        let slopes = [in_q, in_chi * first, in_both * first, twice * first * first + in_chi * second];
        let gradient: [f64; 6] =
            std::array::from_fn(|i| self.weight * (slopes[0] * parts.square[i] + slopes[1] * parts.det[i]));
        let whole = SMatrix::<f64, 6, 6>::from_fn(|i, k| self.weight * parts.second(self, slopes, i, k));
        let hessian = if clamped { without_negative(whole) } else { whole };
        let mut lower = [0.0; 21];
        let pairs = (0..6).flat_map(|i| (0..=i).map(move |k| (i, k)));
        lower.iter_mut().zip(pairs).for_each(|(value, (i, k))| *value = hessian[(i, k)]);
        TriangleModel { gradient, hessian: lower }
    }
}

/// The symmetric matrix with its negative eigenvalues replaced by 0.
fn without_negative(matrix: SMatrix<f64, 6, 6>) -> SMatrix<f64, 6, 6> {
    let SymmetricEigen { eigenvectors, eigenvalues } = SymmetricEigen::new(matrix);
    let mut whole = SMatrix::<f64, 6, 6>::zeros();
    for (k, &value) in eigenvalues.iter().enumerate().filter(|(_, value)| **value > 0.0) {
        let v = eigenvectors.column(k);
        whole += v * v.transpose() * value;
    }
    whole
}

/// First derivatives of ‖F‖² and det F along the six tangents, and what second ones are made of.
struct SphereParts {
    x: [Vector; 3],
    tangent: [Vector; 6],
    square: [f64; 6],
    det: [f64; 6],
    /// Derivatives of det(a, b, c) and of |a + b + c|, these two, and `3/2A`.
    volume: [f64; 6],
    along: [f64; 6],
    whole: f64,
    length: f64,
    factor: f64,
    /// x · ∂/∂x of ‖F‖² and of det F at each corner.
    radial: [[f64; 2]; 3],
}

impl SphereParts {
    fn new(rest: &RestTriangle, x: [Vector; 3]) -> SphereParts {
        let (columns, sum) = (rest.columns(x), add(add(x[0], x[1]), x[2]));
        let (length, factor, whole) = (norm(sum), 3.0 * rest.inverse, det(x[0], x[1], x[2]));
        let middle = scale(1.0 / length, sum);
        let tangent: [Vector; 6] = std::array::from_fn(|i| tangents(x[i / 2])[i % 2]);
        // 2 F g of each corner's function.
        let pull = rest.gradient.map(|[g, h]| scale(2.0, add(scale(g, columns[0]), scale(h, columns[1]))));
        let normal = [0, 1, 2].map(|k| {
            let (b, c) = (x[(k + 1) % 3], x[(k + 2) % 3]);
            cross(b, sub(c, b))
        });
        let volume: [f64; 6] = std::array::from_fn(|i| dot(normal[i / 2], tangent[i]));
        let along: [f64; 6] = std::array::from_fn(|i| dot(middle, tangent[i]));
        let slope = |volume: f64, along: f64| factor * (volume / length - whole * along / (length * length));
        SphereParts {
            x,
            tangent,
            square: std::array::from_fn(|i| dot(pull[i / 2], tangent[i])),
            det: std::array::from_fn(|i| slope(volume[i], along[i])),
            volume,
            along,
            whole,
            length,
            factor,
            radial: [0, 1, 2].map(|k| [dot(pull[k], x[k]), slope(whole, dot(middle, x[k]))]),
        }
    }

    /// The second derivative of the energy along two tangents, from its slopes in ‖F‖², in det F, in both, and twice in det F.
    fn second(&self, rest: &RestTriangle, slopes: [f64; 4], i: usize, j: usize) -> f64 {
        let (k, l) = (i / 2, j / 2);
        let turned = dot(self.tangent[i], self.tangent[j]);
        let hats = rest.gradient[k][0] * rest.gradient[l][0] + rest.gradient[k][1] * rest.gradient[l][1];
        let volume = if k == l {
            0.0
        } else {
            let mut x = self.x;
            (x[k], x[l]) = (self.tangent[i], self.tangent[j]);
            dot(x[0], cross(x[1], x[2]))
        };
        let (s, along) = (self.length, self.along[i] * self.along[j]);
        let mixed = self.volume[i] * self.along[j] + self.along[i] * self.volume[j];
        let det =
            self.factor * (volume / s - mixed / (s * s) + self.whole * (3.0 * along - turned) / (s * s * s));
        let [in_q, in_j, in_both, twice] = slopes;
        let both = self.square[i] * self.det[j] + self.det[i] * self.square[j];
        let flat =
            in_q * 2.0 * hats * turned + in_j * det + in_both * both + twice * self.det[i] * self.det[j];
        // A step returns to the sphere, which is shorter by half of its square.
        let inward = if i == j { in_q * self.radial[k][0] + in_j * self.radial[k][1] } else { 0.0 };
        flat - inward
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SHARES: EnergyShares = EnergyShares { isometric: 0.6, conformal: 0.3, area: 0.1, arap: 0.0 };

    fn triangle() -> (RestTriangle, [Vector; 3]) {
        let rest = RestTriangle { weight: 0.7, ..RestTriangle::new([0.5, 0.6, 0.4]).unwrap() };
        let x = [[0.1, 0.2, 1.0], [0.6, 0.1, 0.9], [0.3, 0.7, 0.8]].map(normalised);
        (rest, x)
    }

    /// The corners after steps along the tangents of the given ones.
    fn stepped(x: [Vector; 3], steps: [f64; 6]) -> [Vector; 3] {
        [0, 1, 2].map(|k| {
            let [u, v] = tangents(x[k]);
            normalised(add(x[k], add(scale(steps[2 * k], u), scale(steps[2 * k + 1], v))))
        })
    }

    #[test]
    fn gradients_and_hessians_are_those_of_differences_also_of_turned_triangles_that_are_softened() {
        let (rest, up) = triangle();
        let h = 1e-4;
        for (soft, x) in [(0.0, up), (0.5, up), (0.8, [up[0], up[2], up[1]])] {
            let soft = SoftDet { softness: soft };
            let energy = |steps: &[(usize, f64)]| {
                let mut all = [0.0; 6];
                steps.iter().for_each(|&(k, by)| all[k] += by);
                rest.sphere_energy(&SHARES, soft, stepped(x, all))
            };
            let model = rest.sphere_model(&SHARES, soft, x, false);
            let size = model.hessian.iter().fold(1.0, |m: f64, x| m.max(x.abs()));
            let mut k = 0;
            for i in 0..6 {
                let slope = (energy(&[(i, h)]) - energy(&[(i, -h)])) / (2.0 * h);
                assert!((slope - model.gradient[i]).abs() < 1e-5 * size, "{i}: {slope}");
                for j in 0..=i {
                    let corner = |a: f64, b: f64| energy(&[(i, a * h), (j, b * h)]);
                    let second = (corner(1., 1.) - corner(1., -1.) - corner(-1., 1.) + corner(-1., -1.))
                        / (4.0 * h * h);
                    assert!(
                        (second - model.hessian[k]).abs() < 1e-5 * size,
                        "{i} {j}: {second} {}",
                        model.hessian[k]
                    );
                    k += 1;
                }
            }
        }
    }

    #[test]
    fn a_turned_triangle_has_infinite_energy_and_small_triangles_have_the_ratio_of_areas() {
        let (rest, [a, b, c]) = triangle();
        let hard = SoftDet { softness: 0.0 };
        assert!(rest.sphere_energy(&SHARES, hard, [a, c, b]).is_infinite());
        assert!(rest.sphere_energy(&SHARES, SoftDet { softness: 0.1 }, [a, c, b]).is_finite());
        let small = [[0.0, 0.0, 1.0], [1e-3, 0.0, 1.0], [0.0, 1e-3, 1.0]].map(normalised);
        let side = |i: usize, j: usize| norm(sub(small[i], small[j]));
        let same = RestTriangle::new([side(1, 2), side(2, 0), side(0, 1)]).unwrap();
        let [square, det] = same.sphere_square_and_det(small);
        assert!((square - 2.0).abs() < 1e-9 && (det - 1.0).abs() < 1e-6, "{square} {det}");
    }
}
