//! Smooth closed surfaces of any genus: tori in a row, blended.
//!
//! The surface is the zero set of `F = −(1/κ) log Σ_k exp(−κ d_k)`, with `d_k` the signed distance to the k-th torus
//! (centre circle of radius 1 about (2k, 0, 0), tube radius 0.45). The mesh starts as the outside of a plate of unit
//! blocks, 2g + 1 long, 3 wide and 1 thick, with g holes of one block, cut into n × n squares per block face; it is
//! projected onto the surface and relaxed along it.

use super::check_count;
use crate::error::Result;
use crate::mesh::Point;
use crate::mesh::io::Soup;
use std::collections::HashMap;

const TUBE: f64 = 0.45;
/// Sharpness κ of the blend: the holes (radius 0.55) stay open, neighbouring tubes join over a width of about 1/κ.
const SHARPNESS: f64 = 8.0;
/// Newton steps of a projection; the distance functions have unit gradient, so that few are needed.
const PROJECTION_STEPS: usize = 30;
/// A vertex is on the surface when |F| is below this (the units of its blocks are 1).
const ON_SURFACE: f64 = 1e-14;

/// A smooth closed surface of genus `genus` ≥ 1 with `n` ≥ 2 edges per block side, (18g + 14) n² + 2 − 2g vertices, all on
/// the surface to 1e-13. Vertex 0 lies on the wall of the first hole towards the next one, where for even n ≥ 4 eight
/// triangles meet: room for a cone of negative curvature. (Genus 0: see [`super::icosphere`].)
pub fn genus(genus: usize, n: usize) -> Result<Soup> {
    let vertices = (18.0 * genus as f64 + 14.0) * (n as f64).powi(2);
    check_count("genus", genus, 1, vertices)?;
    check_count("edges per block", n, 2, vertices)?;
    let (mut positions, quads) = plate(genus, n);
    let surface = Surface { genus };
    positions.iter_mut().for_each(|p| *p = surface.project(*p));
    // Information travels one edge per round: rounds in proportion to n relax the plate's corners at every n.
    for _ in 0..6 * n {
        relax(&mut positions, &quads, &surface);
    }
    let distance = |a: u32, b: u32| {
        let (p, q) = (positions[a as usize], positions[b as usize]);
        (0..3).map(|k| (p[k] - q[k]).powi(2)).sum::<f64>()
    };
    let mut faces = Vec::with_capacity(2 * quads.len());
    for [a, b, c, d] in quads {
        let halves =
            if distance(a, c) <= distance(b, d) { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] };
        faces.extend(halves);
    }
    Ok(Soup { positions, faces })
}

/// The outside of the plate of blocks as counterclockwise squares, centred like the tori.
fn plate(genus: usize, n: usize) -> (Vec<Point>, Vec<[u32; 4]>) {
    let size = [(2 * genus + 1) * n, 3 * n, n].map(|s| s as i64);
    let filled = |c: [i64; 3]| {
        let inside = (0..3).all(|k| c[k] >= 0 && c[k] < size[k]);
        let block = [c[0] / n as i64, c[1] / n as i64];
        inside && !(block[1] == 1 && block[0] % 2 == 1)
    };
    let mut known: HashMap<[i64; 3], u32> = HashMap::new();
    let (mut positions, mut quads) = (Vec::new(), Vec::new());
    let mut vertex = |c: [i64; 3]| {
        *known.entry(c).or_insert_with(|| {
            let x = c.map(|x| x as f64 / n as f64);
            positions.push([x[0] - 1.5, x[1] - 1.5, x[2] - 0.5]);
            positions.len() as u32 - 1
        })
    };
    vertex([2 * n, (3 * n).div_ceil(2), n.div_ceil(2)].map(|x| x as i64));
    for z in 0..size[2] {
        for y in 0..size[1] {
            for x in (0..size[0]).filter(|&x| filled([x, y, z])) {
                let cell = [x, y, z];
                for axis in 0..3 {
                    for side in [0, 1] {
                        let mut neighbour = cell;
                        neighbour[axis] += 2 * side - 1;
                        if filled(neighbour) {
                            continue;
                        }
                        let corner = |u: i64, v: i64| {
                            let mut c = cell;
                            c[axis] += side;
                            c[(axis + 1) % 3] += u;
                            c[(axis + 2) % 3] += v;
                            c
                        };
                        let mut square =
                            [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)].map(&mut vertex);
                        if side == 0 {
                            square.reverse();
                        }
                        quads.push(square);
                    }
                }
            }
        }
    }
    (positions, quads)
}

struct Surface {
    genus: usize,
}

impl Surface {
    /// F and its gradient.
    fn value(&self, p: Point) -> (f64, Point) {
        let torus = |k: usize| {
            let x = p[0] - 2.0 * k as f64;
            let rho = x.hypot(p[1]);
            let tube = (rho - 1.0).hypot(p[2]);
            let (radial, up) = ((rho - 1.0) / tube.max(1e-300), p[2] / tube.max(1e-300));
            (tube - TUBE, [radial * x / rho.max(1e-300), radial * p[1] / rho.max(1e-300), up])
        };
        let nearest = (0..self.genus).map(|k| torus(k).0).fold(f64::INFINITY, f64::min);
        let (mut sum, mut gradient) = (0.0, [0.0; 3]);
        for (distance, direction) in (0..self.genus).map(torus) {
            let weight = (-SHARPNESS * (distance - nearest)).exp();
            sum += weight;
            (0..3).for_each(|i| gradient[i] += weight * direction[i]);
        }
        (nearest - sum.ln() / SHARPNESS, gradient.map(|g| g / sum))
    }

    /// Newton along the gradient to F = 0.
    fn project(&self, mut p: Point) -> Point {
        for _ in 0..PROJECTION_STEPS {
            let (value, gradient) = self.value(p);
            if value.abs() <= ON_SURFACE {
                break;
            }
            let square: f64 = gradient.iter().map(|g| g * g).sum();
            (0..3).for_each(|i| p[i] -= value * gradient[i] / square.max(1e-6));
        }
        p
    }
}

/// Every vertex to the mean of its neighbours along the squares' sides, and back onto the surface.
fn relax(positions: &mut [Point], quads: &[[u32; 4]], surface: &Surface) {
    let mut sum = vec![([0.0; 3], 0.0); positions.len()];
    for quad in quads {
        for k in 0..4 {
            let (a, b) = (quad[k] as usize, quad[(k + 1) % 4] as usize);
            // Each side is seen from both its squares, in either direction: both ends get each other twice in all.
            (0..3).for_each(|i| sum[a].0[i] += positions[b][i]);
            sum[a].1 += 1.0;
            (0..3).for_each(|i| sum[b].0[i] += positions[a][i]);
            sum[b].1 += 1.0;
        }
    }
    for (p, (total, count)) in positions.iter_mut().zip(sum) {
        *p = surface.project(total.map(|x| x / count));
    }
}
