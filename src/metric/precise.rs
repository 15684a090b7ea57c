//! Chords, angles and curvature of a metric in double-double precision, from its variables.
//!
//! ```
//! # use ricci::{Class, Surface, geometry::Space, mesh::shapes};
//! let torus = Surface::from_soup(&shapes::torus(2.0, 1.0, 24, 12)?)?;
//! let metric = torus.initial(Class::yamabe(Space::E2))?.metric;
//! let (precise, curvature) = (metric.angle_defects(torus.mesh())?, metric.curvature(torus.mesh())?.at);
//! assert!(precise.iter().zip(curvature.iter()).all(|(a, b)| (a - b).abs() < 1e-14));
//! # Ok::<(), ricci::Error>(())
//! ```

use super::lengths::Metric;
use crate::error::Result;
use crate::geometry::arctangent::angle;
use crate::geometry::chords::products;
use crate::geometry::conformal::precise_chord;
use crate::geometry::lanes::{Formula, Lanes, work_out};
use crate::geometry::scaled::exponent;
use crate::geometry::triangle::{area_from, half_angles_of_chords};
use crate::geometry::{DoubleDouble, Space};
use crate::mesh::{FaceId, Mesh, PerEdge, PerFace, PerVertex};
use crate::parallel;
use std::ops::{Range, RangeInclusive};

impl Metric {
    /// The half chords of the edges, l/2, sinh(l/2), sin(l/2) in E², H², S², in units of their own, with the exponents of these. They have
    /// 20 digits where lengths are precise ([`crate::geometry::conformal::is_precise`]), else 16. The metric has to be in its domain:
    /// [`Metric::check_domain`].
    pub(crate) fn scaled_chords(&self, mesh: &Mesh) -> PerEdge<(DoubleDouble, i32)> {
        let vertices = self.vertices();
        let mut chords = vec![(DoubleDouble::default(), 0); mesh.n_edges()];
        parallel::fill(&mut chords, |e| {
            let ([a, b], eta) = self.ends_and_eta(mesh, &vertices, e.into());
            precise_chord(self.space, a, b, eta)
        });
        chords.into()
    }

    /// 2π minus the sum of the angles around each interior vertex, π minus it at a boundary vertex, in (−2π, 2π] and double-double
    /// precision. It is the curvature of vertices that are meant to be flat, where sums of angles in f64 would show their own rounding.
    ///
    /// The rotations by all the angles are multiplied; no angle is formed.
    ///
    /// # Errors
    /// Those of [`Metric::check_domain`].
    pub fn angle_defects(&self, mesh: &Mesh) -> Result<PerVertex<f64>> {
        self.check_domain(mesh)?;
        Ok(self.angle_defects_inside(mesh))
    }

    /// [`Metric::angle_defects`] of a metric that is known to be in its domain; of others the numbers mean nothing.
    pub(crate) fn angle_defects_inside(&self, mesh: &Mesh) -> PerVertex<f64> {
        let half_angles = half_angles(self, mesh, &self.scaled_chords(mesh));
        let mut turn: PerVertex<[DoubleDouble; 2]> =
            PerVertex::filled(mesh.n_vertices(), [1.0.into(), 0.0.into()]);
        for f in mesh.faces() {
            for (v, [c, s]) in mesh.face_vertices(f).into_iter().zip(half_angles[f]) {
                let [x, y] = turn[v];
                turn[v] = [x * c - y * s, x * s + y * c];
            }
        }
        PerVertex::from_fn(mesh.n_vertices(), |v| {
            // `turn` is the rotation by half of all the angles, which add up to π − K/2, on the boundary to π/2 − K/2.
            let [x, y] = turn[v].map(f64::from);
            2.0 * if mesh.is_boundary_vertex(v) { x.atan2(y) } else { y.atan2(-x) }
        })
    }
}

/// Per edge its half chord and the exponent of that one's unit ([`Metric::scaled_chords`]).
type ScaledChords = PerEdge<(DoubleDouble, i32)>;
/// `[cos, sin]` of half the angle at each corner of a face.
type HalfAngles = [[DoubleDouble; 2]; 3];

/// `[cos, sin]` of half the angle at each corner, from the half chords and the exponents of their units.
fn half_angles(metric: &Metric, mesh: &Mesh, chords: &ScaledChords) -> PerFace<HalfAngles> {
    let mut angles = vec![HalfAngles::default(); mesh.n_faces()];
    if are_usual(metric, chords) {
        parallel::in_parts(&mut angles, |start, angles| {
            hyperbolic_shapes(mesh, chords, start..start + angles.len(), |f, shape| {
                angles[f.index() - start] =
                    shape.map_or_else(|| half_angles_at(metric, mesh, chords, f), |(angles, _)| angles);
            });
        });
    } else {
        parallel::fill(&mut angles, |f| half_angles_at(metric, mesh, chords, f.into()));
    }
    angles.into()
}

