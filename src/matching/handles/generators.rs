//! The images of the generators of a fundamental group, which determine a homotopy class, and the moves from one class to others.

use crate::error::{Error, Result};
use crate::geometry::complex::mul;
use crate::geometry::{DoubleDouble, Motion, Space};
use crate::topology::Word;

/// The images of the letters a1, b1, …, ag, bg, c1, …, cb: motions that fulfil the relator `[a1, b1] … [ag, bg] c1 … cb = 1`.
#[derive(Debug, Clone)]
pub(super) struct Generators {
    pub space: Space,
    pub genus: usize,
    pub motions: Vec<Motion<DoubleDouble>>,
    /// Per c_j the axis of its motion: the frame at a point of the axis, with the x axis along it.
    pub lines: Vec<Motion<DoubleDouble>>,
}

/// A change of the images of one or two handles that keeps the product of their commutators.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum GeneratorMove {
    /// `a → a b^{±1}` of this handle.
    TwistA(usize, bool),
    /// `b → b a^{±1}`.
    TwistB(usize, bool),
    /// `(a, b) → (a b a⁻¹, a⁻¹)`: a quarter of a turn of the handle.
    Quarter(usize),
    /// The quarter of a turn back, `(a, b) → (b⁻¹, b a b⁻¹)`.
    QuarterBack(usize),
    /// This handle and the next one change places: `(h, k) → (k, k⁻¹ h k)` with their commutators.
    Swap(usize),
}

/// Distance of the relator from the identity, in the entries of a motion, up to which lifts of the surface fit together.
const CLOSED: f64 = 1e-12;
/// Most corrections of the relator: each leaves an error of the size of its square, and rounding.
const CLOSINGS: usize = 8;

impl Generators {
    /// These motions after the least change that makes their relator the identity; `None` if they are so long that it stays off by more
    /// than [`CLOSED`].
    ///
    /// The metric that they come from has curvature 0 at its vertices up to rounding, which the distance from the base magnifies. Lifts of
    /// a surface fit together only if the relator holds.
    pub fn closed(mut self) -> Option<Generators> {
        if self.space == Space::E2 {
            // Translations commute.
            for motion in &mut self.motions {
                *motion = Motion { b: mul(motion.a, motion.b), ..Motion::identity(self.space) };
            }
            return Some(self);
        }
        for _ in 0..CLOSINGS {
            let (rest, mut rows) = self.relator();
            let Some(step) = least_solution(&mut rows, rest.map(|x| -x)) else { break };
            let mut next = self.clone();
            for (motion, by) in next.motions.iter_mut().zip(step.chunks_exact(3)) {
                let by = Motion { space: self.space, a: [1.0.into(), by[0]], b: [by[1], by[2]] };
                *motion = motion.compose(&by.normalised()).normalised();
            }
            // As long as it comes nearer.
            if size(next.relator().0) >= size(rest) {
                break;
            }
            self.motions = next.motions;
        }
        (size(self.relator().0) <= CLOSED).then_some(self)
    }

    /// The difference of the relator from the identity, in the numbers Im a and b of a motion, and its derivative, by rows, by the same
    /// numbers of small motions that act before each generator.
    fn relator(&self) -> ([DoubleDouble; 3], [Vec<DoubleDouble>; 3]) {
        let mut letters = Vec::new();
        for k in 0..self.genus {
            let [a, b] = [2 * k, 2 * k + 1];
            letters.extend([(a, false), (b, false), (a, true), (b, true)]);
        }
        letters.extend((2 * self.genus..self.motions.len()).map(|c| (c, false)));
        let zero = DoubleDouble::default();
        let mut rows: [Vec<DoubleDouble>; 3] = std::array::from_fn(|_| vec![zero; 3 * self.motions.len()]);
        let mut product = Motion::identity(self.space);
        for (k, is_inverse) in letters {
            let motion = self.motions[k];
            // (m e^ξ)⁻¹ = e^{−ξ} m⁻¹
            let next = product.compose(&if is_inverse { motion.inverse() } else { motion });
            let before = if is_inverse { product } else { next };
            for j in 0..3 {
                let one = |i: usize| DoubleDouble::from(f64::from(u8::from(i == j)));
                let unit = Motion { space: self.space, a: [zero, one(0)], b: [one(1), one(2)] };
                let moved = before.compose(&unit).compose(&before.inverse());
                for (row, value) in rows.iter_mut().zip([moved.a[1], moved.b[0], moved.b[1]]) {
                    row[3 * k + j] = if is_inverse { row[3 * k + j] - value } else { row[3 * k + j] + value };
                }
            }
            product = next;
        }
        let rest = product.positive();
        ([rest.a[1], rest.b[0], rest.b[1]], rows)
    }

