//! The vertical of a surface, which files do not tell: sheets lie or stand, statues stand on their base, and what has neither stands on
//! what supports it best.

use super::standing::standing;
use super::vector::{V3, add, complement, dot, ends, norm, normal, scaled, sphere_point, unit};
use ricci::mesh::rims::rims;

/// The vertical of a surface, and whether it lies flat on the ground, so that it is seen from above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stance {
    pub up: V3,
    pub lies: bool,
}

/// A surface whose area, added as vectors, is more than this share of its area is a sheet with an outside.
const SHEET: f64 = 0.35;
/// A sheet lower than this share of its width and length lies on the ground.
const FLAT_SHEET: f64 = 0.34;
/// A sheet whose longest boundary loop is no higher than this share of its own extent lies on the ground with it.
const FLAT_RIM: f64 = 0.02;
/// A mask so many times as wide as high, between these, stands on its narrow end: faces are about 1.3 times as high as wide, and what is wider
/// still is no face.
const ASKEW_MASK: std::ops::Range<f64> = 1.25..1.7;
/// A closed surface lower than this share of its width and length is seen from above, whatever its vertical is.
const LOW: f64 = 0.45;
/// A closed surface thinner than this share of its width and length lies on the ground, if it is also [`CENTRED`].
const FLAT_BODY: f64 = 0.6;
/// Distance of the centroid of a surface from the middle of its bounding box, over the extent, up to which no side of it counts as its top.
const CENTRED: f64 = 0.01;
/// Least share of the area of a flat side that a surface stands on; twice as much is asked of a side that is slanted in the file, as cuts of
/// scans are.
const BASE: f64 = 0.065;
/// Difference of the shares of two flat sides up to which they count as equal.
const ALIKE: f64 = 1e-3;
/// Number of directions in which flat sides are searched, and of those with the most area that are examined.
const DIRECTIONS: usize = 128;
const LOOKED_AT: usize = 6;
/// Faces of a flat side: normals within this cosine of its own, and no deeper than this share of the extent along it.
const LEVEL: f64 = 0.95;
const DEPTH: f64 = 0.04;
/// An upright direction within this cosine of a coordinate axis is that axis.
const AXIS: f64 = 0.995;

const Y: V3 = [0.0, 1.0, 0.0];

/// The stance of a surface, by its shape.
pub fn stance(points: &[V3], faces: &[[u32; 3]]) -> Stance {
    let axis = |k: usize, sign: f64| [0, 1, 2].map(|j| if j == k { sign } else { 0.0 });
    // Height over the lesser of width and length.
    let thin = |up: V3| {
        let [wide, long] = complement(up).map(|across| reach(points, across).1);
        reach(points, up).1 / wide.min(long)
    };
    let (mut outside, mut middle, mut total) = ([0.0; 3], [0.0; 3], f64::MIN_POSITIVE);
    for corners in faces.iter().map(|f| f.map(|v| points[v as usize])) {
        let n = normal(corners);
        let centre = corners.into_iter().fold([0.0; 3], |sum, p| add(sum, scaled(p, 1.0 / 3.0)));
        (outside, middle, total) = (add(outside, n), add(middle, scaled(centre, norm(n))), total + norm(n));
    }
    if norm(outside) > SHEET * total {
        let most = (0..3).fold(0, |l, k| if outside[k].abs() > outside[l].abs() { k } else { l });
        let up = axis(most, outside[most].signum());
        let lies = thin(up) < FLAT_SHEET || has_flat_rim(points, faces, up);
        // A mask faces z with y up. Turned about x, as programs with z up do, it faces −y with z up, or y with −z up.
        let upright = if most == 1 { [0.0, 0.0, -outside[1].signum()] } else { Y };
        let mask = || {
            let across = axis(3 - most - if most == 1 { 2 } else { 1 }, 1.0);
            let ([side, wide], high) = (<[f64; 2]>::from(reach(points, across)), reach(points, upright).1);
            let beyond = dot(across, middle) / total - (side - 0.5 * wide);
            if ASKEW_MASK.contains(&(wide / high)) { scaled(across, beyond.signum()) } else { upright }
        };
        return Stance { up: if lies { up } else { mask() }, lies };
    }
    // A surface with a flat base, such as a statue, stands on it, however thin it is.
    if let Some(up) = base(points, faces) {
        return Stance { up, lies: thin(up) < FLAT_BODY };
    }
    let off = |k: usize| {
        let (high, extent) = reach(points, axis(k, 1.0));
        (middle[k] / total - high + 0.5 * extent).abs() / extent
    };
    let is_centred = (0..3).all(|k| off(k) < CENTRED);
    let flat = [2, 1, 0].into_iter().map(|k| axis(k, 1.0)).find(|up| is_centred && thin(*up) < FLAT_BODY);
    let up = flat.unwrap_or_else(|| {
        let (up, is_sure) = standing(points, faces);
        if is_sure || thin(Y) >= LOW { up } else { Y }
    });
    Stance { up, lies: flat.is_some() || thin(up) < LOW }
}

