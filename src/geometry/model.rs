//! Models of the hyperbolic plane, and maps between them and the hyperboloid `x² + y² − w² = −1`, `w ≥ 1`.
//!
//! ```text
//! Poincaré disk  z = (x + iy)/(1 + w)        Klein disk  β(z) = (x + iy)/w = 2z/(1 + z z̄)
//! half-plane     i (1 + z)/(1 − z) = (−y + i)/(w − x)
//! ```
//!
//! Coordinates on the hyperboloid keep their relative accuracy at any distance d from the origin. In the disks a point lies 2e^{−d}
//! (Poincaré) or 2e^{−2d} (Klein) from the border, so that coordinates near 1 lose their digits there.
//!
//! ```
//! use ricci::geometry::model::{distance, from_poincare, half_plane};
//! let origin = from_poincare([0.0, 0.0]);
//! assert_eq!(half_plane(origin), [0.0, 1.0]);
//! assert!((distance(origin, from_poincare([0.5, 0.0])) - 3f64.ln()).abs() < 1e-15);
//! ```

use crate::archive::stored;
use crate::error::Error;

/// A model of H² by plane coordinates, or the hyperboloid itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Model {
    /// The unit disk, conformal, with metric `4 dz dz̄ / (1 − |z|²)²`.
    #[default]
    Poincare,
    /// The unit disk in which geodesics are straight; projective.
    Klein,
    /// The upper half-plane, conformal, with metric `dz dz̄ / (Im z)²`.
    HalfPlane,
    /// The hyperboloid in R^{2,1}.
    Hyperboloid,
}
stored!(variants Model {
        Poincare = 0,
        Klein = 1,
        HalfPlane = 2,
        Hyperboloid = 3,
    }
);

impl Model {
    /// The name used on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Model::Poincare => "poincare",
            Model::Klein => "klein",
            Model::HalfPlane => "half-plane",
            Model::Hyperboloid => "hyperboloid",
        }
    }

    /// The coordinates of a point of the hyperboloid, `[x, y, 0]` in the plane models.
    pub fn from_hyperboloid(self, p: [f64; 3]) -> [f64; 3] {
        let flat = |[x, y]: [f64; 2]| [x, y, 0.0];
        match self {
            Model::Poincare => flat(poincare(p)),
            Model::Klein => flat(klein(p)),
            Model::HalfPlane => flat(half_plane(p)),
            Model::Hyperboloid => p,
        }
    }

    /// The first two coordinates of [`Model::from_hyperboloid`]; a plane model has only these.
    pub fn plane(self, p: [f64; 3]) -> [f64; 2] {
        let [x, y, _] = self.from_hyperboloid(p);
        [x, y]
    }
}

impl std::str::FromStr for Model {
    type Err = Error;

    fn from_str(name: &str) -> Result<Model, Error> {
        [Model::Poincare, Model::Klein, Model::HalfPlane, Model::Hyperboloid]
            .into_iter()
            .find(|m| m.name().eq_ignore_ascii_case(name))
            .ok_or_else(|| Error::argument("model", name, "poincare, klein, half-plane or hyperboloid"))
    }
}

/// The point of the Poincaré disk.
pub fn poincare([x, y, w]: [f64; 3]) -> [f64; 2] {
    [x / (1.0 + w), y / (1.0 + w)]
}

/// The point of the Klein disk.
pub fn klein([x, y, w]: [f64; 3]) -> [f64; 2] {
    [x / w, y / w]
}

/// The point of the half-plane; the centre of the disks is mapped to i.
pub fn half_plane([x, y, w]: [f64; 3]) -> [f64; 2] {
    // w − x = (1 + y²)/(w + x) on the hyperboloid: the second form does not cancel for positive x.
    let rest = if x > 0.0 { (1.0 + y * y) / (w + x) } else { w - x };
    [-y / rest, 1.0 / rest]
}

/// The point of the hyperboloid over a point of the Poincaré disk (|z| < 1).
pub fn from_poincare([x, y]: [f64; 2]) -> [f64; 3] {
    let r = x.hypot(y);
    let rest = (1.0 - r) * (1.0 + r);
    [2.0 * x / rest, 2.0 * y / rest, (1.0 + r * r) / rest]
}

