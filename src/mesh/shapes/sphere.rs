//! Spheres and ellipsoids from the subdivided icosahedron.

use super::{THIN, check_count, check_size};
use crate::error::{Error, Result};
use crate::geometry::vector::{cross, distance, dot, norm};
use crate::mesh::Point;
use crate::mesh::io::Soup;
use std::collections::HashMap;

/// The unit sphere: each face of the icosahedron cut into n² triangles, radially projected. 10n² + 2
/// vertices, 20n² faces; the icosahedron's twelve corners come first. n ≥ 1.
///
/// # Errors
///
/// [`Error::Argument`] for n out of range.
pub fn icosphere(n: usize) -> Result<Soup> {
    check_count("frequency", n, 1, 10.0 * (n as f64).powi(2))?;
    let golden = 0.5 * (1.0 + 5.0f64.sqrt());
    let mut positions: Vec<Point> = Vec::new();
    for (a, b) in [(1.0, golden), (-1.0, golden), (1.0, -golden), (-1.0, -golden)] {
        positions.extend([[0.0, a, b], [a, b, 0.0], [b, 0.0, a]]);
    }
    let coarse_faces = icosahedron_faces(&positions);
    // The number of each new point by its pairs (corner of the icosahedron, weight), sorted by corner: both faces at an edge find the same one.
    let mut known: HashMap<[(u32, u32); 3], u32> = HashMap::new();
    let base = positions.clone();
    let mut vertex = |face: [u32; 3], weights: [u32; 3]| {
        let mut key = [0, 1, 2].map(|i| if weights[i] == 0 { (u32::MAX, 0) } else { (face[i], weights[i]) });
        key.sort_unstable();
        // Corners of weight 0 come last; if the second is one of them, the point is a corner of the icosahedron.
        if key[1].1 == 0 {
            return key[0].0;
        }
        *known.entry(key).or_insert_with(|| {
            let mut p = [0.0; 3];
            for (corner, weight) in key.iter().filter(|(_, w)| *w > 0) {
                (0..3).for_each(|k| p[k] += f64::from(*weight) * base[*corner as usize][k]);
            }
            positions.push(p);
            positions.len() as u32 - 1
        })
    };
    let mut faces = Vec::new();
    let n = n as u32;
    for face in coarse_faces {
        for i in 0..n {
            for j in 0..n - i {
                let mut at = |i: u32, j: u32| vertex(face, [n - i - j, i, j]);
                let (a, b, c) = (at(i, j), at(i + 1, j), at(i, j + 1));
                faces.push([a, b, c]);
                if i + j + 1 < n {
                    faces.push([b, at(i + 1, j + 1), c]);
                }
            }
        }
    }
    for p in &mut positions {
        let length = norm(*p);
        p.iter_mut().for_each(|x| *x /= length);
    }
    Ok(Soup::new(positions, faces))
}

/// The ellipsoid with half axes a, b, c along x, y, z: a scaled icosphere.
///
/// # Errors
///
/// [`Error::Argument`] for an axis outside 1e-150 … 1e150 or below 1e-12 of the longest, or n out of
/// range.
pub fn ellipsoid(axes: [f64; 3], n: usize) -> Result<Soup> {
    for (what, axis) in ["first half axis", "second half axis", "third half axis"].into_iter().zip(axes) {
        check_size(what, axis)?;
        if axes.iter().any(|&other| axis < THIN * other) {
            return Err(Error::argument(what, format!("{axis:e}"), "at least 1e-12 of the longest"));
        }
    }
    let mut soup = icosphere(n)?;
    for p in &mut soup.positions {
        (0..3).for_each(|k| p[k] *= axes[k]);
    }
    Ok(soup)
}

/// The twenty faces: triples of corners at the least distance, counterclockwise from outside.
fn icosahedron_faces(p: &[Point]) -> Vec<[u32; 3]> {
    // Corners of an edge are 2 apart, others at least 3.2.
    let near = |a: usize, b: usize| distance(p[a], p[b]) < 2.5;
    let mut faces = Vec::new();
    for a in 0..12 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                if near(a, b) && near(b, c) && near(c, a) {
                    let [x, y, z] = [p[a], p[b], p[c]];
                    let volume = dot(x, cross(y, z));
                    let [a, b, c] = [a as u32, b as u32, c as u32];
                    faces.push(if volume > 0.0 { [a, b, c] } else { [a, c, b] });
                }
            }
        }
    }
    faces
}
