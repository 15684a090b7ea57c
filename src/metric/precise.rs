//! Chords, angles and curvature of a metric to twice the digits of doubles, from its variables.
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
use crate::geometry::chords::products;
use crate::geometry::conformal::half_chord;
use crate::geometry::scaled::exponent;
use crate::geometry::triangle::{area_from, half_angles_of_chords};
use crate::geometry::{Space, Twofold};
use crate::mesh::{EdgeId, FaceId, Mesh, PerEdge, PerFace, PerVertex};
use crate::parallel;
use std::ops::RangeInclusive;

impl Metric {
    /// The half chords of the edges, l/2, sinh(l/2), sin(l/2) in E², H², S², in units of their own, with the exponents of these. To 20
    /// digits where lengths are precise ([`crate::geometry::conformal::is_precise`]), else to those of doubles. It needs a metric in its
    /// domain: [`Metric::check_domain`].
    pub(crate) fn scaled_chords(&self, mesh: &Mesh) -> PerEdge<(Twofold, i32)> {
        let vertices = self.vertices();
        let mut chords = vec![(Twofold::default(), 0); mesh.n_edges()];
        parallel::fill(&mut chords, |e| {
            let e = EdgeId::from(e);
            let [a, b] = mesh.ends(e).map(|v| vertices[v]);
            half_chord(self.space, a, b, self.eta[e])
        });
        chords.into()
    }

    /// By how much the angles around each vertex inside miss 2π, those at a vertex of the boundary π, in (−2π, 2π], to twice the digits. It
    /// is the curvature of vertices that are meant to be flat, where sums of angles in doubles would show their own rounding.
    ///
    /// The rotations by all the angles are multiplied; no angle is formed.
    ///
    /// # Errors
    /// Those of [`Metric::check_domain`].
    pub fn angle_defects(&self, mesh: &Mesh) -> Result<PerVertex<f64>> {
        self.check_domain(mesh)?;
        Ok(self.angle_defects_inside(mesh))
    }

