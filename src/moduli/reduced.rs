//! Period matrices in a reduced basis of loops, in which the radii of their entries are those of short loops.
//!
//! A symplectic change of the loops, `a' = D a + C b`, `b' = B a + A b`, moves the period matrix by `(A Π + B) (C Π + D)⁻¹`, an isometry of Siegel's half-space,
//! so a ball keeps its radius log d. Three kinds of changes are made in turn until none is left, as in Siegel's reduction \[Sie43\]: loops b are added to one
//! another until Im Π is reduced in pairs, whole numbers are taken off Re Π, and a1, b1 change places where |Π_11| < 1.

use super::bounds::PeriodBounds;
use crate::geometry::Enclosure;
use crate::geometry::complex::Complex;

/// Most rounds of changes.
const MOST_ROUNDS: usize = 10_000;
/// Factor by which a number has to fall to be changed: rounding.
const LESS: f64 = 1.0 - 1e-9;

/// A period matrix in another basis, with the radii of its entries.
#[derive(Debug, Clone)]
pub struct ReducedPeriods {
    /// The period matrix (g × g, symmetric).
    pub matrix: Vec<Vec<Complex>>,
    /// The entry of the surface is within this distance (g × g).
    pub radius: Vec<Vec<f64>>,
    /// The loops a1', b1', a2', … as sums of the loops a1, b1, … of the forms (2g × 2g).
    pub loops: Vec<Vec<i64>>,
}

/// A matrix on its way, and its loops.
struct PeriodReduction {
    entries: Vec<Vec<[Enclosure; 2]>>,
    loops: Vec<Vec<i64>>,
}

impl PeriodBounds {
    /// The period matrix in a reduced basis of loops. Each entry of the surface's is within `(d − 1) √(Y_ii Y_jj)` of it, Y its imaginary part, as that in the
    /// given basis, and rounding on the way is added.
    pub fn reduced(&self) -> ReducedPeriods {
        let g = self.matrix.len();
        let mut reduction = PeriodReduction {
            entries: self
                .matrix
                .iter()
                .map(|row| row.iter().map(|z| z.map(Enclosure::from)).collect())
                .collect(),
            loops: (0..2 * g).map(|i| (0..2 * g).map(|j| i64::from(i == j)).collect()).collect(),
        };
        for _ in 0..MOST_ROUNDS {
            let is_changed = reduction.add_loops() | reduction.take_off_integers();
            if !(reduction.exchange() || is_changed) {
                break;
            }
        }
        let z = &reduction.entries;
        let matrix: Vec<Vec<Complex>> =
            z.iter().map(|row| row.iter().map(|z| z.map(Enclosure::nearest)).collect()).collect();
        let radius = |i: usize, j: usize| {
            let wide = (z[i][i][1] * z[j][j][1]).sqrt() * self.gap.into();
            let off =
                (0..2).map(|k| (z[i][j][k] - matrix[i][j][k].into()).upper().abs() + z[i][j][k].radius());
            (wide.upper() + off.sum::<f64>()) * (1.0 + 1e-15)
        };
        let radius = (0..g).map(|i| (0..g).map(|j| radius(i, j)).collect()).collect();
        ReducedPeriods { matrix, radius, loops: reduction.loops }
    }
}

impl PeriodReduction {
    fn imaginary(&self, i: usize, j: usize) -> f64 {
        self.entries[i][j][1].nearest()
    }

    /// Subtracts multiples of loops b from others until no such step makes an imaginary part on the diagonal smaller, and brings the least one to the front.
    fn add_loops(&mut self) -> bool {
        let (g, mut is_changed) = (self.entries.len(), false);
        loop {
            let step = (0..g).flat_map(|i| (0..g).map(move |j| (i, j))).filter(|(i, j)| i != j).find_map(
                |(i, j)| {
                    let k = (self.imaginary(i, j) / self.imaginary(j, j)).round();
                    let smaller =
                        self.imaginary(i, i) - 2.0 * k * self.imaginary(i, j) + k * k * self.imaginary(j, j);
                    (k != 0.0 && smaller < self.imaginary(i, i) * LESS).then_some((i, j, k))
                },
            );
            let Some((i, j, k)) = step else { break };
            self.subtract([i, j], k);
            is_changed = true;
        }
        let least =
            (0..g).min_by(|&i, &j| self.imaginary(i, i).total_cmp(&self.imaginary(j, j))).unwrap_or(0);
        if self.imaginary(least, least) < self.imaginary(0, 0) * LESS {
            self.entries.swap(0, least);
            self.entries.iter_mut().for_each(|row| row.swap(0, least));
            (0..2).for_each(|c| self.loops.swap(c, 2 * least + c));
            is_changed = true;
        }
        is_changed
    }

    /// b_i ↦ b_i − k b_j, a_j ↦ a_j + k a_i.
    fn subtract(&mut self, [i, j]: [usize; 2], k: f64) {
        let by = Enclosure::from(k);
        let g = self.entries.len();
        for l in 0..g {
            let other = self.entries[j][l];
            self.entries[i][l] = [0, 1].map(|c| self.entries[i][l][c] - other[c] * by);
        }
        for row in &mut self.entries {
            row[i] = [0, 1].map(|c| row[i][c] - row[j][c] * by);
        }
        for l in 0..2 * g {
            self.loops[2 * i + 1][l] -= k as i64 * self.loops[2 * j + 1][l];
            self.loops[2 * j][l] += k as i64 * self.loops[2 * i][l];
        }
    }

