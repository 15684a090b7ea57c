//! The class of maps between flat tori whose affine map is nearest to a similarity: by reduced bases of both lattices.
//!
//! The affine map in a class is harmonic, and its energy over the area of the target is `(K + 1/K) / 2`. So the class of least energy is known from
//! the lattices alone, whatever the triangulations.

use super::generators::Generators;
use crate::geometry::complex::{Complex, cross, dot};
use crate::geometry::{DoubleDouble, Motion};

/// A matrix of whole numbers and determinant 1, by rows.
type WholeMatrix = [[i64; 2]; 2];

/// Largest entry, in absolute value, of the matrices between reduced bases that are compared. Reduced moduli lie in one fundamental domain of the
/// modular group, and copies of one that are far from it are far from the other. The test below finds none nearer among entries up to 30.
const MOST_ENTRY: i64 = 2;
/// Most steps of the reduction of a basis: they grow with the logarithm of the ratio of its lengths.
const MOST_STEPS: usize = 200;
/// Largest entry of a reduction, and largest share in one step of it: products of three such matrices are exact in 64 bits.
const MOST_SHARE: f64 = 1e4;
/// Relative difference of energies that are equal up to rounding.
const SAME: f64 = 1e-9;

/// The images of the letters in the class of least energy, and the number of classes that were compared. Of classes of one energy, as
/// those of a map and of the same after half a turn, the one that is nearest to the given correspondence of letters.
pub(super) fn nearest_class(source: &Generators, target: Generators) -> (Generators, usize) {
    let [from, to] = [source, &target].map(|all| [0, 1].map(|k| translation(&all.motions[k])));
    let (Some(first), Some(second)) = (reduction(from), reduction(to)) else { return (target, 1) };
    let (flat, other) = (transformed(first, from), transformed(second, to));
    let range = || -MOST_ENTRY..=MOST_ENTRY;
    let rows = || range().flat_map(|p| range().map(move |q| [p, q]));
    let all = rows().flat_map(|row| rows().map(move |other| [row, other]));
    let mut compared = 0;
    let mut best: Option<(f64, f64, WholeMatrix)> = None;
    for between in all.filter(|m| m[0][0] * m[1][1] - m[0][1] * m[1][0] == 1) {
        compared += 1;
        let energy = energy(flat, transformed(between, other));
        let letters = product(product(inverse(first), between), second);
        let off: f64 =
            (0..4).map(|k| (letters[k / 2][k % 2] - i64::from(k % 3 == 0)) as f64).map(|x| x * x).sum();
        let is_better = best.is_none_or(|(least, nearest, _)| {
            energy < least * (1.0 - SAME) || (energy <= least * (1.0 + SAME) && off < nearest)
        });
        if is_better {
            best = Some((energy, off, letters));
        }
    }
    let Some((_, _, letters)) = best else { return (target, 1) };
    let mut next = target.clone();
    for (motion, row) in next.motions.iter_mut().zip(letters) {
        let whole = row.map(|x| DoubleDouble::from(x as f64));
        let b = [0, 1].map(|k| whole[0] * target.motions[0].b[k] + whole[1] * target.motions[1].b[k]);
        *motion = Motion { b, ..*motion };
    }
    (next, compared)
}

/// The vector of a translation.
fn translation(motion: &Motion<DoubleDouble>) -> Complex {
    let [x, y, _] = motion.origin();
    [f64::from(x), f64::from(y)]
}

/// The matrix that makes a reduced basis of this one: the second vector is at least as long as the first one, and its share along that at most a
/// half. `None` for vectors that span no lattice.
fn reduction(basis: [Complex; 2]) -> Option<WholeMatrix> {
    let ([mut short, mut long], mut by) = (basis, [[1, 0], [0, 1]]);
    for _ in 0..MOST_STEPS {
        if dot(long, long) < (1.0 - SAME) * dot(short, short) {
            (short, long) = (long, short.map(|x| -x));
            by = [by[1], by[0].map(|x| -x)];
        }
        // A share of a half stays, whichever side it is on: the step would lead to a half on the other side, and back.
        let share = dot(short, long) / dot(short, short);
        if share.abs() <= 0.5 * (1.0 + SAME) {
            return (cross(short, long) != 0.0).then_some(by);
        }
        let share = share.round();
        long = [0, 1].map(|k| long[k] - share * short[k]);
        if !(share.abs() <= MOST_SHARE && by.as_flattened().iter().all(|x| x.abs() <= MOST_SHARE as i64)) {
            return None;
        }
        by[1] = [0, 1].map(|k| by[1][k] - share as i64 * by[0][k]);
    }
    None
}

