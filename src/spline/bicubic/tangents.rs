//! Common tangent planes of neighbouring patches.

use super::cubic::{interpolate, uniform};
use super::sample::QuadSample;
use super::surface::BicubicSurface;
use crate::geometry::vector::{Vector, add, cross, dot, normalised, scale, sub};

/// Least cosine of the angle between normals and their mean for the mean to be taken: an angle of more than 0.2 rad is a crease of the
/// spline, which stays.
const CREASE: f64 = 0.98;

/// Sets the curves of a surface from samples, and returns for each patch the derivatives across its sides at the ends of spans, with a
/// common tangent plane where patches meet.
pub(super) fn with_common_planes(
    surface: &mut BicubicSurface,
    samples: &[QuadSample],
) -> Vec<[Vec<Vector>; 4]> {
    let normals = point_normals(surface, samples);
    let uses = surface.uses();
    let mut across: Vec<[Vec<Vector>; 4]> = samples.iter().map(|sample| sample.across.clone()).collect();
    for (at, of) in uses.iter().enumerate() {
        // A curve runs along growing s or t of the first patch that has it.
        let (first, side) = of[0];
        let mut values = samples[first].along(side);
        let mut ends = samples[first].ends(side);
        let curve = &mut surface.curves[at];
        let spans = values.len() - 1;
        for (k, i) in [(0, 0), (1, spans)] {
            values[i] = surface.points[curve.ends[k] as usize];
            ends[k] = normals[curve.ends[k] as usize].map_or(ends[k], |normal| beside(ends[k], normal));
        }
        curve.knots = uniform(spans);
        curve.control = interpolate(&values, ends);
        let curve = surface.curves[at].clone();
        if let [a, b] = of[..] {
            for i in 1..spans {
                let tangent = curve.evaluate(i as f64 / spans as f64)[1];
                share_plane(
                    [a, b].map(|(q, k)| (q, k, along(surface, (q, k), i, spans))),
                    tangent,
                    &mut across,
                );
            }
        }
        // The derivative of a curve at its end is the derivative across the side that meets it there.
        for &(q, k) in of {
            let backwards = runs_backwards(surface, (q, k));
            let ends = if backwards { [ends[1], ends[0]].map(|d| scale(-1.0, d)) } else { ends };
            let corner = [0, usize::MAX, usize::MAX, 0][k];
            for (end, crossed) in ends.into_iter().zip([[3, 1], [0, 2]][k % 2]) {
                let row = &mut across[q][crossed];
                let i = corner.min(row.len() - 1);
                row[i] = end;
            }
        }
    }
    across
}

/// True if the curve of a side runs against growing s or t.
fn runs_backwards(surface: &BicubicSurface, (q, k): (usize, usize)) -> bool {
    (k >= 2) != surface.patches[q].sides[k].reversed
}

/// The index along a side of the end of span i of its curve.
fn along(surface: &BicubicSurface, of: (usize, usize), i: usize, spans: usize) -> usize {
    if runs_backwards(surface, of) { spans - i } else { i }
}

/// Projects the derivatives across a curve, given by patch, side and index for its two patches, to the mean of their tangent planes.
fn share_plane(sides: [(usize, usize, usize); 2], tangent: Vector, across: &mut [[Vec<Vector>; 4]]) {
    // Derivatives point into one patch and out of the other, or into both, so the normals agree up to sign.
    let derivative = |across: &[[Vec<Vector>; 4]], (q, k, i): (usize, usize, usize)| across[q][k][i];
    let [a, b] = sides.map(|of| normalised(cross(tangent, derivative(across, of))));
    let b = if dot(a, b) < 0.0 { scale(-1.0, b) } else { b };
    let mean = normalised(add(a, b));
    if dot(mean, a) < CREASE || !dot(mean, a).is_finite() {
        return;
    }
    for (q, k, i) in sides {
        across[q][k][i] = beside(across[q][k][i], mean);
    }
}

/// For each point the mean of the normals of the patches that meet there; none at creases.
fn point_normals(surface: &BicubicSurface, samples: &[QuadSample]) -> Vec<Option<Vector>> {
    let mut all = vec![Vec::new(); surface.points.len()];
    for (patch, sample) in surface.patches.iter().zip(samples) {
        for (k, point) in patch.corners(&surface.curves).into_iter().enumerate() {
            all[point as usize].push(normalised(sample.normal(k)));
        }
    }
    let mean = |normals: &Vec<Vector>| {
        let mean = normalised(normals.iter().fold([0.0; 3], |sum, &normal| add(sum, normal)));
        normals.iter().all(|&normal| dot(normal, mean) >= CREASE).then_some(mean)
    };
    all.iter().map(mean).collect()
}

/// The projection of a vector to the plane orthogonal to a normal.
fn beside(vector: Vector, normal: Vector) -> Vector {
    sub(vector, scale(dot(vector, normal), normal))
}