/// The end of points along a direction, and their extent, next to nothing at least.
fn reach(points: &[V3], axis: V3) -> (f64, f64) {
    let [low, high] = ends(points.iter().map(|p| dot(axis, *p)));
    (high, (high - low).max(f64::MIN_POSITIVE))
}

/// True if the longest boundary loop lies level under this vertical.
fn has_flat_rim(points: &[V3], faces: &[[u32; 3]], up: V3) -> bool {
    let all = rims(points, faces);
    let longest = all.iter().max_by(|a, b| a.length.total_cmp(&b.length));
    longest.is_some_and(|rim| {
        let on_rim: Vec<V3> = rim.vertices.iter().map(|&v| points[v as usize]).collect();
        let [wide, long] = complement(up).map(|across| reach(&on_rim, across).1);
        reach(&on_rim, up).1 < FLAT_RIM * wide.max(long)
    })
}

/// The direction away from the flat side that a surface stands on, if it has one.
fn base(points: &[V3], faces: &[[u32; 3]]) -> Option<V3> {
    let around: Vec<V3> = (0..DIRECTIONS).map(|i| sphere_point(i, DIRECTIONS)).collect();
    let corners = |f: &[u32; 3]| f.map(|v| points[v as usize]);
    let mut sums = vec![([0.0; 3], 0.0); DIRECTIONS];
    for n in faces.iter().map(|f| normal(corners(f))) {
        let best = (0..DIRECTIONS).fold(0, |b, k| if dot(n, around[k]) > dot(n, around[b]) { k } else { b });
        sums[best] = (add(sums[best].0, n), sums[best].1 + norm(n));
    }
    let total: f64 = sums.iter().map(|s| s.1).sum();
    sums.sort_by(|a, b| b.1.total_cmp(&a.1));
    let share = |down: V3| {
        let (high, extent) = reach(points, down);
        let area = |f: &[u32; 3]| {
            let (n, p) = (normal(corners(f)), corners(f));
            let middle = (0..3).map(|k| dot(down, p[k])).sum::<f64>() / 3.0;
            let level = dot(down, n) > LEVEL * norm(n) && middle > high - DEPTH * extent;
            if level { norm(n) } else { 0.0 }
        };
        faces.iter().map(area).sum::<f64>() / total
    };
    let sides = sums.iter().take(LOOKED_AT).filter_map(|s| unit(s.0)).map(|down| (share(down), down));
    // Of two sides of equal share the one that is lower in the file.
    let taste = |(share, [x, y, z]): &(f64, V3)| share - ALIKE * (x + y + z);
    let (share, down) = sides.max_by(|a, b| taste(a).total_cmp(&taste(b)))?;
    let axis = (0..3).find(|k| down[*k].abs() > AXIS);
    let snapped = axis.map(|k| [0, 1, 2].map(|j| if j == k { -down[k].signum() } else { 0.0 }));
    let least = if snapped.is_some() { BASE } else { 2.0 * BASE };
    (share > least).then(|| snapped.unwrap_or(down.map(|x| -x)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use ricci::mesh::shapes;

    const Z: V3 = [0.0, 0.0, 1.0];

    #[test]
    fn flat_things_lie_and_long_things_stand() {
        let torus = shapes::torus(2.0, 0.7, 40, 20).unwrap();
        assert_eq!(stance(&torus.positions, &torus.faces), Stance { up: Z, lies: true });
        let turned = |p: &V3| [p[2], p[0], p[1]];
        let points: Vec<V3> = torus.positions.iter().map(turned).collect();
        assert_eq!(stance(&points, &torus.faces).up, [1.0, 0.0, 0.0]);
        let disk = shapes::disk(10).unwrap();
        assert_eq!(stance(&disk.positions, &disk.faces), Stance { up: Z, lies: true });
        let below: Vec<[u32; 3]> = disk.faces.iter().map(|f| [f[0], f[2], f[1]]).collect();
        assert_eq!(stance(&disk.positions, &below).up, [0.0, 0.0, -1.0]);
        // A high hill on a level rim lies, too; a mask does not.
        let hill = |cut: f64| -> Vec<V3> {
            let height = |x: f64, y: f64| 1.5 * (1.0 - x * x - y * y) + cut * x * x;
            disk.positions.iter().map(|&[x, y, _]| [x, y, height(x, y)]).collect()
        };
        assert_eq!(stance(&hill(0.0), &disk.faces), Stance { up: Z, lies: true });
        assert_eq!(stance(&hill(0.4), &disk.faces), Stance { up: Y, lies: false });
        // A mask that lies on its side is turned to its wide end, the forehead.
        let oval = |&[x, y, _]: &V3| {
            let wide = 0.5 + 0.04 * (y + 1.0);
            [1.5 * y, -wide * 2.0 * x, 2.0 * (1.0 - x * x - 0.6 * y * y)]
        };
        let mask: Vec<V3> = disk.positions.iter().map(oval).collect();
        assert_eq!(stance(&mask, &disk.faces), Stance { up: [1.0, 0.0, 0.0], lies: false });
        // A prism with a slanted top stands on its end, wherever that looks.
        let prism = |tilt: f64| -> Vec<V3> {
            let corner = |k: u32| {
                [
                    3.0 * f64::from(k & 1),
                    f64::from(k >> 1 & 1),
                    3.0 * f64::from(k >> 2) + f64::from(k >> 2 & k & 1),
                ]
            };
            let (sin, cos) = tilt.sin_cos();
            let turned = |[x, y, z]: V3| [x, cos * y - sin * z, sin * y + cos * z];
            (0..8).map(|k| turned(corner(k))).collect()
        };
        let squares = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let faces: Vec<[u32; 3]> =
            squares.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
        let up = stance(&prism(0.6), &faces).up;
        assert!(up.iter().any(|x| x.abs() > 0.1 && x.abs() < 0.99), "{up:?}");
        // A ring on its edge lies down, unless it has a foot to stand on.
        let ring: Vec<V3> = shapes::torus(2.0, 0.5, 80, 40).unwrap().positions.to_vec();
        let faces = shapes::torus(2.0, 0.5, 80, 40).unwrap().faces;
        let foot: Vec<V3> = ring.iter().map(|&[x, y, z]| [x, y.max(-1.8), z]).collect();
        assert_eq!(stance(&foot, &faces), Stance { up: Y, lies: false });
        // What has its height along y by default, but little of it, is seen from above.
        let ball = shapes::icosphere(12).unwrap();
        let cone = |&[x, y, z]: &V3| {
            let height = 0.4 * (1.0 - (1.0 - y * y).max(0.0).sqrt());
            [if x > 0.0 { 2.5 * x } else { x }, height * y.signum(), z]
        };
        let low: Vec<V3> = ball.positions.iter().map(cone).collect();
        assert_eq!(stance(&low, &ball.faces), Stance { up: Y, lies: true });
        let tall = shapes::ellipsoid([1.0, 3.0, 1.0], 8).unwrap();
        assert_eq!(stance(&tall.positions, &tall.faces), Stance { up: Y, lies: false });
    }
}
