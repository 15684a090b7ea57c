//! Rotations of the sphere that bring one conformal factor as near as possible to another one.

use crate::control::Control;
use crate::error::Result;
use crate::geometry::vector::{Vector, cross, dot, normalised};
use crate::linalg::dense::symmetric_eigenvectors;

/// A function on the sphere, given at points, with a measure: positive weights with the sum 1.
pub(super) struct SphereSamples {
    pub points: Vec<Vector>,
    pub values: Vec<f64>,
    pub weights: Vec<f64>,
}

/// A rotation, by rows.
pub(super) type Rotation = [Vector; 3];
/// The rotation that moves nothing.
pub(super) const IDENTITY: Rotation = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// Cells of a raster of the sphere along a meridian; twice as many along the equator.
const ROWS: usize = 24;
/// Rotations of the coarse search that are refined.
const REFINED: usize = 3;
/// Halvings of the step of the refinement.
const HALVINGS: usize = 8;

/// Candidates for the rotation of the first function that fits it to the second one: the identity, the rotations that bring the axes of
/// inertia of its measure to those of the other one (exact for copies of one surface), and the best of a search by the difference of the
/// two functions on a raster.
///
/// # Errors
/// Those of [`symmetric_eigenvectors`].
pub(super) fn turnings([from, to]: [&SphereSamples; 2], control: &Control) -> Result<Vec<Rotation>> {
    let (own, other) = (axes(from)?, axes(to)?);
    // Two identical surfaces fit without a rotation, to the last digit.
    let mut all = vec![IDENTITY];
    for [a, b] in [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]] {
        let turned = [own[0].map(|x| a * x), own[1].map(|x| b * x)];
        all.push(bringing([turned[0], turned[1]], [other[0], other[1]]));
    }
    let samples = SphereRaster::new(from).samples();
    control.check()?;
    let raster = SphereRaster::new(to);
    let off = |turn: &Rotation| raster.difference(turn, &samples);
    let tried = |turn| control.check().map(|()| (off(&turn), turn));
    let mut coarse: Vec<(f64, Rotation)> = grid().into_iter().map(tried).collect::<Result<_>>()?;
    coarse.sort_by(|a, b| a.0.total_cmp(&b.0));
    for (_, turn) in coarse.into_iter().take(REFINED) {
        control.check()?;
        all.push(refined(turn, &off));
    }
    Ok(all)
}

/// The axes of inertia of the measure, by descending moment; orthonormal.
fn axes(of: &SphereSamples) -> Result<[Vector; 3]> {
    let mut moment = [[0.0; 3]; 3];
    for (p, w) in of.points.iter().zip(&of.weights) {
        for (i, row) in moment.iter_mut().enumerate() {
            (0..3).for_each(|j| row[j] += w * p[i] * p[j]);
        }
    }
    let vectors = symmetric_eigenvectors(&moment.map(|row| row.to_vec()))?;
    let vector = |k: usize| [vectors[k][0], vectors[k][1], vectors[k][2]];
    let (a, b) = (vector(2), vector(1));
    Ok([a, b, cross(a, b)])
}

/// The rotation that brings two orthonormal vectors to two others.
fn bringing(from: [Vector; 2], to: [Vector; 2]) -> Rotation {
    let [own, other] = [from, to].map(|[a, b]| [a, b, cross(a, b)]);
    std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| other[k][i] * own[k][j]).sum()))
}

/// Rotations about 20° apart: for poles all over the sphere, and turns about them.
fn grid() -> Vec<Rotation> {
    let n = 96;
    let mut all = Vec::new();
    for k in 0..n {
        // Fibonacci's spiral of points on the sphere.
        let z = 1.0 - (2.0 * k as f64 + 1.0) / n as f64;
        let angle = k as f64 * std::f64::consts::PI * (3.0 - 5f64.sqrt());
        let r = (1.0 - z * z).sqrt();
        let pole = [r * angle.cos(), r * angle.sin(), z];
        let across = if pole[2].abs() < 0.9 { [0.0, 0.0, 1.0] } else { [1.0, 0.0, 0.0] };
        let first = normalised(cross(across, pole));
        let second = cross(pole, first);
        for turn in 0..18 {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(turn) / 18.0).sin_cos();
            let x: Vector = std::array::from_fn(|i| cos * first[i] + sin * second[i]);
            all.push(bringing([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]], [pole, x]));
        }
    }
    all
}