    /// [`Metric::angle_defects`] of a metric that is known to be in its domain; outside it they mean nothing.
    pub(crate) fn angle_defects_inside(&self, mesh: &Mesh) -> PerVertex<f64> {
        let half_angles = half_angles(self, mesh, &self.scaled_chords(mesh));
        let mut turn: PerVertex<[Twofold; 2]> =
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
type Chords = PerEdge<(Twofold, i32)>;

/// `[cos, sin]` of half the angle at each corner, from the half chords and the exponents of their units.
fn half_angles(metric: &Metric, mesh: &Mesh, chords: &Chords) -> PerFace<[[Twofold; 2]; 3]> {
    let (mut angles, sides) =
        (vec![[[Twofold::default(); 2]; 3]; mesh.n_faces()], usual_sides(metric, chords));
    parallel::fill(&mut angles, |f| {
        let f = FaceId::from(f);
        let found =
            sides.as_ref().and_then(|sides| hyperbolic_shape(mesh.opposite_edges(f).map(|e| sides[e])));
        found.map_or_else(|| half_angles_at(metric, mesh, chords, f), |(angles, _)| angles)
    });
    angles.into()
}

fn half_angles_at(metric: &Metric, mesh: &Mesh, chords: &Chords, f: FaceId) -> [[Twofold; 2]; 3] {
    let sides = mesh.opposite_edges(f).map(|e| chords[e]);
    // In E² the unit of the longest side is used, so that its chord is about 1. In H² and S² lengths have no unit but 1.
    let size = |(q, unit): (Twofold, i32)| unit + exponent(q.high);
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
) -> Result<(Chords, PerFace<[[Twofold; 2]; 3]>, Vec<(f64, bool)>)> {
    metric.check(mesh)?;
    let chords = metric.scaled_chords(mesh);
    let mut angles = vec![[[Twofold::default(); 2]; 3]; mesh.n_faces()];
    let mut areas = vec![(0.0, false); mesh.n_faces()];
    if let Some(sides) = usual_sides(metric, &chords) {
        parallel::fill_both(&mut angles, &mut areas, |f| {
            let f = FaceId::from(f);
            let found = hyperbolic_shape(mesh.opposite_edges(f).map(|e| sides[e]));
            found.unwrap_or_else(|| {
                let angles = half_angles_at(metric, mesh, &chords, f);
                (angles, (0.0, is_flat(&angles)))
            })
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

/// The sides of the triangles in H², where all have [`USUAL_CHORDS`].
fn usual_sides(metric: &Metric, chords: &Chords) -> Option<PerEdge<Side>> {
    let is_usual = |(q, unit): &(Twofold, i32)| *unit == 0 && USUAL_CHORDS.contains(&q.high);
    (metric.space == Space::H2 && chords.iter().all(is_usual)).then(|| {
        let mut sides = vec![Side::default(); chords.len()];
        parallel::fill(&mut sides, |e| Side::of_chord(chords[EdgeId::from(e)].0));
        sides.into()
    })
}

/// Whether half angles are those of (π, 0, 0), which broken triangles have.
fn is_flat(half_angles: &[[Twofold; 2]; 3]) -> bool {
    half_angles.iter().all(|[cos, sin]| cos.high == 0.0 || sin.high == 0.0)
}

/// Half chords in H² of edges that surely are in the domain of metrics ([`Metric::check_domain`]), and products of which doubles hold.
const USUAL_CHORDS: RangeInclusive<f64> = 1e-60..=1e60;

/// A side of triangles in H², of length l.
#[derive(Clone, Copy, Default)]
struct Side {
    /// sinh(l/2)
    chord: Twofold,
    /// cosh(l/2)
    cosh: Twofold,
    /// 1/√(sinh l)
    inverse_root: Twofold,
}

impl Side {
    fn of_chord(chord: Twofold) -> Side {
        let one = Twofold::from(1.0);
        let cosh = (one + chord * chord).sqrt();
        Side { chord, cosh, inverse_root: one / (chord * cosh).scaled(1).sqrt() }
    }
}

/// `[cos, sin]` of half the angles of a triangle in H², and its area, with the remark that it is not broken; `None` of one that may be.
///
/// With half the perimeter s and `r_k = s − l_k` the half-angle law reads `cos²(θ_k/2) = sinh s sinh r_k / (sinh l_i sinh l_j)` and
/// `sin²(θ_k/2) = sinh r_i sinh r_j / (sinh l_i sinh l_j)`, where `sinh s sinh r_k = (p − q_k)(p + q_k)` with the half chords q and
/// `p = sinh((l_i + l_j)/2)`. The roots `x_k` of these products give all, since `√(sinh r_i sinh r_j) = x_i x_j / sinh s`; also the area,
/// by `tan(area/2) = 2 x_i x_j x_k / (sinh s (1 + Σ cosh l))`.
fn hyperbolic_shape(sides: [Side; 3]) -> Option<([[Twofold; 2]; 3], (f64, bool))> {
    let (q, c) = (sides.map(|s| s.chord), sides.map(|s| s.cosh));
    let d = [0, 1, 2].map(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        q[i] * c[j] + q[j] * c[i] - q[k]
    });
    let (product, whole) = products(q, c, d);
    if product.iter().any(|x| x.high <= 0.0) {
        return None;
    }
    let x = product.map(Twofold::sqrt);
    let over = Twofold::from(1.0) / whole;
    let angles = [0, 1, 2].map(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        let scale = sides[i].inverse_root * sides[j].inverse_root;
        [x[k] * scale, x[i] * x[j] * (over * scale)]
    });
    let heron = x[0].high * x[1].high * (x[2].high * over.high);
    let cosh: f64 = q.iter().map(|q| 1.0 + 2.0 * q.high * q.high).sum();
    Some((angles, (2.0 * (2.0 * heron).atan2(1.0 + cosh), false)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::triangle::half_differences;

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
            let q = lengths.map(|l: f64| Twofold::from((0.5 * l).sinh()));
            let (angles, (area, broken)) = hyperbolic_shape(q.map(Side::of_chord)).unwrap();
            let known = half_angles_of_chords(Space::H2, q);
            for (angle, known) in angles.as_flattened().iter().zip(known.as_flattened()) {
                assert!(
                    (*angle - *known).high.abs() <= lost * known.high,
                    "{lengths:?}: {angle:?} {known:?}"
                );
            }
            let known = area_from(Space::H2, half_differences(q.map(|q| 2.0 * q.high.asinh())));
            assert!(!broken && (area / known - 1.0).abs() < 1e5 * lost.sqrt(), "{lengths:?}: {area} {known}");
        }
        for lengths in [[1.0, 0.3, 0.4], [2.0, 1.0, 0.5]] {
            let q = lengths.map(|l: f64| Twofold::from((0.5 * l).sinh()));
            assert!(hyperbolic_shape(q.map(Side::of_chord)).is_none());
        }
    }
}
