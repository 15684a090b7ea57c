//! The barycentre of weighted points of the unit disk, and the Möbius transformation that moves it to the centre.
//!
//! Let A_p be the Möbius transformation that moves p to 0. The barycentre of points z is the p with `Σ w A_p z = 0`: the lowest point of
//! `Σ w 2 log cosh(d(p, z)/2)`, d the hyperbolic distance, which is convex. At p = 0 its gradient is `−Σ w z`, its Hessian `½ Σ w ((1 +
//! |z|²) − 2 z zᵀ)`. Unlike the mean, it moves with the points under Möbius transformations of the disk.
//!
//! ```
//! use ricci::geometry::disk_barycentre::disk_barycentre;
//! let centred = disk_barycentre(&[[0.5, 0.1], [0.5, -0.1], [0.9, 0.0]], &[1.0, 1.0, 2.0])?;
//! let [x, y] = [[0.5, 0.1], [0.5, -0.1], [0.9, 0.0], [0.9, 0.0]].map(|z| centred.apply(z)).into_iter().fold([0.0; 2], |s, z| [s[0] + z[0], s[1] + z[1]]);
//! assert!(x.hypot(y) < 1e-14);
//! # Ok::<(), ricci::Error>(())
//! ```

use super::complex::{Complex, add, norm, norm2, scale};
use super::mobius::Mobius;
use crate::error::{Error, Result, check_size};

/// Longest Newton step, a hyperbolic distance: over a distance of 1 the Hessian changes moderately.
const LONGEST_STEP: f64 = 1.0;
/// Most Newton steps. Points of the open disk with f64 coordinates lie within a hyperbolic distance of 40.
const MAX_STEPS: usize = 200;
/// `|Σ w z|/Σ w` below which the points count as balanced: a few roundings of 1.
const BALANCED: f64 = 4e-16;

/// The transformation of the disk after which `Σ w z = 0`, without a rotation. `points` lie in the closed unit disk, one of them with
/// positive weight inside, or three on the circle.
///
/// # Errors
/// [`Error::Size`]; [`Error::Argument`] for weights that are negative or not finite, and where there is no such transformation because
/// half of the weight lies at one point of the circle.
pub fn disk_barycentre(points: &[Complex], weights: &[f64]) -> Result<Mobius> {
    check_size("weights", weights.len(), points.len())?;
    let total: f64 = weights.iter().sum();
    let refused = |value: String| {
        Error::argument(
            "weights",
            value,
            "not negative, with less than half of them at one point of the circle",
        )
    };
    if weights.iter().any(|&w| w < 0.0) || !(total > 0.0 && total.is_finite()) {
        return Err(refused(format!("of sum {total}")));
    }
    let (mut map, mut before) = (Mobius::IDENTITY, f64::INFINITY);
    for _ in 0..MAX_STEPS {
        let (mean, [xx, xy, yy]) = moments(points, weights, total, &map);
        let off = norm(mean);
        // Near the end rounding keeps the mean from falling further.
        if off <= BALANCED || (off < 1e-9 && off >= 0.5 * before) {
            return Ok(map);
        }
        before = off;
        let determinant = xx * yy - xy * xy;
        let step = [(yy * mean[0] - xy * mean[1]) / determinant, (xx * mean[1] - xy * mean[0]) / determinant];
        let length = norm(step);
        if !length.is_finite() {
            break;
        }
        // The point at hyperbolic distance s from 0 is tanh(s/2).
        let reach = (0.5 * length.min(LONGEST_STEP)).tanh();
        map = Mobius::to_origin(scale(reach / length, step)).after(&map);
    }
    Err(refused("without a balance".into()))
}

/// Mean of the moved points, and the Hessian's entries xx, xy, yy.
fn moments(points: &[Complex], weights: &[f64], total: f64, map: &Mobius) -> (Complex, [f64; 3]) {
    let (mut mean, mut hessian) = ([0.0; 2], [0.0; 3]);
    for (&z, &w) in points.iter().zip(weights) {
        let (z, w) = (map.apply(z), w / total);
        mean = add(mean, scale(w, z));
        let own = 1.0 + norm2(z);
        let parts = [own - 2.0 * z[0] * z[0], -2.0 * z[0] * z[1], own - 2.0 * z[1] * z[1]];
        hessian.iter_mut().zip(parts).for_each(|(h, part)| *h += 0.5 * w * part);
    }
    (mean, hessian)
}
