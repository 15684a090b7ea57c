//! Normals at the corners of faces: smooth over the surface, sharp at its creases.

use super::vector::{V3, add, dot, norm, normal, scaled, sub, unit};

/// Faces that meet at more than this angle (radians) are shaded as two sides of a crease.
const CREASE: f64 = 0.75;
/// A face lower than this share of its longest side is a needle, whose normal is rounding: it takes that of its neighbours.
const NEEDLE: f64 = 1e-3;
/// A vertex in more faces than this is smooth; comparing them in pairs would cost the square of their number.
const MOST_FACES: usize = 64;

/// A unit normal for every corner: the mean over the faces at its vertex that meet the corner's face at less than
/// [`CREASE`], each weighed with its area and its angle there.
pub fn corner_normals(points: &[V3], faces: &[[u32; 3]]) -> Vec<[V3; 3]> {
    let sides: Vec<FaceNormal> =
        faces.iter().map(|f| FaceNormal::new(f.map(|v| points[v as usize]))).collect();
    // The faces around each vertex, and which of their corners it is.
    let mut around = vec![Vec::new(); points.len()];
    for (f, face) in faces.iter().enumerate() {
        (0..3).for_each(|k| around[face[k] as usize].push((f, k)));
    }
    let limit = CREASE.cos();
    let corner = |f: usize, v: u32| {
        let fan = &around[v as usize];
        let own = sides[f].direction;
        let smooth = sides[f].needle || fan.len() > MOST_FACES;
        let mean = fan.iter().fold([0.0; 3], |sum, &(g, k)| {
            let joins = smooth || sides[g].needle || dot(own, sides[g].direction) > limit;
            if joins { add(sum, scaled(sides[g].direction, sides[g].weight[k])) } else { sum }
        });
        unit(mean).or(unit(own)).unwrap_or([0.0, 0.0, 1.0])
    };
    faces.iter().enumerate().map(|(f, face)| face.map(|v| corner(f, v))).collect()
}

/// The normal of a face, and its weight in the normals at its corners.
struct FaceNormal {
    direction: V3,
    weight: [f64; 3],
    needle: bool,
}

impl FaceNormal {
    fn new(p: [V3; 3]) -> FaceNormal {
        let n = normal(p);
        let doubled_area = norm(n);
        let direction = unit(n).unwrap_or([0.0; 3]);
        let sides = [0, 1, 2].map(|k| sub(p[(k + 1) % 3], p[k]));
        let longest = sides.iter().map(|s| norm(*s)).fold(0.0, f64::max);
        let angle = |k: usize| f64::atan2(doubled_area, -dot(sides[k], sides[(k + 2) % 3]));
        let weight = [0, 1, 2].map(|k| doubled_area * angle(k));
        FaceNormal { direction, weight, needle: doubled_area <= NEEDLE * longest * longest }
    }
}