/// The rotation after turns about the three axes in smaller and smaller steps, each of which brings the functions nearer.
fn refined(mut turn: Rotation, off: &impl Fn(&Rotation) -> f64) -> Rotation {
    let (mut least, mut step) = (off(&turn), 0.2);
    for _ in 0..HALVINGS {
        for axis in 0..3 {
            for angle in [step, -step] {
                let next = turned(&turn, axis, angle);
                let value = off(&next);
                if value < least {
                    (least, turn) = (value, next);
                }
            }
        }
        step *= 0.5;
    }
    turn
}

/// The rotation followed by a turn about an axis.
fn turned(turn: &Rotation, axis: usize, angle: f64) -> Rotation {
    let (sin, cos) = angle.sin_cos();
    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut next = *turn;
    next[i] = std::array::from_fn(|k| cos * turn[i][k] - sin * turn[j][k]);
    next[j] = std::array::from_fn(|k| sin * turn[i][k] + cos * turn[j][k]);
    next
}

/// Means of a function in cells of equal height on the axis.
struct SphereRaster {
    values: Vec<Option<(f64, f64)>>,
}

impl SphereRaster {
    fn new(of: &SphereSamples) -> SphereRaster {
        let mut sums = vec![[0.0; 2]; 2 * ROWS * ROWS];
        for ((p, value), w) in of.points.iter().zip(&of.values).zip(&of.weights) {
            let cell = &mut sums[cell(*p)];
            (cell[0], cell[1]) = (cell[0] + w * value, cell[1] + w);
        }
        SphereRaster { values: sums.into_iter().map(|[sum, w]| (w > 0.0).then(|| (sum / w, w))).collect() }
    }

    /// The middles of the cells that hold points, with the values and weights of the cells.
    fn samples(&self) -> Vec<(Vector, f64, f64)> {
        let at = |(k, value): (usize, &Option<(f64, f64)>)| value.map(|(value, w)| (middle(k), value, w));
        self.values.iter().enumerate().filter_map(at).collect()
    }

    /// The mean square difference to rotated samples; those that meet an empty cell do not count.
    fn difference(&self, turn: &Rotation, samples: &[(Vector, f64, f64)]) -> f64 {
        let (mut sum, mut total) = (0.0, f64::MIN_POSITIVE);
        for (p, value, w) in samples {
            if let Some((other, _)) = self.values[cell(turn.map(|row| dot(row, *p)))] {
                sum += w * (value - other) * (value - other);
                total += w;
            }
        }
        sum / total
    }
}

fn cell(p: Vector) -> usize {
    let row = ((0.5 * (1.0 - p[2]) * ROWS as f64) as usize).min(ROWS - 1);
    let turn = p[1].atan2(p[0]).rem_euclid(std::f64::consts::TAU) / std::f64::consts::TAU;
    row * 2 * ROWS + ((turn * 2.0 * ROWS as f64) as usize).min(2 * ROWS - 1)
}

fn middle(cell: usize) -> Vector {
    let z = 1.0 - 2.0 * ((cell / (2 * ROWS)) as f64 + 0.5) / ROWS as f64;
    let angle = std::f64::consts::TAU * ((cell % (2 * ROWS)) as f64 + 0.5) / (2 * ROWS) as f64;
    let r = (1.0 - z * z).sqrt();
    [r * angle.cos(), r * angle.sin(), z]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::vector::sub;

    #[test]
    fn a_turned_copy_is_found_by_its_axes() {
        let points: Vec<Vector> =
            grid().iter().map(|turn| normalised([turn[0][0], turn[1][0], turn[2][0] + 0.3])).collect();
        let n = points.len() as f64;
        let weights: Vec<f64> =
            (0..points.len()).map(|k| (1.0 + (points[k][0] - 0.4 * points[k][1]).sin()) / n).collect();
        let values: Vec<f64> = points.iter().map(|p| (3.0 * p[0]).sin() + p[1] * p[2]).collect();
        let by = grid()[701];
        let turned: Vec<Vector> = points.iter().map(|p| by.map(|row| dot(row, *p))).collect();
        let [from, to] = [points, turned].map(|points| SphereSamples {
            points,
            values: values.clone(),
            weights: weights.clone(),
        });
        let off =
            |turn: &Rotation| (0..3).map(|i| dot(sub(turn[i], by[i]), sub(turn[i], by[i]))).sum::<f64>();
        assert!(turnings([&from, &to], &Control::new()).unwrap()[..5].iter().any(|turn| off(turn) < 1e-20));
    }
}
