//! The fairness energy of splines, a quadratic form of the control points for each patch.

use super::patch::{Parameter, Patch};
use super::recurrence::Scratch;
use super::space::SplineSpace;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::complex::{Complex, distance as between, doubled_area};
use crate::parallel;
use std::f64::consts::SQRT_2;

/// Number of sample points along each side of a patch: enough that some lie in the strips between the knots of two vertices.
const GRID: usize = 8;
/// Number of sample points in a patch.
const SAMPLES: usize = GRID * (GRID + 1) / 2;
/// Weight of the bending relative to that of its variation: it matters where there are fewer points than a quadratic polynomial needs.
const BENDING: f64 = 0.1;

/// Largest entry of a patch's energy over that of the median patch: thinner patches have larger ones.
const THIN: f64 = 1e6;

/// The unit of length of the fairness energy, and what it is a mean of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum FairnessUnit {
    /// The mean side of all triangles, all in one plane; an integral over the domain times its area.
    Domain,
    /// The longest side of each triangle; a mean over the triangles. The energy depends neither on the sizes of charts nor on the number of
    /// triangles: it compares the third differences of the control points with the distances of points.
    Patches,
}

/// The energy in one patch: the numbers of control points, ascending, and the lower triangle of a matrix by rows.
pub(super) struct PatchEnergy {
    pub control: Vec<u32>,
    pub matrix: Vec<f64>,
}

/// The energies of all patches, whose sum is the energy of the spline.
///
/// # Errors
/// Those of [`SplineSpace::each`]; [`Error::Cancelled`].
pub(super) fn energies(
    space: &SplineSpace,
    unit: FairnessUnit,
    control: &Control,
) -> Result<Vec<PatchEnergy>> {
    let grids: Vec<FairnessGrid> = space.patches().iter().map(FairnessGrid::new).collect();
    let area: f64 = grids.iter().map(|grid| grid.area).sum();
    let count = grids.len().max(1) as f64;
    // The unit of length is the side of an equilateral triangle of the mean area, so that a larger domain is as fair.
    let side = (4.0 / 3f64.sqrt() * area / count).sqrt();
    let mut found: Vec<Result<PatchEnergy>> = Vec::new();
    found.resize_with(grids.len(), || Ok(PatchEnergy { control: Vec::new(), matrix: Vec::new() }));
    parallel::fill_with(&mut found, Scratch::default, |scratch, patch| {
        if control.is_cancelled() {
            return Err(Error::Cancelled);
        }
        let grid = &grids[patch];
        let (weight, side, scale) = match unit {
            FairnessUnit::Domain => (area * grid.area, side, 1.0),
            FairnessUnit::Patches => {
                let side = grid.longest();
                (1.0 / count, side, side.powi(if space.degree() == 1 { 2 } else { 4 }))
            }
        };
        let energy = grid.energy(space, patch, scratch)?;
        Ok(energy.matrix(&grid.couplings(space.degree(), side), weight * scale / SAMPLES as f64))
    });
    let mut energies = found.into_iter().collect::<Result<Vec<PatchEnergy>>>()?;
    bound(&mut energies);
    Ok(energies)
}

/// Scales down energies of patches so thin that beside them all others, and the points, would be lost in rounding.
fn bound(energies: &mut [PatchEnergy]) {
    let mut largest: Vec<f64> =
        energies.iter().map(|of| of.matrix.iter().fold(0.0, |most: f64, x| most.max(x.abs()))).collect();
    let all = largest.clone();
    largest.sort_by(f64::total_cmp);
    let Some(&median) = largest.get(largest.len() / 2) else { return };
    for (energy, most) in energies.iter_mut().zip(all).filter(|(_, most)| *most > THIN * median) {
        energy.matrix.iter_mut().for_each(|x| *x *= THIN * median / most);
    }
}

/// The sample points of the fairness energy in a patch: the centres of those of its GRID² equal triangles that have its orientation.
struct FairnessGrid {
    corners: [Complex; 3],
    area: f64,
}

/// The derivatives of the basis functions at the sample points of a patch.
struct SampledDerivatives {
    control: Vec<u32>,
    /// For each derivative and sample point the factors of the control points.
    factors: Vec<Vec<f64>>,
}

impl FairnessGrid {
    fn new(patch: &Patch) -> FairnessGrid {
        let corners = [0, 1, 2].map(|k| patch.knots[k][0]);
        FairnessGrid { corners, area: 0.5 * doubled_area(corners) }
    }

