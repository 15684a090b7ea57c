//! Fenchel–Nielsen coordinates: lengths and twists of the curves that cut a hyperbolic surface into pairs of pants.
//!
//! ```text
//!            left of c                 An axis m beside c, on either side, has its foot on c where the common perpendicular meets c.
//!       ___________________ m          The twist is the way along c, in its direction, from the foot of the axis on the right to that of
//!             |   τ > 0                the axis on the left: going along the surface across c, one turns left and goes on by τ.
//!   c  ———————+———————+———————→
//!                     |
//!       ______________|____ m'
//!            right of c
//! ```

use crate::embed::DeckGroup;
use crate::error::{Error, Result};
use crate::geometry::{DoubleDouble, Motion, Space};
use crate::topology::{Letter, SurfaceGroup, Word};

/// A curve of a decomposition into pairs of pants.
#[derive(Debug, Clone)]
pub struct PantsCurve {
    /// Its name: a1, a2, …; c1, … for the commutators `a_i b_i a_i⁻¹ b_i⁻¹` (of surfaces with boundary `[a1,b1]`, …, since c1 is a boundary
    /// loop there); d2, … for the products of the first i of commutators and boundary loops.
    pub name: String,
    /// Its word in the generators.
    pub word: Word,
    /// The length of its closed geodesic.
    pub length: f64,
    /// The twist, a length of either sign. Adding the length is a Dehn twist, which changes the marking and not the surface.
    pub twist: f64,
}

/// The curves a_i, the commutators c_i of a_i and b_i, and where there are more than three of commutators and boundary loops, the products d_j of the
/// first j of them, 2 ≤ j ≤ n − 2: 3g − 3 + b disjoint simple curves, with their lengths and twists. Of n = 2 curves c_1, c_2, which are one, the first is
/// left, unless it is the boundary loop.
///
/// A pair of pants with boundary elements x y z = 1 has a lift that is bounded by the axes of just these elements, so the axes beside one are known
/// by their words: `b a b⁻¹` and `b⁻¹ a b` beside a; a_i and `d_{i−1}` (c_2 for i = 1, d_{n−2} for i = n; in genus 2 a_1 and a_2) beside c_i; c_i and
/// c_{i+1} beside d_i.
///
/// # Errors
/// [`Error::Layout`] for a group that is not that of a hyperbolic surface, and where rounding leaves two axes on one side of a curve.
pub fn fenchel_nielsen(deck: &DeckGroup) -> Result<Vec<PantsCurve>> {
    let (g, b) = (deck.group.genus, deck.group.boundaries);
    if deck.space != Space::H2 || 2 * g + b < 3 {
        return Err(Error::Layout("only hyperbolic surfaces have Fenchel-Nielsen coordinates".into()));
    }
    let mut curves = Vec::with_capacity(3 * g + b - 3);
    for NamedCurve { name, word, beside } in named_curves(deck.group) {
        let [axis, first, second] = [&word, &beside[0], &beside[1]].map(|w| deck.motion(w));
        let axis = axis?;
        let twist = twist(&axis, [&first?, &second?]).ok_or_else(|| {
            Error::Layout(format!(
                "the axes beside {name} do not lie on its two sides: rounding, or a group of another surface"
            ))
        })?;
        curves.push(PantsCurve { name, word, length: axis.translation_length(), twist });
    }
    Ok(curves)
}

/// A curve with its name, its word, and the words of the axes beside it.
struct NamedCurve {
    name: String,
    word: Word,
    beside: [Word; 2],
}