fn transformed(by: WholeMatrix, basis: [Complex; 2]) -> [Complex; 2] {
    by.map(|[p, q]| [0, 1].map(|k| p as f64 * basis[0][k] + q as f64 * basis[1][k]))
}

fn product(m: WholeMatrix, n: WholeMatrix) -> WholeMatrix {
    m.map(|[p, q]| [0, 1].map(|k| p * n[0][k] + q * n[1][k]))
}

fn inverse([[a, b], [c, d]]: WholeMatrix) -> WholeMatrix {
    [[d, -b], [-c, a]]
}

/// `(K + 1/K) / 2` of the linear map between two bases.
fn energy([v, w]: [Complex; 2], [x, y]: [Complex; 2]) -> f64 {
    // The images of the unit vectors are (w₂ x − v₂ y)/d and (v₁ y − w₁ x)/d.
    let first = [0, 1].map(|k| w[1] * x[k] - v[1] * y[k]);
    let second = [0, 1].map(|k| v[0] * y[k] - w[0] * x[k]);
    0.5 * (dot(first, first) + dot(second, second)) / (cross(v, w) * cross(x, y)).abs()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Space;

    fn lattice(basis: [Complex; 2]) -> Generators {
        let motion = |[x, y]: Complex| Motion {
            b: [x, y].map(|c| DoubleDouble::from(0.5 * c)),
            ..Motion::identity(Space::E2)
        };
        Generators { space: Space::E2, genus: 1, motions: basis.map(motion).to_vec(), lines: Vec::new() }
    }

    /// The dilatation of the affine map between the bases.
    fn dilatation(source: [Complex; 2], image: &Generators) -> f64 {
        let energy = energy(source, [0, 1].map(|k| translation(&image.motions[k])));
        energy + ((energy - 1.0) * (energy + 1.0)).max(0.0).sqrt()
    }

    #[test]
    fn the_class_found_has_the_least_distance_of_the_moduli() {
        let cases = [
            ([-0.3, 2.0], [0.3, 1.2]),
            ([0.0, 1.0], [3.4, 0.6]),
            ([0.1, 1.1], [0.35, 1.4]),
            ([0.5, 0.9], [-0.5, 0.87]),
            ([7.2, 0.05], [-3.1, 0.2]),
        ];
        for (tau, other) in cases {
            let source = [[1.0, 0.0], tau];
            let (image, compared) = nearest_class(&lattice(source), lattice([[1.0, 0.0], other]));
            let found = dilatation(source, &image);
            // Against all matrices with entries up to 30.
            let (mut least, range) = (f64::INFINITY, -30i64..=30);
            for (p, q) in range.clone().flat_map(|p| range.clone().map(move |q| (p, q))) {
                for r in range.clone() {
                    // p s − q r = 1.
                    let s = if p != 0 && (1 + q * r) % p == 0 { (1 + q * r) / p } else { continue };
                    let next = transformed([[p, q], [r, s]], [[1.0, 0.0], other]);
                    least = least.min(energy(source, next));
                }
            }
            let least = least + ((least - 1.0) * (least + 1.0)).max(0.0).sqrt();
            assert!(compared > 20 && found <= least * (1.0 + 1e-9), "{tau:?} {other:?}: {found} {least}");
        }
    }

    #[test]
    fn equal_lattices_keep_their_letters_and_degenerate_ones_are_left_alone() {
        let square = lattice([[1.0, 0.0], [0.0, 1.0]]);
        let (image, _) = nearest_class(&square, square.clone());
        assert_eq!(image.motions, square.motions);
        let flat = lattice([[1.0, 0.0], [2.0, 0.0]]);
        assert_eq!(nearest_class(&flat, square.clone()).1, 1);
        assert!(reduction([[1.0, 0.0], [f64::NAN, 1.0]]).is_none());
    }
}