    /// The motion of a word.
    ///
    /// # Errors
    /// [`Error::Argument`] for a letter beyond the generators.
    pub fn motion(&self, word: &Word) -> Result<Motion<DoubleDouble>> {
        let mut product = Motion::identity(self.space);
        for letter in word.letters() {
            let Some(motion) = self.motions.get(letter.index()) else {
                return Err(Error::argument("letter", letter.index(), "one of the group's generators"));
            };
            product = if letter.is_inverse() {
                product.compose(&motion.inverse())
            } else {
                product.compose(motion)
            };
        }
        Ok(product.normalised())
    }

    /// All moves.
    pub fn moves(&self) -> Vec<GeneratorMove> {
        let handles = 0..self.genus;
        let of = |k: usize| {
            [
                GeneratorMove::Quarter(k),
                GeneratorMove::TwistA(k, true),
                GeneratorMove::TwistA(k, false),
                GeneratorMove::TwistB(k, true),
                GeneratorMove::TwistB(k, false),
            ]
        };
        let swaps = (1..self.genus).map(|k| GeneratorMove::Swap(k - 1));
        handles.flat_map(of).chain(swaps).collect()
    }

    /// The images after a move.
    pub fn moved(&self, by: GeneratorMove) -> Generators {
        let mut next = self.clone();
        let m = &mut next.motions;
        let power = |x: Motion<DoubleDouble>, is_positive: bool| if is_positive { x } else { x.inverse() };
        match by {
            GeneratorMove::TwistA(k, sign) => m[2 * k] = m[2 * k].compose(&power(m[2 * k + 1], sign)),
            GeneratorMove::TwistB(k, sign) => m[2 * k + 1] = m[2 * k + 1].compose(&power(m[2 * k], sign)),
            GeneratorMove::Quarter(k) => {
                let (a, b) = (m[2 * k], m[2 * k + 1]);
                (m[2 * k], m[2 * k + 1]) = (b.conjugated_by(&a), a.inverse());
            }
            GeneratorMove::QuarterBack(k) => {
                let (a, b) = (m[2 * k], m[2 * k + 1]);
                (m[2 * k], m[2 * k + 1]) = (b.inverse(), a.conjugated_by(&b));
            }
            GeneratorMove::Swap(k) => {
                let [a, b, c, d] = [0, 1, 2, 3].map(|j| m[2 * k + j]);
                let commutator = c.compose(&d).compose(&c.inverse()).compose(&d.inverse());
                let back = commutator.inverse();
                (m[2 * k], m[2 * k + 1]) = (c, d);
                (m[2 * k + 2], m[2 * k + 3]) = (a.conjugated_by(&back), b.conjugated_by(&back));
            }
        }
        next.motions.iter_mut().for_each(|motion| *motion = motion.normalised());
        next
    }

    /// The images after symmetries that surfaces often have and that need several moves: half a turn of all handles (the map x → −x of a
    /// torus, the hyperelliptic involution in genus 2), the exchange of two neighbouring handles, alone or with half a turn of each one way
    /// or the other, and each of these with the half turn of all handles.
    pub fn symmetric(&self) -> Vec<Generators> {
        let half = |of: &Generators, k: usize, back: bool| {
            let by = if back { GeneratorMove::QuarterBack(k) } else { GeneratorMove::Quarter(k) };
            of.moved(by).moved(by)
        };
        let turned = |of: &Generators| (0..self.genus).fold(of.clone(), |all, k| half(&all, k, k % 2 == 1));
        let mut all = vec![turned(self)];
        for k in 1..self.genus {
            let swapped = self.moved(GeneratorMove::Swap(k - 1));
            let both = |back: bool| half(&half(&swapped, k - 1, back), k, back);
            for next in [swapped.clone(), both(false), both(true)] {
                all.extend([turned(&next), next]);
            }
        }
        all
    }