    fn longest(&self) -> f64 {
        let [a, b, c] = self.corners;
        between(a, b).max(between(b, c)).max(between(c, a))
    }

    /// The sample points: rows from the first side to the third corner, each from left to right.
    fn places(&self, patch: u32) -> Vec<Parameter> {
        let [a, b, c] = self.corners;
        let cells = (0..GRID).flat_map(|row| (0..GRID - row).map(move |cell| (cell, row)));
        let place = |(cell, row): (usize, usize)| {
            let [s, t] = [cell, row].map(|at| (at as f64 + 1.0 / 3.0) / GRID as f64);
            let [x, y] = [0, 1].map(|x| (1.0 - s - t) * a[x] + s * b[x] + t * c[x]);
            Parameter { patch, x, y }
        };
        cells.map(place).collect()
    }

    /// The pairs of neighbouring sample points, by their numbers, with their distances.
    fn steps(&self) -> Vec<([usize; 2], f64)> {
        let [a, b, c] = self.corners;
        let [along, up, back] = [between(a, b), between(a, c), between(b, c)].map(|x| x / GRID as f64);
        let mut steps = Vec::new();
        let mut at = 0;
        for row in 0..GRID {
            let wide = GRID - row;
            for _ in 1..wide {
                let above = at + wide;
                steps.extend([([at, at + 1], along), ([at, above], up), ([at + 1, above], back)]);
                at += 1;
            }
            at += 1;
        }
        steps
    }

    /// The matrix of the energy in the derivatives at the sample points, as its rows: the squares of the derivatives for degree 1, else
    /// the squared changes of second derivatives from point to point beside a share of their squares.
    fn couplings(&self, degree: usize, side: f64) -> Vec<Vec<(usize, f64)>> {
        if degree == 1 {
            return (0..SAMPLES).map(|i| vec![(i, 1.0)]).collect();
        }
        let mut rows: Vec<Vec<(usize, f64)>> = (0..SAMPLES).map(|i| vec![(i, BENDING)]).collect();
        for ([i, j], length) in self.steps() {
            // Steps in three directions measure the squared gradient 1.5 times.
            let factor = side * side / (length * length * 1.5);
            for (a, b) in [(i, j), (j, i)] {
                rows[a][0].1 += factor;
                rows[a].push((b, -factor));
            }
        }
        rows
    }

    fn energy(&self, space: &SplineSpace, patch: usize, scratch: &mut Scratch) -> Result<SampledDerivatives> {
        let order = space.degree().min(2);
        let mut terms: Vec<(usize, u32, [f64; 3])> = Vec::new();
        for (i, place) in self.places(patch as u32).into_iter().enumerate() {
            space.each(place, order, scratch, |control, jet| {
                let [_, x, y, xx, xy, yy] = *jet;
                terms.push((i, control, if order == 1 { [x, y, 0.0] } else { [xx, SQRT_2 * xy, yy] }));
            })?;
        }
        let mut control: Vec<u32> =
            terms.iter().filter(|(_, _, d)| *d != [0.0; 3]).map(|&(_, control, _)| control).collect();
        control.sort_unstable();
        control.dedup();
        let mut factors = vec![vec![0.0; control.len()]; 3 * SAMPLES];
        for (i, number, derivatives) in terms {
            if let Ok(at) = control.binary_search(&number) {
                (0..3).for_each(|d| factors[d * SAMPLES + i][at] += derivatives[d]);
            }
        }
        Ok(SampledDerivatives { control, factors })
    }
}

impl SampledDerivatives {
    /// The energy, from its matrix in the derivatives.
    fn matrix(self, couplings: &[Vec<(usize, f64)>], weight: f64) -> PatchEnergy {
        let n = self.control.len();
        let mut matrix = vec![0.0; n * (n + 1) / 2];
        let mut coupled = vec![0.0; n];
        for derivative in self.factors.chunks(SAMPLES) {
            for (row, of) in couplings.iter().zip(derivative) {
                coupled.fill(0.0);
                for &(j, factor) in row {
                    coupled.iter_mut().zip(&derivative[j]).for_each(|(c, d)| *c += weight * factor * d);
                }
                let mut rest = &mut matrix[..];
                for (i, &d) in of.iter().enumerate() {
                    let (line, later) = rest.split_at_mut(i + 1);
                    if d != 0.0 {
                        line.iter_mut().zip(&coupled).for_each(|(m, c)| *m += d * c);
                    }
                    rest = later;
                }
            }
        }
        PatchEnergy { control: self.control, matrix }
    }
}
