//! Bad triangles on demand: meshes graded towards a vertex, and slivers.

use super::check_corners;
use crate::error::{Error, Result};
use crate::geometry::random::SplitMix64;
use crate::geometry::vector::{add, cross, distance, lerp, norm, normalised, scale, sub, triangle_normal};
use crate::mesh::Point;
use crate::mesh::io::Soup;

/// Halves the edges around `vertex`, then those of the smaller triangles around it, `levels` times: edge lengths fall like 2^−levels
/// towards it. All new triangles are similar to old ones or are halves of trapezia.
///
/// ```text
///          v                 Each triangle (v, a, b) becomes (v, a', b') and the trapezium (a', a, b, b'), cut
///         / \                along a'b. New vertices come last, level by level in the order of the vertex's
///       a'___b'              faces. Positions are midpoints: the surface stays as it is.
///       / \   \
///      a___\___b
/// ```
///
/// # Errors
///
/// [`Error::Argument`] for a vertex that does not exist or is in no face, or for too many levels; [`Error::TooLarge`]. The error for
/// levels names the largest number: 100 for a vertex at the origin, and elsewhere as many as leave the edges at it 1024 times as long as
/// the rounding of its coordinates (about 40 on the unit sphere), so that angles keep three digits.
pub fn grade(soup: &mut Soup, vertex: u32, levels: usize) -> Result<()> {
    let star: Vec<usize> = (0..soup.faces.len()).filter(|&f| soup.faces[f].contains(&vertex)).collect();
    check_corners(soup)?;
    if star.is_empty() {
        return Err(Error::argument("vertex to grade towards", vertex, "a vertex of a face"));
    }
    let most = most_levels(soup, vertex, &star);
    if levels > most {
        let value = format!("{levels}, of at most {most} at vertex {vertex}");
        return Err(Error::argument("levels", value, "fewer: edges would vanish in rounding"));
    }
    check_room(soup, 2 * levels * star.len())?;
    for _ in 0..levels {
        // The vertices opposite the graded one, each with its midpoint.
        let mut middle: Vec<(u32, u32)> = Vec::new();
        for &f in &star {
            for a in soup.faces[f].into_iter().filter(|&a| a != vertex) {
                if !middle.iter().any(|&(known, _)| known == a) {
                    let p = lerp(soup.positions[vertex as usize], soup.positions[a as usize], 0.5);
                    middle.push((a, soup.positions.len() as u32));
                    soup.positions.push(p);
                }
            }
        }
        let middle_of = |a: u32| middle.iter().find(|&&(known, _)| known == a).map_or(a, |&(_, m)| m);
        for &f in &star {
            let Some(corner) = soup.faces[f].iter().position(|&v| v == vertex) else {
                return Err(Error::connectivity("face", f, "left the graded vertex"));
            };
            let (a, b) = (soup.faces[f][(corner + 1) % 3], soup.faces[f][(corner + 2) % 3]);
            let (near_a, near_b) = (middle_of(a), middle_of(b));
            soup.faces[f] = [vertex, near_a, near_b];
            soup.faces.extend([[near_a, a, b], [near_a, b, near_b]]);
        }
    }
    forget_attributes(soup);
    Ok(())
}

/// Most levels of grading. Around the origin f64 resolves even shorter edges, but edges of 2⁻¹⁰⁰ of their first length are of no use.
const MOST_LEVELS: usize = 100;
/// Least length of the edges at the graded vertex, in units of its largest coordinate: 1024 roundings of it.
const RESOLVED: f64 = 1024.0 * f64::EPSILON;

fn most_levels(soup: &Soup, vertex: u32, star: &[usize]) -> usize {
    let at = |v: u32| soup.positions[v as usize];
    let others = star.iter().flat_map(|&f| soup.faces[f]).filter(|&v| v != vertex);
    let shortest = others.map(|v| distance(at(v), at(vertex))).fold(f64::INFINITY, f64::min);
    let largest = at(vertex).into_iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let levels = (shortest / (RESOLVED * largest)).log2().floor();
    // Infinite at the origin; NaN for positions that are not finite, which building a mesh refuses.
    if levels < MOST_LEVELS as f64 { levels.max(0.0) as usize } else { MOST_LEVELS }
}