    /// The images after a change of the order of c_1 … c_b that keeps their product. `order`: the numbers of those that become the first,
    /// the second, ….
    pub fn reordered(mut self, order: &[usize]) -> Generators {
        let first = 2 * self.genus;
        let mut now: Vec<usize> = (0..order.len()).collect();
        for (place, wanted) in order.iter().enumerate() {
            let Some(mut at) = now.iter().position(|k| k == wanted) else { continue };
            while at > place {
                // (x, y) → (y, y⁻¹ x y)
                let (x, y) = (self.motions[first + at - 1], self.motions[first + at]);
                let back = y.inverse();
                self.motions[first + at - 1] = y;
                self.motions[first + at] = x.conjugated_by(&back).normalised();
                let line = back.compose(&self.lines[at - 1]).normalised();
                self.lines[at - 1] = self.lines[at];
                self.lines[at] = line;
                now.swap(at - 1, at);
                at -= 1;
            }
        }
        self
    }
}

fn size(rest: [DoubleDouble; 3]) -> f64 {
    rest.iter().map(|x| f64::from(*x).abs()).fold(0.0, f64::max)
}

/// The shortest solution of three linear equations, by orthogonalising their rows; `None` for linearly dependent rows.
fn least_solution(
    rows: &mut [Vec<DoubleDouble>; 3],
    mut side: [DoubleDouble; 3],
) -> Option<Vec<DoubleDouble>> {
    let dot = |a: &[DoubleDouble], b: &[DoubleDouble]| {
        a.iter().zip(b).fold(DoubleDouble::default(), |sum, (x, y)| sum + *x * *y)
    };
    let n = rows[0].len();
    let mut solution = vec![DoubleDouble::default(); n];
    for k in 0..3 {
        let (done, rest) = rows.split_at_mut(k);
        for (row, known) in done.iter().zip(side) {
            let along = dot(row, &rest[0]);
            rest[0].iter_mut().zip(row).for_each(|(x, y)| *x = *x - along * *y);
            side[k] = side[k] - along * known;
        }
        let length = dot(&rest[0], &rest[0]).sqrt();
        if !(f64::from(length) > 0.0 && f64::from(length).is_finite()) {
            return None;
        }
        rest[0].iter_mut().for_each(|x| *x = *x / length);
        side[k] = side[k] / length;
        solution.iter_mut().zip(&rest[0]).for_each(|(x, y)| *x = *x + side[k] * *y);
    }
    Some(solution)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::matching::cover::moved;

    fn relator(of: &Generators) -> Motion<DoubleDouble> {
        let mut product = Motion::identity(of.space);
        for k in 0..of.genus {
            let (a, b) = (of.motions[2 * k], of.motions[2 * k + 1]);
            product = product.compose(&a).compose(&b).compose(&a.inverse()).compose(&b.inverse());
        }
        of.motions[2 * of.genus..].iter().fold(product, |all, c| all.compose(c))
    }

    #[test]
    fn moves_and_other_orders_keep_the_relator() {
        let space = Space::H2;
        let motion = |k: usize| {
            let x = k as f64;
            let turn = Motion::rotation([(0.3 * x).cos(), (0.3 * x).sin()], space).precise();
            moved(&Motion::identity(space), [0.4 + 0.1 * x, (0.7 * x).sin()]).compose(&turn)
        };
        let lines = (0..3).map(|k| motion(20 + k)).collect();
        let all = Generators { space, genus: 2, motions: (0..7).map(motion).collect(), lines };
        let before = relator(&all);
        let off = |after: &Generators| relator(after).compose(&before.inverse()).distance_from_identity();
        for by in all.moves() {
            assert!(off(&all.moved(by)) < 1e-14, "{by:?}");
        }
        for k in 0..2 {
            let there_and_back = all.moved(GeneratorMove::Quarter(k)).moved(GeneratorMove::QuarterBack(k));
            let apart = |(a, b): (&Motion<DoubleDouble>, &Motion<DoubleDouble>)| {
                a.compose(&b.inverse()).distance_from_identity()
            };
            assert!(there_and_back.motions.iter().zip(&all.motions).map(apart).all(|d| d < 1e-14));
        }
        assert!(all.symmetric().len() == 7 && all.symmetric().iter().all(|next| off(next) < 1e-14));
        let other = all.clone().reordered(&[2, 0, 1]);
        assert!(off(&other) < 1e-14 && other.motions[4] == all.motions[6]);
    }
}
