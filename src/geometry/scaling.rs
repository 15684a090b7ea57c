//! e^u of many vertices and half chords of many edges at a time, for vertex scaling (ε = 0) in E² and H², in double-double precision.

use super::conformal::plain_chord_of;
use super::double_double::exp_parts;
use super::lanes::{Formula, Lanes, work_out};
use super::vertex::{Vertex, is_plain};
use super::{DoubleDouble, Space};
use crate::parallel::in_parts;

/// The variables of a vertex: ε, u, and the part that u misses of its value.
pub(crate) type Variable = (i8, f64, f64);

/// Fills `out` with [`Vertex::precise`] of all vertices.
pub(crate) fn fill_vertices(space: Space, out: &mut [Vertex], given: impl Fn(usize) -> Variable + Sync) {
    in_parts(out, |start, out| {
        let u = |i| match given(start + i) {
            (epsilon, u, _) if is_plain(space, epsilon, u) => [u],
            _ => [0.0],
        };
        work_out(Exponential, out.len(), u, |i, exponential| {
            let (epsilon, u, low) = given(start + i);
            out[i] = if is_plain(space, epsilon, u) {
                Vertex::of_exponential(epsilon, exponential, low)
            } else {
                Vertex::precise(space, epsilon, u, low)
            };
        });
    });
}

/// Fills `out` with the half chords of edges between vertices with ε = 0; `given` returns the ends and η of an edge. A half chord is 0
/// where [`super::conformal::plain_chord`] is 0.
pub(crate) fn fill_chords(
    space: Space,
    out: &mut [DoubleDouble],
    given: impl Fn(usize) -> ([Vertex; 2], DoubleDouble) + Sync,
) {
    in_parts(out, |start, out| {
        let parts = |i| {
            let ([a, b], eta) = given(start + i);
            // An end with a unit of its own has no plain chord.
            let scale = if a.exponent | b.exponent == 0 { a.scale } else { 0.0 };
            [scale, a.low, b.scale, b.low, eta.high, eta.low]
        };
        work_out(Chord { space }, out.len(), parts, |i, [high, low]| out[i] = DoubleDouble { high, low });
    });
}

/// The formula [`exp_parts`].
#[derive(Clone, Copy)]
struct Exponential;

impl Formula<1, 3> for Exponential {
    #[inline(always)]
    fn of<L: Lanes>(self, [u]: [L; 1]) -> [L; 3] {
        exp_parts(u)
    }
}

/// The half chord of an edge, from e^u of the ends and η, each with its low part.
#[derive(Clone, Copy)]
struct Chord {
    space: Space,
}

impl Formula<6, 2> for Chord {
    #[inline(always)]
    fn of<L: Lanes>(self, [a, a_low, b, b_low, eta, eta_low]: [L; 6]) -> [L; 2] {
        let DoubleDouble { high, low } = plain_chord_of(self.space, [a, a_low], [b, b_low], [eta, eta_low]);
        [high, low]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::conformal::{edge, plain_chord};

    #[test]
    fn vertices_and_chords_have_the_bits_that_they_have_alone() {
        let mut u: Vec<f64> = (0..200)
            .map(|i| {
                [0.37 * f64::from(i) - 40.0, -300.0, 650.0, 2e5, f64::NAN]
                    [usize::from(i % 9 == 0) * (i as usize / 9 % 5)]
            })
            .collect();
        // Ends of edges, some at the ends of the range.
        for (i, [a, b]) in
            [[695.0, -695.0], [330.0, -330.0], [690.0, -690.0], [-330.0, -330.0], [332.0, 10.0]]
                .into_iter()
                .enumerate()
        {
            (u[10 * i], u[10 * i + 7]) = (a, b);
        }
        for space in [Space::E2, Space::H2, Space::S2] {
            for epsilon in [0, 1, -1] {
                let mut vertices = vec![Vertex::default(); u.len()];
                fill_vertices(space, &mut vertices, |i| (epsilon, u[i], 1e-18));
                for (vertex, &u) in vertices.iter().zip(&u) {
                    let alone = Vertex::precise(space, epsilon, u, 1e-18);
                    assert_eq!(format!("{vertex:?}"), format!("{alone:?}"), "{space} {epsilon} {u}");
                }
                if epsilon != 0 || space == Space::S2 {
                    continue;
                }
                let mut chords = vec![DoubleDouble::default(); u.len() - 7];
                let given = |i: usize| {
                    (
                        [vertices[i], vertices[i + 7]],
                        DoubleDouble { high: [0.7, 1e20][i % 20 / 10], low: 1e-17 },
                    )
                };
                fill_chords(space, &mut chords, given);
                for (i, chord) in chords.iter().enumerate() {
                    let ([a, b], eta) = given(i);
                    assert_eq!(*chord, plain_chord(space, a, b, eta), "{space} {i}");
                    assert!(chord.high == 0.0 || edge(space, a, b, eta).is_some(), "{space} {i}");
                }
                assert!(chords.iter().any(|q| q.high > 0.0) && chords.iter().any(|q| q.high == 0.0));
            }
        }
    }
}
