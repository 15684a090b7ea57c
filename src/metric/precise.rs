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
use crate::geometry::conformal::half_chord;
use crate::geometry::scaled::exponent;
use crate::geometry::triangle::half_angles_of_chords;
use crate::geometry::{Space, Twofold};
use crate::mesh::{EdgeId, FaceId, Mesh, PerEdge, PerFace, PerVertex};
use crate::parallel;

impl Metric {
    /// The half chords of the edges, l/2, sinh(l/2), sin(l/2) in E², H², S², in units of their own, with the exponents of these. To 20 digits where
    /// lengths are precise ([`crate::geometry::conformal::is_precise`]), else to those of doubles. It needs a metric in its domain:
    /// [`Metric::check_domain`].
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

/// `[cos, sin]` of half the angle at each corner, from the half chords and the exponents of their units.
pub(crate) fn half_angles(
    metric: &Metric,
    mesh: &Mesh,
    chords: &PerEdge<(Twofold, i32)>,
) -> PerFace<[[Twofold; 2]; 3]> {
    let mut angles = vec![[[Twofold::default(); 2]; 3]; mesh.n_faces()];
    parallel::fill(&mut angles, |f| {
        let sides = mesh.opposite_edges(FaceId::from(f)).map(|e| chords[e]);
        // In E² the unit of the longest side is used, so that its chord is about 1. In H² and S² lengths have no unit but 1.
        let size = |(q, unit): (Twofold, i32)| unit + exponent(q.high);
        let unit =
            if metric.space == Space::E2 { sides.map(size).into_iter().fold(i32::MIN, i32::max) } else { 0 };
        half_angles_of_chords(metric.space, sides.map(|(q, own)| q.scaled(own - unit)))
    });
    angles.into()
}