/// The curves of the canonical decomposition of a surface with 2g − 2 + b > 0.
fn named_curves(group: SurfaceGroup) -> Vec<NamedCurve> {
    let (g, n) = (group.genus, group.genus + group.boundaries);
    let letter = |k: usize| Word::from_iter([Letter::generator(k)]);
    let [a, b] = [0, 1].map(|k| (0..g).map(|i| letter(2 * i + k)).collect::<Vec<Word>>());
    // The commutators, then the boundary loops, counted from 0.
    let handles = (0..g).map(|i| a[i].commutator(&b[i]));
    let c: Vec<Word> = handles.chain((2 * g..group.n_generators()).map(letter)).collect();
    // d[i] = c_1 ⋯ c_{i+1}, counted from 0 as the others are.
    let d: Vec<Word> = c
        .iter()
        .scan(Word::identity(), |product, c| {
            *product = product.times(c);
            Some(product.clone())
        })
        .collect();
    let mut curves = Vec::new();
    let mut add = |name: String, word: &Word, beside: [Word; 2]| {
        curves.push(NamedCurve { name, word: word.clone(), beside });
    };
    for i in 0..g {
        let conjugate = |by: &Word| by.times(&a[i]).times(&by.inverse());
        add(format!("a{}", i + 1), &a[i], [conjugate(&b[i]), conjugate(&b[i].inverse())]);
    }
    let commutator = |i: usize| match group.boundaries {
        0 => format!("c{}", i + 1),
        _ => format!("[a{0},b{0}]", i + 1),
    };
    if n <= 2 {
        if g == 2 {
            add(commutator(0), &c[0], [a[0].clone(), a[1].clone()]);
        }
        return curves;
    }
    for i in 0..g {
        let beyond = match i {
            0 => &c[1],
            _ if i == n - 1 => &d[n - 3],
            _ => &d[i - 1],
        };
        add(commutator(i), &c[i], [a[i].clone(), beyond.clone()]);
    }
    for i in 1..n - 2 {
        add(format!("d{}", i + 1), &d[i], [c[i].clone(), c[i + 1].clone()]);
    }
    curves
}

/// A vector [x, y, w] of Minkowski space.
pub(super) type MinkowskiVector = [DoubleDouble; 3];

pub(super) fn product(u: &MinkowskiVector, v: &MinkowskiVector) -> DoubleDouble {
    u[0] * v[0] + u[1] * v[1] - u[2] * v[2]
}

fn scaled(u: &MinkowskiVector, by: DoubleDouble) -> MinkowskiVector {
    [u[0] * by, u[1] * by, u[2] * by]
}

fn minus(u: &MinkowskiVector, v: &MinkowskiVector) -> MinkowskiVector {
    [u[0] - v[0], u[1] - v[1], u[2] - v[2]]
}

pub(super) fn determinant([p, q, r]: [&MinkowskiVector; 3]) -> DoubleDouble {
    let minor = |i: usize, j: usize| q[i] * r[j] - q[j] * r[i];
    p[0] * minor(1, 2) + p[1] * minor(2, 0) + p[2] * minor(0, 1)
}

/// The unit normal of the axis of a translation, pointing to its right.
pub(super) fn normal(motion: &Motion<DoubleDouble>) -> MinkowskiVector {
    // The form x Im b − y Re b + w Im a is positive on the right; as a product with a vector its last sign turns.
    let Motion { a, b, .. } = motion.positive();
    let raw = [b[1], -b[0], -a[1]];
    scaled(&raw, DoubleDouble::from(1.0) / product(&raw, &raw).sqrt())
}

/// The point of the axis with unit normal n that is nearest to the axis with unit normal m; `None` where these meet.
pub(super) fn foot(n: &MinkowskiVector, m: &MinkowskiVector) -> Option<MinkowskiVector> {
    let along = minus(m, &scaled(n, product(m, n)));
    let square = -product(&along, &along);
    let size = if along[2].high < 0.0 { -square.sqrt() } else { square.sqrt() };
    (square.high > 0.0).then(|| scaled(&along, DoubleDouble::from(1.0) / size))
}

/// The distance from the foot of the axis on the right of a translation to that on the left, in its direction. `None` where not one lies on
/// each side.
fn twist(motion: &Motion<DoubleDouble>, beside: [&Motion<DoubleDouble>; 2]) -> Option<f64> {
    let n = normal(motion);
    let mut feet = [None, None];
    for other in beside {
        let m = normal(other);
        let is_right = product(&n, &foot(&m, &n)?).high > 0.0;
        feet[usize::from(is_right)] = Some(foot(&n, &m)?);
    }
    let [left, right] = [feet[0]?, feet[1]?];
    // Of the translation along the x axis n is −y, and the determinant of n, (0, 0, 1) and (sinh τ, 0, cosh τ) is −sinh τ.
    let sine = determinant([&n, &right, &left]).high;
    Some(-sine.asinh())
}
