//! Vectors in space: the library's functions, and further ones that pictures need.

pub use ricci::geometry::vector::{Vector as V3, add, cross, dot, norm, sub, triangle_normal as normal};

pub fn scaled(a: V3, s: f64) -> V3 {
    a.map(|x| s * x)
}

/// The unit vector along `a`; `None` where it has no direction.
pub fn unit(a: V3) -> Option<V3> {
    let length = norm(a);
    (length > 0.0 && length.is_finite()).then(|| scaled(a, 1.0 / length))
}

/// The point with these barycentric coordinates.
pub fn at(b: V3, p: [V3; 3]) -> V3 {
    [0, 1, 2].map(|k| b[0] * p[0][k] + b[1] * p[1][k] + b[2] * p[2][k])
}

/// Two unit vectors that complete the unit vector `n` to a right-handed frame.
pub fn complement(n: V3) -> [V3; 2] {
    // The coordinate axis farthest from n.
    let least = (0..3).fold(0, |l, k| if n[k].abs() < n[l].abs() { k } else { l });
    let mut axis = [0.0; 3];
    axis[least] = 1.0;
    let a = unit(cross(axis, n)).unwrap_or([1.0, 0.0, 0.0]);
    [a, cross(n, a)]
}

/// The least and the largest of some numbers.
pub fn ends(numbers: impl Iterator<Item = f64>) -> [f64; 2] {
    numbers.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
}

/// Centre of the bounding box and the largest distance from it.
pub fn bounding_ball(points: &[V3]) -> (V3, f64) {
    let centre = [0, 1, 2].map(|k| 0.5 * ends(points.iter().map(|p| p[k])).iter().sum::<f64>());
    let radius = points.iter().map(|p| norm(sub(*p, centre))).fold(0.0, f64::max);
    (centre, radius.max(f64::MIN_POSITIVE))
}

/// Points spread evenly over the unit sphere: point `i` of `n` on a spiral from pole to pole, a golden angle apart.
pub fn sphere_point(i: usize, n: usize) -> V3 {
    let z = 1.0 - (2 * i + 1) as f64 / n as f64;
    let (sin, cos) = (i as f64 * std::f64::consts::PI * (3.0 - 5f64.sqrt())).sin_cos();
    let r = (1.0 - z * z).sqrt();
    [r * cos, r * sin, z]
}