    /// b_i ↦ b_i − Σ n_ij a_j for the whole numbers nearest to the real parts.
    fn take_off_integers(&mut self) -> bool {
        let (g, mut is_changed) = (self.entries.len(), false);
        for i in 0..g {
            for j in 0..=i {
                let n = self.entries[i][j][0].nearest();
                if n.abs() <= 0.5 / LESS {
                    continue;
                }
                let n = n.round();
                is_changed = true;
                for (i, j) in [(i, j), (j, i)].into_iter().take(if i == j { 1 } else { 2 }) {
                    self.entries[i][j][0] = self.entries[i][j][0] - n.into();
                    for l in 0..2 * g {
                        self.loops[2 * i + 1][l] -= n as i64 * self.loops[2 * j][l];
                    }
                }
            }
        }
        is_changed
    }

    /// a_1 ↦ b_1, b_1 ↦ −a_1, where that makes Im Π_11 larger.
    fn exchange(&mut self) -> bool {
        let g = self.entries.len();
        let z = self.entries[0][0];
        let square = z[0] * z[0] + z[1] * z[1];
        if square.nearest() >= LESS {
            return false;
        }
        let over =
            |w: [Enclosure; 2]| [(w[0] * z[0] + w[1] * z[1]) / square, (w[1] * z[0] - w[0] * z[1]) / square];
        let row: Vec<[Enclosure; 2]> = self.entries[0].clone();
        for (i, r) in row.iter().enumerate().skip(1) {
            for j in 1..g {
                let q = over(row[j]);
                let taken = [r[0] * q[0] - r[1] * q[1], r[0] * q[1] + r[1] * q[0]];
                self.entries[i][j] = [0, 1].map(|c| self.entries[i][j][c] - taken[c]);
            }
        }
        for (j, r) in row.iter().enumerate().skip(1) {
            self.entries[0][j] = over(*r);
            self.entries[j][0] = over(*r);
        }
        self.entries[0][0] = [-z[0] / square, z[1] / square];
        self.loops.swap(0, 1);
        self.loops[1].iter_mut().for_each(|x| *x = -*x);
        true
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::harmonic::{Domain, FormsOptions, HarmonicForms};
    use crate::mesh::shapes;
    use crate::moduli::{BoundsOptions, period_bounds};
    use crate::{Control, Surface};

    fn product(a: &[Vec<i64>], b: &[Vec<i64>]) -> Vec<Vec<i64>> {
        let n = b.len();
        a.iter().map(|row| (0..n).map(|j| (0..n).map(|k| row[k] * b[k][j]).sum()).collect()).collect()
    }

    /// From a basis that was changed by large symplectic matrices to a reduced one: the loops remain symplectic, and give the matrix.
    #[test]
    fn changed_bases_are_reduced() {
        let control = Control::new();
        let surface = Surface::from_soup(&shapes::tapered_genus(3, 3, 1.6).unwrap()).unwrap();
        let domain = Domain::new(&surface, &control).unwrap();
        let forms = HarmonicForms::new(&domain, &FormsOptions::default(), &control).unwrap();
        let bounds = period_bounds(&forms, &BoundsOptions::default(), &control).unwrap();
        let plain = bounds.reduced();
        let g = 3;
        // Shear, and add loops many times.
        let mut twisted = bounds.clone();
        let mut state = PeriodReduction {
            entries: bounds
                .matrix
                .iter()
                .map(|row| row.iter().map(|z| z.map(Enclosure::from)).collect())
                .collect(),
            loops: vec![vec![0; 6]; 6],
        };
        for (i, j, k) in [(0, 1, 7.0), (2, 0, -5.0), (1, 2, 9.0)] {
            state.subtract([i, j], k);
        }
        twisted.matrix =
            state.entries.iter().map(|row| row.iter().map(|z| z.map(Enclosure::nearest)).collect()).collect();
        twisted.matrix[0][1][0] += 40.0;
        twisted.matrix[1][0][0] += 40.0;
        let found = twisted.reduced();
        let largest = |m: &[Vec<f64>]| m.iter().flatten().copied().fold(0.0, f64::max);
        assert!(
            largest(&found.radius) < 1.001 * largest(&plain.radius),
            "{:?} {:?}",
            found.radius,
            plain.radius
        );
        for reduced in [&plain, &found] {
            let standard: Vec<Vec<i64>> = (0..2 * g)
                .map(|i| {
                    (0..2 * g)
                        .map(|j| {
                            if i ^ 1 != j {
                                0
                            } else if i < j {
                                1
                            } else {
                                -1
                            }
                        })
                        .collect()
                })
                .collect();
            let transposed: Vec<Vec<i64>> =
                (0..2 * g).map(|i| (0..2 * g).map(|j| reduced.loops[j][i]).collect()).collect();
            assert_eq!(product(&product(&reduced.loops, &standard), &transposed), standard);
            for (i, row) in reduced.matrix.iter().enumerate() {
                assert!(
                    row.iter().all(|z| z[0].abs() <= 0.5 + 1e-6) && row[i][1] > 0.0,
                    "{:?}",
                    reduced.matrix
                );
            }
        }
    }

    #[test]
    fn a_torus_has_its_reduced_modulus() {
        let control = Control::new();
        let torus = Surface::from_soup(&shapes::torus(2.0, 0.4, 24, 12).unwrap()).unwrap();
        let forms =
            HarmonicForms::new(&Domain::new(&torus, &control).unwrap(), &FormsOptions::default(), &control)
                .unwrap();
        let bounds = period_bounds(&forms, &BoundsOptions::default(), &control).unwrap();
        let (tau, reduced) = (bounds.modulus().unwrap(), bounds.reduced());
        let off = (tau.value[0].abs() - reduced.matrix[0][0][0].abs())
            .hypot(tau.value[1] - reduced.matrix[0][0][1]);
        assert!(off < 1e-12 && (tau.radius / reduced.radius[0][0] - 1.0).abs() < 1e-9);
    }
}
