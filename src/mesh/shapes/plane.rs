//! Disks and annuli in the plane z = 0.

use super::{THIN, check_count, check_size};
use crate::error::{Error, Result};
use crate::mesh::io::Soup;
use std::f64::consts::TAU;

/// The unit disk: a centre and n rings, 6k vertices on ring k at radius k/n, joined by nearly equilateral
/// triangles. 3n(n + 1) + 1 vertices, 6n² faces. n ≥ 1.
///
/// # Errors
///
/// [`Error::Argument`] for n out of range.
pub fn disk(n: usize) -> Result<Soup> {
    check_count("rings", n, 1, 3.0 * (n as f64).powi(2))?;
    let mut soup = Soup::new(vec![[0.0; 3]], Vec::new());
    // The first vertex of ring k.
    let start = |k: usize| if k == 0 { 0 } else { 3 * k * (k - 1) + 1 };
    for k in 1..=n {
        let radius = k as f64 / n as f64;
        for i in 0..6 * k {
            let (sin, cos) = (TAU * i as f64 / (6 * k) as f64).sin_cos();
            soup.positions.push([radius * cos, radius * sin, 0.0]);
        }
        let outer = |i: usize| (start(k) + i % (6 * k)) as u32;
        let inner = |i: usize| (start(k - 1) + if k == 1 { 0 } else { i % (6 * (k - 1)) }) as u32;
        for sector in 0..6 {
            for i in 0..k {
                let (o, p) = (sector * k + i, sector * (k - 1) + i);
                soup.faces.push([outer(o), outer(o + 1), inner(p)]);
                if i + 1 < k {
                    soup.faces.push([inner(p), outer(o + 1), inner(p + 1)]);
                }
            }
        }
    }
    Ok(soup)
}

/// The annulus between the radii `inner` < `outer`: `n_radial` ≥ 1 steps in geometric progression, `n_around` ≥ 3 steps, alternate rings
/// turned by half a step. (n_radial + 1)·n_around vertices, ring by ring from inside.
///
/// # Errors
///
/// [`Error::Argument`] for radii outside 1e-150 … 1e150 or not increasing, counts out of range, and rings so close or so far apart that
/// no triangle between them has an area in f64.
pub fn annulus(inner: f64, outer: f64, n_radial: usize, n_around: usize) -> Result<Soup> {
    check_size("inner radius", inner)?;
    check_size("outer radius", outer)?;
    if inner >= outer {
        return Err(Error::argument("inner radius", inner, "below the outer radius"));
    }
    let vertices = n_radial as f64 * n_around as f64;
    check_count("radial steps", n_radial, 1, vertices)?;
    check_count("steps around", n_around, 3, vertices)?;
    // The logarithm of the ratio of neighbouring rings.
    let step = (outer / inner).ln() / n_radial as f64;
    if !(THIN..=-THIN.ln()).contains(&step) {
        let need =
            if step < THIN { "fewer: the rings would coincide" } else { "more: a step has no area in f64" };
        return Err(Error::argument("radial steps", n_radial, need));
    }
    let mut soup = Soup::default();
    for k in 0..=n_radial {
        let radius = inner * (outer / inner).powf(k as f64 / n_radial as f64);
        for i in 0..n_around {
            let turn = (i as f64 + 0.5 * (k % 2) as f64) / n_around as f64;
            let (sin, cos) = (TAU * turn).sin_cos();
            soup.positions.push([radius * cos, radius * sin, 0.0]);
        }
    }
    let at = |k: usize, i: usize| (k * n_around + i % n_around) as u32;
    for k in 0..n_radial {
        for i in 0..n_around {
            // Ring k + 1 is half a step ahead of an even ring k and half a step behind an odd one.
            let (a, b) = (at(k, i), at(k, i + 1));
            let (c, d) = (at(k + 1, i), at(k + 1, i + 1));
            let cell = if k % 2 == 0 { [[a, c, b], [b, c, d]] } else { [[a, c, d], [a, d, b]] };
            soup.faces.extend(cell);
        }
    }
    Ok(soup)
}
