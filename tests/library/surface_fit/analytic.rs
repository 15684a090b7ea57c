//! Surfaces of which the distance, the normal and the mean curvature are known everywhere, as level sets.

use ricci::Control;
use ricci::mesh::io::Soup;
use ricci::mesh::shapes::{self, SplitMix64};
use ricci::spline::{Parameter, Spline};
use std::f64::consts::TAU;

/// A function whose level 0 is the surface, negative inside.
pub type LevelFunction = fn([f64; 3]) -> f64;

/// The largest and the root mean square errors of a spline.
#[derive(Debug, Clone, Copy)]
pub struct SplineErrors {
    /// Distance from the surface, over the diagonal.
    pub rms: f64,
    pub max: f64,
    /// Angle of normals, in radians.
    pub normal: f64,
    pub normal_rms: f64,
    /// Mean curvature, over its largest value.
    pub curvature: f64,
    pub curvature_rms: f64,
}

/// Steps of differences.
const STEP: f64 = 1e-4;

fn gradient(f: LevelFunction, p: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|x| {
        let moved = |by: f64| {
            let mut q = p;
            q[x] += by;
            f(q)
        };
        (8.0 * (moved(STEP) - moved(-STEP)) - (moved(2.0 * STEP) - moved(-2.0 * STEP))) / (12.0 * STEP)
    })
}

fn norm(v: [f64; 3]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn unit_normal(f: LevelFunction, p: [f64; 3]) -> [f64; 3] {
    let g = gradient(f, p);
    g.map(|x| x / norm(g))
}

/// Half the divergence of the unit normal.
fn mean_curvature(f: LevelFunction, p: [f64; 3]) -> f64 {
    let part = |x: usize| {
        let moved = |by: f64| {
            let mut q = p;
            q[x] += by;
            unit_normal(f, q)[x]
        };
        (moved(10.0 * STEP) - moved(-10.0 * STEP)) / (20.0 * STEP)
    };
    0.5 * (part(0) + part(1) + part(2))
}

/// The diagonal of the bounding box of the control points.
fn extent(spline: &Spline) -> f64 {
    let range = |x: usize| {
        let all = || spline.control_points().iter().map(|p| p[x]);
        all().fold(f64::NEG_INFINITY, f64::max) - all().fold(f64::INFINITY, f64::min)
    };
    norm([range(0), range(1), range(2)])
}

/// The errors at places in all patches; some of each patch are near its corners and sides.
pub fn errors(spline: &Spline, f: LevelFunction) -> SplineErrors {
    let diagonal = extent(spline);
    let mut places = Vec::new();
    for (k, patch) in spline.space().patches().iter().enumerate() {
        let corners = patch.corners();
        for i in 0..6 {
            for j in 0..6 - i {
                let [s, t] = [i, j].map(|x| (f64::from(x) + 0.28) / 5.9);
                let at = |x: usize| (1.0 - s - t) * corners[0][x] + s * corners[1][x] + t * corners[2][x];
                let at = Parameter { patch: k as u32, x: at(0), y: at(1) };
                if !spline.is_in_hole(at) {
                    places.push(at);
                }
            }
        }
    }
    let found = spline.evaluate(&places, 2, 0, &Control::new()).unwrap();
    let mut all =
        SplineErrors { rms: 0.0, max: 0.0, normal: 0.0, normal_rms: 0.0, curvature: 0.0, curvature_rms: 0.0 };
    let mut largest = 0.0f64;
    for at in &found {
        let miss = (f(at.point) / norm(gradient(f, at.point)) / diagonal).abs();
        let exact = unit_normal(f, at.point);
        let normal = at.normal().unwrap();
        let cosine: f64 = (0..3).map(|x| normal[x] * exact[x]).sum();
        let sine = norm([
            normal[1] * exact[2] - normal[2] * exact[1],
            normal[2] * exact[0] - normal[0] * exact[2],
            normal[0] * exact[1] - normal[1] * exact[0],
        ]);
        let angle = sine.atan2(cosine);
        let [k, l] = at.principal_curvatures().unwrap();
        let h = mean_curvature(f, at.point);
        largest = largest.max(h.abs());
        let bend = (0.5 * (k + l) + h).abs();
        all.max = all.max.max(miss);
        all.rms += miss * miss;
        all.normal = all.normal.max(angle);
        all.normal_rms += angle * angle;
        all.curvature = all.curvature.max(bend);
        all.curvature_rms += bend * bend;
    }
    let n = found.len() as f64;
    all.rms = (all.rms / n).sqrt();
    all.normal_rms = (all.normal_rms / n).sqrt();
    all.curvature_rms = (all.curvature_rms / n).sqrt() / largest;
    all.curvature /= largest;
    all
}

pub fn torus_level([x, y, z]: [f64; 3]) -> f64 {
    let far = x.hypot(y) - 1.0;
    far.hypot(z) - 0.4
}

/// A torus with the radii 1 and 0.4; vertices of a regular grid are moved by a share of its steps.
pub fn torus(n_u: usize, n_v: usize, jitter: f64) -> Soup {
    let mut soup = shapes::torus(1.0, 0.4, n_u, n_v).unwrap();
    let mut random = SplitMix64::new(7);
    let mut next = || (random.bits() >> 11) as f64 / (1u64 << 53) as f64 - 0.5;
    for (k, p) in soup.positions.iter_mut().enumerate() {
        let u = TAU * ((k % n_u) as f64 + jitter * next()) / n_u as f64;
        let v = TAU * ((k / n_u) as f64 + jitter * next()) / n_v as f64;
        let r = 1.0 + 0.4 * v.cos();
        *p = [r * u.cos(), r * u.sin(), 0.4 * v.sin()];
    }
    soup
}

/// A height over the plane, with bumps.
fn height(x: f64, y: f64) -> f64 {
    0.2 * (2.0 * x).sin() * (1.7 * y + 0.3).cos()
}

pub fn bumps_level([x, y, z]: [f64; 3]) -> f64 {
    z - height(x, y)
}

/// A square of side 2 with bumps, around the z axis; inner vertices of a regular grid of n steps are moved by a share of them.
pub fn bumps(n: usize, jitter: f64) -> Soup {
    let mut random = SplitMix64::new(7);
    let mut next = || (random.bits() >> 11) as f64 / (1u64 << 53) as f64 - 0.5;
    let is_inner = |k: usize| k > 0 && k < n;
    let mut positions = Vec::new();
    for (j, i) in (0..(n + 1) * (n + 1)).map(|k| (k / (n + 1), k % (n + 1))) {
        let moved = |k: usize, by: f64| 2.0 * (k as f64 + by) / n as f64 - 1.0;
        let is_moved = is_inner(i) && is_inner(j);
        let [a, b] = [next(), next()].map(|x| if is_moved { jitter * x } else { 0.0 });
        let [x, y] = [moved(i, a), moved(j, b)];
        positions.push([x, y, height(x, y)]);
    }
    let corner = |k: usize| ((k / n) * (n + 1) + k % n) as u32;
    let cells = (0..n * n).map(corner);
    let above = n as u32 + 1;
    let faces = cells.flat_map(|k| [[k, k + 1, k + above + 1], [k, k + above + 1, k + above]]).collect();
    Soup::new(positions, faces)
}
