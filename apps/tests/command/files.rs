//! What the files say, computed with formulas of our own.

use crate::run::{numbers, triples};
use serde_json::Value;
use std::f64::consts::PI;

/// Angles of a triangle by the law of cosines, opposite the sides.
pub fn angles(space: &str, l: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| {
        let (a, b, c) = (l[(k + 1) % 3], l[(k + 2) % 3], l[k]);
        let cos = match space {
            "e2" => (a * a + b * b - c * c) / (2.0 * a * b),
            "h2" => (a.cosh() * b.cosh() - c.cosh()) / (a.sinh() * b.sinh()),
            "s2" => (c.cos() - a.cos() * b.cos()) / (a.sin() * b.sin()),
            _ => panic!("space {space}"),
        };
        cos.clamp(-1.0, 1.0).acos()
    })
}

/// Curvature at every vertex of a metric file, from `faces`, `lengths` and `boundary` alone.
pub fn curvature(metric: &Value) -> Vec<f64> {
    let space = metric["space"].as_str().unwrap();
    let boundary = metric["boundary"].as_array().unwrap();
    let mut k: Vec<f64> = boundary.iter().map(|b| if b.as_bool().unwrap() { PI } else { 2.0 * PI }).collect();
    for (corners, sides) in triples(&metric["faces"]).into_iter().zip(triples(&metric["lengths"])) {
        for (v, angle) in corners.into_iter().zip(angles(space, sides)) {
            k[v as usize] -= angle;
        }
    }
    k
}

/// Largest |K − K̄| of a metric file.
pub fn curvature_error(metric: &Value) -> f64 {
    let (k, target) = (curvature(metric), numbers(&metric["target"]));
    assert_eq!(k.len(), target.len());
    k.iter().zip(&target).fold(0.0, |m, (k, t)| f64::max(m, (k - t).abs()))
}

/// An OBJ file with texture coordinates, as written.
#[derive(Default)]
pub struct Obj {
    pub v: Vec<[f64; 3]>,
    pub vt: Vec<[f64; 2]>,
    pub faces: Vec<[usize; 3]>,
    pub corners: Vec<[usize; 3]>,
}

pub fn parse_obj(text: &str) -> Obj {
    let mut obj = Obj::default();
    for line in text.lines() {
        let mut tokens = line.split_whitespace();
        let kind = tokens.next();
        let rest: Vec<&str> = tokens.collect();
        let number = |k: usize| rest[k].parse::<f64>().unwrap();
        match kind {
            Some("v") => obj.v.push([number(0), number(1), number(2)]),
            Some("vt") => obj.vt.push([number(0), number(1)]),
            Some("f") => {
                let index = |k: usize, part: usize| {
                    rest[k].split('/').nth(part).unwrap().parse::<usize>().unwrap() - 1
                };
                obj.faces.push([index(0, 0), index(1, 0), index(2, 0)]);
                obj.corners.push([index(0, 1), index(1, 1), index(2, 1)]);
            }
            _ => {}
        }
    }
    obj
}

impl Obj {
    /// Signed area of a face in the layout.
    pub fn area(&self, f: usize) -> f64 {
        let [a, b, c] = self.corners[f].map(|i| self.vt[i]);
        0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
    }

    /// Sides of a face in the layout, opposite its corners.
    pub fn sides(&self, f: usize) -> [f64; 3] {
        let p = self.corners[f].map(|i| self.vt[i]);
        std::array::from_fn(|k| {
            let (a, b) = (p[(k + 1) % 3], p[(k + 2) % 3]);
            (a[0] - b[0]).hypot(a[1] - b[1])
        })
    }

    /// Area of the surface in space.
    pub fn surface_area(&self) -> f64 {
        let area = |f: &[usize; 3]| {
            let [a, b, c] = f.map(|i| self.v[i]);
            let (p, q): ([f64; 3], [f64; 3]) =
                (std::array::from_fn(|k| b[k] - a[k]), std::array::from_fn(|k| c[k] - a[k]));
            let n = [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
            0.5 * n.iter().map(|x| x * x).sum::<f64>().sqrt()
        };
        self.faces.iter().map(area).sum()
    }
}
