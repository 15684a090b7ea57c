//! Vectors in space.
//!
//! ```
//! use ricci::geometry::vector::{cross, norm};
//! assert_eq!(norm(cross([2.0, 0.0, 0.0], [0.0, 3.0, 0.0])), 6.0);
//! ```

/// x, y, z.
pub type Vector = [f64; 3];

/// `a + b`.
pub fn add(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// `a − b`.
pub fn sub(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// `s a`.
pub fn scale(s: f64, a: Vector) -> Vector {
    a.map(|x| s * x)
}

/// `(1 − t) a + t b`.
pub fn lerp(a: Vector, b: Vector, t: f64) -> Vector {
    add(scale(1.0 - t, a), scale(t, b))
}

/// Inner product.
pub fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Vector product.
pub fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Euclidean length.
pub fn norm(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

/// Euclidean distance.
pub fn distance(a: Vector, b: Vector) -> f64 {
    norm(sub(a, b))
}

/// The diagonal of the bounding box of points; 0 without points.
pub fn diagonal(points: &[Vector]) -> f64 {
    let bound = |pick: fn(f64, f64) -> f64| {
        points.iter().copied().reduce(|a, b| [0, 1, 2].map(|k| pick(a[k], b[k]))).unwrap_or_default()
    };
    distance(bound(f64::min), bound(f64::max))
}

/// The vector of length 1 in the same direction; a zero vector stays zero.
pub fn normalised(a: Vector) -> Vector {
    let length = norm(a);
    if length > 0.0 { scale(1.0 / length, a) } else { a }
}

/// A unit vector across a unit vector: along the plane that it is the normal of, and at least 45 degrees off the axis that is nearest to it.
pub fn perpendicular(a: Vector) -> Vector {
    let [x, y, z] = a.map(f64::abs);
    let axis = if x <= y && x <= z {
        [1.0, 0.0, 0.0]
    } else if y <= z {
        [0.0, 1.0, 0.0]
    } else {
        [0.0, 0.0, 1.0]
    };
    normalised(cross(axis, a))
}

/// Normal of a triangle: twice its area long, on the side from which its corners run counterclockwise.
pub fn triangle_normal([a, b, c]: [Vector; 3]) -> Vector {
    cross(sub(b, a), sub(c, a))
}