/// The kind of a sliver.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sliver {
    /// A vertex close to the middle of a side, with one angle near π and two small ones.
    Cap,
    /// A vertex close to a corner, with a short edge and one small angle.
    Needle,
}

/// Cuts `count` faces, chosen by `seed`, into three by a new vertex, placed so that the smallest angle is about `angle` (radians, up to
/// 0.1): near the middle of the first side, whose ends see it under this angle, or near the first corner, where the farther of the other
/// two sees it so; never farther in than a third of the face. The shape of the surface does not change.
///
/// The new vertices come last; the first third of each cut face keeps its number and the others come last.
///
/// # Errors
///
/// [`Error::Argument`] for an angle outside 1e-7 … 0.1 or more slivers than faces; [`Error::TooLarge`].
pub fn slivers(soup: &mut Soup, kind: Sliver, count: usize, angle: f64, seed: u64) -> Result<()> {
    check_corners(soup)?;
    if !(THINNEST..=0.1).contains(&angle) {
        return Err(Error::argument("angle of a sliver", angle, "between 1e-7 and 0.1 radians"));
    }
    let n_faces = soup.faces.len();
    if count > n_faces {
        return Err(Error::argument("slivers", count, "at most the number of faces"));
    }
    check_room(soup, 2 * count)?;
    let mut random = SplitMix64::new(seed);
    // The first entries of a random permutation (Fisher and Yates).
    let mut order: Vec<usize> = (0..n_faces).collect();
    for i in 0..count {
        let rest = (n_faces - i) as u64;
        order.swap(i, i + (random.bits() % rest) as usize);
    }
    for &f in &order[..count] {
        let [a, b, c] = soup.faces[f];
        let [p, q, r] = [a, b, c].map(|v| soup.positions[v as usize]);
        let position = match kind {
            Sliver::Cap => cap([p, q, r], angle),
            Sliver::Needle => needle([p, q, r], angle),
        };
        let v = soup.positions.len() as u32;
        soup.positions.push(position);
        soup.faces[f] = [a, b, v];
        soup.faces.extend([[b, c, v], [c, a, v]]);
    }
    forget_attributes(soup);
    Ok(())
}

/// Least angle of a sliver, radians. Two sides of a cap with this angle together exceed its base by `2 (1 − cos 1e-7) = 1e-14` of it, a
/// few ulps; by its lengths in f64 a thinner cap may have no area.
const THINNEST: f64 = 1e-7;

/// The point above the middle of pq that is seen from p and q under `angle`.
fn cap([p, q, r]: [Point; 3], angle: f64) -> Point {
    let side = distance(p, q);
    let height = norm(triangle_normal([p, q, r])) / side;
    lerp(lerp(p, q, 0.5), r, (0.5 * side * angle.tan() / height).min(1.0 / 3.0))
}

/// The point on the bisector at p that is seen from the farther one of q and r under `angle`.
fn needle([p, q, r]: [Point; 3], angle: f64) -> Point {
    let (to_q, to_r) = (sub(q, p), sub(r, p));
    let bisector = normalised(add(normalised(to_q), normalised(to_r)));
    let sine = norm(cross(normalised(to_q), bisector));
    let (near, far) = (norm(to_q).min(norm(to_r)), norm(to_q).max(norm(to_r)));
    add(p, scale((far * angle / sine).min(near / 3.0), bisector))
}

/// Checks that the half-edges of this many more faces, three per face, can be numbered in u32.
fn check_room(soup: &Soup, new_faces: usize) -> Result<()> {
    let count = soup.faces.len() + new_faces;
    if count > u32::MAX as usize / 3 { Err(Error::TooLarge { what: "faces", count }) } else { Ok(()) }
}

/// Drops the attributes, which are unknown for new vertices and faces.
fn forget_attributes(soup: &mut Soup) {
    soup.attributes = Default::default();
}
