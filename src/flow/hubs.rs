//! The start of flows on surfaces whose boundary loops are filled by hubs.
//!
//! A hub h is a circle, ε_h = 1, with η_hi = 0 to the vertices i of its loop, which are points, ε_i = 0. So these lie on the circle:
//! `l_hi = e^{u_h}` in E², `l_hi = γ_h` in H². An edge between a hub and a vertex of its loop has no other diagonal and is never
//! flipped. An edge of the loop may be flipped; the hub is then joined to a vertex outside its circle.

use super::origin::FlowOrigin;
use super::solution::Solution;
use crate::control::Control;
use crate::error::Result;
use crate::geometry::triangle::angles;
use crate::geometry::{DoubleDouble, Space};
use crate::mesh::{EdgeId, FilledMesh, HalfedgeId, Mesh, PerEdge, VertexId};
use crate::metric::lengths::face_lengths;
use crate::metric::{Class, Metric, Surface};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::Arc;

/// Least radius of a circle at the start, in units of the longest edge of its loop, since chords of a circle are at most twice its radius.
const LEAST_START: f64 = 0.6;

/// The radius of the circle about a hub at the start: that of a circle as long as the loop, or a larger one if one edge is long.
pub(crate) fn start_radius(lengths: &PerEdge<f64>, rim: &[HalfedgeId]) -> f64 {
    let edges = rim.iter().map(|h| lengths[h.edge()]);
    let (sum, longest) = edges.fold((0.0, 0.0), |(sum, longest), l| (sum + l, f64::max(longest, l)));
    (sum / TAU).max(LEAST_START * longest)
}

impl Solution {
    /// The start of a flow of mixed types: the filled surface with its lengths (those at hubs only have to be lengths of triangles), on the
    /// triangulation that is Delaunay inside, points everywhere but at the hubs.
    ///
    /// # Errors
    /// Those of [`crate::metric::delaunay_start`].
    pub(crate) fn with_hubs(
        surface: Surface,
        filled: &FilledMesh,
        space: Space,
        control: &Control,
    ) -> Result<Solution> {
        let mut origin = FlowOrigin::delaunay(surface, Class::yamabe(space), false, &filled.rims(), control)?;
        let mesh = match &origin.flipped {
            Some(flipped) => flipped.mesh.clone(),
            None => origin.surface.mesh().clone(),
        };
        let lengths = origin.initial.metric.lengths(&mesh)?;
        let initial = &mut origin.initial;
        for k in 0..filled.loops.len() {
            let (hub, radius) = (filled.hub(k), start_radius(&lengths, &filled.loops[k]));
            make_hub(&mesh, &mut initial.metric, hub);
            initial.metric.u[hub] = if space == Space::H2 { (0.5 * radius).tanh().ln() } else { radius.ln() };
            initial.radii[hub] = radius;
            // In the geometry of the input the circle has no size, so any u in the domain will do (in H² u is negative if ε = 1).
            initial.input_u[hub] = if initial.input_geometry == Space::H2 { -1.0 } else { 0.0 };
        }
        origin.class = None;
        Ok(Solution::start(origin))
    }
}

/// Radians by which an angle opposite an edge of a loop may exceed its bound.
const OBTUSE: f64 = 1e-6;

impl Solution {
    /// The edges of loops that are opposite an obtuse angle in the triangulation that the flow starts from, with the foot of the height on
    /// them: its distance from the origin of the half-edge 2e as a share of the edge.
    ///
    /// An angle θ opposite an edge of a circle is Delaunay where `θ ≤ π/2 ∓ ψ/2`, ψ the angle of the edge at the centre, with + where the
    /// surface lies inside the circle. It counts as obtuse where it is above both bounds, ψ that of the edge's share of its loop.
    pub(crate) fn obtuse_rims(&self, filled: &FilledMesh) -> Vec<(EdgeId, f64)> {
        let surface = self.surface();
        let (mesh, lengths) = match &self.origin.flipped {
            Some(flipped) => (&flipped.mesh, &flipped.lengths),
            None => (surface.mesh(), &**surface.lengths()),
        };
        let (tan, atan): (fn(f64) -> f64, fn(f64) -> f64) = match surface.geometry() {
            Space::E2 => (|x| x, |x| x),
            Space::H2 => (f64::tanh, f64::atanh),
            Space::S2 => (f64::tan, f64::atan),
        };
        let around = |rim: &Vec<HalfedgeId>| rim.iter().map(|h| lengths[h.edge()]).sum::<f64>();
        let foot = |outside: &HalfedgeId, around: f64| {
            let h = outside.twin();
            let (f, k) = mesh.corner(h)?;
            // Lengths opposite the origin of h, its tip, the third corner.
            let all = face_lengths(mesh, lengths, f);
            let [a, b, c] = [k, (k + 1) % 3, (k + 2) % 3].map(|i| all[i]);
            let angles = angles(surface.geometry(), [a, b, c]).at;
            let share = atan(tan(b) * angles[0].cos()) / c;
            let from_origin = if h == h.edge().halfedge() { share } else { 1.0 - share };
            (angles[2] > FRAC_PI_2 + PI * c / around + OBTUSE).then_some((h.edge(), from_origin))
        };
        let of_loop = |rim: &Vec<HalfedgeId>| {
            let around = around(rim);
            rim.iter().filter_map(|h| foot(h, around)).collect::<Vec<_>>()
        };
        filled.loops.iter().flat_map(of_loop).collect()
    }
}

fn make_hub(mesh: &Mesh, metric: &mut Metric, hub: VertexId) {
    metric.epsilon[hub] = 1;
    let eta = Arc::make_mut(&mut metric.eta);
    mesh.outgoing(hub).for_each(|h| eta[h.edge()] = DoubleDouble::default());
}