fn half_angles_at(metric: &Metric, mesh: &Mesh, chords: &ScaledChords, f: FaceId) -> HalfAngles {
    let sides = mesh.opposite_edges(f).map(|e| chords[e]);
    // In E² the unit of the longest side is used, so that its chord is about 1. In H² and S² lengths have no unit but 1.
    let size = |(q, unit): (DoubleDouble, i32)| unit + exponent(q.high);
    let unit =
        if metric.space == Space::E2 { sides.map(size).into_iter().fold(i32::MIN, i32::max) } else { 0 };
    half_angles_of_chords(metric.space, sides.map(|(q, own)| q.scaled(own - unit)))
}

/// The half chords of the edges as [`Metric::scaled_chords`] has them, `[cos, sin]` of half the angle at each corner, and per face its
/// area, by formulas without angles, and whether its lengths break the triangle inequality.
///
/// # Errors
/// Those of [`Metric::lengths`].
pub(crate) fn shapes(
    metric: &Metric,
    mesh: &Mesh,
) -> Result<(ScaledChords, PerFace<HalfAngles>, Vec<(f64, bool)>)> {
    metric.check(mesh)?;
    let chords = metric.scaled_chords(mesh);
    let mut angles = vec![HalfAngles::default(); mesh.n_faces()];
    let mut areas = vec![(0.0, false); mesh.n_faces()];
    if are_usual(metric, &chords) {
        parallel::in_parts_of_both(&mut angles, &mut areas, |start, angles, areas| {
            hyperbolic_shapes(mesh, &chords, start..start + angles.len(), |f, shape| {
                let at = f.index() - start;
                (angles[at], areas[at]) = match shape {
                    Some((angles, area)) => (angles, (area, false)),
                    None => {
                        let angles = half_angles_at(metric, mesh, &chords, f);
                        (angles, (0.0, is_flat(&angles)))
                    }
                };
            });
        });
    } else {
        let measured = metric.measured(mesh)?;
        measured.lengths()?;
        parallel::fill_both(&mut angles, &mut areas, |f| {
            let angles = half_angles_at(metric, mesh, &chords, f.into());
            let area = area_from(metric.space, measured.differences_of(f.into()));
            (angles, (area, is_flat(&angles)))
        });
    }
    Ok((chords, angles.into(), areas))
}

/// True if these are half chords in H² and all [`USUAL_CHORDS`].
fn are_usual(metric: &Metric, chords: &ScaledChords) -> bool {
    let is_usual = |(q, unit): &(DoubleDouble, i32)| *unit == 0 && USUAL_CHORDS.contains(&q.high);
    metric.space == Space::H2 && chords.iter().all(is_usual)
}

/// True if half angles are those of (π, 0, 0), which broken triangles have.
fn is_flat(half_angles: &HalfAngles) -> bool {
    half_angles.iter().all(|[cos, sin]| cos.high == 0.0 || sin.high == 0.0)
}

/// Half chords in H² of edges that are certainly in the domain of metrics ([`Metric::check_domain`]), and whose products f64 holds.
const USUAL_CHORDS: RangeInclusive<f64> = 1e-60..=1e60;

/// Call `take` with the half angles and the area of each of these faces in H², with `None` for a face that may be broken.
fn hyperbolic_shapes(
    mesh: &Mesh,
    chords: &ScaledChords,
    faces: Range<usize>,
    mut take: impl FnMut(FaceId, Option<(HalfAngles, f64)>),
) {
    let given = |i: usize| {
        let [a, b, c] = mesh.opposite_edges((faces.start + i).into()).map(|e| chords[e].0);
        [a.high, b.high, c.high, a.low, b.low, c.low]
    };
    work_out(HyperbolicShape, faces.len(), given, |i, found| {
        let number = |n: usize| DoubleDouble { high: found[2 * n], low: found[2 * n + 1] };
        let angles = [0, 2, 4].map(|n| [number(n), number(n + 1)]);
        let [area, is_known] = [found[12], found[13]];
        take((faces.start + i).into(), (is_known == 1.0).then_some((angles, area)));
    });
}

/// The formula for a triangle in H²: `[cos, sin]` of half its angles, each as high and low part, its area, and 1; instead of 1 a 0 for a
/// triangle that may be broken, whose numbers mean nothing. Given are the high parts of the half chords of its sides, then the low ones.
///
/// With half the perimeter s and `r_k = s − l_k` the half-angle law reads `cos²(θ_k/2) = sinh s sinh r_k / (sinh l_i sinh l_j)` and
/// `sin²(θ_k/2) = sinh r_i sinh r_j / (sinh l_i sinh l_j)`, where `sinh s sinh r_k = (p − q_k)(p + q_k)` with the half chords q and
/// `p = sinh((l_i + l_j)/2)`. The roots `x_k` of these products give all, since `√(sinh r_i sinh r_j) = x_i x_j / sinh s`; also the area,
/// by `tan(area/2) = 2 x_i x_j x_k / (sinh s (1 + Σ cosh l))`.
#[derive(Clone, Copy)]
struct HyperbolicShape;

