//! Möbius matrices from files, with arithmetic of our own.

use crate::run::numbers;
use serde_json::Value;
use std::collections::BTreeMap;

pub type C = [f64; 2];
pub type Matrix = [[C; 2]; 2];

pub const ONE: Matrix = [[[1.0, 0.0], [0.0, 0.0]], [[0.0, 0.0], [1.0, 0.0]]];

pub fn add(a: C, b: C) -> C {
    [a[0] + b[0], a[1] + b[1]]
}

pub fn mul(a: C, b: C) -> C {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

pub fn div(a: C, b: C) -> C {
    let n = b[0] * b[0] + b[1] * b[1];
    mul(a, [b[0] / n, -b[1] / n])
}

fn neg(a: C) -> C {
    [-a[0], -a[1]]
}

pub fn determinant(m: &Matrix) -> C {
    add(mul(m[0][0], m[1][1]), neg(mul(m[0][1], m[1][0])))
}

pub fn times(a: &Matrix, b: &Matrix) -> Matrix {
    let entry = |i: usize, j: usize| add(mul(a[i][0], b[0][j]), mul(a[i][1], b[1][j]));
    [[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]]
}

pub fn inverse(m: &Matrix) -> Matrix {
    let d = determinant(m);
    [[div(m[1][1], d), div(neg(m[0][1]), d)], [div(neg(m[1][0]), d), div(m[0][0], d)]]
}

/// The image of a point of the plane or the Poincaré disk.
pub fn apply(m: &Matrix, z: C) -> C {
    div(add(mul(m[0][0], z), m[0][1]), add(mul(m[1][0], z), m[1][1]))
}

/// |trace| at determinant 1.
pub fn trace(m: &Matrix) -> f64 {
    let (t, d) = (add(m[0][0], m[1][1]), determinant(m));
    t[0].hypot(t[1]) / d[0].hypot(d[1]).sqrt()
}

pub fn matrix(value: &Value) -> Matrix {
    let entry = |i: usize, j: usize| -> C { numbers(&value[i][j]).try_into().unwrap() };
    [[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]]
}

/// A generators file.
pub struct Group {
    pub generators: BTreeMap<String, Matrix>,
    pub word: Vec<String>,
}

impl Group {
    pub fn read(file: &Value) -> Group {
        let all = file["generators"].as_object().unwrap();
        let word = file["word"].as_array().unwrap().iter().map(|w| w.as_str().unwrap().into()).collect();
        assert_eq!(all.len(), file["basis"].as_array().unwrap().len());
        Group { generators: all.iter().map(|(k, m)| (k.clone(), matrix(m))).collect(), word }
    }

    /// The matrix of a word.
    pub fn element<'a>(&self, letters: impl Iterator<Item = &'a str>) -> Matrix {
        letters.fold(ONE, |m, letter| {
            let (name, back) = letter.strip_suffix("^-1").map_or((letter, false), |name| (name, true));
            let g = self.generators[name];
            times(&m, &if back { inverse(&g) } else { g })
        })
    }

    /// How far the relator is from ±1, over the largest square of the norm of a partial product.
    pub fn residual(&self) -> f64 {
        let norm = |m: &Matrix| m.iter().flatten().flatten().map(|x| x * x).sum::<f64>();
        let largest = (0..=self.word.len())
            .map(|k| norm(&self.element(self.word[..k].iter().map(String::as_str))))
            .fold(1.0, f64::max);
        let m = self.element(self.word.iter().map(String::as_str));
        let off = |sign: f64| {
            let rest = |i: usize, j: usize, k: usize| m[i][j][k] - sign * ONE[i][j][k];
            let square = |(i, j, k): (usize, usize, usize)| rest(i, j, k).powi(2);
            (0..8).map(|b| square((b & 1, b >> 1 & 1, b >> 2))).sum::<f64>().sqrt()
        };
        off(1.0).min(off(-1.0)) / largest
    }
}