/// The point of the hyperboloid over a point of the Klein disk (|k| < 1).
pub fn from_klein([x, y]: [f64; 2]) -> [f64; 3] {
    let r = x.hypot(y);
    let w = 1.0 / ((1.0 - r) * (1.0 + r)).sqrt();
    [w * x, w * y, w]
}

/// The point of the hyperboloid over a point of the half-plane (Im > 0).
pub fn from_half_plane([x, y]: [f64; 2]) -> [f64; 3] {
    // w − x = 1/Im, −y = Re/Im, w + x = (1 + y²)(Im)
    let sum = (x * x + y * y) / y;
    [0.5 * (sum - 1.0 / y), -x / y, 0.5 * (sum + 1.0 / y)]
}

/// Hyperbolic distance of two points of the hyperboloid: `sinh²(d/2) = ⟨p − q, p − q⟩/4`.
pub fn distance(p: [f64; 3], q: [f64; 3]) -> f64 {
    let d = [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
    let square = d[0] * d[0] + d[1] * d[1] - d[2] * d[2];
    2.0 * (0.25 * square).max(0.0).sqrt().asinh()
}

/// The point of the hyperboloid at the share `t` of the geodesic from p to q. The weights of p and q are `sinh((1 − t) l)/sinh l` and
/// `sinh(t l)/sinh l`.
pub fn between(p: [f64; 3], q: [f64; 3], t: f64) -> [f64; 3] {
    let length = distance(p, q);
    let whole = length.sinh();
    let (a, b) = if whole > 0.0 {
        (((1.0 - t) * length).sinh() / whole, (t * length).sinh() / whole)
    } else {
        (1.0 - t, t)
    };
    let [x, y] = [0, 1].map(|k| a * p[k] + b * q[k]);
    [x, y, 1.0f64.hypot(x.hypot(y))]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points() -> Vec<[f64; 3]> {
        let at = |i: u32| {
            let (r, t) = (f64::from(i) * 0.5, f64::from(i) * 0.9);
            [r.sinh() * t.cos(), r.sinh() * t.sin(), r.cosh()]
        };
        (0..20).map(at).collect()
    }

    #[test]
    fn models_and_hyperboloid_are_inverse_to_each_other() {
        for p in points() {
            let close = |q: [f64; 3], digits: f64| (0..3).all(|k| (p[k] - q[k]).abs() <= digits * p[2]);
            // The accuracy that coordinates of a disk have so far out.
            assert!(close(from_poincare(poincare(p)), 4.0 * f64::EPSILON * p[2]));
            assert!(close(from_klein(klein(p)), 4.0 * f64::EPSILON * p[2] * p[2]));
            assert!(close(from_half_plane(half_plane(p)), 1e-14));
        }
    }

    #[test]
    fn klein_is_the_chord_model_of_poincare_and_half_plane_its_cayley_image() {
        for p in points() {
            let [x, y] = poincare(p);
            let n = x * x + y * y;
            let k = klein(p);
            assert!((k[0] - 2.0 * x / (1.0 + n)).abs() < 1e-15 && (k[1] - 2.0 * y / (1.0 + n)).abs() < 1e-15);
            // i(1 + z)/(1 − z)
            let d = (1.0 - x).powi(2) + y * y;
            let expected = [-2.0 * y / d, (1.0 - n) / d];
            let got = half_plane(p);
            assert!((0..2).all(|i| (got[i] - expected[i]).abs() < 1e-7 * (1.0 + expected[i].abs())));
        }
        assert_eq!(half_plane([0.0, 0.0, 1.0]), [0.0, 1.0]);
    }

    #[test]
    fn distances_agree_between_models() {
        let all = points();
        for (p, q) in all.iter().zip(&all[1..]).take(8) {
            let cosh = p[2] * q[2] - p[0] * q[0] - p[1] * q[1];
            assert!((distance(*p, *q) - cosh.acosh()).abs() < 1e-9);
            let [[a, b], [c, d]] = [half_plane(*p), half_plane(*q)];
            let in_half_plane = 1.0 + ((a - c).powi(2) + (b - d).powi(2)) / (2.0 * b * d);
            assert!((in_half_plane / cosh - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn names_are_read_back() {
        for model in [Model::Poincare, Model::Klein, Model::HalfPlane, Model::Hyperboloid] {
            assert_eq!(model.name().parse::<Model>().unwrap(), model);
        }
        assert!("disk".parse::<Model>().is_err());
    }
}
