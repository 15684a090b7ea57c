//! Vectors in space.

pub type V3 = [f64; 3];

pub fn add(a: V3, b: V3) -> V3 {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub fn sub(a: V3, b: V3) -> V3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub fn scaled(a: V3, s: f64) -> V3 {
    a.map(|x| s * x)
}

pub fn dot(a: V3, b: V3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn cross(a: V3, b: V3) -> V3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub fn norm(a: V3) -> f64 {
    dot(a, a).sqrt()
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

/// Normal of a triangle, twice its area long.
pub fn normal(p: [V3; 3]) -> V3 {
    cross(sub(p[1], p[0]), sub(p[2], p[0]))
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
