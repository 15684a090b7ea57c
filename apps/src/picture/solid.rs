//! The surface in space: camera, normals, seams and cones on it.

use super::checker::{Checker, Tiles};
use super::raster::{Paint, Primitive, Rgb, dot, line};
use super::{Fit, LINE, Surface, cone_color, seam_color};

type V3 = [f64; 3];

/// Colour of a surface without layout.
const CLAY: Rgb = [0.62, 0.56, 0.48];
/// How far lines and dots are lifted off the surface, as a share of its size.
const LIFT: f64 = 0.006;
/// Share of the area that must face one way for a side to be the outside: none does on a closed surface.
const FACING: f64 = 1e-6;
/// The view is this far from the normal of the widest side: depth shows without hiding the shape.
const TILT: [f64; 2] = [0.45, 0.35];

pub fn primitives(surface: &Surface<'_>, tiles: Option<&Tiles>) -> Vec<Primitive> {
    let finite = |p: &V3| p.iter().all(|x| x.is_finite());
    if surface.positions.is_empty() || !surface.positions.iter().all(finite) {
        return Vec::new();
    }
    let (view, centre) = camera(surface.positions, surface.faces);
    let seen: Vec<V3> =
        surface.positions.iter().map(|p| view.map(|axis| dot3(axis, sub(*p, centre)))).collect();
    let fit = Fit::new(seen.iter().map(|p| [p[0], p[1]]));
    let pixels: Vec<[f64; 2]> = seen.iter().map(|p| fit.apply([p[0], p[1]])).collect();
    let depth: Vec<f64> = seen.iter().map(|p| fit.scale * p[2]).collect();
    let corners = |f: usize| surface.faces[f].map(|v| v as usize);
    let normals = vertex_normals(&seen, surface.faces);
    let mut out = Vec::with_capacity(surface.faces.len());
    for f in 0..surface.faces.len() {
        let c = corners(f);
        let xy = c.map(|v| pixels[v]);
        let checker = surface.corner_uv.zip(tiles).map(|(uv, tiles)| Checker::new(uv[f], tiles, f, xy));
        let paint = Paint::Lit { normals: c.map(|v| normals[v]), checker, base: CLAY };
        out.push(Primitive { xy, z: c.map(|v| depth[v]), paint });
    }
    let lift = LIFT * super::PANEL as f64;
    for &(a, b, seam) in surface.seams {
        let (a, b) = (a as usize, b as usize);
        line(&mut out, pixels[a], pixels[b], [depth[a] + lift, depth[b] + lift], LINE, seam_color(seam));
    }
    for &(v, curvature) in surface.cones {
        let v = v as usize;
        dot(&mut out, pixels[v], depth[v] + 2.0 * lift, 5.0, cone_color(curvature));
    }
    out
}

/// Rows: screen x, screen y, towards the viewer. From the principal axes of the points: the longest across, the shortest
/// nearly towards the viewer. An open surface shows its outside. With the centre of the points.
fn camera(points: &[V3], faces: &[[u32; 3]]) -> ([V3; 3], V3) {
    let n = points.len() as f64;
    let mean = [0, 1, 2].map(|k| points.iter().map(|p| p[k]).sum::<f64>() / n);
    let mut m = [[0.0; 3]; 3];
    for p in points {
        let d = [0, 1, 2].map(|k| p[k] - mean[k]);
        for i in 0..3 {
            (0..3).for_each(|j| m[i][j] += d[i] * d[j]);
        }
    }
    let axes = principal_axes(m);
    // A right-handed frame whose axes point the way the coordinates do, for want of anything better.
    let ahead = |a: V3| {
        let largest = (0..3).fold(0, |l, k| if a[k].abs() > a[l].abs() { k } else { l });
        if a[largest] < 0.0 { a.map(|x| -x) } else { a }
    };
    let x = ahead(axes[0]);
    let mut y = ahead(axes[1]);
    let (mut outside, mut total) = ([0.0; 3], 0.0);
    for face in faces {
        let n = normal(face.map(|v| points[v as usize]));
        total += norm(n);
        (0..3).for_each(|k| outside[k] += n[k]);
    }
    // Mostly vertical things stand upright: the longer axis goes up if it is the vertical one of the file.
    let (x, z) = if x[1].abs() > 0.8 {
        let z = cross(ahead(y), x);
        let across = ahead(y);
        y = x;
        (across, z)
    } else {
        (x, cross(x, y))
    };
    // Half a turn about the vertical where the viewer would look at the back.
    let (x, z) = if dot3(outside, z) < -FACING * total { (x.map(|a| -a), z.map(|a| -a)) } else { (x, z) };
    let (sa, ca) = TILT[0].sin_cos();
    let turned_x = [0, 1, 2].map(|k| ca * x[k] - sa * z[k]);
    let turned_z = [0, 1, 2].map(|k| sa * x[k] + ca * z[k]);
    let (sb, cb) = TILT[1].sin_cos();
    let up = [0, 1, 2].map(|k| cb * y[k] - sb * turned_z[k]);
    let towards = [0, 1, 2].map(|k| sb * y[k] + cb * turned_z[k]);
    ([turned_x, up, towards], mean)
}

/// Eigenvectors of a symmetric matrix, largest eigenvalue first, by Jacobi rotations.
fn principal_axes(mut m: [[f64; 3]; 3]) -> [V3; 3] {
    let mut v = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for _ in 0..30 {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if m[p][q].abs() <= 1e-14 * (m[p][p].abs() + m[q][q].abs()) {
                continue;
            }
            let theta = 0.5 * f64::atan2(2.0 * m[p][q], m[p][p] - m[q][q]);
            let (s, c) = theta.sin_cos();
            for row in &mut m {
                (row[p], row[q]) = (c * row[p] + s * row[q], c * row[q] - s * row[p]);
            }
            for k in 0..3 {
                (m[p][k], m[q][k]) = (c * m[p][k] + s * m[q][k], c * m[q][k] - s * m[p][k]);
                (v[p][k], v[q][k]) = (c * v[p][k] + s * v[q][k], c * v[q][k] - s * v[p][k]);
            }
        }
    }
    let mut order = [0, 1, 2];
    order.sort_by(|&a, &b| m[b][b].total_cmp(&m[a][a]));
    order.map(|k| v[k])
}

/// Angle-weighted vertex normals.
fn vertex_normals(points: &[V3], faces: &[[u32; 3]]) -> Vec<V3> {
    let mut normals = vec![[0.0; 3]; points.len()];
    for face in faces {
        let p = face.map(|v| points[v as usize]);
        let n = normal(p);
        let length = norm(n);
        if length == 0.0 {
            continue;
        }
        for k in 0..3 {
            let (a, b) = (sub(p[(k + 1) % 3], p[k]), sub(p[(k + 2) % 3], p[k]));
            let angle = f64::atan2(length, dot3(a, b));
            (0..3).for_each(|i| normals[face[k] as usize][i] += angle * n[i] / length);
        }
    }
    normals
}

fn sub(a: V3, b: V3) -> V3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(a: V3, b: V3) -> V3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub fn normal(p: [V3; 3]) -> V3 {
    cross(sub(p[1], p[0]), sub(p[2], p[0]))
}

fn dot3(a: V3, b: V3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn norm(a: V3) -> f64 {
    dot3(a, a).sqrt()
}