impl Formula<6, 14> for HyperbolicShape {
    #[inline(always)]
    fn of<L: Lanes>(self, [a, b, c, a_low, b_low, c_low]: [L; 6]) -> [L; 14] {
        let q = [
            DoubleDouble { high: a, low: a_low },
            DoubleDouble { high: b, low: b_low },
            DoubleDouble { high: c, low: c_low },
        ];
        let one = DoubleDouble::plain(a.constant(1.0));
        // cosh(l/2), 1/√(sinh l), p − q
        let [mut cosh, mut inverse_root, mut d] = [[one; 3]; 3];
        for k in 0..3 {
            cosh[k] = (one + q[k] * q[k]).sqrt();
            inverse_root[k] = one / (q[k] * cosh[k]).twice().sqrt();
        }
        for k in 0..3 {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            d[k] = q[i] * cosh[j] + q[j] * cosh[i] - q[k];
        }
        let (product, whole) = products(q, cosh, d);
        let over = one / whole;
        let (zero, least) = (a.constant(0.0), a.constant(f64::MIN_POSITIVE));
        let (mut x, mut is_known) = (product, one.high);
        for k in 0..3 {
            x[k] = product[k].sqrt();
            // NaN counts as not known too.
            is_known = product[k].high.where_at_least(least, is_known, zero);
        }
        let mut angles = [[one; 2]; 3];
        for k in 0..3 {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            let scale = inverse_root[i] * inverse_root[j];
            angles[k] = [x[k] * scale, x[i] * x[j] * (over * scale)];
        }
        let heron = x[0].high * x[1].high * (x[2].high * over.high);
        let squares = a * a + b * b + c * c;
        let area = angle(heron + heron, a.constant(4.0) + (squares + squares));
        let [[u, v], [w, x], [y, z]] = angles;
        let area = area + area;
        [
            u.high, u.low, v.high, v.low, w.high, w.low, x.high, x.low, y.high, y.low, z.high, z.low, area,
            is_known,
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::triangle::half_differences;

    #[test]
    fn shapes_have_the_same_bits_several_at_a_time_and_alone() {
        let given = |i: usize| {
            let [a, b, c] = [0.3, 0.7, 1.1].map(|x| (x + 0.37 * i as f64).sin().abs());
            // The longest third sides break the triangle; some are no numbers.
            [a, b, if i % 50 == 49 { f64::NAN } else { a + c }, 1e-18, -1e-18, 1e-19]
        };
        let mut known = 0;
        work_out(HyperbolicShape, 200, given, |i, found| {
            let alone = HyperbolicShape.of(given(i));
            assert_eq!(found.map(f64::to_bits)[13], alone[13].to_bits(), "{i}");
            if alone[13] == 1.0 {
                known += 1;
                assert_eq!(found, alone, "{i}");
            }
            assert!(i % 50 != 49 || alone[13] == 0.0);
        });
        assert!(known > 20 && known < 190, "{known}");
    }

    #[test]
    fn hyperbolic_shapes_are_those_of_the_half_angle_law() {
        // Triangles that are nearly flat lose digits by both laws, those with long sides by the law that serves all spaces.
        for (lengths, lost) in [
            ([1.0, 1.1, 0.7], 1e-29),
            ([1e-9, 1.0, 1.0], 1e-21),
            ([1e-30, 2e-30, 2.5e-30], 1e-29),
            ([6.0, 5.9, 0.3], 1e-26),
            ([1.0, 1.0, 1.999_999], 1e-23),
        ] {
            let q = lengths.map(|l: f64| DoubleDouble::from((0.5 * l).sinh()));
            let [a, b, c] = q.map(|q| q.high);
            let found = HyperbolicShape.of([a, b, c, 0.0, 0.0, 0.0]);
            let [area, is_known] = [found[12], found[13]];
            let angles: Vec<DoubleDouble> =
                found[..12].chunks(2).map(|x| DoubleDouble { high: x[0], low: x[1] }).collect();
            let known = half_angles_of_chords(Space::H2, q);
            for (angle, known) in angles.iter().zip(known.as_flattened()) {
                assert!(
                    (*angle - *known).high.abs() <= lost * known.high,
                    "{lengths:?}: {angle:?} {known:?}"
                );
            }
            let known = area_from(Space::H2, half_differences(q.map(|q| 2.0 * q.high.asinh())));
            assert!(
                is_known == 1.0 && (area / known - 1.0).abs() < 1e5 * lost.sqrt(),
                "{lengths:?}: {area} {known}"
            );
        }
        for lengths in [[1.0, 0.3, 0.4], [2.0, 1.0, 0.5]] {
            let [a, b, c] = lengths.map(|l: f64| (0.5 * l).sinh());
            assert!(HyperbolicShape.of([a, b, c, 0.0, 0.0, 0.0])[13] == 0.0);
        }
    }
}
